/* This file creates and runs the stage that draws particles, by one of four techniques. */
#include "draw/sprites/particles.h"

#include <stdlib.h>

#include "base/error.h"
#include "draw/moment/draw_blocks.h"
#include "draw/sprites/gas_before.h"
#include "draw/sprites/particles_cpu.h"
#include "draw/sprites/particles_geometry.h"
#include "draw/sprites/particles_tiled.h"
#include "draw/volume/volume.h"

struct kiln_particles_stage {
    enum kiln_raster_technique technique;
    struct kiln_draw_blocks blocks; /* for techniques in GL */
    struct kiln_device *device;
    const struct kiln_scene *scene;
    struct kiln_atlas *atlas;
    struct kiln_geometry *geometry; /* NULL for `cpu` */
    struct kiln_gas_before *gas;    /* NULL for `cpu`, and without gas */
    struct kiln_tiled *tiled;       /* NULL unless `tiled` */
    struct kiln_raster_cpu *tiles;  /* NULL unless `cpu` */
};

struct kiln_particles_stage *
kiln_particles_create(struct kiln_device *device, const struct kiln_scene *scene,
                      struct kiln_atlas *atlas, enum kiln_raster_technique technique,
                      struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_particles_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "particles");
        return NULL;
    }
    *stage = (struct kiln_particles_stage){
        .technique = technique, .device = device, .scene = scene, .atlas = atlas};
    kiln_draw_blocks_init(&stage->blocks, device);
    if (technique == KILN_RASTER_CPU)
        stage->tiles = kiln_raster_cpu_create(scene, atlas, threads, error);
    else if (kiln_atlas_send(atlas, error))
        stage->geometry = kiln_geometry_create(device, scene, atlas, technique, error);
    if (technique == KILN_RASTER_TILED && stage->geometry)
        stage->tiled = kiln_tiled_create(device, scene, stage->geometry, error);
    const bool gas = stage->geometry && kiln_volume_domains(scene) > 0;
    if (gas)
        stage->gas = kiln_gas_before_create(device, error);
    if ((!stage->geometry && !stage->tiles) || (technique == KILN_RASTER_TILED && !stage->tiled) ||
        (gas && !stage->gas))
        kiln_particles_destroy(&stage);
    return stage;
}

void kiln_particles_destroy(struct kiln_particles_stage **stage)
{
    if (!*stage)
        return;
    kiln_tiled_destroy(&(*stage)->tiled);
    kiln_gas_before_destroy(&(*stage)->gas);
    kiln_draw_blocks_finish(&(*stage)->blocks);
    kiln_geometry_destroy(&(*stage)->geometry);
    kiln_raster_cpu_destroy(&(*stage)->tiles);
    free(*stage);
    *stage = NULL;
}

bool kiln_particles_nearest_first(const struct kiln_particles_stage *stage)
{
    /* `tiled` draws from front to back, so that it can stop where nearer particles hide the rest.
     * For post.compose: oit it leaves the drawing to kiln_geometry, which draws back to front. */
    return stage->technique == KILN_RASTER_TILED && stage->scene->post.compose != KILN_COMPOSE_OIT;
}

bool kiln_particles_splits(const struct kiln_particles_stage *stage,
                           const struct kiln_particles_draw *draw, uint64_t systems)
{
    return stage->technique == KILN_RASTER_CPU && kiln_raster_cpu_splits(draw, systems);
}

bool kiln_particles_adds_apart(const struct kiln_particles_stage *stage,
                               const struct kiln_particles_draw *draw)
{
    return stage->technique == KILN_RASTER_CPU && !draw->sum_alpha && !draw->fire_covers &&
           !draw->by_fragment;
}

/* Binds the uniform blocks of a pass, and its gas. */
static bool bind_blocks(struct kiln_particles_stage *stage, const struct kiln_particles_draw *draw,
                        struct kiln_error *error)
{
    return kiln_draw_blocks_bind(&stage->blocks, draw->view, draw->backdrop, error) &&
           (!stage->gas || kiln_gas_before_bind(stage->gas, draw->gas, error));
}

bool kiln_particles_run(struct kiln_particles_stage *stage, const struct kiln_particles_draw *draw,
                        struct kiln_error *error)
{
    switch (stage->technique) {
    case KILN_RASTER_GEOMETRY:
    case KILN_RASTER_INSTANCED:
        return bind_blocks(stage, draw, error) && kiln_geometry_run(stage->geometry, draw, error);
    case KILN_RASTER_TILED:
        if (!bind_blocks(stage, draw, error))
            return false;
        return draw->by_fragment ? kiln_geometry_run(stage->geometry, draw, error)
                                 : kiln_tiled_run(stage->tiled, draw, error);
    case KILN_RASTER_CPU:
        return kiln_raster_cpu_run(stage->tiles, draw, error);
    }
    return false;
}
