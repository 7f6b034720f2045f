/* This file fills a drawn moment: camera, sun, looks, posed meshes, shapes and particles. It fills
 * them in this order, in which each part needs only the parts before it. */
#include "draw/moment/moment.h"

#include <stdlib.h>

#include "base/error.h"
#include "draw/moment/moment_gl.h"

bool kiln_moment_init(struct kiln_moment *moment, struct kiln_device *device,
                      const struct kiln_scene *scene, const struct kiln_atlas *atlas,
                      struct kiln_error *error)
{
    *moment = (struct kiln_moment){.scene = scene};
    if (!kiln_simd_choose(&moment->simd, error) || !kiln_meshes_init(&moment->meshes, scene, error))
        goto fail;
    if (!kiln_instances_init(&moment->instances, scene, error))
        goto fail;
    moment->look_rows = kiln_look_rows(scene);
    moment->look_table =
        calloc((size_t)moment->look_rows * KILN_LOOK_SAMPLES, sizeof *moment->look_table);
    moment->look_programs = calloc(KILN_MAX_SYSTEMS, sizeof *moment->look_programs);
    if (moment->look_programs)
        kiln_look_programs_fill(scene, moment->look_programs);
    if (moment->look_programs && atlas)
        kiln_looks_fill(scene, atlas, moment->look_programs, moment->looks);
    if (device)
        moment->gl = kiln_moment_gl_create(device);
    if (moment->look_table && moment->look_programs && (moment->gl || !device))
        return true;
    kiln_error_no_memory(error, "the looks");

fail:
    kiln_moment_finish(moment);
    return false;
}

void kiln_moment_finish(struct kiln_moment *moment)
{
    kiln_moment_gl_destroy(&moment->gl);
    kiln_instances_finish(&moment->instances);
    kiln_meshes_finish(&moment->meshes);
    free(moment->look_table);
    free(moment->look_programs);
    moment->look_table = NULL;
    moment->look_programs = NULL;
}

void kiln_moment_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_moment *m = NULL;
    kiln_meshes_footprint(scene, footprint);
    kiln_instances_footprint(scene, footprint);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_TEXTURES,
                       (uint64_t)kiln_look_rows(scene) * KILN_LOOK_SAMPLES, sizeof *m->look_table);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_TEXTURES, kiln_sources_sizes(scene).texels,
                       sizeof(uint4));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_TEXTURES, KILN_MAX_SYSTEMS,
                       sizeof *m->look_programs);
}

/* Makes the pool's records and spins available on the host. */
static bool read_particles(struct kiln_moment *moment, struct kiln_error *error)
{
    struct kiln_pool *pool = moment->pool;
    moment->records = kiln_buffer_host(&pool->records, KILN_READ, error);
    if (!moment->records)
        return false;
    if (pool->spins.size > 0)
        moment->spins = kiln_buffer_host(&pool->spins, KILN_READ, error);
    return moment->spins || pool->spins.size == 0;
}

void kiln_moment_set_view(struct kiln_moment *moment, struct kiln_instant instant)
{
    moment->view = kiln_view_compute(moment->scene, instant);
}

void kiln_moment_set_time(struct kiln_moment *moment, struct kiln_instant instant)
{
    const struct kiln_scene *scene = moment->scene;
    kiln_moment_set_view(moment, instant);
    const float time_s = moment->view.clock.x;
    moment->sun = kiln_sun_frame_at(scene, time_s);
    if (moment->look_changes == 0 || kiln_looks_vary(scene)) {
        kiln_looks_sample(scene, time_s, moment->look_table);
        kiln_look_programs_sample(scene, moment->look_programs, time_s, moment->look_table);
        moment->look_changes++;
    }
    kiln_meshes_pose(&moment->meshes, time_s);
    kiln_shapes_fill(scene, moment->meshes.loaded, &moment->sun, time_s, &moment->shapes);
    kiln_shapes_see(&moment->shapes, moment->sun.towards, moment->from_sun);
}

bool kiln_moment_set_particles(struct kiln_moment *moment, struct kiln_pool *pool, bool on_host,
                               struct kiln_error *error)
{
    moment->pool = pool;
    moment->records = NULL;
    moment->spins = NULL;
    if (moment->meshes.painted && pool)
        kiln_painted_update(moment->meshes.painted, pool);
    return !on_host || !pool || read_particles(moment, error);
}

bool kiln_moment_fill(struct kiln_moment *moment, struct kiln_pool *pool,
                      struct kiln_instant instant, bool on_host, struct kiln_error *error)
{
    kiln_moment_set_time(moment, instant);
    return kiln_moment_set_particles(moment, pool, on_host, error);
}
