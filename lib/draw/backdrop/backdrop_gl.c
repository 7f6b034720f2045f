/* This file draws the backdrop in GL: it uploads uniform blocks, draws the meshes, then runs a
 * full-screen pass and a second pass over the tiles that contain edges. */
#include "draw/backdrop/backdrop_gl.h"

#include <stdlib.h>

#include "asset/image/texture.h"
#include "base/error.h"
#include "draw/backdrop/meshes_gl.h"
#include "draw/moment/draw_blocks.h"
#include "gpu/framebuffer.h"
#include "gpu/program.h"

struct kiln_backdrop_gl {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    struct kiln_image *color, *depth;
    struct kiln_image surfaces; /* the surface at each pixel's centre */
    GLuint cast, antialias;     /* programs */
    struct kiln_framebuffer cast_framebuffer, color_framebuffer;
    GLuint vertex_array;
    struct kiln_draw_blocks blocks;
    struct kiln_buffer shapes_buffer;
    struct kiln_meshes_gl *meshes;
    struct kiln_texture floor_image, sky_image;
};

static bool create_programs(struct kiln_backdrop_gl *stage, struct kiln_error *error)
{
    const struct kiln_shape_features features = kiln_shape_features(stage->scene);
    char defines[KILN_SHAPE_DEFINES];
    struct kiln_program_params params = {.vertex = "gpu/framebuffer_fill.vert",
                                         .fragment = "draw/backdrop/backdrop.frag",
                                         .defines = defines};
    kiln_shape_defines(&features, 1, defines);
    stage->cast = kiln_program_create(stage->device, &params, error);
    if (!stage->cast)
        return false;
    params.vertex = "draw/backdrop/backdrop_edges.vert";
    kiln_shape_defines(&features, KILN_EDGE_SAMPLES, defines);
    stage->antialias = kiln_program_create(stage->device, &params, error);
    return stage->antialias != 0;
}

static bool load_pictures(struct kiln_backdrop_gl *stage, struct kiln_error *error)
{
    const struct kiln_backdrop *backdrop = &stage->scene->backdrop;
    if (backdrop->floor_image &&
        !kiln_texture_init(&stage->floor_image, stage->device, stage->scene->loader,
                           backdrop->floor_image, GL_REPEAT, error))
        return false;
    return !backdrop->sky_image ||
           kiln_texture_init(&stage->sky_image, stage->device, stage->scene->loader,
                             backdrop->sky_image, GL_CLAMP_TO_EDGE, error);
}

static bool create_targets(struct kiln_backdrop_gl *stage, struct kiln_error *error)
{
    kiln_image_init(&stage->surfaces, stage->device, stage->color->width, stage->color->height,
                    GL_R32F, "backdrop surfaces");
    struct kiln_image *targets[] = {stage->color, stage->depth, &stage->surfaces};
    return kiln_framebuffer_init(&stage->cast_framebuffer, stage->device, targets, 3, error) &&
           kiln_framebuffer_init(&stage->color_framebuffer, stage->device, targets, 1, error);
}

struct kiln_backdrop_gl *kiln_backdrop_gl_create(struct kiln_device *device,
                                                 const struct kiln_scene *scene,
                                                 const struct kiln_meshes *meshes,
                                                 const struct kiln_backdrop_params *params,
                                                 struct kiln_error *error)
{
    struct kiln_backdrop_gl *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the backdrop");
        return NULL;
    }
    stage->device = device;
    stage->scene = scene;
    stage->color = params->color;
    stage->depth = params->depth;
    stage->meshes = kiln_meshes_gl_create(device, scene, meshes, error);
    if (!stage->meshes || !create_programs(stage, error) || !create_targets(stage, error) ||
        !load_pictures(stage, error)) {
        kiln_backdrop_gl_destroy(&stage);
        return NULL;
    }
    glGenVertexArrays(1, &stage->vertex_array);
    kiln_draw_blocks_init(&stage->blocks, device);
    kiln_buffer_init(&stage->shapes_buffer, device, sizeof(struct kiln_draw_shapes), "shapes");
    return stage;
}

void kiln_backdrop_gl_destroy(struct kiln_backdrop_gl **gl)
{
    struct kiln_backdrop_gl *s = *gl;
    if (!s)
        return;
    glDeleteProgram(s->cast); /* 0 is ignored */
    glDeleteProgram(s->antialias);
    kiln_framebuffer_finish(&s->cast_framebuffer);
    kiln_framebuffer_finish(&s->color_framebuffer);
    kiln_image_finish(&s->surfaces);
    glDeleteVertexArrays(1, &s->vertex_array);
    kiln_draw_blocks_finish(&s->blocks);
    kiln_buffer_finish(&s->shapes_buffer);
    kiln_meshes_gl_destroy(&s->meshes);
    kiln_texture_finish(&s->floor_image);
    kiln_texture_finish(&s->sky_image);
    free(s);
    *gl = NULL;
}

void kiln_backdrop_gl_pictures(const struct kiln_backdrop_gl *gl, struct kiln_picture_size *floor,
                               struct kiln_picture_size *sky)
{
    *floor = (struct kiln_picture_size){gl->floor_image.width, gl->floor_image.height};
    *sky = (struct kiln_picture_size){gl->sky_image.width, gl->sky_image.height};
}

static void bind_picture(GLenum unit, const struct kiln_texture *texture)
{
    if (!texture->gl)
        return;
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture->gl);
    glActiveTexture(GL_TEXTURE0);
}

static bool cast(struct kiln_backdrop_gl *stage, const struct kiln_draw_shapes *shapes,
                 struct kiln_error *error)
{
    if (!kiln_meshes_gl_draw(stage->meshes, shapes, error))
        return false;
    bind_picture(KILN_UNIT_FLOOR, &stage->floor_image);
    if (!kiln_framebuffer_bind(&stage->cast_framebuffer, error))
        return false;
    glDisable(GL_BLEND);
    glUseProgram(stage->cast);
    kiln_framebuffer_fill(stage->vertex_array);

    GLuint surfaces = kiln_image_gl(&stage->surfaces, KILN_READ, error);
    if (!surfaces || !kiln_framebuffer_bind(&stage->color_framebuffer, error))
        return false;
    uint32_t width = stage->color->width, height = stage->color->height;
    glUseProgram(stage->antialias);
    glActiveTexture(GL_TEXTURE0 + KILN_UNIT_SURFACES);
    glBindTexture(GL_TEXTURE_2D, surfaces);
    glEnable(GL_PROGRAM_POINT_SIZE);
    uint32_t columns = (width + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    uint32_t rows = (height + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    glDrawArrays(GL_POINTS, 0, (GLsizei)(columns * rows));
    glDisable(GL_PROGRAM_POINT_SIZE);
    return true;
}

bool kiln_backdrop_gl_draw(struct kiln_backdrop_gl *gl, const struct kiln_backdrop_inputs *inputs,
                           bool is_current, struct kiln_error *error)
{
    if (!kiln_draw_blocks_bind(&gl->blocks, &inputs->view, &inputs->block, error))
        return false;
    GLuint shapes = kiln_buffer_upload(&gl->shapes_buffer, &inputs->shapes, error);
    if (!shapes)
        return false;
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_SHAPES, shapes);
    bind_picture(KILN_UNIT_SKY, &gl->sky_image);
    kiln_meshes_gl_bind_shadows(gl->meshes);
    return is_current ||
           (cast(gl, &inputs->shapes, error) && kiln_device_check(gl->device, "backdrop", error));
}
