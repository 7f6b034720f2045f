/* This header interpolates the parts of the sky and of each lamp that surfaces see past objects;
 * ray_grid_smoke.h does the same with what smoke lets through. A lamp fills a disc of the sky, so
 * its shadows are blurred, and mostly wider than a few pixels; the sky is all around. The picture
 * is divided into strips of blocks of GRID_STEP x GRID_STEP pixels. What is seen is computed at the
 * blocks' corners, the nodes of a grid. A pixel takes it from its block's corners where no shadow
 * can be missed: the corners and the pixel lie on one smooth piece of surface, what is seen hardly
 * bends between nodes, and for a lamp, every object that may hide it has a penumbra wider than the
 * block. All other pixels compute it. Blocks do not depend on the width of vectors, so neither does
 * the picture; the pixels of a vector are in one block. */
#ifndef KILN_DRAW_BACKDROP_RAY_GRID_H
#define KILN_DRAW_BACKDROP_RAY_GRID_H

#include <assert.h>

#include "draw/backdrop/ray_shapes.h"
#include "draw/backdrop/ray_sky.h"
#include "draw/light/ray_lamp.h"
#include "shared/lamp.h"

enum {
    GRID_WIDTH = 64,
    GRID_HEIGHT = 8, /* of a strip, px */
    GRID_STEP = 4,   /* edge of a block, px */
    GRID_COLUMNS = GRID_WIDTH / GRID_STEP + 1,
    GRID_ROWS = GRID_HEIGHT / GRID_STEP + 1,
    GRID_NODES = GRID_COLUMNS * GRID_ROWS,
    GRID_NODE_ROOM = 64, /* GRID_NODES, rounded up to whole vectors */
    GRID_BLOCKS_A_ROW = GRID_WIDTH / GRID_STEP,
    GRID_BLOCKS = GRID_BLOCKS_A_ROW * (GRID_HEIGHT / GRID_STEP),
    GRID_LAMPS = KILN_MOST_LAMPS,
    /* Numbers of lights after those of lamps, and of all lights that smoke may hide. */
    GRID_SUN = GRID_LAMPS,
    GRID_SKY,
    GRID_SMOKY,
};

/* The least cosine between normals of one smooth piece of surface, and how far its points may lie
 * off its plane, as a part of their distance from each other. */
#define GRID_ALIKE_COSINE 0.98f
#define GRID_ALIKE_SLOPE  0.15f

/* How much what is seen may bend (bend_around), in parts of a lamp or of the sky. */
#define GRID_BEND     0.015f
#define GRID_SKY_BEND 0.01f

/* The least width of the filter that blurs shadows from maps, as a part of a block's extent. */
#define GRID_BLUR 0.25f

/* Describes what is interpolated. */
struct grid_lights {
    struct kiln_lamp_set lamps;
    bool sky;
};

struct light_grid {
    /* by node */
    _Alignas(64) float surface[GRID_NODE_ROOM];
    float at[3][GRID_NODE_ROOM], normal[3][GRID_NODE_ROOM];
    float seen[GRID_LAMPS][GRID_NODE_ROOM]; /* of each lamp; -1: the node faces away from it */
    float blur[GRID_LAMPS][GRID_NODE_ROOM]; /* of shadows from maps, m */
    float sky[GRID_NODE_ROOM];              /* the part that is seen; -1: no surface */
    /* the part of each light that smoke lets through, if there is any; -1: no surface */
    float past_smoke[GRID_SMOKY][GRID_NODE_ROOM];
    bool smoky[GRID_SMOKY]; /* false: no smoke hides the light from the pixels */
    /* by block */
    int32_t alike[GRID_BLOCKS];              /* mask: the corners lie on one smooth piece */
    int32_t smooth[GRID_LAMPS][GRID_BLOCKS]; /* mask: what they see of a lamp may be interpolated */
    int32_t sky_smooth[GRID_BLOCKS];         /* mask: the same of the sky */
    int32_t smoke_smooth[GRID_SMOKY][GRID_BLOCKS]; /* mask: the same of past_smoke */
    float size2[GRID_BLOCKS];                      /* square of the extent of the corners, m2 */
};

SIMD struct vf3 gather_vector(const float (*from)[GRID_NODE_ROOM], vi node)
{
    return (struct vf3){vf_gather(from[0], node), vf_gather(from[1], node),
                        vf_gather(from[2], node)};
}

/* ---- nodes ----------------------------------------------------------------------------------- */

/* Stores the hits of LANES nodes. within: mask of those in the picture. */
SIMD void place_nodes(int first, const struct ray_hit *hit, struct vf3 at, vi within,
                      struct light_grid *grid)
{
    const vi active = within & (hit->surface >= 0.0f);
    vf_store(grid->surface + first, vf_select(active, hit->surface, vf_all(-1.0f)));
    const vf numbers[6] = {at.x, at.y, at.z, hit->normal.x, hit->normal.y, hit->normal.z};
    for (int i = 0; i < 3; i++) {
        vf_store(grid->at[i] + first, numbers[i]);
        vf_store(grid->normal[i] + first, numbers[3 + i]);
    }
}

SIMD struct vf3 load_vector(const float (*from)[GRID_NODE_ROOM], int first)
{
    return (struct vf3){vf_load(from[0] + first), vf_load(from[1] + first),
                        vf_load(from[2] + first)};
}

/* Computes what LANES nodes see of lamp i. */
SIMD void light_nodes(const struct kiln_ray_frame *frame, uint32_t i, int first,
                      struct light_grid *grid)
{
    const struct kiln_draw_light *lamp = &frame->backdrop->lights[i];
    const struct vf3 at = load_vector(grid->at, first), normal = load_vector(grid->normal, first);
    const struct vf3 towards = vf3_towards(lamp->position_radius2, at);
    const vi faces =
        (vf_load(grid->surface + first) >= 0.0f) & (lamp_irradiance(*lamp, towards, normal) > 0.0f);
    struct light_receiver lit = {.visible = vf_all(1.0f), .blur = vf_all(0.0f)};
    if (any(faces))
        lit = lamp_receiver_of(&frame->lamp_objects, lamp, &frame->casters->lamps[i],
                               vf3_add_scaled(at, normal, vf_all(LIGHT_START)), normal, NULL,
                               vf_all(0.0f), faces);
    vf_store(grid->seen[i] + first, vf_select(faces, lit.visible, vf_all(-1.0f)));
    vf_store(grid->blur[i] + first, lit.blur);
}

/* Computes what LANES nodes see of the sky. */
SIMD void light_nodes_by_sky(const struct kiln_ray_frame *frame, int first, struct light_grid *grid)
{
    const vi active = vf_load(grid->surface + first) >= 0.0f;
    vf seen = vf_all(1.0f);
    if (any(active)) {
        const struct ray_point point = {load_vector(grid->at, first),
                                        load_vector(grid->normal, first), active};
        seen = sky_past_objects(frame, &point);
    }
    vf_store(grid->sky + first, vf_select(active, seen, vf_all(-1.0f)));
}

/* ---- blocks ---------------------------------------------------------------------------------- */

/* Returns the lanes where a point lies on the smooth piece of surface around another one, not
 * farther from it than the square root of size2, m. */
SIMD vi on_same_piece(struct vf3 at, struct vf3 normal, struct vf3 other, struct vf3 other_normal,
                      vf size2)
{
    const struct vf3 way = vf3_sub(other, at);
    const vf off = vf3_dot(way, normal), square = vf3_dot(way, way);
    return (vf3_dot(normal, other_normal) > GRID_ALIKE_COSINE) & (square <= size2) &
           (off * off <= GRID_ALIKE_SLOPE * GRID_ALIKE_SLOPE * size2);
}

/* Returns the lanes where a shape may cast a sharp shadow on a block of a surface. */
SIMD vi casts_sharply(const struct kiln_draw_shape *shape, struct vf3 towards,
                      const struct light_way *way, struct vf3 normal)
{
    switch (shape->kind.x) {
#define SHARP(KIND, name)                                                                          \
    case SHAPE_##KIND: {                                                                           \
        const struct name##_seen seen = name##_seen_along(*shape, way->direction);                 \
        const vi hides = name##_may_hide(*shape, seen, towards, *way);                             \
        return any(hides) ? hides & ~name##_is_smooth(*shape, towards, *way, normal) : hides;      \
    }
        KILN_SHAPES(SHARP)
#undef SHARP
    }
    return vi_all(0);
}

/* Returns the lanes of a mask where all shapes cast smooth shadows on a block of a surface.
 * casters: those that may hide the lamp; size: of the block, m. */
SIMD vi shapes_cast_smoothly(const struct kiln_lamp_objects *objects,
                             const struct kiln_draw_light *lamp,
                             const struct kiln_shape_set *casters, struct vf3 at, struct vf3 normal,
                             vf size, vi smooth)
{
    const struct light_way way =
        lamp_way_of(vf3_towards(lamp->position_radius2, at), lamp->color.w, size);
    struct kiln_shape_walk walk = kiln_shape_walk_begin(casters);
    while (any(smooth) && kiln_shape_walk_next(&walk)) {
        const struct kiln_draw_shape *shape = &objects->shapes->shapes[walk.shape];
        const struct vf3 towards = vf3_towards(shape->center, at);
        const vi near = smooth & light_meets_sphere(way, towards, shape->center.w);
        if (any(near))
            smooth &= ~(near & casts_sharply(shape, towards, &way, normal));
    }
    return smooth;
}

/* Returns the second difference of three nodes in a line, without its sign. */
SIMD vf second_difference(const float *values, vi node, int32_t step)
{
    const vf ends = vf_gather(values, node) + vf_gather(values, node + 2 * step);
    return vf_abs(ends - 2.0f * vf_gather(values, node + step));
}

/* Returns how much values of nodes bend around a block: the greatest second difference of three
 * neighbours in a row or in a column. The error of interpolation is about an eighth of it. */
SIMD vf bend_around(const float *values, vi node, vi column, vi row)
{
    const vi left = vi_select(column > 0, node - 1, node);
    const vi right = vi_select(column < GRID_BLOCKS_A_ROW - 1, node + 1, node);
    const vi top = node - row * GRID_COLUMNS;
    vf bend = vf_all(0.0f);
    const vi starts[2] = {left, right};
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 2; k++)
            bend = vf_max(bend, second_difference(values, starts[k] + i * GRID_COLUMNS, 1));
        bend = vf_max(bend, second_difference(values, top + i, GRID_COLUMNS));
    }
    return bend;
}

/* Describes LANES blocks: where each lies in the grid, and its first node. */
struct grid_blocks {
    vi column, row, node;
};

SIMD struct grid_blocks grid_blocks_from(int first)
{
    const vi block = vi_count() + first, row = vi_of(vf_of(block) * (1.0f / GRID_BLOCKS_A_ROW));
    const vi column = block - row * GRID_BLOCKS_A_ROW;
    return (struct grid_blocks){column, row, row * GRID_COLUMNS + column};
}

/* Decides for LANES blocks whether their corners lie on one smooth piece of surface, and which
 * lamps shapes hide smoothly. */
SIMD void judge_surfaces(const struct kiln_ray_frame *frame, int first,
                         const struct kiln_lamp_set *lamps, struct light_grid *grid)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    const vi node = grid_blocks_from(first).node;
    const vi corners[3] = {node + 1, node + GRID_COLUMNS, node + GRID_COLUMNS + 1};
    const struct vf3 at = gather_vector(grid->at, node), normal = gather_vector(grid->normal, node);
    vf size2 = vf_all(0.0f);
    for (int i = 0; i < 3; i++) {
        const struct vf3 way = vf3_sub(gather_vector(grid->at, corners[i]), at);
        size2 = vf_max(size2, vf3_dot(way, way));
    }
    const vf surface = vf_gather(grid->surface, node);
    vi alike = surface >= 0.0f;
    for (int i = 0; i < 3; i++)
        alike &= (vf_gather(grid->surface, corners[i]) == surface) &
                 on_same_piece(at, normal, gather_vector(grid->at, corners[i]),
                               gather_vector(grid->normal, corners[i]), size2);
    memcpy(grid->alike + first, &alike, sizeof alike);
    vf_store(grid->size2 + first, size2);
    for (uint32_t i = 0; i < b->counts.y; i++) {
        if (!kiln_bits_have(lamps->words, i))
            continue;
        const struct kiln_draw_light *lamp = &b->lights[i];
        vi smooth = alike;
        const struct kiln_shape_set *casters = &frame->casters->lamps[i];
        if (kiln_shape_set_any(casters) && any(smooth))
            smooth = shapes_cast_smoothly(&frame->lamp_objects, lamp, casters, at, normal,
                                          vf_sqrt(size2), smooth);
        memcpy(grid->smooth[i] + first, &smooth, sizeof smooth);
    }
}

/* Removes blocks from those that are smooth for a lamp: some corner faces away from the lamp, what
 * is seen of it bends around the block, or its shadow is sharp there. */
SIMD void judge_seen(uint32_t lamp, int first, struct light_grid *grid)
{
    static const int32_t corners[4] = {0, 1, GRID_COLUMNS, GRID_COLUMNS + 1};
    const struct grid_blocks blocks = grid_blocks_from(first);
    const vf size2 = vf_load(grid->size2 + first);
    vf least = vf_all(1.0f), blur = vf_all(1e6f);
    for (int i = 0; i < 4; i++) {
        least = vf_min(least, vf_gather(grid->seen[lamp] + corners[i], blocks.node));
        blur = vf_min(blur, vf_gather(grid->blur[lamp] + corners[i], blocks.node));
    }
    const vf bend = bend_around(grid->seen[lamp], blocks.node, blocks.column, blocks.row);
    vi smooth;
    memcpy(&smooth, grid->smooth[lamp] + first, sizeof smooth);
    smooth &=
        (least >= 0.0f) & (bend <= GRID_BEND) & (blur * blur >= GRID_BLUR * GRID_BLUR * size2);
    memcpy(grid->smooth[lamp] + first, &smooth, sizeof smooth);
}

/* Finds the blocks, among those of a mask, around which numbers of nodes bend by no more than
 * `most`. */
SIMD void judge_bend(const float *values, float most, const int32_t blocks[GRID_BLOCKS],
                     int32_t smooth[GRID_BLOCKS])
{
    for (int first = 0; first < GRID_BLOCKS; first += LANES) {
        const struct grid_blocks at = grid_blocks_from(first);
        const vf bend = bend_around(values, at.node, at.column, at.row);
        vi mask;
        memcpy(&mask, blocks + first, sizeof mask);
        mask &= bend <= most;
        memcpy(smooth + first, &mask, sizeof mask);
    }
}

/* Finds the blocks whose corners see alike parts of the sky. */
SIMD void judge_sky(const struct kiln_ray_frame *frame, struct light_grid *grid)
{
    for (int first = 0; first < GRID_NODES; first += LANES)
        light_nodes_by_sky(frame, first, grid);
    judge_bend(grid->sky, GRID_SKY_BEND, grid->alike, grid->sky_smooth);
}

static inline bool are_some(const int32_t masks[GRID_BLOCKS])
{
    int32_t some = 0;
    for (int block = 0; block < GRID_BLOCKS; block++)
        some |= masks[block];
    return some != 0;
}

/* ---- pixels ---------------------------------------------------------------------------------- */

/* The pixels of a vector: GRID_STEP columns, and this many rows. */
enum { GRID_VECTOR_ROWS = LANES / GRID_STEP };
static_assert(GRID_VECTOR_ROWS * GRID_STEP == LANES && GRID_STEP % GRID_VECTOR_ROWS == 0,
              "the pixels of a vector are in one block");

/* Return where each lane lies among the pixels of a vector. */
SIMD vi grid_lane_columns(void)
{
    return vi_count() & (GRID_STEP - 1);
}

SIMD vi grid_lane_rows(void)
{
    return vi_count() / GRID_STEP;
}

/* Holds where the pixels of a vector lie in a grid. */
struct grid_place {
    const struct light_grid *grid;
    uint32_t block, node;
    vf right, down; /* part of the way between the block's corners */
    vi alike;       /* mask: the pixel lies on the smooth piece of its block */
};

SIMD struct vf3 node_vector(const float (*from)[GRID_NODE_ROOM], uint32_t node)
{
    return (struct vf3){vf_all(from[0][node]), vf_all(from[1][node]), vf_all(from[2][node])};
}

/* Returns the places of the pixels of a vector, the first of which is at (column, row) in the
 * strip. */
SIMD struct grid_place grid_place_of(const struct light_grid *grid, uint32_t column, uint32_t row,
                                     const struct ray_hit *hit, struct vf3 at)
{
    const uint32_t across = column / GRID_STEP, above = row / GRID_STEP;
    struct grid_place place = {.grid = grid};
    place.block = across + above * GRID_BLOCKS_A_ROW;
    place.node = across + above * GRID_COLUMNS;
    place.right = vf_of(grid_lane_columns()) * (1.0f / GRID_STEP);
    place.down = vf_of(grid_lane_rows() + (int32_t)(row % GRID_STEP)) * (1.0f / GRID_STEP);
    place.alike = vi_all(grid->alike[place.block]);
    if (grid->alike[place.block])
        place.alike &=
            (grid->surface[place.node] == hit->surface) &
            on_same_piece(node_vector(grid->at, place.node), node_vector(grid->normal, place.node),
                          at, hit->normal, vf_all(grid->size2[place.block]));
    return place;
}

/* Interpolates numbers of nodes in the lanes whose blocks are smooth, and returns these lanes. */
SIMD vi grid_between(const struct grid_place *place, const float *from,
                     const int32_t smooth[GRID_BLOCKS], vf *seen)
{
    if (!smooth[place->block] || !any(place->alike))
        return vi_all(0);
    from += place->node;
    const vf a = vf_all(from[0]), b = vf_all(from[1]);
    const vf c = vf_all(from[GRID_COLUMNS]), d = vf_all(from[GRID_COLUMNS + 1]);
    const vf above = a + (b - a) * place->right, below = c + (d - c) * place->right;
    *seen = above + (below - above) * place->down;
    return place->alike;
}

/* Return the lanes where what is seen of lamp i, or of the sky, is interpolated, and what that is.
 */
SIMD vi grid_lamp_seen(const struct grid_place *place, uint32_t i, vf *seen)
{
    return grid_between(place, place->grid->seen[i], place->grid->smooth[i], seen);
}

SIMD vi grid_sky_seen(const struct grid_place *place, vf *seen)
{
    return grid_between(place, place->grid->sky, place->grid->sky_smooth, seen);
}

#endif
