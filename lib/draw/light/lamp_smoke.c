/* This file places the maps of the smoke around lamps, whose layers lie between the lamp and the
 * farthest corner of the smoke's grid. Threads fill rows of the maps independently. */
#include "draw/light/lamp_smoke.h"

#include <math.h>
#include <stdlib.h>

#include "base/error.h"
#include "shared/exact.h"

enum { ROWS = KILN_LAMP_SMOKE_HEIGHT, GRAIN = 4 };

struct kiln_lamp_smoke {
    kiln_lamp_smoke_fill *fill;
    float *maps;
    uint32_t room; /* maps that there is memory for */
    struct kiln_lamp_smoke_job jobs[KILN_MOST_LAMPS];
};

struct kiln_lamp_smoke *kiln_lamp_smoke_create(enum kiln_simd simd)
{
    struct kiln_lamp_smoke *smoke = calloc(1, sizeof *smoke);
    if (smoke)
        smoke->fill = KILN_SIMD_PICK(kiln_lamp_smoke_fill, simd);
    return smoke;
}

void kiln_lamp_smoke_destroy(struct kiln_lamp_smoke **smoke)
{
    if (!*smoke)
        return;
    free((*smoke)->maps);
    free(*smoke);
    *smoke = NULL;
}

/* Describes a grid in the world: its middle, and half of its edge, m. */
struct cube {
    float3 middle;
    float half;
};

static struct cube cube_of(const struct kiln_smoke_grid *grid)
{
    struct cube cube = {.middle = {0.0f, 0.0f, 0.0f}};
    for (int i = 0; i < 3; i++) {
        const float4 row = grid->world_to_grid[i];
        const float3 axis = {row.x, row.y, row.z};
        const float square = float3_dot(axis, axis); /* of 1 / edge */
        cube.middle = float3_add_scaled(cube.middle, axis, (0.5f - row.w) / square);
        cube.half = 0.5f / sqrtf(square);
    }
    return cube;
}

/* Sets the directions of a light's map. A light is far from the smoke if the sphere around the grid
 * fills less than the face of a cube. */
static void aim_map(const struct cube *cube, struct kiln_draw_light *light)
{
    const float4 at = light->position_radius2;
    const float3 to = float3_sub(cube->middle, (float3){at.x, at.y, at.z});
    const float sphere = 3.0f * cube->half * cube->half, square = float3_dot(to, to);
    light->smoke_ahead = light->smoke_right = (float4){0.0f, 0.0f, 0.0f, 0.0f};
    if (square < 2.25f * sphere)
        return;
    const float3 ahead = float3_scale(to, 1.0f / sqrtf(square));
    const float3 aside = fabsf(ahead.y) < 0.9f ? (float3){0, 1, 0} : (float3){1, 0, 0};
    float3 right = float3_cross(aside, ahead);
    right = float3_scale(right, 1.0f / sqrtf(float3_dot(right, right)));
    light->smoke_ahead = (float4){ahead.x, ahead.y, ahead.z, sqrtf((square - sphere) / sphere)};
    light->smoke_right = (float4){right.x, right.y, right.z, 0.0f};
}

/* Returns the distances from a light to the nearest and to the farthest point of a grid, m. */
static void find_range(const struct kiln_smoke_grid *grid, const struct cube *cube, float4 light,
                       float *nearest, float *farthest)
{
    float near = 0.0f, far = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float4 row = grid->world_to_grid[i];
        const float at = row.x * light.x + row.y * light.y + row.z * light.z + row.w;
        const float before = exact_max(exact_max(-at, at - 1.0f), 0.0f);
        const float after = exact_max(fabsf(at), fabsf(1.0f - at));
        near += before * before;
        far += after * after;
    }
    *nearest = 2.0f * cube->half * sqrtf(near);
    *farthest = 2.0f * cube->half * sqrtf(far);
}

/* Sets the directions and distances of a light's map. Layer 1 lies a cell away, or where the smoke
 * begins. Smoke inside of the lamp counts as none, since light starts at the lamp's surface. */
static struct kiln_lamp_smoke_job place_map(const struct kiln_smoke_grid *grid,
                                            struct kiln_draw_light *light)
{
    const struct cube cube = cube_of(grid);
    const float cell = 2.0f * cube.half / (float)KILN_SMOKE_COARSE;
    const float layers = (float)(KILN_LAMP_SMOKE_LAYERS - 2);
    float nearest, farthest;
    aim_map(&cube, light);
    find_range(grid, &cube, light->position_radius2, &nearest, &farthest);
    light->maps.y = exact_max(exact_max(nearest, cell), light->color.w);
    const float doublings = exact_log2(exact_max(farthest / light->maps.y, 1.01f));
    light->maps.z = layers / doublings;
    return (struct kiln_lamp_smoke_job){.grid = grid,
                                        .lamp = *light,
                                        .step = 1.5f * cell,
                                        .factor = exact_exp2(doublings / layers)};
}

static bool reserve(struct kiln_lamp_smoke *smoke, uint32_t count, struct kiln_error *error)
{
    if (count <= smoke->room)
        return true;
    float *maps = realloc(smoke->maps, (size_t)count * KILN_LAMP_SMOKE_MAP * sizeof *maps);
    if (!maps)
        return kiln_error_no_memory(error, "the smoke around lamps");
    smoke->maps = maps;
    smoke->room = count;
    return true;
}

static void fill_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_lamp_smoke *smoke = context;
    for (size_t i = begin; i < end; i++)
        smoke->fill(&smoke->jobs[i / ROWS], (uint32_t)(i % ROWS));
}

const float *kiln_lamp_smoke_run(struct kiln_lamp_smoke *smoke, const struct kiln_smoke_grid *grid,
                                 struct kiln_threads *threads, struct kiln_draw_light *lights,
                                 uint32_t light_count, uint32_t *count, struct kiln_error *error)
{
    *count = 0;
    for (uint32_t i = 0; i < light_count; i++) {
        if (!(lights[i].casters.w & 1u) || lights[i].casters.w & KILN_LAMP_THROUGH_SMOKE)
            continue;
        smoke->jobs[*count] = place_map(grid, &lights[i]);
        lights[i].casters.z = ++*count;
    }
    if (!reserve(smoke, *count ? *count : 1, error))
        return NULL;
    for (uint32_t i = 0; i < *count; i++)
        smoke->jobs[i].map = smoke->maps + (size_t)i * KILN_LAMP_SMOKE_MAP;
    kiln_threads_for(threads, (size_t)*count * ROWS, GRAIN, fill_rows, smoke);
    return smoke->maps;
}
