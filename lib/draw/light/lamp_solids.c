/* This file collects the solid particles and draws the shadow maps in which lamps see them. Threads
 * draw the faces of all lamps independently, each on a canvas of its own, so that the result does
 * not depend on them. On a face, solids are drawn from the nearest to the farthest. Solids equally
 * far away follow each other as collected: meshes before spheres, by systems and slots.
 *
 * The particles are collected anew for each moment, and compared with those that the maps show:
 * only then is it known whether they moved. */
#include "draw/light/lamp_solids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/light/solid_face.h"
#include "draw/moment/appearance_blocks.h"
#include "draw/moment/shapes.h"
#include "scene/work.h"
#include "shared/exact.h"

enum { FIRST_ROOM = 1024, FACES = KILN_MOST_LAMPS * KILN_LAMP_FACES };

/* Holds the pose of a mesh, which it has besides the sphere that stands for it. */
struct posed {
    float4 axes[3]; /* of the mesh in the world, for each unit of a corner, m */
    float reach;    /* radius of its bounding sphere, m */
    uint32_t system;
    uint32_t unused[2]; /* so that there is no padding, which memcmp would compare */
};

/* Holds the solids of a moment. */
struct collected {
    float4 *balls; /* in the world; w: radius, m */
    size_t count, room;
    struct posed *meshes; /* of the first mesh_count solids */
    size_t mesh_count, mesh_room;
};

/* Holds what the map of a lamp depends on besides the solids. */
struct lamp_key {
    float4 position, color, facing, right;
};

/* A solid on a face. */
struct turn {
    float distance2; /* square of its distance from the lamp, m^2 */
    uint32_t number;
};

/* Holds what a thread needs to draw a face. */
struct painter {
    struct kiln_solid_canvas *canvas;
    struct turn *turns;
};

struct kiln_lamp_solids {
    const struct kiln_scene *scene;
    const struct kiln_instances *instances;
    struct kiln_threads *threads;
    kiln_appearance_find *find;
    bool triangles; /* meshes are drawn as such, unless they are too many */
    bool failed;    /* memory was short for a solid */
    struct collected now, before;
    struct painter *painters; /* one for each thread */
    size_t turn_room;         /* of each of them */
    uint32_t *texels;
    uint32_t room; /* lamps that `texels` has room for */
    struct lamp_key shown[KILN_MOST_LAMPS];
    uint32_t shown_count; /* maps that show the solids of `before` */
    float far[KILN_MOST_LAMPS];
    bool filled[FACES]; /* the face shows a solid */
    uint64_t changes[FACES];
};

bool kiln_lamp_solids_exist(const struct kiln_scene *scene)
{
    return kiln_shape_features(scene).solids && kiln_scene_shadow_lights(scene) > 0;
}

struct kiln_lamp_solids *kiln_lamp_solids_create(const struct kiln_moment *moment,
                                                 struct kiln_threads *threads,
                                                 struct kiln_error *error)
{
    struct kiln_lamp_solids *solids = calloc(1, sizeof *solids);
    const uint32_t count = kiln_threads_count(threads);
    bool ok = solids != NULL;
    if (ok) {
        solids->scene = moment->scene;
        solids->instances = &moment->instances;
        solids->threads = threads;
        solids->find = KILN_SIMD_PICK(kiln_appearance_find, moment->simd);
        solids->triangles = kiln_instance_tile_edge(moment->scene) > 0;
        solids->painters = calloc(count, sizeof *solids->painters);
        ok = solids->painters != NULL;
    }
    for (uint32_t i = 0; ok && i < count; i++) {
        solids->painters[i].canvas = kiln_solid_canvas_create();
        ok = solids->painters[i].canvas != NULL;
    }
    if (!ok) {
        kiln_error_no_memory(error, "the shadows of lamps");
        kiln_lamp_solids_destroy(&solids);
    }
    return solids;
}

void kiln_lamp_solids_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_lamp_solids *s = NULL;
    const uint64_t solids = kiln_scene_solid_slots(scene);
    const uint64_t meshes = kiln_instance_tile_edge(scene) > 0 ? kiln_scene_mesh_slots(scene) : 0;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, solids,
                       2 * sizeof *s->now.balls + footprint->threads * sizeof(struct turn));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, meshes, 2 * sizeof *s->now.meshes);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_LIGHTS, footprint->threads,
                       kiln_solid_canvas_bytes());
    kiln_footprint_add(footprint, KILN_FOOTPRINT_LIGHTS, kiln_scene_shadow_lights(scene),
                       (uint64_t)KILN_LAMP_FACES * KILN_LAMP_SOLID_WORDS * sizeof *s->texels);
}

void kiln_lamp_solids_destroy(struct kiln_lamp_solids **solids)
{
    struct kiln_lamp_solids *s = *solids;
    if (!s)
        return;
    for (uint32_t i = 0; s->painters && i < kiln_threads_count(s->threads); i++) {
        kiln_solid_canvas_destroy(&s->painters[i].canvas);
        free(s->painters[i].turns);
    }
    free(s->painters);
    free(s->now.balls);
    free(s->now.meshes);
    free(s->before.balls);
    free(s->before.meshes);
    free(s->texels);
    free(s);
    *solids = NULL;
}

/* ---- solids ---------------------------------------------------------------------------------- */

/* Returns the array with room for one entry more, or NULL when memory is short; the array is valid
 * still. */
static void *grow(void *array, size_t count, size_t *room, size_t size)
{
    if (count < *room)
        return array;
    const size_t more = *room ? 2 * *room : FIRST_ROOM;
    void *grown = realloc(array, more * size);
    if (grown)
        *room = more;
    return grown;
}

static void add_ball(struct kiln_lamp_solids *solids, float3 at, float radius)
{
    struct collected *now = &solids->now;
    float4 *balls = grow(now->balls, now->count, &now->room, sizeof *balls);
    solids->failed |= !balls;
    if (!balls)
        return;
    now->balls = balls;
    now->balls[now->count++] = (float4){at.x, at.y, at.z, radius};
}

static float4 scaled(float3 axis, float size)
{
    return (float4){axis.x * size, axis.y * size, axis.z * size, 0.0f};
}

/* size: the longest edge of the mesh, m. */
static void add_mesh(struct kiln_lamp_solids *solids, const struct kiln_appearance_system *system,
                     uint32_t number, uint32_t slot, const struct value_clocks *clocks, float size)
{
    struct collected *now = &solids->now;
    struct posed *meshes = grow(now->meshes, now->mesh_count, &now->mesh_room, sizeof *meshes);
    solids->failed |= !meshes;
    if (!meshes)
        return;
    now->meshes = meshes;
    const struct kiln_look *look = &solids->scene->systems[number].look;
    const struct instance_axes axes = kiln_appearance_axes(system, slot, clocks, look->mesh.orient);
    now->meshes[now->mesh_count++] = (struct posed){
        .axes = {scaled(axes.x, size), scaled(axes.y, size), scaled(axes.z, size)},
        .reach = size * solids->instances->meshes[number].reach,
        .system = number,
    };
}

static void collect_system(struct kiln_lamp_solids *solids, const struct kiln_moment *moment,
                           uint32_t number)
{
    const struct kiln_appearance_system system = kiln_appearance_system(moment, number);
    const struct kiln_look *look = &solids->scene->systems[number].look;
    const bool mesh = look->shape == KILN_SHAPE_MESH;
    const float part = mesh ? 2.0f * look->mesh.shade : 1.0f; /* of the sphere that stands for it */
    struct kiln_appearance_block block;
    for (uint32_t first = 0; first < system.used && !solids->failed; first += KILN_LANES) {
        solids->find(&system, first, &block);
        for (uint32_t i = 0; i < KILN_LANES && !solids->failed; i++) {
            /* A particle's opacity scales its radius (solids_spheres.vert). */
            const float radius = block.radius[i] * block.opacity[i];
            if (!(block.alive[i] && radius > 0.0f))
                continue;
            const struct value_clocks clocks =
                kiln_appearance_clocks(&system, first + i, block.lanes.age_s[i], block.progress[i]);
            if (mesh && solids->triangles)
                add_mesh(solids, &system, number, first + i, &clocks, 2.0f * radius);
            add_ball(solids, kiln_get3(&block.position, i), radius * part);
        }
    }
}

/* Collects all solids; those that are drawn as meshes come first. */
static void collect(struct kiln_lamp_solids *solids, const struct kiln_moment *moment)
{
    const struct kiln_scene *scene = solids->scene;
    solids->now.count = solids->now.mesh_count = 0;
    for (int meshes = 1; meshes >= 0; meshes--) {
        for (uint32_t i = 0; i < scene->system_count; i++) {
            const struct kiln_system *system = &scene->systems[i];
            if (system->enabled && kiln_look_is_opaque(&system->look) &&
                (system->look.shape == KILN_SHAPE_MESH) == (meshes == 1))
                collect_system(solids, moment, i);
        }
    }
}

static bool same_bytes(const void *a, const void *b, size_t count, size_t size)
{
    return count == 0 || memcmp(a, b, count * size) == 0;
}

static bool have_moved(const struct collected *now, const struct collected *before)
{
    return now->count != before->count || now->mesh_count != before->mesh_count ||
           !same_bytes(now->balls, before->balls, now->count, sizeof *now->balls) ||
           !same_bytes(now->meshes, before->meshes, now->mesh_count, sizeof *now->meshes);
}

/* ---- what a lamp sees ------------------------------------------------------------------------ */

static float3 xyz(float4 v)
{
    return (float3){v.x, v.y, v.z};
}

/* Returns the radius of a sphere around all of a solid, m. */
static float bound_of(const struct collected *solids, size_t number)
{
    const float radius = solids->balls[number].w;
    return number < solids->mesh_count ? exact_max(radius, solids->meshes[number].reach) : radius;
}

/* Returns whether a solid may hide some of a lamp's light. One that contains the lamp's centre does
 * not, nor one that is behind a rectangle or outside of a spot's cone. from: from the lamp, m. */
static bool may_hide(const struct lamp_key *lamp, float3 from, float radius, float bound)
{
    const float square = float3_dot(from, from);
    if (!(square > radius * radius))
        return false;
    const float ahead = float3_dot(from, xyz(lamp->facing));
    if (lamp->facing.w == KILN_LAMP_RECTANGLE)
        return ahead + bound > 1e-3f;
    if (lamp->facing.w != KILN_LAMP_SPOT)
        return true;
    const float cosine = lamp->right.w, room = bound + lamp->color.w;
    const float sine = sqrtf(exact_max(1.0f - cosine * cosine, 0.0f));
    const float aside = sqrtf(exact_max(square - ahead * ahead, 0.0f));
    /* The distance from the cone; where its apex is nearest, that from the apex. */
    const bool beside = ahead * cosine + aside * sine > 0.0f;
    return (beside ? aside * cosine - ahead * sine : sqrtf(square)) < room;
}

/* Returns the part of a lamp that is behind a solid within it, 1 for a solid outside of it. */
static float opacity_of(const struct lamp_key *lamp, float distance)
{
    return exact_min(0.5f + 0.5f * distance / exact_max(lamp->color.w, 1e-5f), 1.0f);
}

static struct lamp_key key_of(const struct kiln_draw_light *light)
{
    return (struct lamp_key){light->position_radius2, light->color, light->facing, light->right};
}

static bool shines(const struct kiln_draw_light *light)
{
    return light->casters.x != 0 && light->color.x + light->color.y + light->color.z > 0.0f;
}

struct reach_job {
    const struct collected *solids;
    const struct kiln_draw_light *lights;
    float far[KILN_MOST_LAMPS]; /* results, m; 0: the light shines on no solid */
};

/* Finds the distance that the maps of lights reach: past all solids that may hide them. */
static void find_reach(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct reach_job *job = context;
    const struct collected *solids = job->solids;
    for (size_t i = begin; i < end; i++) {
        const struct lamp_key lamp = key_of(&job->lights[i]);
        job->far[i] = 0.0f;
        for (size_t k = 0; shines(&job->lights[i]) && k < solids->count; k++) {
            const float4 ball = solids->balls[k];
            const float3 from = float3_sub(xyz(ball), xyz(lamp.position));
            const float bound = bound_of(solids, k);
            const float square = float3_dot(from, from), more = job->far[i] - bound;
            if ((more <= 0.0f || square > more * more) && may_hide(&lamp, from, ball.w, bound))
                job->far[i] = sqrtf(square) + bound;
        }
    }
}

/* ---- faces ----------------------------------------------------------------------------------- */

/* Describes the maps that are drawn anew. */
struct face_job {
    struct kiln_lamp_solids *solids;
    uint32_t numbers[KILN_MOST_LAMPS];
};

static int compare_turns(const void *a, const void *b)
{
    const struct turn *x = a, *y = b;
    if (x->distance2 != y->distance2)
        return x->distance2 < y->distance2 ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

/* Lists the solids of a face, the nearest first. Returns how many they are. */
static size_t list_solids(const struct collected *solids, const struct lamp_key *lamp,
                          uint32_t face, struct turn *turns)
{
    size_t count = 0;
    for (size_t i = 0; i < solids->count; i++) {
        const float4 ball = solids->balls[i];
        const float3 from = float3_sub(xyz(ball), xyz(lamp->position));
        const float bound = bound_of(solids, i);
        if (!kiln_face_misses(kiln_face_frame(face, from), bound) &&
            may_hide(lamp, from, ball.w, bound))
            turns[count++] = (struct turn){float3_dot(from, from), (uint32_t)i};
    }
    qsort(turns, count, sizeof *turns, compare_turns);
    return count;
}

static void draw_solid(const struct kiln_lamp_solids *solids, const struct lamp_key *lamp,
                       uint32_t face, const struct turn *turn, struct kiln_solid_canvas *canvas)
{
    const float4 ball = solids->now.balls[turn->number];
    const struct kiln_seen_solid seen = {
        .center = kiln_face_frame(face, float3_sub(xyz(ball), xyz(lamp->position))),
        .radius = ball.w,
        .opacity = opacity_of(lamp, sqrtf(turn->distance2)),
    };
    if (turn->number >= solids->now.mesh_count) {
        kiln_solid_canvas_ball(canvas, &seen);
        return;
    }
    const struct posed *posed = &solids->now.meshes[turn->number];
    const struct kiln_instance_mesh *mesh = &solids->instances->meshes[posed->system];
    struct kiln_seen_mesh shape = {
        .corners = (const float4(*)[2])solids->instances->corners + mesh->first,
        .triangles = mesh->triangles,
        .reach = posed->reach,
    };
    for (int i = 0; i < 3; i++)
        shape.axes[i] = kiln_face_frame(face, xyz(posed->axes[i]));
    kiln_solid_canvas_mesh(canvas, &seen, &shape);
}

/* Draws a face; one that shows no solid, now and before, stays as it is. */
static void draw_face(struct kiln_lamp_solids *solids, uint32_t number, uint32_t face,
                      const struct painter *painter)
{
    const struct lamp_key *lamp = &solids->shown[number];
    const size_t at = (size_t)number * KILN_LAMP_FACES + face;
    const size_t count = list_solids(&solids->now, lamp, face, painter->turns);
    if (count == 0 && !solids->filled[at])
        return;
    solids->filled[at] = count > 0;
    solids->changes[at]++;
    kiln_solid_canvas_clear(painter->canvas, solids->far[number]);
    for (size_t i = 0; i < count; i++)
        draw_solid(solids, lamp, face, &painter->turns[i], painter->canvas);
    kiln_solid_canvas_write(painter->canvas, solids->texels + at * KILN_LAMP_SOLID_WORDS);
}

static void draw_faces(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct face_job *job = context;
    for (size_t i = begin; i < end; i++)
        draw_face(job->solids, job->numbers[i / KILN_LAMP_FACES], (uint32_t)(i % KILN_LAMP_FACES),
                  &job->solids->painters[worker]);
}

/* ---- maps ------------------------------------------------------------------------------------ */

/* Makes room for the maps of lamps, empty at first, and for the list of each thread. */
static bool reserve(struct kiln_lamp_solids *solids, uint32_t count, struct kiln_error *error)
{
    const size_t lamp = (size_t)KILN_LAMP_FACES * KILN_LAMP_SOLID_WORDS;
    bool ok = !solids->failed;
    if (ok && count > solids->room) {
        uint32_t *texels = realloc(solids->texels, count * lamp * sizeof *texels);
        ok = texels != NULL;
        if (ok) {
            memset(texels + solids->room * lamp, 0, (count - solids->room) * lamp * sizeof *texels);
            solids->texels = texels;
            solids->room = count;
        }
    }
    const size_t turns = solids->now.room;
    for (uint32_t i = 0; ok && turns > solids->turn_room && i < kiln_threads_count(solids->threads);
         i++) {
        free(solids->painters[i].turns);
        solids->painters[i].turns = malloc(turns * sizeof *solids->painters[i].turns);
        ok = solids->painters[i].turns != NULL;
    }
    solids->turn_room = ok ? turns : 0;
    return ok || kiln_error_no_memory(error, "the shadows of lamps");
}

static void swap_collected(struct kiln_lamp_solids *solids)
{
    const struct collected now = solids->now;
    solids->now = solids->before;
    solids->before = now;
}

bool kiln_lamp_solids_run(struct kiln_lamp_solids *solids, const struct kiln_moment *moment,
                          struct kiln_draw_light *lights, uint32_t light_count,
                          struct kiln_lamp_solid_maps *maps, struct kiln_error *error)
{
    struct reach_job reach = {.solids = &solids->now, .lights = lights};
    struct face_job job = {.solids = solids};
    uint32_t count = 0, anew = 0;
    *maps = (struct kiln_lamp_solid_maps){.count = 0};
    collect(solids, moment);
    kiln_threads_for(solids->threads, light_count, 1, find_reach, &reach);
    const uint32_t kept = have_moved(&solids->now, &solids->before) ? 0 : solids->shown_count;
    solids->shown_count = 0;
    for (uint32_t i = 0; i < light_count && count < KILN_MOST_LAMPS; i++) {
        if (!(reach.far[i] > 0.0f))
            continue;
        const struct lamp_key key = key_of(&lights[i]);
        if (count >= kept || memcmp(&key, &solids->shown[count], sizeof key) != 0)
            job.numbers[anew++] = count;
        solids->shown[count] = key;
        solids->far[count] = reach.far[i];
        lights[i].casters.y |= ++count << KILN_LAMP_SOLID_SHIFT;
        lights[i].maps.w = reach.far[i];
    }
    if (!reserve(solids, count, error))
        return false;
    kiln_threads_for(solids->threads, (size_t)anew * KILN_LAMP_FACES, 1, draw_faces, &job);
    solids->shown_count = count;
    swap_collected(solids);
    *maps = (struct kiln_lamp_solid_maps){count, solids->texels, solids->changes};
    return true;
}
