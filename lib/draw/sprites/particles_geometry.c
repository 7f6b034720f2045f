/* This file draws particles in GL as points that the geometry shader turns into billboards, or as
 * instances of a quad. One draw call draws all systems of a pass, whatever their looks; an entry
 * names system and slot, and the vertex shader fetches the record and computes all else (Heinz
 * 2019, 3.2.2). */
#include "draw/sprites/particles_geometry.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/error.h"
#include "draw/light/lighting_gl.h"
#include "draw/light/sun_shade.h"
#include "draw/moment/moment_gl.h"
#include "draw/sprites/fragments_gl.h"
#include "draw/sprites/gas_before.h"
#include "draw/sprites/occlusion.h"
#include "gpu/program.h"
#include "scene/ribbon.h"

struct kiln_geometry {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_atlas *atlas;
    enum kiln_raster_technique technique;
    GLuint program; /* 0: the stage draws nothing, and only binds data for technique `tiled` */
    struct kiln_fragments_gl *fragments; /* NULL unless post.compose is oit */
    struct kiln_occlusion *occlusion;
    GLuint vertex_array;
    GLint additive_alpha;
};

/* Returns whether any system needs other shapes than billboards parallel to the picture. One
 * program must draw all particles, in one call, since particles of different shapes may interleave
 * in depth. The program for all shapes is slower, so only scenes that need it use it. */
static bool needs_shapes(const struct kiln_scene *scene)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        const enum kiln_facing facing = look->facing.way;
        bool plane = facing == KILN_FACING_SCREEN || facing == KILN_FACING_VELOCITY;
        bool billboard = look->shape == KILN_SHAPE_BILLBOARD;
        if (scene->systems[i].enabled && !kiln_look_is_opaque(look) && !(billboard && plane))
            return true;
    }
    return false;
}

void kiln_geometry_defines(const struct kiln_scene *scene, struct kiln_text *defines)
{
    kiln_text_add(defines, "#define SHAPES %d\n%s%s%s%s%s%s", needs_shapes(scene) ? 1 : 0,
                  kiln_sun_shade_exists(scene) ? "#define SUN_SHADE 1\n" : "",
                  kiln_lamp_shade_exists(scene) ? "#define LAMP_SHADE 1\n" : "",
                  kiln_scene_has_haze(scene) ? "#define HAZE 1\n" : "",
                  kiln_scene_has_smoke(scene) ? "" : "#define NO_SMOKE 1\n",
                  kiln_scene_has_lamps(scene) ? "" : "#define NO_LAMPS 1\n",
                  kiln_gas_before_defines(scene));
    if (kiln_ribbon_most_parts(scene) > 0)
        kiln_text_add(defines, "#define RIBBONS %u\n", kiln_ribbon_most_parts(scene));
    kiln_moment_gl_defines(scene, defines);
}

static bool create_program(struct kiln_geometry *stage, const char *defines,
                           struct kiln_error *error)
{
    bool instanced = stage->technique == KILN_RASTER_INSTANCED;
    const struct kiln_program_params program = {
        .vertex = instanced ? "draw/sprites/particles_instanced.vert"
                            : "draw/sprites/particles_geometry.vert",
        .geometry = instanced ? NULL : "draw/sprites/particles_geometry.geom",
        .fragment = "draw/sprites/particles.frag",
        .defines = defines};
    stage->program = kiln_program_create(stage->device, &program, error);
    if (!stage->program)
        return false;
    stage->additive_alpha = glGetUniformLocation(stage->program, "additive_alpha");
    stage->occlusion = kiln_occlusion_create(stage->device, error);
    if (!stage->occlusion)
        return false;
    if (stage->scene->post.compose != KILN_COMPOSE_OIT)
        return true;
    stage->fragments = kiln_fragments_gl_create(stage->device, &program, stage->scene, error);
    return stage->fragments != NULL;
}

struct kiln_geometry *kiln_geometry_create(struct kiln_device *device,
                                           const struct kiln_scene *scene,
                                           const struct kiln_atlas *atlas,
                                           enum kiln_raster_technique technique,
                                           struct kiln_error *error)
{
    struct kiln_geometry *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "particles");
        return NULL;
    }
    *stage = (struct kiln_geometry){
        .device = device, .scene = scene, .atlas = atlas, .technique = technique};
    /* Technique `tiled` draws by this stage for post.compose: oit. */
    bool draws = technique == KILN_RASTER_GEOMETRY || technique == KILN_RASTER_INSTANCED ||
                 (technique == KILN_RASTER_TILED && scene->post.compose == KILN_COMPOSE_OIT);
    struct kiln_text defines = {0};
    kiln_geometry_defines(scene, &defines);
    bool ok = !defines.failed || kiln_error_no_memory(error, "particles");
    ok = ok && (!draws || create_program(stage, defines.data, error));
    kiln_text_free(&defines);
    if (!ok) {
        kiln_geometry_destroy(&stage);
        return NULL;
    }
    glGenVertexArrays(1, &stage->vertex_array);
    if (!kiln_device_check(device, "particles set-up", error))
        kiln_geometry_destroy(&stage);
    return stage;
}

void kiln_geometry_destroy(struct kiln_geometry **stage)
{
    struct kiln_geometry *s = *stage;
    if (!s)
        return;
    if (s->program)
        glDeleteProgram(s->program);
    kiln_fragments_gl_destroy(&s->fragments);
    kiln_occlusion_destroy(&s->occlusion);
    glDeleteVertexArrays(1, &s->vertex_array);
    free(s);
    *stage = NULL;
}

uint32_t kiln_geometry_items(const struct kiln_geometry *stage)
{
    const uint32_t parts = kiln_ribbon_most_parts(stage->scene);
    return parts > 0 ? parts : 1;
}

static void bind_texture(GLuint unit, GLenum target, GLuint texture)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target, texture);
}

bool kiln_geometry_bind_draw(struct kiln_geometry *stage, const struct kiln_particles_draw *draw,
                             struct kiln_error *error)
{
    GLuint depth = kiln_image_gl(draw->depth, KILN_READ, error);
    if (!depth || !kiln_lighting_bind(draw->lighting, error) ||
        !kiln_moment_bind(draw->moment, draw->entries, error))
        return false;
    bind_texture(KILN_UNIT_ATLAS, GL_TEXTURE_2D_ARRAY, stage->atlas->texture);
    bind_texture(KILN_UNIT_SCENE_DEPTH, GL_TEXTURE_2D, depth);
    bind_texture(KILN_UNIT_ATLAS_MOTION, GL_TEXTURE_2D_ARRAY, stage->atlas->motion);
    bind_texture(KILN_UNIT_STRIPS, GL_TEXTURE_2D_ARRAY, stage->atlas->strips);
    return true;
}

/* Describes the draw call of a pass, for `submit`. */
struct submission {
    const struct kiln_geometry *stage;
    GLsizei count;
};

static void submit(void *context)
{
    const struct submission *s = context;
    glBindVertexArray(s->stage->vertex_array);
    if (s->stage->technique == KILN_RASTER_INSTANCED)
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, s->count);
    else
        glDrawArrays(GL_POINTS, 0, s->count);
}

/* Draws the particles into the bound framebuffer; bindings and occlusion are in place. */
static bool draw_visible(struct kiln_geometry *stage, const struct kiln_particles_draw *draw,
                         struct kiln_error *error)
{
    struct submission submission = {stage, (GLsizei)(draw->count * kiln_geometry_items(stage))};
    if (draw->by_fragment)
        return kiln_fragments_gl_run(stage->fragments, draw, submit, &submission, error);
    glUseProgram(stage->program);
    glUniform1f(stage->additive_alpha, draw->sum_alpha || draw->fire_covers ? 1.0f : 0.0f);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, draw->sum_alpha ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
    submit(&submission);
    glDisable(GL_BLEND);
    return kiln_device_check(stage->device, "particles", error);
}

bool kiln_geometry_run(struct kiln_geometry *stage, const struct kiln_particles_draw *draw,
                       struct kiln_error *error)
{
    if (!kiln_framebuffer_bind(draw->framebuffer, error))
        return false;
    static const GLfloat transparent[4] = {0};
    glClearBufferfv(GL_COLOR, 0, transparent);
    if (!draw->keep_bloom)
        glClearBufferfv(GL_COLOR, 1, transparent);
    if (draw->count == 0)
        return kiln_device_check(stage->device, "particles", error);

    if (!kiln_geometry_bind_draw(stage, draw, error) ||
        !kiln_occlusion_begin(stage->occlusion, draw, error))
        return false;
    bool ok = draw_visible(stage, draw, error);
    kiln_occlusion_end(stage->occlusion);
    return ok;
}
