/* This file finds out which cells of a domain lie in solids, and which faces solids shut. It asks
 * the colliders of particles, cell by cell, in the bricks that their bounds reach; bricks that only
 * standing colliders reach are asked once for each window. */
#include "sim/gas/solids.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "shared/collide.h"
#include "sim/gas/frames.h"

/* Cells whose centres a brick's walls need: its own, and one below them on each axis. */
enum { SIDE = GAS_BRICK + 1, CENTRES = SIDE * SIDE * SIDE, NOT_SOLID = 0xffff };

/* The colliders whose bounds reach a brick. */
struct near {
    uint16_t number[KILN_MAX_COLLIDERS];
    uint32_t count;
};

void gas_solids_init(struct gas_solids *solids, const struct kiln_scene *scene,
                     const struct kiln_gas_domain *domain, struct kiln_threads *threads)
{
    *solids = (struct gas_solids){.scene = scene, .domain = domain, .threads = threads};
}

static size_t brick_count(const struct gas_solids *solids)
{
    return (size_t)solids->bricks.x * (size_t)solids->bricks.y * (size_t)solids->bricks.z;
}

void gas_solids_finish(struct gas_solids *solids)
{
    for (size_t i = 0; solids->walls && i < brick_count(solids); i++)
        free(solids->walls[i]);
    free(solids->walls);
    free(solids->emptied);
    solids->walls = NULL;
    solids->emptied = NULL;
    solids->emptied_count = 0;
    solids->bricks = (struct kiln_gas_place){0, 0, 0};
}

bool gas_solids_wanted(const struct kiln_scene *scene, const struct kiln_gas_domain *domain)
{
    bool any = kiln_backdrop_floor_collides(&scene->backdrop);
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++)
        any = any || scene->backdrop.objects[i].collide;
    return domain->collide && any;
}

/* ---- a brick --------------------------------------------------------------------------------- */

struct work {
    struct gas_solids *solids;
    const struct kiln_gas *gas;
    const struct gas_levels *levels;
    const struct kiln_sim *sim;
    float before, since; /* parts of the step: when walls were made last, and now */
    struct gas_map to_world;
    struct gas_map back;          /* velocities from the world to the domain */
    struct kiln_node_frame frame; /* of the domain */
    const size_t *bricks;         /* to make anew */
    atomic_bool short_of_memory;
};

/* Returns the place in the world of a place in the window, in cells. */
static float3 in_world(const struct work *work, float x, float y, float z)
{
    const struct kiln_gas *gas = work->gas;
    const struct kiln_gas_shape *shape = &gas->shape;
    return gas_mapped(&work->to_world,
                      FLOAT3(shape->corner.x + ((float)gas->at.x + x) * shape->cell,
                             shape->corner.y + ((float)gas->at.y + y) * shape->cell,
                             shape->corner.z + ((float)gas->at.z + z) * shape->cell));
}

/* Returns the velocity of a collider's surface near a place of the world, in the domain's frame. */
static float3 velocity_of(const struct work *work, uint32_t collider, float3 p)
{
    const struct kiln_sim *sim = work->sim;
    const struct kiln_collider c = collide_around(sim, collider, 0.0f);
    const struct collide_state state = {.position = p, .since = work->since};
    const uint face = collide_nearest(sim, collider, 0.0f, work->since, p);
    const float3 v = collide_blow_at(sim, state, c, collider, face, 0.0f).ground;
    return gas_turned(&work->back, float3_sub(v, gas_frame_velocity(&work->frame, p)));
}

static bool reaches(const struct gas_region *region, struct kiln_gas_place b)
{
    return b.x >= region->low.x && b.x < region->high.x && b.y >= region->low.y &&
           b.y < region->high.y && b.z >= region->low.z && b.z < region->high.z;
}

/* Returns the number of the first collider that a segment meets, or NOT_SOLID. */
static uint16_t met_by(const struct work *work, const struct near *near, float3 from, float3 to)
{
    for (uint32_t i = 0; i < near->count; i++) {
        const struct collide_span span =
            collide_through(work->sim, near->number[i], 0.0f, work->since, work->since, from, to);
        if (!span.misses && span.enter < span.leave)
            return near->number[i];
    }
    return NOT_SOLID;
}

/* Fills in the collider that each centre lies in: NOT_SOLID: in none. */
static void find_centres(const struct work *work, struct kiln_gas_place brick,
                         const struct near *near, uint16_t in[CENTRES], float3 at[CENTRES])
{
    for (int32_t k = 0; k < CENTRES; k++) {
        const int32_t x = brick.x * GAS_BRICK + k % SIDE - 1;
        const int32_t y = brick.y * GAS_BRICK + k / SIDE % SIDE - 1;
        const int32_t z = brick.z * GAS_BRICK + k / (SIDE * SIDE) - 1;
        at[k] = in_world(work, (float)x + 0.5f, (float)y + 0.5f, (float)z + 0.5f);
        in[k] = NOT_SOLID;
        for (uint32_t i = 0; i < near->count && in[k] == NOT_SOLID; i++)
            if (collide_is_inside(work->sim, near->number[i], 0.0f, work->since, at[k]))
                in[k] = near->number[i];
    }
}

static float component(float3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* Shuts the lower faces of a brick's cells. Returns whether any is shut. */
static bool shut_faces(const struct work *work, const struct near *near, const uint16_t in[CENTRES],
                       const float3 at[CENTRES], struct gas_wall *wall)
{
    static const int32_t stride[3] = {1, SIDE, SIDE * SIDE};
    bool any = false;
    for (int32_t cell = 0; cell < GAS_BRICK_CELLS; cell++) {
        const int32_t x = cell % GAS_BRICK, y = cell / GAS_BRICK % GAS_BRICK;
        const int32_t z = cell / (GAS_BRICK * GAS_BRICK);
        const int32_t k = (z + 1) * stride[2] + (y + 1) * stride[1] + x + 1;
        wall->cell[cell] = in[k] != NOT_SOLID ? GAS_SOLID : 0;
        for (int axis = 0; axis < 3; axis++) {
            const int32_t below = k - stride[axis];
            const uint16_t by = in[k] != NOT_SOLID       ? in[k]
                                : in[below] != NOT_SOLID ? in[below]
                                                         : met_by(work, near, at[below], at[k]);
            wall->open[axis][cell] = by == NOT_SOLID ? 1.0f : 0.0f;
            wall->speed[axis][cell] = 0.0f;
            if (by == NOT_SOLID)
                continue;
            const float3 middle = float3_scale(float3_add(at[below], at[k]), 0.5f);
            any = true;
            wall->cell[cell] |= (uint8_t)(GAS_SHUT_X << axis);
            wall->speed[axis][cell] = component(velocity_of(work, by, middle), axis);
        }
    }
    return any;
}

/* Returns whether a collider that moves has gone over a place since walls were made last: a thin
 * one may be before a centre, and then behind it. */
static bool is_swept(const struct work *work, const struct near *near, float3 p)
{
    for (uint32_t i = 0; i < near->count; i++) {
        if (!work->solids->places[near->number[i]].moves)
            continue;
        const struct collide_span span =
            collide_through(work->sim, near->number[i], 0.0f, work->before, work->since, p, p);
        if (!span.misses && span.enter < span.leave)
            return true;
    }
    return false;
}

/* Names the cells that solids take at the end of a substep: their gas would else be behind those
 * that are thin. */
static void find_emptied(const struct work *work, const struct near *near,
                         const uint16_t in[CENTRES], const float3 at[CENTRES],
                         struct gas_emptied *emptied)
{
    for (int32_t cell = 0; cell < GAS_BRICK_CELLS; cell++) {
        const int32_t x = cell % GAS_BRICK, y = cell / GAS_BRICK % GAS_BRICK;
        const int32_t z = cell / (GAS_BRICK * GAS_BRICK);
        const int32_t k = ((z + 1) * SIDE + y + 1) * SIDE + x + 1;
        if (in[k] != NOT_SOLID || is_swept(work, near, at[k]))
            emptied->cells[cell / 32] |= 1u << (cell % 32);
    }
}

/* Fills `open` of the finest level for a brick. */
static void fill_level(const struct work *work, struct kiln_gas_place b,
                       const struct gas_wall *wall)
{
    const struct gas_level *level = &work->levels->level[0];
    for (int32_t cell = 0; cell < GAS_BRICK_CELLS; cell++) {
        const int32_t x = b.x * GAS_BRICK + cell % GAS_BRICK;
        const int32_t y = b.y * GAS_BRICK + cell / GAS_BRICK % GAS_BRICK;
        const int32_t z = b.z * GAS_BRICK + cell / (GAS_BRICK * GAS_BRICK);
        const int32_t number[3] = {x, y, z};
        for (int axis = 0; axis < 3; axis++) {
            const float all = number[axis] > 0                     ? 1.0f
                              : level->closed[(ptrdiff_t)2 * axis] ? 0.0f
                                                                   : 2.0f;
            level->open[axis][gas_level_at(level, x, y, z)] =
                wall ? all * wall->open[axis][cell] : all;
        }
    }
}

static void make_bricks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct work *work = context;
    struct gas_solids *solids = work->solids;
    for (size_t i = begin; i < end; i++) {
        const size_t number = work->bricks[i];
        const struct kiln_gas_place n = solids->bricks;
        const struct kiln_gas_place b = {(int32_t)(number % (size_t)n.x),
                                         (int32_t)(number / (size_t)n.x % (size_t)n.y),
                                         (int32_t)(number / ((size_t)n.x * (size_t)n.y))};
        struct gas_wall **wall = &solids->walls[number];
        struct gas_emptied *emptied = &solids->emptied[i];
        struct near near = {.count = 0};
        uint16_t in[CENTRES];
        float3 at[CENTRES];
        bool any = false;
        *emptied = (struct gas_emptied){.brick = number};
        for (uint32_t k = 0; k < work->sim->surroundings->collider_count; k++)
            if (reaches(&solids->places[k].region, b))
                near.number[near.count++] = (uint16_t)k;
        if (near.count > 0) {
            find_centres(work, b, &near, in, at);
            if (!*wall)
                *wall = malloc(sizeof **wall);
            if (!*wall) {
                atomic_store(&work->short_of_memory, true);
                return;
            }
            any = shut_faces(work, &near, in, at, *wall);
            if (work->since > work->before && work->gas->brick[number].chunk)
                find_emptied(work, &near, in, at, emptied);
        }
        if (!any) {
            free(*wall);
            *wall = NULL;
        }
        fill_level(work, b, *wall);
    }
}

/* ---- a window -------------------------------------------------------------------------------- */

/* Returns the bricks of the window that a box in the world may reach, with a cell around it. */
static struct gas_region region_of(const struct work *work, float3 low, float3 high)
{
    const struct kiln_gas *gas = work->gas;
    const struct kiln_gas_shape *shape = &gas->shape;
    const struct kiln_node_frame world = {.turn = {0.0, 0.0, 0.0, 1.0}, .scale = 1.0};
    const struct gas_map map = gas_map_between(&world, &work->frame);
    const float3 middle = gas_mapped(&map, float3_scale(float3_add(low, high), 0.5f));
    const float3 half = float3_scale(float3_sub(high, low), 0.5f);
    const float place[3] = {middle.x - shape->corner.x, middle.y - shape->corner.y,
                            middle.z - shape->corner.z};
    const int32_t first[3] = {gas->at.x, gas->at.y, gas->at.z};
    int32_t a[3], b[3];
    for (int i = 0; i < 3; i++) {
        const float reach =
            ((exact_abs(map.row[i][0]) * half.x + exact_abs(map.row[i][1]) * half.y) +
             exact_abs(map.row[i][2]) * half.z) +
            shape->cell;
        const float from = (place[i] - reach) / shape->cell - (float)first[i];
        const float to = (place[i] + reach) / shape->cell - (float)first[i];
        const float most = (float)KILN_MAX_GAS_EDGE;
        a[i] = (int32_t)FLOOR(exact_clamp(from, -1.0f, most) / (float)GAS_BRICK);
        /* a face may also belong to the next brick */
        b[i] = (int32_t)FLOOR(exact_clamp(to + 1.0f, -1.0f, most) / (float)GAS_BRICK) + 1;
    }
    return (struct gas_region){{a[0], a[1], a[2]}, {b[0], b[1], b[2]}};
}

static bool moves(const struct kiln_sim *sim, const struct kiln_collider *c)
{
    const bool of_mesh = c->kind == COLLIDER_SDF || c->kind == COLLIDER_DEPTH;
    const struct kiln_pose *pose = of_mesh ? &sim->surroundings->poses[c->mesh] : NULL;
    return memcmp(&c->min, &c->min_end, 3 * sizeof(float)) != 0 ||
           memcmp(&c->max, &c->max_end, 3 * sizeof(float)) != 0 ||
           memcmp(&c->center, &c->center_end, 3 * sizeof(float)) != 0 ||
           memcmp(&c->extent, &c->extent_end, 3 * sizeof(float)) != 0 || c->spin.w != 0.0f ||
           c->kind == COLLIDER_VOLUME ||
           (pose && memcmp(pose->to_local, pose->to_local_end, sizeof pose->to_local) != 0);
}

/* Adds the bricks of a region to a list, each once. */
static void mark_region(const struct gas_solids *solids, const struct gas_region *region,
                        uint8_t *marks)
{
    const struct kiln_gas_place n = solids->bricks, low = region->low, high = region->high;
    for (int32_t z = low.z < 0 ? 0 : low.z; z < high.z && z < n.z; z++)
        for (int32_t y = low.y < 0 ? 0 : low.y; y < high.y && y < n.y; y++)
            for (int32_t x = low.x < 0 ? 0 : low.x; x < high.x && x < n.x; x++)
                marks[((size_t)z * (size_t)n.y + (size_t)y) * (size_t)n.x + (size_t)x] = 1;
}

bool gas_solids_are_of(const struct gas_solids *solids, const struct kiln_gas *gas)
{
    return solids->walls && solids->window == gas->window;
}

/* Marks the bricks whose walls change. fresh: the walls are of no window yet. */
static void mark_changes(struct work *work, bool fresh, uint8_t *marks)
{
    struct gas_solids *solids = work->solids;
    const bool domain_moves = solids->domain->attach.name != NULL &&
                              !kiln_node_stands(solids->scene, solids->domain->attach.node);
    for (uint32_t i = 0; i < work->sim->surroundings->collider_count; i++) {
        const struct kiln_collider *c = &work->sim->surroundings->colliders[i];
        const struct collide_box box = collide_box_at(*c, work->since);
        struct gas_collider_place *place = &solids->places[i];
        const struct gas_collider_place before = *place;
        *place = (struct gas_collider_place){region_of(work, box.min, box.max),
                                             domain_moves || moves(work->sim, c)};
        const bool changed = fresh || place->moves || before.moves ||
                             memcmp(&before.region, &place->region, sizeof before.region) != 0;
        if (changed && !fresh)
            mark_region(solids, &before.region, marks);
        if (changed)
            mark_region(solids, &place->region, marks);
    }
}

static bool new_window(struct gas_solids *solids, const struct kiln_gas *gas)
{
    gas_solids_finish(solids);
    solids->window = gas->window;
    solids->bricks = gas->bricks;
    solids->made++;
    solids->walls = calloc(brick_count(solids), sizeof *solids->walls);
    return solids->walls != NULL;
}

/* Makes the walls of the marked bricks anew, and fills the levels where they lie. */
static bool make_walls(struct work *work, const uint8_t *marks, size_t *list)
{
    struct gas_solids *solids = work->solids;
    const size_t count = brick_count(solids);
    const size_t plane = (size_t)solids->bricks.x * (size_t)solids->bricks.y;
    size_t listed = 0;
    for (size_t i = 0; i < count; i++)
        if (marks[i])
            list[listed++] = i;
    if (listed == 0)
        return true;
    free(solids->emptied);
    solids->emptied = malloc(listed * sizeof *solids->emptied);
    if (!solids->emptied)
        return false;
    work->bricks = list;
    solids->emptied_count = listed;
    solids->made++;
    kiln_threads_for(solids->threads, listed, 1, make_bricks, work);
    if (atomic_load(&work->short_of_memory))
        return false;
    gas_levels_coarsen(work->levels, (int32_t)(list[0] / plane) * GAS_BRICK,
                       (int32_t)(list[listed - 1] / plane + 1) * GAS_BRICK);
    return true;
}

bool gas_solids_move(struct gas_solids *solids, const struct kiln_gas *gas,
                     const struct gas_levels *levels, const struct kiln_sim *sim, float since,
                     float time_s)
{
    const struct kiln_node_frame world = {.turn = {0.0, 0.0, 0.0, 1.0}, .scale = 1.0};
    const struct kiln_node_frame frame = gas_frame(solids->scene, &solids->domain->attach, time_s);
    const bool fresh = !gas_solids_are_of(solids, gas);
    struct work work = {
        .solids = solids,
        .gas = gas,
        .levels = levels,
        .sim = sim,
        .before = fresh || since < solids->since ? since : solids->since,
        .since = since,
        .to_world = gas_map_between(&frame, &world),
        .back = gas_map_between(&world, &frame),
        .frame = frame,
    };
    if (fresh && !new_window(solids, gas))
        return false;
    solids->emptied_count = 0;
    solids->since = since;
    const size_t count = brick_count(solids);
    uint8_t *marks = calloc(count, 1);
    size_t *list = malloc((count + 1) * sizeof *list);
    bool ok = marks && list;
    if (ok) {
        mark_changes(&work, fresh, marks);
        ok = make_walls(&work, marks, list);
    }
    free(marks);
    free(list);
    return ok;
}
