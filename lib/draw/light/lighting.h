/* This header declares the lighting stage, which runs first in stage 4. It computes the light of a
 * frame that follows from its particles and gas: the light that fire sheds, and the shadows of
 * smoke and solid particles. The stages that draw the backdrop and the particles read the result.
 */
#ifndef KILN_DRAW_LIGHT_LIGHTING_H
#define KILN_DRAW_LIGHT_LIGHTING_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/light/lamp_map.h"
#include "draw/light/lamp_shade.h"
#include "draw/light/lamp_smoke.h"
#include "draw/light/lamp_solids.h"
#include "draw/light/smoke_shadow.h"
#include "draw/light/solid_shadow.h"
#include "draw/light/sun_shade.h"
#include "draw/moment/appearance.h"

/* Holds the light of one frame on the host; kiln_lighting_bind sends it to GL. The stage owns the
 * arrays, which are valid until its next run. */
struct kiln_lighting {
    uint64_t run;         /* number of the run, from 1 */
    uint32_t light_count; /* lamps, then the light of fire */
    struct kiln_draw_light lights[KILN_MOST_LAMPS];
    struct kiln_light_range {
        uint32_t first, count;
    } gas_lights[KILN_MAX_GAS]; /* the lights of the flames of each domain, among `lights` */
    const uint32_t *lamp_maps;  /* shadow maps of the first lamp_map_count of kiln_lamp_maps_run; */
    uint32_t lamp_map_count;    /* NULL: there are none */
    uint64_t lamp_map_changes;  /* a number that grows when a map changes */
    struct kiln_lamp_solid_maps lamp_solids; /* shadow maps of solid particles */
    bool smoke;                              /* there is smoke, and its grids are set */
    float4 sun_to_grid[3], sky_to_grid[3];   /* world positions to 0..1 in the grids */
    const float *sun_depth, *sky_depth; /* optical depth in the grids, KILN_SMOKE_GRID cubed, rows
                                         * along x; sun_depth is NULL where there is no sun */
    /* Holds the optical depths of all smoke but the gas of a domain, which dims that gas, in the
     * same grids; NULL: there is none */
    struct kiln_other_smoke {
        const float *sun_depth, *sky_depth;
    } other_smoke[KILN_MAX_GAS];
    const float *lamp_smoke; /* maps of the first lamp_smoke_count of kiln_lamp_smoke_run; NULL:
                              * there are none */
    uint32_t lamp_smoke_count;
    struct kiln_solid_bins solids; /* lists of opaque particles */
    const float *sunlit; /* by slot: the part of the sun that a lit particle sees past the backdrop,
                          * smoke left out. NULL: the whole sun */
    const uint32_t *lamplit; /* planes of kiln_lamp_shade_run, the parts of lights that lit
                              * particles see; NULL: the whole lights */
    uint32_t slot_count;
    struct kiln_lighting_gl *gl; /* textures of this light (lighting_gl.h); NULL: not needed */
};

struct kiln_lighting_stage;

/* Creates the stage; NULL with an error. Moment and threads must outlive it. device may be NULL if
 * nothing is drawn in GL. */
struct kiln_lighting_stage *kiln_lighting_create(struct kiln_device *device,
                                                 const struct kiln_moment *moment,
                                                 struct kiln_threads *threads,
                                                 struct kiln_error *error);

/* Adds the memory of the stage on the host. */
void kiln_lighting_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_lighting_destroy(struct kiln_lighting_stage **stage);

/* Returns whether the stage reads particles on the host, so that moments must have them there. */
bool kiln_lighting_reads_particles(const struct kiln_lighting_stage *stage);

/* Computes the light of a moment's particles and gas. gas: the pool that has the gas, which may be
 * another one than the moment's; NULL: there is none. */
bool kiln_lighting_run(struct kiln_lighting_stage *stage, const struct kiln_moment *moment,
                       const struct kiln_pool *gas, struct kiln_lighting *lighting,
                       struct kiln_error *error);

#endif
