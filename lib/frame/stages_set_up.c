/* This file creates the drawing stages of a scene, by the chosen techniques, and the images that
 * they draw into. */
#include "base/cache.h"
#include "base/error.h"
#include "draw/solids/solids_cpu.h"
#include "draw/sprites/particles_cpu.h"
#include "frame/stages.h"

/* Returns the format of the render targets. Blending into 16-bit floats makes the result darker by
 * rounding. Targets of 32-bit floats avoid that; they are used on software devices, where they cost
 * nothing. */
static GLenum target_format(const struct kiln_device *device)
{
    return !device || device->info.software ? GL_RGBA32F : GL_RGBA16F;
}

static uint64_t opaque_systems(const struct kiln_scene *scene)
{
    uint64_t mask = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (scene->systems[i].enabled && kiln_look_is_opaque(&scene->systems[i].look))
            mask |= UINT64_C(1) << i;
    }
    return mask;
}

/* Returns whether particles draw their glow into the bloom source. They do if the bloom or a bloom
 * layer needs it, but not if the scene has a bright pass, which fills the bloom source instead. */
static bool needs_glow(const struct kiln_scene *scene, bool layers)
{
    bool blooms = scene->post.bloom != KILN_BLOOM_NONE;
    return blooms ? scene->post.bloom_source != KILN_BLOOM_BRIGHT : layers;
}

static bool init_targets(struct kiln_stages *s, struct kiln_error *error)
{
    uint32_t w = s->scene->width, h = s->scene->height;
    GLenum format = target_format(s->device);
    kiln_image_init(&s->scene_color, s->device, w, h, format, "scene");
    kiln_image_init(&s->scene_depth, s->device, w, h, GL_R32F, "scene depth");
    kiln_image_init(&s->backdrop_color, s->device, w, h, format, "backdrop");
    kiln_image_init(&s->backdrop_depth, s->device, w, h, GL_R32F, "backdrop depth");
    kiln_image_init(&s->particle_color, s->device, w, h, format, "particles");
    kiln_image_init(&s->bloom_color, s->device, w, h, format, "bloom source");
    size_t targets = s->glow ? 2 : 1;
    struct kiln_image *merged[] = {&s->particle_color, &s->bloom_color};
    if (!kiln_framebuffer_init(&s->particle_framebuffer, s->device, merged, targets, error))
        return false;

    bool separate = s->scene->post.compose == KILN_COMPOSE_SEPARATE;
    if (s->layers && !separate) {
        kiln_image_init(&s->smoke_color, s->device, w, h, format, "smoke");
        struct kiln_image *smoke[] = {&s->smoke_color};
        if (!kiln_framebuffer_init(&s->smoke_framebuffer, s->device, smoke, 1, error))
            return false;
    }
    if (!s->layers && !separate)
        return true;
    kiln_image_init(&s->fire_color, s->device, w, h, format, "fire");
    struct kiln_image *fire[] = {&s->fire_color, &s->bloom_color};
    return kiln_framebuffer_init(&s->fire_framebuffer, s->device, fire, separate ? targets : 1,
                                 error);
}

/* Lists what each system asks of the atlas. */
static void list_requests(const struct kiln_scene *scene,
                          struct kiln_atlas_request requests[KILN_MAX_SYSTEMS])
{
    static const char *const plain = "builtin:spark";
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        requests[i] =
            (struct kiln_atlas_request){.sources = look->atlas,
                                        .count = look->atlas_count,
                                        .columns = look->columns,
                                        .rows = look->rows,
                                        .motion = look->motion,
                                        .motion_full = {look->motion_full[0], look->motion_full[1]},
                                        .loader = scene->loader};
        if (!kiln_look_has_texture(look)) /* such particles show no texture and get the
                                           * smallest one */
            requests[i] = (struct kiln_atlas_request){
                .sources = &plain, .count = 1, .columns = 1, .rows = 1, .motion = "none"};
    }
}

static bool init_atlas(struct kiln_stages *s, struct kiln_error *error)
{
    struct kiln_atlas_request requests[KILN_MAX_SYSTEMS];
    list_requests(s->scene, requests);
    char cache[KILN_PATH_SIZE];
    const bool cached = kiln_cache_folder(cache);
    return kiln_atlas_init(&s->atlas, s->device, requests, s->scene->system_count,
                           cached ? cache : NULL, s->threads, error);
}

/* Creates the backdrop stage, and the solids stage if the scene has opaque particles. Without
 * solids, the backdrop draws into the scene's images. With solids, it draws into images of its own,
 * and the solids stage draws the scene's images from them. */
static bool init_scenery(struct kiln_stages *s, enum kiln_backdrop_technique technique,
                         struct kiln_error *error)
{
    bool solids = s->opaque_systems != 0;
    const struct kiln_backdrop_params backdrop_params = {
        .technique = technique,
        .threads = s->threads,
        .color = solids ? &s->backdrop_color : &s->scene_color,
        .depth = solids ? &s->backdrop_depth : &s->scene_depth,
    };
    s->backdrop = kiln_backdrop_create(s->device, &s->moment, &backdrop_params, error);
    if (!s->backdrop)
        return false;
    if (!solids)
        return true;
    const struct kiln_solids_params solids_params = {
        .backdrop = s->backdrop,
        .threads = s->threads,
        .targets = {.backdrop_color = &s->backdrop_color,
                    .backdrop_depth = &s->backdrop_depth,
                    .color = &s->scene_color,
                    .depth = &s->scene_depth,
                    .bloom = &s->bloom_color},
    };
    s->solids = kiln_solids_create(s->device, &s->moment, &solids_params, error);
    return s->solids;
}

static bool init_coarse(struct kiln_stages *s, const struct kiln_techniques *techniques,
                        struct kiln_error *error)
{
    if (s->scene->post.resolution == KILN_RESOLUTION_FULL)
        return true;
    const struct kiln_coarse_params params = {.particles = s->particles,
                                              .in_gl = techniques->composite == KILN_COMPOSITE_GL,
                                              .format = target_format(s->device)};
    s->coarse = kiln_coarse_create(s->device, s->scene, &params, s->threads, error);
    return s->coarse != NULL;
}

static bool init_sort(struct kiln_stages *s, const struct kiln_techniques *techniques,
                      struct kiln_error *error)
{
    const struct kiln_sort_setup setup = {
        .device = s->device, .threads = s->threads, .frames = techniques->sort_number};
    s->sort = kiln_sort_create(techniques->sort, &setup, error);
    if (s->sort)
        s->history = kiln_sort_history(s->sort);
    return s->sort != NULL;
}

/* Creates the stages that draw particles and what is around them. */
static bool init_drawing(struct kiln_stages *s, const struct kiln_techniques *techniques,
                         struct kiln_error *error)
{
    s->lighting = kiln_lighting_create(s->device, &s->moment, s->threads, error);
    if (!s->lighting)
        return false;
    s->particles = kiln_particles_create(s->device, s->scene, &s->atlas, techniques->raster,
                                         s->threads, error);
    if (!s->particles || !init_coarse(s, techniques, error) ||
        !init_scenery(s, techniques->backdrop, error))
        return false;
    s->on_host = techniques->raster == KILN_RASTER_CPU ||
                 kiln_lighting_reads_particles(s->lighting) ||
                 (s->solids && techniques->backdrop == KILN_BACKDROP_CPU);
    return true;
}

/* Creates the stage of gas, if there is gas. */
static bool init_volume(struct kiln_stages *s, enum kiln_march_technique technique,
                        struct kiln_error *error)
{
    if (kiln_volume_domains(s->scene) == 0)
        return true;
    const uint32_t w = s->scene->width, h = s->scene->height;
    kiln_image_init(&s->gas_color, s->device, w, h, GL_RGBA32F, "gas");
    kiln_image_init(&s->gas_depth, s->device, w, h, GL_R32F, "depth of gas");
    s->volume = kiln_volume_create(&s->moment, s->glow, s->threads, error);
    return s->volume &&
           (technique == KILN_MARCH_CPU || kiln_volume_use_gl(s->volume, s->device, error));
}

/* Creates what moments within a step, and frames of several moments, need. */
static bool init_moments(struct kiln_stages *s, const struct kiln_techniques *techniques,
                         struct kiln_error *error)
{
    if (kiln_scene_has_instants_between(s->scene)) {
        const bool in_gl = techniques->simulate != KILN_SIMULATE_CPU;
        s->between = kiln_between_create(s->device, &s->moment, in_gl, s->threads, error);
        if (!s->between)
            return false;
    }
    s->bloom_source = &s->bloom_color;
    if (kiln_scene_moment_count(s->scene) == 1)
        return true;
    const struct kiln_shutter_params params = {.technique = techniques->composite,
                                               .threads = s->threads,
                                               .width = s->scene->width,
                                               .height = s->scene->height};
    s->shutter = kiln_shutter_create(s->device, &params, error);
    if (s->shutter)
        s->bloom_source = kiln_shutter_image(s->shutter, KILN_SHUTTER_BLOOM);
    return s->shutter != NULL;
}

/* Creates the stages that make a picture of the drawn layers. */
static bool init_post(struct kiln_stages *s, const struct kiln_techniques *techniques,
                      struct kiln_output_needs needs, struct kiln_error *error)
{
    if (s->scene->post.bloom != KILN_BLOOM_NONE) {
        const struct kiln_bloom_params params = {.technique = techniques->bloom,
                                                 .threads = s->threads,
                                                 .source = s->bloom_source,
                                                 .format = target_format(s->device)};
        s->bloom = kiln_bloom_create(s->device, s->scene, &params, error);
        if (!s->bloom)
            return false;
    }
    const struct kiln_composite_params params = {.technique = techniques->composite,
                                                 .threads = s->threads,
                                                 .bits = needs.bits ? needs.bits : 8,
                                                 .beauty = needs.layers != KILN_LAYERS_NONE,
                                                 .texture = needs.texture};
    s->composite = kiln_composite_create(s->device, s->scene, &params, error);
    return s->composite != NULL;
}

static bool init_stages(struct kiln_stages *s, const struct kiln_techniques *techniques,
                        struct kiln_output_needs needs, struct kiln_error *error)
{
    return init_sort(s, techniques, error) && init_drawing(s, techniques, error) &&
           init_volume(s, techniques->march, error) && init_moments(s, techniques, error) &&
           init_post(s, techniques, needs, error);
}

bool kiln_stages_init(struct kiln_stages *stages, struct kiln_device *device,
                      const struct kiln_scene *scene, const struct kiln_stages_params *params,
                      struct kiln_error *error)
{
    const struct kiln_output_needs needs = params->needs;
    *stages = (struct kiln_stages){.device = device,
                                   .scene = scene,
                                   .threads = params->threads,
                                   .timer = params->timer,
                                   .caller = params->caller,
                                   .layers = needs.layers == KILN_LAYERS_ALL,
                                   .opaque_systems = opaque_systems(scene),
                                   .glow = needs_glow(scene, needs.layers == KILN_LAYERS_ALL)};
    kiln_buffer_init(&stages->entries, device, params->slot_count * sizeof(uint32_t), "entries");
    if (init_atlas(stages, error) && init_targets(stages, error) &&
        kiln_moment_init(&stages->moment, device, scene, &stages->atlas, error) &&
        init_stages(stages, &params->techniques, needs, error))
        return true;
    kiln_stages_finish(stages);
    return false;
}

/* Adds the images that init_targets makes. An image takes memory when it is first drawn. */
static void add_targets(const struct kiln_scene *scene, bool solids,
                        struct kiln_footprint *footprint)
{
    const uint64_t pixels = (uint64_t)scene->width * scene->height;
    const bool separate = scene->post.compose == KILN_COMPOSE_SEPARATE;
    const bool glows = needs_glow(scene, false) || solids; /* solids draw their glow in any case */
    const uint64_t colors = 2u + solids + separate + glows;
    const uint64_t depths = 1u + solids;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, pixels,
                       colors * 4 * sizeof(float) + depths * sizeof(float));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, pixels, 4 * sizeof(uint8_t));
}

void kiln_stages_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    struct kiln_atlas_request requests[KILN_MAX_SYSTEMS];
    list_requests(scene, requests);
    const uint64_t layers = kiln_atlas_footprint(requests, scene->system_count, footprint);
    const bool solids = opaque_systems(scene) != 0;
    add_targets(scene, solids, footprint);
    kiln_moment_footprint(scene, footprint);
    kiln_lighting_footprint(scene, footprint);
    kiln_backdrop_footprint(scene, footprint);
    if (solids)
        kiln_solids_cpu_footprint(scene, footprint);
    kiln_raster_cpu_footprint(scene, layers, footprint);
    kiln_coarse_footprint(scene, footprint);
    kiln_volume_footprint(scene, footprint);
    if (kiln_scene_moment_count(scene) > 1)
        kiln_shutter_footprint(scene, footprint);
    kiln_bloom_footprint(scene, footprint);
    kiln_composite_footprint(scene, footprint);
}

void kiln_stages_finish(struct kiln_stages *stages)
{
    kiln_composite_destroy(&stages->composite);
    kiln_bloom_destroy(&stages->bloom);
    kiln_shutter_destroy(&stages->shutter);
    kiln_volume_destroy(&stages->volume);
    kiln_solids_destroy(&stages->solids);
    kiln_coarse_destroy(&stages->coarse);
    kiln_particles_destroy(&stages->particles);
    kiln_backdrop_destroy(&stages->backdrop);
    kiln_lighting_destroy(&stages->lighting);
    kiln_sort_destroy(&stages->sort);
    kiln_between_destroy(&stages->between);
    kiln_moment_finish(&stages->moment);
    kiln_framebuffer_finish(&stages->particle_framebuffer);
    kiln_framebuffer_finish(&stages->fire_framebuffer);
    kiln_framebuffer_finish(&stages->smoke_framebuffer);
    struct kiln_image *images[] = {&stages->backdrop_color, &stages->backdrop_depth,
                                   &stages->scene_color,    &stages->scene_depth,
                                   &stages->particle_color, &stages->fire_color,
                                   &stages->smoke_color,    &stages->bloom_color,
                                   &stages->gas_color,      &stages->gas_depth};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        kiln_image_finish(images[i]);
    kiln_atlas_finish(&stages->atlas);
    kiln_buffer_finish(&stages->entries);
}
