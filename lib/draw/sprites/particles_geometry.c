/* Particles as points that the geometry shader turns into billboards, or as instances of a quad:
 * one draw call for the systems of a pass, whatever their looks; an entry names system and slot,
 * and the vertex shader fetches the rest (Heinz 2019, 3.2.2: one draw call, nothing stored but what
 * changes). */
#include "draw/sprites/particles_geometry.h"
#include "draw/light/lighting_gl.h"
#include "draw/light/sun_shade.h"
#include "draw/moment/looks.h"
#include "draw/sprites/fragments_gl.h"
#include "draw/sprites/occlusion.h"

#include "base/error.h"
#include "gpu/program.h"
#include "shared/look_layout.h"

#include <assert.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static_assert(offsetof(struct kiln_draw_look, flags) == 48, "std140");
static_assert(sizeof(struct kiln_draw_look) == 96 + 16 * KILN_MAX_TEXTURES, "std140");
static_assert(KILN_MAX_SYSTEMS * sizeof(struct kiln_draw_look) <= 16384, "of every GL");
struct kiln_geometry {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_atlas *atlas;
    enum kiln_raster_technique technique;
    GLuint program;                      /* 0: only binds what others draw */
    struct kiln_fragments_gl *fragments; /* of a scene whose pixels sort */
    struct kiln_occlusion *occlusion;
    GLuint vertex_array;
    struct kiln_buffer looks, keys;
    GLuint look_table; /* texture, KILN_LOOK_SAMPLES wide */
    float4 *table;     /* what is in it */
    bool table_valid;
    GLint additive_alpha;
};

static bool make_buffers(struct kiln_geometry *stage, struct kiln_error *error)
{
    const struct kiln_scene *scene = stage->scene;
    struct kiln_draw_look looks[KILN_MAX_SYSTEMS];
    kiln_looks_fill(scene, stage->atlas, looks);
    float4 keys[KILN_MAX_VALUE_KEYS] = {{0}};
    if (scene->key_count)
        memcpy(keys, scene->keys, scene->key_count * sizeof *keys);
    kiln_buffer_init(&stage->looks, stage->device, sizeof looks, "looks");
    kiln_buffer_init(&stage->keys, stage->device, sizeof keys, "value keys");
    return kiln_buffer_upload(&stage->looks, looks, error) &&
           kiln_buffer_upload(&stage->keys, keys, error);
}

static void make_look_table(struct kiln_geometry *stage)
{
    glGenTextures(1, &stage->look_table);
    glBindTexture(GL_TEXTURE_2D, stage->look_table);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, KILN_LOOK_SAMPLES,
                 KILN_LOOK_TEXELS / KILN_LOOK_SAMPLES, 0, GL_RGBA, GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    kiln_device_label(stage->device, GL_TEXTURE, stage->look_table, "look table");
}

/* Brings the table to a clip time. */
static void update_looks(struct kiln_geometry *stage, float time_s)
{
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, stage->look_table);
    if (stage->table_valid && !kiln_looks_vary(stage->scene))
        return;
    kiln_looks_sample(stage->scene, time_s, stage->table);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, KILN_LOOK_SAMPLES, KILN_LOOK_TEXELS / KILN_LOOK_SAMPLES,
                    GL_RGBA, GL_FLOAT, stage->table);
    stage->table_valid = true;
}

/* Does any system need more than billboards parallel to the picture? One program draws all that is
 * sorted together, in one call, however the depths of the shapes interleave; the one that knows all
 * shapes is slower, so only scenes that need it pay. */
static bool needs_shapes(const struct kiln_scene *scene)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        bool plane = look->facing == KILN_FACING_SCREEN || look->facing == KILN_FACING_VELOCITY;
        bool billboard = look->shape == KILN_SHAPE_BILLBOARD;
        if (scene->systems[i].enabled && !kiln_look_is_opaque(look) && !(billboard && plane))
            return true;
    }
    return false;
}

void kiln_geometry_defines(const struct kiln_scene *scene, char *out, size_t size)
{
    snprintf(out, size, "#define SHAPES %d\n%s", needs_shapes(scene) ? 1 : 0,
             kiln_sun_shade_exists(scene) ? "#define SUN_SHADE 1\n" : "");
}

static bool create_program(struct kiln_geometry *stage, struct kiln_error *error)
{
    char defines[64];
    kiln_geometry_defines(stage->scene, defines, sizeof defines);
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
    stage->fragments = kiln_fragments_gl_create(stage->device, &program, error);
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
        kiln_error_set(error, KILN_DEVICE_FAILED, "particles: out of memory");
        return NULL;
    }
    *stage = (struct kiln_geometry){
        .device = device, .scene = scene, .atlas = atlas, .technique = technique};
    stage->table = calloc((size_t)KILN_LOOK_TEXELS, sizeof *stage->table);
    if (!stage->table) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "particles: out of memory");
        kiln_geometry_destroy(&stage);
        return NULL;
    }
    /* `tiled` leaves lists of fragments to it. */
    bool draws = technique == KILN_RASTER_GEOMETRY || technique == KILN_RASTER_INSTANCED ||
                 (technique == KILN_RASTER_TILED && scene->post.compose == KILN_COMPOSE_OIT);
    if (draws && !create_program(stage, error)) {
        kiln_geometry_destroy(&stage);
        return NULL;
    }
    glGenVertexArrays(1, &stage->vertex_array);
    make_look_table(stage);
    if (!make_buffers(stage, error) || !kiln_device_check(device, "particles set-up", error))
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
    kiln_buffer_finish(&s->looks);
    kiln_buffer_finish(&s->keys);
    glDeleteTextures(1, &s->look_table);
    free(s->table);
    free(s);
    *stage = NULL;
}

static void bind_texture(GLuint unit, GLenum target, GLuint texture)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target, texture);
}

bool kiln_geometry_bind(struct kiln_geometry *stage, struct kiln_pool *pool,
                        struct kiln_buffer *entries, float time_s, struct kiln_error *error)
{
    GLuint records = kiln_buffer_gl(&pool->records, KILN_READ, error);
    GLuint order = records ? kiln_buffer_gl(entries, KILN_READ, error) : 0;
    GLuint looks = order ? kiln_buffer_gl(&stage->looks, KILN_READ, error) : 0;
    GLuint keys = looks ? kiln_buffer_gl(&stage->keys, KILN_READ, error) : 0;
    if (!keys)
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, KILN_BIND_RECORDS, records);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, KILN_BIND_ENTRIES, order);
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_LOOKS, looks);
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_KEYS, keys);
    update_looks(stage, time_s);
    return true;
}

bool kiln_geometry_bind_draw(struct kiln_geometry *stage, const struct kiln_particles_draw *draw,
                             struct kiln_error *error)
{
    GLuint depth = kiln_image_gl(draw->depth, KILN_READ, error);
    if (!depth || !kiln_lighting_bind(draw->lighting, error) ||
        !kiln_geometry_bind(stage, draw->pool, draw->entries, draw->view->clock.x, error))
        return false;
    bind_texture(1, GL_TEXTURE_2D_ARRAY, stage->atlas->texture);
    bind_texture(2, GL_TEXTURE_2D, depth);
    bind_texture(3, GL_TEXTURE_2D_ARRAY, stage->atlas->motion);
    return true;
}

/* A draw call of a technique. */
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

/* Draws what is not hidden into the bound framebuffer. */
static bool draw_visible(struct kiln_geometry *stage, const struct kiln_particles_draw *draw,
                         struct kiln_error *error)
{
    struct submission submission = {stage, (GLsizei)draw->count};
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
