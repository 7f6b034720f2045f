/* This file samples the velocity of gas at the points of a grid. Points at the border of the grid
 * do nothing, as all that lies beyond it does. Air outside of the window is at rest in the world.
 */
#include "sim/gas/wind.h"

#include <stdlib.h>

#include "base/error.h"
#include "sim/gas/frames.h"
#include "sim/world/force_params.h"

/* Says where a place lies among faces along an axis: `low` is the face at it or below it, `next` is
 * 1, or 0 at the last face, and `part` is how far it is on the way from the one to the other. */
struct between {
    int32_t low, next;
    float part;
};

/* The points of a grid that have the same place along an axis. */
struct line {
    float at; /* m, in the domain */
    bool is_inside /* the window */, is_border /* of the grid */;
    /* Faces across this axis lie at whole numbers of cells, those across the others in the middle
     * of cells. */
    struct between whole, middle;
};

struct work {
    const struct kiln_gas *gas;
    struct kiln_grid grid;
    struct kiln_node_frame frame; /* of the domain */
    double axis[3][3];
    bool moves; /* the domain does */
    float pull;
    float4 *words;               /* of the grid */
    const struct line *lines[3]; /* along x, y and z */
};

static float mix(float a, float b, float part)
{
    return a + (b - a) * part;
}

static struct between find_between(float at, float last)
{
    const float held = exact_clamp(at, 0.0f, last);
    const float whole = FLOOR(held);
    struct between b = {.low = (int32_t)whole, .part = held - whole};
    b.next = b.low < (int32_t)last ? 1 : 0;
    return b;
}

/* Finds the places of `count` points along an axis, `spacing` m from each other, in the window.
 * Each point of the grid has three of them, so that they are not found anew for each point. */
static void find_lines(struct line *lines, uint32_t count, float first, float spacing, float corner,
                       float cell, int32_t window_at, int32_t window_cells)
{
    const float most = (float)window_cells;
    for (uint32_t i = 0; i < count; i++) {
        const float at = first + (float)i * spacing;
        const float place = (at - corner) / cell - (float)window_at;
        lines[i] = (struct line){.at = at,
                                 .is_inside = window_cells > 0 && place >= 0.0f && place <= most,
                                 .is_border = i == 0 || i + 1 == count,
                                 .whole = find_between(place, most),
                                 .middle = find_between(place - 0.5f, most - 1.0f)};
    }
}

/* Returns the velocity across the faces of an axis where three lines meet: the mean of the eight
 * faces around that place. */
static float velocity_at(const struct kiln_gas *gas, int axis, const struct line *const lines[3])
{
    const struct between *b[3];
    for (int i = 0; i < 3; i++)
        b[i] = i == axis ? &lines[i]->whole : &lines[i]->middle;
    const float *f = gas->faces[axis] + b[2]->low * gas->plane + b[1]->low * gas->row + b[0]->low;
    const ptrdiff_t x = b[0]->next, y = b[1]->next * gas->row, z = b[2]->next * gas->plane;
    const float part[3] = {b[0]->part, b[1]->part, b[2]->part};
    const float near = mix(mix(f[0], f[x], part[0]), mix(f[y], f[y + x], part[0]), part[1]);
    const float far =
        mix(mix(f[z], f[z + x], part[0]), mix(f[z + y], f[z + y + x], part[0]), part[1]);
    return mix(near, far, part[2]);
}

/* Returns the velocity of the domain's own motion at a place of the domain, in its axes, m/s of the
 * world. */
static float3 own_velocity(const struct work *work, float3 p)
{
    const struct kiln_node_frame *f = &work->frame;
    const double in[3] = {(double)p.x * f->scale, (double)p.y * f->scale, (double)p.z * f->scale};
    double at[3], v[3];
    for (int c = 0; c < 3; c++)
        at[c] = work->axis[0][c] * in[0] + work->axis[1][c] * in[1] + work->axis[2][c] * in[2];
    v[0] = f->velocity[0] + (f->spin[1] * at[2] - f->spin[2] * at[1]);
    v[1] = f->velocity[1] + (f->spin[2] * at[0] - f->spin[0] * at[2]);
    v[2] = f->velocity[2] + (f->spin[0] * at[1] - f->spin[1] * at[0]);
    float y[3];
    for (int i = 0; i < 3; i++)
        y[i] = exact_canon(
            (float)(work->axis[i][0] * v[0] + work->axis[i][1] * v[1] + work->axis[i][2] * v[2]));
    return FLOAT3(y[0], y[1], y[2]);
}

static float4 word_at(const struct work *work, const struct line *const lines[3], float metres)
{
    const struct kiln_gas *gas = work->gas;
    float3 v = FLOAT3(0.0f, 0.0f, 0.0f);
    if (lines[0]->is_inside && lines[1]->is_inside && lines[2]->is_inside) {
        if (work->moves)
            v = own_velocity(work, FLOAT3(lines[0]->at, lines[1]->at, lines[2]->at));
        v = float3_add_scaled(v,
                              FLOAT3(velocity_at(gas, 0, lines), velocity_at(gas, 1, lines),
                                     velocity_at(gas, 2, lines)),
                              metres);
    }
    const bool at_border = lines[0]->is_border || lines[1]->is_border || lines[2]->is_border;
    const float pull = at_border ? 0.0f : work->pull;
    return FLOAT4(exact_canon(v.x * pull), exact_canon(v.y * pull), exact_canon(v.z * pull), pull);
}

static void write_planes(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    const struct kiln_grid *grid = &work->grid;
    const float metres = exact_canon((float)work->frame.scale);
    for (size_t z = begin; z < end; z++)
        for (uint32_t y = 0; y < grid->size.y; y++) {
            float4 *row = work->words + (z * grid->size.y + y) * grid->size.x;
            for (uint32_t x = 0; x < grid->size.x; x++) {
                const struct line *const lines[3] = {&work->lines[0][x], &work->lines[1][y],
                                                     &work->lines[2][z]};
                row[x] = word_at(work, lines, metres);
            }
        }
}

/* Writes the grid of one wind. */
static bool write_grid(struct work *work, struct kiln_threads *threads, struct kiln_error *error)
{
    const struct kiln_gas *gas = work->gas;
    const struct kiln_gas_shape *shape = &gas->shape;
    const struct kiln_grid *grid = &work->grid;
    struct line *lines =
        malloc(((size_t)grid->size.x + grid->size.y + grid->size.z) * sizeof *lines);
    if (!lines)
        return kiln_error_no_memory(error, "winds of gas");
    struct line *const y = lines + grid->size.x, *const z = y + grid->size.y;
    find_lines(lines, grid->size.x, grid->origin.x, grid->high.x, shape->corner.x, shape->cell,
               gas->at.x, gas->cells.x);
    find_lines(y, grid->size.y, grid->origin.y, grid->high.y, shape->corner.y, shape->cell,
               gas->at.y, gas->cells.y);
    find_lines(z, grid->size.z, grid->origin.z, grid->high.z, shape->corner.z, shape->cell,
               gas->at.z, gas->cells.z);
    work->lines[0] = lines;
    work->lines[1] = y;
    work->lines[2] = z;
    kiln_threads_for(threads, grid->size.z, 1, write_planes, work);
    free(lines);
    return true;
}

bool kiln_gas_winds_write(const struct kiln_scene *scene, struct kiln_pool *pool,
                          const struct kiln_sim_params *params, struct kiln_threads *threads,
                          uint32_t step, struct kiln_error *error)
{
    struct kiln_sim_grids *grids = params->grids;
    const float end_s = kiln_scene_time(scene, step), forces_s = kiln_sim_forces_s(scene, step);
    for (uint32_t i = 0; i < scene->system_count && pool->gas_count > 0; i++)
        for (uint32_t k = 0; k < scene->systems[i].force_count; k++) {
            const struct kiln_force *force = &scene->systems[i].forces[k];
            if (force->kind != KILN_FORCE_GAS)
                continue;
            float4 *words = kiln_buffer_host(&grids->words, KILN_READ_WRITE, error);
            if (!words || !kiln_gas_fetch(&pool->gas[force->domain], error))
                return false;
            const struct kiln_gas_domain *domain = &scene->gas[force->domain];
            const struct kiln_grid *grid =
                &params->surroundings.grids[kiln_sim_grids_find_baked(grids, force)];
            struct work work = {
                .gas = &pool->gas[force->domain],
                .grid = *grid,
                .frame = gas_frame(scene, &domain->attach, end_s),
                .moves = domain->attach.name && !kiln_node_stands(scene, domain->attach.node),
                .pull = exact_canon(kiln_scene_system_value(scene, i, &force->pull, forces_s)),
                .words = words + grid->size.w,
            };
            gas_axes(&work.frame, work.axis);
            if (!write_grid(&work, threads, error))
                return false;
        }
    return true;
}
