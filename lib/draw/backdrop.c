/* The backdrop: scene values at the frame's time into uniform blocks, the meshes, a full-screen
 * pass, and a second one over the tiles with edges in them. When neither a block nor the camera
 * changed since the last frame, the picture is kept. */
#include "draw/backdrop.h"

#include "asset/texture.h"
#include "base/error.h"
#include "draw/meshes.h"
#include "draw/shapes.h"
#include "gpu/framebuffer.h"
#include "gpu/program.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static_assert(sizeof(struct kiln_view) == 112, "std140");
static_assert(offsetof(struct kiln_view, eye) == 48, "std140");
static_assert(sizeof(struct kiln_draw_light) == 32, "std140");
static_assert(offsetof(struct kiln_draw_backdrop, counts) == 96, "std140");
static_assert(offsetof(struct kiln_draw_backdrop, box_half) == 112 + 16 * KILN_MAX_OBJECTS,
              "std140");
static_assert(offsetof(struct kiln_draw_backdrop, lights) == 112 + 48 * KILN_MAX_OBJECTS, "std140");
static_assert(sizeof(struct kiln_draw_backdrop) ==
                  208 + 48 * KILN_MAX_OBJECTS + 32 * (KILN_MAX_LIGHTS + KILN_MAX_FIRE_LIGHTS),
              "std140, and no padding, which same_picture() would compare");

/* What the picture depends on. */
struct backdrop_inputs {
    struct kiln_view view;
    struct kiln_draw_backdrop block;
    struct kiln_draw_shapes shapes;
};

struct kiln_backdrop_stage {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    struct kiln_image *color, *depth;
    struct kiln_image surfaces; /* what each pixel's centre shows */
    GLuint cast, antialias;     /* programs */
    struct kiln_framebuffer cast_framebuffer, color_framebuffer;
    GLuint vertex_array;
    struct kiln_buffer view_buffer, block_buffer, shapes_buffer;
    struct kiln_meshes *meshes;
    struct kiln_texture floor_image, sky_image;
    struct kiln_sky_light sky_light; /* of the image */
    struct backdrop_inputs drawn;
    bool has_drawn;
};

static float4 with_w(float3 v, float w)
{
    return (float4){v.x, v.y, v.z, w};
}

static float3 normalized(float3 v)
{
    float length = sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
    if (!(length > 0.0f))
        return (float3){0.0f, 1.0f, 0.0f};
    return (float3){v.x / length, v.y / length, v.z / length};
}

static void fill_boxes(const struct kiln_scene *scene, float time_s,
                       struct kiln_draw_backdrop *block)
{
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *box = &scene->backdrop.objects[i];
        if (box->kind != KILN_OBJECT_BOX)
            continue;
        uint k = block->counts.x++;
        float3 size = kiln_scene_value3(scene, &box->size, time_s);
        block->box_center[k] = with_w(kiln_scene_value3(scene, &box->center, time_s), 0.0f);
        block->box_half[k] = (float4){0.5f * size.x, 0.5f * size.y, 0.5f * size.z, 0.0f};
        block->box_color[k] = with_w(kiln_scene_value3(scene, &box->color, time_s), 0.0f);
    }
}

static void fill_lights(const struct kiln_scene *scene, float time_s,
                        struct kiln_draw_backdrop *block)
{
    for (uint32_t i = 0; i < scene->backdrop.light_count; i++) {
        const struct kiln_light *light = &scene->backdrop.lights[i];
        float radius = kiln_scene_value(scene, &light->radius, time_s);
        float3 position = kiln_scene_value3(scene, &light->position, time_s);
        block->lights[i].position_radius2 = with_w(position, radius * radius);
        block->lights[i].color = with_w(kiln_scene_value3(scene, &light->color, time_s), 0.0f);
    }
}

/* What the particles light and shade. */
static void add_lighting(struct kiln_draw_backdrop *block, const struct kiln_lighting *lighting)
{
    for (uint32_t i = 0; i < lighting->fire_count; i++)
        block->lights[block->counts.y++] = lighting->fire[i];
    block->counts.w = lighting->smoke ? 1u : 0u;
    block->sun_color.w = lighting->sunlit ? 1.0f : 0.0f;
    memcpy(block->sun_to_grid, lighting->sun_to_grid, sizeof block->sun_to_grid);
    memcpy(block->sky_to_grid, lighting->sky_to_grid, sizeof block->sky_to_grid);
}

/* Surfaces, particles and the haze are lit by the image, where there is one. */
static void light_by_image(const struct kiln_backdrop_stage *stage, float intensity,
                           struct kiln_draw_backdrop *block)
{
    const float *up = stage->sky_light.up, *horizon = stage->sky_light.horizon;
    block->sky_top = (float4){up[0] * intensity, up[1] * intensity, up[2] * intensity, 0.0f};
    block->sky_horizon =
        (float4){horizon[0] * intensity, horizon[1] * intensity, horizon[2] * intensity, 0.0f};
}

/* Where the pictures of the floor and the sky lie. */
static void fill_maps(const struct kiln_backdrop_stage *stage, float time_s,
                      struct kiln_draw_shapes *shapes)
{
    const float full_turn = 6.28318531f;
    const struct kiln_scene *scene = stage->scene;
    const struct kiln_texture *floor_image = &stage->floor_image, *sky = &stage->sky_image;
    if (floor_image->gl) {
        float tile = kiln_scene_value(scene, &scene->backdrop.floor_tile, time_s);
        float width = (float)floor_image->width, height = (float)floor_image->height;
        shapes->floor_map.x = 1.0f / tile;
        shapes->floor_map.y = width / (tile * height);
        shapes->floor_map.z = width / tile;
    }
    if (sky->gl)
        shapes->sky_map =
            (float4){kiln_scene_value(scene, &scene->backdrop.sky_rotation, time_s) / full_turn,
                     kiln_scene_value(scene, &scene->backdrop.sky_intensity, time_s),
                     (float)sky->width / full_turn, 0.0f};
}

static struct kiln_draw_backdrop make_block(const struct kiln_scene *scene, float time_s)
{
    const struct kiln_backdrop *b = &scene->backdrop;
    struct kiln_draw_backdrop block = {
        .sky_top = with_w(kiln_scene_value3(scene, &b->sky_top, time_s), 0.0f),
        .sky_horizon = with_w(kiln_scene_value3(scene, &b->sky_horizon, time_s), 0.0f),
        .floor_color = with_w(kiln_scene_value3(scene, &b->floor_color, time_s),
                              kiln_scene_value(scene, &b->floor_height, time_s)),
        .floor_params = {b->floor_enabled ? 1.0f : 0.0f,
                         kiln_scene_value(scene, &b->floor_checker, time_s),
                         kiln_scene_value(scene, &b->haze, time_s), 0.0f},
        .sun_direction =
            with_w(normalized(kiln_scene_value3(scene, &b->sun_direction, time_s)), 0.0f),
        .sun_color = with_w(kiln_scene_value3(scene, &b->sun_color, time_s), 0.0f),
        .counts = {0, b->light_count, b->transparent ? 1u : 0u, 0},
    };
    fill_boxes(scene, time_s, &block);
    fill_lights(scene, time_s, &block);
    return block;
}

/* The camera's clock does not show in the backdrop; smoke and spheres do, whose grids and lists are
 * not compared. */
static bool same_picture(const struct backdrop_inputs *a, const struct backdrop_inputs *b)
{
    return a->block.counts.w == 0 && a->shapes.counts.w == 0 &&
           memcmp(&a->block, &b->block, sizeof a->block) == 0 &&
           memcmp(&a->shapes, &b->shapes, sizeof a->shapes) == 0 &&
           memcmp(a->view.world_to_view, b->view.world_to_view, sizeof a->view.world_to_view) ==
               0 &&
           memcmp(&a->view.frustum, &b->view.frustum, sizeof a->view.frustum) == 0;
}

static bool create_programs(struct kiln_backdrop_stage *stage, struct kiln_error *error)
{
    const struct kiln_shape_features features = kiln_shape_features(stage->scene);
    char defines[KILN_SHAPE_DEFINES];
    struct kiln_program_params params = {
        .vertex = "draw/fullscreen.vert", .fragment = "draw/backdrop.frag", .defines = defines};
    kiln_shape_defines(&features, 1, defines);
    stage->cast = kiln_program_create(stage->device, &params, error);
    if (!stage->cast)
        return false;
    params.vertex = "draw/backdrop_edges.vert";
    kiln_shape_defines(&features, KILN_EDGE_SAMPLES, defines);
    stage->antialias = kiln_program_create(stage->device, &params, error);
    return stage->antialias != 0;
}

/* What the scene has in files. */
static bool load_files(struct kiln_backdrop_stage *stage, struct kiln_error *error)
{
    const struct kiln_backdrop *backdrop = &stage->scene->backdrop;
    stage->meshes = kiln_meshes_create(stage->device, stage->scene, error);
    if (!stage->meshes)
        return false;
    if (backdrop->floor_image && !kiln_texture_init(&stage->floor_image, stage->device,
                                                    backdrop->floor_image, GL_REPEAT, error))
        return false;
    return !backdrop->sky_image ||
           (kiln_sky_light_measure(&stage->sky_light, backdrop->sky_image, error) &&
            kiln_texture_init(&stage->sky_image, stage->device, backdrop->sky_image,
                              GL_CLAMP_TO_EDGE, error));
}

static bool create_targets(struct kiln_backdrop_stage *stage, struct kiln_error *error)
{
    kiln_image_init(&stage->surfaces, stage->device, stage->color->width, stage->color->height,
                    GL_R32F, "backdrop surfaces");
    struct kiln_image *targets[] = {stage->color, stage->depth, &stage->surfaces};
    return kiln_framebuffer_init(&stage->cast_framebuffer, stage->device, targets, 3, error) &&
           kiln_framebuffer_init(&stage->color_framebuffer, stage->device, targets, 1, error);
}

struct kiln_backdrop_stage *kiln_backdrop_create(struct kiln_device *device,
                                                 const struct kiln_scene *scene,
                                                 struct kiln_image *color, struct kiln_image *depth,
                                                 struct kiln_error *error)
{
    struct kiln_backdrop_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "backdrop: out of memory");
        return NULL;
    }
    stage->device = device;
    stage->scene = scene;
    stage->color = color;
    stage->depth = depth;
    if (!create_programs(stage, error) || !create_targets(stage, error) ||
        !load_files(stage, error)) {
        kiln_backdrop_destroy(&stage);
        return NULL;
    }
    glGenVertexArrays(1, &stage->vertex_array);
    kiln_buffer_init(&stage->view_buffer, device, sizeof stage->drawn.view, "view");
    kiln_buffer_init(&stage->block_buffer, device, sizeof stage->drawn.block, "backdrop");
    kiln_buffer_init(&stage->shapes_buffer, device, sizeof stage->drawn.shapes, "shapes");
    return stage;
}

void kiln_backdrop_destroy(struct kiln_backdrop_stage **stage)
{
    struct kiln_backdrop_stage *s = *stage;
    if (!s)
        return;
    glDeleteProgram(s->cast); /* 0 is ignored */
    glDeleteProgram(s->antialias);
    kiln_framebuffer_finish(&s->cast_framebuffer);
    kiln_framebuffer_finish(&s->color_framebuffer);
    kiln_image_finish(&s->surfaces);
    glDeleteVertexArrays(1, &s->vertex_array);
    kiln_buffer_finish(&s->view_buffer);
    kiln_buffer_finish(&s->block_buffer);
    kiln_buffer_finish(&s->shapes_buffer);
    kiln_meshes_destroy(&s->meshes);
    kiln_texture_finish(&s->floor_image);
    kiln_texture_finish(&s->sky_image);
    free(s);
    *stage = NULL;
}

static void bind_picture(GLenum unit, const struct kiln_texture *texture)
{
    if (!texture->gl)
        return;
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture->gl);
    glActiveTexture(GL_TEXTURE0);
}

static bool cast(struct kiln_backdrop_stage *stage, const struct kiln_draw_shapes *shapes,
                 struct kiln_error *error)
{
    if (!kiln_meshes_draw(stage->meshes, shapes, error))
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
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, surfaces);
    glEnable(GL_PROGRAM_POINT_SIZE);
    uint32_t columns = (width + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    uint32_t rows = (height + KILN_EDGE_TILE - 1) / KILN_EDGE_TILE;
    glDrawArrays(GL_POINTS, 0, (GLsizei)(columns * rows));
    glDisable(GL_PROGRAM_POINT_SIZE);
    return true;
}

struct kiln_mesh *const *kiln_backdrop_meshes(const struct kiln_backdrop_stage *stage)
{
    return kiln_meshes_loaded(stage->meshes);
}

bool kiln_backdrop_draw(struct kiln_backdrop_stage *stage, const struct kiln_view *view,
                        const struct kiln_lighting *lighting, struct kiln_error *error)
{
    float time_s = view->clock.x;
    struct backdrop_inputs now = {.view = *view, .block = make_block(stage->scene, time_s)};
    kiln_shapes_fill(stage->scene, kiln_meshes_loaded(stage->meshes), time_s, &now.shapes);
    fill_maps(stage, time_s, &now.shapes);
    if (stage->sky_image.gl)
        light_by_image(stage, now.shapes.sky_map.y, &now.block);
    add_lighting(&now.block, lighting);
    now.shapes.counts.w = lighting->spheres.edge;
    memcpy(now.shapes.world_to_bin, lighting->spheres.world_to_bin, sizeof now.shapes.world_to_bin);
    GLuint view_buffer = kiln_buffer_upload(&stage->view_buffer, &now.view, error);
    GLuint block_buffer = kiln_buffer_upload(&stage->block_buffer, &now.block, error);
    GLuint shapes_buffer = kiln_buffer_upload(&stage->shapes_buffer, &now.shapes, error);
    if (!view_buffer || !block_buffer || !shapes_buffer)
        return false;
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_VIEW, view_buffer);
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_BACKDROP, block_buffer);
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_SHAPES, shapes_buffer);
    bind_picture(KILN_UNIT_SKY, &stage->sky_image);
    kiln_meshes_bind_shadows(stage->meshes);
    if (stage->has_drawn && same_picture(&now, &stage->drawn))
        return true;

    if (!cast(stage, &now.shapes, error))
        return false;
    stage->drawn = now;
    stage->has_drawn = true;
    return kiln_device_check(stage->device, "backdrop", error);
}

/* A kept picture was drawn with an equal block. */
const struct kiln_draw_backdrop *kiln_backdrop_block(const struct kiln_backdrop_stage *stage)
{
    return &stage->drawn.block;
}
