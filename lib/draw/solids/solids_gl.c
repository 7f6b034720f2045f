/* This file draws solid spheres in GL as impostors: the geometry shader finds the rectangle that a
 * sphere covers, and the fragment shader casts a ray at it. Each pixel has four samples with a
 * depth test of their own, so spheres need no order and silhouettes are smooth. A second pass
 * blends the mean of the samples over the backdrop, into images of its own: the backdrop's picture
 * is kept from frame to frame and must not change. */
#include "draw/solids/solids_gl.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/error.h"
#include "draw/moment/moment_gl.h"
#include "draw/solids/instances_gl.h"
#include "gpu/framebuffer.h"
#include "gpu/program.h"

enum { SAMPLES = 4 }; /* every OpenGL 4.3 has 4; the shaders assume 4 */

struct kiln_solids_gl {
    struct kiln_device *device;
    struct kiln_solids_targets targets;
    GLuint cast, resolve;             /* programs; cast: 0: no particle is a sphere */
    struct kiln_instances_gl *meshes; /* NULL: no particle is a mesh */
    GLuint samples[3];                /* multisampled textures: colour, bloom, depth */
    GLuint framebuffer;               /* the framebuffer of `samples` */
    struct kiln_framebuffer scene;    /* the images that the stage writes */
    GLuint vertex_array;
};

static bool has_spheres(const struct kiln_scene *scene)
{
    bool found = false;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        found |= system->enabled && system->look.shape == KILN_SHAPE_SPHERE;
    }
    return found;
}

static bool create_programs(struct kiln_solids_gl *stage, const struct kiln_scene *scene,
                            struct kiln_error *error)
{
    const struct kiln_shape_features features = kiln_shape_features(scene);
    const struct kiln_program_params cast = {.vertex = "draw/solids/solids_spheres.vert",
                                             .geometry = "draw/solids/solids_spheres.geom",
                                             .fragment = "draw/solids/solids_spheres.frag"};
    const struct kiln_program_params resolve = {.vertex = "gpu/framebuffer_fill.vert",
                                                .fragment = "draw/solids/solids_resolve.frag"};
    if (has_spheres(scene)) {
        struct kiln_text defines = {0};
        kiln_shape_defines(&features, &defines);
        kiln_text_add(&defines, "%s%s", kiln_looks_patterned(scene) ? "#define PATTERN 1\n" : "",
                      kiln_scene_spins(scene) ? "#define SPINS 1\n" : "");
        kiln_moment_gl_defines(scene, &defines);
        stage->cast = kiln_program_create_defined(stage->device, &cast, &defines, error);
        if (!stage->cast)
            return false;
    }
    stage->resolve = kiln_program_create(stage->device, &resolve, error);
    return stage->resolve != 0;
}

/* Makes the multisampled targets. Colours are stored in 16 bits, since four samples need much
 * memory; nothing is blended in them, so rounding errors do not add up. */
static bool create_samples(struct kiln_solids_gl *stage, struct kiln_error *error)
{
    static const GLenum formats[3] = {GL_RGBA16F, GL_RGBA16F, GL_DEPTH_COMPONENT32F};
    static const GLenum points[3] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                     GL_DEPTH_ATTACHMENT};
    static const char *const labels[3] = {"solid samples", "solid bloom samples",
                                          "solid depth samples"};
    const struct kiln_image *size = stage->targets.color;
    glGenTextures(3, stage->samples);
    glGenFramebuffers(1, &stage->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, stage->framebuffer);
    for (size_t i = 0; i < 3; i++) {
        glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, stage->samples[i]);
        glTexStorage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, SAMPLES, formats[i],
                                  (GLsizei)size->width, (GLsizei)size->height, GL_TRUE);
        glFramebufferTexture2D(GL_FRAMEBUFFER, points[i], GL_TEXTURE_2D_MULTISAMPLE,
                               stage->samples[i], 0);
        kiln_device_label(stage->device, GL_TEXTURE, stage->samples[i], labels[i]);
    }
    glDrawBuffers(2, points);
    if (!kiln_device_check(stage->device, "samples of solids", error))
        return false;
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "%s: framebuffer of solids is incomplete (0x%04x)",
                              stage->device->info.name, status);
    return true;
}

struct kiln_solids_gl *kiln_solids_gl_create(struct kiln_device *device,
                                             const struct kiln_moment *moment,
                                             const struct kiln_solids_params *params,
                                             struct kiln_error *error)
{
    struct kiln_solids_gl *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the solids");
        return NULL;
    }
    const struct kiln_solids_targets *targets = &params->targets;
    *stage = (struct kiln_solids_gl){.device = device, .targets = *targets};
    struct kiln_image *written[] = {targets->color, targets->depth, targets->bloom};
    glGenVertexArrays(1, &stage->vertex_array);
    bool ok = create_programs(stage, moment->scene, error) && create_samples(stage, error);
    if (ok && moment->instances.corners) {
        stage->meshes = kiln_instances_gl_create(device, moment, error);
        ok = stage->meshes != NULL;
    }
    if (!ok || !kiln_framebuffer_init(&stage->scene, device, written, 3, error))
        kiln_solids_gl_destroy(&stage);
    return stage;
}

void kiln_solids_gl_destroy(struct kiln_solids_gl **stage)
{
    struct kiln_solids_gl *s = *stage;
    if (!s)
        return;
    kiln_instances_gl_destroy(&s->meshes);
    glDeleteProgram(s->cast); /* 0 is ignored */
    glDeleteProgram(s->resolve);
    glDeleteFramebuffers(1, &s->framebuffer);
    glDeleteTextures(3, s->samples);
    kiln_framebuffer_finish(&s->scene);
    glDeleteVertexArrays(1, &s->vertex_array);
    free(s);
    *stage = NULL;
}

static void bind_texture(GLuint unit, GLenum target, GLuint texture)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target, texture);
}

static bool cast(struct kiln_solids_gl *stage, uint32_t count, struct kiln_error *error)
{
    const struct kiln_image *size = stage->targets.color;
    static const GLfloat transparent[4] = {0}, farthest = 0.0f;
    glBindFramebuffer(GL_FRAMEBUFFER, stage->framebuffer);
    glViewport(0, 0, (GLsizei)size->width, (GLsizei)size->height);
    glClearBufferfv(GL_COLOR, 0, transparent);
    glClearBufferfv(GL_COLOR, 1, transparent);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glBindVertexArray(stage->vertex_array);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    if (stage->cast) {
        glUseProgram(stage->cast);
        glDrawArrays(GL_POINTS, 0, (GLsizei)count);
    }
    bool ok = !stage->meshes || kiln_instances_gl_draw(stage->meshes, count, error);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
    return ok;
}

bool kiln_solids_gl_draw(struct kiln_solids_gl *stage, const struct kiln_moment *moment,
                         struct kiln_buffer *entries, uint32_t count, struct kiln_error *error)
{
    GLuint depth = kiln_image_gl(stage->targets.backdrop_depth, KILN_READ, error);
    GLuint color = depth ? kiln_image_gl(stage->targets.backdrop_color, KILN_READ, error) : 0;
    if (!color || !kiln_moment_bind(moment, entries, error))
        return false;
    struct kiln_pool *pool = moment->pool;
    if (pool->spins.size > 0) {
        GLuint spins = kiln_buffer_gl(&pool->spins, KILN_READ, error);
        if (!spins)
            return false;
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, KILN_BIND_SPINS, spins);
    }
    bind_texture(KILN_UNIT_SCENE_DEPTH, GL_TEXTURE_2D, depth);
    if (!cast(stage, count, error))
        return false;

    if (!kiln_framebuffer_bind(&stage->scene, error))
        return false;
    for (GLuint i = 0; i < 3; i++)
        bind_texture(i, GL_TEXTURE_2D_MULTISAMPLE, stage->samples[i]);
    bind_texture(3, GL_TEXTURE_2D, color);
    bind_texture(4, GL_TEXTURE_2D, depth);
    glUseProgram(stage->resolve);
    kiln_framebuffer_fill(stage->vertex_array);
    return kiln_device_check(stage->device, "solids", error);
}
