/* This file draws solid particles on the host, for solids.c: it transforms each into a sphere or a
 * mesh in view space, and draws each band of KILN_SOLID_ROWS rows with the particles that touch it.
 * Visibility in the samples is resolved before any light is computed. */
#include "draw/solids/solids_cpu.h"

#include <stdlib.h>

#include "base/error.h"
#include "base/matrix.h"
#include "draw/moment/appearance.h"
#include "draw/solids/solid_rows.h"
#include "scene/work.h"
#include "shared/derived.h"
#include "shared/exact.h"

enum { GRAIN = 512 };

struct kiln_solids_cpu {
    const struct kiln_scene *scene;
    const struct kiln_backdrop_stage *backdrop;
    struct kiln_threads *threads;
    struct kiln_solids_targets targets;
    const struct kiln_solid_rows *code; /* for the width of vectors in use */
    const struct kiln_instances *meshes;
    struct kiln_drawn_sphere *spheres;
    struct kiln_drawn_instance *instances; /* NULL where there are no meshes */
    struct kiln_row_range *ranges;         /* rows that each particle may touch */
    uint32_t capacity;                     /* elements of spheres, instances and ranges */
    struct kiln_row_lists lists;
    size_t pitch; /* elements of a row of samples */
    /* `samples`, `nearest`, `triangles` and `visible` are the scratch memory of struct
     * kiln_solid_strip. Each thread has a part of each. */
    float *samples;
    int32_t *nearest, *triangles;
    uint32_t *visible;
};

/* Returns for how many solids there is room after a frame with `count` of them. */
static uint64_t room_for(uint64_t count)
{
    return count + count / 4 + 64;
}

static size_t pitch_of(const struct kiln_scene *scene)
{
    return (size_t)scene->width + KILN_SOLID_PAD;
}

/* Returns the number of samples that a thread has. */
static size_t samples_of(const struct kiln_scene *scene)
{
    return (size_t)KILN_SOLID_ROWS * KILN_SOLID_SAMPLES * pitch_of(scene);
}

/* Returns the number of words that a thread has for visible particles. */
static size_t visible_words_of(const struct kiln_scene *scene)
{
    return (size_t)KILN_SOLID_VISIBLE_WORDS * KILN_SOLID_SAMPLES * pitch_of(scene);
}

static bool allocate(struct kiln_solids_cpu *stage)
{
    size_t threads = kiln_threads_count(stage->threads);
    stage->pitch = pitch_of(stage->scene);
    stage->samples = malloc(threads * samples_of(stage->scene) * sizeof *stage->samples);
    stage->nearest = malloc(threads * samples_of(stage->scene) * sizeof *stage->nearest);
    stage->visible = malloc(threads * visible_words_of(stage->scene) * sizeof *stage->visible);
    bool meshes = stage->meshes->corners != NULL;
    if (meshes)
        stage->triangles = malloc(threads * samples_of(stage->scene) * sizeof *stage->triangles);
    return stage->samples && stage->nearest && stage->visible && (stage->triangles || !meshes);
}

struct kiln_solids_cpu *kiln_solids_cpu_create(const struct kiln_moment *moment,
                                               const struct kiln_solids_params *params,
                                               struct kiln_error *error)
{
    struct kiln_solids_cpu *stage = calloc(1, sizeof *stage);
    if (stage)
        *stage = (struct kiln_solids_cpu){.scene = moment->scene,
                                          .meshes = &moment->instances,
                                          .backdrop = params->backdrop,
                                          .threads = params->threads,
                                          .targets = params->targets,
                                          .code = KILN_SIMD_PICK(kiln_solid_rows, moment->simd)};
    if (!stage || !allocate(stage)) {
        kiln_error_no_memory(error, "the solids");
        kiln_solids_cpu_destroy(&stage);
    }
    return stage;
}

void kiln_solids_cpu_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_solids_cpu *s = NULL;
    const bool meshes = kiln_scene_mesh_slots(scene) > 0;
    const uint64_t solids = room_for(kiln_scene_solid_slots(scene));
    const uint64_t sample =
        sizeof *s->samples + sizeof *s->nearest + (meshes ? sizeof *s->triangles : 0);
    const uint64_t solid =
        sizeof *s->spheres + sizeof *s->ranges + (meshes ? sizeof *s->instances : 0);
    const uint64_t bands = (scene->height + KILN_SOLID_ROWS - 1) / KILN_SOLID_ROWS;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, footprint->threads,
                       samples_of(scene) * sample + visible_words_of(scene) * sizeof *s->visible);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, solids, solid);
    kiln_row_lists_footprint(solids, bands, KILN_FOOTPRINT_PARTICLES, footprint);
}

void kiln_solids_cpu_destroy(struct kiln_solids_cpu **stage)
{
    if (!*stage)
        return;
    kiln_row_lists_finish(&(*stage)->lists);
    free((*stage)->spheres);
    free((*stage)->instances);
    free((*stage)->triangles);
    free((*stage)->ranges);
    free((*stage)->samples);
    free((*stage)->nearest);
    free((*stage)->visible);
    free(*stage);
    *stage = NULL;
}

/* ---- from particles to solids ---------------------------------------------------------------- */

struct convert_job {
    struct kiln_solids_cpu *stage;
    const struct kiln_pool *pool;
    const struct kiln_view *view;
    const uint32_t *entries;             /* the particles: system and slot, as in record.glsl */
    uint32_t patterns[KILN_MAX_SYSTEMS]; /* LOOK_PLAIN, LOOK_STRIPE or LOOK_SEGMENTS + number */
    struct kiln_appearance_system systems[KILN_MAX_SYSTEMS];
};

/* Returns the range of columns or rows between the two tangents from the eye to a circle, and 2 px
 * on either side; its end is not part of it. The circle lies in the plane of the depth axis and one
 * axis of the picture. aside: the circle's place along that axis, m, from the view's axis; scale:
 * pixels for a slope of 1; middle: the principal point, px; size: pixels of the picture along that
 * axis. */
static struct kiln_row_range between_tangents(float aside, float depth, float radius, float scale,
                                              float middle, float size)
{
    float t = sqrtf(exact_max(aside * aside + depth * depth - radius * radius, 0.0f));
    float low = (aside * t - depth * radius) / (depth * t + aside * radius);
    float high = (aside * t + depth * radius) / (depth * t - aside * radius);
    low = low * scale + middle - 2.0f;
    high = high * scale + middle + 3.0f;
    return (struct kiln_row_range){(int16_t)exact_int(exact_clamp(low, 0.0f, size)),
                                   (int16_t)exact_int(exact_clamp(high, 0.0f, size))};
}

/* Bounds the columns and rows that a particle may touch by those of its bounding sphere. Where the
 * bounding sphere of a mesh reaches the near plane, the bounds are the whole picture. */
static void bound_ball(const struct kiln_view *view, const float center[3], float radius,
                       struct kiln_row_range *x, struct kiln_row_range *y)
{
    const float4 frustum = view->frustum, principal = view->principal;
    float depth = -center[2];
    if (depth - radius <= view->eye.w) {
        *x = (struct kiln_row_range){0, (int16_t)exact_int(frustum.z)};
        *y = (struct kiln_row_range){0, (int16_t)exact_int(frustum.w)};
        return;
    }
    *x = between_tangents(center[0], depth, radius, 0.5f * frustum.z / frustum.x, principal.x,
                          frustum.z);
    *y = between_tangents(-center[1], depth, radius, 0.5f * frustum.w / frustum.y, principal.y,
                          frustum.w);
}

/* Transforms a position from the world to view space. */
static void find_center(const struct kiln_view *view, float3 at, vec3 center)
{
    mat4 world_to_view;
    kiln_matrix_from_rows(view->world_to_view, world_to_view);
    glm_mat4_mulv3(world_to_view, (vec3){at.x, at.y, at.z}, 1.0f, center);
}

/* Returns half the edge of a pixel in metres, at a depth in metres. A particle with a smaller
 * radius would flicker between the samples. It is drawn as wide as a pixel, and covers a part of
 * what it fills. */
static float least_radius(const struct kiln_view *view, float depth)
{
    float pixel_m = 2.0f * view->frustum.y * exact_max(depth, 1e-3f) / view->frustum.w;
    return 0.5f * pixel_m;
}

static void set3(float to[3], float4 from)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

/* Writes the second colour and the pose of a system with a pattern into the sphere, for all its
 * particles. They have no effect where the sphere is not drawn. */
static void make_pattern(const struct convert_job *m, uint32_t number, uint32_t slot,
                         const struct value_clocks *clocks, struct kiln_drawn_sphere *s)
{
    const struct kiln_appearance_system *system = &m->systems[number];
    const uint32_t pattern = m->patterns[number];
    if (pattern == LOOK_PLAIN)
        return;
    s->segments = pattern == LOOK_STRIPE ? -1.0f : (float)(pattern - LOOK_SEGMENTS);
    set3(s->other, kiln_appearance_look(system, KILN_LOOK_OTHER, clocks));
    const float4 pose = kiln_appearance_pose(system, slot, clocks);
    s->pose[0] = pose.x;
    s->pose[1] = pose.y;
    s->pose[2] = pose.z;
    s->pose[3] = pose.w;
}

/* Makes a drawn sphere. An opaque sphere cannot fade, so its opacity scales its radius. A sphere
 * that reaches the near plane is not drawn. */
static void make_sphere(const struct convert_job *m, const struct kiln_appearance_system *system,
                        const struct kiln_appearance *particle, struct kiln_drawn_sphere *s,
                        struct kiln_row_range *rows)
{
    const struct kiln_view *view = m->view;
    find_center(view, particle->position, s->center);
    float radius = particle->radius * particle->opacity, depth = -s->center[2];
    s->radius = exact_max(radius, least_radius(view, depth));
    s->part = radius * radius / (s->radius * s->radius);
    if (!(radius > 0.0f) || depth - s->radius <= view->eye.w)
        return;
    float4 cover = kiln_appearance_look(system, KILN_LOOK_COVER, &particle->clocks);
    set3(s->albedo, cover);
    s->lit = cover.w;
    set3(s->glow, kiln_appearance_look(system, KILN_LOOK_HOT, &particle->clocks));
    set3(s->bloom, kiln_appearance_look(system, KILN_LOOK_BLOOM, &particle->clocks));
    bound_ball(view, s->center, s->radius, &s->x, rows);
}

/* Writes the axes of the mesh in view space. scale: metres for each unit of the mesh. */
static void place_axes(const struct kiln_view *view, const struct instance_axes *axes, float scale,
                       struct kiln_drawn_instance *d)
{
    mat4 world_to_view;
    mat3 turn, to_world = {{axes->x.x, axes->x.y, axes->x.z},
                           {axes->y.x, axes->y.y, axes->y.z},
                           {axes->z.x, axes->z.y, axes->z.z}};
    kiln_matrix_from_rows(view->world_to_view, world_to_view);
    glm_mat4_pick3(world_to_view, turn);
    glm_mat3_mul(turn, to_world, turn);
    glm_mat3_scale(turn, scale);
    for (int i = 0; i < 9; i++)
        d->to_view[i % 3][i / 3] = turn[i / 3][i % 3];
}

/* Makes a drawn mesh. An opaque mesh cannot fade, so its opacity scales its size. */
static void make_instance(const struct convert_job *m, uint32_t number, uint32_t slot,
                          const struct kiln_appearance *particle, struct kiln_drawn_instance *d,
                          struct kiln_row_range *rows)
{
    const struct kiln_appearance_system *system = &m->systems[number];
    const struct kiln_instance_mesh *mesh = &m->stage->meshes->meshes[number];
    const struct kiln_look *look = &m->stage->scene->systems[number].look;
    const struct kiln_view *view = m->view;
    float center[3], size = 2.0f * particle->radius * particle->opacity;
    find_center(view, particle->position, center);
    float depth = -center[2], reach = exact_max(size * mesh->reach, least_radius(view, depth));
    if (!(size > 0.0f) || depth + reach <= view->eye.w)
        return;
    const struct instance_axes axes =
        kiln_appearance_axes(system, slot, &particle->clocks, look->mesh.orient);
    place_axes(view, &axes, reach / mesh->reach, d);
    for (int i = 0; i < 3; i++)
        d->to_view[i][3] = center[i];
    float4 cover = kiln_appearance_look(system, KILN_LOOK_COVER, &particle->clocks);
    set3(d->albedo, cover);
    d->lit = cover.w;
    d->shade = size * look->mesh.shade;
    d->part = size * size * mesh->reach * mesh->reach / (reach * reach);
    set3(d->glow, kiln_appearance_look(system, KILN_LOOK_HOT, &particle->clocks));
    set3(d->bloom, kiln_appearance_look(system, KILN_LOOK_BLOOM, &particle->clocks));
    d->first = mesh->first;
    d->triangles = mesh->triangles;
    bound_ball(view, center, reach, &d->x, rows);
}

static void make_solids(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct convert_job *m = context;
    for (size_t i = begin; i < end; i++) {
        uint32_t number = KILN_ENTRY_SYSTEM(m->entries[i]);
        uint32_t slot = KILN_ENTRY_SLOT(m->entries[i]);
        const struct kiln_appearance_system *system = &m->systems[number];
        struct kiln_appearance particle;
        m->stage->ranges[i] = (struct kiln_row_range){0, 0};
        m->stage->spheres[i] = (struct kiln_drawn_sphere){.radius = 0.0f};
        struct kiln_drawn_instance *instance = m->stage->instances ? &m->stage->instances[i] : NULL;
        if (instance)
            *instance = (struct kiln_drawn_instance){.triangles = 0};
        slot -= m->pool->systems[number].base;
        if (!kiln_appearance_at(system, slot, &particle))
            continue;
        if (instance && m->stage->meshes->meshes[number].triangles > 0)
            make_instance(m, number, slot, &particle, instance, &m->stage->ranges[i]);
        else
            make_sphere(m, system, &particle, &m->stage->spheres[i], &m->stage->ranges[i]);
        make_pattern(m, number, slot, &particle.clocks, &m->stage->spheres[i]);
    }
}

static bool make_room(struct kiln_solids_cpu *stage, uint32_t count, struct kiln_error *error)
{
    if (count <= stage->capacity && stage->spheres)
        return true;
    free(stage->spheres);
    free(stage->ranges);
    free(stage->instances);
    stage->capacity = (uint32_t)room_for(count);
    stage->spheres = malloc(stage->capacity * sizeof *stage->spheres);
    stage->ranges = malloc(stage->capacity * sizeof *stage->ranges);
    bool meshes = stage->meshes->corners != NULL;
    stage->instances = meshes ? malloc(stage->capacity * sizeof *stage->instances) : NULL;
    if (stage->spheres && stage->ranges && (stage->instances || !meshes))
        return true;
    free(stage->spheres);
    stage->spheres = NULL;
    return kiln_error_no_memory(error, "the solids");
}

static void make_all(struct kiln_solids_cpu *stage, const struct kiln_moment *moment,
                     const uint32_t *entries, uint32_t count)
{
    struct convert_job job = {
        .stage = stage, .pool = moment->pool, .view = &moment->view, .entries = entries};
    for (uint32_t i = 0; i < stage->scene->system_count; i++) {
        job.systems[i] = kiln_appearance_system(moment, i);
        job.patterns[i] = kiln_look_pattern(&stage->scene->systems[i].look);
    }
    kiln_threads_for(stage->threads, count, GRAIN, make_solids, &job);
}

/* ---- drawing --------------------------------------------------------------------------------- */

struct draw_job {
    struct kiln_solids_cpu *stage;
    struct kiln_solid_strip strip; /* the members that all strips share */
};

static void draw_bands(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct draw_job *d = context;
    struct kiln_solids_cpu *stage = d->stage;
    const struct kiln_row_lists *lists = &stage->lists;
    for (size_t i = begin; i < end; i++) {
        struct kiln_solid_strip strip = d->strip;
        const size_t band = lists->begin + i;
        uint32_t y = (uint32_t)band * KILN_SOLID_ROWS, height = stage->scene->height;
        strip.y = y;
        strip.y_to = y + KILN_SOLID_ROWS < height ? y + KILN_SOLID_ROWS : height;
        strip.list = kiln_row_lists_of(lists, band, &strip.count);
        strip.samples = stage->samples + worker * samples_of(stage->scene);
        strip.nearest = stage->nearest + worker * samples_of(stage->scene);
        strip.visible = stage->visible + worker * visible_words_of(stage->scene);
        if (stage->triangles)
            strip.triangles = stage->triangles + worker * samples_of(stage->scene);
        stage->code->draw(&strip);
    }
}

static bool open_images(const struct kiln_solids_targets *t, struct kiln_solid_strip *strip,
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

bool kiln_solids_cpu_draw(struct kiln_solids_cpu *stage, const struct kiln_moment *moment,
                          struct kiln_buffer *entries, uint32_t count, struct kiln_error *error)
{
    const uint32_t *list = kiln_buffer_host(entries, KILN_READ, error);
    if (!list || !make_room(stage, count, error))
        return false;
    make_all(stage, moment, list, count);
    struct draw_job job = {stage,
                           {.frame = kiln_backdrop_rays(stage->backdrop),
                            .spheres = stage->spheres,
                            .instances = stage->instances,
                            .corners = (const float4(*)[2])stage->meshes->corners,
                            .ranges = stage->ranges,
                            .patterned = kiln_looks_patterned(stage->scene),
                            .width = stage->scene->width,
                            .pitch = stage->pitch}};
    const struct kiln_row_items items = {.ranges = stage->ranges,
                                         .count = count,
                                         .height = stage->scene->height,
                                         .band_height = KILN_SOLID_ROWS};
    return open_images(&stage->targets, &job.strip, error) &&
           kiln_row_lists_draw(&stage->lists, &items, stage->threads, draw_bands, &job, error);
}
