/* This file draws the shadow maps of lamps on the host. Threads draw the faces of all lamps
 * independently, each with a canvas of its own, so that the result does not depend on them. A face
 * is a picture in perspective, for which kiln_mesh_project and kiln_mesh_rows work as for the
 * camera's. */
#include "draw/light/lamp_map.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/matrix.h"
#include "base/pages.h"
#include "draw/vector/mesh_project.h"
#include "shared/exact.h"

enum { EDGE = KILN_LAMP_EDGE, PITCH = EDGE + KILN_MESH_PAD, GRAIN = 512 };

static_assert(EDGE == 1 << (KILN_LAMP_LEVELS - 1), "down to one texel");

/* Holds what a thread needs to draw a face. */
struct canvas {
    struct kiln_projected_triangle *triangles;
    uint32_t *list; /* numbers of the triangles that the face shows, 0 and on */
    float *nearness;
};

/* Describes what the maps of a lamp show. */
struct shown {
    bool drawn;
    float4 position;
    float far; /* m */
};

struct kiln_lamp_maps {
    struct kiln_threads *threads;
    const struct kiln_mesh_rows *rows;
    const struct kiln_meshes *meshes;
    uint32_t triangle_count;
    float3 *positions;       /* of all vertices, in the world */
    struct canvas *canvases; /* one for each thread */
    uint32_t *texels;
    uint32_t room; /* lamps that `texels` has room for */
    struct kiln_shadow_span spans[KILN_MOST_LAMPS * KILN_LAMP_FACES][2 * EDGE]; /* of each face */
    uint64_t changes;
    struct shown shown[KILN_MOST_LAMPS];
    struct kiln_draw_mesh placed[KILN_MAX_MESHES]; /* the meshes that the maps show */
};

bool kiln_lamp_maps_exist(const struct kiln_scene *scene)
{
    bool meshes = false;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++)
        meshes |= kiln_object_is_mesh(&scene->backdrop.objects[i]);
    return meshes && kiln_scene_shadow_lights(scene) > 0;
}

static bool allocate(struct kiln_lamp_maps *maps)
{
    size_t vertices = 0;
    for (uint32_t i = 0; i < maps->meshes->count; i++) {
        vertices += maps->meshes->loaded[i]->vertex_count;
        maps->triangle_count += maps->meshes->loaded[i]->triangle_count;
    }
    const uint32_t threads = kiln_threads_count(maps->threads);
    maps->positions = malloc((vertices ? vertices : 1) * sizeof *maps->positions);
    maps->canvases = calloc(threads, sizeof *maps->canvases);
    if (!maps->positions || !maps->canvases)
        return false;
    const size_t triangles = maps->triangle_count ? maps->triangle_count : 1;
    for (uint32_t i = 0; i < threads; i++) {
        struct canvas *canvas = &maps->canvases[i];
        canvas->triangles = malloc(triangles * sizeof *canvas->triangles);
        canvas->list = malloc(triangles * sizeof *canvas->list);
        canvas->nearness = malloc((size_t)EDGE * PITCH * sizeof *canvas->nearness);
        if (!canvas->triangles || !canvas->list || !canvas->nearness)
            return false;
        for (uint32_t k = 0; k < triangles; k++)
            canvas->list[k] = k;
    }
    return true;
}

struct kiln_lamp_maps *kiln_lamp_maps_create(const struct kiln_moment *moment,
                                             struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_lamp_maps *maps = calloc(1, sizeof *maps);
    if (maps) {
        maps->threads = threads;
        maps->rows = KILN_SIMD_PICK(kiln_mesh_rows, moment->simd);
        maps->meshes = &moment->meshes;
    }
    if (!maps || !allocate(maps)) {
        kiln_error_no_memory(error, "the shadows of lamps");
        kiln_lamp_maps_destroy(&maps);
    }
    return maps;
}

void kiln_lamp_maps_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_lamp_maps *m = NULL;
    const struct canvas *c = NULL;
    uint64_t vertices, triangles;
    kiln_meshes_count(scene, &vertices, &triangles);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, vertices, sizeof *m->positions);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, triangles * footprint->threads,
                       sizeof *c->triangles + sizeof *c->list);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_LIGHTS, footprint->threads,
                       (size_t)EDGE * PITCH * sizeof *c->nearness);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_LIGHTS, kiln_scene_shadow_lights(scene),
                       KILN_LAMP_FACES *
                           (KILN_LAMP_WORDS * sizeof *m->texels + sizeof m->spans[0]));
}

void kiln_lamp_maps_destroy(struct kiln_lamp_maps **maps)
{
    struct kiln_lamp_maps *m = *maps;
    if (!m)
        return;
    for (uint32_t i = 0; m->canvases && i < kiln_threads_count(m->threads); i++) {
        free(m->canvases[i].triangles);
        free(m->canvases[i].list);
        free(m->canvases[i].nearness);
    }
    free(m->canvases);
    free(m->positions);
    free(m->texels);
    free(m);
    *maps = NULL;
}

/* ---- faces ----------------------------------------------------------------------------------- */

/* Describes the maps that are drawn anew. */
struct face_job {
    struct kiln_lamp_maps *maps;
    uint32_t numbers[KILN_MOST_LAMPS];
};

/* Returns a place, seen from the lamp, in a face's view space: right, up, and against its axis
 * (lamp_place_of). */
static float3 into_face(uint32_t face, float3 from)
{
    const float sign = face & 1 ? -1.0f : 1.0f;
    if (face < 2)
        return (float3){from.z, from.y, -sign * from.x};
    if (face < 4)
        return (float3){from.x, from.z, -sign * from.y};
    return (float3){from.x, from.y, -sign * from.z};
}

/* Returns whether a triangle lies beside the face's picture for certain. */
static bool is_beside(const float3 corner[3])
{
    bool behind = true, left = true, right = true, above = true, below = true;
    for (int k = 0; k < 3; k++) {
        const float reach = -corner[k].z * KILN_LAMP_RANGE;
        behind &= -corner[k].z < KILN_MESH_NEAREST;
        left &= corner[k].x < -reach;
        right &= corner[k].x > reach;
        above &= corner[k].y > reach;
        below &= corner[k].y < -reach;
    }
    return behind || left || right || above || below;
}

/* Projects the triangles that a face may show. Returns how many they are. */
static uint32_t project_face(const struct kiln_lamp_maps *maps, const struct shown *lamp,
                             uint32_t face, const struct canvas *canvas)
{
    const float4 frustum = {KILN_LAMP_RANGE, KILN_LAMP_RANGE, EDGE, EDGE};
    const float4 principal = {0.5f * EDGE, 0.5f * EDGE, 0.0f, 0.0f};
    const float3 *positions = maps->positions;
    uint32_t count = 0;
    for (uint32_t i = 0; i < maps->meshes->count; i++) {
        const struct kiln_mesh *mesh = maps->meshes->loaded[i];
        for (size_t k = 0; k < mesh->triangle_count; k++) {
            float3 corner[3], normal;
            float volume;
            for (int c = 0; c < 3; c++) {
                const float3 at = positions[mesh->triangles[k][c]];
                corner[c] =
                    into_face(face, (float3){at.x - lamp->position.x, at.y - lamp->position.y,
                                             at.z - lamp->position.z});
            }
            if (!is_beside(corner))
                count += kiln_mesh_project(corner, frustum, principal, KILN_MESH_NEAREST,
                                           &canvas->triangles[count], &normal, &volume);
        }
        positions += mesh->vertex_count;
    }
    return count;
}

static void draw_face(struct kiln_lamp_maps *maps, uint32_t number, uint32_t face,
                      const struct canvas *canvas)
{
    const struct shown *lamp = &maps->shown[number];
    const uint32_t count = project_face(maps, lamp, face, canvas);
    memset(canvas->nearness, 0, (size_t)EDGE * PITCH * sizeof *canvas->nearness);
    const struct kiln_mesh_strip strip = {
        .width = EDGE,
        .rows = EDGE,
        .u = -KILN_LAMP_RANGE,
        .v = KILN_LAMP_RANGE,
        .u_step = 2.0f * KILN_LAMP_RANGE / (float)EDGE,
        .v_step = -2.0f * KILN_LAMP_RANGE / (float)EDGE,
        .layers = 1,
        .offsets = {{0.5f, 0.5f}},
        .nearness_max = 1.0f / KILN_MESH_NEAREST,
        .nearness = canvas->nearness,
        .pitch = PITCH,
    };
    maps->rows->draw(&strip, canvas->triangles, canvas->list, count);
    uint32_t *texels = maps->texels + ((size_t)number * KILN_LAMP_FACES + face) * KILN_LAMP_WORDS;
    uint32_t *finest = texels + KILN_SHADOW_PAIR * kiln_shadow_level_start(EDGE, 0);
    const size_t pitch = KILN_SHADOW_PITCH(EDGE);
    const float inverse_far = 1.0f / lamp->far;
    struct kiln_shadow_span *spans = maps->spans[(size_t)number * KILN_LAMP_FACES + face];
    for (size_t y = 0; y < EDGE; y++) {
        kiln_shadow_update_span(&spans[y], canvas->nearness + y * PITCH, EDGE);
        for (size_t x = spans[y].changed_from; x < spans[y].changed_to; x++) {
            const float nearness = canvas->nearness[y * PITCH + x];
            const float distance = exact_min(inverse_far / exact_max(nearness, 1e-6f), 1.0f);
            const uint32_t texel = nearness > 0.0f ? kiln_shadow_texel(distance) : 0;
            kiln_shadow_store(finest + KILN_SHADOW_PAIR * (y * pitch + x), pitch, &texel, 1);
        }
    }
    for (uint32_t level = 1; level < KILN_LAMP_LEVELS; level++)
        kiln_shadow_shrink(texels, spans, EDGE, level, 0, EDGE >> level);
}

static void draw_faces(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct face_job *job = context;
    for (size_t i = begin; i < end; i++)
        draw_face(job->maps, job->numbers[i / KILN_LAMP_FACES], (uint32_t)(i % KILN_LAMP_FACES),
                  &job->maps->canvases[worker]);
}

/* ---- lamps ----------------------------------------------------------------------------------- */

struct vertex_job {
    const struct kiln_mesh *mesh;
    const struct kiln_draw_mesh *placed;
    float3 *positions;
};

static void place_vertices(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct vertex_job *job = context;
    mat4 to_world;
    kiln_matrix_from_rows(job->placed->to_world, to_world);
    for (size_t i = begin; i < end; i++) {
        vec3 at;
        glm_mat4_mulv3(to_world, job->mesh->vertices[i], 1.0f, at);
        job->positions[i] = (float3){at[0], at[1], at[2]};
    }
}

/* Brings the vertices to where the meshes are now. Maps of older places are forgotten. */
static void place_meshes(struct kiln_lamp_maps *maps, const struct kiln_draw_shapes *shapes)
{
    if (maps->meshes->count == 0 ||
        memcmp(maps->placed, shapes->meshes, maps->meshes->count * sizeof *maps->placed) == 0)
        return;
    memcpy(maps->placed, shapes->meshes, maps->meshes->count * sizeof *maps->placed);
    for (uint32_t i = 0; i < KILN_MOST_LAMPS; i++)
        maps->shown[i].drawn = false;
    float3 *positions = maps->positions;
    for (uint32_t i = 0; i < maps->meshes->count; i++) {
        const struct kiln_mesh *mesh = maps->meshes->loaded[i];
        struct vertex_job job = {mesh, &shapes->meshes[i], positions};
        kiln_threads_for(maps->threads, mesh->vertex_count, GRAIN, place_vertices, &job);
        positions += mesh->vertex_count;
    }
}

/* Returns the distance that the maps of a lamp reach: past all meshes, m. */
static float reach_of(const struct kiln_lamp_maps *maps, float4 position)
{
    float far = 1.0f;
    for (uint32_t i = 0; i < maps->meshes->count; i++) {
        const float4 center = maps->placed[i].center;
        const float3 to = {center.x - position.x, center.y - position.y, center.z - position.z};
        far = exact_max(far, sqrtf(float3_dot(to, to)) + center.w);
    }
    return far;
}

static bool reserve(struct kiln_lamp_maps *maps, uint32_t count, struct kiln_error *error)
{
    if (count <= maps->room)
        return true;
    const size_t lamp = (size_t)KILN_LAMP_FACES * KILN_LAMP_WORDS;
    uint32_t *texels = kiln_alloc_pages(count * lamp * sizeof *texels);
    if (!texels)
        return kiln_error_no_memory(error, "the shadows of lamps");
    if (maps->room)
        memcpy(texels, maps->texels, maps->room * lamp * sizeof *texels);
    memset(texels + maps->room * lamp, 0, (count - maps->room) * lamp * sizeof *texels);
    free(maps->texels);
    maps->texels = texels;
    maps->room = count;
    return true;
}

const uint32_t *kiln_lamp_maps_run(struct kiln_lamp_maps *maps, const struct kiln_moment *moment,
                                   struct kiln_draw_light *lights, uint32_t light_count,
                                   uint32_t *count, struct kiln_error *error)
{
    struct face_job job = {.maps = maps};
    uint32_t anew = 0;
    *count = 0;
    place_meshes(maps, &moment->shapes);
    for (uint32_t i = 0; i < light_count && *count < KILN_MOST_LAMPS; i++) {
        if (!lights[i].casters.x)
            continue;
        struct shown *shown = &maps->shown[*count];
        const float4 position = lights[i].position_radius2;
        if (!shown->drawn || shown->position.x != position.x || shown->position.y != position.y ||
            shown->position.z != position.z) {
            *shown = (struct shown){true, position, reach_of(maps, position)};
            job.numbers[anew++] = *count;
        }
        lights[i].casters.y = ++*count;
        lights[i].maps.x = shown->far;
    }
    if (!reserve(maps, *count ? *count : 1, error))
        return NULL;
    kiln_threads_for(maps->threads, (size_t)anew * KILN_LAMP_FACES, 1, draw_faces, &job);
    maps->changes += anew;
    return maps->texels;
}

uint64_t kiln_lamp_maps_changes(const struct kiln_lamp_maps *maps)
{
    return maps->changes;
}
