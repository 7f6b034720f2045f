/* This file runs flock_look in vectors: it sums up what one bird of a flock sees of the others. The
 * bodies in the cells around the bird are tested block by block. The few that it sees are gathered
 * into blocks of their own, whose parts are added up lane by lane. All sums are of integers, so
 * their order changes no bit. */
#include "sim/crowd/flock.h"

enum { LANES = 16, BLOCK = 64 };

/* The bodies that the particle sees, padded to a multiple of LANES. */
struct seen {
    uint32_t count;
    uint32_t others[BLOCK]; /* slots of these bodies */
    float apart[3][BLOCK], parting[3][BLOCK], square[BLOCK];
};

struct look {
    const struct kiln_flock_birds *birds;
    float3 from, velocity;
    uint32_t self, slot;
    struct seen seen;
    int count;
    int parts[12][LANES]; /* the members of struct flock_sums except its count */
};

static inline void add_parts(struct look *look, uint32_t lane, struct flock_sums parts)
{
    look->parts[0][lane] += parts.apart.x;
    look->parts[1][lane] += parts.apart.y;
    look->parts[2][lane] += parts.apart.z;
    look->parts[3][lane] += parts.parting.x;
    look->parts[4][lane] += parts.parting.y;
    look->parts[5][lane] += parts.parting.z;
    look->parts[6][lane] += parts.away.x;
    look->parts[7][lane] += parts.away.y;
    look->parts[8][lane] += parts.away.z;
    look->parts[9][lane] += parts.aside.x;
    look->parts[10][lane] += parts.aside.y;
    look->parts[11][lane] += parts.aside.z;
}

/* Pads the block with a body that adds nothing to the sums: it is far away and moves as the bird.
 */
static inline void add_nobody(struct seen *seen)
{
    const uint32_t i = seen->count++;
    seen->others[i] = 0;
    seen->square[i] = 1e30f;
    for (int axis = 0; axis < 3; axis++)
        seen->apart[axis][i] = seen->parting[axis][i] = 0.0f;
}

static inline void add_seen(struct look *look)
{
    struct seen *seen = &look->seen;
    const struct kiln_crowd *view = &look->birds->view;
    look->count += (int)seen->count;
    while (seen->count % LANES != 0)
        add_nobody(seen);
    for (uint32_t first = 0; first < seen->count; first += LANES) {
        for (uint32_t lane = 0; lane < LANES; lane++) {
            const uint32_t i = first + lane;
            const struct flock_seen one = {
                .apart = {seen->apart[0][i], seen->apart[1][i], seen->apart[2][i]},
                .parting = {seen->parting[0][i], seen->parting[1][i], seen->parting[2][i]},
                .square = seen->square[i],
                .mine = look->slot,
                .other = seen->others[i],
            };
            add_parts(look, lane, flock_parts_of(view, one));
        }
    }
    seen->count = 0;
}

struct block {
    uint32_t is_seen[BLOCK];
    float apart[3][BLOCK], square[BLOCK];
};

static inline void gather(struct look *look, const struct block *block, uint32_t i, uint32_t body)
{
    const struct kiln_flock_birds *birds = look->birds;
    const float *const *rows = birds->rows;
    const float3 velocity = {rows[3][body], rows[4][body], rows[5][body]};
    const float3 parting = float3_canon(float3_sub(velocity, look->velocity));
    struct seen *seen = &look->seen;
    const uint32_t to = seen->count++;
    seen->others[to] = birds->view.bodies[body].velocity_slot.w;
    seen->square[to] = block->square[i];
    for (int axis = 0; axis < 3; axis++)
        seen->apart[axis][to] = block->apart[axis][i];
    seen->parting[0][to] = parting.x;
    seen->parting[1][to] = parting.y;
    seen->parting[2][to] = parting.z;
    if (seen->count == BLOCK)
        add_seen(look);
}

/* Tests LANES bodies from begin + first on. The rows may be read behind the last body. */
static inline void try_lanes(const struct look *look, struct block *block, uint32_t begin,
                             uint32_t first, int y, int z)
{
    const struct kiln_crowd *view = &look->birds->view;
    const float *const *rows = look->birds->rows;
    const float *const to_x = rows[0] + begin, *const to_y = rows[1] + begin;
    const float *const to_z = rows[2] + begin;
    const float3 from = look->from, velocity = look->velocity;
    for (uint32_t lane = 0; lane < LANES; lane++) {
        const uint32_t i = first + lane;
        const float3 to = {to_x[i], to_y[i], to_z[i]};
        const float3 way = float3_canon(float3_sub(to, from));
        const float square = exact_canon(float3_dot(way, way));
        block->apart[0][i] = way.x;
        block->apart[1][i] = way.y;
        block->apart[2][i] = way.z;
        block->square[i] = square;
        block->is_seen[i] = flock_is_seen(view, velocity, way, square, to, y, z);
    }
}

/* Tests count bodies from begin on, at most BLOCK, and gathers those that the bird sees. */
static inline void try_block(struct look *look, uint32_t begin, uint32_t count, int y, int z)
{
    struct block block;
    for (uint32_t first = 0; first < count; first += LANES)
        try_lanes(look, &block, begin, first, y, z);
    if (look->self >= begin && look->self - begin < count)
        block.is_seen[look->self - begin] = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (block.is_seen[i])
            gather(look, &block, i, begin + i);
    }
}

static inline void try_all(struct look *look, uint32_t begin, uint32_t end, int y, int z)
{
    for (uint32_t first = begin; first < end; first += BLOCK)
        try_block(look, first, end - first < BLOCK ? end - first : BLOCK, y, z);
}

static inline int sum_of(const int *lanes)
{
    int sum = 0;
    for (int i = 0; i < LANES; i++)
        sum += lanes[i];
    return sum;
}

static inline struct flock_triple triple_of(const struct look *look, int first)
{
    return (struct flock_triple){sum_of(look->parts[first]), sum_of(look->parts[first + 1]),
                                 sum_of(look->parts[first + 2])};
}

static struct flock_sums look_around(const struct kiln_flock_birds *birds, uint32_t self)
{
    const struct kiln_crowd *view = &birds->view;
    const struct kiln_body body = view->bodies[self];
    struct look look;
    look.birds = birds;
    look.self = self;
    look.slot = body.velocity_slot.w;
    look.from = body_position(body);
    look.velocity = body_velocity(body);
    look.seen.count = 0;
    look.count = 0;
    memset(look.parts, 0, sizeof look.parts);
    const float cells_per_metre = view->params->cells_per_metre;
    const int x = cell_along(look.from.x, cells_per_metre);
    const int y = cell_along(look.from.y, cells_per_metre);
    const int z = cell_along(look.from.z, cells_per_metre);
    uint32_t left = FLOCK_MOST;
    for (int number = 4; number < 13; number++) {
        const struct flock_row row = flock_row_at(view, x, y, z, number % 9);
        if (flock_row_size(row) > left)
            continue;
        left -= flock_row_size(row);
        try_all(&look, 0, row.behind, row.y, row.z);
        try_all(&look, row.begin, row.end, row.y, row.z);
    }
    add_seen(&look);
    return (struct flock_sums){.count = look.count,
                               .apart = triple_of(&look, 0),
                               .parting = triple_of(&look, 3),
                               .away = triple_of(&look, 6),
                               .aside = triple_of(&look, 9)};
}

const struct kiln_flock_loops KILN_SIMD_NAME(kiln_flock_loops) = {.look = look_around};
