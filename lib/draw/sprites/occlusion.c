/* This file fills a depth buffer with the depth of the scene, so that fragments of hidden particles
 * are rejected before they are shaded. The depth test rejects a fragment only if it is farther than
 * the scene by more than the rounding error, so that pictures stay the same to the bit. The
 * fragment shader discards the other hidden fragments. */
#include "draw/sprites/occlusion.h"

#include <stdlib.h>

#include "base/error.h"
#include "gpu/program.h"

/* On software GL a depth test costs a few hundredths of the time to shade a fragment, and saves
 * four fifths of that time for a hidden one. So it is used only if at least 1 / MIN_HIDDEN_DIVISOR
 * of the sampled particles is hidden. On GPUs it costs nothing. SAMPLES: particles that are
 * sampled, about. */
enum { SAMPLES = 1024, MIN_HIDDEN_DIVISOR = 8 };

struct kiln_occlusion {
    struct kiln_device *device;
    GLuint fill_program, sample_program, vertex_array;
    GLuint buffer; /* renderbuffer, at least as large as any picture so far */
    uint32_t width, height;
    struct kiln_buffer hidden; /* one number: how many sampled particles are hidden */
    bool is_enabled;           /* true: the depth test is used in this pass */
};

static bool create_programs(struct kiln_occlusion *o, struct kiln_error *error)
{
    const struct kiln_program_params fill = {.vertex = "gpu/framebuffer_fill.vert",
                                             .fragment = "draw/sprites/occlusion.frag"};
    const struct kiln_program_params sample = {.compute = "draw/sprites/occlusion_sample.comp"};
    o->fill_program = kiln_program_create(o->device, &fill, error);
    if (!o->fill_program)
        return false;
    o->sample_program = kiln_program_create(o->device, &sample, error);
    return o->sample_program != 0;
}

struct kiln_occlusion *kiln_occlusion_create(struct kiln_device *device, struct kiln_error *error)
{
    struct kiln_occlusion *occlusion = calloc(1, sizeof *occlusion);
    if (!occlusion) {
        kiln_error_no_memory(error, "particles");
        return NULL;
    }
    occlusion->device = device;
    kiln_buffer_init(&occlusion->hidden, device, sizeof(uint32_t), "hidden particles");
    glGenVertexArrays(1, &occlusion->vertex_array);
    glGenRenderbuffers(1, &occlusion->buffer);
    if (!create_programs(occlusion, error))
        kiln_occlusion_destroy(&occlusion);
    return occlusion;
}

void kiln_occlusion_destroy(struct kiln_occlusion **occlusion)
{
    struct kiln_occlusion *o = *occlusion;
    if (!o)
        return;
    glDeleteProgram(o->fill_program); /* 0 is ignored */
    glDeleteProgram(o->sample_program);
    glDeleteVertexArrays(1, &o->vertex_array);
    glDeleteRenderbuffers(1, &o->buffer);
    kiln_buffer_finish(&o->hidden);
    free(o);
    *occlusion = NULL;
}

/* Decides whether the depth test is worth its cost in this pass: sets `is_enabled`. */
static bool sample(struct kiln_occlusion *o, uint32_t count, struct kiln_error *error)
{
    o->is_enabled = true;
    if (!o->device->info.software)
        return true;
    const uint32_t spacing = (count - 1) / SAMPLES + 1, samples = (count - 1) / spacing + 1;
    uint32_t *hidden = kiln_buffer_host(&o->hidden, KILN_OVERWRITE, error);
    if (!hidden)
        return false;
    *hidden = 0;
    GLuint gl = kiln_buffer_gl(&o->hidden, KILN_READ_WRITE, error);
    if (!gl)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, OCCLUSION_BIND_HIDDEN, gl);
    glUseProgram(o->sample_program);
    glUniform1ui(OCCLUSION_AT_COUNT, count);
    glUniform1ui(OCCLUSION_AT_SPACING, spacing);
    kiln_device_dispatch(o->device, samples, 64);
    hidden = kiln_buffer_host(&o->hidden, KILN_READ, error);
    o->is_enabled = hidden && *hidden >= samples / MIN_HIDDEN_DIVISOR;
    return hidden != NULL;
}

static bool make_room(struct kiln_occlusion *o, const struct kiln_image *depth,
                      struct kiln_error *error)
{
    glBindRenderbuffer(GL_RENDERBUFFER, o->buffer);
    if (depth->width <= o->width && depth->height <= o->height)
        return true;
    o->width = depth->width > o->width ? depth->width : o->width;
    o->height = depth->height > o->height ? depth->height : o->height;
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, (GLsizei)o->width,
                          (GLsizei)o->height);
    return kiln_device_check(o->device, "depth of the scene", error);
}

bool kiln_occlusion_begin(struct kiln_occlusion *occlusion, const struct kiln_particles_draw *draw,
                          struct kiln_error *error)
{
    if (!sample(occlusion, draw->count, error))
        return false;
    if (!occlusion->is_enabled)
        return true;
    if (!make_room(occlusion, draw->depth, error))
        return false;
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                              occlusion->buffer);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glUseProgram(occlusion->fill_program);
    kiln_framebuffer_fill(occlusion->vertex_array);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    return kiln_device_check(occlusion->device, "depth of the scene", error);
}

void kiln_occlusion_end(struct kiln_occlusion *occlusion)
{
    if (!occlusion->is_enabled)
        return;
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, 0);
}
