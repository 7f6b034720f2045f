/* This file divides polygons into triangles as assimp 5.2 does, by which kiln read meshes before:
 * diagonals and the order of triangles decide about smooth normals, painted texels and equal
 * distances. A quad is divided from its concave corner, or from the first one. A polygon of more
 * corners is projected along the longest axis of its normal, and its ears are cut one after the
 * other.
 *
 * All operations are rounded as IEEE 754 says, so the results are the same on every processor. */
#include "polygon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- memory ---------------------------------------------------------------------------------- */

void decode_polygon_finish(struct decode_polygon *polygon)
{
    free(polygon->points);
    free(polygon->triangles);
    free(polygon->flat);
    free(polygon->next);
    free(polygon->previous);
    free(polygon->bends);
    *polygon = (struct decode_polygon){0};
}

bool decode_polygon_resize(struct decode_polygon *polygon, size_t count)
{
    if (count <= polygon->capacity) {
        polygon->count = count;
        return true;
    }
    const size_t capacity = 2 * count;
    decode_polygon_finish(polygon);
    *polygon = (struct decode_polygon){
        .points = malloc(capacity * sizeof *polygon->points),
        .triangles = malloc(capacity * sizeof *polygon->triangles),
        .flat = malloc(capacity * sizeof *polygon->flat),
        .next = malloc(capacity * sizeof *polygon->next),
        .previous = malloc(capacity * sizeof *polygon->previous),
        .bends = malloc(capacity * sizeof *polygon->bends),
        .count = count,
        .capacity = capacity,
    };
    const bool ok = polygon->points && polygon->triangles && polygon->flat && polygon->next &&
                    polygon->previous && polygon->bends;
    if (!ok)
        decode_polygon_finish(polygon);
    return ok;
}

static void put(struct decode_polygon *polygon, size_t *made, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t triangle[3] = {a, b, c};
    memcpy(polygon->triangles[(*made)++], triangle, sizeof triangle);
}

/* ---- quads ----------------------------------------------------------------------------------- */

/* Finds the direction from one corner of a quad to another, of length 1 or 0. */
static void find_direction(const float from[3], const float to[3], float out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = to[c] - from[c];
    const float length = sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    const float scale = length > 0 ? 1 / length : 0;
    for (int c = 0; c < 3; c++)
        out[c] *= scale;
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns the corner of a quad at which the angles beside the diagonal are more than half a turn
 * together, or the first corner. The angles are compared by their cosines. The numbers are floats,
 * since double would decide otherwise where a corner is nearly straight; so would a cosine that
 * rounding made less than -1, of which assimp takes no angle. */
static uint32_t find_concave(const float (*points)[3])
{
    for (uint32_t i = 0; i < 4; i++) {
        float left[3], middle[3], right[3];
        find_direction(points[i], points[(i + 3) % 4], left);
        find_direction(points[i], points[(i + 2) % 4], middle);
        find_direction(points[i], points[(i + 1) % 4], right);
        const float a = dot(left, middle), b = dot(right, middle);
        if (a < -b && a >= -1 && b >= -1)
            return i;
    }
    return 0;
}

/* ---- ears ------------------------------------------------------------------------------------ */

/* Projects the corners along the longest axis of the polygon's normal (Newell's), such that they
 * run counter-clockwise. */
static void flatten(struct decode_polygon *polygon)
{
    double normal[3] = {0};
    for (size_t i = 0; i < polygon->count; i++) {
        const float *p = polygon->points[i], *q = polygon->points[(i + 1) % polygon->count];
        for (int c = 0; c < 3; c++) {
            const int d = (c + 1) % 3, e = (c + 2) % 3;
            normal[c] += ((double)p[d] - (double)q[d]) * ((double)p[e] + (double)q[e]);
        }
    }
    const double x = fabs(normal[0]), y = fabs(normal[1]), z = fabs(normal[2]);
    int along = 2;
    if (x > y)
        along = x > z ? 0 : 2;
    else if (y > z)
        along = 1;
    const bool turned = normal[along] < 0;
    const int first = (along + (turned ? 2 : 1)) % 3, second = (along + (turned ? 1 : 2)) % 3;
    for (size_t i = 0; i < polygon->count; i++) {
        polygon->flat[i][0] = (double)polygon->points[i][first];
        polygon->flat[i][1] = (double)polygon->points[i][second];
    }
}

/* Returns twice the area of a triangle, negative if its corners run clockwise. */
static double area_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool are_equal(const double a[2], const double b[2])
{
    return a[0] == b[0] && a[1] == b[1];
}

/* Lists the corners at which the polygon does not bend inwards. Only these can lie in an ear. */
static size_t find_bends(struct decode_polygon *polygon)
{
    const double(*flat)[2] = (const double(*)[2])polygon->flat;
    const size_t count = polygon->count;
    size_t bends = 0;
    for (size_t i = 0; i < count; i++) {
        polygon->next[i] = (uint32_t)((i + 1) % count);
        polygon->previous[i] = (uint32_t)((i + count - 1) % count);
        if (area_of(flat[polygon->previous[i]], flat[i], flat[polygon->next[i]]) <= 0)
            polygon->bends[bends++] = (uint32_t)i;
    }
    return bends;
}

/* Returns whether a corner is an ear: the triangle of its neighbours has no other corner inside. */
static bool is_ear(const struct decode_polygon *polygon, size_t bends, uint32_t ear)
{
    const double(*flat)[2] = (const double(*)[2])polygon->flat;
    const double *a = flat[polygon->previous[ear]], *b = flat[ear], *c = flat[polygon->next[ear]];
    if (area_of(a, b, c) < 0)
        return false;
    for (size_t i = 0; i < bends; i++) {
        const double *p = flat[polygon->bends[i]];
        if (area_of(a, b, p) > 0 && area_of(b, c, p) > 0 && area_of(c, a, p) > 0 &&
            !are_equal(p, a) && !are_equal(p, b) && !are_equal(p, c))
            return false;
    }
    return true;
}

/* Cuts ears until three corners are left. Where there is no ear, as in a polygon that crosses
 * itself, the corner at hand is cut, so that there are always two triangles fewer than corners. */
static void cut_ears(struct decode_polygon *polygon, size_t *made)
{
    const size_t bends = find_bends(polygon);
    uint32_t ear = 0;
    for (size_t left = polygon->count; left > 3; left--) {
        for (size_t tries = 0; tries < left && !is_ear(polygon, bends, ear); tries++)
            ear = polygon->next[ear];
        const uint32_t before = polygon->previous[ear], after = polygon->next[ear];
        put(polygon, made, before, ear, after);
        polygon->next[before] = after;
        polygon->previous[after] = before;
        ear = after;
    }
    const uint32_t next = polygon->next[ear], last = polygon->previous[ear];
    if (ear < next && ear < last)
        put(polygon, made, ear, next, last);
    else if (next < last)
        put(polygon, made, next, last, ear);
    else
        put(polygon, made, last, ear, next);
}

/* Lets no triangle begin with the corner with which the one before begins. Assimp tells by equal
 * first corners which triangles were one polygon, and so avoids them between ears. */
static void vary_first_corners(struct decode_polygon *polygon, size_t made)
{
    for (size_t i = 1; i < made; i++) {
        const uint32_t *t = polygon->triangles[i];
        const uint32_t turned[3] = {t[2], t[0], t[1]};
        if (t[0] == polygon->triangles[i - 1][0])
            memcpy(polygon->triangles[i], turned, sizeof turned);
    }
}

void decode_polygon_divide(struct decode_polygon *polygon)
{
    size_t made = 0;
    if (polygon->count == 3) {
        put(polygon, &made, 0, 1, 2);
    } else if (polygon->count == 4) {
        const uint32_t a = find_concave((const float(*)[3])polygon->points);
        put(polygon, &made, a, (a + 1) % 4, (a + 2) % 4);
        put(polygon, &made, a, (a + 2) % 4, (a + 3) % 4);
    } else {
        flatten(polygon);
        cut_ears(polygon, &made);
        vary_first_corners(polygon, made);
    }
}
