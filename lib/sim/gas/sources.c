/* This file evaluates the sources of gas and adds them, brick by brick. A cell counts by how far
 * its centre is from the shape, in the shape's own frame: wholly within it, and less the farther it
 * is, up to the source's reach. */
#include "sim/gas/sources.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "shared/exact.h"
#include "shared/noise.h"
#include "shared/particle.h"
#include "shared/random.h"

#define NOISE_CONTRAST           0.9f
#define NOISE_OCTAVES_OF_SOURCES 3u

void gas_sources_init(struct gas_sources *sources, const struct kiln_scene *scene, uint32_t domain)
{
    *sources =
        (struct gas_sources){.scene = scene, .domain = &scene->gas[domain], .number = domain};
}

void gas_sources_finish(struct gas_sources *sources)
{
    for (uint32_t i = 0; i < KILN_MAX_GAS_SOURCES; i++)
        gas_splats_finish(&sources->splats[i]);
    *sources = (struct gas_sources){.count = 0};
}

/* ---- shapes ---------------------------------------------------------------------------------- */

static float distance_to_box(float3 p, float3 half, bool surface)
{
    const float3 q =
        FLOAT3(exact_abs(p.x) - half.x, exact_abs(p.y) - half.y, exact_abs(p.z) - half.z);
    const float3 out = FLOAT3(exact_max(q.x, 0.0f), exact_max(q.y, 0.0f), exact_max(q.z, 0.0f));
    const float inside = exact_min(exact_max(q.x, exact_max(q.y, q.z)), 0.0f);
    const float outside = float3_length(out);
    return surface ? exact_abs(outside + inside) : outside;
}

static float distance_to_line(float3 p, float3 half)
{
    const float square = float3_dot(half, half);
    const float part = exact_clamp(exact_div(float3_dot(p, half), square), -1.0f, 1.0f);
    return float3_length(float3_sub(p, float3_scale(half, part)));
}

/* Returns the distance to a disc about the origin, or to its rim. */
static float distance_to_disc(float3 p, float3 axis, float radius, bool rim)
{
    const float height = float3_dot(p, axis);
    const float along = float3_length(float3_sub(p, float3_scale(axis, height)));
    const float off = rim ? along - radius : exact_max(along - radius, 0.0f);
    return exact_sqrt(off * off + height * height);
}

/* Returns the distance of a place in the shape's frame from the shape, m. */
static float distance_to(const struct gas_source *source, float3 place)
{
    const struct kiln_emitter *emit = &source->from->emit;
    const float3 p = float3_sub(place, source->origin);
    switch (emit->shape) {
    case KILN_EMITTER_SPHERE: {
        const float off = float3_length(p) - source->radius;
        return emit->surface ? exact_abs(off) : exact_max(off, 0.0f);
    }
    case KILN_EMITTER_BOX:
        return distance_to_box(p, source->half, emit->surface);
    case KILN_EMITTER_LINE:
        return distance_to_line(p, source->half);
    case KILN_EMITTER_DISC:
    case KILN_EMITTER_CONE:
        return distance_to_disc(p, source->axis, source->radius, emit->surface);
    case KILN_EMITTER_RING:
        return distance_to_disc(p, source->axis, source->radius, true);
    default:
        return float3_length(p);
    }
}

/* Returns the way of the jet of a cone at a place of the domain: away from the tip behind its small
 * end, at most as far from its axis as its angle says. A cone of 90 degrees or more has its tip in
 * its origin. */
static float3 jet_at(const struct gas_source *source, float3 p)
{
    const float3 axis = source->jet, from = float3_sub(p, source->center);
    const float ahead = exact_max(source->narrow, 0.0f) * source->nozzle;
    const float wide = source->narrow > 0.0f ? source->wide : 1.0f;
    const float3 way = float3_add_scaled(float3_scale(from, wide), axis, ahead);
    const float3 unit = float3_normalize(way, axis);
    const float along = float3_dot(unit, axis);
    if (along >= source->narrow)
        return unit;
    const float3 across = float3_sub(unit, float3_scale(axis, along));
    const float3 off = float3_normalize(across, FLOAT3(0.0f, 0.0f, 0.0f));
    return float3_add_scaled(float3_scale(off, source->wide), axis, source->narrow);
}

/* Returns half the edges of a box about the shape, along the axes of its frame. */
static float3 half_box(const struct gas_source *source)
{
    const float r = source->radius;
    switch (source->from->emit.shape) {
    case KILN_EMITTER_BOX:
    case KILN_EMITTER_LINE:
        return FLOAT3(exact_abs(source->half.x), exact_abs(source->half.y),
                      exact_abs(source->half.z));
    default:
        return FLOAT3(r, r, r);
    }
}

/* ---- values ---------------------------------------------------------------------------------- */

static float value(const struct gas_sources *s, const struct kiln_value *v, float time_s)
{
    return exact_canon(kiln_scene_system_value(s->scene, KILN_SYSTEM_OF_GAS(s->number), v, time_s));
}

static float3 value3(const struct gas_sources *s, const struct kiln_value3 *v, float time_s)
{
    const float3 y = kiln_scene_system_value3(s->scene, KILN_SYSTEM_OF_GAS(s->number), v, time_s);
    return FLOAT3(exact_canon(y.x), exact_canon(y.y), exact_canon(y.z));
}

static void set_shape(const struct gas_sources *s, struct gas_source *source, float time_s)
{
    const struct kiln_gas_domain *domain = s->domain;
    const struct kiln_emitter *emit = &source->from->emit;
    const struct kiln_node_frame own = gas_frame(s->scene, &domain->attach, time_s);
    const struct kiln_node_frame at =
        gas_frame(s->scene, emit->attach.name ? &emit->attach : &domain->attach, time_s);
    const struct gas_map back = gas_map_between(&at, &own);
    const float3 size = value3(s, &emit->size, time_s);
    source->to_shape = gas_map_between(&own, &at);
    source->metres = exact_canon((float)(at.scale / own.scale));
    source->origin = value3(s, &emit->origin, time_s);
    source->axis = float3_normalize(value3(s, &emit->direction, time_s), FLOAT3(0.0f, 1.0f, 0.0f));
    source->half = float3_scale(size, 0.5f);
    source->radius = emit->shape == KILN_EMITTER_POINT ? 0.0f : value(s, &emit->radius, time_s);
    source->center = gas_mapped(&back, source->origin);
    if (emit->shape == KILN_EMITTER_CONE) {
        const struct exact_angle angle = exact_sincos(value(s, &emit->angle, time_s));
        source->jet = float3_normalize(gas_turned(&back, source->axis), FLOAT3(0.0f, 1.0f, 0.0f));
        source->narrow = angle.cosine;
        source->wide = angle.sine;
        source->nozzle = source->radius * source->metres;
    }
    const float3 half = half_box(source);
    const float more = source->reach + s->domain->shape.cell;
    float reach[3];
    for (int i = 0; i < 3; i++)
        reach[i] = ((exact_abs(back.row[i][0]) * half.x + exact_abs(back.row[i][1]) * half.y) +
                    exact_abs(back.row[i][2]) * half.z) +
                   more;
    const float3 around = FLOAT3(reach[0], reach[1], reach[2]);
    source->region = gas_region_of(&domain->shape, float3_sub(source->center, around),
                                   float3_add(source->center, around));
    /* the velocity of the shape's node at its origin, in the domain's frame */
    const struct kiln_node_frame world = {.turn = {0.0, 0.0, 0.0, 1.0}, .scale = 1.0};
    const struct gas_map from_world = gas_map_between(&world, &own);
    const struct gas_map to_world = gas_map_between(&own, &world);
    const float3 place = gas_mapped(&to_world, source->center);
    const float3 moving =
        float3_sub(gas_frame_velocity(&at, place), gas_frame_velocity(&own, place));
    source->velocity = float3_add_scaled(source->velocity, gas_turned(&from_world, moving),
                                         value(s, &source->from->inherit, time_s));
}

/* Returns whether a source is made up of points. */
static bool is_of_points(const struct kiln_gas_source *from)
{
    return from->from == KILN_GAS_FROM_SYSTEM || from->emit.shape == KILN_EMITTER_MESH ||
           from->emit.shape == KILN_EMITTER_IMAGE || from->emit.shape == KILN_EMITTER_PATH;
}

/* Sums up the points of a source, whose velocities have the part that it inherits. */
static bool set_points(const struct gas_sources *s, struct gas_source *source,
                       struct kiln_pool *pool, uint32_t step, struct kiln_error *error)
{
    const struct gas_splatting how = {
        .scene = s->scene,
        .domain = s->domain,
        .step = step,
        .reach = source->reach,
        .inherit = value(s, &source->from->inherit, kiln_scene_time(s->scene, step)),
    };
    struct gas_splats *splats = source->splats;
    const bool ok =
        source->from->from == KILN_GAS_FROM_SYSTEM
            ? gas_splats_set_particles(splats, &how, pool, source->from->system, error)
            : gas_splats_set_samples(splats, &how, &source->from->emit, source->seed, error);
    source->region = ok && splats->any ? gas_region_of(&s->domain->shape, splats->low, splats->high)
                                       : (struct gas_region){{0, 0, 0}, {0, 0, 0}};
    return ok;
}

bool gas_sources_set(struct gas_sources *sources, struct kiln_pool *pool, uint32_t step,
                     struct kiln_error *error)
{
    const struct kiln_gas_domain *domain = sources->domain;
    const float time_s = kiln_scene_time(sources->scene, step);
    sources->count = 0;
    for (uint32_t i = 0; i < domain->source_count; i++) {
        const struct kiln_gas_source *from = &domain->sources[i];
        struct gas_source *source = &sources->source[sources->count];
        const float rate = value(sources, &from->rate, time_s);
        if (rate <= 0.0f)
            continue;
        *source = (struct gas_source){
            .from = from,
            .reach = exact_max(value(sources, &from->reach, time_s), 1.5f * domain->shape.cell),
            .fuel = value(sources, &from->fuel, time_s),
            .temperature = value(sources, &from->temperature, time_s),
            .smoke = value(sources, &from->smoke, time_s),
            .rate = rate,
            .color = value3(sources,
                            kiln_gas_source_is_colored(from) ? &from->color : &domain->look.albedo,
                            time_s),
            .velocity = value3(sources, &from->velocity, time_s),
            .outward = value(sources, &from->outward, time_s),
            .noise = value(sources, &from->noise, time_s),
            .noise_scale = exact_rcp(value(sources, &from->noise_size, time_s)),
            .seed = random_mix(sources->scene->seed + 0x67617300u + i),
            .splats = is_of_points(from) ? &sources->splats[i] : NULL,
        };
        source->noise_rise =
            value(sources, &from->noise_speed, time_s) * time_s * source->noise_scale;
        if (!source->splats)
            set_shape(sources, source, time_s);
        else if (!set_points(sources, source, pool, step, error))
            return false;
        sources->count++;
    }
    return true;
}

void gas_sources_set_time(struct gas_sources *sources, float dt)
{
    for (uint32_t i = 0; i < sources->count; i++) {
        struct gas_source *source = &sources->source[i];
        source->taken = 1.0f - exact_exp(-source->rate * dt);
    }
}

/* ---- cells ----------------------------------------------------------------------------------- */

static float raised(float now, float wanted, float part)
{
    return now < wanted ? now + (wanted - now) * part : now;
}

/* Holds a cell that a source adds to. */
struct cell {
    float *carried, *change; /* change: of the first axis; the others lie planes behind it */
    float *color;            /* NULL: smoke has no colours */
    float3 flow;             /* m/s, before the step */
};

/* Brings a cell to the values of a source. within: how far it lies in it, 0 to 1. velocity: that
 * the source blows with. */
static void add_to_cell(const struct gas_source *source, const struct cell *cell, float within,
                        float3 velocity)
{
    const float part = source->taken;
    float *q = cell->carried;
    const float before = q[GAS_SMOKE];
    q[GAS_FUEL] = raised(q[GAS_FUEL], source->fuel * within, part);
    q[GAS_TEMPERATURE] = raised(q[GAS_TEMPERATURE], source->temperature * within, part);
    q[GAS_SMOKE] = raised(q[GAS_SMOKE], source->smoke * within, part);
    if (cell->color) {
        const float more = q[GAS_SMOKE] - before;
        cell->color[0] = cell->color[0] + more * source->color.x;
        cell->color[1] = cell->color[1] + more * source->color.y;
        cell->color[2] = cell->color[2] + more * source->color.z;
        cell->color[3] = cell->color[3] + more;
    }
    if (!source->from->blows)
        return;
    const float flow[3] = {cell->flow.x, cell->flow.y, cell->flow.z};
    const float wanted[3] = {velocity.x, velocity.y, velocity.z};
    for (int c = 0; c < 3; c++) {
        float *change = cell->change + (ptrdiff_t)c * GAS_BRICK_CELLS;
        *change = *change + (wanted[c] - (flow[c] + *change)) * (part * within);
    }
}

/* Returns how far a cell lies within a source, before noise. */
static float within_of(const struct gas_source *source, float3 p, size_t brick, int32_t cell)
{
    if (source->splats) {
        const uint32_t number = source->splats->number[brick];
        return number == 0 ? 0.0f : exact_min(source->splats->brick[number - 1][cell][3], 1.0f);
    }
    const float far = distance_to(source, gas_mapped(&source->to_shape, p)) * source->metres;
    return exact_clamp(1.0f - exact_div(far, source->reach), 0.0f, 1.0f);
}

/* Returns the velocity that a source blows with in a cell that it reaches. */
static float3 velocity_of(const struct gas_source *source, float3 p, size_t brick, int32_t cell)
{
    if (source->splats) {
        const float *sum = source->splats->brick[source->splats->number[brick] - 1][cell];
        return float3_add_scaled(source->velocity, FLOAT3(sum[0], sum[1], sum[2]),
                                 exact_rcp(sum[3]));
    }
    if (source->outward == 0.0f)
        return source->velocity;
    const float3 out = float3_sub(p, source->center);
    const float3 way = source->from->emit.shape == KILN_EMITTER_CONE
                           ? jet_at(source, p)
                           : float3_normalize(out, FLOAT3(0.0f, 1.0f, 0.0f));
    return float3_add_scaled(source->velocity, way, source->outward);
}

/* Holds the cells of a brick that a source reaches. */
struct reached {
    struct gas_points points; /* their centres in the domain, m */
    float within[GAS_BRICK_CELLS];
    int16_t cell[GAS_BRICK_CELLS];
};

static float3 point_of(const struct gas_points *points, uint32_t i)
{
    return FLOAT3(points->place[0][i], points->place[1][i], points->place[2][i]);
}

static void set_point(struct gas_points *points, uint32_t i, float3 p)
{
    points->place[0][i] = p.x;
    points->place[1][i] = p.y;
    points->place[2][i] = p.z;
}

/* Finds the cells of a brick that a source reaches. first: cell of the brick in the domain. wall:
 * of the brick, or NULL. */
static void find_reached(const struct gas_source *source, const struct kiln_gas_shape *shape,
                         struct kiln_gas_place first, const struct gas_wall *wall,
                         struct reached *reached)
{
    const size_t number = gas_brick_number(shape, first);
    uint32_t count = 0;
    for (int32_t i = 0; i < GAS_BRICK_CELLS; i++) {
        const int32_t x = i % GAS_BRICK, y = i / GAS_BRICK % GAS_BRICK;
        const int32_t z = i / (GAS_BRICK * GAS_BRICK);
        const float3 p = FLOAT3(shape->corner.x + ((float)(first.x + x) + 0.5f) * shape->cell,
                                shape->corner.y + ((float)(first.y + y) + 0.5f) * shape->cell,
                                shape->corner.z + ((float)(first.z + z) + 0.5f) * shape->cell);
        if (wall && wall->cell[i] & GAS_SOLID)
            continue;
        const float within = within_of(source, p, number, i);
        if (within <= 0.0f)
            continue;
        set_point(&reached->points, count, p);
        reached->within[count] = within;
        reached->cell[count] = (int16_t)i;
        count++;
    }
    reached->points.count = count;
}

/* Takes off what noise leaves out. */
static void weaken(const struct gas_source *source, const struct gas_advect *kernels,
                   struct reached *reached)
{
    struct gas_points at;
    at.count = reached->points.count;
    for (uint32_t i = 0; i < at.count; i++) {
        const float3 p = float3_scale(point_of(&reached->points, i), source->noise_scale);
        set_point(&at, i, FLOAT3(p.x, p.y - source->noise_rise, p.z));
    }
    kernels->noise(&at, source->seed, NOISE_OCTAVES_OF_SOURCES);
    for (uint32_t i = 0; i < at.count; i++) {
        const float pattern = exact_clamp(0.5f + NOISE_CONTRAST * at.noise[0][i], 0.0f, 1.0f);
        reached->within[i] = reached->within[i] * (1.0f - source->noise * (1.0f - pattern));
    }
}

/* Finds the cells of a brick of the window that a source reaches in the end. */
static void find_cells(const struct gas_source *source, const struct gas_pass *pass,
                       const struct gas_advect *kernels, gas_brick_place at,
                       struct reached *reached)
{
    const size_t index = kiln_gas_brick_index(pass->gas, at.x, at.y, at.z);
    const struct gas_wall *wall = pass->walls ? pass->walls[index] : NULL;
    find_reached(source, &pass->gas->shape, gas_first_cell(pass->gas, at), wall, reached);
    if (source->noise > 0.0f)
        weaken(source, kernels, reached);
}

static void add_source(const struct gas_source *source, const struct gas_pass *pass,
                       const struct gas_advect *kernels, gas_brick_place at, bool *any)
{
    struct kiln_gas *gas = pass->gas;
    const struct kiln_gas_shape *shape = &gas->shape;
    struct kiln_gas_brick *brick = &gas->brick[kiln_gas_brick_index(gas, at.x, at.y, at.z)];
    const size_t number = gas_brick_number(shape, gas_first_cell(gas, at));
    struct reached reached;
    find_cells(source, pass, kernels, at, &reached);
    for (uint32_t k = 0; k < reached.points.count; k++) {
        const int32_t i = reached.cell[k];
        const ptrdiff_t carried = (ptrdiff_t)i * GAS_CARRIED;
        const ptrdiff_t face =
            gas_row_of_window(gas, at, i / GAS_BRICK % GAS_BRICK, i / (GAS_BRICK * GAS_BRICK)) +
            i % GAS_BRICK;
        if (reached.within[k] <= 0.0f)
            continue;
        *any = true;
        const struct cell cell = {
            .carried = brick->now + carried,
            .change = brick->change + i,
            .color = shape->colored ? brick->next_extras + carried : NULL,
            .flow = FLOAT3(0.5f * (gas->faces[0][face] + gas->faces[0][face + 1]),
                           0.5f * (gas->faces[1][face] + gas->faces[1][face + gas->row]),
                           0.5f * (gas->faces[2][face] + gas->faces[2][face + gas->plane])),
        };
        add_to_cell(source, &cell, reached.within[k],
                    velocity_of(source, point_of(&reached.points, k), number, i));
    }
}

bool gas_sources_add(const struct gas_sources *sources, const struct gas_pass *pass,
                     const struct gas_advect *kernels, gas_brick_place at)
{
    bool any = false;
    for (uint32_t i = 0; i < sources->count; i++)
        if (gas_region_has(&sources->source[i].region, pass->gas, at))
            add_source(&sources->source[i], pass, kernels, at, &any);
    return any;
}

bool gas_sources_brings(const struct gas_sources *sources, uint32_t number,
                        struct gas_brought *brought)
{
    if (number >= sources->count)
        return false;
    const struct gas_source *s = &sources->source[number];
    *brought = (struct gas_brought){
        .region = s->region,
        .fuel = s->fuel,
        .temperature = s->temperature,
        .smoke = s->smoke,
        .taken = s->taken,
        .color = {s->color.x, s->color.y, s->color.z},
        .blows = s->from->blows,
    };
    return true;
}

bool gas_sources_reach(const struct gas_sources *sources, const struct gas_pass *pass,
                       const struct gas_advect *kernels, uint32_t number, gas_brick_place at,
                       float4 *cells)
{
    const struct gas_source *source = &sources->source[number];
    const struct kiln_gas_shape *shape = &pass->gas->shape;
    const size_t brick = gas_brick_number(shape, gas_first_cell(pass->gas, at));
    bool any = false;
    struct reached reached;
    find_cells(source, pass, kernels, at, &reached);
    memset(cells, 0, GAS_BRICK_CELLS * sizeof *cells);
    for (uint32_t k = 0; k < reached.points.count; k++) {
        const int32_t i = reached.cell[k];
        const float3 v = velocity_of(source, point_of(&reached.points, k), brick, i);
        any = any || reached.within[k] > 0.0f;
        cells[i] = FLOAT4(v.x, v.y, v.z, reached.within[k]);
    }
    return any;
}
