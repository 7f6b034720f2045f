/* This file runs the exactness probe: it evaluates the arithmetic of the simulation in a shader
 * stage and compares the results with C. The shader calls the same functions as the simulation, so
 * a driver that passes rounds, compares and hashes as C does. */
#include "gpu/probe.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "gpu/buffer.h"
#include "gpu/capture.h"
#include "gpu/integer_textures.h"
#include "gpu/program.h"
#include "shared/probe.h"

/* Bit patterns of special and extreme floats. The first test vectors are all pairs of them. */
static const uint32_t edges[] = {
    0x00000000u, 0x80000000u, 0x00000001u, 0x807fffffu, 0x00800000u, 0x0d7fffffu, 0x0d800000u,
    0x8d800000u, 0x33800000u, 0x3effffffu, 0x3f000000u, 0x3f7fffffu, 0x3f800000u, 0x3f800001u,
    0xbf800000u, 0x3fc90fdbu, 0x40490fdbu, 0xc0490fdbu, 0x3f317218u, 0x42b17218u, 0xc28a0000u,
    0x46000000u, 0x46000001u, 0x4affffffu, 0x4b000000u, 0x4b7fffffu, 0x5effffffu, 0x71800000u,
    0x71800001u, 0x7f7fffffu, 0x7f800000u, 0xff800000u, 0x7fc00000u, 0xffffffffu,
};
enum { EDGES = sizeof edges / sizeof *edges };

static const char *const word_names[PROBE_WORDS] = {
    "a + b",       "a - b",       "a * b",       "a * b + c", "min",     "max",     "floor",
    "compare",     "rcp",         "div",         "sqrt",      "rsqrt",   "sin",     "cos",
    "exp",         "canon",       "unit x",      "unit y",    "unit z",  "dot",     "cross x",
    "cross y",     "cross z",     "lerp",        "noise x",   "noise y", "noise z", "hash",
    "direction x", "direction y", "direction z", "random",
};
static_assert(sizeof(struct probe_result) == PROBE_WORDS * sizeof(uint32_t), "std430");

static uint4 vector_at(uint32_t index)
{
    uint32_t w = random_mix(index ^ 0x51ab2e07u);
    if (index < EDGES * EDGES)
        return UINT4(edges[index % EDGES], edges[index / EDGES], edges[random_mix(index) % EDGES],
                     w);
    return UINT4(random_mix(3 * index), random_mix(3 * index + 1), random_mix(3 * index + 2), w);
}

struct probe {
    struct kiln_device *device;
    enum kiln_probe_stage stage;
    GLuint program;
    struct kiln_capture capture;                  /* for the geometry stage */
    struct kiln_integer_textures inputs, outputs; /* for the fragment stage */
    struct kiln_buffer vectors, results;
};

enum { ROW = 64, MEMBERS = PROBE_WORDS / 4 };

/* Returns count rounded up to whole rows of the texture. */
static uint32_t whole_rows(uint32_t count)
{
    return (count + ROW - 1) / ROW * ROW;
}

/* Returns the index of a result word. In the fragment stage, each member of the results (four
 * words) is a texture with one texel a vector. */
static size_t word_index(const struct probe *probe, uint32_t vector, uint32_t word)
{
    size_t vectors = probe->vectors.size / sizeof(uint4);
    if (probe->stage == KILN_PROBE_FRAGMENT)
        return (word / 4 * vectors + vector) * 4 + word % 4;
    return (size_t)vector * PROBE_WORDS + word;
}

static void run_compute(struct probe *probe, uint32_t count, GLuint vectors, GLuint results)
{
    glUniform1ui(PROBE_AT_COUNT, count);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PROBE_BIND_VECTORS, vectors);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PROBE_BIND_RESULTS, results);
    kiln_device_dispatch(probe->device, count, 64);
}

static void run_geometry(struct probe *probe, uint32_t count, GLuint vectors, GLuint results)
{
    kiln_capture_begin(&probe->capture);
    glBindVertexBuffer(0, vectors, 0, sizeof(uint4));
    glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, results, 0,
                      (GLsizeiptr)(count * sizeof(struct probe_result)));
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, (GLsizei)count);
    glEndTransformFeedback();
    kiln_capture_end();
}

static void run_fragment(struct probe *probe, uint32_t count, GLuint vectors, GLuint results)
{
    const GLsizei rows = (GLsizei)(whole_rows(count) / ROW);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, vectors);
    glBindTexture(GL_TEXTURE_2D, probe->inputs.textures[0]);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, ROW, rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT, NULL);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    kiln_integer_textures_bind(&probe->inputs, 0);
    kiln_integer_textures_draw(&probe->outputs, 0, (uint32_t)rows);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, results);
    for (uint32_t i = 0; i < MEMBERS; i++) {
        glReadBuffer(GL_COLOR_ATTACHMENT0 + i);
        glReadPixels(0, 0, ROW, rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                     (void *)(i * probe->vectors.size)); /* NOLINT(performance-no-int-to-ptr) */
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

static bool run_on_device(struct probe *probe, uint32_t first, uint32_t count,
                          struct kiln_error *error)
{
    uint4 *vectors = kiln_buffer_host(&probe->vectors, KILN_OVERWRITE, error);
    if (!vectors)
        return false;
    for (uint32_t i = 0; i < count; i++)
        vectors[i] = vector_at(first + i);
    GLuint vector_buffer = kiln_buffer_gl(&probe->vectors, KILN_READ, error);
    GLuint result_buffer = kiln_buffer_gl(&probe->results, KILN_OVERWRITE, error);
    if (!vector_buffer || !result_buffer)
        return false;
    glUseProgram(probe->program);
    if (probe->stage == KILN_PROBE_GEOMETRY)
        run_geometry(probe, count, vector_buffer, result_buffer);
    else if (probe->stage == KILN_PROBE_FRAGMENT)
        run_fragment(probe, count, vector_buffer, result_buffer);
    else
        run_compute(probe, count, vector_buffer, result_buffer);
    return kiln_device_check(probe->device, "probe", error);
}

/* Returns true when all results equal those of C; otherwise fills in the reason. */
static bool compare(const struct probe *probe, const uint4 *vectors, const uint32_t *results,
                    uint32_t count, char reason[256])
{
    for (uint32_t i = 0; i < count; i++) {
        struct probe_result expected = probe_run(vectors[i]);
        uint32_t expected_words[PROBE_WORDS];
        memcpy(expected_words, &expected, sizeof expected_words);
        for (uint32_t word = 0; word < PROBE_WORDS; word++) {
            const uint32_t found = results[word_index(probe, i, word)];
            if (expected_words[word] != found) {
                snprintf(reason, 256, "%s of (%08x, %08x, %08x, %08x) is %08x instead of %08x",
                         word_names[word], vectors[i].x, vectors[i].y, vectors[i].z, vectors[i].w,
                         found, expected_words[word]);
                return false;
            }
        }
    }
    return true;
}

static bool run(struct probe *probe, uint32_t count, char reason[256], struct kiln_error *error)
{
    enum { MAX_BATCH = 1 << 16 };
    const uint32_t most = count < MAX_BATCH ? count : MAX_BATCH;
    const size_t capacity = whole_rows(most);
    kiln_buffer_init(&probe->vectors, probe->device, capacity * sizeof(uint4), "probe vectors");
    kiln_buffer_init(&probe->results, probe->device, capacity * sizeof(struct probe_result),
                     "probe results");
    if (probe->stage == KILN_PROBE_FRAGMENT &&
        (!kiln_integer_textures_init(&probe->inputs, probe->device, 1, ROW, whole_rows(most) / ROW,
                                     "probe vectors", error) ||
         !kiln_integer_textures_init(&probe->outputs, probe->device, MEMBERS, ROW,
                                     whole_rows(most) / ROW, "probe results", error)))
        return false;
    for (uint32_t first = 0; first < count; first += most) {
        uint32_t batch = count - first < most ? count - first : most;
        if (!run_on_device(probe, first, batch, error))
            return false;
        const uint4 *vectors = kiln_buffer_host(&probe->vectors, KILN_READ, error);
        const uint32_t *results = kiln_buffer_host(&probe->results, KILN_READ, error);
        if (!vectors || !results || !compare(probe, vectors, results, batch, reason))
            return false;
    }
    return true;
}

static bool init_probe(struct probe *probe, struct kiln_error *error)
{
    struct kiln_program_params files = {.compute = "gpu/probe.comp"};
    if (probe->stage == KILN_PROBE_FRAGMENT)
        files = (struct kiln_program_params){.vertex = "gpu/framebuffer_fill.vert",
                                             .fragment = "gpu/probe.frag"};
    if (probe->stage == KILN_PROBE_GEOMETRY) {
        static const char *const varyings[] = {"sums",        "orders",     "roots",      "curves",
                                               "unit_square", "cross_lerp", "noise_hash", "around"};
        files = (struct kiln_program_params){.vertex = "gpu/probe.vert",
                                             .geometry = "gpu/probe.geom",
                                             .captured = varyings,
                                             .captured_count = sizeof varyings / sizeof *varyings};
        if (!kiln_capture_init(&probe->capture, probe->device, 1, error))
            return false;
    }
    probe->program = kiln_program_create(probe->device, &files, error);
    return probe->program != 0;
}

bool kiln_probe_vectors(struct kiln_device *device, enum kiln_probe_stage stage, uint32_t count,
                        char reason[256], struct kiln_error *error)
{
    reason[0] = '\0';
    struct probe probe = {.device = device, .stage = stage};
    bool exact = init_probe(&probe, error) && run(&probe, count, reason, error);
    kiln_buffer_finish(&probe.vectors);
    kiln_buffer_finish(&probe.results);
    kiln_capture_finish(&probe.capture);
    kiln_integer_textures_finish(&probe.inputs);
    kiln_integer_textures_finish(&probe.outputs);
    if (probe.program)
        glDeleteProgram(probe.program);
    return exact;
}

bool kiln_probe_exact(struct kiln_device *device, enum kiln_probe_stage stage, char reason[256],
                      struct kiln_error *error)
{
    return kiln_probe_vectors(device, stage, 4096, reason, error);
}
