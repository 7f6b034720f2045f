/* Adds up the accelerations of bodies by blending in GL. Each texel of the force texture belongs to
 * a body. For each source a quad covers all texels; its fragments compute the accelerations of the
 * bodies by the source, and blending adds them up (Drone 2007, figure 3). The paper adds up forces
 * and divides by the mass when it moves a body; here accelerations are added up, since bodies may
 * have no mass. */
#include "bench/papers/force_splat.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "bench/papers/papers.h"
#include "gpu/image.h"
#include "gpu/program.h"
#include "shared/papers/bench_layout.h"

enum { ROW = 128 }; /* texels in a row of the textures */

struct kiln_force_splat {
    struct kiln_device *device;
    struct kiln_image bodies, forces;
    struct kiln_framebuffer framebuffer;
    GLuint program, vertex_array;
};

struct kiln_force_splat *kiln_force_splat_create(struct kiln_device *device, GLenum format,
                                                 uint32_t most, struct kiln_error *error)
{
    struct kiln_force_splat *splat = calloc(1, sizeof *splat);
    if (!splat) {
        kiln_error_no_memory(error, "the splats of forces");
        return NULL;
    }
    const uint32_t rows = (most + ROW - 1) / ROW;
    struct kiln_image *const targets[] = {&splat->forces};
    splat->device = device;
    kiln_image_init(&splat->bodies, device, ROW, rows, GL_RGBA32F, "bodies");
    kiln_image_init(&splat->forces, device, ROW, rows, format, "forces");
    glGenVertexArrays(1, &splat->vertex_array);
    splat->program = kiln_program_create(
        device,
        &(struct kiln_program_params){.vertex = "bench/papers/force_splat.vert",
                                      .fragment = "bench/papers/force_splat.frag"},
        error);
    if (!splat->program || !kiln_framebuffer_init(&splat->framebuffer, device, targets, 1, error))
        kiln_force_splat_destroy(&splat);
    return splat;
}

void kiln_force_splat_destroy(struct kiln_force_splat **splat)
{
    struct kiln_force_splat *s = *splat;
    if (!s)
        return;
    kiln_framebuffer_finish(&s->framebuffer);
    kiln_image_finish(&s->bodies);
    kiln_image_finish(&s->forces);
    if (s->program)
        glDeleteProgram(s->program);
    glDeleteVertexArrays(1, &s->vertex_array);
    free(s);
    *splat = NULL;
}

bool kiln_force_splat_run(struct kiln_force_splat *splat, const float4 *sources, uint32_t count,
                          float softening_square, double *ms, struct kiln_error *error)
{
    float *texels = kiln_image_host(&splat->bodies, KILN_OVERWRITE, error);
    if (!texels)
        return false;
    memset(texels, 0, (size_t)ROW * splat->bodies.height * sizeof *sources);
    memcpy(texels, sources, count * sizeof *sources);
    const GLuint bodies = kiln_image_gl(&splat->bodies, KILN_READ, error);
    if (!bodies || !kiln_framebuffer_bind(&splat->framebuffer, error))
        return false;
    glFinish();
    const double before_s = kiln_clock_seconds();
    glClearBufferfv(GL_COLOR, 0, (const GLfloat[4]){0.0f, 0.0f, 0.0f, 0.0f});
    glUseProgram(splat->program);
    glUniform1ui(SPLAT_AT_ROW, ROW);
    glUniform1f(SPLAT_AT_SOFTENING, softening_square);
    glBindTexture(GL_TEXTURE_2D, bodies);
    glBindVertexArray(splat->vertex_array);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)count);
    glDisable(GL_BLEND);
    glBindVertexArray(0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glFinish();
    *ms = 1e3 * (kiln_clock_seconds() - before_s);
    return kiln_device_check(splat->device, "force splatting", error);
}

const float4 *kiln_force_splat_sums(struct kiln_force_splat *splat, struct kiln_error *error)
{
    return (const float4 *)kiln_image_host(&splat->forces, KILN_READ, error);
}

static void *create_32(struct kiln_device *device, uint32_t most, struct kiln_error *error)
{
    return kiln_force_splat_create(device, GL_RGBA32F, most, error);
}

static void *create_16(struct kiln_device *device, uint32_t most, struct kiln_error *error)
{
    return kiln_force_splat_create(device, GL_RGBA16F, most, error);
}

static void destroy(void *way)
{
    struct kiln_force_splat *splat = way;
    kiln_force_splat_destroy(&splat);
}

static bool run(void *way, const float4 *sources, uint32_t count, float softening_square,
                double *ms, struct kiln_error *error)
{
    return kiln_force_splat_run(way, sources, count, softening_square, ms, error);
}

/* With more bodies than these, llvmpipe would blend for seconds in each turn. */
enum { MOST_IN_SOFTWARE = 4096 };

const struct kiln_gravity_row kiln_gravity_splats_32_row = {"splats, RGBA32F", MOST_IN_SOFTWARE,
                                                            create_32, destroy, run};
const struct kiln_gravity_row kiln_gravity_splats_16_row = {"splats, RGBA16F", MOST_IN_SOFTWARE,
                                                            create_16, destroy, run};
