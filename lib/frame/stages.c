/* This file runs the drawing stages of one frame in the order of figure 3.1 of the thesis (Heinz
 * 2019): sort, lighting, backdrop, particles, bloom, composite, and the readback. */
#include "frame/stages.h"

#include <string.h>

#include "base/cache.h"
#include "base/error.h"

/* Returns the format of the render targets. Blending into 16-bit floats makes the result darker by
 * rounding. Targets of 32-bit floats avoid that; they are used on software devices, where they cost
 * nothing. */
static GLenum target_format(const struct kiln_device *device)
{
    return !device || device->info.software ? GL_RGBA32F : GL_RGBA16F;
}

static uint32_t opaque_systems(const struct kiln_scene *scene)
{
    uint32_t mask = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (scene->systems[i].enabled && kiln_look_is_opaque(&scene->systems[i].look))
            mask |= 1u << i;
    }
    return mask;
}

/* Returns a mask of the systems with a blend mode, without systems of opaque particles. */
static uint32_t transparent_systems(const struct kiln_scene *scene, enum kiln_blend blend)
{
    uint32_t mask = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (scene->systems[i].enabled && scene->systems[i].look.blend == blend)
            mask |= 1u << i;
    }
    return mask & ~opaque_systems(scene);
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

static bool init_atlas(struct kiln_stages *s, struct kiln_error *error)
{
    static const char *const plain = "builtin:spark";
    struct kiln_atlas_request requests[KILN_MAX_SYSTEMS];
    for (uint32_t i = 0; i < s->scene->system_count; i++) {
        const struct kiln_look *look = &s->scene->systems[i].look;
        requests[i] =
            (struct kiln_atlas_request){.sources = look->atlas,
                                        .count = look->atlas_count,
                                        .columns = look->columns,
                                        .rows = look->rows,
                                        .motion = look->motion,
                                        .motion_full = {look->motion_full[0], look->motion_full[1]},
                                        .loader = s->scene->loader};
        if (look->shape != KILN_SHAPE_BILLBOARD) /* such particles show no texture and get the
                                                  * smallest one */
            requests[i] = (struct kiln_atlas_request){
                .sources = &plain, .count = 1, .columns = 1, .rows = 1, .motion = "none"};
    }
    char cache[KILN_PATH_SIZE];
    const bool cached = kiln_cache_folder(cache);
    return kiln_atlas_init(&s->atlas, s->device, requests, s->scene->system_count,
                           cached ? cache : NULL, s->threads, error);
}

/* Returns the image that the bloom stage blurs. */
static struct kiln_image *bloom_source(struct kiln_stages *s)
{
    return s->shutter ? kiln_shutter_image(s->shutter, KILN_SHUTTER_BLOOM) : &s->bloom_color;
}

/* Creates the backdrop stage, and the solids stage if the scene has opaque particles. Without
 * solids, the backdrop draws into the scene's images. With solids, it draws into images of its own,
 * and the solids stage draws the scene's images from them. */
static bool init_scenery(struct kiln_stages *s, enum kiln_backdrop_technique technique,
                         struct kiln_error *error)
{
    bool solids = opaque_systems(s->scene) != 0;
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

static bool init_stages(struct kiln_stages *s, const struct kiln_techniques *techniques,
                        struct kiln_output_needs needs, struct kiln_error *error)
{
    struct kiln_device *device = s->device;
    s->sort = techniques->sort_spread > 0
                  ? kiln_sort_create_spread(device, techniques->sort_spread, s->threads, error)
                  : kiln_sort_create(device, techniques->sort, s->threads, error);
    if (!s->sort)
        return false;
    s->lighting = kiln_lighting_create(device, &s->moment, s->threads, error);
    if (!s->lighting)
        return false;
    s->particles =
        kiln_particles_create(device, s->scene, &s->atlas, techniques->raster, s->threads, error);
    if (!s->particles || !init_coarse(s, techniques, error) ||
        !init_scenery(s, techniques->backdrop, error))
        return false;
    s->on_host = techniques->raster == KILN_RASTER_CPU ||
                 kiln_lighting_reads_particles(s->lighting) ||
                 (s->solids && techniques->backdrop == KILN_BACKDROP_CPU);
    if (kiln_scene_has_instants_between(s->scene)) {
        const bool in_gl = techniques->simulate != KILN_SIMULATE_CPU;
        s->between = kiln_between_create(device, &s->moment, in_gl, s->threads, error);
        if (!s->between)
            return false;
    }
    if (kiln_scene_moment_count(s->scene) > 1) {
        s->shutter =
            kiln_shutter_create(device,
                                &(struct kiln_shutter_params){.technique = techniques->composite,
                                                              .threads = s->threads,
                                                              .width = s->scene->width,
                                                              .height = s->scene->height},
                                error);
        if (!s->shutter)
            return false;
    }
    if (s->scene->post.bloom != KILN_BLOOM_NONE) {
        s->bloom = kiln_bloom_create(device, s->scene,
                                     &(struct kiln_bloom_params){.technique = techniques->bloom,
                                                                 .threads = s->threads,
                                                                 .source = bloom_source(s),
                                                                 .format = target_format(device)},
                                     error);
        if (!s->bloom)
            return false;
    }
    s->composite = kiln_composite_create(
        device, s->scene,
        &(struct kiln_composite_params){.technique = techniques->composite,
                                        .threads = s->threads,
                                        .bits = needs.bits ? needs.bits : 8,
                                        .beauty = needs.layers != KILN_LAYERS_NONE,
                                        .texture = needs.texture},
        error);
    return s->composite != NULL;
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
                                   .glow = needs_glow(scene, needs.layers == KILN_LAYERS_ALL)};
    kiln_buffer_init(&stages->entries, device, params->slot_count * sizeof(uint32_t), "entries");
    if (init_atlas(stages, error) && init_targets(stages, error) &&
        kiln_moment_init(&stages->moment, device, scene, &stages->atlas, error) &&
        init_stages(stages, &params->techniques, needs, error))
        return true;
    kiln_stages_finish(stages);
    return false;
}

void kiln_stages_finish(struct kiln_stages *stages)
{
    kiln_composite_destroy(&stages->composite);
    kiln_bloom_destroy(&stages->bloom);
    kiln_shutter_destroy(&stages->shutter);
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
                                   &stages->smoke_color,    &stages->bloom_color};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        kiln_image_finish(images[i]);
    kiln_atlas_finish(&stages->atlas);
    kiln_buffer_finish(&stages->entries);
}

/* Describes a pass that sorts the chosen systems and draws them into a framebuffer. */
struct particle_pass {
    uint32_t systems;
    bool by_depth;
    struct kiln_framebuffer *framebuffer;
    bool keep_bloom; /* do not clear the bloom image */
    bool sum_alpha, fire_covers;
    bool by_fragment;
    /* NULL, or for the colour of covering and of additive particles alone; become NULL if they need
     * passes of their own */
    struct kiln_image *covering, *added;
};

/* Returns the sort order of a pass. Particles whose blending does not depend on the order are not
 * sorted. */
static enum kiln_sort_order order_of(const struct kiln_stages *s, bool by_depth)
{
    if (!by_depth)
        return KILN_SORT_BY_SERIAL;
    return kiln_particles_nearest_first(s->particles) ? KILN_SORT_FRONT_TO_BACK
                                                      : KILN_SORT_BACK_TO_FRONT;
}

static struct kiln_sort_params sort_params(const struct kiln_view *view)
{
    return (struct kiln_sort_params){
        .eye = {view->eye.x, view->eye.y, view->eye.z},
        .forward = kiln_view_forward(view),
    };
}

/* Begins a pass. Returns false if the caller asks to stop. */
static bool begin_pass(struct kiln_stages *s, enum kiln_pass pass, struct kiln_error *error)
{
    if (!kiln_may_go_on(s->caller, error))
        return false;
    kiln_timer_begin(s->timer, pass);
    return true;
}

/* Ends the open pass, also if it failed, and returns ok. */
static bool end_pass(struct kiln_stages *s, bool ok)
{
    kiln_timer_end(s->timer);
    return ok;
}

/* Returns the pool with the particles at an instant, or NULL with an error. */
static struct kiln_pool *pool_at(struct kiln_stages *s, struct kiln_pool *before,
                                 struct kiln_pool *pool, struct kiln_instant instant,
                                 struct kiln_error *error)
{
    return instant.back > 0.0f ? kiln_between_run(s->between, before, pool, instant, error) : pool;
}

/* Updates the order that the sort keeps, if it does. */
static bool advance_sort(struct kiln_stages *s, struct kiln_pool *pool, struct kiln_instant instant,
                         struct kiln_error *error)
{
    const struct kiln_view view = kiln_view_compute(s->scene, instant);
    const struct kiln_sort_params params = sort_params(&view);
    return begin_pass(s, KILN_PASS_sort, error) &&
           end_pass(s, kiln_sort_advance(s->sort, pool, &params, error));
}

bool kiln_stages_skip_moment(struct kiln_stages *stages, struct kiln_pool *before,
                             struct kiln_pool *pool, struct kiln_instant instant,
                             struct kiln_error *error)
{
    pool = pool_at(stages, before, pool, instant, error);
    return pool && advance_sort(stages, pool, instant, error);
}

static bool sort_particles(struct kiln_stages *s, uint32_t systems, bool by_depth, uint32_t *count,
                           struct kiln_error *error)
{
    struct kiln_sort_params params = sort_params(&s->moment.view);
    params.systems = systems;
    params.order = order_of(s, by_depth);
    return begin_pass(s, KILN_PASS_sort, error) &&
           end_pass(s, kiln_sort_run(s->sort, s->moment.pool, &params, &s->entries, count, error));
}

static bool draw_particles(struct kiln_stages *s, struct particle_pass *pass, uint32_t *count,
                           struct kiln_error *error)
{
    if (!sort_particles(s, pass->systems, pass->by_depth, count, error))
        return false;

    struct kiln_particles_draw draw = {
        .moment = &s->moment,
        .entries = &s->entries,
        .count = *count,
        .view = &s->moment.view,
        .backdrop = kiln_backdrop_block(s->backdrop),
        .lighting = &s->light,
        .depth = &s->scene_depth,
        .framebuffer = pass->framebuffer,
        .keep_bloom = pass->keep_bloom,
        .sum_alpha = pass->sum_alpha,
        .fire_covers = pass->fire_covers,
        .by_fragment = pass->by_fragment,
    };
    if (s->coarse || !kiln_particles_splits(s->particles, &draw, pass->systems))
        pass->covering = NULL;
    if (s->coarse || !kiln_particles_adds_apart(s->particles, &draw))
        pass->added = NULL;
    draw.covering = pass->covering;
    draw.added = pass->added;
    return begin_pass(s, KILN_PASS_particles, error) &&
           end_pass(s, s->coarse ? kiln_coarse_run(s->coarse, &draw, error)
                                 : kiln_particles_run(s->particles, &draw, error));
}

/* Draws the solids. Their list is not sorted, since a depth test resolves their order. */
static bool draw_solids(struct kiln_stages *s, uint32_t *count, struct kiln_error *error)
{
    if (!sort_particles(s, opaque_systems(s->scene), false, count, error))
        return false;
    return begin_pass(s, KILN_PASS_particles, error) &&
           end_pass(s, kiln_solids_draw(s->solids, &s->moment, &s->entries, *count, error));
}

/* Draws fire and smoke from one sorted list, or with KILN_COMPOSE_OIT from one list for each pixel.
 * Fire is additive and smoke covers fire and its glow; with KILN_COMPOSE_ALPHA fire covers as well
 * (Heinz 2019, 2.3.1). The smoke layer and the fire layer of an EXR file are drawn in passes of
 * their own where the stage cannot keep them apart. */
static bool draw_merged(struct kiln_stages *s, uint32_t *drawn, struct kiln_error *error)
{
    uint32_t fire = transparent_systems(s->scene, KILN_BLEND_ADD);
    uint32_t smoke = transparent_systems(s->scene, KILN_BLEND_ALPHA);
    bool fire_covers = s->scene->post.compose == KILN_COMPOSE_ALPHA;
    bool by_fragment = s->scene->post.compose == KILN_COMPOSE_OIT && smoke != 0;
    struct particle_pass all = {.systems = fire | smoke,
                                .by_depth = smoke != 0 || fire_covers,
                                .framebuffer = &s->particle_framebuffer,
                                .keep_bloom = s->solids != NULL,
                                .fire_covers = fire_covers,
                                .by_fragment = by_fragment,
                                .covering = s->layers ? &s->smoke_color : NULL,
                                .added = s->layers ? &s->fire_color : NULL};
    if (!draw_particles(s, &all, drawn, error))
        return false;
    if (!s->layers)
        return true;

    uint32_t count = 0;
    struct particle_pass smoke_layer = {.systems = smoke,
                                        .by_depth = true,
                                        .framebuffer = &s->smoke_framebuffer,
                                        .by_fragment = by_fragment};
    struct particle_pass fire_layer = {.systems = fire,
                                       .by_depth = fire_covers,
                                       .framebuffer = &s->fire_framebuffer,
                                       .fire_covers = fire_covers};
    return (all.covering || draw_particles(s, &smoke_layer, &count, error)) &&
           (all.added || draw_particles(s, &fire_layer, &count, error));
}

/* Draws smoke over the scene, then sums fire in a target of its own, so that it shines through
 * smoke. This is the order of the thesis (Heinz 2019, 3.2.1 and figure 4.3). */
static bool draw_separate(struct kiln_stages *s, uint32_t *drawn, struct kiln_error *error)
{
    struct particle_pass smoke = {.systems = transparent_systems(s->scene, KILN_BLEND_ALPHA),
                                  .by_depth = true,
                                  .framebuffer = &s->particle_framebuffer,
                                  .keep_bloom = s->solids != NULL};
    struct particle_pass fire = {.systems = transparent_systems(s->scene, KILN_BLEND_ADD),
                                 .framebuffer = &s->fire_framebuffer,
                                 .keep_bloom = true,
                                 .sum_alpha = true};
    uint32_t smoke_count = 0, fire_count = 0;
    bool ok = draw_particles(s, &smoke, &smoke_count, error) &&
              draw_particles(s, &fire, &fire_count, error);
    *drawn = smoke_count + fire_count;
    return ok;
}

/* Returns the images of the moment that was drawn last. */
static struct kiln_composite_inputs moment_inputs(struct kiln_stages *s)
{
    bool separate = s->scene->post.compose == KILN_COMPOSE_SEPARATE;
    return (struct kiln_composite_inputs){
        .scene = &s->scene_color,
        .particles = &s->particle_color,
        .fire = separate ? &s->fire_color : NULL,
    };
}

/* Returns the image of the smoke layer. */
static struct kiln_image *smoke_layer(struct kiln_stages *s)
{
    bool separate = s->scene->post.compose == KILN_COMPOSE_SEPARATE;
    return separate ? &s->particle_color : &s->smoke_color;
}

/* Adds the images of the moment to the shutter's sums for its frame. */
static bool add_moment(struct kiln_stages *s, uint32_t moment, struct kiln_error *error)
{
    float weight = 1.0f / (float)kiln_scene_moment_count(s->scene);
    bool first = moment == 0;
    const struct kiln_composite_inputs inputs = moment_inputs(s);
    return kiln_shutter_add_composed(s->shutter, &inputs, weight, first, error) &&
           (!s->glow || kiln_shutter_add(s->shutter, KILN_SHUTTER_BLOOM, &s->bloom_color, weight,
                                         first, error)) &&
           (!s->layers || (kiln_shutter_add(s->shutter, KILN_SHUTTER_FIRE, &s->fire_color, weight,
                                            first, error) &&
                           kiln_shutter_add(s->shutter, KILN_SHUTTER_SMOKE, smoke_layer(s), weight,
                                            first, error)));
}

/* Fills the moment with the particles of an instant, and lights them. Moments of a frame at the
 * same time share both, since they differ only in the view. */
static bool fill_moment(struct kiln_stages *s, struct kiln_pool *before, struct kiln_pool *pool,
                        struct kiln_instant instant, bool first, struct kiln_error *error)
{
    const bool shared = !first && kiln_instants_coincide(instant, s->instant);
    s->instant = instant;
    if (shared) {
        kiln_moment_look_through(&s->moment, instant);
        return advance_sort(s, s->moment.pool, instant, error);
    }
    pool = pool_at(s, before, pool, instant, error);
    if (!pool || !advance_sort(s, pool, instant, error) ||
        !begin_pass(s, KILN_PASS_lighting, error))
        return false;
    return end_pass(s, kiln_moment_fill(&s->moment, pool, instant, s->on_host, error) &&
                           kiln_lighting_run(s->lighting, &s->moment, &s->light, error));
}

/* Draws the backdrop and the solid particles over it. The other passes blend particles over the
 * result. */
static bool draw_scenery(struct kiln_stages *s, uint32_t *drawn, struct kiln_error *error)
{
    *drawn = 0;
    if (!begin_pass(s, KILN_PASS_backdrop, error) ||
        !end_pass(s, kiln_backdrop_draw(s->backdrop, &s->moment, &s->light, error)) ||
        (s->solids && !draw_solids(s, drawn, error)))
        return false;
    return !s->coarse || (begin_pass(s, KILN_PASS_particles, error) &&
                          end_pass(s, kiln_coarse_prepare(s->coarse, &s->scene_depth, error)));
}

bool kiln_stages_draw(struct kiln_stages *stages, struct kiln_pool *before, struct kiln_pool *pool,
                      struct kiln_instant instant, uint32_t moment, uint32_t *drawn,
                      struct kiln_error *error)
{
    struct kiln_stages *s = stages;
    const bool separate = s->scene->post.compose == KILN_COMPOSE_SEPARATE;
    uint32_t solids = 0;
    if (!fill_moment(s, before, pool, instant, moment == 0, error) ||
        !draw_scenery(s, &solids, error))
        return false;
    if (!(separate ? draw_separate(s, drawn, error) : draw_merged(s, drawn, error)))
        return false;
    *drawn += solids;
    return !s->shutter ||
           (begin_pass(s, KILN_PASS_composite, error) && end_pass(s, add_moment(s, moment, error)));
}

bool kiln_stages_keep_history(const struct kiln_stages *stages)
{
    return kiln_sort_keeps_history(stages->sort);
}

bool kiln_stages_compose(struct kiln_stages *stages, uint32_t frame, struct kiln_error *error)
{
    struct kiln_stages *s = stages;
    struct kiln_composite_inputs inputs = moment_inputs(s);
    if (s->shutter)
        inputs = (struct kiln_composite_inputs){
            .scene = kiln_shutter_image(s->shutter, KILN_SHUTTER_COMPOSED)};
    inputs.frame = frame;
    inputs.time_s = kiln_scene_instant_time(s->scene, kiln_scene_instant(s->scene, frame, 0));
    if (s->bloom) {
        const struct kiln_bloom_inputs light = {inputs.scene, inputs.particles, inputs.fire,
                                                inputs.time_s};
        if (!begin_pass(s, KILN_PASS_bloom, error))
            return false;
        inputs.bloom = kiln_bloom_run(s->bloom, &light, &inputs.bloom_scale, error);
        if (!end_pass(s, inputs.bloom != NULL))
            return false;
    }
    return begin_pass(s, KILN_PASS_composite, error) &&
           end_pass(s, kiln_composite_run(s->composite, &inputs, error));
}

static const char *const LAYER_NAMES[] = {"beauty", "depth", "fire", "smoke", "bloom"};
static const uint32_t LAYER_CHANNELS[] = {4, 1, 4, 4, 4};

uint32_t kiln_stages_layers(const char *names[KILN_MAX_LAYERS], uint32_t channels[KILN_MAX_LAYERS])
{
    uint32_t count = sizeof LAYER_CHANNELS / sizeof *LAYER_CHANNELS;
    for (uint32_t i = 0; i < count; i++) {
        names[i] = LAYER_NAMES[i];
        channels[i] = LAYER_CHANNELS[i];
    }
    return count;
}

/* Gives a layer the pixels of an image: the memory itself where each frame draws the image anew. */
static bool read_layer(struct kiln_stages *s, struct kiln_image *image, bool drawn_anew,
                       struct kiln_layer *layer, struct kiln_error *error)
{
    const float *pixels = kiln_image_host(image, KILN_READ, error);
    if (!pixels)
        return false;
    if (drawn_anew && !image->device) {
        kiln_image_exchange(image, &layer->pixels);
        return true;
    }
    size_t floats = (size_t)image->width * image->height * layer->channels;
    return kiln_threads_copy(s->threads, layer->pixels, pixels, floats * sizeof(float), error);
}

static bool read_layers(struct kiln_stages *s, struct kiln_picture *picture,
                        struct kiln_error *error)
{
    struct kiln_image *sources[] = {NULL, &s->scene_depth, &s->fire_color, smoke_layer(s),
                                    bloom_source(s)};
    if (s->shutter) { /* depths have no mean: those of the last moment are those of a pinhole */
        sources[2] = kiln_shutter_image(s->shutter, KILN_SHUTTER_FIRE);
        sources[3] = kiln_shutter_image(s->shutter, KILN_SHUTTER_SMOKE);
    }
    if (!kiln_composite_take_beauty(s->composite, &picture->layers[0].pixels, error))
        return false;
    for (uint32_t i = 1; i < picture->layer_count; i++) {
        const bool drawn_anew = !s->shutter && i > 1; /* depths may be kept for the next frame */
        if (!read_layer(s, sources[i], drawn_anew, &picture->layers[i], error))
            return false;
    }
    return true;
}

bool kiln_stages_read(struct kiln_stages *stages, struct kiln_picture *picture,
                      struct kiln_error *error)
{
    if (!begin_pass(stages, KILN_PASS_readback, error))
        return false;
    bool ok = picture->bits == 0 ||
              kiln_composite_read_display(stages->composite, picture->display, error);
    return end_pass(stages,
                    ok && (picture->layer_count == 0 || read_layers(stages, picture, error)));
}
