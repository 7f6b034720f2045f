/* Estimates the number of particles, and the gas, over time. The run is divided into slots of time.
 * In each, a system gets births by its rate, its bursts, or what its parents do. A birth lives
 * between the shortest and the longest life of its time, evenly spread, so the number of the living
 * that it leaves falls along a line: sums of second differences give the numbers of all slots in
 * one pass. Nothing is known of collisions, bounds and demitters, which end lives early. */
#include "job/workload.h"

#include <math.h>
#include <stdlib.h>

#include "scene/family.h"
#include "scene/gas_extent.h"
#include "scene/gas_shape.h"
#include "scene/instant.h"

enum { MOST_SLOTS = 1 << 16 };

/* The cost of a particle and of a pixel, in about nanoseconds of a processor. Only their ratios
 * matter. */
static const double STEP_FIXED = 20e3, STEP_PARTICLE = 30, PAIR = 0.5;
static const double STEP_GAS_CELL = 15, STEP_GAS_ACTIVE = 150; /* of the window; with gas */
static const double DRAW_GAS_CELL = 15, DRAW_GAS_ACTIVE = 150;
static const double FRAME_PIXEL = 25, DRAW_PARTICLE = 100, DRAW_PIXEL = 0.6, SORTED_PIXEL = 15;

static const double NEAR = 0.05;

struct kiln_workload {
    const struct kiln_scene *scene;
    uint32_t count;  /* slots of time; numbers of the living are those at their ends */
    double start_s;  /* clip time of the first one */
    double length_s; /* of a slot */
    double *steps;   /* work of a step in each slot */
    double *frames;  /* work of a frame in each slot */
};

/* Holds the numbers of one system by slot. */
struct numbers {
    double *births, *living;
    double *jumps, *slopes; /* differences of `living`, and of its differences */
};

static double time_of(const struct kiln_workload *w, uint32_t slot)
{
    return w->start_s + (slot + 0.5) * w->length_s;
}

/* ---- births and lives ------------------------------------------------------------------------ */

/* Returns the number of a burst's repetitions before a clip time, without their delays. */
static double repetitions_before(const struct kiln_burst *burst, double time_s)
{
    const double passed = ceil((time_s - burst->time_s) / burst->every_s);
    return fmin(fmax(passed, 0.0), burst->most);
}

static void add_bursts(const struct kiln_workload *w, const struct kiln_emitter *emit,
                       double *births)
{
    for (uint32_t i = 0; i < emit->burst_count; i++) {
        const struct kiln_burst *burst = &emit->bursts[i];
        const double count = 0.5 * ((double)burst->count[0] + burst->count[1]);
        for (uint32_t k = 0; k < w->count && burst->every_s > 0.0; k++)
            births[k] += count * (repetitions_before(burst, w->start_s + (k + 1) * w->length_s) -
                                  repetitions_before(burst, w->start_s + k * w->length_s));
        if (burst->every_s > 0.0)
            continue;
        const double time_s = burst->time_s + 0.5 * burst->jitter_s;
        const double slot = floor((time_s - w->start_s) / w->length_s);
        if (slot >= w->count || slot < 0.0)
            continue;
        /* The frame at 0 s shows bursts at its very time; other frames show earlier ones. */
        births[(uint32_t)slot - (time_s == 0.0 && slot > 0.0)] += count;
    }
}

/* Returns how many particles an emitter has borne by the metre before a time. */
static double by_metre_before(const struct kiln_workload *w, const struct kiln_emitter *emit,
                              double time_s)
{
    const double steps = time_s / (double)w->scene->dt_s + w->scene->warmup_steps;
    if (!emit->by_way)
        return 0.0;
    const uint32_t step = (uint32_t)fmin(fmax(steps, 0.0), emit->way_count - 1.0);
    return (double)emit->by_way[step] / 4294967296.0;
}

/* Returns how many children a second a particle has along its way. Its speed is taken for that of
 * its birth. */
static double trail_rate(const struct kiln_scene *scene, const struct kiln_parent *parent)
{
    const struct kiln_range *speed = &scene->systems[parent->system].emit.speed;
    if (parent->per_metre > 0)
        return parent->per_metre * (double)kiln_scene_value_max(scene, &speed->max);
    return (double)kiln_scene_value_max(scene, &parent->rate);
}

/* Adds the births of a trail. The first child is born with its parent, and others from the age on
 * at which the rate gives one more. */
static void add_trail(const struct kiln_workload *w, const struct kiln_parent *parent,
                      const struct numbers *of_parent, double *births)
{
    const double rate = trail_rate(w->scene, parent) * w->length_s;
    if (rate <= 0.0)
        return;
    const uint32_t whole = (uint32_t)fmin(1.0 / rate, w->count);
    double young = 0.0; /* parents with one child so far: those of the last slots, and of a part */
    for (uint32_t i = 0; i < w->count; i++) {
        const double older = i >= whole ? of_parent->births[i - whole] : 0.0;
        const double of_part = (1.0 / rate - whole) * older;
        young += whole > 0 ? of_parent->births[i] - older : 0.0;
        births[i] = of_parent->births[i] + fmax(of_parent->living[i] - young - of_part, 0.0) * rate;
    }
}

/* Fills the births of a system in each slot; of_parent: what its parent does, or unused. */
static void find_births(const struct kiln_workload *w, const struct kiln_system *system,
                        const struct numbers *of_parent, double *births)
{
    const struct kiln_emitter *emit = &system->emit;
    const struct kiln_parent *parent = &emit->parent;
    const double count = 0.5 * ((double)parent->count[0] + parent->count[1]);
    for (uint32_t i = 0; i < w->count; i++) {
        if (!parent->enabled) {
            const float rate = kiln_scene_value(w->scene, &emit->rate, (float)time_of(w, i));
            const double from_s = w->start_s + i * w->length_s;
            births[i] = fmax((double)rate, 0.0) * w->length_s +
                        by_metre_before(w, emit, from_s + w->length_s) -
                        by_metre_before(w, emit, from_s);
            continue;
        }
        const double before = i > 0 ? of_parent->living[i - 1] : 0.0;
        const double deaths = fmax(before + of_parent->births[i] - of_parent->living[i], 0.0);
        if (parent->event == KILN_EVENT_DEATH)
            births[i] = deaths * count;
        else if (parent->event == KILN_EVENT_BOUNCE) /* taken for one of each, at its birth */
            births[i] = of_parent->births[i] * count;
    }
    if (parent->enabled && parent->event == KILN_EVENT_TRAIL)
        add_trail(w, parent, of_parent, births);
    if (!parent->enabled)
        add_bursts(w, emit, births);
}

/* Adds a line of the living: `count` until `from`, then fewer, until none are left at `to`. Both
 * are counted in slots from the beginning of slot `first`. */
static void add_lives(const struct kiln_workload *w, const struct numbers *n, uint32_t first,
                      double count, double from, double to)
{
    n->jumps[first] += count;
    if (to < 1.0) { /* part of a slot; the frame of this slot sees a part of them */
        n->jumps[first] -= count * (1.0 - 0.5 * (from + to));
        n->jumps[first + 1] -= count * 0.5 * (from + to);
        return;
    }
    const double begin = floor(from), end = fmax(ceil(to), begin + 1.0);
    const double fall = count / (end - begin);
    const uint32_t a = (uint32_t)fmin(first + begin, w->count);
    const uint32_t b = (uint32_t)fmin(first + end, w->count);
    n->slopes[a + 1] -= fall;
    n->slopes[b + 1] += fall;
}

/* Return the limits of lives that begin at a time. */
static double least_life_s(const struct kiln_scene *scene, const struct kiln_range *life,
                           float time_s)
{
    if (kiln_value_uses(scene->keys, &life->min) & KILN_VALUE_OF_PARTICLES)
        return (double)kiln_scene_value_min(scene, &life->min);
    return (double)kiln_scene_value(scene, &life->min, time_s);
}

static double most_life_s(const struct kiln_scene *scene, const struct kiln_range *life,
                          float time_s)
{
    if (kiln_value_uses(scene->keys, &life->max) & KILN_VALUE_OF_PARTICLES)
        return (double)kiln_scene_value_max(scene, &life->max);
    return (double)kiln_scene_value(scene, &life->max, time_s);
}

static void find_living(const struct kiln_workload *w, const struct kiln_system *system,
                        const struct numbers *n)
{
    const struct kiln_range *life = &system->emit.life;
    for (uint32_t i = 0; i < w->count + 2; i++)
        n->jumps[i] = n->slopes[i] = 0.0;
    for (uint32_t i = 0; i < w->count; i++) {
        const float time_s = (float)time_of(w, i);
        const double least = least_life_s(w->scene, life, time_s);
        const double most = most_life_s(w->scene, life, time_s);
        if (n->births[i] > 0.0)
            add_lives(w, n, i, n->births[i], fmin(least, most) / w->length_s,
                      fmax(least, most) / w->length_s);
    }
    double living = 0.0, slope = 0.0;
    for (uint32_t i = 0; i < w->count; i++) {
        slope += n->slopes[i];
        living += n->jumps[i] + slope;
        n->living[i] = fmin(fmax(living, 0.0), (double)system->capacity);
    }
}

/* ---- work ------------------------------------------------------------------------------------ */

static bool attracts_all(const struct kiln_system *system)
{
    for (uint32_t i = 0; i < system->interaction_count; i++) {
        if (system->interactions[i].kind == KILN_INTERACT_GRAVITY)
            return true;
    }
    return false;
}

/* Returns how many pixels a particle covers at a time: at the distance of what the camera looks at,
 * within the picture. */
static double pixels_of(const struct kiln_workload *w, const struct kiln_system *system,
                        float time_s)
{
    const struct kiln_scene *scene = w->scene;
    const double away = (double)kiln_scene_camera_at(scene, time_s).distance;
    const double half = tan(0.5 * (double)kiln_scene_value(scene, &scene->camera.fov, time_s));
    const double per_metre = 0.5 * scene->height / (half * fmax(away, 1e-3));
    const struct kiln_parent *parent = &system->emit.parent;
    const struct kiln_system *sized =
        parent->enabled && parent->look.size ? &scene->systems[parent->system] : system;
    const double edge = per_metre * (double)kiln_scene_value_max(scene, &sized->look.size);
    return fmin(edge * edge, (double)scene->width * scene->height);
}

static void add_work(struct kiln_workload *w, const struct kiln_system *system,
                     const struct numbers *n)
{
    const bool pairs = attracts_all(system);
    const bool sorted = w->scene->post.compose == KILN_COMPOSE_OIT;
    const double moments = kiln_scene_moment_count(w->scene);
    for (uint32_t i = 0; i < w->count; i++) {
        const double living = n->living[i];
        if (living <= 0.0)
            continue;
        const double pixels = pixels_of(w, system, (float)time_of(w, i));
        const double pixel = sorted ? SORTED_PIXEL : DRAW_PIXEL;
        w->steps[i] += living * (STEP_PARTICLE + (pairs ? PAIR * living : 0.0));
        w->frames[i] += moments * living * (DRAW_PARTICLE + pixel * pixels);
    }
}

/* Adds the work of gas, which spreads from its sources. It is found at some moments, between which
 * it grows along lines. */
static void add_gas(struct kiln_workload *w, uint32_t number)
{
    enum { MOMENTS = 65 };
    const struct kiln_scene *scene = w->scene;
    const double substeps = kiln_gas_least_substeps(scene, &scene->gas[number]);
    const double moments = kiln_scene_moment_count(scene);
    double cells[MOMENTS], active[MOMENTS];
    for (int k = 0; k < MOMENTS; k++) {
        const double slot = (w->count - 1.0) * k / (MOMENTS - 1);
        const struct kiln_gas_extent extent =
            kiln_gas_extent_at(scene, number, w->start_s + (slot + 1.0) * w->length_s);
        const struct kiln_gas_place *n = &extent.cells;
        cells[k] = (double)n->x * n->y * n->z;
        active[k] = (double)extent.bricks * GAS_BRICK_CELLS;
    }
    for (uint32_t i = 0; i < w->count; i++) {
        const double at = w->count > 1 ? (double)i * (MOMENTS - 1) / (w->count - 1.0) : 0.0;
        const uint32_t k = (uint32_t)fmin(at, MOMENTS - 2);
        const double part = at - k;
        const double all = cells[k] + part * (cells[k + 1] - cells[k]);
        const double full = active[k] + part * (active[k + 1] - active[k]);
        w->steps[i] += substeps * (STEP_GAS_CELL * all + STEP_GAS_ACTIVE * full);
        w->frames[i] += moments * (DRAW_GAS_CELL * all + DRAW_GAS_ACTIVE * full);
    }
}

static bool fill(struct kiln_workload *w, struct numbers *n)
{
    const struct kiln_scene *scene = w->scene;
    uint32_t order[KILN_MAX_SYSTEMS];
    const double frame = FRAME_PIXEL * scene->width * scene->height;
    for (uint32_t i = 0; i < w->count; i++) {
        w->steps[i] = STEP_FIXED;
        w->frames[i] = frame * kiln_scene_moment_count(scene);
    }
    for (uint32_t i = 0; i < scene->gas_count; i++)
        if (scene->gas[i].enabled)
            add_gas(w, i);
    kiln_family_order(scene, order);
    for (uint32_t k = 0; k < scene->system_count; k++) {
        const struct kiln_system *system = &scene->systems[order[k]];
        struct numbers *own = &n[order[k]];
        const size_t size = w->count + 2;
        own->births = calloc(4 * size, sizeof *own->births);
        if (!own->births)
            return false;
        own->living = own->births + size;
        own->jumps = own->births + 2 * size;
        own->slopes = own->births + 3 * size;
        if (!system->enabled)
            continue;
        find_births(w, system, &n[system->emit.parent.system], own->births);
        find_living(w, system, own);
        add_work(w, system, own);
    }
    return true;
}

struct kiln_workload *kiln_workload_create(const struct kiln_scene *scene)
{
    struct kiln_workload *w = calloc(1, sizeof *w);
    struct numbers *n = calloc(KILN_MAX_SYSTEMS, sizeof *n);
    const double frame_s = (double)scene->fps.den / scene->fps.num;
    if (w) {
        const double before_s = (double)scene->warmup_steps * (double)scene->dt_s;
        const double all = ceil(before_s / frame_s) + scene->frames + 2.0;
        w->scene = scene;
        w->count = (uint32_t)fmin(all, MOST_SLOTS);
        w->start_s = -before_s - frame_s; /* a slot before the run, which the first frame shows */
        w->length_s = all / w->count * frame_s;
        w->steps = calloc(w->count, sizeof *w->steps);
        w->frames = calloc(w->count, sizeof *w->frames);
    }
    const bool ok = w && n && w->steps && w->frames && fill(w, n);
    for (uint32_t i = 0; n && i < KILN_MAX_SYSTEMS; i++)
        free(n[i].births);
    free(n);
    if (!ok)
        kiln_workload_destroy(&w);
    return w;
}

void kiln_workload_destroy(struct kiln_workload **workload)
{
    if (!*workload)
        return;
    free((*workload)->steps);
    free((*workload)->frames);
    free(*workload);
    *workload = NULL;
}

/* ---- questions ------------------------------------------------------------------------------- */

static uint32_t slot_of(const struct kiln_workload *w, double time_s)
{
    const double slot = (time_s - w->start_s) / w->length_s;
    return (uint32_t)fmin(fmax(slot, 0.0), w->count - 1.0);
}

double kiln_workload_frame(const struct kiln_workload *workload, uint32_t frame)
{
    const struct kiln_scene *scene = workload->scene;
    const double time_s = (double)frame * scene->fps.den / scene->fps.num;
    /* A frame shows the end of the slot before its time. */
    return workload->frames[slot_of(workload, time_s - (1.0 - 1e-6) * workload->length_s)];
}

double kiln_workload_steps(const struct kiln_workload *workload, uint32_t from, uint32_t to)
{
    const struct kiln_scene *scene = workload->scene;
    double work = 0.0;
    while (from < to) { /* slot by slot, since all steps of a slot are alike */
        const double time_s = ((double)from - scene->warmup_steps) * (double)scene->dt_s;
        const uint32_t slot = slot_of(workload, time_s);
        const double end_s = workload->start_s + (slot + 1.0) * workload->length_s;
        const double left = fmax(ceil((end_s - time_s) / (double)scene->dt_s), 1.0);
        const uint32_t steps = (uint32_t)fmin(left, to - from);
        work += steps * workload->steps[slot];
        from += steps;
    }
    return work;
}

/* Returns the first frame whose work differs by at most NEAR of the whole range from the least, or
 * from the most. An early frame needs fewer steps. */
static uint32_t find_frame(const struct kiln_workload *w, bool heaviest)
{
    double least = kiln_workload_frame(w, 0), most = least;
    for (uint32_t i = 1; i < w->scene->frames; i++) {
        const double work = kiln_workload_frame(w, i);
        /* not fmin and fmax, by which GCC 12 fails for arm64 */
        if (work < least)
            least = work;
        if (work > most)
            most = work;
    }
    const double slack = NEAR * (most - least);
    uint32_t frame = 0;
    while (heaviest ? kiln_workload_frame(w, frame) < most - slack
                    : kiln_workload_frame(w, frame) > least + slack)
        frame++;
    return frame;
}

uint32_t kiln_workload_lightest(const struct kiln_workload *workload)
{
    return find_frame(workload, false);
}

uint32_t kiln_workload_heaviest(const struct kiln_workload *workload)
{
    return find_frame(workload, true);
}
