/* This file steps particles in geometry shaders and captures the living ones by transform feedback.
 * The thesis keeps its particles in the captured stream and asks a query for their number before
 * the next step (Heinz 2019, 3.3.3). Here the number stays in GL, and each step ends with the state
 * in the pool's slots, as with every technique, where it is hashed, sorted, drawn and saved.
 * Children read their parents' traces from storage blocks, as in compute. */
#include <stdio.h>

#include "gpu/capture.h"
#include "shared/papers/step_layout.h"
#include "sim/step/papers/common.h"
#include "sim/step/papers/papers.h"

struct feedback {
    struct kiln_capture capture;
    struct kiln_sim_programs move, emit;
    GLuint place_program;
    /* transform feedback objects, which also have the number of captured particles */
    GLuint moved, born;
    struct kiln_buffer stream; /* as large as the pool's records */
};

/* Returns how many births one emitter makes in programs for a device. */
static uint32_t emitter_births(const struct kiln_device *device)
{
    return device->info.software ? 1 : SIM_EMITTER_BIRTHS;
}

static void finish(void *technique)
{
    struct feedback *feedback = technique;
    kiln_capture_finish(&feedback->capture);
    kiln_sim_programs_finish(&feedback->move);
    kiln_sim_programs_finish(&feedback->emit);
    if (feedback->place_program)
        glDeleteProgram(feedback->place_program);
    if (feedback->moved)
        glDeleteTransformFeedbacks(1, &feedback->moved);
    if (feedback->born)
        glDeleteTransformFeedbacks(1, &feedback->born);
    kiln_buffer_finish(&feedback->stream);
}

static bool init(void *technique, struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_sim_params *params, struct kiln_error *error)
{
    struct feedback *feedback = technique;
    kiln_buffer_init(&feedback->stream, device, 0, KILN_SIM_SECOND);
    if (!kiln_sim_check_stage(device, params, KILN_PROBE_GEOMETRY, error) ||
        !kiln_capture_init(&feedback->capture, device, 2, error))
        return false;
    glGenTransformFeedbacks(1, &feedback->moved);
    glGenTransformFeedbacks(1, &feedback->born);
    static const char *const record[] = {"stream_position_serial", "stream_velocity_birth"};
    char defines[48];
    snprintf(defines, sizeof defines, "#define SIM_EMITTER_BIRTHS %u\n", emitter_births(device));
    struct kiln_program_params files = {.vertex = "sim/step/papers/feedback.vert",
                                        .geometry = "sim/step/papers/feedback.geom",
                                        .defines = defines,
                                        .captured = record,
                                        .captured_count = 2};
    if (!kiln_sim_programs_init(&feedback->move, device, scene, params, files, error))
        return false;
    files.geometry = "sim/step/papers/feedback_emit.geom";
    if (!kiln_sim_programs_init(&feedback->emit, device, scene, params, files, error))
        return false;
    feedback->place_program = kiln_program_create(
        device, &(struct kiln_program_params){.vertex = "sim/step/papers/feedback_place.vert"},
        error);
    return feedback->place_program != 0;
}

static const size_t RECORD = sizeof(struct kiln_particle);

/* A range of records of one system in a buffer. */
struct range {
    GLuint buffer;
    uint32_t first, count;
};

static void read_vertices(struct range from)
{
    glBindVertexBuffer(0, from.buffer, (GLintptr)(from.first * RECORD), (GLsizei)RECORD);
}

/* Runs the program for a number of vertices and captures what it emits in a range. */
static void stream(GLuint object, GLuint program, uint32_t vertices, struct range to)
{
    if (to.count == 0)
        return;
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, object);
    glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, to.buffer, (GLintptr)(to.first * RECORD),
                      (GLsizeiptr)(to.count * RECORD));
    glUseProgram(program);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, (GLsizei)vertices);
    glEndTransformFeedback();
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
}

/* Writes the captured particles into their slots. */
static void place(GLuint object, struct range from)
{
    if (from.count == 0)
        return;
    read_vertices(from);
    glDrawTransformFeedback(GL_POINTS, object);
}

static void empty(struct range slots)
{
    const GLuint zero = 0;
    glBindBuffer(GL_COPY_WRITE_BUFFER, slots.buffer);
    glClearBufferSubData(GL_COPY_WRITE_BUFFER, GL_R32UI, (GLintptr)(slots.first * RECORD),
                         (GLsizeiptr)(slots.count * RECORD), GL_RED_INTEGER, GL_UNSIGNED_INT,
                         &zero);
}

/* Steps one system. Births take the last places of the stream; the particles that move fit before
 * them, since they come from slots that nothing is born into. */
static void step_system(const struct feedback *feedback, const struct kiln_step_params *step,
                        GLuint records, GLuint second)
{
    const struct range slots = {records, step->base, step->used};
    const struct range moved = {second, step->base, step->used - step->birth_count};
    const struct range born = {second, moved.first + moved.count, step->birth_count};
    const uint32_t births = emitter_births(feedback->stream.device);
    const uint32_t emitters = (step->birth_count + births - 1) / births;
    read_vertices(slots);
    stream(feedback->moved, kiln_sim_programs_of(&feedback->move, step), slots.count, moved);
    stream(feedback->born, kiln_sim_programs_of(&feedback->emit, step), emitters, born);
    empty(slots);
    glUseProgram(feedback->place_program);
    place(feedback->moved, moved);
    place(feedback->born, born);
}

static bool step_pool(void *technique, const struct kiln_sim_blocks *blocks,
                      const struct kiln_sim_params *params, struct kiln_pool *pool, uint32_t number,
                      struct kiln_error *error)
{
    (void)number;
    struct feedback *feedback = technique;
    GLuint records = kiln_buffer_gl(&pool->records, KILN_READ_WRITE, error);
    GLuint second = kiln_sim_second(&feedback->stream, pool, error);
    if (!records || !second)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, SIM_BIND_RECORDS, records);
    kiln_capture_begin(&feedback->capture);
    for (uint32_t k = 0; k < params->system_count; k++) {
        uint32_t i = params->order[k];
        if (params->systems[i].used == 0)
            continue;
        kiln_sim_blocks_bind(blocks, params, i);
        step_system(feedback, &params->systems[i], records, second);
    }
    kiln_capture_end();
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    return kiln_device_check(blocks->device, "simulate", error);
}

const struct kiln_simulate_row kiln_simulate_feedback_row = {
    .copies = 2,
    .size = sizeof(struct feedback),
    .init = init,
    .finish = finish,
    .step = step_pool,
};
