/* This file fills grids with the optical depth of smoke towards a light. Each particle is a ball
 * whose density falls off smoothly. It is added to the level of a pyramid whose cells suit its
 * size, so that a large puff costs no more cells than a small one. The levels of the pyramid are
 * added up, and gas is read in between; then all is summed along the light.
 *
 * The smoke is divided into parts, whose number depends on the amount of smoke alone. Each part has
 * a pyramid of its own. The parts are added up in order, so that threads do not change the result.
 * Empty slices of a pyramid, usually most of it, are not even cleared. */
#include "draw/light/smoke_shadow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vector.h"
#include "draw/light/gas_cells.h"
#include "shared/exact.h"

enum {
    EDGE = KILN_SMOKE_GRID,
    LEVELS = 4, /* 64, 32, 16 and 8 cells */
    MOST_PARTS = 8,
    LEAST_PART = 2, /* chunks of puffs */
    BAND = 8,       /* rows of a slice that are summed along the light together */
    LANES = 8,      /* cells of a row that a ball reaches at most */
    BALLS = 64,     /* balls that are placed together */
};

static const float MOST_CELLS = 2.5f;  /* of a ball's radius, in its level, except the coarsest */
static const float LEAST_CELLS = 1.2f; /* of a ball's radius: smaller balls are enlarged to it */

/* Holds the smoke of one part in one grid, at all levels. */
struct pyramid {
    float *levels[LEVELS];          /* extinction, 1/m */
    uint64_t filled_slices[LEVELS]; /* a bit for each slice of cells that is not empty */
    float low[3], high[3];          /* bounds along the axes, m */
    bool any;
};

struct box {
    struct kiln_smoke_grid *grid;
    float3 axes[3];  /* of the grid, unit; the third points to the light */
    float cell;      /* m */
    float origin[3]; /* the grid's low corner along the axes, m */
    float *finer;    /* levels 1 and coarser, interpolated along rows of the finest */
    bool coarse;     /* whether any level but the finest has contents */
    struct pyramid parts[MOST_PARTS];
    struct kiln_gas_reader gas[KILN_MAX_GAS];
    uint32_t gas_domain[KILN_MAX_GAS]; /* the domain that each of them reads */
    uint32_t gas_count;
};

struct kiln_smoke_shadow {
    struct box boxes[KILN_MAX_SMOKE_GRIDS];
    float *memory;
    /* These are of one call of kiln_smoke_shadow_fill: */
    const struct kiln_smoke *smoke;
    uint32_t parts;
    uint32_t left_out; /* the domain whose gas does not count; KILN_MAX_GAS: all gas counts */
};

static size_t level_floats(int level)
{
    size_t edge = (size_t)(EDGE >> level);
    return edge * edge * edge;
}

static size_t finer_floats(void)
{
    return 2 * level_floats(1);
}

uint64_t kiln_smoke_shadow_bytes(bool puffs)
{
    size_t pyramid = 0;
    for (int level = 0; puffs && level < LEVELS; level++)
        pyramid += level_floats(level);
    return KILN_MAX_SMOKE_GRIDS * (MOST_PARTS * pyramid + finer_floats()) * sizeof(float);
}

struct kiln_smoke_shadow *kiln_smoke_shadow_create(void)
{
    struct kiln_smoke_shadow *shadow = calloc(1, sizeof *shadow);
    float *memory = malloc(kiln_smoke_shadow_bytes(true));
    if (!shadow || !memory) {
        free(shadow);
        free(memory);
        return NULL;
    }
    shadow->memory = memory;
    for (int i = 0; i < KILN_MAX_SMOKE_GRIDS; i++) {
        struct box *box = &shadow->boxes[i];
        for (int part = 0; part < MOST_PARTS; part++) {
            for (int level = 0; level < LEVELS; level++) {
                box->parts[part].levels[level] = memory;
                memory += level_floats(level);
            }
        }
        box->finer = memory;
        memory += finer_floats();
    }
    return shadow;
}

void kiln_smoke_shadow_destroy(struct kiln_smoke_shadow **shadow)
{
    if (!*shadow)
        return;
    free((*shadow)->memory);
    free(*shadow);
    *shadow = NULL;
}

static void choose_axes(float3 axes[3], float3 direction)
{
    float3 aside = fabsf(direction.y) < 0.9f ? (float3){0, 1, 0} : (float3){1, 0, 0};
    float3 first = float3_cross(aside, direction);
    float length = sqrtf(float3_dot(first, first));
    axes[0] = (float3){first.x / length, first.y / length, first.z / length};
    axes[1] = float3_cross(direction, axes[0]);
    axes[2] = direction;
}

/* Returns the first chunk of a part. */
static uint32_t first_chunk(const struct kiln_smoke_shadow *shadow, size_t part)
{
    return (uint32_t)((uint64_t)shadow->smoke->chunk_count * part / shadow->parts);
}

static void grow_bounds(const struct box *box, struct pyramid *part, const struct kiln_puff *puff)
{
    for (int i = 0; i < 3; i++) {
        float at = float3_dot(box->axes[i], puff->position);
        float low = at - puff->radius, high = at + puff->radius;
        part->low[i] = part->any && part->low[i] < low ? part->low[i] : low;
        part->high[i] = part->any && part->high[i] > high ? part->high[i] : high;
    }
    part->any = true;
}

/* Grows bounds by the gas that throws shadows. */
static void grow_by_gas(const struct box *box, const struct kiln_gas_cells *gas,
                        struct pyramid *part)
{
    for (uint32_t i = 0; i < gas->count; i++) {
        const struct kiln_gas_block *block = &gas->blocks[i];
        for (uint32_t k = 0; k < 8 && block->shadow; k++) {
            float at[3];
            for (int c = 0; c < 3; c++)
                at[c] = block->corner[c] +
                        block->edges[0][c] * (k & 1 ? block->high[0] : block->low[0]) +
                        block->edges[1][c] * (k & 2 ? block->high[1] : block->low[1]) +
                        block->edges[2][c] * (k & 4 ? block->high[2] : block->low[2]);
            const struct kiln_puff corner = {.position = {at[0], at[1], at[2]}};
            grow_bounds(box, part, &corner);
        }
    }
}

/* Finds bounds of the smoke along the grids' axes. Work item grid * parts + part is one part of the
 * smoke in one grid. */
static void find_bounds(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_smoke_shadow *shadow = context;
    for (size_t work = begin; work < end; work++) {
        struct box *box = &shadow->boxes[work / shadow->parts];
        size_t index = work % shadow->parts;
        struct pyramid *part = &box->parts[index];
        part->any = false;
        if (index == 0 && shadow->smoke->gas)
            grow_by_gas(box, shadow->smoke->gas, part);
        uint32_t last = first_chunk(shadow, index + 1);
        for (uint32_t chunk = first_chunk(shadow, index); chunk < last; chunk++) {
            const struct kiln_puff *puffs = shadow->smoke->puffs + (size_t)chunk * KILN_SMOKE_CHUNK;
            for (uint32_t i = 0; i < shadow->smoke->counts[chunk]; i++)
                grow_bounds(box, part, &puffs[i]);
        }
    }
}

/* Places the grid. The cells lie at multiples of their size in the world, and their size is a
 * power of 2^(1/4) m, so that the grid does not crawl when the smoke grows. Returns false when
 * there is no smoke. */
static bool place_grid(struct box *box, uint32_t parts)
{
    float low[3], high[3], longest = 0.0f;
    bool any = false;
    for (uint32_t k = 0; k < parts; k++) {
        const struct pyramid *part = &box->parts[k];
        for (int i = 0; i < 3 && part->any; i++) {
            low[i] = any && low[i] < part->low[i] ? low[i] : part->low[i];
            high[i] = any && high[i] > part->high[i] ? high[i] : part->high[i];
        }
        any = any || part->any;
    }
    if (!any)
        return false;
    for (int i = 0; i < 3; i++)
        longest = fmaxf(longest, high[i] - low[i]);
    float least = longest / (EDGE - 4);
    box->cell = exact_exp2(0.25f * ceilf(4.0f * exact_log2(fmaxf(least, 1e-4f))));
    float edge_m = box->cell * EDGE;
    for (int i = 0; i < 3; i++) {
        float margin = 0.5f * (edge_m - (high[i] - low[i]));
        box->origin[i] = box->cell * floorf((low[i] - margin) / box->cell);
        float3 axis = box->axes[i];
        box->grid->world_to_grid[i] =
            (float4){axis.x / edge_m, axis.y / edge_m, axis.z / edge_m, -box->origin[i] / edge_m};
    }
    return true;
}

/* Prepares to read gas at the middles of the cells of a grid that has its place. */
static void place_gas(struct box *box, const struct kiln_gas_cells *gas)
{
    float origin[3] = {0.0f, 0.0f, 0.0f}, steps[3][3];
    for (int i = 0; i < 3; i++) {
        const float axis[3] = {box->axes[i].x, box->axes[i].y, box->axes[i].z};
        for (int c = 0; c < 3; c++) {
            origin[c] += axis[c] * (box->origin[i] + 0.5f * box->cell);
            steps[i][c] = axis[c] * box->cell;
        }
    }
    box->gas_count = 0;
    for (uint32_t i = 0; gas && i < gas->count; i++)
        if (gas->blocks[i].shadow) {
            box->gas_domain[box->gas_count] = gas->blocks[i].domain;
            box->gas[box->gas_count++] = kiln_gas_reader_of(&gas->blocks[i], origin, steps);
        }
}

/* Holds up to BALLS balls of smoke, in cells of their levels, so that loops over balls are
 * vectorised. */
struct balls {
    float at[3][BALLS]; /* the centre, in cells */
    float radius[BALLS];
    float inverse[BALLS]; /* of the radius */
    float volume[BALLS];  /* of a cell, m^3 */
    int level[BALLS];
    int first[3][BALLS], count[3][BALLS]; /* the cells that the ball reaches, along each axis */
};

static inline void place_balls(const struct box *box, const struct kiln_puff *puffs, int count,
                               struct balls *balls)
{
    const float cell = box->cell;
    for (int i = 0; i < count; i++) {
        int level = 0;
        for (int k = 1; k < LEVELS; k++)
            level += puffs[i].radius > MOST_CELLS * (cell * 0.5f * (float)(1 << k));
        float size = cell * (float)(1 << level);
        float radius = exact_max(puffs[i].radius / size, LEAST_CELLS);
        balls->level[i] = level;
        balls->radius[i] = radius;
        balls->inverse[i] = 1.0f / radius;
        balls->volume[i] = size * size * size;
        for (int axis = 0; axis < 3; axis++)
            balls->at[axis][i] =
                (float3_dot(box->axes[axis], puffs[i].position) - box->origin[axis]) / size;
    }
}

/* Finds the cells that balls reach. LANES cells from a ball's first cell on never pass the end of a
 * row of the grid, so that they can be read as one vector. */
static inline void find_reaches(int count, struct balls *balls)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < count; i++) {
            int edge = EDGE >> balls->level[i];
            float at = balls->at[axis][i], radius = balls->radius[i];
            int first = exact_int(exact_clamp(floorf(at - radius), 0.0f, (float)edge));
            int last = exact_int(exact_clamp(ceilf(at + radius), 0.0f, (float)edge)) - 1;
            int reached = last - first + 1;
            balls->count[axis][i] = reached > LANES ? LANES : reached;
            balls->first[axis][i] = axis == 0 && first > edge - LANES ? edge - LANES : first;
        }
    }
}

/* Vectors of LANES cells of a row. */
typedef float row8 __attribute__((vector_size(4 * LANES)));
typedef int32_t mask8 __attribute__((vector_size(4 * LANES)));

/* Holds the weights of a ball's cells, (1 - d^2)^2 at the distance d from its centre, in radii. A
 * row has LANES cells. */
struct ball {
    float squares[3][LANES]; /* of cells' distances from the centre along each axis, in radii */
    row8 weights[LANES * LANES];
};

static inline void compute_distances(const struct balls *balls, int i, struct ball *ball)
{
    const row8 middles = {0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f};
    for (int axis = 0; axis < 3; axis++) {
        row8 away =
            (middles + ((float)balls->first[axis][i] - balls->at[axis][i])) * balls->inverse[i];
        away *= away;
        memcpy(ball->squares[axis], &away, sizeof away);
    }
}

/* Computes a ball's weights and returns their sum. */
static inline float compute_weights(const struct balls *balls, int i, struct ball *ball)
{
    row8 sum = {0.0f}, squares;
    memcpy(&squares, ball->squares[0], sizeof squares);
    for (int z = 0; z < balls->count[2][i]; z++) {
        for (int y = 0; y < balls->count[1][i]; y++) {
            row8 inside = 1.0f - (ball->squares[2][z] + ball->squares[1][y]) - squares;
            inside = (row8)((mask8)inside & (mask8)(inside > 0.0f));
            sum += ball->weights[z * LANES + y] = inside * inside;
        }
    }
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

static inline void add_ball(float *cells, const struct balls *balls, int i, const struct ball *ball,
                            float scale)
{
    const int edge = EDGE >> balls->level[i];
    for (int z = 0; z < balls->count[2][i]; z++) {
        int row = (balls->first[2][i] + z) * edge + balls->first[1][i];
        float *at = cells + (size_t)row * (size_t)edge + (size_t)balls->first[0][i];
        for (int y = 0; y < balls->count[1][i]; y++, at += edge) {
            row8 sum;
            memcpy(&sum, at, sizeof sum);
            sum += scale * ball->weights[z * LANES + y];
            memcpy(at, &sum, sizeof sum);
        }
    }
}

/* Clears the slices of a level that are about to be written for the first time. */
static inline void clear_new_slices(struct pyramid *part, int level, int first, int count)
{
    size_t slice = (size_t)(EDGE >> level) * (size_t)(EDGE >> level);
    for (int z = first; z < first + count; z++) {
        if (!(part->filled_slices[level] >> z & 1))
            memset(part->levels[level] + (size_t)z * slice, 0, slice * sizeof(float));
        part->filled_slices[level] |= (uint64_t)1 << z;
    }
}

/* Adds balls to a pyramid. The sum of a ball's extinction is preserved, however few cells it
 * reaches. */
static inline void deposit(const struct box *box, struct pyramid *part,
                           const struct kiln_puff *puffs, int count)
{
    struct balls balls;
    struct ball ball;
    place_balls(box, puffs, count, &balls);
    find_reaches(count, &balls);
    for (int i = 0; i < count; i++) {
        compute_distances(&balls, i, &ball);
        float sum = compute_weights(&balls, i, &ball);
        if (!(sum > 0.0f))
            continue;
        const int level = balls.level[i];
        clear_new_slices(part, level, balls.first[2][i], balls.count[2][i]);
        add_ball(part->levels[level], &balls, i, &ball,
                 puffs[i].extinction / (sum * balls.volume[i]));
    }
}

KILN_WIDE_VECTORS
static void deposit_parts(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_smoke_shadow *shadow = context;
    for (size_t work = begin; work < end; work++) {
        const struct box *box = &shadow->boxes[work / shadow->parts];
        size_t index = work % shadow->parts;
        struct pyramid *part = &shadow->boxes[work / shadow->parts].parts[index];
        memset(part->filled_slices, 0, sizeof part->filled_slices);
        uint32_t last = first_chunk(shadow, index + 1);
        for (uint32_t chunk = first_chunk(shadow, index); chunk < last; chunk++) {
            const struct kiln_puff *puffs = shadow->smoke->puffs + (size_t)chunk * KILN_SMOKE_CHUNK;
            const uint32_t count = shadow->smoke->counts[chunk];
            for (uint32_t i = 0; i < count; i += BALLS)
                deposit(box, part, puffs + i, (int)(count - i < BALLS ? count - i : BALLS));
        }
    }
}

/* Adds a level of all other parts to that of the first part. */
static void add_parts(struct box *box, int level, uint32_t parts)
{
    struct pyramid *sum = &box->parts[0];
    size_t slice = (size_t)(EDGE >> level) * (size_t)(EDGE >> level);
    for (int z = 0; z < EDGE >> level; z++) {
        float *cells = sum->levels[level] + (size_t)z * slice;
        for (uint32_t k = 1; k < parts; k++) {
            if (!(box->parts[k].filled_slices[level] >> z & 1))
                continue;
            const float *more = box->parts[k].levels[level] + (size_t)z * slice;
            if (!(sum->filled_slices[level] >> z & 1))
                memset(cells, 0, slice * sizeof *cells);
            sum->filled_slices[level] |= (uint64_t)1 << z;
            for (size_t i = 0; i < slice; i++)
                cells[i] += more[i];
        }
    }
}

/* Holds the two coarse cells between whose centres a fine cell lies: the one that contains it, of
 * weight 3/4, and the next, of weight 1/4. */
struct between {
    int cells[2];
};

static struct between between_of(int fine, int coarse_edge)
{
    int own = fine / 2, next = fine & 1 ? own + 1 : own - 1;
    next = next < 0 ? 0 : next > coarse_edge - 1 ? coarse_edge - 1 : next;
    return (struct between){{own, next}};
}

/* Interpolates a level along its rows: each becomes a row of twice as many cells. */
static inline void refine_rows(const float *restrict coarse, int coarse_edge, float *restrict rows)
{
    for (int row = 0; row < coarse_edge * coarse_edge; row++) {
        const float *from = coarse + (size_t)row * (size_t)coarse_edge;
        float *to = rows + 2 * (size_t)row * (size_t)coarse_edge;
        int last = coarse_edge - 1;
        to[0] = 0.75f * from[0] + 0.25f * from[0];
        for (int x = 0; x < last; x++) {
            to[2 * x + 1] = 0.75f * from[x] + 0.25f * from[x + 1];
            to[2 * x + 2] = 0.75f * from[x + 1] + 0.25f * from[x];
        }
        to[2 * last + 1] = 0.75f * from[last] + 0.25f * from[last];
    }
}

/* Adds the refined rows of the coarser level to row (y, z) of a level. */
static inline void add_coarser(const float *rows, int edge, int y, int z, float *restrict fine)
{
    struct between at_y = between_of(y, edge / 2), at_z = between_of(z, edge / 2);
    const float *from[4];
    for (int i = 0; i < 4; i++)
        from[i] =
            rows + (size_t)(at_z.cells[i / 2] * (edge / 2) + at_y.cells[i % 2]) * (size_t)edge;
    const float *restrict a = from[0], *restrict b = from[1];
    const float *restrict c = from[2], *restrict d = from[3];
    for (int x = 0; x < edge; x++) {
        float nearer = fine[x] + 0.5625f * a[x] + 0.1875f * b[x];
        fine[x] = nearer + 0.1875f * c[x] + 0.0625f * d[x];
    }
}

/* Adds up all parts and all levels, except the finest level, in `finer`. */
KILN_WIDE_VECTORS
static void add_levels(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_smoke_shadow *shadow = context;
    for (size_t which = begin; which < end; which++) {
        struct box *box = &shadow->boxes[which];
        box->coarse = false;
        for (int level = LEVELS - 1; level > 0; level--) {
            int edge = EDGE >> level;
            float *cells = box->parts[0].levels[level];
            add_parts(box, level, shadow->parts);
            uint64_t filled_slices = box->parts[0].filled_slices[level];
            if (!box->coarse && !filled_slices)
                continue;
            for (int row = 0; row < edge * edge; row++) {
                float *fine = cells + (size_t)row * (size_t)edge;
                if (!(filled_slices >> (row / edge) & 1))
                    memset(fine, 0, (size_t)edge * sizeof *fine);
                if (box->coarse)
                    add_coarser(box->finer, edge, row % edge, row / edge, fine);
            }
            box->coarse = true;
            refine_rows(cells, edge, box->finer);
        }
    }
}

/* Adds the extinction of row (y, z) at the finest level, from all parts and levels. */
static inline void add_row(const struct kiln_smoke_shadow *shadow, const struct box *box, int y,
                           int z, float *restrict extinction)
{
    for (uint32_t k = 0; k < shadow->parts; k++) {
        const struct pyramid *part = &box->parts[k];
        if (!(part->filled_slices[0] >> z & 1))
            continue;
        const float *restrict cells = part->levels[0] + (size_t)(z * EDGE + y) * EDGE;
        for (int x = 0; x < EDGE; x++)
            extinction[x] += cells[x];
    }
    if (box->coarse)
        add_coarser(box->finer, EDGE, y, z, extinction);
    for (uint32_t i = 0; i < box->gas_count; i++)
        if (box->gas_domain[i] != shadow->left_out)
            kiln_gas_reader_add(&box->gas[i], y, z, EDGE, extinction);
}

/* Computes the optical depth between each cell's centre and the light. above: from the light to the
 * cell's face towards it; moves on to the next cell's. */
static inline void advance(const float *restrict extinction, float cell, float *restrict above,
                           float *restrict depth)
{
    for (int x = 0; x < EDGE; x++) {
        float own = extinction[x] * cell;
        depth[x] = above[x] + 0.5f * own;
        above[x] += own;
    }
}

/* Adds a row of extinction to the row of the coarse grid that contains it. */
static inline void add_to_coarse(const float *restrict extinction, int y, int z,
                                 float *restrict coarse)
{
    const bool first = (y & 1) == 0 && (z & 1) == 1; /* slices come from the last to the first */
    float *row = coarse + (size_t)(z / 2 * KILN_SMOKE_COARSE + y / 2) * KILN_SMOKE_COARSE;
    for (size_t x = 0; x < KILN_SMOKE_COARSE; x++) {
        const float pair = 0.125f * (extinction[2 * x] + extinction[2 * x + 1]);
        row[x] = first ? pair : row[x] + pair;
    }
}

/* Sums BAND rows of every slice of a grid along the light. Work item grid * (EDGE / BAND) + band is
 * one band of rows in one grid. */
KILN_WIDE_VECTORS
static void sum_towards_light(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_smoke_shadow *shadow = context;
    for (size_t work = begin; work < end; work++) {
        const struct box *box = &shadow->boxes[work / (EDGE / BAND)];
        int first = (int)(work % (EDGE / BAND)) * BAND;
        float above[BAND][EDGE] = {{0}};
        for (int z = EDGE - 1; z >= 0; z--) {
            for (int y = first; y < first + BAND; y++) {
                float extinction[EDGE] = {0};
                add_row(shadow, box, y, z, extinction);
                if (box->grid->extinction)
                    add_to_coarse(extinction, y, z, box->grid->extinction);
                advance(extinction, box->cell, above[y - first],
                        box->grid->depth + (size_t)(z * EDGE + y) * EDGE);
            }
        }
    }
}

bool kiln_smoke_shadow_fill(struct kiln_smoke_shadow *shadow, const struct kiln_smoke *smoke,
                            struct kiln_threads *threads, struct kiln_smoke_grid *grids,
                            uint32_t count)
{
    uint32_t useful = smoke->chunk_count / LEAST_PART;
    shadow->parts = useful < 1 ? 1 : useful > MOST_PARTS ? MOST_PARTS : useful;
    shadow->smoke = smoke;
    shadow->left_out = KILN_MAX_GAS;
    for (uint32_t i = 0; i < count; i++) {
        shadow->boxes[i].grid = &grids[i];
        choose_axes(shadow->boxes[i].axes, grids[i].direction);
    }
    kiln_threads_for(threads, (size_t)count * shadow->parts, 1, find_bounds, shadow);
    for (uint32_t i = 0; i < count; i++) {
        if (!place_grid(&shadow->boxes[i], shadow->parts))
            return false;
        place_gas(&shadow->boxes[i], smoke->gas);
    }
    kiln_threads_for(threads, (size_t)count * shadow->parts, 1, deposit_parts, shadow);
    kiln_threads_for(threads, count, 1, add_levels, shadow);
    kiln_threads_for(threads, (size_t)count * (EDGE / BAND), 1, sum_towards_light, shadow);
    return true;
}

/* Returns whether there is smoke that is not the gas of a domain. */
static bool has_others(const struct kiln_smoke_shadow *shadow, uint32_t domain)
{
    const struct box *box = &shadow->boxes[0];
    for (uint32_t i = 0; i < box->gas_count; i++)
        if (box->gas_domain[i] != domain)
            return true;
    for (uint32_t chunk = 0; chunk < shadow->smoke->chunk_count; chunk++)
        if (shadow->smoke->counts[chunk] > 0)
            return true;
    return false;
}

bool kiln_smoke_shadow_without(struct kiln_smoke_shadow *shadow, uint32_t domain,
                               struct kiln_threads *threads, float *const depths[], uint32_t count)
{
    struct kiln_smoke_grid grids[KILN_MAX_SMOKE_GRIDS], *all[KILN_MAX_SMOKE_GRIDS];
    if (!has_others(shadow, domain))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        all[i] = shadow->boxes[i].grid;
        grids[i] = (struct kiln_smoke_grid){.depth = depths[i]};
        shadow->boxes[i].grid = &grids[i];
    }
    shadow->left_out = domain;
    kiln_threads_for(threads, (size_t)count * (EDGE / BAND), 1, sum_towards_light, shadow);
    for (uint32_t i = 0; i < count; i++)
        shadow->boxes[i].grid = all[i];
    return true;
}
