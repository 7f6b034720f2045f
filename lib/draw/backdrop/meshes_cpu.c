/* This file finds the triangles of the backdrop's meshes that rays hit, on the host, and updates
 * the shadow maps. The number of the nearest triangle is found band by band, at the centres of
 * pixels and at the samples of edges at once; ray_mesh.h takes depth and normal from that
 * triangle. */
#include "draw/backdrop/meshes_cpu.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/matrix.h"
#include "base/pages.h"
#include "draw/light/mesh_shadow.h"
#include "draw/vector/mesh_project.h"
#include "shared/exact.h"

enum { GRAIN = 512 };

static_assert((int)KILN_HIT_LAYERS == (int)KILN_MESH_LAYERS, "a layer for each ray of a pixel");

struct kiln_meshes_cpu {
    const struct kiln_meshes *meshes;
    uint32_t width, height;
    float3 *view_positions, *world_normals; /* of all vertices */
    struct kiln_mesh_triangle *triangles;   /* of all meshes */
    struct kiln_mesh_uvs *uvs;              /* of all meshes; NULL: no mesh takes paint */
    int32_t *hits;
    bool *empty; /* bands whose hits are all 0 */
    struct kiln_mesh_canvas canvas;
    struct kiln_mesh_shadow shadows[KILN_MAX_MESHES];
    struct kiln_mesh_view view;
};

/* Returns the number of vertices of the meshes before mesh `end`. */
static size_t vertices_before(const struct kiln_meshes *meshes, uint32_t end)
{
    size_t count = 0;
    for (uint32_t i = 0; i < end; i++)
        count += meshes->loaded[i]->vertex_count;
    return count;
}

static size_t triangles_before(const struct kiln_meshes *meshes, uint32_t end)
{
    size_t count = 0;
    for (uint32_t i = 0; i < end; i++)
        count += meshes->loaded[i]->triangle_count;
    return count;
}

static size_t pitch_of(uint32_t width)
{
    return (width > KILN_SHADOW_EDGE ? width : KILN_SHADOW_EDGE) + (size_t)KILN_MESH_PAD;
}

static size_t bands_of(uint32_t height)
{
    return (height + KILN_MESH_ROWS - 1) / KILN_MESH_ROWS;
}

/* Returns the pixels of a band, of all layers. */
static size_t strip_of(uint32_t width)
{
    return (size_t)KILN_MESH_ROWS * KILN_HIT_LAYERS * pitch_of(width);
}

static bool allocate(struct kiln_meshes_cpu *m, struct kiln_threads *threads)
{
    size_t vertices = vertices_before(m->meshes, m->meshes->count);
    size_t triangles = triangles_before(m->meshes, m->meshes->count);
    const size_t bands = bands_of(m->height);
    if (vertices == 0 || triangles == 0) /* never, since no mesh is empty */
        return false;
    m->view_positions = calloc(vertices, sizeof *m->view_positions);
    m->world_normals = calloc(vertices, sizeof *m->world_normals);
    m->triangles = calloc(triangles, sizeof *m->triangles);
    if (m->meshes->painted)
        m->uvs = calloc(triangles, sizeof *m->uvs);
    const size_t hits = bands * strip_of(m->width) * sizeof *m->hits;
    m->hits = kiln_alloc_pages(hits);
    if (m->hits)
        memset(m->hits, 0, hits);
    m->empty = malloc(bands * sizeof *m->empty);
    struct kiln_mesh_canvas *canvas = &m->canvas;
    canvas->threads = threads;
    canvas->pitch = pitch_of(m->width);
    canvas->strip = strip_of(m->width);
    canvas->triangles = calloc(triangles, sizeof *canvas->triangles);
    canvas->ranges = calloc(triangles, sizeof *canvas->ranges);
    canvas->nearness =
        malloc(kiln_threads_count(threads) * canvas->strip * sizeof *canvas->nearness);
    if (m->empty)
        memset(m->empty, 1, bands * sizeof *m->empty);
    return m->view_positions && m->world_normals && m->triangles &&
           (m->uvs || !m->meshes->painted) && m->hits && m->empty && canvas->triangles &&
           canvas->ranges && canvas->nearness;
}

struct kiln_meshes_cpu *kiln_meshes_cpu_create(const struct kiln_scene *scene,
                                               const struct kiln_meshes *meshes,
                                               struct kiln_threads *threads,
                                               struct kiln_error *error)
{
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return NULL;
    struct kiln_meshes_cpu *m = calloc(1, sizeof *m);
    if (m) {
        m->meshes = meshes;
        m->width = scene->width;
        m->height = scene->height;
        m->canvas.rows = KILN_SIMD_PICK(kiln_mesh_rows, simd);
    }
    if (!m || !allocate(m, threads)) {
        kiln_error_no_memory(error, "the meshes");
        kiln_meshes_cpu_destroy(&m);
        return NULL;
    }
    m->view = (struct kiln_mesh_view){
        .triangles = m->triangles, .uvs = m->uvs, .hits = m->hits, .pitch = m->canvas.pitch};
    for (uint32_t i = 0; i < meshes->count; i++) {
        if (!kiln_mesh_shadow_init(&m->shadows[i], error)) {
            kiln_meshes_cpu_destroy(&m);
            return NULL;
        }
        m->view.shadows[i] = m->shadows[i].texels;
        if (meshes->painted)
            m->view.paint[i] = kiln_painted_picture(meshes->painted, i);
    }
    return m;
}

void kiln_meshes_cpu_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_meshes_cpu *m = NULL;
    uint64_t vertices, triangles, count = 0;
    bool painted = false;
    kiln_meshes_count(scene, &vertices, &triangles);
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        count += kiln_object_is_mesh(&scene->backdrop.objects[i]);
        painted |= kiln_object_takes_paint(&scene->backdrop.objects[i]);
    }
    if (count == 0)
        return;
    const size_t bands = bands_of(scene->height), strip = strip_of(scene->width);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, vertices,
                       sizeof *m->view_positions + sizeof *m->world_normals);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, triangles,
                       sizeof *m->triangles + (painted ? sizeof *m->uvs : 0) +
                           sizeof *m->canvas.triangles + sizeof *m->canvas.ranges);
    kiln_row_lists_footprint(triangles, bands, KILN_FOOTPRINT_OBJECTS, footprint);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, bands, strip * sizeof *m->hits);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, footprint->threads,
                       strip * sizeof *m->canvas.nearness);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, count, kiln_mesh_shadow_bytes());
}

void kiln_meshes_cpu_destroy(struct kiln_meshes_cpu **meshes)
{
    struct kiln_meshes_cpu *m = *meshes;
    if (!m)
        return;
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++)
        kiln_mesh_shadow_finish(&m->shadows[i]);
    free(m->view_positions);
    free(m->world_normals);
    free(m->triangles);
    free(m->uvs);
    free(m->hits);
    free(m->empty);
    free(m->canvas.triangles);
    free(m->canvas.ranges);
    free(m->canvas.nearness);
    kiln_row_lists_finish(&m->canvas.lists);
    free(m);
    *meshes = NULL;
}

const struct kiln_mesh_view *kiln_meshes_cpu_view(const struct kiln_meshes_cpu *meshes)
{
    return &meshes->view;
}

/* ---- triangles ------------------------------------------------------------------------------- */

/* Describes a mesh that is being projected into the picture. */
struct mesh_projection {
    struct kiln_meshes_cpu *m;
    const struct kiln_view *view;
    const struct kiln_draw_mesh *draw_mesh;
    const struct kiln_mesh *mesh;
    int32_t number;
    /* All that follow are of this mesh alone. */
    float3 *view_positions, *world_normals;
    struct kiln_mesh_triangle *triangles;
    struct kiln_mesh_uvs *uvs; /* NULL: the mesh takes no paint */
    struct kiln_projected_triangle *flat;
    struct kiln_row_range *ranges;
};

static void transform_vertices(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct mesh_projection *p = context;
    mat4 to_world, world_to_view;
    mat3 turn;
    kiln_matrix_from_rows(p->draw_mesh->to_world, to_world);
    glm_mat4_pick3(to_world, turn);
    kiln_matrix_from_rows(p->view->world_to_view, world_to_view);
    for (size_t i = begin; i < end; i++) {
        float *vertex = p->mesh->vertices[i];
        vec3 at, normal;
        glm_mat4_mulv3(to_world, vertex, 1.0f, at);
        glm_mat4_mulv3(world_to_view, at, 1.0f, at);
        glm_mat3_mulv(turn, vertex + 3, normal);
        p->view_positions[i] = (float3){at[0], at[1], at[2]};
        p->world_normals[i] = (float3){normal[0], normal[1], normal[2]};
    }
}

static void project_uvs(const struct mesh_projection *p, size_t i, float volume)
{
    struct kiln_mesh_uvs *uvs = &p->uvs[i];
    *uvs = (struct kiln_mesh_uvs){{0}, {0}};
    for (int k = 0; k < 3; k++) {
        const float *uv = p->mesh->uvs[p->mesh->triangles[i][k]];
        for (int c = 0; c < 3; c++) {
            const float part = p->flat[i].edges[k][c] / volume;
            uvs->u[c] += part * uv[0];
            uvs->v[c] += part * uv[1];
        }
    }
}

/* Returns the nearest distance at which a camera sees meshes, m. */
static float nearest_of(const struct kiln_view *view)
{
    return exact_min(KILN_MESH_NEAREST, view->eye.w);
}

static void project_triangle(const struct mesh_projection *p, size_t i)
{
    const uint32_t *corners = p->mesh->triangles[i];
    struct kiln_mesh_triangle *t = &p->triangles[i];
    struct kiln_projected_triangle *flat = &p->flat[i];
    const float3 corner[3] = {p->view_positions[corners[0]], p->view_positions[corners[1]],
                              p->view_positions[corners[2]]};
    float3 face;
    float volume;
    const bool seen = kiln_mesh_project(corner, p->view->frustum, p->view->principal,
                                        nearest_of(p->view), flat, &face, &volume);
    p->ranges[i] = kiln_rows_of_triangle(flat, p->view->frustum.w);
    if (!seen)
        return;
    const float sign = volume < 0.0f ? -1.0f : 1.0f;
    memset(t->normal, 0, sizeof t->normal);
    for (int k = 0; k < 3; k++) {
        const float3 normal = p->world_normals[corners[k]];
        for (int c = 0; c < 3; c++) {
            float part = flat->edges[k][c] / exact_abs(volume);
            t->normal[0][c] += part * normal.x;
            t->normal[1][c] += part * normal.y;
            t->normal[2][c] += part * normal.z;
        }
    }
    if (p->uvs)
        project_uvs(p, i, exact_abs(volume));
    memcpy(t->nearness, flat->nearness, sizeof t->nearness);
    const float4 *rows = p->view->world_to_view;
    t->face[0] = -sign * (rows[0].x * face.x + rows[1].x * face.y + rows[2].x * face.z);
    t->face[1] = -sign * (rows[0].y * face.x + rows[1].y * face.y + rows[2].y * face.z);
    t->face[2] = -sign * (rows[0].z * face.x + rows[1].z * face.y + rows[2].z * face.z);
    t->mesh = p->number;
}

static void project_triangles(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t i = begin; i < end; i++)
        project_triangle(context, i);
}

static void project_meshes(struct kiln_meshes_cpu *m, const struct kiln_view *view,
                           const struct kiln_draw_shapes *shapes)
{
    for (uint32_t i = 0; i < m->meshes->count; i++) {
        const struct kiln_mesh *mesh = m->meshes->loaded[i];
        size_t vertex = vertices_before(m->meshes, i), triangle = triangles_before(m->meshes, i);
        struct mesh_projection projection = {
            .m = m,
            .view = view,
            .draw_mesh = &shapes->meshes[i],
            .mesh = mesh,
            .number = (int32_t)i,
            .view_positions = m->view_positions + vertex,
            .world_normals = m->world_normals + vertex,
            .triangles = m->triangles + triangle,
            .uvs = mesh->uvs ? m->uvs + triangle : NULL,
            .flat = m->canvas.triangles + triangle,
            .ranges = m->canvas.ranges + triangle,
        };
        struct kiln_threads *threads = m->canvas.threads;
        kiln_threads_for(threads, mesh->vertex_count, GRAIN, transform_vertices, &projection);
        kiln_threads_for(threads, mesh->triangle_count, GRAIN, project_triangles, &projection);
    }
}

/* ---- hits ------------------------------------------------------------------------------------ */

struct raster_job {
    struct kiln_meshes_cpu *m;
    const struct kiln_view *view;
};

static void rasterise_band(const struct raster_job *f, uint32_t band, float *nearness)
{
#define PAIR(x, y)                                                                                 \
    {                                                                                              \
        x, y                                                                                       \
    }
    struct kiln_meshes_cpu *m = f->m;
    const float4 frustum = f->view->frustum, principal = f->view->principal;
    const size_t row = KILN_HIT_LAYERS * m->view.pitch;
    size_t count;
    const uint32_t *list = kiln_row_lists_of(&m->canvas.lists, band, &count);
    uint32_t y = band * KILN_MESH_ROWS, left = m->height - y;
    int32_t *hits = m->hits + y * row;
    if (!m->empty[band])
        memset(hits, 0, KILN_MESH_ROWS * row * sizeof *hits);
    m->empty[band] = count == 0;
    if (count == 0)
        return;
    memset(nearness, 0, KILN_MESH_ROWS * row * sizeof *nearness);
    const struct kiln_mesh_strip strip = {
        .width = m->width,
        .y = y,
        .rows = left < KILN_MESH_ROWS ? left : KILN_MESH_ROWS,
        .u = -frustum.x - principal.z,
        .v = frustum.y - principal.w,
        .u_step = 2.0f * frustum.x / frustum.z,
        .v_step = -2.0f * frustum.y / frustum.w,
        .layers = KILN_HIT_LAYERS,
        .offsets = {{0.5f, 0.5f}, KILN_EDGE_OFFSETS(PAIR)},
        .nearness_max = 1.0f / nearest_of(f->view),
        .nearness = nearness,
        .triangles = hits,
        .pitch = m->view.pitch,
    };
    m->canvas.rows->draw(&strip, m->canvas.triangles, list, count);
#undef PAIR
}

static void rasterise_bands(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct raster_job *f = context;
    for (size_t i = begin; i < end; i++)
        rasterise_band(f, f->m->canvas.lists.begin + (uint32_t)i,
                       f->m->canvas.nearness + worker * f->m->canvas.strip);
}

bool kiln_meshes_cpu_run(struct kiln_meshes_cpu *meshes, const struct kiln_view *view,
                         const struct kiln_draw_backdrop *backdrop,
                         const struct kiln_draw_shapes *shapes, struct kiln_error *error)
{
    struct kiln_meshes_cpu *m = meshes;
    for (uint32_t i = 0; i < m->meshes->count; i++) {
        if (!kiln_mesh_shadow_update(&m->shadows[i], &m->canvas, m->meshes->loaded[i],
                                     &shapes->meshes[i], shapes, backdrop->sun_direction, error))
            return false;
    }
    project_meshes(m, view, shapes);
    const struct kiln_row_items items = {
        .ranges = m->canvas.ranges,
        .count = (uint32_t)triangles_before(m->meshes, m->meshes->count),
        .height = m->height,
        .band_height = KILN_MESH_ROWS};
    struct raster_job job = {m, view};
    return kiln_row_lists_draw(&m->canvas.lists, &items, m->canvas.threads, rasterise_bands, &job,
                               error);
}
