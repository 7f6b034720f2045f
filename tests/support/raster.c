/* Makes the input of the raster techniques (atlas, target images, particles and light), and draws
 * with them: with `cpu` all on the host, so that tests of it need no GL. */
#include "support/raster.h"

#include <stdlib.h>

#include "support/cmocka.h"
#include "support/pools.h"

float raster_random(float low, float high)
{
    return low + (high - low) * (float)(rand() % 10001) / 10000.0f;
}

struct kiln_particle raster_random_particle(float x, float y, float z, uint32_t serial,
                                            uint32_t steps)
{
    float velocity[3];
    for (int i = 0; i < 3; i++)
        velocity[i] = raster_random(-2.0f, 2.0f);
    return (struct kiln_particle){
        {FLOAT_BITS(x), FLOAT_BITS(y), FLOAT_BITS(z), serial},
        {FLOAT_BITS(velocity[0]), FLOAT_BITS(velocity[1]), FLOAT_BITS(velocity[2]),
         (1u + (uint32_t)rand() % steps) << KILN_BIRTH_STEP_SHIFT | KILN_PARTICLE_ALIVE}};
}

void raster_open(struct raster *r, struct kiln_scene *scene, uint32_t columns, uint32_t rows,
                 uint32_t step)
{
    raster_open_on(r, NULL, KILN_RASTER_CPU, scene, columns, rows, step);
}

void raster_open_on(struct raster *r, struct kiln_device *device,
                    enum kiln_raster_technique technique, struct kiln_scene *scene,
                    uint32_t columns, uint32_t rows, uint32_t step)
{
    struct kiln_error error = {0};
    *r = (struct raster){.device = device,
                         .technique = technique,
                         .scene = scene,
                         .threads = kiln_threads_create(2)};
    struct kiln_atlas_request requests[KILN_MAX_SYSTEMS];
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        requests[i] = (struct kiln_atlas_request){.sources = look->atlas,
                                                  .count = look->atlas_count,
                                                  .columns = columns,
                                                  .rows = rows,
                                                  .motion = look->motion};
    }
    if (!kiln_atlas_init(&r->atlas, device, requests, scene->system_count, NULL, r->threads,
                         &error))
        fail_msg("%s", error.message);
    if (!kiln_moment_init(&r->moment, device, scene, &r->atlas, &error) ||
        !kiln_moment_fill(&r->moment, NULL, kiln_instant_at_step(step), false, &error))
        fail_msg("%s", error.message);
    r->light = (struct kiln_draw_backdrop){.sky_top = {0.2f, 0.3f, 0.5f, 0.0f},
                                           .sky_horizon = {0.3f, 0.3f, 0.3f, 0.0f}};
}

void raster_add_lamps(struct raster *r, uint32_t lamps)
{
    r->light.sun_direction = (float4){0.6f, 0.8f, 0.0f, 0.0f};
    r->light.sun_color = (float4){3.0f, 2.8f, 2.5f, 0.0f};
    r->light.counts.y = lamps;
    for (uint32_t i = 0; i < lamps; i++)
        r->light.lights[i] = (struct kiln_draw_light){
            .position_radius2 = {(float)i - (float)(lamps / 2), 1.0f, 0.5f, 0.01f},
            .color = {0.3f, 0.2f, 0.1f, 0.1f}};
}

float *raster_add_targets(struct raster *r)
{
    struct kiln_error error = {0};
    const uint32_t width = r->scene->width, height = r->scene->height;
    kiln_image_init(&r->depth, r->device, width, height, GL_R32F, "depth");
    kiln_image_init(&r->color, r->device, width, height, GL_RGBA32F, "color");
    kiln_image_init(&r->bloom, r->device, width, height, GL_RGBA32F, "bloom");
    kiln_image_init(&r->added, r->device, width, height, GL_RGBA32F, "added");
    struct kiln_image *targets[] = {&r->color, &r->bloom};
    assert_true(kiln_framebuffer_init(&r->framebuffer, r->device, targets, 2, &error));
    float *depth = kiln_image_host(&r->depth, KILN_OVERWRITE, &error);
    assert_non_null(depth);
    for (uint32_t i = 0; i < width * height; i++)
        depth[i] = 1e9f;
    return depth;
}

void raster_add_particles(struct raster *r, uint32_t capacity, uint32_t count,
                          struct kiln_particle **records, uint32_t **entries)
{
    struct kiln_error error = {0};
    r->count = count;
    pool_init_even(&r->pool, r->device, r->scene, capacity);
    kiln_buffer_init(&r->entries, r->device, count * sizeof(uint32_t), "entries");
    *records = kiln_buffer_host(&r->pool.records, KILN_OVERWRITE, &error);
    *entries = kiln_buffer_host(&r->entries, KILN_OVERWRITE, &error);
    assert_true(*records && *entries);
}

struct kiln_particles_draw raster_job(struct raster *r)
{
    static const struct kiln_lighting lighting = {.smoke = false};
    struct kiln_error error = {0};
    r->moment.pool = &r->pool;
    r->moment.records = kiln_buffer_host(&r->pool.records, KILN_READ, &error);
    assert_non_null(r->moment.records);
    return (struct kiln_particles_draw){.moment = &r->moment,
                                        .entries = &r->entries,
                                        .count = r->count,
                                        .view = &r->moment.view,
                                        .backdrop = &r->light,
                                        .lighting = &lighting,
                                        .depth = &r->depth,
                                        .framebuffer = &r->framebuffer};
}

void raster_draw(struct raster *r, const struct kiln_particles_draw *job, uint32_t thread_count)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(thread_count);
    struct kiln_particles_stage *stage = r->stage;
    if (!stage)
        stage =
            kiln_particles_create(r->device, r->scene, &r->atlas, r->technique, threads, &error);
    if (!stage || !kiln_particles_run(stage, job, &error))
        fail_msg("%s", error.message);
    if (r->technique != KILN_RASTER_CPU) /* keeps its programs */
        r->stage = stage;
    else
        kiln_particles_destroy(&stage);
    kiln_threads_destroy(&threads);
}

void raster_close(struct raster *r)
{
    kiln_particles_destroy(&r->stage);
    kiln_moment_finish(&r->moment);
    kiln_buffer_finish(&r->entries);
    kiln_pool_finish(&r->pool);
    kiln_framebuffer_finish(&r->framebuffer);
    struct kiln_image *images[] = {&r->depth, &r->color, &r->bloom, &r->added};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        kiln_image_finish(images[i]);
    kiln_atlas_finish(&r->atlas);
    kiln_threads_destroy(&r->threads);
    kiln_scene_destroy(&r->scene);
}
