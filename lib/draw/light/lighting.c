/* This file computes the light of a moment that follows from its particles: it runs the light of
 * fire, the shadows of smoke and solids, and the shade on particles. It computes on the host, a few
 * hundred thousand additions a frame, in an order that does not depend on threads. */
#include "draw/light/lighting.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/light/firelight.h"
#include "draw/light/gas_light.h"
#include "draw/light/lamps.h"
#include "draw/light/lighting_gl.h"
#include "draw/moment/instances.h"
#include "shared/exact.h"

enum {
    GRIDS = 2,
    CELLS = KILN_SMOKE_GRID * KILN_SMOKE_GRID * KILN_SMOKE_GRID,
    COARSE = KILN_SMOKE_COARSE * KILN_SMOKE_COARSE * KILN_SMOKE_COARSE,
};

struct kiln_lighting_stage {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    uint64_t run;     /* runs done */
    bool fire, smoke; /* whether the scene has any */
    bool sun;         /* whether the sun ever shines */
    struct kiln_smoke puffs;
    struct kiln_gas_cells gas;
    struct kiln_smoke_shadow *shadow;
    float *depths;                      /* of both grids; then the extinction */
    float *other_depths;                /* of both grids, for each domain that is_shaded */
    struct kiln_lamp_smoke *lamp_smoke; /* NULL: not needed, here and below */
    struct kiln_solid_shadow *solids;
    struct kiln_sun_shade *shade;
    struct kiln_lamp_shade *lamp_shade;
    struct kiln_lamp_maps *lamp_maps;
    struct kiln_lamp_solids *lamp_solids;
    struct kiln_lighting_gl *gl;
};

/* Returns whether smoke that is not its own may dim the sun and the sky in a domain. */
static bool is_shaded(const struct kiln_scene *scene, uint32_t domain)
{
    if (!scene->gas[domain].enabled || !scene->gas[domain].look.lights)
        return false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        if (kiln_system_is_smoke(&scene->systems[i]))
            return true;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        if (i != domain && kiln_scene_gas_is_smoke(scene, i))
            return true;
    return false;
}

/* Returns the bytes of `other_depths`. */
static size_t other_bytes(const struct kiln_scene *scene)
{
    size_t count = 0;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        count += is_shaded(scene, i);
    return count * GRIDS * CELLS * sizeof(float);
}

/* Returns whether particles make light or shade, or are in it. */
static bool particles_count(const struct kiln_lighting_stage *stage)
{
    return stage->fire || stage->smoke || stage->solids || stage->shade || stage->lamp_shade;
}

static bool allocate(struct kiln_lighting_stage *stage, struct kiln_device *device,
                     enum kiln_simd simd)
{
    if (!particles_count(stage) && !stage->lamp_maps)
        return true;
    const struct kiln_lighting_textures textures = {
        .smoke = stage->smoke,
        .sun = stage->sun,
        .lamps = kiln_scene_has_lamps(stage->scene),
        .solids = stage->solids != NULL,
        .instances = kiln_instance_tile_edge(stage->scene) > 0,
        .lamp_maps = stage->lamp_maps != NULL,
        .lamp_solids = stage->lamp_solids != NULL,
    };
    if (device)
        stage->gl = kiln_lighting_gl_create(device, &textures);
    if (stage->smoke) {
        stage->shadow = kiln_smoke_shadow_create();
        stage->depths = malloc(((size_t)GRIDS * CELLS + COARSE) * sizeof *stage->depths);
        stage->lamp_smoke = kiln_lamp_smoke_create(simd);
    }
    const size_t others = stage->smoke ? other_bytes(stage->scene) : 0;
    stage->other_depths = others > 0 ? malloc(others) : NULL;
    if (others > 0 && !stage->other_depths)
        return false;
    return (stage->gl || !device) &&
           ((stage->shadow && stage->depths && stage->lamp_smoke) || !stage->smoke);
}

static bool create_shadows(struct kiln_lighting_stage *stage, const struct kiln_moment *moment,
                           struct kiln_error *error)
{
    const struct kiln_scene *scene = stage->scene;
    if (kiln_shape_features(scene).solids) {
        stage->solids = kiln_solid_shadow_create(scene, &moment->instances, error);
        if (!stage->solids)
            return false;
    }
    if (kiln_sun_shade_exists(scene)) {
        stage->shade = kiln_sun_shade_create(scene, error);
        if (!stage->shade)
            return false;
    }
    if (kiln_lamp_shade_exists(scene)) {
        stage->lamp_shade = kiln_lamp_shade_create(scene, error);
        if (!stage->lamp_shade)
            return false;
    }
    if (kiln_lamp_maps_exist(scene)) {
        stage->lamp_maps = kiln_lamp_maps_create(moment, stage->threads, error);
        if (!stage->lamp_maps)
            return false;
    }
    if (kiln_lamp_solids_exist(scene)) {
        stage->lamp_solids = kiln_lamp_solids_create(moment, stage->threads, error);
        return stage->lamp_solids != NULL;
    }
    return true;
}

struct kiln_lighting_stage *kiln_lighting_create(struct kiln_device *device,
                                                 const struct kiln_moment *moment,
                                                 struct kiln_threads *threads,
                                                 struct kiln_error *error)
{
    struct kiln_lighting_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the lighting");
        return NULL;
    }
    const struct kiln_scene *scene = moment->scene;
    *stage = (struct kiln_lighting_stage){.scene = scene,
                                          .threads = threads,
                                          .fire = kiln_scene_has_firelight(scene),
                                          .smoke = kiln_scene_has_smoke(scene),
                                          .sun = kiln_scene_has_sun(scene)};
    if (!create_shadows(stage, moment, error)) {
        kiln_lighting_destroy(&stage);
        return NULL;
    }
    if (!allocate(stage, device, moment->simd)) {
        kiln_error_no_memory(error, "the lighting");
        kiln_lighting_destroy(&stage);
        return NULL;
    }
    return stage;
}

/* Adds the memory of smoke, its grids and its maps around lamps. */
static void add_smoke(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    uint64_t slots = 0;
    bool puffs = false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        if (kiln_system_is_smoke(&scene->systems[i])) {
            slots += scene->systems[i].capacity;
            puffs = true;
        }
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, slots, sizeof(struct kiln_puff));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, 1,
                       kiln_smoke_shadow_bytes(puffs) +
                           ((size_t)GRIDS * CELLS + COARSE) * sizeof(float) + other_bytes(scene));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_LIGHTS, kiln_scene_shadow_lights(scene),
                       KILN_LAMP_SMOKE_MAP * sizeof(float));
}

void kiln_lighting_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    if (kiln_scene_has_smoke(scene))
        add_smoke(scene, footprint);
    kiln_gas_cells_footprint(scene, footprint);
    if (kiln_shape_features(scene).solids)
        kiln_solid_shadow_footprint(scene, footprint);
    if (kiln_sun_shade_exists(scene))
        kiln_sun_shade_footprint(scene, footprint);
    if (kiln_lamp_shade_exists(scene))
        kiln_lamp_shade_footprint(scene, footprint);
    if (kiln_lamp_maps_exist(scene))
        kiln_lamp_maps_footprint(scene, footprint);
    if (kiln_lamp_solids_exist(scene))
        kiln_lamp_solids_footprint(scene, footprint);
}

void kiln_lighting_destroy(struct kiln_lighting_stage **stage)
{
    if (!*stage)
        return;
    kiln_lighting_gl_destroy(&(*stage)->gl);
    kiln_solid_shadow_destroy(&(*stage)->solids);
    kiln_sun_shade_destroy(&(*stage)->shade);
    kiln_lamp_shade_destroy(&(*stage)->lamp_shade);
    kiln_lamp_maps_destroy(&(*stage)->lamp_maps);
    kiln_lamp_solids_destroy(&(*stage)->lamp_solids);
    free((*stage)->depths);
    free((*stage)->other_depths);
    kiln_smoke_finish(&(*stage)->puffs);
    kiln_gas_cells_finish(&(*stage)->gas);
    kiln_smoke_shadow_destroy(&(*stage)->shadow);
    kiln_lamp_smoke_destroy(&(*stage)->lamp_smoke);
    free(*stage);
    *stage = NULL;
}

/* Fills the grids of the smoke that dims gas and is not its own. */
static void shade_gas(struct kiln_lighting_stage *stage, struct kiln_lighting *lighting)
{
    const uint32_t count = stage->sun ? 2 : 1;
    float *sky = stage->other_depths;
    for (uint32_t i = 0; i < stage->scene->gas_count; i++) {
        if (!is_shaded(stage->scene, i))
            continue;
        float *const depths[GRIDS] = {sky, sky + CELLS};
        if (kiln_smoke_shadow_without(stage->shadow, i, stage->threads, depths, count))
            lighting->other_smoke[i] = (struct kiln_other_smoke){
                .sun_depth = stage->sun ? depths[1] : NULL, .sky_depth = depths[0]};
        sky += (size_t)GRIDS * CELLS;
    }
}

/* Fills the grids of smoke, and the maps of smoke around lamps. Where there is no sun, every
 * position is mapped outside of the sun's grid. */
static bool shade(struct kiln_lighting_stage *stage, const struct kiln_moment *moment,
                  struct kiln_lighting *lighting, struct kiln_error *error)
{
    struct kiln_smoke_grid grids[GRIDS] = {
        {.direction = {0.0f, 1.0f, 0.0f},
         .depth = stage->depths,
         .extinction = lighting->light_count ? stage->depths + (size_t)GRIDS * CELLS : NULL},
        {.direction = moment->sun.towards, .depth = stage->depths + CELLS},
    };
    if (!kiln_smoke_gather(&stage->puffs, moment, stage->threads, error))
        return false;
    stage->puffs.gas = &stage->gas;
    lighting->smoke = kiln_smoke_shadow_fill(stage->shadow, &stage->puffs, stage->threads, grids,
                                             stage->sun ? 2 : 1);
    if (!lighting->smoke)
        return true;
    for (int i = 0; i < 3; i++)
        lighting->sun_to_grid[i] = (float4){0.0f, 0.0f, 0.0f, -1.0f};
    lighting->sky_depth = grids[0].depth;
    memcpy(lighting->sky_to_grid, grids[0].world_to_grid, sizeof lighting->sky_to_grid);
    shade_gas(stage, lighting);
    lighting->lamp_smoke =
        kiln_lamp_smoke_run(stage->lamp_smoke, &grids[0], stage->threads, lighting->lights,
                            lighting->light_count, &lighting->lamp_smoke_count, error);
    if (!lighting->lamp_smoke)
        return false;
    if (!stage->sun)
        return true;
    lighting->sun_depth = grids[1].depth;
    memcpy(lighting->sun_to_grid, grids[1].world_to_grid, sizeof lighting->sun_to_grid);
    return true;
}

static bool cast_shadows(struct kiln_lighting_stage *stage, const struct kiln_moment *moment,
                         struct kiln_lighting *lighting, struct kiln_error *error)
{
    if (stage->solids &&
        !kiln_solid_shadow_run(stage->solids, moment, stage->threads, &lighting->solids, error))
        return false;
    lighting->slot_count = moment->pool->slot_count;
    if (stage->shade)
        lighting->sunlit = kiln_sun_shade_run(stage->shade, moment, stage->threads, error);
    if (stage->lamp_shade)
        lighting->lamplit = kiln_lamp_shade_run(
            stage->lamp_shade, moment, stage->threads, lighting->lights, lighting->light_count,
            lighting->lamp_maps, lighting->lamp_solids.texels, error);
    for (uint32_t i = 0; lighting->lamplit && i < lighting->light_count; i++)
        lighting->lights[i].casters.w |= (lighting->lights[i].casters.w & 1u) << 1;
    return (!stage->shade || lighting->sunlit) && (!stage->lamp_shade || lighting->lamplit);
}

/* Adds the light of the flames of gas, where there is room for it beside that of particles. */
static uint32_t add_gas_lights(struct kiln_lighting_stage *stage, uint32_t count,
                               struct kiln_lighting *lighting)
{
    const uint32_t most = stage->scene->backdrop.light_count + KILN_MAX_FIRE_LIGHTS;
    for (uint32_t i = 0; i < stage->gas.count; i++) {
        const uint32_t domain = stage->gas.blocks[i].domain;
        lighting->gas_lights[domain].first = count;
        if (count + KILN_GAS_LIGHTS <= most)
            count += kiln_gas_light_gather(&stage->gas.blocks[i], stage->threads,
                                           lighting->lights + count);
        lighting->gas_lights[domain].count = count - lighting->gas_lights[domain].first;
    }
    return count;
}

/* Gathers the lamps and the light of fire, and draws their shadow maps. */
static bool light_lamps(struct kiln_lighting_stage *stage, const struct kiln_moment *moment,
                        struct kiln_lighting *lighting, struct kiln_error *error)
{
    uint32_t count = kiln_lamps_fill(moment, lighting->lights);
    if (stage->fire)
        count += kiln_firelight_gather(moment, stage->threads, lighting->lights + count);
    count = add_gas_lights(stage, count, lighting);
    lighting->light_count = count;
    if (stage->lamp_maps) {
        lighting->lamp_maps = kiln_lamp_maps_run(stage->lamp_maps, moment, lighting->lights, count,
                                                 &lighting->lamp_map_count, error);
        if (!lighting->lamp_maps)
            return false;
        lighting->lamp_map_changes = kiln_lamp_maps_changes(stage->lamp_maps);
    }
    if (stage->lamp_solids && !kiln_lamp_solids_run(stage->lamp_solids, moment, lighting->lights,
                                                    count, &lighting->lamp_solids, error))
        return false;
    kiln_lamps_find_casters(moment, lighting->lights, count);
    return true;
}

bool kiln_lighting_reads_particles(const struct kiln_lighting_stage *stage)
{
    return particles_count(stage);
}

bool kiln_lighting_run(struct kiln_lighting_stage *stage, const struct kiln_moment *moment,
                       const struct kiln_pool *gas, struct kiln_lighting *lighting,
                       struct kiln_error *error)
{
    *lighting = (struct kiln_lighting){.run = ++stage->run, .gl = stage->gl};
    if (!kiln_gas_cells_gather(&stage->gas, moment, gas, stage->threads, error) ||
        !light_lamps(stage, moment, lighting, error))
        return false;
    if (!particles_count(stage))
        return true;
    return cast_shadows(stage, moment, lighting, error) &&
           (!stage->smoke || shade(stage, moment, lighting, error));
}
