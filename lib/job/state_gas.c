/* This file has the part of a saved state that is gas: the active bricks of the window, what their
 * cells carry, and the velocities and the pressure of all cells. What lies in pieces in memory goes
 * through a buffer, a piece at a time. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "job/state_visit.h"

enum {
    BRICKS_A_TABLE = 128,
    CELL_WORDS = 4,  /* that a cell carries, or a group of extra floats has */
    PLACE_WORDS = 4, /* velocities across the lower faces of a cell, and its pressure */
};

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static float of_bits(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static uint64_t wide_bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static double of_wide_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static size_t brick_count(const struct kiln_gas *gas)
{
    return (size_t)gas->bricks.x * (size_t)gas->bricks.y * (size_t)gas->bricks.z;
}

struct kiln_state_gas kiln_state_gas_of(const struct kiln_gas *gas)
{
    struct kiln_state_gas head = {
        .at = {(uint32_t)gas->at.x, (uint32_t)gas->at.y, (uint32_t)gas->at.z},
        .cells = {(uint32_t)gas->cells.x, (uint32_t)gas->cells.y, (uint32_t)gas->cells.z},
        .groups = kiln_gas_groups(&gas->shape),
        .fastest = bits_of(gas->fastest),
        .kept = bits_of(gas->kept),
        .smoke = wide_bits_of(gas->smoke),
        .growth = wide_bits_of(gas->growth),
        .due = wide_bits_of(gas->due),
    };
    for (size_t i = 0; i < brick_count(gas); i++)
        head.bricks += gas->brick[i].now != NULL;
    return head;
}

bool kiln_state_gas_is_plausible(const struct kiln_state_gas *head)
{
    const uint32_t *n = head->cells;
    const bool none = n[0] == 0 && n[1] == 0 && n[2] == 0;
    uint64_t bricks = 1;
    bool fits = head->groups <= 3;
    for (int i = 0; i < 3; i++) {
        fits = fits && n[i] % KILN_GAS_STRIDE == 0 && head->at[i] % KILN_GAS_STRIDE == 0 &&
               n[i] <= KILN_MAX_GAS_EDGE && head->at[i] <= KILN_MAX_GAS_EDGE - n[i] &&
               (n[i] > 0 || none);
        bricks *= n[i] / GAS_BRICK;
    }
    return fits && head->bricks <= bricks && isfinite(of_bits(head->fastest)) &&
           isfinite(of_bits(head->kept)) && isfinite(of_wide_bits(head->smoke)) &&
           isfinite(of_wide_bits(head->growth)) && isfinite(of_wide_bits(head->due));
}

bool kiln_state_gas_shape(struct kiln_gas *gas, const struct kiln_state_gas *head, const char *path,
                          struct kiln_error *error)
{
    const uint32_t *at = head->at, *n = head->cells;
    const struct kiln_gas_place all = gas->shape.cells;
    if (head->groups != kiln_gas_groups(&gas->shape) || at[0] + n[0] > (uint32_t)all.x ||
        at[1] + n[1] > (uint32_t)all.y || at[2] + n[2] > (uint32_t)all.z)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the state belongs to other domains of gas", path);
    for (size_t i = 0; i < brick_count(gas); i++)
        kiln_gas_brick_free(gas, &gas->brick[i]);
    if (!kiln_gas_set_window(
            gas, (struct kiln_gas_place){(int32_t)at[0], (int32_t)at[1], (int32_t)at[2]},
            (struct kiln_gas_place){(int32_t)n[0], (int32_t)n[1], (int32_t)n[2]}))
        return kiln_error_no_memory(error, "gas");
    gas->fastest = of_bits(head->fastest);
    gas->kept = of_bits(head->kept);
    gas->smoke = of_wide_bits(head->smoke);
    gas->growth = of_wide_bits(head->growth);
    gas->due = of_wide_bits(head->due);
    return true;
}

/* ---- tables ---------------------------------------------------------------------------------- */

/* What visiting a gas needs. */
struct visit {
    const struct kiln_state_visitor *visitor;
    const struct kiln_state_gas *head;
    struct kiln_gas *gas; /* NULL: the tables are only checked */
    uint32_t *list;       /* of active bricks: twice the number, and 1 if it has gas */
    uint32_t *buffer;     /* NULL: the tables are only checked */
};

static bool writes(const struct visit *v)
{
    return v->visitor->out != NULL;
}

static bool refuse(const struct visit *v, struct kiln_error *error)
{
    return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the gas of the state is damaged",
                          v->visitor->path);
}

/* Gives the listed bricks their chunks. The list must rise, so that no brick is listed twice. */
static bool take_bricks(const struct visit *v, struct kiln_error *error)
{
    const size_t count = brick_count(v->gas);
    for (uint32_t i = 0; i < v->head->bricks; i++) {
        const uint32_t number = v->list[i] / 2;
        if (number >= count || (i > 0 && number <= v->list[i - 1] / 2))
            return refuse(v, error);
        if (!kiln_gas_brick_take(v->gas, &v->gas->brick[number]))
            return kiln_error_no_memory(error, "gas");
        v->gas->has_gas[number] = v->list[i] & 1;
    }
    return true;
}

static bool visit_list(const struct visit *v, struct kiln_error *error)
{
    uint32_t listed = 0;
    for (size_t i = 0; v->gas && writes(v) && i < brick_count(v->gas); i++)
        if (v->gas->brick[i].now)
            v->list[listed++] = 2 * (uint32_t)i + v->gas->has_gas[i];
    const struct kiln_table table = {v->list, v->head->bricks, 1, 1};
    return v->visitor->visit(v->visitor, &table, error) &&
           (!v->gas || writes(v) || take_bricks(v, error));
}

/* Returns what cells of a brick carry: its own four floats, or a group of extra ones. */
static float *carried_of(const struct visit *v, uint32_t listed, uint32_t group)
{
    const struct kiln_gas_brick *brick = &v->gas->brick[v->list[listed] / 2];
    return group == 0 ? brick->now
                      : brick->extras + (size_t)(group - 1) * GAS_BRICK_CELLS * CELL_WORDS;
}

static bool visit_carried(const struct visit *v, uint32_t group, struct kiln_error *error)
{
    const size_t words = (size_t)GAS_BRICK_CELLS * CELL_WORDS, bytes = words * sizeof *v->buffer;
    for (uint32_t first = 0; first < v->head->bricks; first += BRICKS_A_TABLE) {
        const uint32_t left = v->head->bricks - first;
        const uint32_t count = left < BRICKS_A_TABLE ? left : BRICKS_A_TABLE;
        const struct kiln_table table = {v->buffer, (size_t)count * GAS_BRICK_CELLS, CELL_WORDS, 0};
        for (uint32_t i = 0; v->gas && writes(v) && i < count; i++)
            memcpy(v->buffer + i * words, carried_of(v, first + i, group), bytes);
        if (!v->visitor->visit(v->visitor, &table, error))
            return false;
        for (uint32_t i = 0; v->gas && !writes(v) && i < count; i++)
            memcpy(carried_of(v, first + i, group), v->buffer + i * words, bytes);
    }
    return true;
}

/* Returns the four numbers of a place in the window's arrays; the last plane, row and place of each
 * row have only faces. */
static float *number_at(const struct visit *v, int32_t x, int32_t y, int32_t z, int which)
{
    const struct kiln_gas *gas = v->gas;
    const ptrdiff_t row = z * gas->plane + y * gas->row;
    return which < 3 ? gas->faces[which] + row + x
                     : gas->pressure + row + (x & 1) * (gas->row / 2) + x / 2;
}

static bool has_number(const struct visit *v, int32_t x, int32_t y, int32_t z, int which)
{
    const struct kiln_gas_place n = v->gas->cells;
    const bool in[3] = {x < n.x, y < n.y, z < n.z};
    return (in[0] || which == 0) && (in[1] || which == 1) && (in[2] || which == 2);
}

/* Copies the numbers of a plane to the buffer, or back. */
static void copy_plane(const struct visit *v, int32_t z)
{
    const struct kiln_gas_place n = v->gas->cells;
    uint32_t *word = v->buffer;
    for (int32_t y = 0; y <= n.y; y++)
        for (int32_t x = 0; x <= n.x; x++)
            for (int which = 0; which < PLACE_WORDS; which++, word++) {
                const bool has = has_number(v, x, y, z, which);
                if (!writes(v) && has)
                    *number_at(v, x, y, z, which) = of_bits(*word);
                if (writes(v))
                    *word = has ? bits_of(*number_at(v, x, y, z, which)) : 0;
            }
}

static size_t plane_places(const struct kiln_state_gas *head)
{
    return (size_t)(head->cells[0] + 1) * (head->cells[1] + 1);
}

static bool visit_planes(const struct visit *v, struct kiln_error *error)
{
    const int32_t planes = (int32_t)v->head->cells[2];
    const struct kiln_table table = {v->buffer, plane_places(v->head), PLACE_WORDS, 0};
    for (int32_t z = 0; z <= planes && planes > 0; z++) {
        if (v->gas && writes(v))
            copy_plane(v, z);
        if (!v->visitor->visit(v->visitor, &table, error))
            return false;
        if (v->gas && !writes(v))
            copy_plane(v, z);
    }
    return true;
}

/* Returns whether all numbers are such as steps make. */
static bool is_sound(const struct visit *v)
{
    const struct kiln_gas *gas = v->gas;
    const struct kiln_gas_place n = gas->cells;
    const int32_t extras = (int32_t)v->head->groups * GAS_BRICK_CELLS * CELL_WORDS;
    bool sound = true;
    for (size_t i = 0; i < brick_count(gas); i++) {
        const struct kiln_gas_brick *brick = &gas->brick[i];
        for (int32_t k = 0; brick->now && k < GAS_BRICK_CELLS * GAS_CARRIED; k++)
            sound = sound && isfinite(brick->now[k]) && brick->now[k] >= 0.0f;
        for (int32_t k = 0; brick->now && k < extras; k++)
            sound = sound && isfinite(brick->extras[k]);
    }
    for (int32_t z = 0; z <= n.z && n.z > 0; z++)
        for (int32_t y = 0; y <= n.y; y++)
            for (int32_t x = 0; x <= n.x; x++)
                for (int which = 0; which < PLACE_WORDS; which++)
                    sound = sound && (!has_number(v, x, y, z, which) ||
                                      isfinite(*number_at(v, x, y, z, which)));
    return sound;
}

bool kiln_state_gas_visit(const struct kiln_state_visitor *visitor,
                          const struct kiln_state_gas *head, struct kiln_gas *gas,
                          struct kiln_error *error)
{
    struct visit v = {.visitor = visitor, .head = head, .gas = gas};
    const size_t of_bricks = (size_t)BRICKS_A_TABLE * GAS_BRICK_CELLS * CELL_WORDS;
    const size_t of_plane = plane_places(head) * PLACE_WORDS;
    if (gas) {
        v.list = malloc((head->bricks + (size_t)1) * sizeof *v.list);
        v.buffer = malloc((of_bricks > of_plane ? of_bricks : of_plane) * sizeof *v.buffer);
    }
    bool ok = !gas || (v.list && v.buffer) || kiln_error_no_memory(error, "a state of gas");
    ok = ok && visit_list(&v, error);
    for (uint32_t group = 0; ok && group <= head->groups; group++)
        ok = visit_carried(&v, group, error);
    ok = ok && visit_planes(&v, error) && (!gas || writes(&v) || is_sound(&v) || refuse(&v, error));
    free(v.list);
    free(v.buffer);
    return ok;
}
