/* This file runs the drawing stages of one frame in the order of figure 3.1 of the thesis (Heinz
 * 2019): sort, lighting, backdrop, particles, bloom, composite, and the readback. stages_set_up.c
 * creates them. */
#include "frame/stages.h"

#include "base/error.h"

/* Returns a mask of the systems with a blend mode, without systems of opaque particles. */
static uint64_t transparent_systems(const struct kiln_stages *s, enum kiln_blend blend)
{
    const struct kiln_scene *scene = s->scene;
    uint64_t mask = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (scene->systems[i].enabled && scene->systems[i].look.blend == blend)
            mask |= UINT64_C(1) << i;
    }
    return mask & ~s->opaque_systems;
}

/* Describes a pass that sorts the chosen systems and draws them into a framebuffer. */
struct particle_pass {
    uint64_t systems;
    bool by_depth;
    struct kiln_framebuffer *framebuffer;
    bool keep_bloom; /* do not clear the bloom image */
    bool sum_alpha, fire_covers;
    bool by_fragment;
    float smoke, flame, glow; /* the light of gas that particles cover: struct kiln_tile_gas */
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

/* Begins a pass. Returns false with an error if the caller asks to stop. */
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

/* Runs an expression as a pass, and is its value; false with an error if the caller asks to stop.
 */
#define RUN_PASS(stages, pass, run, error)                                                         \
    (begin_pass((stages), (pass), (error)) && end_pass((stages), (run)))

/* Returns the pool with the particles at the instant that the moment is set to, or NULL with an
 * error. */
static struct kiln_pool *pool_at(struct kiln_stages *s, struct kiln_pool *before,
                                 struct kiln_pool *pool, struct kiln_instant instant,
                                 struct kiln_error *error)
{
    return instant.back > 0.0f ? kiln_between_run(s->between, before, pool, instant, error) : pool;
}

/* Advances the history of a stage that keeps one by the moment. */
static bool advance_history(struct kiln_stages *s, struct kiln_pool *pool, struct kiln_error *error)
{
    const struct kiln_history *history = &s->history;
    if (!history->kind)
        return true;
    const struct kiln_sort_params seen = sort_params(&s->moment.view);
    return RUN_PASS(s, KILN_PASS_sort,
                    history->kind->advance(history->technique, pool, seen.eye, seen.forward, error),
                    error);
}

bool kiln_stages_skip_moment(struct kiln_stages *stages, struct kiln_pool *before,
                             struct kiln_pool *pool, struct kiln_instant instant,
                             struct kiln_error *error)
{
    kiln_moment_set_view(&stages->moment, instant);
    pool = pool_at(stages, before, pool, instant, error);
    return pool && advance_history(stages, pool, error);
}

static bool sort_particles(struct kiln_stages *s, uint64_t systems, bool by_depth, uint32_t *count,
                           struct kiln_error *error)
{
    struct kiln_sort_params params = sort_params(&s->moment.view);
    params.systems = systems;
    params.order = order_of(s, by_depth);
    return RUN_PASS(s, KILN_PASS_sort,
                    kiln_sort_run(s->sort, s->moment.pool, &params, &s->entries, count, error),
                    error);
}

static bool draw_particles(struct kiln_stages *s, struct particle_pass *pass, uint32_t *count,
                           struct kiln_error *error)
{
    if (!sort_particles(s, pass->systems, pass->by_depth, count, error))
        return false;

    const struct kiln_volume_profiles *profiles =
        s->volume ? kiln_volume_profiles(s->volume) : NULL;
    const struct kiln_tile_gas gas = {.profiles = profiles,
                                      .width = s->scene->width,
                                      .height = s->scene->height,
                                      .scale = 1.0f,
                                      .smoke = pass->smoke,
                                      .flame = pass->flame,
                                      .glow = pass->glow};
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
        .gas = profiles ? &gas : NULL,
    };
    if (s->coarse || !kiln_particles_splits(s->particles, &draw, pass->systems))
        pass->covering = NULL;
    if (s->coarse || !kiln_particles_adds_apart(s->particles, &draw))
        pass->added = NULL;
    draw.covering = pass->covering;
    draw.added = pass->added;
    return RUN_PASS(s, KILN_PASS_particles,
                    s->coarse ? kiln_coarse_run(s->coarse, &draw, error)
                              : kiln_particles_run(s->particles, &draw, error),
                    error);
}

/* Draws the solids. Their list is not sorted, since a depth test resolves their order. */
static bool draw_solids(struct kiln_stages *s, uint32_t *count, struct kiln_error *error)
{
    if (!sort_particles(s, s->opaque_systems, false, count, error))
        return false;
    return RUN_PASS(s, KILN_PASS_particles,
                    kiln_solids_draw(s->solids, &s->moment, &s->entries, *count, error), error);
}

/* Draws fire and smoke from one sorted list, or with KILN_COMPOSE_OIT from one list for each pixel.
 * Fire is additive and smoke covers fire and its glow; with KILN_COMPOSE_ALPHA fire covers as well
 * (Heinz 2019, 2.3.1). The smoke layer and the fire layer of an EXR file are drawn in passes of
 * their own where the stage cannot keep them apart. */
static bool draw_merged(struct kiln_stages *s, uint32_t *drawn, struct kiln_error *error)
{
    uint64_t fire = transparent_systems(s, KILN_BLEND_ADD);
    uint64_t smoke = transparent_systems(s, KILN_BLEND_ALPHA);
    bool fire_covers = s->scene->post.compose == KILN_COMPOSE_ALPHA;
    bool by_fragment = s->scene->post.compose == KILN_COMPOSE_OIT && smoke != 0;
    struct particle_pass all = {.systems = fire | smoke,
                                .by_depth = smoke != 0 || fire_covers,
                                .framebuffer = &s->particle_framebuffer,
                                .keep_bloom = s->solids || s->volume,
                                .fire_covers = fire_covers,
                                .by_fragment = by_fragment,
                                .smoke = 1.0f,
                                .flame = 1.0f,
                                .glow = 1.0f,
                                .covering = s->layers ? &s->smoke_color : NULL,
                                .added = s->layers ? &s->fire_color : NULL};
    if (!draw_particles(s, &all, drawn, error))
        return false;
    if (!s->layers)
        return true;

    uint32_t count = 0;
    struct particle_pass smoke_layer = {.systems = smoke,
                                        .by_depth = true,
                                        .smoke = 1.0f,
                                        .framebuffer = &s->smoke_framebuffer,
                                        .by_fragment = by_fragment};
    struct particle_pass fire_layer = {.systems = fire,
                                       .by_depth = fire_covers,
                                       .flame = 1.0f,
                                       .framebuffer = &s->fire_framebuffer,
                                       .fire_covers = fire_covers};
    return (all.covering || draw_particles(s, &smoke_layer, &count, error)) &&
           (all.added || draw_particles(s, &fire_layer, &count, error));
}

/* Draws smoke over the scene, then sums fire in a target of its own, so that it shines through
 * smoke. This is the order of the thesis (Heinz 2019, 3.2.1 and figure 4.3). */
static bool draw_separate(struct kiln_stages *s, uint32_t *drawn, struct kiln_error *error)
{
    struct particle_pass smoke = {.systems = transparent_systems(s, KILN_BLEND_ALPHA),
                                  .by_depth = true,
                                  .smoke = 1.0f,
                                  .framebuffer = &s->particle_framebuffer,
                                  .keep_bloom = s->solids || s->volume};
    struct particle_pass fire = {.systems = transparent_systems(s, KILN_BLEND_ADD),
                                 .framebuffer = &s->fire_framebuffer,
                                 .keep_bloom = true,
                                 .sum_alpha = true};
    uint32_t smoke_count = 0, fire_count = 0;
    bool ok =
        draw_particles(s, &smoke, &smoke_count, error) &&
        (!s->volume || !s->glow ||
         RUN_PASS(s, KILN_PASS_gas,
                  kiln_volume_add_glow(s->volume, KILN_VOLUME_SHINE, &s->bloom_color, true, error),
                  error)) &&
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
                                            first, error) &&
                           (!s->volume || kiln_shutter_add(s->shutter, KILN_SHUTTER_GAS,
                                                           &s->gas_color, weight, first, error))));
}

/* Sets the moment to an instant and its particles, and lights them. Moments of a frame at the same
 * time share all of this but the view. */
static bool fill_moment(struct kiln_stages *s, struct kiln_pool *before, struct kiln_pool *pool,
                        struct kiln_instant instant, bool first, struct kiln_error *error)
{
    s->same_instant = !first && kiln_instants_coincide(instant, s->instant);
    s->instant = instant;
    if (s->same_instant) {
        kiln_moment_set_view(&s->moment, instant);
        return advance_history(s, s->moment.pool, error);
    }
    if (!begin_pass(s, KILN_PASS_lighting, error))
        return false;
    kiln_moment_set_time(&s->moment, instant);
    end_pass(s, true);
    const struct kiln_pool *gas = pool; /* that of the step, since gas has no moments between */
    pool = pool_at(s, before, pool, instant, error);
    return pool && advance_history(s, pool, error) &&
           RUN_PASS(s, KILN_PASS_lighting,
                    kiln_moment_set_particles(&s->moment, pool, s->on_host, error) &&
                        kiln_lighting_run(s->lighting, &s->moment, gas, &s->light, error),
                    error);
}

/* Draws the backdrop and the solid particles over it. The other passes blend particles over the
 * result. */
static bool draw_scenery(struct kiln_stages *s, uint32_t *drawn, struct kiln_error *error)
{
    *drawn = 0;
    return RUN_PASS(s, KILN_PASS_backdrop,
                    kiln_backdrop_draw(s->backdrop, &s->moment, &s->light, error), error) &&
           (!s->solids || draw_solids(s, drawn, error)) &&
           (!s->coarse || RUN_PASS(s, KILN_PASS_particles,
                                   kiln_coarse_prepare(s->coarse, &s->scene_depth, error), error));
}

/* Draws gas, and its glow, before the particles. With `separate` the glow of flames comes later, as
 * that of fire. moment: its number. */
static bool draw_gas(struct kiln_stages *s, const struct kiln_pool *pool, uint32_t moment,
                     struct kiln_error *error)
{
    const enum kiln_volume_light_of glow =
        s->scene->post.compose == KILN_COMPOSE_SEPARATE ? KILN_VOLUME_SMOKE : KILN_VOLUME_ALL;
    const uint64_t sprites =
        transparent_systems(s, KILN_BLEND_ADD) | transparent_systems(s, KILN_BLEND_ALPHA);
    const bool last = moment + 1 == kiln_scene_moment_count(s->scene);
    const struct kiln_volume_draw draw = {.moment = &s->moment,
                                          .pool = pool,
                                          .backdrop = kiln_backdrop_block(s->backdrop),
                                          .lighting = &s->light,
                                          .depth = &s->scene_depth,
                                          .profiles = sprites != 0,
                                          .same = s->same_instant,
                                          .halfway = s->layers && last ? &s->gas_depth : NULL};
    return RUN_PASS(
        s, KILN_PASS_gas,
        kiln_volume_draw(s->volume, &draw, error) &&
            (!s->layers || kiln_volume_write_layer(s->volume, &s->gas_color, error)) &&
            (!s->glow || kiln_volume_add_glow(s->volume, glow, &s->bloom_color, s->solids, error)),
        error);
}

/* Puts gas under the particles of all images that show it: its smoke under smoke, and its flames
 * to fire, where the two are apart. */
static bool put_gas(struct kiln_stages *s, struct kiln_error *error)
{
    const bool separate = s->scene->post.compose == KILN_COMPOSE_SEPARATE;
    const enum kiln_volume_light_of light = separate ? KILN_VOLUME_SMOKE : KILN_VOLUME_ALL;
    return kiln_volume_put_under(s->volume, light, &s->particle_color, error) &&
           ((!separate && !s->layers) ||
            kiln_volume_put_under(s->volume, separate ? KILN_VOLUME_SHINE : KILN_VOLUME_FLAME,
                                  &s->fire_color, error)) &&
           (separate || !s->layers ||
            kiln_volume_put_under(s->volume, KILN_VOLUME_SMOKE, &s->smoke_color, error));
}

/* Brings gas to the host, where light and pictures read it. */
static bool fetch_gas(struct kiln_pool *pool, struct kiln_error *error)
{
    for (uint32_t i = 0; i < pool->gas_count; i++)
        if (!kiln_gas_fetch(&pool->gas[i], error))
            return false;
    return true;
}

bool kiln_stages_draw(struct kiln_stages *stages, struct kiln_pool *before, struct kiln_pool *pool,
                      struct kiln_instant instant, uint32_t moment, uint32_t *drawn,
                      struct kiln_error *error)
{
    struct kiln_stages *s = stages;
    const bool separate = s->scene->post.compose == KILN_COMPOSE_SEPARATE;
    uint32_t solids = 0;
    if ((s->volume && !RUN_PASS(s, KILN_PASS_gas, fetch_gas(pool, error), error)) ||
        !fill_moment(s, before, pool, instant, moment == 0, error) ||
        !draw_scenery(s, &solids, error) || (s->volume && !draw_gas(s, pool, moment, error)))
        return false;
    if (!(separate ? draw_separate(s, drawn, error) : draw_merged(s, drawn, error)))
        return false;
    if (s->volume && !RUN_PASS(s, KILN_PASS_gas, put_gas(s, error), error))
        return false;
    *drawn += solids;
    return !s->shutter || RUN_PASS(s, KILN_PASS_composite, add_moment(s, moment, error), error);
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
        if (!RUN_PASS(s, KILN_PASS_bloom,
                      (inputs.bloom = kiln_bloom_run(s->bloom, &light, &inputs.bloom_scale, error)),
                      error))
            return false;
    }
    return RUN_PASS(s, KILN_PASS_composite, kiln_composite_run(s->composite, &inputs, error),
                    error);
}

/* Numbers the layers of a frame. Those from LAYER_DENSITY on are layers of gas. */
enum {
    LAYER_BEAUTY,
    LAYER_DEPTH,
    LAYER_FIRE,
    LAYER_SMOKE,
    LAYER_BLOOM,
    LAYER_DENSITY,
    LAYER_EMISSION,
    LAYER_HALFWAY,
    LAYER_COUNT
};
static const char *const LAYER_NAMES[LAYER_COUNT] = {
    [LAYER_BEAUTY] = "beauty",
    [LAYER_DEPTH] = "depth",
    [LAYER_FIRE] = "fire",
    [LAYER_SMOKE] = "smoke",
    [LAYER_BLOOM] = "bloom",
    [LAYER_DENSITY] = KILN_LAYER_GAS_DENSITY,
    [LAYER_EMISSION] = "gas.emission",
    [LAYER_HALFWAY] = "gas.depth",
};
static const uint32_t LAYER_CHANNELS[LAYER_COUNT] = {4, 1, 4, 4, 4, 1, 4, 1};

uint32_t kiln_stages_layers(bool gas, const char *names[KILN_MAX_LAYERS],
                            uint32_t channels[KILN_MAX_LAYERS])
{
    const uint32_t count = gas ? LAYER_COUNT : LAYER_DENSITY;
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

/* Holds the image of gas, and the layers that it is parted into. */
struct gas_layers {
    const float *gas;
    float *density, *emission;
};

static void part_gas(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct gas_layers *layers = context;
    for (size_t i = begin; i < end; i++) {
        const float *pixel = layers->gas + 4 * i;
        layers->density[i] = pixel[3];
        for (size_t c = 0; c < 3; c++)
            layers->emission[4 * i + c] = pixel[c];
        layers->emission[4 * i + 3] = 0.0f; /* light that hides nothing, as the layer `fire` */
    }
}

static bool read_gas_layers(struct kiln_stages *s, struct kiln_picture *picture,
                            struct kiln_error *error)
{
    struct kiln_image *image =
        s->shutter ? kiln_shutter_image(s->shutter, KILN_SHUTTER_GAS) : &s->gas_color;
    struct gas_layers layers = {.gas = kiln_image_host(image, KILN_READ, error),
                                .density = picture->layers[LAYER_DENSITY].pixels,
                                .emission = picture->layers[LAYER_EMISSION].pixels};
    const size_t pixels = (size_t)image->width * image->height;
    return layers.gas &&
           kiln_threads_try(s->threads, pixels, (size_t)1 << 14, part_gas, &layers, error) &&
           read_layer(s, &s->gas_depth, true, &picture->layers[LAYER_HALFWAY], error);
}

static bool read_layers(struct kiln_stages *s, struct kiln_picture *picture,
                        struct kiln_error *error)
{
    struct kiln_image *sources[] = {
        [LAYER_BEAUTY] = NULL,           [LAYER_DEPTH] = &s->scene_depth,
        [LAYER_FIRE] = &s->fire_color,   [LAYER_SMOKE] = smoke_layer(s),
        [LAYER_BLOOM] = s->bloom_source,
    };
    if (s->shutter) { /* depths have no mean: those of the last moment are those of a pinhole */
        sources[LAYER_FIRE] = kiln_shutter_image(s->shutter, KILN_SHUTTER_FIRE);
        sources[LAYER_SMOKE] = kiln_shutter_image(s->shutter, KILN_SHUTTER_SMOKE);
    }
    if (!kiln_composite_take_beauty(s->composite, &picture->layers[LAYER_BEAUTY].pixels, error))
        return false;
    for (uint32_t i = LAYER_DEPTH; i < LAYER_DENSITY && i < picture->layer_count; i++) {
        /* depths may be kept for the next frame */
        const bool drawn_anew = !s->shutter && i != LAYER_DEPTH;
        if (!read_layer(s, sources[i], drawn_anew, &picture->layers[i], error))
            return false;
    }
    return picture->layer_count <= LAYER_DENSITY || read_gas_layers(s, picture, error);
}

static bool read_picture(struct kiln_stages *s, struct kiln_picture *picture,
                         struct kiln_error *error)
{
    return (picture->bits == 0 ||
            kiln_composite_read_display(s->composite, picture->display, error)) &&
           (picture->layer_count == 0 || read_layers(s, picture, error));
}

bool kiln_stages_read(struct kiln_stages *stages, struct kiln_picture *picture,
                      struct kiln_error *error)
{
    return RUN_PASS(stages, KILN_PASS_readback, read_picture(stages, picture, error), error);
}
