/* Computed on the host: a few hundred thousand additions a frame, in an order that does not depend
 * on threads. */
#include "draw/light/lighting.h"

#include "base/error.h"
#include "draw/light/firelight.h"
#include "draw/light/lighting_gl.h"
#include "draw/light/living_blocks.h"
#include "draw/moment/looks.h"
#include "shared/exact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GRIDS = 2, CELLS = KILN_SMOKE_GRID * KILN_SMOKE_GRID * KILN_SMOKE_GRID };

struct kiln_lighting_stage {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    uint64_t run;     /* runs done */
    bool fire, smoke; /* whether the scene has any */
    bool sun;         /* whether it shines ever */
    bool table_valid;
    float4 *table; /* looks */
    const struct kiln_living_loops *loops;
    struct kiln_smoke puffs;
    struct kiln_smoke_shadow *shadow;
    float *depths;                      /* of the grids */
    struct kiln_sphere_shadow *spheres; /* NULL: there are none, here and below */
    struct kiln_sun_shade *shade;
    struct kiln_lighting_gl *gl;
};

static bool any_light(const struct kiln_lighting_stage *stage)
{
    return stage->fire || stage->smoke || stage->spheres || stage->shade;
}

static bool allocate(struct kiln_lighting_stage *stage, struct kiln_device *device)
{
    if (!any_light(stage))
        return true;
    stage->table = calloc((size_t)KILN_LOOK_TEXELS, sizeof *stage->table);
    if (device)
        stage->gl = kiln_lighting_gl_create(device);
    if (stage->smoke) {
        stage->shadow = kiln_smoke_shadow_create();
        stage->depths = malloc((size_t)GRIDS * CELLS * sizeof *stage->depths);
    }
    return stage->table && (stage->gl || !device) &&
           ((stage->shadow && stage->depths) || !stage->smoke);
}

static bool sun_exists(const struct kiln_scene *scene)
{
    const struct kiln_value3 *color = &scene->backdrop.sun_color;
    return kiln_scene_value_max(scene, &color->x) > 0.0f ||
           kiln_scene_value_max(scene, &color->y) > 0.0f ||
           kiln_scene_value_max(scene, &color->z) > 0.0f;
}

static bool create_shadows(struct kiln_lighting_stage *stage, struct kiln_error *error)
{
    const struct kiln_scene *scene = stage->scene;
    if (kiln_shape_features(scene).spheres) {
        stage->spheres = kiln_sphere_shadow_create(scene, error);
        if (!stage->spheres)
            return false;
    }
    if (kiln_sun_shade_exists(scene)) {
        stage->shade = kiln_sun_shade_create(scene, error);
        if (!stage->shade)
            return false;
    }
    return true;
}

struct kiln_lighting_stage *kiln_lighting_create(struct kiln_device *device,
                                                 const struct kiln_scene *scene,
                                                 struct kiln_threads *threads,
                                                 struct kiln_error *error)
{
    struct kiln_lighting_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "lighting: out of memory");
        return NULL;
    }
    *stage = (struct kiln_lighting_stage){.scene = scene,
                                          .threads = threads,
                                          .fire = kiln_firelight_exists(scene),
                                          .smoke = kiln_smoke_exists(scene),
                                          .sun = sun_exists(scene)};
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error) || !create_shadows(stage, error)) {
        kiln_lighting_destroy(&stage);
        return NULL;
    }
    stage->loops = KILN_SIMD_PICK(kiln_living_loops, simd);
    if (!allocate(stage, device)) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "lighting: out of memory");
        kiln_lighting_destroy(&stage);
        return NULL;
    }
    return stage;
}

void kiln_lighting_destroy(struct kiln_lighting_stage **stage)
{
    if (!*stage)
        return;
    kiln_lighting_gl_destroy(&(*stage)->gl);
    kiln_sphere_shadow_destroy(&(*stage)->spheres);
    kiln_sun_shade_destroy(&(*stage)->shade);
    free((*stage)->table);
    free((*stage)->depths);
    kiln_smoke_finish(&(*stage)->puffs);
    kiln_smoke_shadow_destroy(&(*stage)->shadow);
    free(*stage);
    *stage = NULL;
}

static float3 sun_direction(const struct kiln_scene *scene, float time_s)
{
    float3 v = kiln_scene_value3(scene, &scene->backdrop.sun_direction, time_s);
    float length = sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
    if (!(length > 0.0f))
        return (float3){0.0f, 1.0f, 0.0f};
    return (float3){v.x / length, v.y / length, v.z / length};
}

/* Where there is no sun, every place lies beside its grid. */
static bool shade(struct kiln_lighting_stage *stage, const struct kiln_living_moment *moment,
                  struct kiln_lighting *lighting, struct kiln_error *error)
{
    struct kiln_smoke_grid grids[GRIDS] = {
        {.direction = {0.0f, 1.0f, 0.0f}, .depth = stage->depths},
        {.direction = sun_direction(stage->scene, moment->view->clock.x),
         .depth = stage->depths + CELLS},
    };
    if (!kiln_smoke_gather(&stage->puffs, moment, stage->threads, error))
        return false;
    lighting->smoke = kiln_smoke_shadow_fill(stage->shadow, &stage->puffs, stage->threads, grids,
                                             stage->sun ? 2 : 1);
    if (!lighting->smoke)
        return true;
    for (int i = 0; i < 3; i++)
        lighting->sun_to_grid[i] = (float4){0.0f, 0.0f, 0.0f, -1.0f};
    lighting->sky_depth = grids[0].depth;
    memcpy(lighting->sky_to_grid, grids[0].world_to_grid, sizeof lighting->sky_to_grid);
    if (!stage->sun)
        return true;
    lighting->sun_depth = grids[1].depth;
    memcpy(lighting->sun_to_grid, grids[1].world_to_grid, sizeof lighting->sun_to_grid);
    return true;
}

static bool cast_shadows(struct kiln_lighting_stage *stage, const struct kiln_living_moment *moment,
                         struct kiln_lighting *lighting, struct kiln_error *error)
{
    if (stage->spheres &&
        !kiln_sphere_shadow_run(stage->spheres, moment, stage->threads, &lighting->spheres, error))
        return false;
    lighting->slot_count = moment->pool->slot_count;
    if (stage->shade)
        lighting->sunlit = kiln_sun_shade_run(stage->shade, moment, stage->threads, error);
    return !stage->shade || lighting->sunlit;
}

void kiln_lighting_use_meshes(struct kiln_lighting_stage *stage, struct kiln_meshes *meshes)
{
    if (stage->shade)
        kiln_sun_shade_use_meshes(stage->shade, meshes);
}

/* Do shadows follow from how collisions have turned particles? */
static bool asks_for_spins(const struct kiln_lighting_stage *stage, const struct kiln_pool *pool)
{
    for (uint32_t i = 0; stage->spheres && i < stage->scene->system_count; i++) {
        const struct kiln_look *look = &stage->scene->systems[i].look;
        if (pool->systems[i].spins && look->shape == KILN_SHAPE_MESH &&
            look->mesh.orient == KILN_ORIENT_SPIN)
            return pool->spins.size > 0;
    }
    return false;
}

bool kiln_lighting_run(struct kiln_lighting_stage *stage, struct kiln_pool *pool,
                       const struct kiln_view *view, struct kiln_lighting *lighting,
                       struct kiln_error *error)
{
    *lighting = (struct kiln_lighting){.run = ++stage->run, .gl = stage->gl};
    if (!any_light(stage))
        return true;
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    if (!records)
        return false;
    if (!stage->table_valid || kiln_looks_vary(stage->scene))
        kiln_looks_sample(stage->scene, view->clock.x, stage->table);
    stage->table_valid = true;
    const struct kiln_spin *spins = NULL;
    if (asks_for_spins(stage, pool)) {
        spins = kiln_buffer_host(&pool->spins, KILN_READ, error);
        if (!spins)
            return false;
    }
    const struct kiln_living_moment moment = {stage->scene, pool,         records, view,
                                              stage->table, stage->loops, spins};
    if (!cast_shadows(stage, &moment, lighting, error))
        return false;
    if (stage->fire)
        lighting->fire_count = kiln_firelight_gather(&moment, stage->threads, lighting->fire);
    return !stage->smoke || shade(stage, &moment, lighting, error);
}
