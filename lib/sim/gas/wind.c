/* This file samples the velocity of gas at the points of a grid. Points at the border of the grid
 * do nothing, as all that lies beyond it does. Air outside of the window is at rest in the world.
 */
#include "sim/gas/wind.h"

#include "sim/gas/frames.h"
#include "sim/world/force_params.h"

struct work {
    const struct kiln_gas *gas;
    struct kiln_grid grid;
    struct kiln_node_frame frame; /* of the domain */
    double axis[3][3];
    bool moves; /* the domain does */
    float pull;
    float4 *words; /* of the grid */
};

static float mix(float a, float b, float part)
{
    return a + (b - a) * part;
}

/* Returns the velocity across the faces of an axis at a place in the window, in cells from its
 * corner: the mean of the eight faces around it. */
static float velocity_at(const struct kiln_gas *gas, int axis, const float place[3])
{
    const int32_t count[3] = {gas->cells.x, gas->cells.y, gas->cells.z};
    int32_t low[3], next[3];
    float part[3];
    for (int i = 0; i < 3; i++) {
        /* faces lie at whole numbers along their axis, and in the middle of cells along the others
         */
        const float at = i == axis ? place[i] : place[i] - 0.5f;
        const float last = (float)(count[i] - (i == axis ? 0 : 1));
        const float held = exact_clamp(at, 0.0f, last);
        const float whole = FLOOR(held);
        low[i] = (int32_t)whole;
        part[i] = held - whole;
        next[i] = low[i] < (int32_t)last ? 1 : 0;
    }
    const float *f = gas->faces[axis] + low[2] * gas->plane + low[1] * gas->row + low[0];
    const ptrdiff_t x = next[0], y = next[1] * gas->row, z = next[2] * gas->plane;
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

static void write_planes(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct work *work = context;
    const struct kiln_gas *gas = work->gas;
    const struct kiln_gas_shape *shape = &gas->shape;
    const struct kiln_grid *grid = &work->grid;
    const float metres = exact_canon((float)work->frame.scale);
    for (size_t z = begin; z < end; z++)
        for (uint32_t y = 0; y < grid->size.y; y++)
            for (uint32_t x = 0; x < grid->size.x; x++) {
                const float3 p = FLOAT3(grid->origin.x + (float)x * grid->high.x,
                                        grid->origin.y + (float)y * grid->high.y,
                                        grid->origin.z + (float)z * grid->high.z);
                const float place[3] = {(p.x - shape->corner.x) / shape->cell - (float)gas->at.x,
                                        (p.y - shape->corner.y) / shape->cell - (float)gas->at.y,
                                        (p.z - shape->corner.z) / shape->cell - (float)gas->at.z};
                const float most[3] = {(float)gas->cells.x, (float)gas->cells.y,
                                       (float)gas->cells.z};
                bool inside = gas->cells.x > 0;
                for (int c = 0; c < 3; c++)
                    inside = inside && place[c] >= 0.0f && place[c] <= most[c];
                float3 v = FLOAT3(0.0f, 0.0f, 0.0f);
                if (inside && work->moves)
                    v = own_velocity(work, p);
                if (inside)
                    v = float3_add_scaled(v,
                                          FLOAT3(velocity_at(gas, 0, place),
                                                 velocity_at(gas, 1, place),
                                                 velocity_at(gas, 2, place)),
                                          metres);
                const bool at_border = x == 0 || x + 1 == grid->size.x || y == 0 ||
                                       y + 1 == grid->size.y || z == 0 || z + 1 == grid->size.z;
                const float pull = at_border ? 0.0f : work->pull;
                work->words[(z * grid->size.y + y) * grid->size.x + x] =
                    FLOAT4(exact_canon(v.x * pull), exact_canon(v.y * pull),
                           exact_canon(v.z * pull), pull);
            }
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
            kiln_threads_for(threads, grid->size.z, 1, write_planes, &work);
        }
    return true;
}
