/* Two passes over the particles, more where lists are long: places come from counts by a scan on
 * the host, and what arrives in any order leaves it sorted. */
#include "draw/fragments_gl.h"

#include "base/error.h"
#include "shared/fragment_layout.h"

#include <stdio.h>
#include <stdlib.h>

enum { FRAGMENTS_AT_A_TIME = 1 << 21, KEY_BYTES = 16, FRAGMENT_BYTES = 32 };

enum program { COUNT, FILL, RESOLVE, PROGRAM_COUNT };

struct kiln_fragments_gl {
    struct kiln_device *device;
    GLuint programs[PROGRAM_COUNT];
    GLint row_length[PROGRAM_COUNT];
    GLuint vertex_array;
    struct kiln_buffer counts, places; /* of each pixel; the places in its band of rows */
    struct kiln_buffer keys, fragments;
    uint32_t *ends; /* of the bands: rows */
    uint32_t end_room;
};

static bool create_programs(struct kiln_fragments_gl *f,
                            const struct kiln_program_params *particles, struct kiln_error *error)
{
    for (int i = 0; i < PROGRAM_COUNT; i++) {
        char defines[128];
        snprintf(defines, sizeof defines, "%s#define FILL %d\n",
                 particles->defines ? particles->defines : "", i == FILL ? 1 : 0);
        struct kiln_program_params params = *particles;
        params.defines = defines;
        params.fragment = "draw/particles_list.frag";
        if (i == RESOLVE)
            params = (struct kiln_program_params){.vertex = "draw/fullscreen.vert",
                                                  .fragment = "draw/fragments_resolve.frag"};
        f->programs[i] = kiln_program_create(f->device, &params, error);
        if (!f->programs[i])
            return false;
        f->row_length[i] = glGetUniformLocation(f->programs[i], "row_length");
    }
    return true;
}

struct kiln_fragments_gl *kiln_fragments_gl_create(struct kiln_device *device,
                                                   const struct kiln_program_params *particles,
                                                   struct kiln_error *error)
{
    struct kiln_fragments_gl *f = calloc(1, sizeof *f);
    if (!f) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "fragments: out of memory");
        return NULL;
    }
    f->device = device;
    kiln_buffer_init(&f->counts, device, 0, "fragment counts");
    kiln_buffer_init(&f->places, device, 0, "fragment places");
    kiln_buffer_init(&f->keys, device, 0, "fragment keys");
    kiln_buffer_init(&f->fragments, device, 0, "fragments");
    glGenVertexArrays(1, &f->vertex_array);
    if (!create_programs(f, particles, error))
        kiln_fragments_gl_destroy(&f);
    return f;
}

void kiln_fragments_gl_destroy(struct kiln_fragments_gl **fragments)
{
    struct kiln_fragments_gl *f = *fragments;
    if (!f)
        return;
    for (int i = 0; i < PROGRAM_COUNT; i++)
        glDeleteProgram(f->programs[i]); /* 0 is ignored */
    kiln_buffer_finish(&f->counts);
    kiln_buffer_finish(&f->places);
    kiln_buffer_finish(&f->keys);
    kiln_buffer_finish(&f->fragments);
    glDeleteVertexArrays(1, &f->vertex_array);
    free(f->ends);
    free(f);
    *fragments = NULL;
}

static bool bind_buffer(struct kiln_buffer *buffer, GLuint binding, enum kiln_access access,
                        struct kiln_error *error)
{
    GLuint gl = kiln_buffer_gl(buffer, access, error);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, gl);
    return gl != 0;
}

static void use_program(const struct kiln_fragments_gl *f, enum program program,
                        const struct kiln_image *size)
{
    glUseProgram(f->programs[program]);
    glUniform1ui(f->row_length[program], size->width);
}

/* The particles, into lists alone: a program without outputs leaves undefined what it could write.
 */
static void submit_to_lists(void (*submit)(void *context), void *context)
{
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    submit(context);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

static bool count(struct kiln_fragments_gl *f, const struct kiln_image *size,
                  void (*submit)(void *context), void *context, struct kiln_error *error)
{
    const size_t pixels = (size_t)size->width * size->height;
    kiln_buffer_reserve(&f->counts, pixels * sizeof(uint32_t));
    kiln_buffer_reserve(&f->places, pixels * sizeof(uint32_t));
    if (!bind_buffer(&f->counts, KILN_BIND_FRAGMENT_COUNTS, KILN_OVERWRITE, error))
        return false;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, f->counts.gl);
    glClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, NULL);
    use_program(f, COUNT, size);
    submit_to_lists(submit, context);
    return kiln_device_check(f->device, "fragments: count", error);
}

static bool make_room(struct kiln_fragments_gl *f, uint32_t rows, struct kiln_error *error)
{
    if (rows <= f->end_room)
        return true;
    free(f->ends);
    f->ends = malloc(rows * sizeof *f->ends);
    f->end_room = f->ends ? rows : 0;
    return f->ends ||
           kiln_error_set(error, KILN_DEVICE_FAILED, "fragments: out of memory for %u rows", rows);
}

static size_t row_total(const uint32_t *counts, uint32_t width)
{
    size_t total = 0;
    for (uint32_t x = 0; x < width; x++)
        total += counts[x];
    return total;
}

/* Divides the picture into bands of rows and gives each pixel its place in its band; returns how
 * many bands, and the most fragments of one. 0 with an error. */
static uint32_t scan(struct kiln_fragments_gl *f, const struct kiln_image *size, size_t *most,
                     struct kiln_error *error)
{
    const uint32_t *counts = kiln_buffer_host(&f->counts, KILN_READ, error);
    uint32_t *places = counts ? kiln_buffer_host(&f->places, KILN_OVERWRITE, error) : NULL;
    if (!places || !make_room(f, size->height, error))
        return 0;
    uint32_t bands = 0;
    size_t place = 0;
    *most = 1;
    for (uint32_t y = 0; y < size->height; y++) {
        const size_t first = (size_t)y * size->width;
        const size_t total = row_total(counts + first, size->width);
        if (place > 0 && place + total > FRAGMENTS_AT_A_TIME) {
            f->ends[bands++] = y;
            place = 0;
        }
        for (size_t i = first; i < first + size->width; i++) {
            places[i] = (uint32_t)place;
            place += counts[i];
        }
        *most = place > *most ? place : *most;
    }
    f->ends[bands++] = size->height;
    if (*most > UINT32_MAX) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "fragments: %zu in a row of pixels", *most);
        return 0;
    }
    return bands;
}

static bool draw_band(struct kiln_fragments_gl *f, const struct kiln_particles_draw *draw,
                      void (*submit)(void *context), void *context, struct kiln_error *error)
{
    const struct kiln_image *size = draw->framebuffer->images[0];
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    use_program(f, FILL, size);
    submit_to_lists(submit, context);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    use_program(f, RESOLVE, size);
    if (draw->keep_bloom) {
        glEnablei(GL_BLEND, 1);
        glBlendFunci(1, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    kiln_framebuffer_fill(f->vertex_array);
    glDisable(GL_BLEND);
    return kiln_device_check(f->device, "fragments", error);
}

bool kiln_fragments_gl_run(struct kiln_fragments_gl *fragments,
                           const struct kiln_particles_draw *draw, void (*submit)(void *context),
                           void *context, struct kiln_error *error)
{
    struct kiln_fragments_gl *f = fragments;
    const struct kiln_image *size = draw->framebuffer->images[0];
    size_t most = 0;
    uint32_t bands = count(f, size, submit, context, error) ? scan(f, size, &most, error) : 0;
    if (bands == 0)
        return false;
    kiln_buffer_reserve(&f->keys, most * KEY_BYTES);
    kiln_buffer_reserve(&f->fragments, most * FRAGMENT_BYTES);
    if (!bind_buffer(&f->counts, KILN_BIND_FRAGMENT_COUNTS, KILN_READ, error) ||
        !bind_buffer(&f->places, KILN_BIND_FRAGMENT_PLACES, KILN_READ_WRITE, error) ||
        !bind_buffer(&f->keys, KILN_BIND_FRAGMENT_KEYS, KILN_OVERWRITE, error) ||
        !bind_buffer(&f->fragments, KILN_BIND_FRAGMENTS, KILN_OVERWRITE, error))
        return false;
    glEnable(GL_SCISSOR_TEST);
    bool ok = true;
    for (uint32_t band = 0, y = 0; band < bands && ok; y = f->ends[band++]) {
        glScissor(0, (GLint)y, (GLsizei)size->width, (GLsizei)(f->ends[band] - y));
        ok = draw_band(f, draw, submit, context, error);
    }
    glDisable(GL_SCISSOR_TEST);
    return ok;
}
