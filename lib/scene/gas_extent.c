/* This file expects how much of a domain gas fills: cones above its sources, which grow with time.
 * The front of a plume rises by about a quarter of the free-fall speed over three times the reach
 * of its source, and a plume widens by 0.1 to 0.28 m a metre; both were measured with fires, a
 * fireball and columns of smoke. Noise takes half of its amount from the heat of a source. Burning
 * blows the base of the cone up. Where that says little, gas fills the whole domain: under a closed
 * top, above moving nodes and meshes, and where gas does not rise. */
#include "scene/gas_extent.h"

#include <math.h>

#include "shared/exact.h"

static const double RISE = 0.25;  /* of the free-fall speed... */
static const double WIDTHS = 3.0; /* ...over so many times the reach of the source */
/* m of radius a metre of height, of a plume that nothing stirs, and what turbulence as strong as
 * the buoyancy adds */
static const double SLOPE = 0.1, STIRRED_SLOPE = 0.18;
static const double JET = 0.1;   /* of the velocity of a source, by which the front is faster */
static const double JET_S = 0.5; /* s: for which a jet keeps its way */

/* Bricks from the gas to the end of what is active on its sides: one brick, and half of the one
 * that it is in, on average. */
static const double ASIDE = 1.5;

static const double CORNERS = 0.2; /* of a square, beyond the circle in it */

enum {
    MOMENTS = 17, /* at which sources are looked at */
    SLICES = 16,
    MARGIN = 2, /* bricks between active ones and the end of a window */
};

/* A box about a source at all moments, in the domain, and what rises from it. */
struct base {
    double low[3], high[3];
    double from_s; /* clip time from which it is on */
};

/* What the values of a domain say at all moments. */
struct rising {
    const struct kiln_scene *scene;
    const struct kiln_gas_domain *domain;
    uint32_t number; /* of its system */
    double start_s, end_s;
    double speed, jet;      /* m/s: of the front at first, and what stays of it */
    double slope;           /* m of radius a metre of height */
    double slower;          /* 1/s: by which hot gas that cools gets slower */
    double low[3], high[3]; /* m: of the domain */
    double brick;           /* m: edge of a brick */
};

static double most(const struct rising *r, const struct kiln_value *value)
{
    return (double)kiln_scene_value_max(r->scene, value);
}

static double value(const struct rising *r, const struct kiln_value *value, double time_s)
{
    return (double)kiln_scene_system_value(r->scene, r->number, value, (float)time_s);
}

static bool is_same_node(const struct kiln_attach *a, const struct kiln_attach *b)
{
    return (a->name != NULL) == (b->name != NULL) && (!a->name || a->node == b->node);
}

static void set_domain(struct rising *r)
{
    const struct kiln_gas_shape *shape = &r->domain->shape;
    const float corner[3] = {shape->corner.x, shape->corner.y, shape->corner.z};
    const int32_t cells[3] = {shape->cells.x, shape->cells.y, shape->cells.z};
    for (int c = 0; c < 3; c++) {
        r->low[c] = (double)corner[c];
        r->high[c] = r->low[c] + cells[c] * (double)shape->cell;
    }
    r->brick = GAS_BRICK * (double)shape->cell;
}

/* Returns the cube root of a number from 1 on, by Newton's method. */
static double cube_root(double x)
{
    double root = x;
    for (int i = 0; i < 40; i++)
        root = (2.0 * root + x / (root * root)) / 3.0;
    return root;
}

/* Returns by how much burning makes the shape of a source wider. */
static double burst_of(const struct rising *r, const struct kiln_gas_source *source)
{
    const double blown = most(r, &r->domain->burn.expand) * most(r, &source->fuel);
    return r->domain->burn.enabled ? cube_root(fmax(0.5 * blown, 1.0)) : 1.0;
}

/* Returns how far a source reaches from its middle at most, m. */
static double reach_of(const struct rising *r, const struct kiln_gas_source *source)
{
    const struct kiln_emitter *emit = &source->emit;
    const bool edged = emit->shape == KILN_EMITTER_BOX || emit->shape == KILN_EMITTER_LINE;
    double half = emit->shape == KILN_EMITTER_POINT || edged ? 0.0 : most(r, &emit->radius);
    if (edged)
        half = 0.5 *
               fmax(most(r, &emit->size.x), fmax(most(r, &emit->size.y), most(r, &emit->size.z)));
    return burst_of(r, source) * half + most(r, &source->reach);
}

/* Returns whether gas rises from small sources in a way that is known; fills in how. */
static bool find_rise(struct rising *r)
{
    const struct kiln_gas_domain *d = r->domain;
    double hot = 0.0, smoke = 0.0, upwards = 0.0, reach = 0.0;
    for (uint32_t i = 0; i < d->source_count; i++) {
        const struct kiln_gas_source *s = &d->sources[i];
        if (s->from == KILN_GAS_FROM_SYSTEM || s->emit.shape > KILN_EMITTER_RING ||
            !is_same_node(&s->emit.attach, &d->attach))
            return false;
        hot = fmax(hot, most(r, &s->temperature) * (1.0 - 0.5 * most(r, &s->noise)));
        if (d->burn.enabled && most(r, &s->fuel) > 0.0)
            hot = fmax(hot, 1.0);
        smoke = fmax(smoke, most(r, &s->smoke));
        reach = fmax(reach, reach_of(r, s));
        upwards = fmax(upwards, most(r, &s->velocity.y));
    }
    const double height = r->high[1] - r->low[1];
    const double up = most(r, &d->buoyancy) * hot - most(r, &d->weight) * smoke;
    r->speed = RISE * sqrt(fmax(up, 0.0) * fmin(WIDTHS * reach, height));
    r->jet = JET * upwards;
    r->slope =
        SLOPE + STIRRED_SLOPE *
                    fmin(most(r, &d->turbulence.strength) / fmax(most(r, &d->buoyancy), 1e-3), 1.0);
    r->slower = 0.5 * (most(r, &d->cool_even) + 0.5 * most(r, &d->cool_glow));
    return up > 0.0;
}

/* Returns half the edges of a source's shape at a time. */
static void half_of(const struct rising *r, const struct kiln_gas_source *source, double time_s,
                    double half[3])
{
    const struct kiln_emitter *emit = &source->emit;
    const struct kiln_value *edges[3] = {&emit->size.x, &emit->size.y, &emit->size.z};
    const bool edged = emit->shape == KILN_EMITTER_BOX || emit->shape == KILN_EMITTER_LINE;
    const double radius = emit->shape == KILN_EMITTER_POINT ? 0.0 : value(r, &emit->radius, time_s);
    const bool flat = emit->shape == KILN_EMITTER_DISC || emit->shape == KILN_EMITTER_RING;
    for (int c = 0; c < 3; c++)
        half[c] = flat && c == 1 ? 0.0 : edged ? 0.5 * fabs(value(r, edges[c], time_s)) : radius;
}

/* Finds the box about a source at all moments at which it is on. Returns false if it is off. */
static bool find_base(const struct rising *r, const struct kiln_gas_source *source,
                      struct base *base)
{
    const struct kiln_emitter *emit = &source->emit;
    const struct kiln_value *origin[3] = {&emit->origin.x, &emit->origin.y, &emit->origin.z};
    const struct kiln_value *velocity[3] = {&source->velocity.x, NULL, &source->velocity.z};
    const double burst = burst_of(r, source);
    bool on = false;
    for (int i = 0; i < MOMENTS; i++) {
        const double time_s = r->start_s + (r->end_s - r->start_s) * i / (MOMENTS - 1);
        double half[3];
        if (!(value(r, &source->rate, time_s) > 0.0))
            continue;
        half_of(r, source, time_s, half);
        const double reach = value(r, &source->reach, time_s);
        const double out = JET * fmax(value(r, &source->outward, time_s), 0.0);
        for (int c = 0; c < 3; c++) {
            const double at = value(r, origin[c], time_s), edge = burst * half[c] + reach + out;
            const double jet = velocity[c] ? JET_S * value(r, velocity[c], time_s) : 0.0;
            const double low = at - edge + fmin(jet, 0.0), high = at + edge + fmax(jet, 0.0);
            base->low[c] = on ? fmin(base->low[c], low) : low;
            base->high[c] = on ? fmax(base->high[c], high) : high;
        }
        base->from_s = on ? base->from_s : time_s;
        on = true;
    }
    return on;
}

/* A rectangle of a horizontal slice, and its axes. */
static const int SIDES[2] = {0, 2};

struct rectangle {
    double low[2], high[2];
};

static double area_of(const struct rectangle *r)
{
    return fmax(r->high[0] - r->low[0], 0.0) * fmax(r->high[1] - r->low[1], 0.0);
}

static void include(struct rectangle *r, const struct rectangle *other)
{
    for (int c = 0; c < 2; c++) {
        r->low[c] = fmin(r->low[c], other->low[c]);
        r->high[c] = fmax(r->high[c], other->high[c]);
    }
}

/* Returns the highest place of the cone above a base. */
static double top_of(const struct rising *r, const struct base *b)
{
    const double t = fmax(r->end_s - b->from_s, 0.0), k = r->slower;
    const double hot_s = k > 1e-6 ? (1.0 - (double)exact_exp((float)(-k * t))) / k : t;
    return b->high[1] + r->speed * hot_s + r->jet * t + r->brick;
}

/* Returns the area of all cones at a height, of which those that overlap count once. */
static double area_at(const struct rising *r, const struct base *bases, uint32_t count, double y,
                      struct rectangle *all)
{
    double area = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const struct base *b = &bases[i];
        struct rectangle whole, cut;
        if (y < b->low[1] - r->brick || y > top_of(r, b))
            continue;
        const double wider = r->slope * fmax(y - b->high[1], 0.0) + ASIDE * r->brick;
        for (int c = 0; c < 2; c++) {
            whole.low[c] = b->low[SIDES[c]] - wider;
            whole.high[c] = b->high[SIDES[c]] + wider;
            cut.low[c] = fmax(whole.low[c], r->low[SIDES[c]]);
            cut.high[c] = fmin(whole.high[c], r->high[SIDES[c]]);
        }
        /* it is round where the sides of the domain do not cut it */
        area += area_of(&cut) * (1.0 - CORNERS * area_of(&cut) / area_of(&whole));
        if (area_of(&cut) > 0.0)
            include(all, &cut);
    }
    return fmin(area, area_of(all));
}

/* Adds up the volume of the cones above bases, in the domain, and finds the box about it. */
static double add_cones(const struct rising *r, const struct base *bases, uint32_t count,
                        struct base *box)
{
    double volume = 0.0, bottom = r->high[1], top = r->low[1];
    struct rectangle all = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    for (uint32_t i = 0; i < count; i++) {
        bottom = fmin(bottom, bases[i].low[1] - r->brick);
        top = fmax(top, top_of(r, &bases[i]));
    }
    bottom = fmax(bottom, r->low[1]);
    top = fmin(top, r->high[1]);
    for (int k = 0; k < SLICES && top > bottom; k++) {
        struct rectangle slice = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
        const double y = bottom + (top - bottom) * (k + 0.5) / SLICES;
        volume += area_at(r, bases, count, y, &slice) * (top - bottom) / SLICES;
        include(&all, &slice);
    }
    *box = (struct base){.low = {all.low[0], bottom, all.low[1]},
                         .high = {all.high[0], top, all.high[1]}};
    return volume;
}

/* Returns the cells of a window about what is active along an axis. */
static int32_t window_of(const struct rising *r, const struct base *box, int axis, int32_t all)
{
    const double margin = (MARGIN - 1) * r->brick, cell = (double)r->domain->shape.cell;
    const double low = fmax(box->low[axis] - margin, r->low[axis]);
    const double high = fmin(box->high[axis] + margin, r->high[axis]);
    const double cells = ceil(fmax(high - low, cell) / cell / KILN_GAS_STRIDE) * KILN_GAS_STRIDE;
    return cells < all ? (int32_t)cells : all;
}

static struct kiln_gas_extent whole(const struct kiln_gas_shape *shape)
{
    const struct kiln_gas_place n = shape->cells;
    return (struct kiln_gas_extent){n, (uint64_t)n.x * (uint64_t)n.y * (uint64_t)n.z /
                                           GAS_BRICK_CELLS};
}

struct kiln_gas_extent kiln_gas_extent_at(const struct kiln_scene *scene, uint32_t domain,
                                          double time_s)
{
    const struct kiln_gas_domain *d = &scene->gas[domain];
    const struct kiln_gas_shape *shape = &d->shape;
    struct rising r = {.scene = scene,
                       .domain = d,
                       .number = KILN_SYSTEM_OF_GAS(domain),
                       .start_s = -(double)scene->warmup_steps * (double)scene->dt_s,
                       .end_s = time_s};
    struct base bases[KILN_MAX_GAS_SOURCES], box = {.from_s = 0.0};
    struct kiln_gas_extent extent = {.bricks = 0};
    uint32_t count = 0;
    if (!d->enabled)
        return extent;
    set_domain(&r);
    const bool rises = find_rise(&r);
    for (uint32_t i = 0; rises && i < d->source_count; i++)
        count += find_base(&r, &d->sources[i], &bases[count]);
    if (rises && count == 0)
        return extent;
    const double volume = rises ? add_cones(&r, bases, count, &box) : 0.0;
    if (!rises || (shape->closed[3] && box.high[1] >= r.high[1]))
        return whole(shape);
    extent.cells = (struct kiln_gas_place){window_of(&r, &box, 0, shape->cells.x),
                                           window_of(&r, &box, 1, shape->cells.y),
                                           window_of(&r, &box, 2, shape->cells.z)};
    const double bricks = volume / (r.brick * r.brick * r.brick);
    const double all = (double)extent.cells.x * extent.cells.y * extent.cells.z / GAS_BRICK_CELLS;
    extent.bricks = (uint64_t)fmin(fmax(bricks, 1.0), all);
    return extent;
}

struct kiln_gas_extent kiln_gas_extent(const struct kiln_scene *scene, uint32_t domain)
{
    return kiln_gas_extent_at(scene, domain,
                              (double)scene->frames * scene->fps.den / scene->fps.num);
}
