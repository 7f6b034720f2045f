/* This file draws the backdrop in GL: it uploads uniform blocks, draws the meshes, then runs a
 * full-screen pass and a second pass over the tiles that contain edges.
 *
 * Both passes run one program with targets and textures of the same formats, since llvmpipe
 * compiles a program for each set of formats and takes more than a second for this one. So each
 * pass has an image of surfaces that it draws into, and reads that of the other pass: the first
 * pass makes no use of what it reads, and nobody reads what the second pass draws. */
#include "draw/backdrop/backdrop_gl.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

#include "asset/image/texture.h"
#include "base/error.h"
#include "draw/backdrop/meshes_gl.h"
#include "draw/moment/draw_blocks.h"
#include "gpu/framebuffer.h"
#include "gpu/program.h"
#include "shared/sort_layout.h"

static_assert(KILN_BIND_STORED_SHAPES > SORT_BIND_TOTAL, "bound from the backdrop to the solids");

/* Bytes of the uniform block of shapes, which has the first shapes alone. */
enum {
    SHAPES_BLOCK_BYTES = offsetof(struct kiln_draw_shapes, shapes) +
                         KILN_BLOCK_SHAPES * sizeof(struct kiln_draw_shape)
};
static_assert(SHAPES_BLOCK_BYTES <= 16384, "what every GL allows a uniform block");

enum { PASS_CENTERS, PASS_EDGES, PASSES };

struct kiln_backdrop_gl {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    struct kiln_image *color, *depth;
    struct kiln_image surfaces[PASSES]; /* of the first pass: the surface at each pixel's centre */
    struct kiln_framebuffer framebuffers[PASSES];
    GLuint program;
    GLuint vertex_array;
    struct kiln_draw_blocks blocks;
    struct kiln_buffer shapes_buffer; /* the uniform block */
    struct kiln_buffer stored_shapes; /* all shapes, where the block has no room */
    bool stores_shapes;
    struct kiln_meshes_gl *meshes;
    struct kiln_texture floor_image, sky_image;
};

static bool create_program(struct kiln_backdrop_gl *stage, struct kiln_error *error)
{
    const struct kiln_shape_features features = kiln_shape_features(stage->scene);
    stage->stores_shapes = features.stored;
    struct kiln_text defines = {0};
    kiln_shape_defines(&features, &defines);
    const struct kiln_program_params params = {.vertex = "draw/backdrop/backdrop.vert",
                                               .fragment = "draw/backdrop/backdrop.frag"};
    stage->program = kiln_program_create_defined(stage->device, &params, &defines, error);
    return stage->program != 0;
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
    static const char *const labels[PASSES] = {"backdrop surfaces", "backdrop surfaces of edges"};
    for (int pass = 0; pass < PASSES; pass++) {
        struct kiln_image *targets[] = {stage->color, stage->depth, &stage->surfaces[pass]};
        kiln_image_init(&stage->surfaces[pass], stage->device, stage->color->width,
                        stage->color->height, GL_R32F, labels[pass]);
        if (!kiln_framebuffer_init(&stage->framebuffers[pass], stage->device, targets, 3, error))
            return false;
    }
    return true;
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
    if (!stage->meshes || !create_program(stage, error) || !create_targets(stage, error) ||
        !load_pictures(stage, error)) {
        kiln_backdrop_gl_destroy(&stage);
        return NULL;
    }
    glGenVertexArrays(1, &stage->vertex_array);
    kiln_draw_blocks_init(&stage->blocks, device);
    kiln_buffer_init(&stage->shapes_buffer, device, SHAPES_BLOCK_BYTES, "shapes");
    kiln_buffer_init(&stage->stored_shapes, device,
                     KILN_MAX_OBJECTS * sizeof(struct kiln_draw_shape), "stored shapes");
    return stage;
}

void kiln_backdrop_gl_destroy(struct kiln_backdrop_gl **gl)
{
    struct kiln_backdrop_gl *s = *gl;
    if (!s)
        return;
    glDeleteProgram(s->program); /* 0 is ignored */
    for (int pass = 0; pass < PASSES; pass++) {
        kiln_framebuffer_finish(&s->framebuffers[pass]);
        kiln_image_finish(&s->surfaces[pass]);
    }
    glDeleteVertexArrays(1, &s->vertex_array);
    kiln_draw_blocks_finish(&s->blocks);
    kiln_buffer_finish(&s->shapes_buffer);
    kiln_buffer_finish(&s->stored_shapes);
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

/* Binds the targets and textures of a pass, and its program. */
static bool begin_pass(struct kiln_backdrop_gl *stage, int pass, struct kiln_error *error)
{
    const int other = PASS_EDGES - pass;
    const GLuint surfaces = kiln_image_gl(&stage->surfaces[other], KILN_READ, error);
    if (!surfaces || !kiln_framebuffer_bind(&stage->framebuffers[pass], error))
        return false;
    glActiveTexture(GL_TEXTURE0 + KILN_UNIT_SURFACES);
    glBindTexture(GL_TEXTURE_2D, surfaces);
    glActiveTexture(GL_TEXTURE0);
    glUseProgram(stage->program);
    glUniform1i(BACKDROP_AT_EDGES, pass == PASS_EDGES);
    return true;
}

static bool cast(struct kiln_backdrop_gl *stage, const struct kiln_draw_shapes *shapes,
                 struct kiln_error *error)
{
    if (!kiln_meshes_gl_draw(stage->meshes, shapes, error))
        return false;
    bind_picture(KILN_UNIT_FLOOR, &stage->floor_image);
    if (!begin_pass(stage, PASS_CENTERS, error))
        return false;
    glDisable(GL_BLEND);
    kiln_framebuffer_fill(stage->vertex_array);

    if (!begin_pass(stage, PASS_EDGES, error))
        return false;
    uint32_t width = stage->color->width, height = stage->color->height;
    glEnable(GL_PROGRAM_POINT_SIZE);
    uint32_t columns = (width + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    uint32_t rows = (height + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    glDrawArrays(GL_POINTS, 0, (GLsizei)(columns * rows));
    glDisable(GL_PROGRAM_POINT_SIZE);
    return true;
}

/* Uploads the shapes and binds them. The uniform block has the first of them. */
static bool bind_shapes(struct kiln_backdrop_gl *gl, const struct kiln_draw_shapes *shapes,
                        struct kiln_error *error)
{
    const GLuint block = kiln_buffer_upload(&gl->shapes_buffer, shapes, error);
    if (!block)
        return false;
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_SHAPES, block);
    if (!gl->stores_shapes)
        return true;
    const GLuint stored = kiln_buffer_upload(&gl->stored_shapes, shapes->shapes, error);
    if (stored)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, KILN_BIND_STORED_SHAPES, stored);
    return stored != 0;
}

bool kiln_backdrop_gl_draw(struct kiln_backdrop_gl *gl, const struct kiln_backdrop_inputs *inputs,
                           bool is_current, struct kiln_error *error)
{
    if (!kiln_draw_blocks_bind(&gl->blocks, &inputs->view, &inputs->block, error))
        return false;
    if (!bind_shapes(gl, &inputs->shapes, error))
        return false;
    bind_picture(KILN_UNIT_SKY, &gl->sky_image);
    kiln_meshes_gl_bind_shadows(gl->meshes);
    return is_current ||
           (cast(gl, &inputs->shapes, error) && kiln_device_check(gl->device, "backdrop", error));
}
