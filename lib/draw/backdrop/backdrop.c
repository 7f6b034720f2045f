/* This file runs the backdrop stage: it evaluates scene values at the frame's time into the blocks
 * that its techniques read, and draws by the chosen technique. When neither a block nor the camera
 * changed since the last frame, the picture is kept. */
#include "draw/backdrop/backdrop.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/pyramid.h"
#include "asset/image/texture.h"
#include "asset/loader/loader.h"
#include "base/error.h"
#include "draw/backdrop/backdrop_cpu.h"
#include "draw/backdrop/backdrop_gl.h"
#include "draw/backdrop/meshes_cpu.h"
#include "draw/backdrop/surface_cache.h"
#include "draw/light/lighting_gl.h"
#include "shared/exact.h"
#include "shared/shapes.h"

struct kiln_backdrop_stage {
    const struct kiln_scene *scene;
    struct kiln_backdrop_gl *gl;     /* NULL for technique cpu */
    struct kiln_backdrop_cpu *cpu;   /* NULL for technique gl */
    struct kiln_device *device;      /* for gl; may be NULL for cpu */
    struct kiln_sky_light sky_light; /* measured from the sky image */
    struct kiln_backdrop_inputs drawn;
    bool has_drawn;
};

static float4 with_w(float3 v, float w)
{
    return (float4){v.x, v.y, v.z, w};
}

/* Adds the lamps and the light and shadows of particles to the block. */
static void add_lighting(struct kiln_draw_backdrop *block, const struct kiln_lighting *lighting)
{
    block->counts.y = lighting->light_count;
    memcpy(block->lights, lighting->lights, lighting->light_count * sizeof *block->lights);
    block->counts.w = lighting->smoke ? 1u : 0u;
    block->sun_color.w = lighting->sunlit ? 1.0f : 0.0f;
    memcpy(block->sun_to_grid, lighting->sun_to_grid, sizeof block->sun_to_grid);
    memcpy(block->sky_to_grid, lighting->sky_to_grid, sizeof block->sky_to_grid);
}

/* Sets the sky's light from the sky image, which then lights surfaces, particles and the haze. */
static void light_by_image(const struct kiln_backdrop_stage *stage, float intensity,
                           struct kiln_draw_backdrop *block)
{
    const float *up = stage->sky_light.up, *horizon = stage->sky_light.horizon;
    block->sky_top =
        (float4){up[0] * intensity, up[1] * intensity, up[2] * intensity, block->sky_top.w};
    block->sky_horizon = (float4){horizon[0] * intensity, horizon[1] * intensity,
                                  horizon[2] * intensity, block->sky_horizon.w};
}

/* Fills in the colours of haze before a sky that is a picture. turn: of the picture, as a part of a
 * full turn, as sky_place_of in shared/picture_map.h adds it. */
static void fill_haze(const struct kiln_backdrop_stage *stage, float turn, float intensity,
                      struct kiln_draw_backdrop *block)
{
    static_assert((int)KILN_SKY_PARTS == (int)KILN_HAZE_PARTS, "a part has a colour");
    block->counts.x = 1;
    for (uint32_t i = 0; i < KILN_HAZE_PARTS; i++) {
        /* the middles of the picture's parts lie half a part from their edges */
        float place = (float)i / (float)KILN_HAZE_PARTS + turn;
        place = (place - floorf(place)) * (float)KILN_HAZE_PARTS + ((float)KILN_HAZE_PARTS - 0.5f);
        const uint32_t low = exact_uint(place);
        const float part = place - (float)low;
        const float *from = stage->sky_light.around[low % KILN_HAZE_PARTS];
        const float *to = stage->sky_light.around[(low + 1) % KILN_HAZE_PARTS];
        float color[3];
        for (int c = 0; c < 3; c++)
            color[c] = intensity * (from[c] + (to[c] - from[c]) * part);
        block->haze[i] = (float4){color[0], color[1], color[2], 0.0f};
    }
}

/* Holds the sizes of the floor's and the sky's pictures; width 0: no picture. */
struct pictures {
    struct kiln_picture_size floor, sky;
};

/* Fills in how the pictures are mapped to the floor and the sky. */
static void fill_maps(const struct kiln_scene *scene, const struct pictures *pictures, float time_s,
                      struct kiln_draw_shapes *shapes)
{
    const float full_turn = 6.28318531f;
    if (pictures->floor.width) {
        float tile = kiln_scene_value(scene, &scene->backdrop.floor_tile, time_s);
        float width = (float)pictures->floor.width, height = (float)pictures->floor.height;
        shapes->floor_map.x = 1.0f / tile;
        shapes->floor_map.y = width / (tile * height);
        shapes->floor_map.z = width / tile;
    }
    if (pictures->sky.width)
        shapes->sky_map =
            (float4){kiln_scene_value(scene, &scene->backdrop.sky_rotation, time_s) / full_turn,
                     kiln_scene_value(scene, &scene->backdrop.sky_intensity, time_s),
                     (float)pictures->sky.width / full_turn, 0.0f};
}

/* Returns the sun's colour, dimmed by planes: a plane is infinite, so the half space behind it
 * shades everything. */
static float3 sun_color(const struct kiln_moment *moment)
{
    const struct kiln_scene *scene = moment->scene;
    const float time_s = moment->view.clock.x;
    float3 color = kiln_scene_value3(scene, &scene->backdrop.sun_color, time_s);
    for (uint32_t i = 0; i < moment->shapes.counts.x; i++) {
        const struct kiln_draw_shape *plane = &moment->shapes.shapes[i];
        const float4 normal = plane->rows[1];
        const float height = real3_dot_all(moment->sun.towards, normal);
        if (plane->kind.x == SHAPE_PLANE)
            color = float3_scale(color, 1.0f - plane_hides(height, moment->sun.spread));
    }
    return color;
}

/* Returns the distance between two unit vectors that are an angle apart. */
static float chord(float angle)
{
    return 2.0f * exact_sincos(0.5f * angle).sine;
}

static struct kiln_draw_backdrop make_block(const struct kiln_moment *moment)
{
    const struct kiln_scene *scene = moment->scene;
    const float time_s = moment->view.clock.x;
    const struct kiln_backdrop *b = &scene->backdrop;
    return (struct kiln_draw_backdrop){
        .sky_top = with_w(kiln_scene_value3(scene, &b->sky_top, time_s),
                          kiln_scene_value(scene, &b->sun_disc, time_s)),
        .sky_horizon = with_w(kiln_scene_value3(scene, &b->sky_horizon, time_s),
                              kiln_scene_value(scene, &b->sun_glow, time_s)),
        .floor_color = with_w(kiln_scene_value3(scene, &b->floor_color, time_s),
                              kiln_scene_value(scene, &b->floor_height, time_s)),
        .floor_params = {b->floor_enabled ? 1.0f : 0.0f,
                         kiln_scene_value(scene, &b->floor_checker, time_s),
                         kiln_scene_value(scene, &b->haze, time_s),
                         chord(kiln_scene_value(scene, &b->sun_glow_size, time_s))},
        .sun_direction = with_w(moment->sun.towards,
                                chord(0.5f * kiln_scene_value(scene, &b->sun_size, time_s))),
        .sun_color = with_w(sun_color(moment), 0.0f),
        .counts = {0, 0, b->transparent ? 1u : 0u, 0},
    };
}

/* Returns whether two inputs give the same picture. The camera's clock does not change the picture,
 * so it is not compared. Smoke and solid particles change it, but their grids and lists are not
 * compared, so inputs with them always count as different. */
static bool same_picture(const struct kiln_backdrop_inputs *a, const struct kiln_backdrop_inputs *b)
{
    return a->block.counts.w == 0 && a->shapes.counts.w == 0 && a->paint == b->paint &&
           memcmp(&a->block, &b->block, sizeof a->block) == 0 &&
           memcmp(&a->shapes, &b->shapes, sizeof a->shapes) == 0 &&
           memcmp(a->view.world_to_view, b->view.world_to_view, sizeof a->view.world_to_view) ==
               0 &&
           memcmp(&a->view.frustum, &b->view.frustum, sizeof a->view.frustum) == 0 &&
           a->view.exposure.x == b->view.exposure.x &&
           memcmp(&a->view.principal, &b->view.principal, sizeof a->view.principal) == 0;
}

struct kiln_backdrop_stage *kiln_backdrop_create(struct kiln_device *device,
                                                 const struct kiln_moment *moment,
                                                 const struct kiln_backdrop_params *params,
                                                 struct kiln_error *error)
{
    struct kiln_backdrop_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the backdrop");
        return NULL;
    }
    const struct kiln_scene *scene = moment->scene;
    stage->scene = scene;
    stage->device = device;
    const char *sky_image = scene->backdrop.sky_image;
    bool ok =
        !sky_image || kiln_sky_light_measure(&stage->sky_light, scene->loader, sky_image, error);
    if (ok && params->technique == KILN_BACKDROP_CPU)
        stage->cpu = kiln_backdrop_cpu_create(scene, &moment->meshes, params, error);
    else if (ok)
        stage->gl = kiln_backdrop_gl_create(device, scene, &moment->meshes, params, error);
    if (!stage->cpu && !stage->gl)
        kiln_backdrop_destroy(&stage);
    return stage;
}

/* Adds the memory of a picture of the floor or the sky; path: NULL, or a file. The size of a
 * video's frames is not known before it is opened. */
static void add_picture(const struct kiln_scene *scene, const char *path,
                        struct kiln_footprint *footprint)
{
    uint32_t size[2];
    if (!path || path[0] != '/' || !kiln_loader_knows_size(scene->loader, path, size))
        return;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_BACKDROP, 1, kiln_pyramid_bytes(size[0], size[1]));
}

void kiln_backdrop_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const uint64_t pixels = (uint64_t)scene->width * scene->height;
    add_picture(scene, scene->backdrop.floor_image, footprint);
    add_picture(scene, scene->backdrop.sky_image, footprint);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, pixels, sizeof(float)); /* surfaces */
    kiln_meshes_cpu_footprint(scene, footprint);
    /* Surfaces are kept for the next picture: of the next frame, or of another moment of it. */
    if (kiln_scene_view_stands(scene) && (scene->frames > 1 || kiln_scene_moment_count(scene) > 1))
        kiln_surface_cache_footprint(scene, footprint);
}

void kiln_backdrop_destroy(struct kiln_backdrop_stage **stage)
{
    if (!*stage)
        return;
    kiln_backdrop_cpu_destroy(&(*stage)->cpu);
    kiln_backdrop_gl_destroy(&(*stage)->gl);
    free(*stage);
    *stage = NULL;
}

static struct pictures pictures_of(const struct kiln_backdrop_stage *stage)
{
    struct pictures pictures;
    if (stage->cpu)
        kiln_backdrop_cpu_pictures(stage->cpu, &pictures.floor, &pictures.sky);
    else
        kiln_backdrop_gl_pictures(stage->gl, &pictures.floor, &pictures.sky);
    return pictures;
}

static struct kiln_backdrop_inputs make_inputs(struct kiln_backdrop_stage *stage,
                                               const struct kiln_moment *moment,
                                               const struct kiln_lighting *lighting)
{
    const float time_s = moment->view.clock.x;
    const struct pictures pictures = pictures_of(stage);
    struct kiln_backdrop_inputs inputs = {
        .view = moment->view,
        .block = make_block(moment),
        .shapes = moment->shapes,
        .from_sun = moment->from_sun,
    };
    fill_maps(stage->scene, &pictures, time_s, &inputs.shapes);
    if (pictures.sky.width) {
        light_by_image(stage, inputs.shapes.sky_map.y, &inputs.block);
        fill_haze(stage, inputs.shapes.sky_map.x, inputs.shapes.sky_map.y, &inputs.block);
    }
    if (moment->meshes.painted)
        inputs.paint = kiln_painted_all_changes(moment->meshes.painted);
    add_lighting(&inputs.block, lighting);
    inputs.shapes.counts.w = lighting->solids.edge;
    memcpy(inputs.shapes.world_to_bin, lighting->solids.world_to_bin,
           sizeof inputs.shapes.world_to_bin);
    return inputs;
}

/* Returns the most iterations that an invocation of backdrop.frag runs to light one surface, but
 * for its list of solid particles. Each loop counts one more than its body runs (gpu/device.h).
 * Shapes have loops for each kind: to find the surface, the sky that it sees, the sun and each
 * lamp. */
static uint32_t lighting_iterations(const struct kiln_shape_features *features,
                                    const struct kiln_backdrop_inputs *inputs)
{
    const uint32_t shapes = inputs->shapes.counts.x, meshes = inputs->shapes.counts.z;
    const uint32_t lights = inputs->block.counts.y, taps = 5 + 1; /* of a map of shadows */
    const uint32_t hidden = features->lamp_shadows ? lights : 0;
    const uint32_t each_lamp = (features->meshes ? taps : 0) + (features->solids ? taps : 0);
    const uint32_t passes_over_shapes = 2u + (features->sun ? 1 : 0) + hidden;
    const uint32_t for_meshes = meshes + 1 + (features->sun ? meshes * (1 + taps) + 1 : 0);
    return 1 + passes_over_shapes * (shapes + (uint32_t)__builtin_popcount(features->kinds)) +
           (lights + 1) + hidden * each_lamp + (features->meshes ? for_meshes : 0);
}

/* Refuses pictures that llvmpipe would silently draw wrong, as it ends the loops of an invocation
 * after KILN_SOFTWARE_ITERATIONS. At an edge, an invocation lights a surface for each of its rays,
 * and one more for each that the floor reflects. */
static bool lighting_fits_loops(const struct kiln_backdrop_stage *stage,
                                const struct kiln_backdrop_inputs *inputs,
                                const struct kiln_solid_bins *solids, struct kiln_error *error)
{
    enum { OTHERS = 160 }; /* the loops over rays, neighbours and waves */
    const struct kiln_shape_features features = kiln_shape_features(stage->scene);
    const uint32_t surfaces = (1 + KILN_EDGE_SAMPLES) * (features.floor_gloss ? 2 : 1);
    const uint32_t most = (KILN_SOFTWARE_ITERATIONS - OTHERS) / surfaces;
    const uint32_t needed = lighting_iterations(&features, inputs);
    if (!stage->device->info.software)
        return true;
    if (needed + 1 > most)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "backdrop=gl: %u objects and %u lights take %u iterations a pixel; "
                              "software GL runs at most %d: use --technique backdrop=cpu, or fewer "
                              "objects or lights",
                              inputs->shapes.counts.x + inputs->shapes.counts.z,
                              inputs->block.counts.y, needed * surfaces + OTHERS,
                              KILN_SOFTWARE_ITERATIONS);
    const uint32_t most_listed = (most - needed - 1) * (uint32_t)KILN_SOLIDS_AT_A_TIME;
    if (solids->longest <= most_listed)
        return true;
    return kiln_error_set(error, KILN_DEVICE_FAILED,
                          "backdrop=gl: %u particles may shade one place; software GL draws at "
                          "most %u: use --technique backdrop=cpu, or fewer particles",
                          solids->longest, most_listed);
}

bool kiln_backdrop_draw(struct kiln_backdrop_stage *stage, const struct kiln_moment *moment,
                        const struct kiln_lighting *lighting, struct kiln_error *error)
{
    const struct kiln_backdrop_inputs inputs = make_inputs(stage, moment, lighting);
    bool is_current = stage->has_drawn && same_picture(&inputs, &stage->drawn);
    stage->drawn = inputs;
    stage->has_drawn = false;
    if (stage->cpu)
        stage->has_drawn =
            kiln_backdrop_cpu_draw(stage->cpu, &stage->drawn, lighting, is_current, error);
    else
        stage->has_drawn = lighting_fits_loops(stage, &inputs, &lighting->solids, error) &&
                           kiln_lighting_bind(lighting, error) &&
                           kiln_backdrop_gl_draw(stage->gl, &stage->drawn, is_current, error);
    return stage->has_drawn;
}

const struct kiln_draw_backdrop *kiln_backdrop_block(const struct kiln_backdrop_stage *stage)
{
    return &stage->drawn.block;
}

const struct kiln_ray_frame *kiln_backdrop_rays(const struct kiln_backdrop_stage *stage)
{
    return stage->cpu ? kiln_backdrop_cpu_rays(stage->cpu) : NULL;
}
