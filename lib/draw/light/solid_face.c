/* This file draws solid particles as a lamp sees them, in perspective. Depth is the distance from
 * the lamp, and all of a particle has that of its middle. What the particle shades is farther away.
 *
 * A ball is an ellipse, whose rows are cut out exactly, four for each row of texels. A ball smaller
 * than a texel is shared between the four texels around its middle, by its area. Meshes set bits of
 * a mask. */
#include "draw/light/solid_face.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw/light/lamp_solids.h"
#include "shared/exact.h"

enum {
    EDGE = KILN_LAMP_EDGE,
    ROWS = 4, /* rows of a row of texels */
    BITS = EDGE * KILN_BIT_CELL,
    WORDS = BITS / 64,
};

/* Texels for each unit of a tangent. */
#define TEXELS (0.5f * (float)EDGE / KILN_LAMP_RANGE)

/* Radius of the smallest ball whose rows are cut out, and of the bounding sphere of the smallest
 * mesh whose triangles are drawn, texels. */
static const float SMALLEST_BALL = 0.5f, SMALLEST_MESH = 1.5f;

struct kiln_solid_canvas {
    float far;                /* m */
    uint32_t first, end;      /* rows that are not empty */
    float clear[EDGE * EDGE]; /* part of each texel that is not covered */
    /* The covered part times the means of the distance and of its square, as parts of `far`, and of
     * how narrow the solids are (shared/lamp_map.h). */
    float distance[EDGE * EDGE], square[EDGE * EDGE], narrow[EDGE * EDGE];
    uint64_t bits[BITS * WORDS]; /* of a mesh; clear between meshes */
};

float3 kiln_face_frame(uint32_t face, float3 from)
{
    const float sign = face & 1 ? -1.0f : 1.0f;
    if (face < 2)
        return (float3){from.z, from.y, sign * from.x};
    if (face < 4)
        return (float3){from.x, from.z, sign * from.y};
    return (float3){from.x, from.y, sign * from.z};
}

bool kiln_face_misses(float3 center, float radius)
{
    /* The distance to the pyramid's side is (|x| - range z) / sqrt(1 + range^2). */
    const float room = radius * sqrtf(1.0f + KILN_LAMP_RANGE * KILN_LAMP_RANGE);
    const float reach = KILN_LAMP_RANGE * center.z + room;
    return center.z + radius <= 0.0f || fabsf(center.x) >= reach || fabsf(center.y) >= reach;
}

size_t kiln_solid_canvas_bytes(void)
{
    return sizeof(struct kiln_solid_canvas);
}

struct kiln_solid_canvas *kiln_solid_canvas_create(void)
{
    struct kiln_solid_canvas *canvas = calloc(1, sizeof *canvas);
    if (canvas)
        kiln_solid_canvas_clear(canvas, 1.0f);
    return canvas;
}

void kiln_solid_canvas_destroy(struct kiln_solid_canvas **canvas)
{
    free(*canvas);
    *canvas = NULL;
}

void kiln_solid_canvas_clear(struct kiln_solid_canvas *canvas, float far)
{
    canvas->far = far;
    canvas->first = EDGE;
    canvas->end = 0;
    for (size_t i = 0; i < (size_t)EDGE * EDGE; i++)
        canvas->clear[i] = 1.0f;
    memset(canvas->distance, 0, sizeof canvas->distance);
    memset(canvas->square, 0, sizeof canvas->square);
    memset(canvas->narrow, 0, sizeof canvas->narrow);
}

/* Holds what a texel keeps of a solid. */
struct kept {
    float depth;  /* distance, as a part of `far` */
    float narrow; /* as of struct kiln_solid_canvas */
};

/* Adds a part of a texel behind those that are there. */
static void add_part(struct kiln_solid_canvas *canvas, size_t texel, float part, struct kept kept)
{
    const float seen = canvas->clear[texel] * exact_min(part, 1.0f);
    canvas->clear[texel] -= seen;
    canvas->distance[texel] += seen * kept.depth;
    canvas->square[texel] += seen * kept.depth * kept.depth;
    canvas->narrow[texel] += seen * kept.narrow;
}

static struct kept kept_of(const struct kiln_solid_canvas *canvas,
                           const struct kiln_seen_solid *solid)
{
    const float distance = sqrtf(float3_dot(solid->center, solid->center));
    /* LAMP_WIDEST is range - 1 as a tangent. */
    const float narrow = (KILN_LAMP_RANGE - 1.0f) * distance / solid->radius;
    return (struct kept){exact_min(distance / canvas->far, 1.0f), exact_min(narrow * narrow, 1.0f)};
}

/* Marks rows as not empty. */
static void touch(struct kiln_solid_canvas *canvas, int32_t first, int32_t end)
{
    canvas->first = (uint32_t)first < canvas->first ? (uint32_t)first : canvas->first;
    canvas->end = (uint32_t)end > canvas->end ? (uint32_t)end : canvas->end;
}

/* Returns a coordinate of the picture, texels from its left or lower edge. */
static float texels_of(float tangent)
{
    return 0.5f * (float)EDGE + tangent * TEXELS;
}

/* Returns the tangent, from the face's axis, of a place in texels from the left or the top. */
static float across(float x)
{
    return (x - 0.5f * (float)EDGE) * (1.0f / TEXELS);
}

/* ---- balls ----------------------------------------------------------------------------------- */

/* Draws a ball of less than a texel: its solid angle is shared between four texels. */
static void add_speck(struct kiln_solid_canvas *canvas, const struct kiln_seen_solid *solid)
{
    static const float PI = 3.14159265f;
    const float3 c = solid->center;
    const float inverse = 1.0f / c.z, size = solid->radius * TEXELS * inverse;
    const float area =
        PI * size * size * sqrtf(float3_dot(c, c)) * inverse * solid->opacity; /* texels */
    const float x = texels_of(c.x * inverse) - 0.5f, y = texels_of(-c.y * inverse) - 0.5f;
    const float left = floorf(x), top = floorf(y);
    const struct kept kept = kept_of(canvas, solid);
    for (int i = 0; i < 4; i++) {
        const int32_t column = exact_int(left) + (i & 1), row = exact_int(top) + (i >> 1);
        const float part =
            (i & 1 ? x - left : 1.0f - (x - left)) * (i >> 1 ? y - top : 1.0f - (y - top));
        if (column < 0 || row < 0 || column >= EDGE || row >= EDGE)
            continue;
        add_part(canvas, (size_t)row * EDGE + (size_t)column, part * area, kept);
        touch(canvas, row, row + 1);
    }
}

/* The columns of a ball at a height, texels; empty where `to` is not past `from`. */
struct cut {
    float from, to;
};

/* Cuts a ball by the plane through the lamp whose rays are (u, v, 1). The ray hits the ball where
 * a u^2 + 2 b u + d >= 0, ahead of the lamp. */
static struct cut cut_ball(const struct kiln_seen_solid *solid, float v)
{
    const float3 c = solid->center;
    const float radius2 = solid->radius * solid->radius;
    const float outside = float3_dot(c, c) - radius2; /* square of a tangent's length */
    const float aside = c.y - c.z * v, ahead = c.y * v + c.z;
    const float room = outside * ((v * v + 1.0f) * radius2 - aside * aside);
    if (!(room > 0.0f))
        return (struct cut){0.0f, 0.0f};
    float a = radius2 - c.y * c.y - c.z * c.z;
    a = fabsf(a) < 1e-9f * outside ? -1e-9f * outside : a;
    const float b = c.x * ahead, root = sqrtf(room);
    const float middle = -b / a, half = root / fabsf(a), far = 1e3f;
    if (a > 0.0f) /* one branch of a hyperbola */
        return c.x > 0.0f ? (struct cut){texels_of(middle + half), far * (float)EDGE}
                          : (struct cut){-far, texels_of(middle - half)};
    if (c.x * middle + ahead <= 0.0f)
        return (struct cut){0.0f, 0.0f};
    return (struct cut){texels_of(middle - half), texels_of(middle + half)};
}

/* Draws a row of texels of a ball. */
static void add_row(struct kiln_solid_canvas *canvas, const struct kiln_seen_solid *solid,
                    struct kept kept, int32_t row)
{
    struct cut cuts[ROWS];
    float first = (float)EDGE, end = 0.0f;
    for (int k = 0; k < ROWS; k++) {
        cuts[k] = cut_ball(solid, -across((float)row + ((float)k + 0.5f) / (float)ROWS));
        if (cuts[k].to <= cuts[k].from)
            continue;
        first = exact_min(first, cuts[k].from);
        end = exact_max(end, cuts[k].to);
    }
    first = exact_max(first, 0.0f);
    end = exact_min(end, (float)EDGE);
    if (!(end > first))
        return;
    touch(canvas, row, row + 1);
    for (int32_t x = exact_int(first); x < EDGE && (float)x < end; x++) {
        float part = 0.0f;
        for (int k = 0; k < ROWS; k++) {
            const float left = exact_max(cuts[k].from, (float)x);
            const float right = exact_min(cuts[k].to, (float)x + 1.0f);
            part += exact_max(right - left, 0.0f);
        }
        if (part > 0.0f)
            add_part(canvas, (size_t)row * EDGE + (size_t)x, part * solid->opacity / (float)ROWS,
                     kept);
    }
}

void kiln_solid_canvas_ball(struct kiln_solid_canvas *canvas, const struct kiln_seen_solid *solid)
{
    const float3 c = solid->center;
    const float radius = solid->radius;
    if (c.z > radius && radius * TEXELS < SMALLEST_BALL * c.z) {
        add_speck(canvas, solid);
        return;
    }
    const struct kept kept = kept_of(canvas, solid);
    float low = 0.0f, high = (float)EDGE;
    if (c.z > radius) {
        const float inverse = 1.0f / (c.z * c.z - radius * radius);
        const float root = radius * sqrtf(exact_max(c.y * c.y + c.z * c.z - radius * radius, 0.0f));
        low = exact_clamp(texels_of(-(c.y * c.z + root) * inverse), 0.0f, (float)EDGE);
        high = exact_clamp(texels_of(-(c.y * c.z - root) * inverse), 0.0f, (float)EDGE);
    }
    for (int32_t row = exact_int(low); row < EDGE && (float)row < high; row++)
        add_row(canvas, solid, kept, row);
}

/* ---- meshes ---------------------------------------------------------------------------------- */

/* Bounds of a mesh's bits. */
struct bounds {
    float low[2], high[2];
};

static float3 place_corner(const struct kiln_seen_solid *solid, const struct kiln_seen_mesh *mesh,
                           float4 corner)
{
    float3 at = float3_add_scaled(solid->center, mesh->axes[0], corner.x);
    at = float3_add_scaled(at, mesh->axes[1], corner.y);
    return float3_add_scaled(at, mesh->axes[2], corner.z);
}

static struct bounds set_bits(struct kiln_solid_canvas *canvas, const struct kiln_seen_solid *solid,
                              const struct kiln_seen_mesh *mesh)
{
    const struct kiln_bit_mask mask = {canvas->bits, WORDS, BITS};
    struct bounds bounds = {{(float)BITS, (float)BITS}, {0.0f, 0.0f}};
    for (size_t i = 0; i < mesh->triangles; i++) {
        float p[3][2];
        for (size_t k = 0; k < 3; k++) {
            const float3 at = place_corner(solid, mesh, mesh->corners[3 * i + k][0]);
            const float inverse = 1.0f / at.z;
            p[k][0] = texels_of(at.x * inverse) * (float)KILN_BIT_CELL;
            p[k][1] = texels_of(-at.y * inverse) * (float)KILN_BIT_CELL;
            for (int c = 0; c < 2; c++) {
                bounds.low[c] = exact_min(bounds.low[c], p[k][c]);
                bounds.high[c] = exact_max(bounds.high[c], p[k][c]);
            }
        }
        kiln_bit_mask_add(&mask, (const float(*)[2])p);
    }
    return bounds;
}

/* Returns the texels that bits of the bounds lie in, at most those of the face. */
static void find_texels(const struct bounds *bounds, int axis, int32_t *first, int32_t *end)
{
    const float cell = 1.0f / (float)KILN_BIT_CELL;
    *first = exact_int(exact_clamp(bounds->low[axis] * cell, 0.0f, (float)EDGE));
    *end = exact_int(exact_clamp(bounds->high[axis] * cell + 1.0f, 0.0f, (float)EDGE));
}

void kiln_solid_canvas_mesh(struct kiln_solid_canvas *canvas, const struct kiln_seen_solid *solid,
                            const struct kiln_seen_mesh *mesh)
{
    const float near = solid->center.z - mesh->reach;
    if (near < 0.1f * mesh->reach || mesh->reach * TEXELS < SMALLEST_MESH * solid->center.z) {
        if (!kiln_face_misses(solid->center, solid->radius))
            kiln_solid_canvas_ball(canvas, solid);
        return;
    }
    const struct kiln_bit_mask mask = {canvas->bits, WORDS, BITS};
    const struct bounds bounds = set_bits(canvas, solid, mesh);
    int32_t left, right, top, bottom;
    find_texels(&bounds, 0, &left, &right);
    find_texels(&bounds, 1, &top, &bottom);
    if (right <= left || bottom <= top)
        return;
    touch(canvas, top, bottom);
    const struct kept kept = kept_of(canvas, solid);
    for (int32_t y = top; y < bottom; y++) {
        for (int32_t x = left; x < right; x++) {
            const float part = kiln_bit_mask_part(&mask, (size_t)x, (size_t)y);
            if (part > 0.0f)
                add_part(canvas, (size_t)y * EDGE + (size_t)x, part * solid->opacity, kept);
        }
    }
    memset(canvas->bits + (size_t)top * KILN_BIT_CELL * WORDS, 0,
           (size_t)(bottom - top) * KILN_BIT_CELL * WORDS * sizeof *canvas->bits);
}

/* ---- texels ---------------------------------------------------------------------------------- */

static uint32_t units_of(float part)
{
    return exact_uint(exact_clamp(part, 0.0f, 1.0f) * (float)KILN_SHADOW_ONE + 0.5f);
}

void kiln_solid_canvas_write(const struct kiln_solid_canvas *canvas, uint32_t *texels)
{
    const size_t pitch = KILN_SHADOW_PITCH(EDGE),
                 entry = (size_t)KILN_SHADOW_PAIR * KILN_LAMP_SOLID_TEXEL;
    memset(texels, 0, (size_t)KILN_LAMP_SOLID_WORDS * sizeof *texels);
    if (canvas->end <= canvas->first)
        return;
    uint32_t *finest = texels + entry * kiln_shadow_level_start(EDGE, 0);
    for (size_t i = (size_t)canvas->first * EDGE; i < (size_t)canvas->end * EDGE; i++) {
        const uint32_t texel[KILN_LAMP_SOLID_TEXEL] = {
            units_of(canvas->distance[i]) << 16 | units_of(1.0f - canvas->clear[i]),
            units_of(canvas->narrow[i]) << 16 | units_of(canvas->square[i])};
        kiln_shadow_store(finest + entry * (i / EDGE * pitch + i % EDGE), pitch, texel,
                          KILN_LAMP_SOLID_TEXEL);
    }
    for (uint32_t level = 1; level < KILN_LAMP_LEVELS; level++) {
        for (uint32_t y = canvas->first >> level; y <= (canvas->end - 1) >> level; y++)
            kiln_shadow_shrink_row(texels, EDGE, level, y);
    }
}
