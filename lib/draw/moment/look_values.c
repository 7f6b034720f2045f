/* This file makes rows of samples of the values of looks that vary over other clocks than life, and
 * evaluates them for one particle on the host, as draw/moment/record.glsl does in shaders. */
#include "draw/moment/look_values.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "asset/atlas/blackbody.h"
#include "draw/moment/looks.h"
#include "shared/exact.h"

static_assert(LOOK_VALUE_TEXEL(KILN_LOOK_VALUES) <= LOOK_PROGRAM_ROWS * KILN_LOOK_SAMPLES,
              "all values have a place");
static_assert(KILN_LOOK_ROWS <= LOOK_VALUE_TEXEL(0), "all rows of a look have a place");

/* The clocks that the table does not have. */
#define OWN_CLOCKS                                                                                 \
    (1u << KILN_CLOCK_AGE | 1u << KILN_CLOCK_SPEED | 1u << KILN_CLOCK_HEIGHT |                     \
     1u << KILN_CLOCK_DISTANCE | 1u << KILN_CLOCK_RANDOM | KILN_VALUE_USES_OWN_NOISE)

bool kiln_look_value_is_own(const float4 *keys, const struct kiln_value *value)
{
    return (kiln_value_uses(keys, value) & OWN_CLOCKS) != 0;
}

/* ---- which values there are ----------------------------------------------------------------- */

/* The values of a look, and which components of its rows each of them multiplies. A value that
 * multiplies two rows stands twice. */
enum { ALL_OF_COLOR = 7, X = 1, Y = 2, Z = 4, W = 8 };

struct place {
    uint32_t target, lanes;
    enum { OF_ANY, OF_FIRE, OF_SMOKE } of; /* whether additive looks have it, or covering ones */
    enum { PLAIN, HOT, COOL } light;       /* a temperature whose light the row has */
};

struct scalar_place {
    size_t at; /* of the value in struct kiln_look, in bytes */
    struct place place;
    bool is_mean; /* the row has the mean from birth on */
};

#define SCALAR(member, target, lanes)                                                              \
    {                                                                                              \
        offsetof(struct kiln_look, member), {target, lanes, OF_ANY, PLAIN}, false                  \
    }

static const struct scalar_place scalars[] = {
    SCALAR(size, KILN_LOOK_SHAPE, X),
    SCALAR(stretch, KILN_LOOK_SHAPE, Y),
    SCALAR(opacity, KILN_LOOK_SHAPE, Z),
    SCALAR(soft, KILN_LOOK_SHAPE, W),
    SCALAR(lit, KILN_LOOK_COVER, W),
    SCALAR(lit, KILN_LOOK_OTHER, W),
    SCALAR(intensity, KILN_LOOK_HOT, ALL_OF_COLOR),
    SCALAR(intensity, KILN_LOOK_COOL, ALL_OF_COLOR),
    SCALAR(near_fade, KILN_LOOK_HOT, W),
    SCALAR(cycles, KILN_LOOK_COOL, W),
    SCALAR(thickness, KILN_LOOK_BLOOM, W),
    SCALAR(scale.min, KILN_LOOK_SPREAD, X),
    SCALAR(scale.max, KILN_LOOK_SPREAD, Y),
    SCALAR(rotation.min, KILN_LOOK_TURN, X),
    SCALAR(rotation.max, KILN_LOOK_TURN, Y),
    SCALAR(point_size, KILN_LOOK_TURN, Z),
    SCALAR(line_width, KILN_LOOK_TURN, W),
    SCALAR(width, KILN_LOOK_FORM, X),
    SCALAR(height, KILN_LOOK_FORM, Y),
    {offsetof(struct kiln_look, spin.min), {KILN_LOOK_SPREAD, Z, OF_ANY, PLAIN}, true},
    {offsetof(struct kiln_look, spin.max), {KILN_LOOK_SPREAD, W, OF_ANY, PLAIN}, true},
    {offsetof(struct kiln_look, temperature), {KILN_LOOK_HOT, ALL_OF_COLOR, OF_ANY, HOT}, false},
    {offsetof(struct kiln_look, temperature), {KILN_LOOK_COOL, ALL_OF_COLOR, OF_ANY, COOL}, false},
};

static const struct {
    size_t at; /* of the value in struct kiln_look, in bytes */
    struct place place;
} vectors[] = {
    {offsetof(struct kiln_look, color), {KILN_LOOK_COVER, ALL_OF_COLOR, OF_SMOKE, PLAIN}},
    {offsetof(struct kiln_look, color), {KILN_LOOK_HOT, ALL_OF_COLOR, OF_FIRE, PLAIN}},
    {offsetof(struct kiln_look, color), {KILN_LOOK_COOL, ALL_OF_COLOR, OF_FIRE, PLAIN}},
    {offsetof(struct kiln_look, bloom), {KILN_LOOK_BLOOM, ALL_OF_COLOR, OF_ANY, PLAIN}},
    {offsetof(struct kiln_look, sphere.color), {KILN_LOOK_OTHER, ALL_OF_COLOR, OF_SMOKE, PLAIN}},
};

/* A value of a look that has rows of its own: one component, or three that vary as a whole. */
struct own_value {
    const struct kiln_value *components[3];
    unsigned count;
    struct place place;
    bool is_mean;
    bool is_source; /* it is the colour of what the particle was born on */
    bool of_parent; /* it is a value of the parent's look, at the particle's birth */
};

struct own_values {
    uint32_t count;
    struct own_value values[KILN_LOOK_VALUES];
};

static void add_own(struct own_values *own, struct own_value value)
{
    if (own->count < KILN_LOOK_VALUES)
        own->values[own->count++] = value;
}

/* Adds a vector: as a whole, or each of its components that has a clock of its own, or all of them
 * if it is the parent's. */
static void add_vector(struct own_values *own, const float4 *keys, const struct kiln_value3 *v,
                       struct place place, bool of_parent)
{
    const struct kiln_value *parts[3] = {&v->x, &v->y, &v->z};
    const bool whole = kiln_value3_is_whole(keys, v);
    if (whole && (of_parent || kiln_look_value_is_own(keys, &v->x))) {
        add_own(own, (struct own_value){{parts[0], parts[1], parts[2]},
                                        .count = 3,
                                        .place = place,
                                        .of_parent = of_parent});
        return;
    }
    for (unsigned c = 0; c < 3 && !whole; c++) {
        place.lanes = 1u << c;
        if (of_parent || kiln_look_value_is_own(keys, parts[c]))
            add_own(own, (struct own_value){
                             {parts[c]}, .count = 1, .place = place, .of_parent = of_parent});
    }
}

struct kiln_inherited kiln_look_inherited(const struct kiln_scene *scene, uint32_t index)
{
    const struct kiln_parent *parent = &scene->systems[index].emit.parent;
    return parent->enabled ? parent->look : (struct kiln_inherited){false, false, false};
}

/* Returns whether a value at a place of struct kiln_look is among those that are inherited. */
static bool is_inherited(struct kiln_inherited inherited, size_t at)
{
    return (inherited.size && at == offsetof(struct kiln_look, size)) ||
           (inherited.temperature && at == offsetof(struct kiln_look, temperature)) ||
           (inherited.color && at == offsetof(struct kiln_look, color));
}

static void find_own(const struct kiln_scene *scene, uint32_t index, struct own_values *own)
{
    const struct kiln_system *system = &scene->systems[index];
    const struct kiln_inherited inherited = kiln_look_inherited(scene, index);
    const char *look = (const char *)&system->look;
    const char *of_parent = (const char *)&scene->systems[system->emit.parent.system].look;
    const bool additive = system->look.blend == KILN_BLEND_ADD;
    own->count = 0;
    for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++) {
        const bool has = is_inherited(inherited, scalars[i].at);
        const struct kiln_value *value =
            (const struct kiln_value *)((has ? of_parent : look) + scalars[i].at);
        if (has || kiln_look_value_is_own(scene->keys, value))
            add_own(own, (struct own_value){{value},
                                            .count = 1,
                                            .place = scalars[i].place,
                                            .is_mean = scalars[i].is_mean,
                                            .of_parent = has});
    }
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        const bool has = is_inherited(inherited, vectors[i].at);
        const struct kiln_value3 *vector =
            (const struct kiln_value3 *)((has ? of_parent : look) + vectors[i].at);
        if (vectors[i].place.of != OF_ANY && (vectors[i].place.of == OF_FIRE) != additive)
            continue;
        if (vectors[i].at == offsetof(struct kiln_look, color) && kiln_color_is_source(vector))
            add_own(own, (struct own_value){{&vector->x, &vector->y, &vector->z},
                                            .count = 3,
                                            .place = vectors[i].place,
                                            .is_source = true,
                                            .of_parent = has});
        else
            add_vector(own, scene->keys, vector, vectors[i].place, has);
    }
}

/* Replaces a value by 1 that is inherited, or varies over another clock than life. */
static void replace_own(const float4 *keys, void *look, size_t at, bool inherited)
{
    struct kiln_value *value = (struct kiln_value *)((char *)look + at);
    if (inherited || kiln_look_value_is_own(keys, value))
        *value = (struct kiln_value){.constant = 1.0f};
}

struct kiln_look kiln_look_over_life(const struct kiln_scene *scene, uint32_t index)
{
    const float4 *keys = scene->keys;
    const struct kiln_inherited inherited = kiln_look_inherited(scene, index);
    const struct kiln_value one = {.constant = 1.0f};
    struct kiln_look over_life = scene->systems[index].look;
    if (kiln_color_is_source(&over_life.color))
        over_life.color = (struct kiln_value3){one, one, one};
    for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++)
        replace_own(keys, &over_life, scalars[i].at, is_inherited(inherited, scalars[i].at));
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        const bool has = is_inherited(inherited, vectors[i].at);
        replace_own(keys, &over_life, vectors[i].at + offsetof(struct kiln_value3, x), has);
        replace_own(keys, &over_life, vectors[i].at + offsetof(struct kiln_value3, y), has);
        replace_own(keys, &over_life, vectors[i].at + offsetof(struct kiln_value3, z), has);
    }
    return over_life;
}

/* ---- programs ------------------------------------------------------------------------------- */

static bool has_part(uint32_t how, uint32_t part)
{
    return part == 0 || (how & (part == 1 ? VALUE_TIMES : VALUE_PLUS)) != 0;
}

/* Returns whether a part of a value has steps, of which a row has room for each. */
static bool has_steps(const struct kiln_value *part)
{
    return VALUE_EASE(part->how) == VALUE_STEP && part->count <= KILN_LOOK_SAMPLES;
}

static struct kiln_look_part make_part(const float4 *keys, struct kiln_value part, uint32_t row)
{
    const uint32_t shared = KILN_VALUE_OF_PARTICLES;
    struct kiln_value alone = part;
    alone.how &= ~(VALUE_TIMES | VALUE_PLUS);
    struct kiln_look_part made = {.row = row};
    if (part.count == 0 || !(kiln_value_uses(keys, &alone) & shared))
        return made;
    made.clock = VALUE_CLOCK(part.how);
    made.draw = RANDOM_VALUES + VALUE_DRAW(part.how);
    made.from = keys[part.first].x;
    made.span = keys[part.first + part.count - 1].x - made.from;
    made.per_x = made.span > 0.0f ? (float)(KILN_LOOK_SAMPLES - 1) / made.span : 0.0f;
    if (VALUE_REPEAT(part.how) != VALUE_HOLDS)
        made.flags = VALUE_REPEAT(part.how) == VALUE_LOOPS ? LOOK_PART_LOOPS : LOOK_PART_MIRRORS;
    if (has_steps(&part)) {
        made.flags |= LOOK_PART_STEPS;
        made.steps = part.count;
    }
    if (made.clock == KILN_CLOCK_NOISE) {
        made.period_s = keys[part.first - 1].z;
        made.octaves = exact_uint(keys[part.first - 1].w);
    }
    return made;
}

/* Returns the row of light's way along temperatures. */
static void add_light(struct kiln_look_value *value, uint32_t row)
{
    value->light_row = row;
    value->light_from = value->low;
    value->light_per_x = value->high > value->low
                             ? (float)(KILN_LOOK_SAMPLES - 1) / (value->high - value->low)
                             : 0.0f;
}

/* Makes the value that is the colour of the source of a system or of its parent, which may lack one
 * if it is not enabled. */
static struct kiln_look_value make_source_value(const struct kiln_scene *scene, uint32_t index,
                                                const struct own_value *from)
{
    const struct kiln_emitter *emit = &scene->systems[index].emit;
    if (from->of_parent)
        emit = &scene->systems[emit->parent.system].emit;
    const struct kiln_source *source = emit->source.made;
    return (struct kiln_look_value){
        .target = from->place.target,
        .lanes = from->place.lanes,
        .parts = 1,
        .part = {{.clock = LOOK_CLOCK_SOURCE,
                  .row = source ? source->first_texel : 0,
                  .flags = from->of_parent ? LOOK_PART_PARENT : 0,
                  .octaves = source ? source->cells : 0,
                  .source = source}},
        .high = 1.0f,
    };
}

static void make_program(const struct kiln_scene *scene, uint32_t index,
                         const struct own_values *own, uint32_t *rows,
                         struct kiln_look_program *program)
{
    *program = (struct kiln_look_program){.count = own->count, .row = *rows};
    *rows += own->count > 0 ? LOOK_PROGRAM_ROWS : 0;
    for (uint32_t i = 0; i < own->count; i++) {
        const struct own_value *from = &own->values[i];
        const struct kiln_value *first = from->components[0];
        struct kiln_look_value *value = &program->values[i];
        if (from->is_source) {
            *value = make_source_value(scene, index, from);
            continue;
        }
        *value = (struct kiln_look_value){.target = from->place.target,
                                          .lanes = from->place.lanes,
                                          .low = kiln_value_least(scene->keys, first),
                                          .high = kiln_value_most(scene->keys, first)};
        for (unsigned c = 1; c < from->count; c++) {
            value->low = exact_min(value->low, kiln_value_least(scene->keys, from->components[c]));
            value->high = exact_max(value->high, kiln_value_most(scene->keys, from->components[c]));
        }
        for (uint32_t part = 0; part < VALUE_ENTRIES; part++) {
            if (!has_part(first->how, part))
                continue;
            value->parts |= 1u << part;
            value->part[part] =
                make_part(scene->keys, value_part(scene->keys, *first, part), (*rows)++);
            if (from->of_parent && value->part[part].clock != KILN_CLOCK_CONSTANT)
                value->part[part].flags |= LOOK_PART_PARENT;
        }
        if (from->place.light != PLAIN)
            add_light(value, (*rows)++);
    }
}

static uint32_t base_rows(const struct kiln_scene *scene)
{
    return (scene->system_count ? scene->system_count : 1) * KILN_LOOK_ROWS;
}

uint32_t kiln_look_rows(const struct kiln_scene *scene)
{
    struct own_values own;
    struct kiln_look_program program;
    uint32_t rows = base_rows(scene);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        find_own(scene, i, &own);
        make_program(scene, i, &own, &rows, &program);
    }
    return rows;
}

void kiln_look_programs_fill(const struct kiln_scene *scene,
                             struct kiln_look_program programs[KILN_MAX_SYSTEMS])
{
    struct own_values own;
    uint32_t rows = base_rows(scene);
    memset(programs, 0, KILN_MAX_SYSTEMS * sizeof *programs);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        find_own(scene, i, &own);
        make_program(scene, i, &own, &rows, &programs[i]);
    }
}

/* ---- samples -------------------------------------------------------------------------------- */

/* Returns a part of a value at x, without repetition: at a time if it does not vary by x. */
static float sample_part(const float4 *keys, struct kiln_value part, bool is_mean,
                         const struct kiln_look_part *made, const struct value_clocks *clocks,
                         float x)
{
    part.how &= ~(VALUE_TIMES | VALUE_PLUS);
    if (part.count == 0)
        return part.constant;
    if (made->clock == KILN_CLOCK_CONSTANT)
        return value_curve_at(keys, part, value_clock(keys, part, *clocks));
    if (is_mean && made->clock == KILN_CLOCK_LIFE && x > 0.0f)
        return value_sum_of_keys(keys, part, x) / x;
    part.how &= ~(3u << VALUE_REPEAT_SHIFT);
    return value_curve_at(keys, part, x);
}

/* Returns texel k of a part's row: its components, or the same number for all. */
static float4 part_texel(const float4 *keys, const struct own_value *from, uint32_t part,
                         const struct kiln_look_part *made, const struct value_clocks *clocks,
                         uint32_t k)
{
    float y[3];
    const bool steps = (made->flags & LOOK_PART_STEPS) != 0;
    float x = made->from + made->span * ((float)k / (float)(KILN_LOOK_SAMPLES - 1));
    float next_x = 0.0f;
    for (unsigned c = 0; c < 3; c++) {
        const struct kiln_value value =
            value_part(keys, *from->components[c < from->count ? c : 0], part);
        if (steps) {
            const uint32_t key = k < value.count ? k : value.count - 1;
            x = keys[value.first + key].x;
            next_x = key + 1 < value.count ? keys[value.first + key + 1].x : 0x1p100f;
        }
        y[c] = sample_part(keys, value, from->is_mean, made, clocks, x);
    }
    return (float4){y[0], y[1], y[2], steps ? next_x : y[0]};
}

/* The temperature of a cell's cool parts divided by that of its hot parts: see sample_light. */
static float4 light_texel(const struct kiln_observer *observer, const struct kiln_look *look,
                          const struct kiln_look_value *value, bool cool, uint32_t k)
{
    float rgb[3] = {1.0f, 1.0f, 1.0f};
    const float part = (float)k / (float)(KILN_LOOK_SAMPLES - 1);
    const float kelvin = value->low + (value->high - value->low) * part;
    if (kelvin > 0.0f)
        kiln_blackbody_color(observer, cool ? KILN_LOOK_COOL_SHARE * kelvin : kelvin, rgb);
    else if (look->blend != KILN_BLEND_ADD)
        rgb[0] = rgb[1] = rgb[2] = 0.0f;
    return (float4){rgb[0], rgb[1], rgb[2], 0.0f};
}

static float4 *texel_at(float4 *table, uint32_t row, uint32_t texel)
{
    return table + (size_t)row * KILN_LOOK_SAMPLES + texel;
}

/* Writes the texels of a value that shaders read (look_layout.h). */
static void write_value(float4 *to, const struct kiln_look_value *value)
{
    to[0] = (float4){(float)value->lanes, (float)value->parts, (float)value->light_row, 0.0f};
    to[1] = (float4){value->low, value->high, value->light_from, value->light_per_x};
    for (uint32_t p = 0; p < VALUE_ENTRIES; p++) {
        const struct kiln_look_part *part = &value->part[p];
        const bool steps = (part->flags & LOOK_PART_STEPS) != 0;
        to[2 + 2 * p] = (float4){(float)(part->clock + (part->flags << LOOK_PART_FLAG_SHIFT)),
                                 (float)(part->draw - (part->draw ? RANDOM_VALUES : 0u)),
                                 (float)part->row, (float)(steps ? part->steps : part->octaves)};
        to[3 + 2 * p] = (float4){part->from, part->per_x, part->span, part->period_s};
    }
}

/* Writes the texels of a program, whose values are in the order of the rows that they multiply. */
static void write_program(float4 *table, const struct kiln_look_program *program)
{
    float4 *texels = texel_at(table, program->row, 0);
    uint32_t next = 0;
    for (uint32_t row = 0; row < KILN_LOOK_ROWS; row++) {
        const uint32_t first = next;
        for (uint32_t i = 0; i < program->count; i++) {
            if (program->values[i].target == row)
                write_value(texels + LOOK_VALUE_TEXEL(next++), &program->values[i]);
        }
        texels[row] = (float4){(float)first, (float)(next - first), 0.0f, 0.0f};
    }
}

void kiln_look_programs_sample(const struct kiln_scene *scene,
                               const struct kiln_look_program programs[KILN_MAX_SYSTEMS],
                               float time_s, float4 *table)
{
    struct own_values own;
    struct kiln_observer observer;
    kiln_observer_fill(&observer);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        const struct kiln_look_program *program = &programs[i];
        const struct value_clocks clocks = kiln_scene_clocks(scene, i, time_s);
        if (program->count == 0)
            continue;
        find_own(scene, i, &own);
        write_program(table, program);
        for (uint32_t v = 0; v < program->count; v++) {
            const struct kiln_look_value *value = &program->values[v];
            for (uint32_t k = 0; k < KILN_LOOK_SAMPLES; k++) {
                for (uint32_t p = 0; p < VALUE_ENTRIES; p++) {
                    const struct kiln_look_part *part = &value->part[p];
                    if ((value->parts & 1u << p) && part->clock != LOOK_CLOCK_SOURCE)
                        *texel_at(table, part->row, k) =
                            part_texel(scene->keys, &own.values[v], p, part, &clocks, k);
                }
                if (value->light_row)
                    *texel_at(table, value->light_row, k) =
                        light_texel(&observer, look, value, own.values[v].place.light == COOL, k);
            }
        }
    }
}

/* ---- one particle --------------------------------------------------------------------------- */

static float4 mix4(float4 a, float4 b, float t)
{
    return (float4){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t,
                    a.w + (b.w - a.w) * t};
}

/* Returns a row at a place, in samples. */
static float4 row_at(const float4 *table, uint32_t row, float place)
{
    const float4 *samples = table + (size_t)row * KILN_LOOK_SAMPLES;
    const float held = exact_clamp(place, 0.0f, (float)(KILN_LOOK_SAMPLES - 1));
    uint32_t i = exact_uint(held);
    i = i > KILN_LOOK_SAMPLES - 2 ? KILN_LOOK_SAMPLES - 2 : i;
    return mix4(samples[i], samples[i + 1], held - (float)i);
}

/* Returns what a part's clock shows. */
static float clock_of(const struct kiln_look_part *part, const struct value_clocks *clocks)
{
    const bool parent = (part->flags & LOOK_PART_PARENT) != 0;
    switch (part->clock) {
    case KILN_CLOCK_LIFE:
        return parent ? clocks->parent_life : clocks->life;
    case KILN_CLOCK_AGE:
        return parent ? clocks->parent_age_s : clocks->age_s;
    case KILN_CLOCK_SPEED:
        return float3_length(clocks->velocity);
    case KILN_CLOCK_HEIGHT:
        return clocks->height;
    case KILN_CLOCK_DISTANCE:
        return clocks->distance;
    case KILN_CLOCK_RANDOM:
        return random_unit(parent ? clocks->parent_stream : clocks->stream, part->draw);
    case KILN_CLOCK_NOISE:
        return value_noise_at((struct value_noise){random_bits(clocks->stream, part->draw),
                                                   part->octaves,
                                                   exact_div(clocks->time_s, part->period_s)});
    default:
        return part->from;
    }
}

/* Returns x within the keys of a part that repeats. */
static float repeat(const struct kiln_look_part *part, float x)
{
    const float since = x - part->from, turns = floorf(exact_div(since, part->span));
    const float rest = exact_clamp(since - turns * part->span, 0.0f, part->span);
    const bool back =
        (part->flags & LOOK_PART_MIRRORS) != 0 && turns - 2.0f * floorf(turns * 0.5f) != 0.0f;
    return part->from + (back ? part->span - rest : rest);
}

float4 kiln_look_part_at(const float4 *table, const struct kiln_look_part *part,
                         const struct value_clocks *clocks)
{
    if (part->clock == LOOK_CLOCK_SOURCE) {
        const bool of_parent = (part->flags & LOOK_PART_PARENT) != 0;
        const float3 color =
            kiln_source_color(part->source, of_parent ? clocks->parent_stream : clocks->stream);
        return (float4){color.x, color.y, color.z, color.x};
    }
    float x = clock_of(part, clocks);
    if (part->flags & (LOOK_PART_LOOPS | LOOK_PART_MIRRORS))
        x = repeat(part, x);
    if (!(part->flags & LOOK_PART_STEPS))
        return row_at(table, part->row, (x - part->from) * part->per_x);
    const float4 *texels = table + (size_t)part->row * KILN_LOOK_SAMPLES;
    uint32_t k = 0;
    while (k + 1 < part->steps && x >= texels[k].w)
        k++;
    return (float4){texels[k].x, texels[k].y, texels[k].z, texels[k].x};
}

static float limited(const struct kiln_look_value *value, float x)
{
    return exact_clamp(x, value->low, value->high);
}

static float4 value_result(const float4 *table, const struct kiln_look_value *value,
                           const struct value_clocks *clocks)
{
    float4 y = kiln_look_part_at(table, &value->part[0], clocks);
    if (value->parts & 2u) {
        const float4 by = kiln_look_part_at(table, &value->part[1], clocks);
        y = (float4){y.x * by.x, y.y * by.y, y.z * by.z, y.x * by.x};
    }
    if (value->parts & 4u) {
        const float4 more = kiln_look_part_at(table, &value->part[2], clocks);
        y = (float4){y.x + more.x, y.y + more.y, y.z + more.z, y.x + more.x};
    }
    y = (float4){limited(value, y.x), limited(value, y.y), limited(value, y.z),
                 limited(value, y.x)};
    if (value->light_row)
        y = row_at(table, value->light_row, (y.x - value->light_from) * value->light_per_x);
    return y;
}

float4 kiln_look_multiply(const float4 *table, const struct kiln_look_program *program,
                          uint32_t target, const struct value_clocks *clocks, float4 row)
{
    for (uint32_t i = 0; i < program->count; i++) {
        const struct kiln_look_value *value = &program->values[i];
        if (value->target != target)
            continue;
        const float4 y = value_result(table, value, clocks);
        row.x *= value->lanes & X ? y.x : 1.0f;
        row.y *= value->lanes & Y ? y.y : 1.0f;
        row.z *= value->lanes & Z ? y.z : 1.0f;
        row.w *= value->lanes & W ? y.w : 1.0f;
    }
    return row;
}
