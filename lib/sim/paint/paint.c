/* This file paints the meshes of a scene with the particles that hit them in a step. It makes a
 * splat of each slot's trace, in the mesh's own space at the moment of the impact, and has the
 * texels of the mesh gather the splats in the order of systems and slots. Where only some particles
 * have their turn in a step (Drone 2007, 7.6.1.3), each slot keeps its last splat until then. */
#include "sim/paint/paint.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/matrix.h"
#include "scene/pool_layout.h"
#include "shared/trace.h"

enum { SLOTS_AT_A_TIME = 1024 };

struct kiln_paint_mesh {
    uint32_t object; /* index of the object in the scene */
    struct kiln_chart *chart;
    struct kiln_paint_grid grid;
};

/* ---- meshes ---------------------------------------------------------------------------------- */

static bool load(struct kiln_paint *paint, uint32_t object, struct kiln_error *error)
{
    const struct kiln_scene *scene = paint->scene;
    const struct kiln_object *taker = &scene->backdrop.objects[object];
    struct kiln_paint_mesh *mesh = &paint->meshes[paint->mesh_count++];
    mesh->object = object;
    mesh->chart = kiln_chart_create(taker->shown, taker->paint.size, taker->file, error);
    return mesh->chart && kiln_paint_grid_init(&mesh->grid, mesh->chart, error);
}

bool kiln_paint_init(struct kiln_paint *paint, const struct kiln_scene *scene,
                     struct kiln_threads *threads, struct kiln_error *error)
{
    *paint = (struct kiln_paint){
        .scene = scene, .slot_count = kiln_scene_paint_slots(scene), .threads = threads};
    if (paint->slot_count == 0)
        return true;
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error))
        return false;
    paint->block = KILN_SIMD_PICK(kiln_paint_block_of, simd);
    paint->meshes = calloc(KILN_MAX_MESHES, sizeof *paint->meshes);
    paint->made = malloc(paint->slot_count * sizeof *paint->made);
    paint->turns = malloc(paint->slot_count * sizeof *paint->turns);
    if (!paint->meshes || !paint->made || !paint->turns) {
        kiln_error_no_memory(error, "the paint");
        return false;
    }
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        if (kiln_object_takes_paint(&scene->backdrop.objects[i]) && !load(paint, i, error))
            return false;
    }
    return true;
}

void kiln_paint_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_paint *p = NULL;
    const uint32_t slots = kiln_scene_paint_slots(scene);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, slots,
                       sizeof *p->made + sizeof *p->turns);
    for (uint32_t i = 0; i < scene->backdrop.object_count && slots > 0; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (!kiln_object_takes_paint(object))
            continue;
        const uint32_t edge = object->paint.size;
        kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, 1, kiln_chart_bytes(edge));
        kiln_footprint_pass(footprint, KILN_FOOTPRINT_OBJECTS, kiln_chart_making_bytes(edge));
        kiln_paint_grid_footprint(edge, slots, footprint);
    }
}

void kiln_paint_finish(struct kiln_paint *paint)
{
    for (uint32_t i = 0; i < paint->mesh_count; i++) {
        kiln_chart_destroy(&paint->meshes[i].chart);
        kiln_paint_grid_finish(&paint->meshes[i].grid);
    }
    free(paint->meshes);
    free(paint->made);
    free(paint->turns);
    *paint = (struct kiln_paint){.mesh_count = 0};
}

/* ---- splats ---------------------------------------------------------------------------------- */

/* The pose of a mesh at a time: the transform from the world to the mesh's frame, and metres in one
 * of its units. */
struct pose {
    mat4 to_local;
    float metres;
};

static struct pose pose_at(const struct kiln_scene *scene, const struct kiln_object *mesh,
                           float time_s)
{
    const float3 center = kiln_object_center(scene, mesh, time_s);
    vec3 at = {center.x, center.y, center.z};
    mat3 rotation;
    float4 rows[3];
    struct pose pose = {.metres = kiln_object_length(scene, mesh, &mesh->scale, time_s)};
    kiln_object_rotation(scene, mesh, time_s, rotation);
    /* the transposed rotation divided by the scale; then the position */
    for (int i = 0; i < 3; i++) {
        vec3 row;
        glm_vec3_divs(rotation[i], pose.metres, row);
        rows[i] = FLOAT4(row[0], row[1], row[2], -glm_vec3_dot(row, at));
    }
    kiln_matrix_from_rows(rows, pose.to_local);
    return pose;
}

/* The state while splats are made for one system and one mesh. */
struct making {
    const struct kiln_scene *scene;
    const struct kiln_system *system;
    const struct kiln_step_params *step;
    const struct kiln_trace *traces;
    const struct kiln_chart *chart;
    struct pose start, end; /* poses at the start and the end of the step */
    struct kiln_splat *out;
};

/* Transforms a vector to the mesh's frame at the part `since` of the step. */
static float3 to_mesh(const struct making *m, float3 v, float w, float since)
{
    struct pose start = m->start, end = m->end;
    vec4 at = {v.x, v.y, v.z, w}, before, after;
    glm_mat4_mulv(start.to_local, at, before);
    glm_mat4_mulv(end.to_local, at, after);
    glm_vec4_lerp(before, after, since, at);
    return FLOAT3(at[0], at[1], at[2]);
}

/* The mark that a particle leaves, as its trace tells. */
struct mark {
    float3 at, normal; /* in the world */
    float since;       /* time, as a part of the step */
    float life;        /* progress of the particle's life at that time */
};

static bool find_mark(const struct making *m, const struct kiln_trace *trace, struct mark *mark)
{
    const uint32_t events = trace->serial_event.y;
    if (m->system->paint.when == KILN_PAINT_NEAR) {
        *mark = (struct mark){
            .at = trace_vector(trace->end), .since = trace->end.w, .life = trace->end_velocity.w};
        return (events & TRACE_ALIVE) != 0;
    }
    if ((events & TRACE_TURN) == 0)
        return false;
    const float passed = exact_div(trace->turn.w - trace->start.w, trace->end.w - trace->start.w);
    const float3 normal = trace_normal(*trace);
    *mark = (struct mark){
        .at = float3_add_scaled(trace_vector(trace->turn), normal, -trace->turn_velocity.w),
        .normal = normal,
        .since = trace->turn.w,
        .life = exact_lerp(trace->start_velocity.w, trace->end_velocity.w,
                           exact_clamp(passed, 0.0f, 1.0f)),
    };
    return true;
}

/* Returns whether a splat of this radius may reach the mesh. */
static bool is_near(const struct kiln_chart *chart, float3 at, float radius)
{
    const float place[3] = {at.x, at.y, at.z};
    bool near = true;
    for (int c = 0; c < 3; c++)
        near = near && place[c] >= chart->min[c] - radius && place[c] <= chart->max[c] + radius;
    return near;
}

/* Returns the clocks of a particle at its mark. */
static struct value_clocks clocks_of(const struct making *m, const struct kiln_trace *trace,
                                     const struct mark *mark, float time_s)
{
    const uint32_t key = m->step->derived.random_key;
    struct value_clocks clocks = value_clocks_at(time_s, key, m->step->derived.scene_key);
    clocks.life = mark->life;
    clocks.age_s = mark->life * BITS_FLOAT(trace->serial_event.w);
    clocks.height = mark->at.y;
    clocks.velocity = trace_vector(trace->end_velocity);
    clocks.stream = random_stream(key, trace->serial_event.x);
    return clocks;
}

static struct kiln_splat make_splat(const struct making *m, const struct kiln_trace *trace)
{
    struct kiln_splat splat = {.opacity = 0.0f};
    struct mark mark;
    if (!find_mark(m, trace, &mark))
        return splat;
    const struct kiln_painting *paint = &m->system->paint;
    const float4 *keys = m->scene->keys;
    const float time_s = m->step->time_s + mark.since * m->scene->dt_s;
    const struct value_clocks clocks = clocks_of(m, trace, &mark, time_s);
    const float radius_m =
        random_between(clocks.stream, RANDOM_PAINT, value_at(keys, paint->radius.min, clocks),
                       value_at(keys, paint->radius.max, clocks));
    const float radius =
        radius_m / (m->start.metres + (m->end.metres - m->start.metres) * mark.since);
    const float3 at = to_mesh(m, mark.at, 1.0f, mark.since);
    if (!is_near(m->chart, at, radius))
        return splat;
    const float3 normal = to_mesh(m, mark.normal, 0.0f, mark.since);
    const float3 color = value3_at(keys, m->system->look.color, clocks);
    const float soft = value_at(keys, paint->soft, clocks);
    /* A limit keeps the slope at the rim finite. */
    const float outer = exact_max(soft * (2.0f - soft), 1e-3f);
    splat = (struct kiln_splat){
        .position = {at.x, at.y, at.z},
        .opacity = exact_clamp(value_at(keys, paint->opacity, clocks), 0.0f, 1.0f),
        .normal = {normal.x, normal.y, normal.z},
        .radius_squared = radius * radius,
        .color = {exact_clamp(color.x, 0.0f, 1.0f), exact_clamp(color.y, 0.0f, 1.0f),
                  exact_clamp(color.z, 0.0f, 1.0f)},
        .slope = 1.0f / (outer * radius * radius),
    };
    return splat;
}

static void make_splats(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct making *m = context;
    for (size_t slot = begin; slot < end; slot++)
        m->out[slot] = make_splat(m, &m->traces[slot]);
}

/* Makes the splats of all systems that paint, in the order of their slots. */
static void make_all(const struct kiln_paint *paint, const struct kiln_sim_params *params,
                     const struct kiln_paint_mesh *mesh, const struct kiln_trace *traces)
{
    const struct kiln_scene *scene = paint->scene;
    const struct kiln_object *object = &scene->backdrop.objects[mesh->object];
    const float start_s = params->systems[0].time_s;
    const float end_s = kiln_scene_time(scene, params->systems[0].step);
    const struct pose start = pose_at(scene, object, start_s), end = pose_at(scene, object, end_s);
    struct kiln_splat *out = paint->made;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (!kiln_scene_paints(scene, i))
            continue;
        const struct kiln_step_params *step = &params->systems[i];
        struct making making = {.scene = scene,
                                .system = &scene->systems[i],
                                .step = step,
                                .traces = traces + step->family.traces,
                                .chart = mesh->chart,
                                .start = start,
                                .end = end,
                                .out = out};
        kiln_threads_for(paint->threads, step->used, SLOTS_AT_A_TIME, make_splats, &making);
        for (uint32_t slot = step->used; slot < step->capacity; slot++)
            out[slot].opacity = 0.0f;
        out += step->capacity;
    }
}

/* Collects the splats that are painted in this step by their turn; returns their number. */
static uint32_t take_turns(const struct kiln_paint *paint, struct kiln_canvas *canvas,
                           uint32_t per_step)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < paint->slot_count; i++) {
        if (!(paint->made[i].opacity > 0.0f))
            continue;
        if (canvas->pending)
            canvas->pending[i] = paint->made[i];
        else
            paint->turns[count++] = paint->made[i];
    }
    for (uint32_t k = 0; canvas->pending && k < per_step; k++) {
        struct kiln_splat *splat = &canvas->pending[canvas->next];
        canvas->next = canvas->next + 1 < canvas->slot_count ? canvas->next + 1 : 0;
        if (splat->opacity > 0.0f)
            paint->turns[count++] = *splat;
        splat->opacity = 0.0f;
    }
    return count;
}

/* ---- a step ---------------------------------------------------------------------------------- */

bool kiln_paint_step(struct kiln_paint *paint, const struct kiln_sim_params *params,
                     struct kiln_pool *pool, struct kiln_buffer *traces, struct kiln_error *error)
{
    if (paint->mesh_count == 0)
        return true;
    const struct kiln_trace *left = kiln_buffer_host(traces, KILN_READ, error);
    if (!left)
        return false;
    for (uint32_t i = 0; i < paint->mesh_count; i++) {
        struct kiln_paint_mesh *mesh = &paint->meshes[i];
        struct kiln_canvas *canvas = &pool->canvases[i];
        const struct kiln_object_paint *taker = &paint->scene->backdrop.objects[mesh->object].paint;
        const struct kiln_paint_gather gather = {
            .threads = paint->threads,
            .block = paint->block,
            .chart = mesh->chart,
            .grid = taker->gather == KILN_GATHER_NEAR ? &mesh->grid : NULL};
        bool changed;
        make_all(paint, params, mesh, left);
        const uint32_t count = take_turns(paint, canvas, taker->per_step);
        if (!kiln_paint_gather(&gather, paint->turns, count, canvas->texels, &changed, error))
            return false;
        canvas->changes += changed;
    }
    return true;
}

void kiln_paint_hash(const struct kiln_pool *pool, struct kiln_state_hash *hash)
{
    for (uint32_t i = 0; i < pool->canvas_count; i++)
        kiln_canvas_hash(&pool->canvases[i], i, hash);
}
