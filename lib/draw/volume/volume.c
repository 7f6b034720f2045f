/* This file runs the stage that draws gas. For each domain it copies the gas that is seen to
 * blocks, lights them, lists the tiles of the picture that they touch, and marches through these
 * tiles. Domains are drawn from the farthest to the nearest. */
#include "draw/volume/volume.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/pages.h"
#include "draw/volume/volume_cast.h"
#include "draw/volume/volume_glow.h"
#include "draw/volume/volume_lamps.h"
#include "draw/volume/volume_march.h"
#include "draw/volume/volume_order.h"
#include "draw/volume/volume_put.h"
#include "draw/volume/volume_shade.h"

struct kiln_volume_stage {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    enum kiln_simd simd;
    struct kiln_observer observer;
    struct kiln_flame_colors colors[KILN_MAX_GAS];
    struct kiln_sun_shade *shade; /* NULL: there are no objects */
    struct kiln_volume_lamp lamps[KILN_MOST_LAMPS];
    struct kiln_volume_field field; /* of the domain that is being drawn, as all that follows */
    bool lit;                       /* the field is whole, with its light */
    struct kiln_volume_slices slices;
    struct kiln_volume_glow glow;
    struct kiln_volume_tiles tiles;
    struct kiln_volume_gl *gl; /* NULL: the host marches */
    uint8_t *touched;          /* of each tile: gas was drawn there */
    struct kiln_volume_planes planes;
    float *grid;   /* rays of every second pixel of every second row; NULL: no domain has it */
    float *passed; /* optical depth of the domains before one, of each pixel; NULL until needed */
    struct kiln_volume_profiles profiles;
    struct kiln_volume_costs costs;
    struct kiln_volume_counts counts;
    double lap_s; /* processor time at the last call of end_lap */
    uint32_t width, height;
};

/* Adds the processor time since the last call to a cost. */
static void end_lap(struct kiln_volume_stage *s, double *cost_s)
{
    const double now_s = kiln_clock_cpu_seconds();
    *cost_s += now_s - s->lap_s;
    s->lap_s = now_s;
}

static size_t tile_count(const struct kiln_scene *scene)
{
    return (size_t)kiln_tiles_along(scene->width) * kiln_tiles_along(scene->height);
}

struct kiln_volume_stage *kiln_volume_create(const struct kiln_moment *moment, bool glow,
                                             struct kiln_threads *threads, struct kiln_error *error)
{
    const struct kiln_scene *scene = moment->scene;
    const size_t plane = 4 * sizeof(float) * (size_t)scene->width * scene->height;
    struct kiln_volume_stage *stage = calloc(1, sizeof *stage);
    if (stage) {
        stage->scene = scene;
        stage->threads = threads;
        stage->simd = moment->simd;
        stage->width = scene->width;
        stage->height = scene->height;
        stage->planes.smoke = kiln_alloc_pages(plane);
        stage->planes.flame = kiln_alloc_pages(plane);
        stage->planes.glow = glow ? kiln_alloc_pages(plane) : NULL;
        stage->grid =
            kiln_volume_grid_of(scene) > 0 ? kiln_alloc_pages(kiln_volume_grid_of(scene)) : NULL;
        stage->touched = malloc(tile_count(scene));
        kiln_observer_fill(&stage->observer);
    }
    if (stage && scene->backdrop.object_count > 0)
        stage->shade = kiln_sun_shade_create(scene, error);
    if (!stage || (scene->backdrop.object_count > 0 && !stage->shade) || !stage->planes.smoke ||
        !stage->planes.flame || !stage->touched || (glow && !stage->planes.glow) ||
        (kiln_volume_grid_of(scene) > 0 && !stage->grid)) {
        kiln_error_no_memory(error, "drawn gas");
        kiln_volume_destroy(&stage);
    }
    return stage;
}

bool kiln_volume_use_gl(struct kiln_volume_stage *stage, struct kiln_device *device,
                        struct kiln_error *error)
{
    stage->gl = kiln_volume_gl_create(device, stage->width, stage->height, error);
    return stage->gl != NULL;
}

void kiln_volume_destroy(struct kiln_volume_stage **stage)
{
    struct kiln_volume_stage *s = *stage;
    if (!s)
        return;
    kiln_volume_field_finish(&s->field);
    kiln_volume_glow_finish(&s->glow);
    kiln_volume_tiles_finish(&s->tiles);
    kiln_volume_gl_destroy(&s->gl);
    kiln_volume_profiles_finish(&s->profiles);
    kiln_sun_shade_destroy(&s->shade);
    free(s->slices.floats);
    free(s->planes.smoke);
    free(s->planes.flame);
    free(s->planes.glow);
    free(s->passed);
    free(s->grid);
    free(s->touched);
    free(s);
    *stage = NULL;
}

/* ---- light ----------------------------------------------------------------------------------- */

/* Holds what a domain is drawn with: numbers of its look at the moment, and its place. */
struct domain {
    struct kiln_volume_march march;
    struct kiln_volume_light light;
    struct kiln_volume_frame frame;
    float sky[3];                   /* radiance of the whole sky, averaged */
    float glow;                     /* factor on the light of flames in their smoke */
    struct kiln_volume_shade shade; /* what is in the way of sun and sky beside its own smoke */
    const struct kiln_volume_lamp *lamps;
    uint32_t lamp_count;
};

struct finish_job {
    struct kiln_volume_stage *stage;
    const struct domain *domain;
    const struct kiln_volume_light_rows *rows;
    bool lit; /* by flames */
};

/* Adds the light of a lamp to a block. */
static void light_block(const struct finish_job *job, struct kiln_gas_place brick,
                        const struct kiln_volume_lamp *lamp, float *block)
{
    alignas(64) float parts[VOLUME_PLACES];
    const bool clear = kiln_volume_lamp_is_clear(lamp);
    kiln_volume_lamp_reach *reach = KILN_SIMD_PICK(kiln_volume_lamp_reach, job->stage->simd);
    if (!clear)
        reach(lamp, &job->domain->frame, brick, parts);
    job->rows->add_lamp(&job->domain->frame, brick, lamp->light, clear ? NULL : parts, block);
}

/* Turns the part of the sky's light, and the light of flames, to the radiance that reaches each
 * cell from all sides. */
static void finish_blocks(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct finish_job *job = context;
    const struct kiln_volume_field *field = &job->stage->field;
    const struct kiln_volume_glow *glow = &job->stage->glow;
    const float *sky = job->domain->sky,
                intensity = job->domain->glow * job->domain->march.intensity;
    for (size_t i = begin; i < end; i++) {
        const struct kiln_gas_place brick = kiln_volume_place(field, (uint32_t)i);
        float *block = kiln_volume_block(field, (uint32_t)i);
        kiln_volume_shade_block(&job->domain->shade, &job->domain->frame, brick, block);
        for (int32_t k = 0; k < GAS_BRICK_CELLS; k++) {
            const int32_t x = k % GAS_BRICK, y = k / GAS_BRICK % GAS_BRICK;
            const int32_t z = k / (GAS_BRICK * GAS_BRICK);
            float *cell = kiln_volume_cell(block, x, y, z);
            const float above = cell[VOLUME_RED];
            float fire = 0.0f;
            if (job->lit)
                fire = intensity * kiln_volume_glow_at(glow, brick.x * GAS_BRICK + x,
                                                       brick.y * GAS_BRICK + y,
                                                       brick.z * GAS_BRICK + z);
            for (int c = 0; c < 3; c++)
                cell[VOLUME_RED + c] = above * sky[c] + fire * glow->color[c];
        }
        for (uint32_t n = 0; n < job->domain->lamp_count; n++)
            light_block(job, brick, &job->domain->lamps[n], block);
    }
}

static bool light_domain(struct kiln_volume_stage *s, const struct domain *domain,
                         const struct kiln_gas *gas, struct kiln_error *error)
{
    const struct kiln_volume_march *m = &domain->march;
    struct finish_job job = {
        .stage = s, .domain = domain, .rows = KILN_SIMD_PICK(kiln_volume_light_rows, s->simd)};
    const float edge =
        0.03f / 3.0f * (float)(gas->shape.cells.x + gas->shape.cells.y + gas->shape.cells.z);
    struct kiln_volume_fire fire = {.colors = m->colors,
                                    .thickness = domain->light.thickness,
                                    .cell_m = m->cell_m,
                                    .reach_m = edge * m->cell_m};
    kiln_gas_closed(gas, fire.closed);
    if (!kiln_volume_light_run(&s->slices, &s->field, &domain->light, job.rows, s->threads, error))
        return false;
    end_lap(s, &s->costs.light_s);
    if (domain->glow * m->intensity > 0.0f &&
        !kiln_volume_glow_run(&s->glow, &s->field, &fire,
                              KILN_SIMD_PICK(kiln_volume_glow_rows, s->simd), s->threads, &job.lit,
                              error))
        return false;
    end_lap(s, &s->costs.glow_s);
    kiln_threads_for(s->threads, s->field.count, 8, finish_blocks, &job);
    kiln_volume_field_join(&s->field, s->threads);
    end_lap(s, &s->costs.light_s);
    return true;
}

/* ---- domains --------------------------------------------------------------------------------- */

/* Sets how rays of the view run through the window of a domain. */
static void place_rays(const struct kiln_scene *scene, const struct kiln_gas_domain *d,
                       const struct kiln_gas *gas, const struct kiln_moment *moment,
                       struct domain *to)
{
    struct kiln_volume_march *m = &to->march;
    const struct kiln_view *view = &moment->view;
    const float time_s = view->clock.x, cell = gas->shape.cell;
    const float3 first = {gas->shape.corner.x + cell * (float)gas->at.x,
                          gas->shape.corner.y + cell * (float)gas->at.y,
                          gas->shape.corner.z + cell * (float)gas->at.z};
    const float3 corner = kiln_attached_point(scene, &d->attach, first, time_s);
    float axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    kiln_attached_rotation(scene, &d->attach, axes, time_s);
    m->cell_m = kiln_attached_length(scene, &d->attach, cell, time_s);
    to->frame =
        (struct kiln_volume_frame){.corner = {corner.x, corner.y, corner.z}, .cell_m = m->cell_m};
    const float a_metre = 1.0f / m->cell_m;
    const float4 *rows = view->world_to_view;
    const float3 eye = {view->eye.x - corner.x, view->eye.y - corner.y, view->eye.z - corner.z};
    const float3 sun = moment->sun.towards;
    for (int i = 0; i < 3; i++) {
        const float3 axis = {axes[i][0], axes[i][1], axes[i][2]};
        for (int c = 0; c < 3; c++) {
            to->frame.edges[i][c] = m->cell_m * axes[i][c];
            m->world[c][i] = axes[i][c];
        }
        m->eye[i] = a_metre * float3_dot(axis, eye);
        m->right[i] = a_metre * (axis.x * rows[0].x + axis.y * rows[0].y + axis.z * rows[0].z);
        m->up[i] = a_metre * (axis.x * rows[1].x + axis.y * rows[1].y + axis.z * rows[1].z);
        m->forward[i] = -a_metre * (axis.x * rows[2].x + axis.y * rows[2].y + axis.z * rows[2].z);
        m->to_sun[i] = to->light.to_sun[i] = float3_dot(axis, sun);
    }
    m->near_m = view->eye.w;
    m->pixel_x = 2.0f * view->frustum.x / view->frustum.z;
    m->pixel_y = 2.0f * view->frustum.y / view->frustum.w;
    m->middle_x = view->principal.x;
    m->middle_y = view->principal.y;
}

static void set3(float to[3], float x, float y, float z)
{
    to[0] = x;
    to[1] = y;
    to[2] = z;
}

/* Sets the noise that is drawn where the gas came from. The weight of a group is 0 when its ways
 * begin anew. Weights keep the noise's variance. */
static void set_detail(const struct kiln_scene *scene, const struct kiln_gas_domain *d,
                       const struct kiln_moment *moment, struct kiln_volume_march *m)
{
    m->step = d->detail > 2 ? VOLUME_FINE_STEP : VOLUME_STEP;
    m->octaves = d->detail > 2 ? 2 : d->detail > 1 ? 1 : 0;
    const float phase = kiln_gas_way_phase(0, kiln_scene_time(scene, moment->view.clock_step.x));
    const float second = fabsf(2.0f * phase - 1.0f), first = 1.0f - second;
    const float variance = sqrtf(first * first + second * second);
    m->weights[0] = first / variance;
    m->weights[1] = second / variance;
}

/* Sets the numbers of a domain's look, and its light. */
static void set_look(struct kiln_volume_stage *s, uint32_t number, float time_s,
                     const struct kiln_draw_backdrop *b, struct domain *to)
{
    const struct kiln_scene *scene = s->scene;
    const struct kiln_gas_look *look = &scene->gas[number].look;
    struct kiln_volume_march *m = &to->march;
    const float3 albedo = kiln_scene_value3(scene, &look->albedo, time_s);
    set3(m->albedo, albedo.x, albedo.y, albedo.z);
    m->extinction = kiln_scene_value(scene, &look->extinction, time_s);
    m->absorption = kiln_scene_value(scene, &look->absorption, time_s);
    m->intensity = kiln_scene_value(scene, &look->intensity, time_s);
    m->bloom = kiln_scene_value(scene, &look->bloom, time_s);
    m->scattering = exact_clamp(kiln_scene_value(scene, &look->scattering, time_s), -0.95f, 0.95f);
    kiln_flame_colors_fill(&s->colors[number], &s->observer,
                           kiln_scene_value(scene, &look->kelvin[0], time_s),
                           kiln_scene_value(scene, &look->kelvin[1], time_s));
    m->colors = &s->colors[number];
    m->field = &s->field;
    m->width = s->width;
    m->height = s->height;
    m->planes = s->planes;
    m->haze = b->floor_params.z > 0.0f && b->counts.z == 0 ? b : NULL;
    to->light.thickness = m->extinction * m->cell_m;
    to->glow = kiln_scene_value(scene, &look->glow, time_s);
    if (!look->lights)
        return;
    const float part = 1.0f / 3.14159265f; /* of the irradiance: a white surface's radiance */
    set3(m->sun, part * b->sun_color.x, part * b->sun_color.y, part * b->sun_color.z);
    set3(to->sky, 0.5f * (b->sky_top.x + b->sky_horizon.x),
         0.5f * (b->sky_top.y + b->sky_horizon.y), 0.5f * (b->sky_top.z + b->sky_horizon.z));
    to->light.sun = m->sun[0] > 0.0f || m->sun[1] > 0.0f || m->sun[2] > 0.0f;
    to->light.sky = to->sky[0] > 0.0f || to->sky[1] > 0.0f || to->sky[2] > 0.0f;
}

/* Sets what dims the sun and the sky in a domain. */
static void set_shade(const struct kiln_volume_stage *s, uint32_t number,
                      const struct kiln_lighting *lighting, struct domain *to)
{
    to->shade =
        (struct kiln_volume_shade){.objects = to->light.sun ? s->shade : NULL, .simd = s->simd};
    if (!lighting || !lighting->smoke)
        return;
    to->shade.sun = (struct kiln_volume_smoke){
        to->light.sun ? lighting->other_smoke[number].sun_depth : NULL, lighting->sun_to_grid};
    to->shade.sky = (struct kiln_volume_smoke){
        to->light.sky ? lighting->other_smoke[number].sky_depth : NULL, lighting->sky_to_grid};
}

/* Lists the lamps that light the smoke of a domain. The light of its own flames is not among them:
 * volume_glow.h spreads it in the smoke. */
static void set_lamps(struct kiln_volume_stage *s, uint32_t number,
                      const struct kiln_volume_draw *draw, struct domain *to)
{
    const struct kiln_lighting *lighting = draw->lighting;
    const struct kiln_draw_shapes *shapes = &draw->moment->shapes;
    to->lamps = s->lamps;
    for (uint32_t i = 0; i < draw->backdrop->counts.y && s->scene->gas[number].look.lights; i++) {
        const struct kiln_light_range own =
            lighting ? lighting->gas_lights[number] : (struct kiln_light_range){0, 0};
        if (i >= own.first && i < own.first + own.count)
            continue;
        struct kiln_volume_lamp *lamp = &s->lamps[to->lamp_count++];
        *lamp = (struct kiln_volume_lamp){.light = &draw->backdrop->lights[i],
                                          .objects = {.shapes = shapes}};
        if (!lighting)
            continue;
        lamp->casters = kiln_shape_set_of_lamp(lamp->light, shapes->counts.x);
        lamp->objects.maps = lighting->lamp_maps;
        lamp->objects.solid_maps = lighting->lamp_solids.texels;
        lamp->smoke = lighting->lamp_smoke;
    }
}

/* Copies and, if asked, lights the gas of a domain. */
static bool fill_field(struct kiln_volume_stage *s, const struct domain *domain,
                       const struct kiln_gas *gas, bool light, struct kiln_error *error)
{
    const struct kiln_volume_march *m = &domain->march;
    const float least = 2e-4f / (float)GAS_BRICK; /* opacity, or radiance, of a cell */
    const float smoke = domain->light.thickness, flame = exact_max(m->absorption, m->intensity);
    const struct kiln_volume_seen seen = {.detail = m->octaves > 0 && gas->shape.detailed,
                                          .least_smoke = least / exact_max(smoke, 1e-30f),
                                          .least_flame =
                                              least / exact_max(flame * m->cell_m, 1e-30f),
                                          .albedo = {m->albedo[0], m->albedo[1], m->albedo[2]}};
    s->lit = false;
    if (!kiln_volume_field_fill(&s->field, gas, &seen, s->threads, error))
        return false;
    end_lap(s, &s->costs.field_s);
    if (light && s->field.count > 0 && !light_domain(s, domain, gas, error))
        return false;
    s->lit = light;
    return true;
}

/* Marches through a domain, and adds the time that it takes: in GL that of a clock. */
static bool march(struct kiln_volume_stage *s, const struct kiln_volume_cast *cast,
                  struct kiln_error *error)
{
    double unused_s = 0.0;
    const double start_s = kiln_clock_seconds();
    const bool ok = kiln_volume_cast(cast, s->threads, error);
    end_lap(s, s->gl ? &unused_s : &s->costs.march_s);
    s->costs.march_s += s->gl ? kiln_clock_seconds() - start_s : 0.0;
    return ok;
}

/* Says how a domain is drawn. */
struct domain_draw {
    uint32_t number;
    bool kept;                           /* the field may still be that of this domain */
    const float *depth;                  /* of the scene */
    struct kiln_volume_domain *profiles; /* which it gets; NULL: none */
    struct kiln_volume_halfway halfway;
    bool halfway_only;
};

static bool draw_domain(struct kiln_volume_stage *s, const struct kiln_volume_draw *draw,
                        const struct domain_draw *how, struct kiln_error *error)
{
    const uint32_t number = how->number;
    const struct kiln_gas *gas = &draw->pool->gas[number];
    struct domain domain = {.march = {.depth = how->depth,
                                      .halfway = how->halfway,
                                      .profiles = how->profiles,
                                      .counts = &s->counts}};
    place_rays(s->scene, &s->scene->gas[number], gas, draw->moment, &domain);
    set_look(s, number, draw->moment->view.clock.x, draw->backdrop, &domain);
    set_shade(s, number, draw->lighting, &domain);
    set_lamps(s, number, draw, &domain);
    set_detail(s->scene, &s->scene->gas[number], draw->moment, &domain.march);
    if (how->halfway_only)
        domain.march.planes = (struct kiln_volume_planes){.smoke = NULL};
    const bool same = how->kept && s->lit;
    if (!same && !fill_field(s, &domain, gas, !how->halfway_only, error))
        return false;
    if (s->field.count == 0)
        return true;
    if (how->profiles)
        how->profiles->bloom = domain.march.bloom;
    const bool half = s->scene->gas[number].look.resolution == KILN_GAS_HALF;
    const struct kiln_volume_cast cast = {.march = &domain.march,
                                          .rows = KILN_SIMD_PICK(kiln_volume_march_rows, s->simd),
                                          .tiles = &s->tiles,
                                          .touched = s->touched,
                                          .grid = half && !how->halfway_only ? s->grid : NULL,
                                          .gl = s->gl,
                                          .same_field = same};
    return march(s, &cast, error);
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* Sets that no gas of the picture is half opaque. */
static bool begin_halfway(struct kiln_volume_stage *s, struct kiln_image *image,
                          struct kiln_volume_halfway *halfway, struct kiln_error *error)
{
    const size_t pixels = (size_t)s->width * s->height;
    halfway->depth_m = image ? kiln_image_host(image, KILN_OVERWRITE, error) : NULL;
    if (!halfway->depth_m)
        return !image;
    if (!s->passed)
        s->passed = kiln_alloc_pages(pixels * sizeof *s->passed);
    if (!s->passed)
        return kiln_error_no_memory(error, "drawn gas");
    halfway->passed = memset(s->passed, 0, pixels * sizeof *s->passed);
    for (size_t i = 0; i < pixels; i++)
        halfway->depth_m[i] = 1e9f;
    return true;
}

/* Finds where the gas of several domains has become half opaque. This is a march of its own, from
 * the nearest domain on: they are drawn from the farthest on. */
static bool find_halfway(struct kiln_volume_stage *s, const struct kiln_volume_draw *draw,
                         const uint32_t order[], uint32_t count, struct domain_draw how,
                         struct kiln_error *error)
{
    how.halfway_only = true;
    bool ok = true;
    for (uint32_t i = count; i-- > 0 && ok;) {
        how.number = order[i];
        ok = draw_domain(s, draw, &how, error);
    }
    return ok;
}

/* Empties the planes, and opens the depths of the scene where the march reads them. depth: gets
 * those on the host. */
static bool begin_planes(struct kiln_volume_stage *s, struct kiln_image *image, const float **depth,
                         struct kiln_error *error)
{
    struct kiln_volume_put empty = {.planes = &s->planes, .width = s->width};
    if (s->gl)
        return kiln_volume_gl_begin(s->gl, image, error);
    *depth = kiln_image_host(image, KILN_READ, error);
    return *depth &&
           kiln_threads_try(s->threads, s->height, 64, kiln_volume_clear_rows, &empty, error);
}

bool kiln_volume_draw(struct kiln_volume_stage *stage, const struct kiln_volume_draw *draw,
                      struct kiln_error *error)
{
    uint32_t order[KILN_MAX_GAS];
    const struct kiln_moment *moment = draw->moment;
    const uint32_t count =
        draw->pool ? kiln_volume_order(stage->scene, moment, draw->pool, order) : 0;
    memset(stage->touched, 0, tile_count(stage->scene));
    stage->profiles.count = 0;
    stage->costs = (struct kiln_volume_costs){.rays = 0};
    atomic_store(&stage->counts.rays, 0);
    atomic_store(&stage->counts.samples, 0);
    struct domain_draw how = {.kept = draw->same && count == 1};
    if (!begin_halfway(stage, draw->halfway, &how.halfway, error))
        return false;
    if (count == 0)
        return true;
    if (draw->profiles &&
        !kiln_volume_profiles_begin(&stage->profiles, count, stage->width, stage->height, error))
        return false;
    if (stage->shade)
        kiln_sun_shade_place(stage->shade, moment);
    float *const halfway_m = how.halfway.depth_m;
    if (!begin_planes(stage, draw->depth, &how.depth, error))
        return false;
    stage->lap_s = kiln_clock_cpu_seconds();
    if (draw->halfway && count > 1) {
        if (!find_halfway(stage, draw, order, count, how, error))
            return false;
        how.halfway.depth_m = NULL;
    }
    for (uint32_t i = 0; i < count; i++) {
        how.number = order[i];
        how.profiles = draw->profiles ? &stage->profiles.domains[count - 1 - i] : NULL;
        if (!draw_domain(stage, draw, &how, error))
            return false;
    }
    return !stage->gl || kiln_volume_gl_end(stage->gl, &stage->planes, halfway_m, error);
}

struct kiln_volume_costs kiln_volume_costs(const struct kiln_volume_stage *stage)
{
    struct kiln_volume_costs costs = stage->costs;
    costs.rays = atomic_load(&stage->counts.rays);
    costs.samples = atomic_load(&stage->counts.samples);
    return costs;
}

const struct kiln_volume_profiles *kiln_volume_profiles(const struct kiln_volume_stage *stage)
{
    return stage->profiles.count > 0 ? &stage->profiles : NULL;
}

/* Puts the gas to an image by one of the functions of volume_put.h. */
static bool put(struct kiln_volume_stage *s, struct kiln_volume_put job, struct kiln_image *image,
                enum kiln_access access,
                void (*rows)(void *context, size_t begin, size_t end, uint32_t worker),
                struct kiln_error *error)
{
    job.planes = &s->planes;
    job.touched = s->touched;
    job.width = s->width;
    job.to = kiln_image_host(image, access, error);
    return job.to && kiln_threads_try(s->threads, s->height, 16, rows, &job, error);
}

bool kiln_volume_add_glow(struct kiln_volume_stage *stage, enum kiln_volume_light_of light,
                          struct kiln_image *bloom, bool keep, struct kiln_error *error)
{
    return put(stage, (struct kiln_volume_put){.light = light, .keep = keep}, bloom,
               keep ? KILN_READ_WRITE : KILN_OVERWRITE, kiln_volume_put_glow_rows, error);
}

bool kiln_volume_put_under(struct kiln_volume_stage *stage, enum kiln_volume_light_of light,
                           struct kiln_image *particles, struct kiln_error *error)
{
    return put(stage, (struct kiln_volume_put){.light = light}, particles, KILN_READ_WRITE,
               kiln_volume_put_under_rows, error);
}

bool kiln_volume_write_layer(struct kiln_volume_stage *stage, struct kiln_image *image,
                             struct kiln_error *error)
{
    return put(stage, (struct kiln_volume_put){.keep = false}, image, KILN_OVERWRITE,
               kiln_volume_put_layer_rows, error);
}
