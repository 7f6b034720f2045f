/* Checks that each technique that draws billboards (lib/draw/sprites/particles.c) matches a plain C
 * rasteriser, which follows equations 3.1 to 3.3 of Heinz 2019 pixel by pixel in double precision.
 * If this fails, a technique places, lights, blends or fades billboards wrongly. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "asset/atlas/builtin.h"
#include "draw/backdrop/backdrop.h"
#include "draw/moment/looks.h"
#include "draw/sprites/particles.h"
#include "gpu/framebuffer.h"
#include "shared/derived.h"
#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/pools.h"

enum { WIDTH = 480, HEIGHT = 360, PIXELS = WIDTH * HEIGHT, COUNT = 24, STEP = 40 };

static const char SCENE[] =
    "kiln: 1\n"
    "seed: 5\n"
    "output: {size: [480, 360], fps: 60, frames: 100}\n"
    "camera: {position: [0, 1, 2.2], target: [0, 1, 0], fov: 60 deg, near: 0.05 m}\n"
    "backdrop:\n"
    "  haze: 0\n"
    "  sun: {color: [1, 0.9, 0.8], direction: [1, 2, 1]}\n"
    "  objects:\n"
    "    - box: {center: [0.5, 1, 0], size: [0.6, 0.6, 0.6]}\n"
    "  lights:\n"
    "    - point: {position: [-1, 1, 0.5], color: [2, 1, 0.3], radius: 0.3 m}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {rate: 1, life: 2 s, from: {point: {}}}\n"
    "    look: {atlas: 'builtin:smoke', size: {life: [1.6, 2.4]}, scale: [0.9, 1.2], opacity: "
    "0.6,\n"
    "           color: [0.5, 0.4, 0.3], soft: 3, fade: {in: 0.2, out: 0.3}, lit: 1,\n"
    "           spin: [10 deg/s, 90 deg/s], bloom: [0.1, 0.1, 0.1]}\n"
    "  fire:\n"
    "    emit: {rate: 1, life: 1.5 s, from: {point: {}}}\n"
    "    look: {atlas: 'builtin:fire', blend: add, size: 1.8 m, stretch: 0.05 s, opacity: 0.7,\n"
    "           temperature: {life: [1900, 1200]}, soft: 0, bloom: [1, 0.5, 0.25],\n"
    "           rotation: [0 deg, 360 deg], near_fade: 0.5 m}\n";

/* The number of cells of the fire's flipbook; the smoke has 32, without motion vectors. */
enum { FIRE_CELLS = 16 };

struct fixture {
    struct kiln_device *device;
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_atlas atlas;
    struct kiln_image scene_color, depth, color, bloom;
    struct kiln_backdrop_stage *backdrop;
    struct kiln_particles_stage *particles;
    struct kiln_pool pool;
    struct kiln_buffer entries;
    struct kiln_framebuffer framebuffer;
    struct kiln_moment moment;
    struct kiln_lighting lighting; /* all zero: particles shed no light and cast no shadows */
    float *cells[2];               /* texels of the systems' flipbooks, RGBA */
    uint32_t cell_count[2];
    float motion[FIRE_CELLS * KILN_ATLAS_MOTION * KILN_ATLAS_MOTION * 2];
    bool literal; /* smoke has the soft-particle fade of equation 3.3 as it is printed */
};

static float random_within(float low, float high)
{
    return low + (high - low) * (float)(rand() % 10001) / 10000.0f;
}

/* Places particles of both systems, with random positions, ages and velocities. The draw entries
 * list the farthest particle first. */
static void place_particles(struct fixture *f)
{
    struct kiln_error error = {0};
    static const uint32_t capacities[2] = {COUNT, COUNT};
    pool_init(&f->pool, f->device, capacities, 2);
    struct kiln_particle *records = kiln_buffer_host(&f->pool.records, KILN_OVERWRITE, &error);
    kiln_buffer_init(&f->entries, f->device, COUNT * sizeof(uint32_t), "entries");
    uint32_t *entries = kiln_buffer_host(&f->entries, KILN_OVERWRITE, &error);
    assert_true(records && entries);
    memset(records, 0, 2 * COUNT * sizeof *records);
    srand(17);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t system = i & 1, slot = system * COUNT + i;
        /* Each particle is nearer to the camera than the one before. */
        float z = -1.0f + 2.6f * (float)i / COUNT;
        uint32_t birth = 1 + (uint32_t)(rand() % (STEP - 1));
        records[slot] = (struct kiln_particle){
            .position_serial = {FLOAT_BITS(random_within(-1.0f, 1.0f)),
                                FLOAT_BITS(random_within(0.5f, 1.5f)), FLOAT_BITS(z), i},
            .velocity_birth = {FLOAT_BITS(random_within(-3.0f, 3.0f)),
                               FLOAT_BITS(random_within(-3.0f, 3.0f)), FLOAT_BITS(0.5f),
                               birth << KILN_BIRTH_STEP_SHIFT |
                                   (uint32_t)(rand() % 64) << KILN_BIRTH_FRACTION_SHIFT |
                                   KILN_PARTICLE_ALIVE}};
        entries[i] = KILN_ENTRY(system, slot);
    }
}

static void make_targets(struct fixture *f)
{
    struct kiln_error error = {0};
    kiln_image_init(&f->scene_color, f->device, WIDTH, HEIGHT, GL_RGBA32F, "scene");
    kiln_image_init(&f->depth, f->device, WIDTH, HEIGHT, GL_R32F, "depth");
    kiln_image_init(&f->color, f->device, WIDTH, HEIGHT, GL_RGBA32F, "particles");
    kiln_image_init(&f->bloom, f->device, WIDTH, HEIGHT, GL_RGBA32F, "bloom");
    struct kiln_image *targets[] = {&f->color, &f->bloom};
    assert_true(kiln_framebuffer_init(&f->framebuffer, f->device, targets, 2, &error));
}

/* The technique of drawing billboards with which set_up_with makes the fixture. */
static enum kiln_raster_technique technique;

/* Makes the reference's cells of a system's flipbook, and the motion vectors of the fire's cells,
 * in floats, without the rounding of the atlas. */
static void make_cells(struct fixture *f, int system, const char *name)
{
    const size_t floats = (size_t)KILN_ATLAS_CELL * KILN_ATLAS_CELL * 4;
    const size_t moves = (size_t)KILN_ATLAS_MOTION * KILN_ATLAS_MOTION * 2;
    struct kiln_builtin_scratch *scratch = kiln_builtin_scratch_create();
    struct kiln_builtin builtin;
    assert_non_null(scratch);
    assert_true(kiln_builtin_open(&builtin, name, f->cell_count[system], KILN_SIMD_PLAIN));
    for (uint32_t i = 0; i < f->cell_count[system]; i++) {
        kiln_builtin_cell(&builtin, i, KILN_ATLAS_CELL, scratch, f->cells[system] + i * floats);
        if (system == 1)
            kiln_builtin_motion(&builtin, i, KILN_ATLAS_MOTION, scratch, f->motion + i * moves);
    }
    kiln_builtin_close(&builtin);
    free(scratch);
}

static int set_up_with(void **state, const char *const *overrides, size_t count)
{
    struct kiln_error error = {0};
    struct fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    void *device = NULL;
    test_device_open(&device);
    f->device = device;
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = overrides;
    params.override_count = count;
    f->literal = count > 0;
    f->scene = kiln_scene_parse(SCENE, sizeof SCENE - 1, "test", &params, &error);
    if (!f->scene)
        fail_msg("%s", error.message);
    f->threads = kiln_threads_create(2);
    static const char *const sources[2] = {"builtin:smoke", "builtin:fire"};
    const struct kiln_atlas_request requests[] = {
        {.sources = &sources[0], .count = 1, .columns = 8, .rows = 4, .motion = "none"},
        {.sources = &sources[1], .count = 1, .columns = 4, .rows = 4, .motion = "auto"}};
    assert_true(kiln_atlas_init(&f->atlas, f->device, requests, 2, NULL, f->threads, &error));
    make_targets(f);
    assert_true(kiln_moment_init(&f->moment, f->device, f->scene, &f->atlas, &error));
    f->backdrop = backdrop_create(f->device, &f->moment, &f->scene_color, &f->depth, &error);
    f->particles =
        kiln_particles_create(f->device, f->scene, &f->atlas, technique, f->threads, &error);
    assert_true(f->backdrop && f->particles);
    place_particles(f);
    assert_true(kiln_moment_fill(&f->moment, &f->pool, kiln_instant_at_step(STEP), true, &error));
    assert_true(backdrop_draw_by_lamps(f->backdrop, &f->moment, &error));

    for (int i = 0; i < 2; i++) {
        f->cell_count[i] = requests[i].columns * requests[i].rows;
        size_t floats = (size_t)f->cell_count[i] * KILN_ATLAS_CELL * KILN_ATLAS_CELL * 4;
        f->cells[i] = calloc(floats, sizeof(float));
        assert_non_null(f->cells[i]);
        make_cells(f, i, kiln_builtin_name_of(sources[i]));
    }
    *state = f;
    return 0;
}

static int set_up(void **state)
{
    return set_up_with(state, NULL, 0);
}

/* Makes a fixture whose smoke has the soft-particle fade of equation 3.3 as it is printed. `soft`
 * is so small that alpha stays below its limit of 1 in front of the floor and the box. */
static int set_up_literal(void **state)
{
    static const char *const literal[] = {"systems.smoke.look.soft_formula=literal",
                                          "systems.smoke.look.soft=0.2"};
    return set_up_with(state, literal, 2);
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    free(f->cells[0]);
    free(f->cells[1]);
    kiln_buffer_finish(&f->entries);
    kiln_pool_finish(&f->pool);
    kiln_particles_destroy(&f->particles);
    kiln_backdrop_destroy(&f->backdrop);
    kiln_moment_finish(&f->moment);
    kiln_framebuffer_finish(&f->framebuffer);
    struct kiln_image *images[] = {&f->scene_color, &f->depth, &f->color, &f->bloom};
    for (size_t i = 0; i < 4; i++)
        kiln_image_finish(images[i]);
    kiln_atlas_finish(&f->atlas);
    kiln_threads_destroy(&f->threads);
    kiln_scene_destroy(&f->scene);
    void *device = f->device;
    test_device_close(&device);
    free(f);
    return 0;
}

/* ---- the reference --------------------------------------------------------------------------- */

/* Holds what the reference knows of a billboard. life: the fraction of its life that has passed;
 * soft: rate of the soft-particle fade, 1/m; cover: reflected colour; hot, cool: emitted light
 * where a cell's heat is 1 and 0; bloom: factors on the light that goes to the bloom. */
struct sprite {
    uint32_t system;
    bool additive;
    double center[3], right[2], up[2]; /* view space: centre, m; unit axes */
    double half_width, half_height, depth;
    double life, opacity, soft;
    double distance; /* from the eye, m; 0 unless the literal formula is used */
    double cover[3], hot[3], cool[3], bloom[3];
    double light[4][3]; /* light from all sides; parts along right, up and to the viewer */
};

/* Interpolates a row (KILN_LOOK_*) of a system's look table at a fraction of a particle's life. */
static float4 look(const struct fixture *f, uint32_t system, int row, double life)
{
    double x = life * (KILN_LOOK_SAMPLES - 1);
    int k = x >= KILN_LOOK_SAMPLES - 2 ? KILN_LOOK_SAMPLES - 2 : (int)x;
    float t = (float)(x - k);
    const float4 *p = f->moment.look_table +
                      ((size_t)system * KILN_LOOK_ROWS + (size_t)row) * KILN_LOOK_SAMPLES + k;
    return (float4){p[0].x + (p[1].x - p[0].x) * t, p[0].y + (p[1].y - p[0].y) * t,
                    p[0].z + (p[1].z - p[0].z) * t, p[0].w + (p[1].w - p[0].w) * t};
}

/* Transforms a vector from the world to view space. w: 1 for a position, 0 for a direction. */
static void to_view(const struct fixture *f, float3 v, double w, double out[3])
{
    for (int i = 0; i < 3; i++) {
        const float4 *row = &f->moment.view.world_to_view[i];
        out[i] = (double)row->x * (double)v.x + (double)row->y * (double)v.y +
                 (double)row->z * (double)v.z + (double)row->w * w;
    }
}

/* Adds light from a direction in the world, of any length, to the light on a sprite. */
static void add_light(struct sprite *s, const struct fixture *f, float3 towards,
                      const double radiance[3])
{
    double v[3], length = 0;
    to_view(f, towards, 0, v);
    for (int i = 0; i < 3; i++)
        length += v[i] * v[i];
    length = sqrt(length);
    double along[4] = {1, (v[0] * s->right[0] + v[1] * s->right[1]) / length,
                       (v[0] * s->up[0] + v[1] * s->up[1]) / length, v[2] / length};
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++)
            s->light[k][c] += 0.5 * radiance[c] * along[k];
    }
}

/* Computes the light on a sprite in SCENE: smoke is lit by sky, sun and one lamp. Fire is not lit;
 * it shows its own colour. */
static void light_sprite(struct sprite *s, const struct fixture *f, float3 position)
{
    static const double horizon[3] = {0.12, 0.13, 0.16}, top[3] = {0.02, 0.03, 0.05};
    static const double sun[3] = {1, 0.9, 0.8}, lamp[3] = {2, 1, 0.3};
    if (s->system == 1) {
        for (int c = 0; c < 3; c++)
            s->light[0][c] = 1;
        return;
    }
    for (int c = 0; c < 3; c++)
        s->light[0][c] = horizon[c];
    add_light(s, f, (float3){0, 1, 0}, top);
    double radiance[3];
    for (int c = 0; c < 3; c++)
        radiance[c] = sun[c] / acos(-1.0);
    add_light(s, f, (float3){1, 2, 1}, radiance);
    float3 towards = {-1.0f - position.x, 1.0f - position.y, 0.5f - position.z};
    double d2 = (double)(towards.x * towards.x + towards.y * towards.y + towards.z * towards.z);
    for (int c = 0; c < 3; c++)
        radiance[c] = lamp[c] / (d2 + 0.09);
    add_light(s, f, towards, radiance);
}

static struct sprite make_sprite(const struct fixture *f, uint32_t entry)
{
    struct sprite s = {.system = KILN_ENTRY_SYSTEM(entry)};
    s.additive = s.system == 1;
    struct kiln_particle record =
        ((const struct kiln_particle *)f->pool.records.host)[KILN_ENTRY_SLOT(entry)];
    struct kiln_derived_params derived = {.random_key = random_key(5, s.system),
                                          .dt_s = f->scene->dt_s,
                                          .life = f->scene->systems[s.system].emit.life};
    uint32_t stream = particle_stream(derived, record);
    double age = (double)particle_age(record, STEP, f->scene->dt_s);
    s.life = age / (s.system ? 1.5 : 2.0);

    float4 shape = look(f, s.system, KILN_LOOK_SHAPE, s.life);
    float4 spread = look(f, s.system, KILN_LOOK_SPREAD, s.life);
    float4 turn = look(f, s.system, KILN_LOOK_TURN, s.life);
    float4 cover = look(f, s.system, KILN_LOOK_COVER, s.life);
    float4 hot = look(f, s.system, KILN_LOOK_HOT, s.life);
    float4 cool = look(f, s.system, KILN_LOOK_COOL, s.life);
    float4 bloom = look(f, s.system, KILN_LOOK_BLOOM, s.life);
    memcpy(s.cover, (double[]){cover.x, cover.y, cover.z}, sizeof s.cover);
    memcpy(s.hot, (double[]){hot.x, hot.y, hot.z}, sizeof s.hot);
    memcpy(s.cool, (double[]){cool.x, cool.y, cool.z}, sizeof s.cool);
    memcpy(s.bloom, (double[]){bloom.x, bloom.y, bloom.z}, sizeof s.bloom);

    float3 position = particle_position(record);
    to_view(f, position, 1, s.center);
    s.depth = -s.center[2];
    s.soft = (double)shape.w;
    if (f->scene->systems[s.system].look.soft_formula == KILN_SOFT_LITERAL)
        s.distance =
            sqrt(s.center[0] * s.center[0] + s.center[1] * s.center[1] + s.center[2] * s.center[2]);
    double near = (s.depth - (double)f->moment.view.eye.w) / (double)hot.w;
    s.opacity = (double)shape.z * fmin(fmax(near, 0), 1);
    s.half_width =
        0.5 * (double)shape.x * (double)random_between(stream, RANDOM_SCALE, spread.x, spread.y);
    s.half_height = s.half_width;
    double angle = (double)random_between(stream, RANDOM_ROTATION, turn.x, turn.y);
    double spin = (double)random_between(stream, RANDOM_SPIN, spread.z, spread.w);
    bool backwards = random_unit(stream, RANDOM_SPIN + 1) < 0.5f;
    angle += (backwards ? -spin : spin) * age;
    s.up[0] = -sin(angle);
    s.up[1] = cos(angle);
    if (shape.y > 0) {
        double v[3];
        to_view(f, particle_velocity(record), 0, v);
        double speed = hypot(v[0], v[1]);
        assert_true(speed > 0.2); /* at lower speeds the rotation counts, too (billboard.h) */
        s.up[0] = v[0] / speed;
        s.up[1] = v[1] / speed;
        s.half_height += 0.5 * speed * (double)shape.y;
    }
    double sign = backwards ? -1 : 1;
    s.right[0] = sign * s.up[1];
    s.right[1] = -sign * s.up[0];
    light_sprite(&s, f, position);
    return s;
}

/* Samples level 0 of a cell bilinearly at texture coordinates x and y, 0 to 1. Texels are rounded
 * to 8 bits, as the atlas stores them. */
static void sample_cell(const float *cell, double x, double y, double out[4])
{
    double tx = x * KILN_ATLAS_CELL - 0.5, ty = y * KILN_ATLAS_CELL - 0.5;
    int x0 = (int)floor(tx), y0 = (int)floor(ty);
    memset(out, 0, 4 * sizeof *out);
    for (int k = 0; k < 4; k++) {
        int px = x0 + (k & 1), py = y0 + (k >> 1);
        double w = (k & 1 ? tx - x0 : 1 - (tx - x0)) * (k >> 1 ? ty - y0 : 1 - (ty - y0));
        px = px < 0 ? 0 : px > KILN_ATLAS_CELL - 1 ? KILN_ATLAS_CELL - 1 : px;
        py = py < 0 ? 0 : py > KILN_ATLAS_CELL - 1 ? KILN_ATLAS_CELL - 1 : py;
        for (int c = 0; c < 4; c++) {
            double texel = (double)cell[(py * KILN_ATLAS_CELL + px) * 4 + c];
            texel = c < 2 ? 0.5 + 0.5 * texel : texel;
            out[c] += w * floor(texel * 255 + 0.5) / 255;
        }
    }
}

/* Samples the motion vectors from a cell to the next one bilinearly, without rounding, at texture
 * coordinates x and y, 0 to 1. out: in widths of a cell. */
static void sample_motion(const float *motion, double x, double y, double out[2])
{
    double tx = x * KILN_ATLAS_MOTION - 0.5, ty = y * KILN_ATLAS_MOTION - 0.5;
    int x0 = (int)floor(tx), y0 = (int)floor(ty);
    out[0] = out[1] = 0;
    for (int k = 0; k < 4; k++) {
        int px = x0 + (k & 1), py = y0 + (k >> 1);
        double w = (k & 1 ? tx - x0 : 1 - (tx - x0)) * (k >> 1 ? ty - y0 : 1 - (ty - y0));
        px = px < 0 ? 0 : px > KILN_ATLAS_MOTION - 1 ? KILN_ATLAS_MOTION - 1 : px;
        py = py < 0 ? 0 : py > KILN_ATLAS_MOTION - 1 ? KILN_ATLAS_MOTION - 1 : py;
        for (int c = 0; c < 2; c++)
            out[c] += w * (double)motion[(py * KILN_ATLAS_MOTION + px) * 2 + c];
    }
}

/* Computes the fragment of a sprite at pixel (px, py). out: its premultiplied colour and alpha;
 * bloom: the colour that it adds to the bloom. */
static void shade(const struct fixture *f, const struct sprite *s, int px, int py, double out[4],
                  double bloom[3])
{
    double vx =
        (2 * (px + 0.5) / WIDTH - 1) * (double)f->moment.view.frustum.x * s->depth - s->center[0];
    double vy =
        (1 - 2 * (py + 0.5) / HEIGHT) * (double)f->moment.view.frustum.y * s->depth - s->center[1];
    double a = (vx * s->right[0] + vy * s->right[1]) / s->half_width;
    double b = (vx * s->up[0] + vy * s->up[1]) / s->half_height;
    memset(out, 0, 4 * sizeof *out);
    memset(bloom, 0, 3 * sizeof *bloom);
    if (fabs(a) >= 1 || fabs(b) >= 1)
        return;
    double first[4], second[4], cell[4];
    double position = s->life * (f->cell_count[s->system] - 1);
    size_t k = (size_t)position, size = KILN_ATLAS_CELL * KILN_ATLAS_CELL * 4;
    double x = 0.5 + 0.5 * a, y = 0.5 - 0.5 * b, part = position - (double)k, way[2] = {0};
    if (s->system == 1)
        sample_motion(f->motion + k * KILN_ATLAS_MOTION * KILN_ATLAS_MOTION * 2, x, y, way);
    const float *cells = f->cells[s->system] + k * size;
    sample_cell(cells, x - part * way[0], y + part * way[1], first);
    sample_cell(cells + size, x + (1 - part) * way[0], y - (1 - part) * way[1], second);
    for (int c = 0; c < 4; c++)
        cell[c] = first[c] + (second[c] - first[c]) * part;

    double scene = (double)f->depth.host[py * WIDTH + px], behind = scene - s->depth;
    double fade = s->soft > 0 ? fmin(fmax(behind * s->soft, 0), 1) : behind >= 0;
    if (s->distance > 0)
        fade = behind >= 0 ? fabs(scene - s->distance) * s->soft : 0;
    double nx = 2 * cell[0] - 1, ny = 2 * cell[1] - 1, nz = sqrt(fmax(1 - nx * nx - ny * ny, 0));
    double alpha = fmin(cell[3] * s->opacity * fade, 1);
    for (int c = 0; c < 3; c++) {
        double light =
            s->light[0][c] + s->light[1][c] * nx + s->light[2][c] * ny + s->light[3][c] * nz;
        double glow = s->cool[c] + (s->hot[c] - s->cool[c]) * cell[2];
        out[c] = alpha * (glow + s->cover[c] * fmax(light, 0));
        bloom[c] = s->bloom[c] * out[c];
    }
    out[3] = s->additive ? 0 : alpha;
}

static void reverse(struct fixture *f)
{
    struct kiln_error error = {0};
    uint32_t *entries = kiln_buffer_host(&f->entries, KILN_READ_WRITE, &error);
    assert_non_null(entries);
    for (uint32_t i = 0; i < COUNT / 2; i++) {
        uint32_t other = entries[i];
        entries[i] = entries[COUNT - 1 - i];
        entries[COUNT - 1 - i] = other;
    }
}

/* Draws the particles in the order of the entries, each over the particles before it. A technique
 * that draws the nearest particle first gets the entries in reverse. sum_alpha: sums up colours and
 * alpha instead of blending. */
static void draw(struct fixture *f, bool sum_alpha)
{
    if (kiln_particles_nearest_first(f->particles))
        reverse(f);
    struct kiln_error error = {0};
    const struct kiln_particles_draw job = {
        .moment = &f->moment,
        .entries = &f->entries,
        .count = COUNT,
        .view = &f->moment.view,
        .backdrop = kiln_backdrop_block(f->backdrop),
        .lighting = &f->lighting,
        .depth = &f->depth,
        .framebuffer = &f->framebuffer,
        .sum_alpha = sum_alpha,
    };
    if (!kiln_particles_run(f->particles, &job, &error))
        fail_msg("%s", error.message);
    assert_non_null(kiln_image_host(&f->color, KILN_READ, &error));
    assert_non_null(kiln_image_host(&f->bloom, KILN_READ, &error));
    assert_non_null(kiln_image_host(&f->depth, KILN_READ, &error));
    if (kiln_particles_nearest_first(f->particles))
        reverse(f);
}

/* Each technique must match the reference within the limits of docs/determinism.md: a mean relative
 * error of 1e-3, and at most one value in a thousand off by more than 1 %. For the second limit,
 * 0.1 is added to the value that the error is relative to, since drivers filter 8-bit texels with
 * 8-bit weights. */
static void particles_match_the_reference(void **state)
{
    struct fixture *f = *state;
    draw(f, false);
    struct sprite sprites[COUNT];
    const uint32_t *entries = f->entries.host;
    for (uint32_t i = 0; i < COUNT; i++)
        sprites[i] = make_sprite(f, entries[i]);

    double error_sum = 0, light_sum = 0;
    int off = 0;
    for (int p = 0; p < PIXELS; p++) {
        double color[4] = {0}, bloom[4] = {0};
        /* Pixels in front of the distant sky are left out: there the literal formula makes even
         * faint texels opaque. */
        if (f->literal && f->depth.host[p] > 8.0f)
            continue;
        for (int i = 0; i < COUNT; i++) {
            double over[4], glow[3];
            shade(f, &sprites[i], p % WIDTH, p / WIDTH, over, glow);
            for (int c = 0; c < 4; c++)
                color[c] = over[c] + color[c] * (1 - over[3]);
            for (int c = 0; c < 3; c++)
                bloom[c] = glow[c] + bloom[c] * (1 - over[3]);
        }
        for (int c = 0; c < 4; c++) {
            double delta = fabs((double)f->color.host[4 * p + c] - color[c]);
            error_sum += delta;
            light_sum += color[c];
            off += delta > 1e-2 * (color[c] + 0.1);
            if (c < 3)
                off += fabs((double)f->bloom.host[4 * p + c] - bloom[c]) > 1e-2 * (bloom[c] + 0.1);
        }
    }
    assert_true(light_sum / PIXELS > 0.5); /* the picture is not black */
    print_message("mean relative error %g, values off by over 1 %%: %d of %d\n",
                  error_sum / light_sum, off, PIXELS * 7);
    assert_true(error_sum / light_sum <= 1e-3);
    assert_true(off <= PIXELS * 7 / 1000);
}

/* With sum_alpha, the order of particles must not change the picture, except for rounding. */
static void sums_do_not_depend_on_order(void **state)
{
    struct fixture *f = *state;
    draw(f, true);
    float *before = malloc(PIXELS * 4 * sizeof(float));
    assert_non_null(before);
    memcpy(before, f->color.host, PIXELS * 4 * sizeof(float));
    reverse(f);
    draw(f, true);
    double alpha = 0;
    for (int i = 0; i < PIXELS * 4; i++) {
        assert_true(fabsf(f->color.host[i] - before[i]) <= 1e-4f * (1.0f + before[i]));
        alpha += i % 4 == 3 ? (double)before[i] : 0;
    }
    assert_true(alpha > 0.1 * PIXELS);
    free(before);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(particles_match_the_reference),
        cmocka_unit_test(sums_do_not_depend_on_order),
    };
    static const struct CMUnitTest literal[] = {cmocka_unit_test(particles_match_the_reference)};
    static const struct {
        enum kiln_raster_technique technique;
        const char *name, *literal_name;
    } techniques[] = {
        {KILN_RASTER_GEOMETRY, "geometry", "geometry, equation 3.3 as it is printed"},
        {KILN_RASTER_INSTANCED, "instanced", "instanced, equation 3.3 as it is printed"},
        {KILN_RASTER_TILED, "tiled", "tiled, equation 3.3 as it is printed"},
        {KILN_RASTER_CPU, "cpu", "cpu, equation 3.3 as it is printed"},
    };
    int failed = 0;
    for (size_t i = 0; i < sizeof techniques / sizeof *techniques; i++) {
        technique = techniques[i].technique;
        failed += cmocka_run_group_tests_name(techniques[i].name, tests, set_up, tear_down);
        failed += cmocka_run_group_tests_name(techniques[i].literal_name, literal, set_up_literal,
                                              tear_down);
    }
    return failed;
}
