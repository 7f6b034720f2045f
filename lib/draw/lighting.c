/* Computed on the host: a few hundred thousand additions a frame, in a fixed order, so that the
 * picture does not depend on threads. */
#include "draw/lighting.h"

#include "base/error.h"
#include "draw/firelight.h"
#include "draw/looks.h"
#include "draw/smoke_shadow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SUN, SKY, GRIDS };

struct kiln_lighting_stage {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    bool fire, smoke; /* whether the scene has any */
    bool table_valid;
    float4 *table;          /* looks */
    float *scratch, *depth; /* of a grid */
    GLuint textures[GRIDS];
};

static bool allocate(struct kiln_lighting_stage *stage)
{
    const size_t cells = (size_t)KILN_SMOKE_GRID * KILN_SMOKE_GRID * KILN_SMOKE_GRID;
    if (stage->fire || stage->smoke)
        stage->table = calloc((size_t)KILN_LOOK_TEXELS, sizeof *stage->table);
    if (stage->smoke) {
        stage->scratch = malloc(kiln_smoke_scratch_floats() * sizeof *stage->scratch);
        stage->depth = malloc(cells * sizeof *stage->depth);
    }
    return (stage->table || !(stage->fire || stage->smoke)) &&
           ((stage->scratch && stage->depth) || !stage->smoke);
}

static void make_textures(struct kiln_lighting_stage *stage)
{
    static const char *const labels[GRIDS] = {"smoke towards the sun", "smoke towards the sky"};
    glGenTextures(GRIDS, stage->textures);
    for (int i = 0; i < GRIDS; i++) {
        glActiveTexture(GL_TEXTURE0 + KILN_UNIT_SMOKE_SUN + (GLenum)i);
        glBindTexture(GL_TEXTURE_3D, stage->textures[i]);
        glTexImage3D(GL_TEXTURE_3D, 0, GL_R32F, KILN_SMOKE_GRID, KILN_SMOKE_GRID, KILN_SMOKE_GRID,
                     0, GL_RED, GL_FLOAT, NULL);
        glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
        kiln_device_label(stage->device, GL_TEXTURE, stage->textures[i], labels[i]);
    }
}

struct kiln_lighting_stage *kiln_lighting_create(struct kiln_device *device,
                                                 const struct kiln_scene *scene,
                                                 struct kiln_error *error)
{
    struct kiln_lighting_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "lighting: out of memory");
        return NULL;
    }
    *stage = (struct kiln_lighting_stage){.device = device,
                                          .scene = scene,
                                          .fire = kiln_firelight_exists(scene),
                                          .smoke = kiln_smoke_exists(scene)};
    if (!allocate(stage)) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "lighting: out of memory");
        kiln_lighting_destroy(&stage);
        return NULL;
    }
    if (stage->smoke)
        make_textures(stage);
    return stage;
}

void kiln_lighting_destroy(struct kiln_lighting_stage **stage)
{
    if (!*stage)
        return;
    glDeleteTextures(GRIDS, (*stage)->textures); /* 0 is ignored */
    free((*stage)->table);
    free((*stage)->scratch);
    free((*stage)->depth);
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

static bool fill_grid(struct kiln_lighting_stage *stage, const struct kiln_pool *pool,
                      const struct kiln_particle *records, const struct kiln_view *view,
                      float3 direction, int which, float4 rows[3])
{
    struct kiln_smoke_grid grid = {.depth = stage->depth};
    if (!kiln_smoke_grid_fill(&grid, stage->scene, pool, records, view, stage->table, direction,
                              stage->scratch))
        return false;
    glActiveTexture(GL_TEXTURE0 + KILN_UNIT_SMOKE_SUN + (GLenum)which);
    glBindTexture(GL_TEXTURE_3D, stage->textures[which]);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, KILN_SMOKE_GRID, KILN_SMOKE_GRID, KILN_SMOKE_GRID,
                    GL_RED, GL_FLOAT, grid.depth);
    memcpy(rows, grid.world_to_grid, sizeof grid.world_to_grid);
    return true;
}

bool kiln_lighting_run(struct kiln_lighting_stage *stage, struct kiln_pool *pool,
                       const struct kiln_view *view, struct kiln_lighting *lighting,
                       struct kiln_error *error)
{
    *lighting = (struct kiln_lighting){.smoke = false};
    if (!stage->fire && !stage->smoke)
        return true;
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    if (!records)
        return false;
    if (!stage->table_valid || kiln_looks_vary(stage->scene))
        kiln_looks_sample(stage->scene, view->clock.x, stage->table);
    stage->table_valid = true;
    if (stage->fire)
        lighting->fire_count =
            kiln_firelight_gather(stage->scene, pool, records, view, stage->table, lighting->fire);
    if (stage->smoke)
        lighting->smoke =
            fill_grid(stage, pool, records, view, sun_direction(stage->scene, view->clock.x), SUN,
                      lighting->sun_to_grid) &&
            fill_grid(stage, pool, records, view, (float3){0.0f, 1.0f, 0.0f}, SKY,
                      lighting->sky_to_grid);
    return kiln_device_check(stage->device, "lighting", error);
}
