/* Draws hand-made particles for tests. drawing_init makes a scene, its stages and their target
 * images; drawing_place takes the particles; drawing_run draws them; drawing_run_rasters runs tests
 * with several techniques that draw billboards. The texture atlas is built here, so that each
 * texel's colour tells its place in the texture. */
#include "support/drawing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/parts.h"
#include "support/pools.h"

enum { DRAWING_CELL = 128 }; /* texels along an edge of the finest level of detail */

enum kiln_raster_technique drawing_technique = KILN_RASTER_GEOMETRY;
uint32_t drawing_most = 32;
uint32_t drawing_threads = 2;
const char *drawing_asset_root;

/* Fills a level of detail of the texture: red grows to the right from 0 to 1, green grows
 * downwards, and blue and alpha are 1. Texels hold square roots, since shaders square the texels of
 * colour cells (KILN_CELL_COLOR). */
static void drawing_fill_level(unsigned char *texels, int columns, int rows)
{
    for (int i = 0; i < columns * rows; i++) {
        double x = (i % columns + 0.5) / columns, y = (i / columns + 0.5) / rows;
        unsigned char texel[4] = {(unsigned char)(sqrt(x) * 255 + 0.5),
                                  (unsigned char)(sqrt(y) * 255 + 0.5), 255, 255};
        memcpy(texels + 4 * i, texel, 4);
    }
}

static void drawing_make_atlas(struct drawing *d)
{
    static const signed char still[2] = {0, 0};
    GLuint textures[3];
    glGenTextures(3, textures);
    d->atlas = (struct kiln_atlas){.texels = calloc(1, KILN_ATLAS_LAYER_BYTES),
                                   .texture = textures[0],
                                   .motion = textures[1],
                                   .strips = textures[2],
                                   .layers = 1};
    assert_non_null(d->atlas.texels);
    glBindTexture(GL_TEXTURE_2D_ARRAY, textures[0]);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, KILN_ATLAS_LEVELS, GL_RGBA8, DRAWING_CELL, DRAWING_CELL, 1);
    unsigned char *texels = d->atlas.texels;
    for (int level = 0; level < KILN_ATLAS_LEVELS; level++) {
        int edge = DRAWING_CELL >> level;
        drawing_fill_level(texels, edge, edge);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, 0, edge, edge, 1, GL_RGBA,
                        GL_UNSIGNED_BYTE, texels);
        texels += 4 * edge * edge;
    }
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D_ARRAY, textures[1]);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RG8_SNORM, 1, 1, 1);
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, 1, 1, 1, GL_RG, GL_BYTE, still);
    drawing_fill_level(texels, 1, KILN_ATLAS_STRIP);
    glBindTexture(GL_TEXTURE_2D_ARRAY, textures[2]);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, 1, KILN_ATLAS_STRIP, 1);
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, 1, KILN_ATLAS_STRIP, 1, GL_RGBA,
                    GL_UNSIGNED_BYTE, texels);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    for (int i = 0; i < KILN_MAX_SYSTEMS; i++)
        d->atlas.systems[i] = (struct kiln_atlas_textures){
            .textures = {{.cells = 1, .kind = KILN_CELL_COLOR}}, .count = 1};
}

static void drawing_make_targets(struct drawing *d)
{
    struct kiln_error error = {0};
    uint32_t w = d->scene->width, h = d->scene->height;
    kiln_image_init(&d->backdrop_color, d->device, w, h, GL_RGBA32F, "backdrop");
    kiln_image_init(&d->backdrop_depth, d->device, w, h, GL_R32F, "backdrop depth");
    kiln_image_init(&d->depth, d->device, w, h, GL_R32F, "depth");
    kiln_image_init(&d->color, d->device, w, h, GL_RGBA32F, "particles");
    kiln_image_init(&d->bloom, d->device, w, h, GL_RGBA32F, "bloom");
    struct kiln_image *targets[] = {&d->color, &d->bloom};
    assert_true(kiln_framebuffer_init(&d->framebuffer, d->device, targets, 2, &error));
}

void drawing_init(struct drawing *d, struct kiln_device *device, const char *text,
                  const char *const *overrides, size_t override_count)
{
    struct kiln_error error = {0};
    *d = (struct drawing){.device = device, .threads = kiln_threads_create(drawing_threads)};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = drawing_asset_root;
    params.overrides = overrides;
    params.override_count = override_count;
    d->scene = kiln_scene_parse(text, strlen(text), "test", &params, &error);
    if (!d->scene)
        fail_msg("%s", error.message);
    drawing_make_atlas(d);
    drawing_make_targets(d);
    if (!kiln_moment_init(&d->moment, device, d->scene, &d->atlas, &error))
        fail_msg("%s", error.message);
    d->backdrop =
        backdrop_create(device, &d->moment, &d->backdrop_color, &d->backdrop_depth, &error);
    d->particles =
        kiln_particles_create(device, d->scene, &d->atlas, drawing_technique, d->threads, &error);
    if (!d->backdrop || !d->particles)
        fail_msg("%s", error.message);
    pool_init(&d->pool, device, &drawing_most, 1);
    kiln_buffer_init(&d->entries, device, drawing_most * sizeof(uint32_t), "entries");
}

void drawing_finish(struct drawing *d)
{
    kiln_buffer_finish(&d->entries);
    kiln_pool_finish(&d->pool);
    kiln_particles_destroy(&d->particles);
    kiln_backdrop_destroy(&d->backdrop);
    kiln_moment_finish(&d->moment);
    kiln_framebuffer_finish(&d->framebuffer);
    struct kiln_image *images[] = {&d->backdrop_color, &d->backdrop_depth, &d->depth, &d->color,
                                   &d->bloom};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        kiln_image_finish(images[i]);
    kiln_atlas_finish(&d->atlas);
    kiln_scene_destroy(&d->scene);
    kiln_threads_destroy(&d->threads);
}

struct kiln_particle drawing_particle(uint32_t serial, float3 position, float3 velocity)
{
    return (struct kiln_particle){
        .position_serial = {FLOAT_BITS(position.x), FLOAT_BITS(position.y), FLOAT_BITS(position.z),
                            serial},
        .velocity_birth = {FLOAT_BITS(velocity.x), FLOAT_BITS(velocity.y), FLOAT_BITS(velocity.z),
                           1u << KILN_BIRTH_STEP_SHIFT | KILN_PARTICLE_ALIVE}};
}

void drawing_place(struct drawing *d, const struct kiln_particle *particles, uint32_t count,
                   uint32_t step)
{
    struct kiln_error error = {0};
    struct kiln_particle *records = kiln_buffer_host(&d->pool.records, KILN_OVERWRITE, &error);
    uint32_t *entries = kiln_buffer_host(&d->entries, KILN_OVERWRITE, &error);
    assert_true(records && entries && count <= drawing_most);
    memset(records, 0, drawing_most * sizeof *records);
    memcpy(records, particles, count * sizeof *records);
    for (uint32_t i = 0; i < drawing_most; i++)
        entries[i] = KILN_ENTRY(0, i);
    if (!kiln_moment_fill(&d->moment, &d->pool, kiln_instant_at_step(step), true, &error))
        fail_msg("%s", error.message);
    assert_true(backdrop_draw_by_lamps(d->backdrop, &d->moment, &error));
}

void drawing_run(struct drawing *d, uint32_t count, float depth_m)
{
    struct kiln_error error = {0};
    uint32_t *entries = kiln_buffer_host(&d->entries, KILN_OVERWRITE, &error);
    assert_non_null(entries);
    for (uint32_t i = 0; i < count; i++)
        entries[i] = KILN_ENTRY(0, kiln_particles_nearest_first(d->particles) ? count - 1 - i : i);
    float *depth = kiln_image_host(&d->depth, KILN_OVERWRITE, &error);
    assert_non_null(depth);
    for (uint32_t i = 0; i < d->scene->width * d->scene->height; i++)
        depth[i] = depth_m;
    const struct kiln_particles_draw job = {.moment = &d->moment,
                                            .entries = &d->entries,
                                            .count = count,
                                            .view = &d->moment.view,
                                            .backdrop = kiln_backdrop_block(d->backdrop),
                                            .lighting = &d->lighting,
                                            .depth = &d->depth,
                                            .framebuffer = &d->framebuffer};
    if (!kiln_particles_run(d->particles, &job, &error))
        fail_msg("%s", error.message);
    assert_non_null(kiln_image_host(&d->color, KILN_READ, &error));
    assert_non_null(kiln_image_host(&d->bloom, KILN_READ, &error));
}

/* ---- vectors of the world in double precision ------------------------------------------------ */

vec vec_of(float3 v)
{
    return (vec){(double)v.x, (double)v.y, (double)v.z};
}

double vec_dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

vec vec_add(vec a, vec b, double t)
{
    return (vec){a.x + b.x * t, a.y + b.y * t, a.z + b.z * t};
}

vec vec_cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

vec vec_unit(vec a)
{
    double scale = 1 / sqrt(vec_dot(a, a));
    return (vec){a.x * scale, a.y * scale, a.z * scale};
}

vec drawing_axis(const struct drawing *d, int row)
{
    const float4 *r = &d->moment.view.world_to_view[row];
    return (vec){(double)r->x, (double)r->y, (double)r->z};
}

vec drawing_eye(const struct drawing *d)
{
    return (vec){(double)d->moment.view.eye.x, (double)d->moment.view.eye.y,
                 (double)d->moment.view.eye.z};
}

vec drawing_ray(const struct drawing *d, double x, double y)
{
    double w = (double)d->moment.view.frustum.z, h = (double)d->moment.view.frustum.w;
    vec ray = {0};
    ray = vec_add(ray, drawing_axis(d, 0), (2 * x / w - 1) * (double)d->moment.view.frustum.x);
    ray = vec_add(ray, drawing_axis(d, 1), (1 - 2 * y / h) * (double)d->moment.view.frustum.y);
    return vec_add(ray, drawing_axis(d, 2), -1);
}

vec drawing_project(const struct drawing *d, vec point)
{
    vec away = vec_add(point, drawing_eye(d), -1);
    double depth = -vec_dot(away, drawing_axis(d, 2));
    double x = vec_dot(away, drawing_axis(d, 0)) / depth / (double)d->moment.view.frustum.x;
    double y = vec_dot(away, drawing_axis(d, 1)) / depth / (double)d->moment.view.frustum.y;
    return (vec){(x + 1) / 2 * (double)d->moment.view.frustum.z,
                 (1 - y) / 2 * (double)d->moment.view.frustum.w, depth};
}

int drawing_run_rasters(const struct CMUnitTest *tests, size_t count, char **argv)
{
    static const struct {
        enum kiln_raster_technique technique;
        const char *name;
    } techniques[] = {
        {KILN_RASTER_TILED, "tiled"},
        {KILN_RASTER_CPU, "cpu"},
        {KILN_RASTER_GEOMETRY, "geometry"},
        {KILN_RASTER_INSTANCED, "instanced"},
    };
    int failed = 0;
    for (size_t i = 0; i < (test_is_full() ? 4 : 2); i++) {
        struct test_list list = {.count = 0};
        test_list_add(&list, tests, count);
        drawing_technique = techniques[i].technique;
        failed +=
            test_list_run(&list, techniques[i].name, 1, argv, test_device_open, test_device_close);
    }
    return failed;
}
