/* This file takes means of what gas hides, and sums of what its flames emit, over large cells. Each
 * level of cells holds the means of eight cells of the level before. Every brick is gathered by
 * itself, so threads do not change the result. */
#include "draw/light/gas_cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"
#include "scene/gas_extent.h"
#include "shared/exact.h"

static struct kiln_gas_place halved(struct kiln_gas_place n)
{
    return (struct kiln_gas_place){(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2};
}

static size_t count_of(struct kiln_gas_place n)
{
    return (size_t)n.x * (size_t)n.y * (size_t)n.z;
}

/* Returns the bytes of the large cells of a window, and writes their numbers. glow: with those of
 * flames. */
static size_t bytes_of(struct kiln_gas_place window, bool glow,
                       struct kiln_gas_place cells[KILN_GAS_LEVELS])
{
    size_t floats = 0;
    cells[0] = (struct kiln_gas_place){window.x / KILN_GAS_CELL, window.y / KILN_GAS_CELL,
                                       window.z / KILN_GAS_CELL};
    for (int level = 0; level < KILN_GAS_LEVELS; level++) {
        if (level > 0)
            cells[level] = halved(cells[level - 1]);
        floats += count_of(cells[level]);
    }
    const size_t large = sizeof(struct kiln_gas_glow) + sizeof(float);
    const size_t layer = KILN_GAS_LIGHTS * sizeof(struct kiln_gas_sums);
    return floats * sizeof(float) +
           (glow ? count_of(cells[0]) * large + (size_t)cells[0].z * layer : 0);
}

/* Returns whether the flames of a domain ever light what is around. */
static bool is_lit(const struct kiln_scene *scene, uint32_t domain)
{
    return kiln_scene_gas_lights(scene, domain) > 0;
}

void kiln_gas_cells_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        struct kiln_gas_place cells[KILN_GAS_LEVELS];
        const bool lit = is_lit(scene, i);
        if (lit || kiln_scene_gas_is_smoke(scene, i))
            kiln_footprint_add(footprint, KILN_FOOTPRINT_GAS, 1,
                               bytes_of(kiln_gas_extent(scene, i).cells, lit, cells));
    }
}

void kiln_gas_cells_finish(struct kiln_gas_cells *cells)
{
    for (uint32_t i = 0; i < KILN_MAX_GAS; i++)
        free(cells->memory[i]);
    memset(cells, 0, sizeof *cells);
}

/* ---- bricks ---------------------------------------------------------------------------------- */

struct gather_job {
    struct kiln_gas_block *block;
    const struct kiln_gas *gas;
    const struct kiln_flame_colors *colors;
    float smoke, flame; /* 1/m: what smoke 1 and a whole flame hide */
};

enum { EDGE = KILN_GAS_CELL, LARGE_IN_BRICK = GAS_BRICK / EDGE };

static void add_flame(const struct gather_job *job, const float *cell, int x, int y, int z,
                      struct kiln_gas_glow *glow)
{
    const float flame = cell[GAS_FLAME];
    if (!(flame > 0.0f))
        return;
    const float4 light = kiln_flame_color_near(job->colors, cell[GAS_TEMPERATURE]);
    const float rgb[3] = {flame * light.x, flame * light.y, flame * light.z};
    const float sum = (rgb[0] + rgb[1]) + rgb[2];
    const float at[3] = {(float)x + 0.5f, (float)y + 0.5f, (float)z + 0.5f};
    for (int i = 0; i < 3; i++) {
        glow->rgb[i] += rgb[i];
        glow->at[i] += sum * at[i];
    }
}

/* Gathers a large cell of a brick. cells: of the gas in it. Returns its extinction. */
static float gather_large(const struct gather_job *job, const float *cells,
                          struct kiln_gas_glow *glow)
{
    float smoke = 0.0f, flame = 0.0f;
    for (int z = 0; z < EDGE; z++)
        for (int y = 0; y < EDGE; y++)
            for (int x = 0; x < EDGE; x++) {
                const float *cell =
                    cells + (ptrdiff_t)((z * GAS_BRICK + y) * GAS_BRICK + x) * GAS_CARRIED;
                smoke += cell[GAS_SMOKE];
                flame += cell[GAS_FLAME];
                if (glow)
                    add_flame(job, cell, x, y, z, glow);
            }
    return (smoke * job->smoke + flame * job->flame) * (1.0f / (EDGE * EDGE * EDGE));
}

static void gather_layers(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct gather_job *job = context;
    const struct kiln_gas_place n = job->block->cells[0];
    for (int32_t z = (int32_t)begin; z < (int32_t)end; z++)
        for (int32_t y = 0; y < n.y; y++)
            for (int32_t x = 0; x < n.x; x++) {
                const size_t at = ((size_t)z * (size_t)n.y + (size_t)y) * (size_t)n.x + (size_t)x;
                const float *cells =
                    job->gas
                        ->brick[kiln_gas_brick_index(job->gas, x / LARGE_IN_BRICK,
                                                     y / LARGE_IN_BRICK, z / LARGE_IN_BRICK)]
                        .now;
                struct kiln_gas_glow *glow = job->block->glow ? &job->block->glow[at] : NULL;
                job->block->extinction[0][at] = 0.0f;
                if (glow)
                    *glow = (struct kiln_gas_glow){{0.0f}, {0.0f}};
                if (!cells)
                    continue;
                const int32_t first[3] = {x % LARGE_IN_BRICK * EDGE, y % LARGE_IN_BRICK * EDGE,
                                          z % LARGE_IN_BRICK * EDGE};
                cells += (ptrdiff_t)((first[2] * GAS_BRICK + first[1]) * GAS_BRICK + first[0]) *
                         GAS_CARRIED;
                job->block->extinction[0][at] = gather_large(job, cells, glow);
            }
}

/* ---- levels ---------------------------------------------------------------------------------- */

/* Halves a level. A cell beyond the end of the level before counts as empty. */
static void halve_level(struct kiln_gas_block *block, int level)
{
    const struct kiln_gas_place fine = block->cells[level - 1], n = block->cells[level];
    const float *from = block->extinction[level - 1];
    float *to = block->extinction[level];
    for (int32_t z = 0; z < n.z; z++)
        for (int32_t y = 0; y < n.y; y++)
            for (int32_t x = 0; x < n.x; x++) {
                float sum = 0.0f;
                for (int k = 0; k < 8; k++) {
                    const int32_t fx = 2 * x + (k & 1), fy = 2 * y + (k >> 1 & 1);
                    const int32_t fz = 2 * z + (k >> 2);
                    if (fx < fine.x && fy < fine.y && fz < fine.z)
                        sum += from[((size_t)fz * (size_t)fine.y + (size_t)fy) * (size_t)fine.x +
                                    (size_t)fx];
                }
                *to++ = 0.125f * sum;
            }
}

/* Optical depth of a large cell that counts as nothing. */
#define LEAST_DEPTH 1e-4f

static void find_bounds(struct kiln_gas_block *block)
{
    const struct kiln_gas_place n = block->cells[0];
    const float least = LEAST_DEPTH / (block->cell_m * (float)KILN_GAS_CELL);
    const float *cell = block->extinction[0];
    bool any = false;
    for (int32_t z = 0; z < n.z; z++)
        for (int32_t y = 0; y < n.y; y++)
            for (int32_t x = 0; x < n.x; x++, cell++) {
                const int32_t at[3] = {x, y, z};
                if (!(*cell > least))
                    continue;
                for (int i = 0; i < 3; i++) {
                    const float low = (float)(at[i] * KILN_GAS_CELL);
                    const float high = low + (float)KILN_GAS_CELL;
                    block->low[i] = any ? exact_min(block->low[i], low) : low;
                    block->high[i] = any ? exact_max(block->high[i], high) : high;
                }
                any = true;
            }
    block->shadow = block->shadow && any;
}

/* ---- domains --------------------------------------------------------------------------------- */

static bool make_room(struct kiln_gas_cells *cells, uint32_t domain, struct kiln_gas_block *block,
                      struct kiln_gas_place window, bool glow, struct kiln_error *error)
{
    const size_t bytes = bytes_of(window, glow, block->cells);
    if (bytes > cells->room[domain]) {
        free(cells->memory[domain]);
        cells->memory[domain] = kiln_alloc_pages(bytes);
        cells->room[domain] = cells->memory[domain] ? bytes : 0;
    }
    if (!cells->memory[domain])
        return kiln_error_no_memory(error, "the shadow of gas");
    block->layers = glow ? cells->memory[domain] : NULL;
    float *next = (float *)(void *)((char *)cells->memory[domain] +
                                    (glow ? (size_t)block->cells[0].z * KILN_GAS_LIGHTS *
                                                sizeof *block->layers
                                          : 0));
    for (int level = 0; level < KILN_GAS_LEVELS; level++) {
        block->extinction[level] = next;
        next += count_of(block->cells[level]);
    }
    block->leaving = glow ? next : NULL;
    block->glow = glow ? (struct kiln_gas_glow *)(void *)(next + count_of(block->cells[0])) : NULL;
    return true;
}

static void place(const struct kiln_scene *scene, uint32_t domain, const struct kiln_gas *gas,
                  float time_s, struct kiln_gas_block *block)
{
    const struct kiln_attach *attach = &scene->gas[domain].attach;
    const float cell = gas->shape.cell;
    const float3 first = {gas->shape.corner.x + cell * (float)gas->at.x,
                          gas->shape.corner.y + cell * (float)gas->at.y,
                          gas->shape.corner.z + cell * (float)gas->at.z};
    const float3 corner = kiln_attached_point(scene, attach, first, time_s);
    float axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    kiln_attached_rotation(scene, attach, axes, time_s);
    block->cell_m = kiln_attached_length(scene, attach, cell, time_s);
    block->corner[0] = corner.x;
    block->corner[1] = corner.y;
    block->corner[2] = corner.z;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            block->edges[i][c] = block->cell_m * axes[i][c];
}

static bool gather_domain(struct kiln_gas_cells *cells, const struct kiln_moment *moment,
                          uint32_t domain, const struct kiln_gas *gas, struct kiln_threads *threads,
                          struct kiln_error *error)
{
    const struct kiln_scene *scene = moment->scene;
    const struct kiln_gas_look *look = &scene->gas[domain].look;
    const float time_s = moment->view.clock.x;
    struct kiln_gas_block *block = &cells->blocks[cells->count];
    const bool lit = is_lit(scene, domain);
    *block =
        (struct kiln_gas_block){.domain = domain,
                                .intensity = kiln_scene_value(scene, &look->intensity, time_s) *
                                             kiln_scene_value(scene, &look->light, time_s),
                                .shadow = kiln_scene_gas_is_smoke(scene, domain)};
    if (!lit && !block->shadow)
        return true;
    if (!make_room(cells, domain, block, gas->cells, lit, error))
        return false;
    place(scene, domain, gas, time_s, block);
    if (!cells->observes)
        kiln_observer_fill(&cells->observer);
    cells->observes = true;
    kiln_flame_colors_fill(&cells->colors[domain], &cells->observer,
                           kiln_scene_value(scene, &look->kelvin[0], time_s),
                           kiln_scene_value(scene, &look->kelvin[1], time_s));
    struct gather_job job = {.block = block,
                             .gas = gas,
                             .colors = &cells->colors[domain],
                             .smoke = kiln_scene_value(scene, &look->extinction, time_s),
                             .flame = kiln_scene_value(scene, &look->absorption, time_s)};
    kiln_threads_for(threads, (size_t)block->cells[0].z, 1, gather_layers, &job);
    for (int level = 1; level < KILN_GAS_LEVELS; level++)
        halve_level(block, level);
    find_bounds(block);
    cells->count++;
    return true;
}

bool kiln_gas_cells_gather(struct kiln_gas_cells *cells, const struct kiln_moment *moment,
                           const struct kiln_pool *gas, struct kiln_threads *threads,
                           struct kiln_error *error)
{
    cells->count = 0;
    for (uint32_t i = 0; gas && i < moment->scene->gas_count && i < gas->gas_count; i++)
        if (moment->scene->gas[i].enabled && gas->gas[i].cells.x > 0 &&
            !gather_domain(cells, moment, i, &gas->gas[i], threads, error))
            return false;
    return true;
}

/* ---- reading --------------------------------------------------------------------------------- */

/* The least edge of a large cell, in parts of the distance of the points that read it. */
#define LEAST_EDGE 0.7f

struct kiln_gas_reader kiln_gas_reader_of(const struct kiln_gas_block *block, const float origin[3],
                                          const float steps[3][3])
{
    float square = 0.0f, edge_m = block->cell_m * (float)KILN_GAS_CELL, cells = KILN_GAS_CELL;
    for (int c = 0; c < 3; c++)
        square += steps[0][c] * steps[0][c];
    const float least = LEAST_EDGE * exact_sqrt(square);
    int level = 0;
    for (; level < KILN_GAS_LEVELS - 1 && edge_m < least; level++) {
        edge_m *= 2.0f;
        cells *= 2.0f;
    }
    struct kiln_gas_reader reader = {.extinction = block->extinction[level],
                                     .cells = block->cells[level]};
    const float scale = 1.0f / (cells * block->cell_m * block->cell_m);
    for (int i = 0; i < 3; i++) {
        const float *axis = block->edges[i];
        float at = 0.0f;
        for (int c = 0; c < 3; c++)
            at += axis[c] * (origin[c] - block->corner[c]);
        reader.origin[i] = at * scale - 0.5f;
        for (int k = 0; k < 3; k++)
            reader.steps[k][i] =
                scale * (axis[0] * steps[k][0] + axis[1] * steps[k][1] + axis[2] * steps[k][2]);
    }
    return reader;
}

/* Returns what a level has in a cell; nothing beyond its ends. */
static inline float cell_at(const struct kiln_gas_reader *r, int32_t x, int32_t y, int32_t z)
{
    const bool inside =
        x >= 0 && y >= 0 && z >= 0 && x < r->cells.x && y < r->cells.y && z < r->cells.z;
    return inside
               ? r->extinction[((size_t)z * (size_t)r->cells.y + (size_t)y) * (size_t)r->cells.x +
                               (size_t)x]
               : 0.0f;
}

static inline float row_at(const struct kiln_gas_reader *r, int32_t x, int32_t y, int32_t z,
                           float part)
{
    const float a = cell_at(r, x, y, z);
    return a + (cell_at(r, x + 1, y, z) - a) * part;
}

void kiln_gas_reader_add(const struct kiln_gas_reader *r, int y, int z, int count,
                         float *extinction)
{
    const float cells[3] = {(float)r->cells.x, (float)r->cells.y, (float)r->cells.z};
    float row[3];
    for (int i = 0; i < 3; i++)
        row[i] = r->origin[i] + r->steps[1][i] * (float)y + r->steps[2][i] * (float)z;
    for (int n = 0; n < count; n++) {
        float at[3];
        int32_t low[3];
        bool inside = true;
        for (int i = 0; i < 3; i++) {
            at[i] = row[i] + r->steps[0][i] * (float)n;
            inside &= at[i] > -1.0f && at[i] < cells[i];
        }
        if (!inside)
            continue;
        for (int i = 0; i < 3; i++) {
            const float first = floorf(at[i]);
            low[i] = exact_int(first);
            at[i] -= first;
        }
        const float a = row_at(r, low[0], low[1], low[2], at[0]);
        const float b = row_at(r, low[0], low[1] + 1, low[2], at[0]);
        const float c = row_at(r, low[0], low[1], low[2] + 1, at[0]);
        const float d = row_at(r, low[0], low[1] + 1, low[2] + 1, at[0]);
        const float near = a + (b - a) * at[1], far = c + (d - c) * at[1];
        extinction[n] += near + (far - near) * at[2];
    }
}
