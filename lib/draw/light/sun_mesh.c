/* This file draws and reads a small height map of a mesh as the sun sees it. A cell whose centre is
 * covered by triangles has the height of the highest; cells of coarser levels have means. The
 * mesh's bounding sphere fills the map. */
#include "draw/light/sun_mesh.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/matrix.h"
#include "shared/exact.h"

enum { EDGE = KILN_SUN_MESH_EDGE };

static_assert(KILN_SUN_MESH_CELLS == (4 * EDGE * EDGE - 1) / 3, "all levels");

struct corner {
    float x, y, height; /* x and y in cells; height in m */
};

static float3 middle_of(const struct kiln_draw_mesh *placed)
{
    return (float3){placed->center.x, placed->center.y, placed->center.z};
}

/* Projects a position relative to the mesh's middle. */
static struct corner project(const struct kiln_sun_mesh *map, float3 from)
{
    float scale = 0.5f * EDGE / map->placed.center.w;
    return (struct corner){0.5f * EDGE + float3_dot(from, map->sun.right) * scale,
                           0.5f * EDGE + float3_dot(from, map->sun.up) * scale,
                           float3_dot(from, map->sun.towards)};
}

static struct corner corner_of(const struct kiln_sun_mesh *map, mat4 to_world, vec3 vertex)
{
    vec3 world;
    glm_mat4_mulv3(to_world, vertex, 1.0f, world);
    float3 at = {world[0], world[1], world[2]};
    return project(map, float3_sub(at, middle_of(&map->placed)));
}

/* Returns twice the signed area of the triangle a, b, (x, y). */
static float area(struct corner a, struct corner b, float x, float y)
{
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

static int cell_at(float x)
{
    return exact_int(exact_clamp(x, 0.0f, (float)(EDGE - 1)));
}

static void draw_triangle(struct kiln_sun_mesh *map, const struct corner c[3])
{
    float whole = area(c[0], c[1], c[2].x, c[2].y);
    if (whole == 0.0f)
        return;
    int last_x = cell_at(fmaxf(fmaxf(c[0].x, c[1].x), c[2].x));
    int last_y = cell_at(fmaxf(fmaxf(c[0].y, c[1].y), c[2].y));
    for (int y = cell_at(fminf(fminf(c[0].y, c[1].y), c[2].y)); y <= last_y; y++) {
        for (int x = cell_at(fminf(fminf(c[0].x, c[1].x), c[2].x)); x <= last_x; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f;
            float u = area(c[1], c[2], px, py) / whole, v = area(c[2], c[0], px, py) / whole;
            float w = 1.0f - u - v;
            if (u < 0.0f || v < 0.0f || w < 0.0f)
                continue;
            float height = u * c[0].height + v * c[1].height + w * c[2].height;
            int cell = y * EDGE + x;
            if (map->cover[cell] == 0.0f || height > map->height[cell])
                map->height[cell] = height;
            map->cover[cell] = 1.0f;
        }
    }
}

static void average_levels(float *cells)
{
    const float *fine = cells;
    for (size_t edge = EDGE / 2; edge > 0; edge /= 2) {
        float *coarse = cells += 4 * edge * edge;
        for (size_t i = 0; i < edge * edge; i++) {
            const float *from = fine + 4 * edge * (i / edge) + 2 * (i % edge);
            coarse[i] = 0.25f * (from[0] + from[1] + from[2 * edge] + from[2 * edge + 1]);
        }
        fine = coarse;
    }
}

void kiln_sun_mesh_update(struct kiln_sun_mesh *map, const struct kiln_mesh *mesh,
                          const struct kiln_draw_mesh *placed, const struct kiln_sun_frame *sun)
{
    if (map->drawn && memcmp(&map->placed, placed, sizeof *placed) == 0 &&
        memcmp(&map->sun, sun, sizeof *sun) == 0)
        return;
    memset(map, 0, sizeof *map);
    map->placed = *placed;
    map->sun = *sun;
    map->drawn = true;
    mat4 to_world;
    kiln_matrix_from_rows(placed->to_world, to_world);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        struct corner corners[3];
        for (int k = 0; k < 3; k++)
            corners[k] = corner_of(map, to_world, mesh->vertices[mesh->triangles[i][k]]);
        draw_triangle(map, corners);
    }
    average_levels(map->cover);
    average_levels(map->height);
}

static inline int floor_of(float x)
{
    const int whole = exact_int(x);
    return whole - (whole > INT32_MIN && (float)whole > x);
}

/* Holds the cover of a place in the map, and the mean height there times the cover. */
struct reading {
    float cover, height;
};

/* Interpolates linearly between the centres of four cells of a level; cells beside the map are
 * empty. first: the level's first cell; edge: its width in cells. */
static struct reading read_level(const struct kiln_sun_mesh *map, size_t first, int edge, float x,
                                 float y)
{
    const int left = floor_of(x - 0.5f), top = floor_of(y - 0.5f);
    struct reading sum = {0.0f, 0.0f};
    for (int i = 0; i < 4; i++) {
        const int cx = left + (i & 1), cy = top + (i >> 1);
        if (cx < 0 || cy < 0 || cx >= edge || cy >= edge)
            continue;
        const size_t cell = first + (size_t)(cy * edge + cx);
        float weight = (1.0f - fabsf(x - 0.5f - (float)cx)) * (1.0f - fabsf(y - 0.5f - (float)cy));
        sum.cover += weight * map->cover[cell];
        sum.height += weight * map->height[cell];
    }
    return sum;
}

/* Returns the mean cover of four places within the penumbra. They are read in a level whose cells
 * are a quarter to a half as wide as the penumbra's radius. */
float kiln_sun_mesh_cover(const struct kiln_sun_mesh *map, struct kiln_ball ball)
{
    struct corner at = project(map, float3_sub(ball.center, middle_of(&map->placed)));
    float size = map->placed.center.w;
    if (at.height > size)
        return 0.0f;
    float spread = map->sun.spread * fmaxf(-at.height, 0.0f);
    float width = (ball.radius + spread) * 0.5f * EDGE / size; /* cells */
    const float reach = 0.5f * EDGE + 2.0f * width;
    if (!(fabsf(at.x - 0.5f * EDGE) <= reach && fabsf(at.y - 0.5f * EDGE) <= reach))
        return 0.0f; /* also where the ball is nowhere, so that all below are numbers */
    size_t first = 0;
    int edge = EDGE;
    for (; edge > 1 && (float)(4 * EDGE / edge) <= width; edge /= 2)
        first += (size_t)(edge * edge);
    float cover = 0.0f, scale = (float)edge / EDGE, aside = 0.5f * fmaxf(width, 1.0f);
    for (int i = 0; i < 4; i++) {
        float x = (at.x + (i & 1 ? aside : -aside)) * scale;
        float y = (at.y + (i & 2 ? aside : -aside)) * scale;
        const struct reading found = read_level(map, first, edge, x, y);
        if (found.cover == 0.0f)
            continue;
        float top = found.height / fmaxf(found.cover, 1e-4f);
        float way = (top - at.height) / fmaxf(ball.radius, 2.0f * size / EDGE);
        cover += 0.25f * found.cover * exact_clamp(way, 0.0f, 1.0f);
    }
    return cover;
}
