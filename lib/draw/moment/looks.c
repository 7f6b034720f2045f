/* This file fills the table of looks, which holds each system's look sampled at evenly spaced ages,
 * and the uniform block with the parts of looks that do not depend on age. */
#include "draw/moment/looks.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "asset/atlas/blackbody.h"
#include "scene/family.h"
#include "scene/look_defaults.h"
#include "scene/ribbon.h"
#include "shared/exact.h"

static_assert(KILN_MAX_PARTICLES <= 0x3ffffff && KILN_MAX_SYSTEMS <= 64, "LOOK_PARENT_SLOTS");
static_assert(LOOK_POINT == KILN_SHAPE_POINT && LOOK_LINE == KILN_SHAPE_LINE &&
                  LOOK_MESH == KILN_SHAPE_MESH && LOOK_RIBBON == KILN_SHAPE_RIBBON,
              "shapes");
static_assert(KILN_RIBBON_MOST_SMOOTH <= 64, "6 bits of a word");
static_assert(LOOK_SCREEN == KILN_FACING_SCREEN && LOOK_VIEWPOINT == KILN_FACING_VIEWPOINT &&
                  LOOK_AXIAL == KILN_FACING_AXIAL && LOOK_VELOCITY == KILN_FACING_VELOCITY &&
                  LOOK_SURFACE == KILN_FACING_SURFACE && LOOK_NORMAL == KILN_FACING_NORMAL,
              "facings");

/* Holds the place at which looks are sampled: the clocks of a moment and of a progress through
 * life, 0 to 1. */
struct sampler {
    const struct kiln_scene *scene;
    const struct kiln_observer *observer;
    bool own_temperature; /* the temperature is a value over another clock than life */
    struct value_clocks clocks;
};

static float at(const struct sampler *s, const struct kiln_value *value)
{
    return value_at(s->scene->keys, *value, s->clocks);
}

static float3 at3(const struct sampler *s, const struct kiln_value3 *value)
{
    return value3_at(s->scene->keys, *value, s->clocks);
}

/* Returns the mean of a value from birth to the sampler's age. For a spin, the mean times the age
 * is the angle turned so far. */
static float mean_at(const struct sampler *s, const struct kiln_value *value)
{
    const float progress = s->clocks.life;
    if (value->count == 0 || VALUE_CLOCK(value->how) != KILN_CLOCK_LIFE || progress <= 0.0f)
        return at(s, value);
    return value_sum_at(s->scene->keys, *value, s->clocks, progress) / progress;
}

static float saturate(float x)
{
    return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x;
}

/* Returns the factor of opacity that fades a particle in and out: it is 0 at birth and at death and
 * 1 in between (Heinz 2019, 3.2.4). */
static float fade(const struct sampler *s, const struct kiln_look *look)
{
    float in = at(s, &look->fade_in), out = at(s, &look->fade_out);
    float risen = in > 0.0f ? saturate(s->clocks.life / in) : 1.0f;
    float left = out > 0.0f ? saturate((1.0f - s->clocks.life) / out) : 1.0f;
    return risen * left;
}

/* Returns the light of a black body of a temperature, times a tint, with w as the fourth number. */
static float4 blackbody_light(const struct sampler *s, float3 tint, float kelvin, float w)
{
    float rgb[3];
    kiln_blackbody_color(s->observer, kelvin, rgb);
    return (float4){tint.x * rgb[0], tint.y * rgb[1], tint.z * rgb[2], w};
}

/* Samples the rows of colour and light. The look's colour tints the emitted light of an additive
 * particle; it is the albedo of a covering particle. */
static void sample_light(const struct sampler *s, const struct kiln_look *look,
                         float4 row[KILN_LOOK_ROWS])
{
    bool additive = look->blend == KILN_BLEND_ADD;
    float3 color = at3(s, &look->color);
    float kelvin = at(s, &look->temperature), intensity = at(s, &look->intensity);
    float near_fade = at(s, &look->near_fade), cycles = at(s, &look->cycles);

    float3 tint = {intensity, intensity, intensity};
    if (additive)
        tint = float3_scale(color, intensity);
    float4 cover = {color.x, color.y, color.z, at(s, &look->lit)};
    const float4 covers_none = {0.0f, 0.0f, 0.0f, cover.w};
    float3 other = at3(s, &look->sphere.color);
    row[KILN_LOOK_COVER] = additive ? covers_none : cover;
    row[KILN_LOOK_OTHER] = additive ? covers_none : (float4){other.x, other.y, other.z, cover.w};
    if (s->own_temperature) {
        row[KILN_LOOK_HOT] = (float4){tint.x, tint.y, tint.z, near_fade};
        row[KILN_LOOK_COOL] = (float4){tint.x, tint.y, tint.z, cycles};
    } else if (kelvin > 0.0f) {
        row[KILN_LOOK_HOT] = blackbody_light(s, tint, kelvin, near_fade);
        row[KILN_LOOK_COOL] = blackbody_light(s, tint, KILN_LOOK_COOL_SHARE * kelvin, cycles);
    } else {
        float3 glow = additive ? tint : (float3){0.0f, 0.0f, 0.0f};
        row[KILN_LOOK_HOT] = (float4){glow.x, glow.y, glow.z, near_fade};
        row[KILN_LOOK_COOL] = (float4){glow.x, glow.y, glow.z, cycles};
    }
}

/* Returns the unit vector along v, or up if v is 0, which key frames between opposite vectors may
 * pass through. It computes in double, since squares of small floats underflow. */
static float4 unit(float3 v)
{
    double x = (double)v.x, y = (double)v.y, z = (double)v.z, length = sqrt(x * x + y * y + z * z);
    if (!(length > 0.0))
        return (float4){0.0f, 1.0f, 0.0f, 0.0f};
    return (float4){(float)(x / length), (float)(y / length), (float)(z / length), 0.0f};
}

/* Puts numbers of ribbons in the place of those that only other shapes have. */
static void sample_ribbon(const struct kiln_look *look, float4 row[KILN_LOOK_ROWS])
{
    const struct kiln_look_ribbon *ribbon = &look->ribbon;
    const double textures_a_metre = ribbon->texture_m > 0.0 ? 1.0 / ribbon->texture_m : 0.0;
    row[KILN_LOOK_SHAPE].y = (float)ribbon->gap_m;
    row[KILN_LOOK_TURN] =
        (float4){(float)ribbon->taper[0], (float)ribbon->taper[1], (float)textures_a_metre, 0.0f};
}

static void sample_look(const struct sampler *s, const struct kiln_look *look,
                        float4 row[KILN_LOOK_ROWS])
{
    float3 bloom = at3(s, &look->bloom);
    row[KILN_LOOK_SHAPE] = (float4){at(s, &look->size), at(s, &look->stretch),
                                    at(s, &look->opacity) * fade(s, look), at(s, &look->soft)};
    row[KILN_LOOK_BLOOM] = (float4){bloom.x, bloom.y, bloom.z, at(s, &look->thickness)};
    row[KILN_LOOK_SPREAD] = (float4){at(s, &look->scale.min), at(s, &look->scale.max),
                                     mean_at(s, &look->spin.min), mean_at(s, &look->spin.max)};
    row[KILN_LOOK_TURN] = (float4){at(s, &look->rotation.min), at(s, &look->rotation.max),
                                   at(s, &look->point_size), at(s, &look->line_width)};
    const bool normal = look->facing.way == KILN_FACING_NORMAL;
    row[KILN_LOOK_AXIS] = unit(at3(s, normal ? &look->facing.normal : &look->axis));
    row[KILN_LOOK_FORM] = (float4){at(s, &look->width), at(s, &look->height), 0.0f, 0.0f};
    if (look->shape == KILN_SHAPE_RIBBON)
        sample_ribbon(look, row);
    sample_light(s, look, row);
}

void kiln_looks_sample(const struct kiln_scene *scene, float time_s, float4 *table)
{
    struct kiln_observer observer;
    kiln_observer_fill(&observer);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        float4 *rows = table + (size_t)i * KILN_LOOK_ROWS * KILN_LOOK_SAMPLES;
        const struct kiln_look *whole = &scene->systems[i].look;
        const struct kiln_look look = kiln_look_over_life(scene, i);
        struct sampler sampler = {
            .scene = scene,
            .observer = &observer,
            .own_temperature = kiln_look_value_is_own(scene->keys, &whole->temperature) ||
                               kiln_look_inherited(scene, i).temperature,
            .clocks = kiln_scene_clocks(scene, i, time_s),
        };
        for (uint32_t k = 0; k < KILN_LOOK_SAMPLES; k++) {
            sampler.clocks.life = (float)k / (float)(KILN_LOOK_SAMPLES - 1);
            float4 texel[KILN_LOOK_ROWS];
            sample_look(&sampler, &look, texel);
            for (uint32_t row = 0; row < KILN_LOOK_ROWS; row++)
                rows[row * KILN_LOOK_SAMPLES + k] = texel[row];
        }
    }
}

/* Returns what the values of a look use that are in the table. */
static uint32_t look_uses(const float4 *keys, const struct kiln_look *look)
{
    const struct kiln_value *values[] = {
        &look->size,        &look->stretch,   &look->cycles,  &look->opacity,
        &look->temperature, &look->intensity, &look->fade_in, &look->fade_out,
        &look->soft,        &look->near_fade, &look->lit,     &look->point_size,
        &look->line_width,  &look->thickness, &look->width,   &look->height};
    const struct kiln_value3 *vectors[] = {&look->color, &look->bloom, &look->axis,
                                           &look->facing.normal, &look->sphere.color};
    uint32_t uses = kiln_range_uses(keys, &look->scale) | kiln_range_uses(keys, &look->rotation) |
                    kiln_range_uses(keys, &look->spin);
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        uses |= kiln_value_uses(keys, values[i]);
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
        uses |= kiln_value3_uses(keys, vectors[i]);
    return uses;
}

bool kiln_looks_vary(const struct kiln_scene *scene)
{
    uint32_t uses = 0;
    for (uint32_t i = 0; i < scene->system_count; i++)
        uses |= look_uses(scene->keys, &scene->systems[i].look);
    return (uses & KILN_VALUE_OF_TIME) != 0;
}

uint32_t kiln_look_pattern(const struct kiln_look *look)
{
    if (look->sphere.pattern == KILN_PATTERN_SEGMENTS)
        return LOOK_SEGMENTS + look->sphere.segments;
    return look->sphere.pattern == KILN_PATTERN_STRIPE ? LOOK_STRIPE : LOOK_PLAIN;
}

bool kiln_looks_patterned(const struct kiln_scene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        any = any || (scene->systems[i].enabled && look->shape == KILN_SHAPE_SPHERE &&
                      look->sphere.pattern != KILN_PATTERN_PLAIN);
    }
    return any;
}

/* Returns the number that is added, modulo 2^32, to a slot of the system in the pool to get the
 * index of the slot's spin. Spins and ways lie in the order of the pool (particles/pool.c). */
static uint32_t spins_before(const struct kiln_scene *scene, uint32_t index)
{
    uint32_t slots = 0, spins = 0;
    for (uint32_t i = 0; i < index; i++) {
        slots += scene->systems[i].capacity;
        spins += kiln_scene_system_spins(scene, i) ? scene->systems[i].capacity : 0;
        spins += kiln_family_travels(scene, i) ? scene->systems[i].capacity : 0;
    }
    return spins - slots;
}

static struct kiln_draw_look make_look(const struct kiln_scene *scene, uint32_t index,
                                       const struct kiln_atlas_textures *textures)
{
    const struct kiln_look *look = &scene->systems[index].look;
    struct kiln_draw_look made = {
        .derived = kiln_scene_derived(scene, index),
        .flags = {look->blend == KILN_BLEND_ADD,
                  (look->random_start ? LOOK_RANDOM_START : 0) |
                      (kiln_look_is_picture(look) ? LOOK_UNMIRRORED : 0) |
                      (kiln_look_is_formed(look) ? LOOK_FORMED : 0),
                  look->soft_formula == KILN_SOFT_LITERAL, textures->count},
        .form = {look->shape, look->facing.way, look->point_round,
                 look->shape == KILN_SHAPE_LINE ? look->line_to == KILN_LINE_PREVIOUS
                                                : look->stretch_dims},
    };
    const bool turns = kiln_scene_system_spins(scene, index);
    made.turn = (uint4){turns, spins_before(scene, index), kiln_look_pattern(look),
                        turns && look->mesh.orient == KILN_ORIENT_SPIN};
    for (uint32_t i = 0; i < textures->count; i++) {
        const struct kiln_atlas_range *cells = &textures->textures[i];
        made.textures[i] =
            (uint4){cells->first_layer, cells->cells, cells->kind, FLOAT_BITS(cells->motion)};
    }
    return made;
}

/* Returns the number of the first record of a system. */
static uint32_t first_record(const struct kiln_scene *scene, uint32_t index)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < index; i++)
        first += scene->systems[i].capacity;
    return first;
}

/* Returns `ribbon` of a look. */
static uint4 ribbon_of(const struct kiln_scene *scene, uint32_t index)
{
    const struct kiln_system *system = &scene->systems[index];
    const struct kiln_look_ribbon *ribbon = &system->look.ribbon;
    if (system->look.shape != KILN_SHAPE_RIBBON)
        return (uint4){0};
    uint32_t flags = ribbon->facing == KILN_RIBBON_NORMAL ? LOOK_RIBBON_NORMAL : 0;
    flags |= kiln_ribbon_is_at_once(system) ? LOOK_RIBBON_COUNTED : 0;
    flags |= kiln_ribbon_joins_parent(system) ? LOOK_RIBBON_JOINS : 0;
    uint32_t textures = 0;
    if (ribbon->texture_m > 0.0) {
        const double step = 1.0 / (ribbon->texture_m * kiln_ribbon_per_metre(system));
        const double part = (step - floor(step)) * 65536.0; /* whole textures do not matter */
        const uint32_t high = exact_uint((float)floor(part));
        textures = high << 16 | exact_uint((float)floor((part - high) * 65536.0));
    }
    return (uint4){first_record(scene, index) | (ribbon->smooth - 1) << 26,
                   system->capacity | flags, kiln_ribbon_run(system), textures};
}

/* Returns `values` of a look but for its first word: where the records of its parents are. */
static uint4 parents_of(const struct kiln_scene *scene, uint32_t index)
{
    const struct kiln_parent *parent = &scene->systems[index].emit.parent;
    uint4 values = {0};
    const struct kiln_system *system = &scene->systems[index];
    const bool joins = system->look.shape == KILN_SHAPE_RIBBON && kiln_ribbon_joins_parent(system);
    if (!kiln_family_inherits(system) && !joins)
        return values;
    values.y = first_record(scene, parent->system);
    values.z = scene->systems[parent->system].capacity;
    values.w = parent->slots | parent->system << 26;
    return values;
}

void kiln_looks_fill(const struct kiln_scene *scene, const struct kiln_atlas *atlas,
                     const struct kiln_look_program programs[KILN_MAX_SYSTEMS],
                     struct kiln_draw_look looks[KILN_MAX_SYSTEMS])
{
    memset(looks, 0, KILN_MAX_SYSTEMS * sizeof *looks);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        looks[i] = make_look(scene, i, &atlas->systems[i]);
        looks[i].values = parents_of(scene, i);
        looks[i].ribbon = ribbon_of(scene, i);
        looks[i].values.x = programs[i].count > 0 ? programs[i].row : 0;
    }
}
