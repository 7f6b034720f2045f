/* This file draws the shadow map of a mesh on the host, and its coarser levels. The mesh's bounding
 * sphere fills the map except for a border, as in shaders/draw/backdrop/meshes_shadow.vert. */
#include "draw/light/mesh_shadow.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/matrix.h"
#include "base/pages.h"
#include "draw/vector/mesh_project.h"
#include "shared/exact.h"

enum { EDGE = KILN_SHADOW_EDGE, ROWS_AT_A_TIME = 32 };

static_assert(EDGE == 1 << (KILN_SHADOW_LEVELS - 1), "down to one texel");

bool kiln_mesh_shadow_init(struct kiln_mesh_shadow *shadow, struct kiln_error *error)
{
    *shadow = (struct kiln_mesh_shadow){.drawn = false};
    shadow->texels = kiln_alloc_pages(KILN_SHADOW_WORDS * sizeof *shadow->texels);
    shadow->spans = calloc(KILN_SHADOW_ROWS, sizeof *shadow->spans);
    if (!shadow->texels || !shadow->spans)
        return kiln_error_no_memory(error, "the shadows of meshes");
    memset(shadow->texels, 0, KILN_SHADOW_WORDS * sizeof *shadow->texels);
    return true;
}

void kiln_mesh_shadow_finish(struct kiln_mesh_shadow *shadow)
{
    free(shadow->texels);
    free(shadow->spans);
    shadow->texels = NULL;
    shadow->spans = NULL;
}

uint64_t kiln_mesh_shadow_bytes(void)
{
    const struct kiln_mesh_shadow *s = NULL;
    return KILN_SHADOW_WORDS * sizeof *s->texels + KILN_SHADOW_ROWS * sizeof *s->spans;
}

struct shadow_job {
    struct kiln_mesh_shadow *shadow;
    struct kiln_mesh_canvas *canvas;
    const struct kiln_mesh *mesh;
    uint32_t level; /* the level that is made from the finer one */
};

/* ---- triangles ------------------------------------------------------------------------------- */

struct corner {
    float x, y, height; /* texels; 0 to 1, towards the sun */
};

static float dot(float4 a, float3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct corner project(const struct kiln_mesh_shadow *shadow, mat4 to_world, vec3 vertex)
{
    const struct kiln_draw_mesh *placed = &shadow->placed;
    vec3 world;
    glm_mat4_mulv3(to_world, vertex, 1.0f, world);
    const float3 from = {world[0] - placed->center.x, world[1] - placed->center.y,
                         world[2] - placed->center.z};
    float scale = 0.5f / (placed->center.w * (1.0f + KILN_SHADOW_MARGIN));
    return (struct corner){(0.5f + dot(shadow->right, from) * scale) * (float)EDGE,
                           (0.5f + dot(shadow->up, from) * scale) * (float)EDGE,
                           0.5f + dot(shadow->sun, from) * scale};
}

/* Writes the plane that is 0 along the line from a to b. For the line from b to a it is exactly the
 * negative, since the ends are ordered first. */
static void edge_plane(struct corner a, struct corner b, float plane[3])
{
    bool swap = a.x > b.x || (a.x == b.x && a.y > b.y);
    struct corner from = swap ? b : a, to = swap ? a : b;
    float x = to.x - from.x, y = to.y - from.y, sign = swap ? -1.0f : 1.0f;
    plane[0] = -y * sign;
    plane[1] = x * sign;
    plane[2] = (y * from.x - x * from.y) * sign;
}

static void project_triangle(const struct corner c[3], struct kiln_projected_triangle *t)
{
    *t = (struct kiln_projected_triangle){.x = {0, 0}};
    float area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    if (!(exact_abs(area) > 1e-6f))
        return;
    float sign = area < 0.0f ? -1.0f : 1.0f;
    for (int k = 0; k < 3; k++) {
        edge_plane(c[(k + 1) % 3], c[(k + 2) % 3], t->edges[k]);
        for (int i = 0; i < 3; i++) {
            t->nearness[i] += t->edges[k][i] / area * c[k].height;
            t->edges[k][i] *= sign;
        }
    }
    const float low[2] = {exact_min(exact_min(c[0].x, c[1].x), c[2].x),
                          exact_min(exact_min(c[0].y, c[1].y), c[2].y)};
    const float high[2] = {exact_max(exact_max(c[0].x, c[1].x), c[2].x),
                           exact_max(exact_max(c[0].y, c[1].y), c[2].y)};
    kiln_mesh_bound(low, high, (float)EDGE, t);
}

static void project_triangles(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct shadow_job *d = context;
    mat4 to_world;
    kiln_matrix_from_rows(d->shadow->placed.to_world, to_world);
    for (size_t i = begin; i < end; i++) {
        struct corner corners[3];
        for (int k = 0; k < 3; k++)
            corners[k] = project(d->shadow, to_world, d->mesh->vertices[d->mesh->triangles[i][k]]);
        project_triangle(corners, &d->canvas->triangles[i]);
        d->canvas->ranges[i] = kiln_rows_of_triangle(&d->canvas->triangles[i], (float)EDGE);
    }
}

/* ---- texels ---------------------------------------------------------------------------------- */

static void draw_band(const struct shadow_job *d, uint32_t band, float *nearness)
{
    const struct kiln_mesh_canvas *canvas = d->canvas;
    size_t count;
    const uint32_t *list = kiln_row_lists_of(&canvas->lists, band, &count);
    const uint32_t y = band * KILN_MESH_ROWS;
    memset(nearness, 0, KILN_MESH_ROWS * canvas->pitch * sizeof *nearness);
    const struct kiln_mesh_strip strip = {
        .width = EDGE,
        .y = y,
        .rows = KILN_MESH_ROWS,
        .u_step = 1.0f,
        .v_step = 1.0f,
        .layers = 1,
        .offsets = {{0.5f, 0.5f}},
        .nearness_max = 2.0f,
        .nearness = nearness,
        .pitch = canvas->pitch,
    };
    canvas->rows->draw(&strip, canvas->triangles, list, count);
    const size_t pitch = KILN_SHADOW_PITCH(EDGE);
    uint32_t *finest = d->shadow->texels + KILN_SHADOW_PAIR * kiln_shadow_level_start(EDGE, 0);
    for (uint32_t row = 0; row < KILN_MESH_ROWS; row++) {
        const float *from = nearness + row * canvas->pitch;
        uint32_t *to = finest + (size_t)KILN_SHADOW_PAIR * pitch * (y + row);
        struct kiln_shadow_span *span = &d->shadow->spans[y + row];
        kiln_shadow_update_span(span, from, EDGE);
        for (uint32_t x = span->changed_from; x < span->changed_to; x++) {
            const float distance = exact_clamp(1.0f - from[x], 0.0f, 1.0f);
            const uint32_t texel = from[x] > 0.0f ? kiln_shadow_texel(distance) : 0;
            kiln_shadow_store(to + (size_t)KILN_SHADOW_PAIR * x, pitch, &texel, 1);
        }
    }
}

static void draw_bands(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct shadow_job *d = context;
    for (size_t i = begin; i < end; i++)
        draw_band(d, d->canvas->lists.begin + (uint32_t)i,
                  d->canvas->nearness + worker * d->canvas->strip);
}

static void shrink_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct shadow_job *d = context;
    kiln_shadow_shrink(d->shadow->texels, d->shadow->spans, EDGE, d->level, begin, end);
}

static bool is_up_to_date(const struct kiln_mesh_shadow *shadow,
                          const struct kiln_draw_mesh *placed,
                          const struct kiln_draw_shapes *shapes, float4 sun)
{
    return shadow->drawn && memcmp(&shadow->placed, placed, sizeof *placed) == 0 &&
           memcmp(&shadow->right, &shapes->sun_right, sizeof(float4)) == 0 &&
           memcmp(&shadow->up, &shapes->sun_up, sizeof(float4)) == 0 &&
           memcmp(&shadow->sun, &sun, sizeof(float4)) == 0;
}

bool kiln_mesh_shadow_update(struct kiln_mesh_shadow *shadow, struct kiln_mesh_canvas *canvas,
                             const struct kiln_mesh *mesh, const struct kiln_draw_mesh *placed,
                             const struct kiln_draw_shapes *shapes, float4 sun,
                             struct kiln_error *error)
{
    if (is_up_to_date(shadow, placed, shapes, sun))
        return true;
    shadow->placed = *placed;
    shadow->right = shapes->sun_right;
    shadow->up = shapes->sun_up;
    shadow->sun = sun;
    struct shadow_job job = {shadow, canvas, mesh, 0};
    kiln_threads_for(canvas->threads, mesh->triangle_count, 512, project_triangles, &job);
    const struct kiln_row_items items = {.ranges = canvas->ranges,
                                         .count = mesh->triangle_count,
                                         .height = EDGE,
                                         .band_height = KILN_MESH_ROWS};
    shadow->drawn =
        kiln_row_lists_draw(&canvas->lists, &items, canvas->threads, draw_bands, &job, error);
    if (!shadow->drawn)
        return false;
    while (++job.level < KILN_SHADOW_LEVELS)
        kiln_threads_for(canvas->threads, EDGE >> job.level, ROWS_AT_A_TIME, shrink_rows, &job);
    return true;
}
