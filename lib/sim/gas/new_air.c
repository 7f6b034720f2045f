/* This file sets the velocity of air that a window reaches when it is moved: the air beyond a
 * window is not simulated, but forces have moved it as they have moved the air in it. A wind that
 * blows everywhere then blows in all of a domain alike, however large its window is.
 *
 * The nearest face of the old window has all that has happened to its air: winds that varied, drag,
 * pressure. New air takes that over by how much alike the forces are at both places, so that air
 * beyond the region of a force stays at rest. Nothing else is kept of the air outside, so that a
 * state has all that a run needs to go on from it. */
#include "sim/gas/new_air.h"

#include "shared/exact.h"

/* Returns the velocity of resting air along an axis. place: m, in the domain. */
static float rest_at_point(const struct gas_rest *rest, int axis, const float place[3])
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    return rest->velocity[axis] + (rest->spin[a] * place[b] - rest->spin[b] * place[a]);
}

/* Returns the velocity of resting air across a face. cell: in the domain, the one above the face.
 */
static float rest_across(const struct gas_rest *rest, const struct kiln_gas_shape *shape, int axis,
                         struct kiln_gas_place cell)
{
    const float corner[3] = {shape->corner.x, shape->corner.y, shape->corner.z};
    const int32_t number[3] = {cell.x, cell.y, cell.z};
    float place[3]; /* m: of the face */
    for (int i = 0; i < 3; i++) {
        const float half = i == axis ? 0.0f : 0.5f;
        place[i] = corner[i] + ((float)number[i] + half) * shape->cell;
    }
    return rest_at_point(rest, axis, place);
}

static bool is_still(const struct gas_rest *rest)
{
    bool still = true;
    for (int i = 0; i < 3; i++)
        still = still && rest->velocity[i] == 0.0f && rest->spin[i] == 0.0f;
    return still;
}

/* Holds the cells from `low` to before `high` that a window has in common with the one before, in
 * the window. */
struct kept {
    struct kiln_gas_place low, high;
};

static int32_t clamped(int32_t x, int32_t low, int32_t high)
{
    return x < low ? low : x > high ? high : x;
}

static struct kept kept_of(const struct kiln_gas *gas, struct kiln_gas_place old_at,
                           struct kiln_gas_place old)
{
    const struct kiln_gas_place at = gas->at, n = gas->cells;
    return (struct kept){{clamped(old_at.x - at.x, 0, n.x), clamped(old_at.y - at.y, 0, n.y),
                          clamped(old_at.z - at.z, 0, n.z)},
                         {clamped(old_at.x + old.x - at.x, 0, n.x),
                          clamped(old_at.y + old.y - at.y, 0, n.y),
                          clamped(old_at.z + old.z - at.z, 0, n.z)}};
}

static bool is_empty(const struct kept *kept)
{
    return kept->high.x <= kept->low.x || kept->high.y <= kept->low.y ||
           kept->high.z <= kept->low.z;
}

/* Returns the nearest face to one of the window that the old window had. Faces are of the cell
 * above. */
static struct kiln_gas_place nearest(const struct kept *kept, int axis, struct kiln_gas_place face)
{
    const struct kiln_gas_place low = kept->low, high = kept->high;
    return (struct kiln_gas_place){clamped(face.x, low.x, high.x - (axis != 0)),
                                   clamped(face.y, low.y, high.y - (axis != 1)),
                                   clamped(face.z, low.z, high.z - (axis != 2))};
}

static bool is_same(struct kiln_gas_place a, struct kiln_gas_place b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* ---- the velocity of a face ------------------------------------------------------------------ */

/* Holds what new air is computed from. */
struct filling {
    struct kiln_gas *gas;
    struct kept kept;
    const struct gas_rest *rest;
    const struct gas_lattice *forces; /* NULL: new air is at rest */
    float blown_s, drag;
};

static float *face_at(const struct filling *f, int axis, struct kiln_gas_place face)
{
    return &f->gas->faces[axis][face.z * f->gas->plane + face.y * f->gas->row + face.x];
}

static float rest_at(const struct filling *f, int axis, struct kiln_gas_place face)
{
    const struct kiln_gas_place at = f->gas->at;
    const struct kiln_gas_place cell = {at.x + face.x, at.y + face.y, at.z + face.z};
    return rest_across(f->rest, &f->gas->shape, axis, cell);
}

/* Returns the forces at the point of the lattice that is nearest to a face. */
static float4 forces_at(const struct gas_lattice *forces, struct kiln_gas_place face)
{
    const int32_t half = GAS_LATTICE / 2;
    const uint32_t x = (uint32_t)((face.x + half) / GAS_LATTICE);
    const uint32_t y = (uint32_t)((face.y + half) / GAS_LATTICE);
    const uint32_t z = (uint32_t)((face.z + half) / GAS_LATTICE);
    return forces->points[z * forces->plane + y * forces->row + x];
}

/* Returns how much alike forces are on air of a speed, 0 to 1: the product of the forces on the old
 * air and on the new by the square of the former. The pull counts by the acceleration that it is at
 * this speed. */
static float likeness(float4 before, float4 here, float speed)
{
    const float square = speed * speed;
    const float both = ((before.x * here.x + before.y * here.y) + before.z * here.z) +
                       (before.w * here.w) * square;
    const float own = ((before.x * before.x + before.y * before.y) + before.z * before.z) +
                      (before.w * before.w) * square;
    return own > 0.0f ? exact_clamp(exact_div(both, own), 0.0f, 1.0f) : 0.0f;
}

/* Returns the velocity of air that was at rest, which a wind pulls at, and drag holds. Where no
 * wind blows, it stays at rest: what only accelerates it, pressure mostly holds in balance. */
static float blown(const struct filling *f, int axis, float4 force)
{
    const float along[3] = {force.x, force.y, force.z};
    if (force.w <= f->drag)
        return 0.0f;
    return exact_div(along[axis], force.w) * (1.0f - exact_exp(-force.w * f->blown_s));
}

static float velocity_of(const struct filling *f, int axis, struct kiln_gas_place face)
{
    const float still = rest_at(f, axis, face);
    if (!f->forces)
        return still;
    const float4 force = forces_at(f->forces, face);
    if (is_empty(&f->kept))
        return still + blown(f, axis, force);
    const struct kiln_gas_place old = nearest(&f->kept, axis, face);
    const float moved = *face_at(f, axis, old) - rest_at(f, axis, old);
    return still + moved * likeness(forces_at(f->forces, old), force, moved);
}

/* Sets the faces of the window that the old one did not have. */
static void fill(const struct filling *f)
{
    const struct kiln_gas_place n = f->gas->cells;
    const bool all = is_empty(&f->kept);
    for (int axis = 0; axis < 3; axis++)
        for (int32_t z = 0; z < n.z + (axis == 2); z++)
            for (int32_t y = 0; y < n.y + (axis == 1); y++)
                for (int32_t x = 0; x < n.x + (axis == 0); x++) {
                    const struct kiln_gas_place face = {x, y, z};
                    if (all || !is_same(nearest(&f->kept, axis, face), face))
                        *face_at(f, axis, face) = exact_canon(velocity_of(f, axis, face));
                }
}

void gas_new_air_rest(struct kiln_gas *gas, struct kiln_gas_place old_at,
                      struct kiln_gas_place old_cells, const struct gas_rest *rest)
{
    const struct filling f = {.gas = gas, .kept = kept_of(gas, old_at, old_cells), .rest = rest};
    if (!is_still(rest))
        fill(&f);
}

void gas_new_air_blown(struct kiln_gas *gas, struct kiln_gas_place old_at,
                       struct kiln_gas_place old_cells, const struct gas_rest *rest,
                       const struct gas_lattice *forces, float blown_s, float drag)
{
    const struct filling f = {.gas = gas,
                              .kept = kept_of(gas, old_at, old_cells),
                              .rest = rest,
                              .forces = forces,
                              .blown_s = blown_s,
                              .drag = drag};
    fill(&f);
}

/* ---- air beyond open sides ------------------------------------------------------------------- */

static void include_speed(struct gas_lattice *forces, int axis, float speed)
{
    forces->least[axis] = speed < forces->least[axis] ? speed : forces->least[axis];
    forces->most[axis] = speed > forces->most[axis] ? speed : forces->most[axis];
}

/* Includes the velocities of a point of the lattice. place: m, in the domain. */
static void include_point(struct gas_lattice *forces, const struct gas_rest *rest, float4 force,
                          float drag, const float place[3])
{
    const float along[3] = {force.x, force.y, force.z};
    for (int axis = 0; axis < 3; axis++) {
        include_speed(forces, axis, exact_canon(rest_at_point(rest, axis, place)));
        if (force.w > drag)
            include_speed(forces, axis, exact_canon(exact_div(along[axis], force.w)));
    }
}

void gas_new_air_bounds(struct gas_lattice *forces, const struct kiln_gas *gas,
                        const struct gas_rest *rest, float drag)
{
    const struct kiln_gas_shape *shape = &gas->shape;
    const int32_t last[3] = {gas->cells.x / GAS_LATTICE, gas->cells.y / GAS_LATTICE,
                             gas->cells.z / GAS_LATTICE};
    const float apart = shape->cell * (float)GAS_LATTICE;
    const float corner[3] = {shape->corner.x + (float)gas->at.x * shape->cell,
                             shape->corner.y + (float)gas->at.y * shape->cell,
                             shape->corner.z + (float)gas->at.z * shape->cell};
    for (int axis = 0; axis < 3; axis++)
        forces->least[axis] = forces->most[axis] = exact_canon(rest_at_point(rest, axis, corner));
    for (int32_t z = 0; z <= last[2]; z++)
        for (int32_t y = 0; y <= last[1]; y++) {
            const bool border = y == 0 || z == 0 || y == last[1] || z == last[2];
            const float4 *row =
                forces->points + (size_t)z * forces->plane + (size_t)y * forces->row;
            for (int32_t x = 0; x <= last[0]; x += border ? 1 : last[0]) {
                const float place[3] = {corner[0] + (float)x * apart, corner[1] + (float)y * apart,
                                        corner[2] + (float)z * apart};
                include_point(forces, rest, row[x], drag, place);
            }
        }
}
