/* This file draws the backdrop on the host: it gathers the objects that rays may hit in a frame,
 * then runs two passes over rows of tiles. The first pass casts one ray a pixel, the second casts
 * more rays where there are edges. The order of the rows does not matter, since a row writes only
 * its own pixels. */
#include "draw/backdrop/backdrop_cpu.h"

#include <math.h>
#include <stdlib.h>

#include "base/error.h"
#include "base/matrix.h"
#include "draw/backdrop/backdrop_rows.h"
#include "draw/backdrop/meshes_cpu.h"
#include "shared/exact.h"

struct kiln_backdrop_cpu {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_image *color, *depth;
    const struct kiln_backdrop_rows *rows;
    struct kiln_pyramid *floor_image, *sky_image; /* NULL: none */
    struct kiln_meshes_cpu *meshes;               /* NULL: the scene has none */
    float *surfaces;
    struct kiln_surface_cache *cache; /* NULL: the camera moves */
    struct kiln_object_bounds object_bounds;
    struct kiln_casters casters;
    struct kiln_shape_set all_shapes;
    struct kiln_ray_frame frame;
};

static bool load_pictures(struct kiln_backdrop_cpu *cpu, struct kiln_error *error)
{
    const struct kiln_backdrop *backdrop = &cpu->scene->backdrop;
    if (backdrop->floor_image) {
        cpu->floor_image =
            kiln_pyramid_load(cpu->scene->loader, backdrop->floor_image, true, error);
        if (!cpu->floor_image)
            return false;
    }
    if (backdrop->sky_image)
        cpu->sky_image = kiln_pyramid_load(cpu->scene->loader, backdrop->sky_image, false, error);
    return cpu->sky_image || !backdrop->sky_image;
}

struct kiln_backdrop_cpu *kiln_backdrop_cpu_create(const struct kiln_scene *scene,
                                                   const struct kiln_meshes *meshes,
                                                   const struct kiln_backdrop_params *params,
                                                   struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return NULL;
    struct kiln_backdrop_cpu *cpu = calloc(1, sizeof *cpu);
    size_t pixels = (size_t)scene->width * scene->height;
    if (cpu) {
        cpu->scene = scene;
        cpu->threads = params->threads;
        cpu->color = params->color;
        cpu->depth = params->depth;
        cpu->rows = KILN_SIMD_PICK(kiln_backdrop_rows, simd);
        cpu->surfaces = malloc(pixels * sizeof *cpu->surfaces);
    }
    if (!cpu || !cpu->surfaces) {
        kiln_error_no_memory(error, "the backdrop");
        kiln_backdrop_cpu_destroy(&cpu);
        return NULL;
    }
    bool ok = load_pictures(cpu, error);
    if (ok && kiln_scene_view_stands(scene)) {
        cpu->cache = kiln_surface_cache_create(scene, cpu->rows->lanes, error);
        ok = cpu->cache != NULL;
    }
    if (ok && meshes->count > 0) {
        cpu->meshes = kiln_meshes_cpu_create(scene, meshes, params->threads, error);
        ok = cpu->meshes != NULL;
    }
    if (!ok)
        kiln_backdrop_cpu_destroy(&cpu);
    return cpu;
}

void kiln_backdrop_cpu_destroy(struct kiln_backdrop_cpu **cpu)
{
    if (!*cpu)
        return;
    kiln_pyramid_destroy(&(*cpu)->floor_image);
    kiln_pyramid_destroy(&(*cpu)->sky_image);
    kiln_meshes_cpu_destroy(&(*cpu)->meshes);
    kiln_surface_cache_destroy(&(*cpu)->cache);
    free((*cpu)->surfaces);
    free(*cpu);
    *cpu = NULL;
}

void kiln_backdrop_cpu_pictures(const struct kiln_backdrop_cpu *cpu,
                                struct kiln_picture_size *floor, struct kiln_picture_size *sky)
{
    *floor = *sky = (struct kiln_picture_size){0, 0};
    if (cpu->floor_image)
        *floor = (struct kiln_picture_size){cpu->floor_image->width, cpu->floor_image->height};
    if (cpu->sky_image)
        *sky = (struct kiln_picture_size){cpu->sky_image->width, cpu->sky_image->height};
}

/* ---- objects that rays may hit --------------------------------------------------------------- */

static struct kiln_ray_frame make_frame(struct kiln_backdrop_cpu *cpu,
                                        const struct kiln_backdrop_inputs *inputs,
                                        const struct kiln_lighting *lighting)
{
    const struct kiln_shape_features features = kiln_shape_features(cpu->scene);
    kiln_casters_find(inputs, &cpu->object_bounds, &cpu->casters);
    cpu->all_shapes = kiln_shape_set_all(inputs->shapes.counts.x);
    struct kiln_ray_frame frame = {
        .view = &inputs->view,
        .backdrop = &inputs->block,
        .shapes = &inputs->shapes,
        .all_shapes = &cpu->all_shapes,
        .from_sun = inputs->from_sun,
        .floor_image = cpu->floor_image,
        .sky_image = cpu->sky_image,
        .smoke_to_sun = lighting->smoke ? lighting->sun_depth : NULL,
        .smoke_to_sky = lighting->smoke ? lighting->sky_depth : NULL,
        .solids = lighting->solids,
        .meshes = cpu->meshes ? kiln_meshes_cpu_view(cpu->meshes) : NULL,
        .lamp_objects = {.shapes = &inputs->shapes,
                         .maps = lighting->lamp_maps,
                         .solid_maps = lighting->lamp_solids.texels},
        .object_bounds = &cpu->object_bounds,
        .all_casters = &cpu->casters,
        .casters = &cpu->casters,
        .lamp_smoke = lighting->lamp_smoke,
        .floor_gloss = features.floor_gloss && inputs->block.floor_params.x > 0.0f,
    };
    return frame;
}

/* ---- pixels of shapes ------------------------------------------------------------------------ */

static int32_t pixel_within(float x, float size)
{
    return exact_int(exact_clamp(x, 0.0f, size));
}

/* Returns the pixels that a shape may cover, with a margin of a few pixels. number: among the
 * bounds. */
static struct kiln_pixel_box cover_bounds(const struct kiln_view *view,
                                          const struct kiln_object_bounds *bounds, uint32_t number)
{
    const float near = 1e-6f, margin = 3.0f, width = view->frustum.z, height = view->frustum.w;
    float low[2] = {1e9f, 1e9f}, high[2] = {-1e9f, -1e9f};
    int in_front = 0;
    mat4 world_to_view;
    kiln_matrix_from_rows(view->world_to_view, world_to_view);
    for (int i = 0; i < 8; i++) {
        vec3 at;
        for (int k = 0; k < 3; k++) {
            const float half = bounds->half[k][number];
            at[k] = bounds->center[k][number] + (i >> k & 1 ? half : -half);
        }
        glm_mat4_mulv3(world_to_view, at, 1.0f, at);
        if (-at[2] < near)
            continue;
        in_front++;
        float x = view->principal.x + at[0] / (-at[2] * view->frustum.x) * 0.5f * width;
        float y = view->principal.y - at[1] / (-at[2] * view->frustum.y) * 0.5f * height;
        low[0] = exact_min(low[0], x);
        high[0] = exact_max(high[0], x);
        low[1] = exact_min(low[1], y);
        high[1] = exact_max(high[1], y);
    }
    if (in_front < 8) /* part of the box is behind the eye: all pixels; the whole box: none */
        return (struct kiln_pixel_box){0, in_front ? exact_int(width) : 0, 0,
                                       in_front ? exact_int(height) : 0};
    return (struct kiln_pixel_box){
        pixel_within(low[0] - margin, width), pixel_within(high[0] + margin, width),
        pixel_within(low[1] - margin, height), pixel_within(high[1] + margin, height)};
}

/* ---- the picture ----------------------------------------------------------------------------- */

struct job {
    const struct kiln_backdrop_picture *picture;
    const struct kiln_backdrop_rows *rows;
};

static void cast(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct job *job = context;
    for (size_t i = begin; i < end; i++)
        job->rows->cast(job->picture, (uint32_t)i * KILN_EDGE_TILE);
}

static void antialias(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct job *job = context;
    for (size_t i = begin; i < end; i++)
        job->rows->antialias(job->picture, (uint32_t)i * KILN_EDGE_TILE);
}

bool kiln_backdrop_cpu_draw(struct kiln_backdrop_cpu *cpu,
                            const struct kiln_backdrop_inputs *inputs,
                            const struct kiln_lighting *lighting, bool is_current,
                            struct kiln_error *error)
{
    cpu->frame = make_frame(cpu, inputs, lighting);
    if (is_current)
        return true;
    if (cpu->cache)
        kiln_surface_cache_begin(cpu->cache, inputs);
    const enum kiln_cache_use use = cpu->cache ? cpu->cache->use : KILN_CACHE_UNUSED;
    if (cpu->meshes && use != KILN_CACHE_FILLED &&
        !kiln_meshes_cpu_run(cpu->meshes, &inputs->view, &inputs->block, &inputs->shapes, error))
        return false;
    struct kiln_backdrop_picture picture = {
        .frame = &cpu->frame,
        .width = cpu->color->width,
        .height = cpu->color->height,
        .color = kiln_image_host(cpu->color, KILN_OVERWRITE, error),
        .surfaces = cpu->surfaces,
        .use = use,
        .cache = cpu->cache,
    };
    if (picture.color)
        picture.depth = kiln_image_host(cpu->depth, KILN_OVERWRITE, error);
    if (!picture.depth)
        return false;
    for (uint32_t i = 0; i < inputs->shapes.counts.x; i++)
        picture.boxes[i] = cover_bounds(&inputs->view, &cpu->object_bounds, i);
    struct job job = {&picture, cpu->rows};
    size_t tiles = (picture.height + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    return kiln_threads_try(cpu->threads, tiles, 1, cast, &job, error) &&
           kiln_threads_try(cpu->threads, tiles, 1, antialias, &job, error);
}

const struct kiln_ray_frame *kiln_backdrop_cpu_rays(const struct kiln_backdrop_cpu *cpu)
{
    return &cpu->frame;
}
