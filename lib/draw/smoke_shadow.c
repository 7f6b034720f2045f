/* Each particle is a ball whose density falls off smoothly, put into a grid of about its own
 * fineness: a pyramid of grids, so that a large puff costs no more cells than a small one. The
 * pyramid is added up, and then summed along the light.
 */
#include "draw/smoke_shadow.h"

#include <math.h>
#include <string.h>

enum { EDGE = KILN_SMOKE_GRID, LEVELS = 5 }; /* 64, 32, 16, 8 and 4 cells */

static const float FILL = 0.6f;        /* of a cell of the atlas, in its middle */
static const float MOST_CELLS = 2.5f;  /* of a ball's radius, in its grid */
static const float LEAST_CELLS = 1.2f; /* smaller balls are put in as large as this */

struct smoke {
    float3 axes[3];        /* of the grid; the third to the light */
    float low[3], high[3]; /* bounds along the axes, m */
    bool any;
    float shadow;          /* of the system at hand */
    float cell;            /* m */
    float origin[3];       /* the grid's low corner along the axes, m */
    float *levels[LEVELS]; /* extinction, 1/m */
};

static float3 cross(float3 a, float3 b)
{
    return (float3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static float dot(float3 a, float3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static void choose_axes(float3 axes[3], float3 direction)
{
    float3 aside = fabsf(direction.y) < 0.9f ? (float3){0, 1, 0} : (float3){1, 0, 0};
    float3 first = cross(aside, direction);
    float length = sqrtf(dot(first, first));
    axes[0] = (float3){first.x / length, first.y / length, first.z / length};
    axes[1] = cross(direction, axes[0]);
    axes[2] = direction;
}

/* Optical depth through a particle's middle. */
static float middle_depth(const struct smoke *smoke, const struct kiln_living *particle)
{
    float alpha = FILL * particle->opacity;
    return -logf(1.0f - (alpha < 0.98f ? alpha : 0.98f)) * smoke->shadow;
}

static void widen(void *context, const struct kiln_living *particle)
{
    struct smoke *smoke = context;
    if (!(particle->radius > 0.0f && particle->opacity > 0.0f))
        return;
    for (int i = 0; i < 3; i++) {
        float at = dot(smoke->axes[i], particle->position);
        float low = at - particle->radius, high = at + particle->radius;
        smoke->low[i] = smoke->any && smoke->low[i] < low ? smoke->low[i] : low;
        smoke->high[i] = smoke->any && smoke->high[i] > high ? smoke->high[i] : high;
    }
    smoke->any = true;
}

/* The cells lie at multiples of their size in the world, and their size is one of few, so that the
 * grid does not crawl when the smoke grows. */
static void place_grid(struct smoke *smoke)
{
    float longest = 0.0f;
    for (int i = 0; i < 3; i++)
        longest = fmaxf(longest, smoke->high[i] - smoke->low[i]);
    float least = longest / (EDGE - 4);
    smoke->cell = exp2f(0.25f * ceilf(4.0f * log2f(fmaxf(least, 1e-4f))));
    for (int i = 0; i < 3; i++) {
        float margin = 0.5f * (EDGE * smoke->cell - (smoke->high[i] - smoke->low[i]));
        smoke->origin[i] = smoke->cell * floorf((smoke->low[i] - margin) / smoke->cell);
    }
}

/* The cells of one axis that a ball reaches: their squared distances from its centre in radii. */
struct reach {
    int first, count;
    float squares[8];
};

static struct reach reach_of(float center, float radius, int edge)
{
    int first = (int)floorf(center - radius), last = (int)ceilf(center + radius) - 1;
    struct reach reach = {.first = first < 0 ? 0 : first};
    last = last > edge - 1 ? edge - 1 : last;
    for (int i = reach.first; i <= last && reach.count < 8; i++) {
        float away = ((float)i + 0.5f - center) / radius;
        reach.squares[reach.count++] = away * away;
    }
    return reach;
}

/* Adds scale * (1 - d^2)^2 to the cells, d in radii; scale 0 adds nothing. Returns the sum of the
 * weights. */
static float add_ball(float *cells, int edge, const struct reach reach[3], float scale)
{
    float sum = 0.0f;
    for (int z = 0; z < reach[2].count; z++) {
        for (int y = 0; y < reach[1].count; y++) {
            float square = reach[2].squares[z] + reach[1].squares[y];
            float *row = cells + ((size_t)(reach[2].first + z) * (size_t)edge +
                                  (size_t)(reach[1].first + y)) *
                                     (size_t)edge;
            for (int x = 0; x < reach[0].count; x++) {
                float inside = fmaxf(1.0f - square - reach[0].squares[x], 0.0f);
                float weight = inside * inside;
                sum += weight;
                row[reach[0].first + x] += scale * weight;
            }
        }
    }
    return sum;
}

/* Extinction of e (1 - d^2)^2 has the optical depth 16/15 e r through the middle of a ball and, in
 * all, e r^3 32 pi / 105. The sum is what is kept, however few cells there are. */
static void deposit(void *context, const struct kiln_living *particle)
{
    struct smoke *smoke = context;
    float radius = particle->radius;
    if (!(radius > 0.0f && particle->opacity > 0.0f))
        return;
    float total = middle_depth(smoke, particle) * 15.0f / 16.0f * radius * radius *
                  (32.0f * 3.14159265f / 105.0f);
    int level = 0;
    float cell = smoke->cell;
    while (level < LEVELS - 1 && radius > MOST_CELLS * cell) {
        level++;
        cell *= 2.0f;
    }
    int edge = EDGE >> level;
    struct reach reach[3];
    float radius_cells = fmaxf(radius / cell, LEAST_CELLS);
    for (int i = 0; i < 3; i++) {
        float at = (dot(smoke->axes[i], particle->position) - smoke->origin[i]) / cell;
        reach[i] = reach_of(at, radius_cells, edge);
    }
    float sum = add_ball(smoke->levels[level], edge, reach, 0.0f);
    if (sum > 0.0f)
        add_ball(smoke->levels[level], edge, reach, total / (sum * cell * cell * cell));
}

/* The two coarse cells that a fine one lies between: its own, of weight 3/4, and the next, of 1/4.
 */
struct between {
    int cells[2];
};

static struct between between_of(int fine, int coarse_edge)
{
    int own = fine / 2, next = fine & 1 ? own + 1 : own - 1;
    next = next < 0 ? 0 : next > coarse_edge - 1 ? coarse_edge - 1 : next;
    return (struct between){{own, next}};
}

/* Adds weight times a coarse row to a fine one. */
static void add_coarser_row(const float *coarse, int coarse_edge, float weight, float *fine)
{
    for (int x = 0; x < 2 * coarse_edge; x++) {
        struct between at = between_of(x, coarse_edge);
        fine[x] += weight * (0.75f * coarse[at.cells[0]] + 0.25f * coarse[at.cells[1]]);
    }
}

/* Adds a level to the one of twice its edge, linearly interpolated. */
static void add_coarser(const float *coarse, int coarse_edge, float *fine)
{
    static const float weights[2] = {0.75f, 0.25f};
    int edge = 2 * coarse_edge;
    for (int row = 0; row < edge * edge; row++) {
        struct between y = between_of(row % edge, coarse_edge);
        struct between z = between_of(row / edge, coarse_edge);
        for (int i = 0; i < 4; i++) {
            int from = z.cells[i / 2] * coarse_edge + y.cells[i % 2];
            add_coarser_row(coarse + (size_t)from * (size_t)coarse_edge, coarse_edge,
                            weights[i / 2] * weights[i % 2], fine + (size_t)row * (size_t)edge);
        }
    }
}

/* From extinction to the optical depth between a cell's centre and the light. */
static void sum_towards_light(const struct smoke *smoke, float *depth)
{
    const float *extinction = smoke->levels[0];
    enum { SLICE = EDGE * EDGE };
    float above[SLICE] = {0}; /* up to the cell's upper face */
    for (int z = EDGE - 1; z >= 0; z--) {
        for (int i = 0; i < SLICE; i++) {
            float own = extinction[(size_t)z * SLICE + (size_t)i] * smoke->cell;
            depth[(size_t)z * SLICE + (size_t)i] = above[i] + 0.5f * own;
            above[i] += own;
        }
    }
}

static void set_rows(const struct smoke *smoke, struct kiln_smoke_grid *grid)
{
    float edge_m = smoke->cell * EDGE;
    for (int i = 0; i < 3; i++) {
        float3 axis = smoke->axes[i];
        grid->world_to_grid[i] =
            (float4){axis.x / edge_m, axis.y / edge_m, axis.z / edge_m, -smoke->origin[i] / edge_m};
    }
}

/* Spheres are no smoke, and what is a few pixels wide hides nothing. */
static bool is_smoke(const struct kiln_system *system)
{
    return system->enabled && system->look.blend == KILN_BLEND_ALPHA &&
           system->look.shape == KILN_SHAPE_BILLBOARD;
}

/* 0 for a system that throws no shadow. */
static float shadow_of(const struct kiln_scene *scene, uint32_t system, float time_s)
{
    const struct kiln_system *s = &scene->systems[system];
    if (!is_smoke(s))
        return 0.0f;
    return kiln_scene_value(scene, &s->look.shadow, time_s);
}

static void visit_smoke(struct smoke *smoke, const struct kiln_scene *scene,
                        const struct kiln_pool *pool, const struct kiln_particle *records,
                        const struct kiln_view *view, const float4 *table,
                        void (*visit)(void *context, const struct kiln_living *particle))
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        smoke->shadow = shadow_of(scene, i, view->clock.x);
        if (smoke->shadow > 0.0f)
            kiln_living_visit(scene, pool, records, view, table, i, visit, smoke);
    }
}

size_t kiln_smoke_scratch_floats(void)
{
    size_t floats = 0;
    for (int level = 0; level < LEVELS; level++) {
        size_t edge = EDGE >> level;
        floats += edge * edge * edge;
    }
    return floats;
}

bool kiln_smoke_grid_fill(struct kiln_smoke_grid *grid, const struct kiln_scene *scene,
                          const struct kiln_pool *pool, const struct kiln_particle *records,
                          const struct kiln_view *view, const float4 *table, float3 direction,
                          float *scratch)
{
    struct smoke smoke = {.any = false};
    choose_axes(smoke.axes, direction);
    visit_smoke(&smoke, scene, pool, records, view, table, widen);
    if (!smoke.any)
        return false;
    place_grid(&smoke);
    memset(scratch, 0, kiln_smoke_scratch_floats() * sizeof *scratch);
    for (int level = 0; level < LEVELS; level++) {
        size_t edge = EDGE >> level;
        smoke.levels[level] = scratch;
        scratch += edge * edge * edge;
    }
    visit_smoke(&smoke, scene, pool, records, view, table, deposit);
    for (int level = LEVELS - 1; level > 0; level--)
        add_coarser(smoke.levels[level], EDGE >> level, smoke.levels[level - 1]);
    sum_towards_light(&smoke, grid->depth);
    set_rows(&smoke, grid);
    return true;
}

bool kiln_smoke_exists(const struct kiln_scene *scene)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        if (is_smoke(system) && kiln_scene_value_max(scene, &system->look.shadow) > 0.0f)
            return true;
    }
    return false;
}
