/* Each particle becomes a sphere before the eye, each band of rows draws those that touch it. Which
 * of them a sample shows is found before any light is computed. */
#include "draw/spheres_cpu.h"

#include "base/error.h"
#include "draw/living.h"
#include "draw/looks.h"
#include "draw/sphere_rows.h"
#include "shared/exact.h"

#include <stdlib.h>

enum { MAKE_AT_A_TIME = 512 };

struct kiln_spheres_cpu {
    const struct kiln_scene *scene;
    const struct kiln_backdrop_stage *backdrop;
    struct kiln_threads *threads;
    struct kiln_spheres_targets targets;
    const struct kiln_sphere_rows *rows;
    float4 *table; /* looks */
    bool table_valid;
    struct kiln_drawn_sphere *spheres;
    struct kiln_row_range *ranges; /* their rows */
    uint32_t room;
    struct kiln_row_lists lists;
    size_t pitch; /* of a row of samples */
    float *samples;
    int32_t *nearest;
    uint32_t *entries; /* these three: for each thread */
};

static size_t samples_of(const struct kiln_spheres_cpu *stage)
{
    return (size_t)KILN_SPHERE_ROWS * KILN_SPHERE_SAMPLES * stage->pitch;
}

static size_t entries_of(const struct kiln_spheres_cpu *stage)
{
    return (size_t)2 * KILN_SPHERE_SAMPLES * stage->pitch;
}

static bool allocate(struct kiln_spheres_cpu *stage)
{
    size_t threads = kiln_threads_count(stage->threads);
    stage->pitch = stage->scene->width + KILN_SPHERE_PAD;
    stage->table = calloc((size_t)KILN_LOOK_TEXELS, sizeof *stage->table);
    stage->samples = malloc(threads * samples_of(stage) * sizeof *stage->samples);
    stage->nearest = malloc(threads * samples_of(stage) * sizeof *stage->nearest);
    stage->entries = malloc(threads * entries_of(stage) * sizeof *stage->entries);
    return stage->table && stage->samples && stage->nearest && stage->entries;
}

struct kiln_spheres_cpu *kiln_spheres_cpu_create(const struct kiln_scene *scene,
                                                 const struct kiln_spheres_params *params,
                                                 struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return NULL;
    struct kiln_spheres_cpu *stage = calloc(1, sizeof *stage);
    if (stage)
        *stage = (struct kiln_spheres_cpu){.scene = scene,
                                           .backdrop = params->backdrop,
                                           .threads = params->threads,
                                           .targets = params->targets,
                                           .rows = KILN_SIMD_PICK(kiln_sphere_rows, simd)};
    if (!stage || !allocate(stage)) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "spheres: out of memory");
        kiln_spheres_cpu_destroy(&stage);
    }
    return stage;
}

void kiln_spheres_cpu_destroy(struct kiln_spheres_cpu **stage)
{
    if (!*stage)
        return;
    kiln_row_lists_finish(&(*stage)->lists);
    free((*stage)->table);
    free((*stage)->spheres);
    free((*stage)->ranges);
    free((*stage)->samples);
    free((*stage)->nearest);
    free((*stage)->entries);
    free(*stage);
    *stage = NULL;
}

/* ---- from particles to spheres --------------------------------------------------------------- */

struct making {
    struct kiln_spheres_cpu *stage;
    const struct kiln_pool *pool;
    const struct kiln_view *view;
    const uint32_t *entries;
    struct kiln_living_system systems[KILN_MAX_SYSTEMS];
};

/* Between the slopes of the tangents at a circle, in a plane through the eye, and a pixel or two
 * around; scale: pixels of a slope of 1. */
static struct kiln_row_range between_tangents(float aside, float depth, float radius, float scale,
                                              float size)
{
    float t = sqrtf(exact_max(aside * aside + depth * depth - radius * radius, 0.0f));
    float low = (aside * t - depth * radius) / (depth * t + aside * radius);
    float high = (aside * t + depth * radius) / (depth * t - aside * radius);
    low = low * scale + 0.5f * size - 2.0f;
    high = high * scale + 0.5f * size + 3.0f;
    return (struct kiln_row_range){(int16_t)exact_clamp(low, 0.0f, size),
                                   (int16_t)exact_clamp(high, 0.0f, size)};
}

static void set3(float to[3], float4 from)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

/* It cannot fade, so it grows and shrinks by its opacity. One that reaches the near plane is not
 * drawn. */
static void make_sphere(const struct making *m, const struct kiln_living_system *system,
                        const struct kiln_living *particle, struct kiln_drawn_sphere *s,
                        struct kiln_row_range *rows)
{
    const struct kiln_view *view = m->view;
    const float4 frustum = view->frustum;
    for (int i = 0; i < 3; i++) {
        const float4 row = view->world_to_view[i];
        s->center[i] = row.x * particle->position.x + row.y * particle->position.y +
                       row.z * particle->position.z + row.w;
    }
    float radius = particle->radius * particle->opacity, depth = -s->center[2];
    /* No smaller than a pixel, or it would twinkle between the samples. */
    float pixel_m = 2.0f * frustum.y * exact_max(depth, 1e-3f) / frustum.w;
    s->radius = exact_max(radius, 0.5f * pixel_m);
    if (!(radius > 0.0f) || depth - s->radius <= view->eye.w)
        return;
    float4 cover = kiln_living_look(system, KILN_LOOK_COVER, particle->progress);
    set3(s->albedo, cover);
    s->lit = cover.w;
    set3(s->glow, kiln_living_look(system, KILN_LOOK_HOT, particle->progress));
    set3(s->bloom, kiln_living_look(system, KILN_LOOK_BLOOM, particle->progress));
    s->x =
        between_tangents(s->center[0], depth, s->radius, 0.5f * frustum.z / frustum.x, frustum.z);
    *rows =
        between_tangents(-s->center[1], depth, s->radius, 0.5f * frustum.w / frustum.y, frustum.w);
}

static void make_spheres(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct making *m = context;
    for (size_t i = begin; i < end; i++) {
        uint32_t number = m->entries[i] >> 24, slot = m->entries[i] & 0xffffffu;
        const struct kiln_living_system *system = &m->systems[number];
        struct kiln_living particle;
        m->stage->ranges[i] = (struct kiln_row_range){0, 0};
        m->stage->spheres[i] = (struct kiln_drawn_sphere){.radius = 0.0f};
        if (kiln_living_at(system, slot - m->pool->systems[number].base, &particle))
            make_sphere(m, system, &particle, &m->stage->spheres[i], &m->stage->ranges[i]);
    }
}

static bool make_room(struct kiln_spheres_cpu *stage, uint32_t count, struct kiln_error *error)
{
    if (count <= stage->room && stage->spheres)
        return true;
    free(stage->spheres);
    free(stage->ranges);
    stage->room = count + count / 4 + 64;
    stage->spheres = malloc(stage->room * sizeof *stage->spheres);
    stage->ranges = malloc(stage->room * sizeof *stage->ranges);
    if (stage->spheres && stage->ranges)
        return true;
    free(stage->spheres);
    stage->spheres = NULL;
    return kiln_error_set(error, KILN_DEVICE_FAILED, "spheres: out of memory");
}

static void make_all(struct kiln_spheres_cpu *stage, const struct kiln_pool *pool,
                     const struct kiln_particle *records, const uint32_t *entries, uint32_t count,
                     float time_s)
{
    if (!stage->table_valid || kiln_looks_vary(stage->scene))
        kiln_looks_sample(stage->scene, time_s, stage->table);
    stage->table_valid = true;
    struct making making = {.stage = stage,
                            .pool = pool,
                            .view = kiln_backdrop_rays(stage->backdrop)->view,
                            .entries = entries};
    const struct kiln_living_moment moment = {stage->scene, pool,         records,
                                              making.view,  stage->table, NULL};
    for (uint32_t i = 0; i < stage->scene->system_count; i++)
        making.systems[i] = kiln_living_system(&moment, i);
    kiln_threads_for(stage->threads, count, MAKE_AT_A_TIME, make_spheres, &making);
}

/* ---- into the picture ------------------------------------------------------------------------ */

struct drawing {
    struct kiln_spheres_cpu *stage;
    struct kiln_sphere_strip strip; /* what all have in common */
};

static void draw_bands(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct drawing *d = context;
    struct kiln_spheres_cpu *stage = d->stage;
    const struct kiln_row_lists *lists = &stage->lists;
    for (size_t band = begin; band < end; band++) {
        struct kiln_sphere_strip strip = d->strip;
        uint32_t y = (uint32_t)band * KILN_SPHERE_ROWS, height = stage->scene->height;
        strip.y = y;
        strip.y_to = y + KILN_SPHERE_ROWS < height ? y + KILN_SPHERE_ROWS : height;
        strip.list = lists->list + lists->first[band];
        strip.count = lists->first[band + 1] - lists->first[band];
        strip.samples = stage->samples + worker * samples_of(stage);
        strip.nearest = stage->nearest + worker * samples_of(stage);
        strip.entries = stage->entries + worker * entries_of(stage);
        stage->rows->draw(&strip);
    }
}

static bool open_images(const struct kiln_spheres_targets *t, struct kiln_sphere_strip *strip,
                        struct kiln_error *error)
{
    strip->scene_color = kiln_image_host(t->backdrop_color, KILN_READ, error);
    if (strip->scene_color)
        strip->scene_depth = kiln_image_host(t->backdrop_depth, KILN_READ, error);
    if (strip->scene_depth)
        strip->color = kiln_image_host(t->color, KILN_OVERWRITE, error);
    if (strip->color)
        strip->depth = kiln_image_host(t->depth, KILN_OVERWRITE, error);
    if (strip->depth)
        strip->bloom = kiln_image_host(t->bloom, KILN_OVERWRITE, error);
    return strip->bloom != NULL;
}

bool kiln_spheres_cpu_draw(struct kiln_spheres_cpu *stage, struct kiln_pool *pool,
                           struct kiln_buffer *entries, uint32_t count, float time_s,
                           struct kiln_error *error)
{
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    const uint32_t *list = records ? kiln_buffer_host(entries, KILN_READ, error) : NULL;
    if (!list || !make_room(stage, count, error))
        return false;
    make_all(stage, pool, records, list, count, time_s);
    struct drawing drawing = {stage,
                              {.frame = kiln_backdrop_rays(stage->backdrop),
                               .spheres = stage->spheres,
                               .rows = stage->ranges,
                               .width = stage->scene->width,
                               .pitch = stage->pitch}};
    if (!kiln_row_lists_fill(&stage->lists, stage->ranges, sizeof *stage->ranges, count,
                             stage->scene->height, KILN_SPHERE_ROWS, error) ||
        !open_images(&stage->targets, &drawing.strip, error))
        return false;
    kiln_threads_for(stage->threads, stage->lists.bands, 1, draw_bands, &drawing);
    return true;
}
