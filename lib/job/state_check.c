/* Checks each value of a saved state against what steps can make. shaders/shared/step.h says what
 * that is: a particle beyond 2^20 m or m/s dies, and the numbers that are stored are rounded to 0
 * where they are tiny (exact_canon). spin.h limits spins and normalises poses, and
 * lib/sim/paint/paint.c limits the colours and opacities of paint. */
#include "job/state_check.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "scene/family.h"
#include "scene/scene_births.h"
#include "shared/derived.h"
#include "shared/step.h"

/* The most impacts that a scene lets particles count. */
static const uint32_t MOST_HITS = 1000;

/* Paint is mixed from colours of 0 to 1, and the mixture is rounded. */
static const float MOST_PAINT = 1.001f;

/* A fault that was found in a state; the text is empty where there is none. */
struct fault {
    char text[160];
};

#define FAULT(fault, ...) snprintf((fault)->text, sizeof(fault)->text, __VA_ARGS__)

/* ---- particles ------------------------------------------------------------------------------- */

/* Returns whether these are the bits of a number that steps store: 0, or of a size from 2^-100 to a
 * limit. */
static bool is_stored(uint32_t bits, uint32_t most_bits)
{
    const uint32_t size = bits & EXACT_SIZE_BITS;
    return bits == 0 || (size >= EXACT_TINY_BITS && size <= most_bits);
}

/* Checks the numbers along the three axes. most: the limit, a number. */
static bool check_axes(const uint32_t bits[3], float most, const char *what, struct fault *fault)
{
    for (int axis = 0; axis < 3; axis++) {
        if (is_stored(bits[axis], FLOAT_BITS(most)))
            continue;
        FAULT(fault, "%s along %c: found %g, expected 0 or a size of 2^-100 to %.0f", what,
              "xyz"[axis], (double)BITS_FLOAT(bits[axis]), (double)most);
        return false;
    }
    return true;
}

/* Checks the rest of a particle that has stopped, which has the place of a velocity. */
static void check_rest(const struct kiln_particle *p, uint32_t step, struct fault *fault)
{
    const uint4 rest = p->velocity_birth;
    const uint32_t stopped = rest.x >> KILN_REST_STEP_SHIFT;
    if (stopped < particle_birth_step(*p) || stopped > step)
        FAULT(fault, "step of its rest: found %u, expected %u to %u", stopped,
              particle_birth_step(*p), step);
    else if (rest.y > KILN_MAX_COLLIDERS)
        FAULT(fault, "object that it rides: found %u, expected 0 to %d", rest.y,
              KILN_MAX_COLLIDERS);
    else if (rest.z != 0 && (rest.z >> 16 == 0 || (rest.z & 65535) == 0))
        FAULT(fault, "heading of its rest: found %u, expected 0 or two numbers from 1 to 65535",
              rest.z);
}

/* Checks a particle in a slot, counted in its system. */
static bool check_particle(const struct kiln_particle *p, const struct kiln_pool_system *system,
                           uint32_t slot, uint32_t step, struct fault *fault)
{
    const uint4 place = p->position_serial, speed = p->velocity_birth;
    const uint32_t born = particle_birth_step(*p), serial = place.w;
    const float most = BITS_FLOAT(STEP_ABSURD_BITS);
    if (!particle_is_alive(*p)) {
        const struct kiln_particle left = particle_remains(*p);
        if (memcmp(&left, p, sizeof left) != 0 || (!particle_is_there(*p) && serial != 0))
            FAULT(fault, "found a dead particle that is not empty");
    }
    if (fault->text[0] != '\0' || !particle_is_there(*p))
        return fault->text[0] == '\0';
    if (born == 0 || born > step) {
        FAULT(fault, "step of birth: found %u, expected 1 to %u", born, step);
    } else if (serial >= system->next_serial || serial % system->capacity != slot) {
        FAULT(fault, "serial: found %u, expected one of this slot below %" PRIu64, serial,
              system->next_serial);
    } else if (particle_is_alive(*p) &&
               check_axes((const uint32_t[3]){place.x, place.y, place.z}, most, "position, m",
                          fault) &&
               particle_has_stopped(*p)) {
        check_rest(p, step, fault);
    } else if (fault->text[0] == '\0') {
        check_axes((const uint32_t[3]){speed.x, speed.y, speed.z}, most, "velocity, m/s", fault);
    }
    return fault->text[0] == '\0';
}

/* Checks a spin. The pose is of unit length, except in a slot that never had a particle. */
static bool check_spin(const struct kiln_spin *spin, bool alive, struct fault *fault)
{
    const uint4 rate = spin->rate, pose = spin->pose;
    const uint32_t bits[4] = {pose.x, pose.y, pose.z, pose.w};
    const bool empty = (pose.x | pose.y | pose.z | pose.w) == 0;
    if (!check_axes((const uint32_t[3]){rate.x, rate.y, rate.z}, SPIN_FASTEST, "spin, rad/s",
                    fault))
        return false;
    float square = 0.0f;
    for (int i = 0; i < 4; i++)
        square += BITS_FLOAT(bits[i]) * BITS_FLOAT(bits[i]);
    if (rate.w != 0)
        FAULT(fault, "the last word of the spin: found %u, expected 0", rate.w);
    else if ((!empty || alive) && !(fabsf(square - 1.0f) < 1e-3f))
        FAULT(fault, "pose: found a squared length of %g, expected 1", (double)square);
    return fault->text[0] == '\0';
}

/* Checks the way of a particle: three words, of which two may have any value. */
static bool check_way(const struct kiln_spin *way, struct fault *fault)
{
    const uint4 a = way->rate, b = way->pose;
    if (a.z > MOST_HITS)
        FAULT(fault, "impacts: found %u, expected 0 to %u", a.z, MOST_HITS);
    else if ((a.w | b.x | b.y | b.z | b.w) != 0)
        FAULT(fault, "way: found words that are not 0");
    return fault->text[0] == '\0';
}

/* ---- paint ----------------------------------------------------------------------------------- */

/* Returns the index of the first number that is not from 0 to the limit, or the count. */
static uint32_t find_outside(const float *numbers, uint32_t count, float most)
{
    uint32_t i = 0;
    while (i < count && numbers[i] >= 0.0f && numbers[i] <= most)
        i++;
    return i;
}

static bool check_texel(const float texel[4], struct fault *fault)
{
    const uint32_t channel = find_outside(texel, 4, MOST_PAINT);
    if (channel < 4)
        FAULT(fault, "channel %u: found %g, expected 0 to 1", channel, (double)texel[channel]);
    return channel == 4;
}

static bool check_splat(const struct kiln_splat *splat, struct fault *fault)
{
    const float numbers[] = {splat->position[0], splat->position[1],    splat->position[2],
                             splat->normal[0],   splat->normal[1],      splat->normal[2],
                             splat->slope,       splat->radius_squared, splat->opacity};
    float sizes = 0.0f;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        sizes += 0.0f * numbers[i]; /* NaN for infinity and NaN, otherwise 0 */
    const uint32_t channel = find_outside(splat->color, 3, 1.0f);
    if (sizes != 0.0f)
        FAULT(fault, "found a splat with a number that is not finite");
    else if (!(splat->opacity >= 0.0f && splat->opacity <= 1.0f))
        FAULT(fault, "opacity: found %g, expected 0 to 1", (double)splat->opacity);
    else if (channel < 3)
        FAULT(fault, "colour: found %g, expected 0 to 1", (double)splat->color[channel]);
    else if (splat->opacity > 0.0f && !(splat->radius_squared > 0.0f && splat->slope > 0.0f))
        FAULT(fault, "found a splat without a radius");
    return fault->text[0] == '\0';
}

/* Checks the paint of mesh number `mesh`, counted among those that take paint. */
static bool check_canvas(const struct kiln_canvas *canvas, uint32_t mesh, const char *path,
                         struct kiln_error *error)
{
    struct fault fault = {""};
    const size_t texels = (size_t)canvas->edge * canvas->edge;
    for (size_t i = 0; i < texels; i++) {
        if (!check_texel(canvas->texels[i], &fault))
            return kiln_error_set(error, KILN_INVALID_INPUT, "%s: painted mesh %u, texel %zu: %s",
                                  path, mesh, i, fault.text);
    }
    for (uint32_t i = 0; i < canvas->slot_count; i++) {
        if (!check_splat(&canvas->pending[i], &fault))
            return kiln_error_set(error, KILN_INVALID_INPUT,
                                  "%s: painted mesh %u, waiting splat %u: %s", path, mesh, i,
                                  fault.text);
    }
    return canvas->slot_count == 0 || canvas->next < canvas->slot_count ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: painted mesh %u: the next turn: found %u, expected less than %u",
                          path, mesh, canvas->next, canvas->slot_count);
}

/* ---- pools ----------------------------------------------------------------------------------- */

bool kiln_state_check_pool(struct kiln_pool *pool, uint32_t step, const char *path,
                           struct kiln_error *error)
{
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    const struct kiln_spin *spins = NULL;
    if (!records ||
        (pool->spins.size > 0 && !(spins = kiln_buffer_host(&pool->spins, KILN_READ, error))))
        return false;
    for (uint32_t i = 0; i < pool->system_count; i++) {
        const struct kiln_pool_system *system = &pool->systems[i];
        struct fault fault = {""};
        for (uint32_t slot = 0; slot < system->capacity; slot++) {
            const struct kiln_particle *particle = &records[system->base + slot];
            if (check_particle(particle, system, slot, step, &fault) &&
                (!spins || !system->spins ||
                 check_spin(&spins[system->first_spin + slot], particle_is_alive(*particle),
                            &fault)) &&
                (!spins || !system->travels || check_way(&spins[system->first_way + slot], &fault)))
                continue;
            return kiln_error_set(error, KILN_INVALID_INPUT, "%s: system %u, slot %u: %s", path, i,
                                  slot, fault.text);
        }
    }
    for (uint32_t i = 0; i < pool->canvas_count; i++) {
        if (!check_canvas(&pool->canvases[i], i, path, error))
            return false;
    }
    return true;
}

/* ---- births ---------------------------------------------------------------------------------- */

/* Counts the births of a system by a step, as kiln_sim_params_births does. The system's parent, if
 * it has one, is counted already. */
static void count_births(const struct kiln_scene *scene, uint32_t index, uint32_t step,
                         uint64_t serials[KILN_MAX_SYSTEMS], uint64_t *wait)
{
    const struct kiln_system *system = &scene->systems[index];
    const struct kiln_parent *parent = &system->emit.parent;
    serials[index] = 0;
    *wait = 0;
    if (!system->enabled)
        return;
    if (parent->enabled) {
        serials[index] = serials[parent->system] * parent->slots;
        return;
    }
    struct kiln_scene_births counted;
    struct kiln_births births;
    kiln_scene_births_init(&counted, scene, index);
    for (uint32_t i = 1; i <= step; i++) {
        kiln_births_step(&counted.source, i, wait, &births);
        serials[index] += births.count;
    }
}

/* Checks that slots of the dead are empty, unless children inherit their looks, and that no
 * particle of a system has been dead for a whole step. A step of tolerance is left
 * to devices that round ages in their own way. */
static bool check_ages(const struct kiln_particle *records, const struct kiln_pool_system *slots,
                       const struct kiln_scene *scene, uint32_t index, uint32_t step,
                       const char *path, struct kiln_error *error)
{
    const struct kiln_derived_params derived = kiln_scene_derived(scene, index);
    const bool kept = kiln_family_is_inherited(scene, index);
    for (uint32_t slot = 0; slot < slots->capacity; slot++) {
        const struct kiln_particle particle = records[slots->base + slot];
        if (!particle_is_alive(particle) && particle_is_there(particle) && !kept)
            return kiln_error_set(
                error, KILN_INVALID_INPUT,
                "%s: systems.%s, slot %u: found a dead particle that is not empty", path,
                scene->systems[index].name, slot);
        if (!particle_is_alive(particle))
            continue;
        const float age_s = particle_age(particle, step, derived.dt_s);
        const float life_s = particle_life_s(scene->keys, derived, particle);
        if (!(age_s - derived.dt_s < life_s))
            return kiln_error_set(
                error, KILN_INVALID_INPUT,
                "%s: systems.%s, slot %u: age: found %g s, expected less than the "
                "life of %g s",
                path, scene->systems[index].name, slot, (double)age_s, (double)life_s);
    }
    return true;
}

/* Returns the number of colliders of a scene. */
static uint32_t count_colliders(const struct kiln_scene *scene)
{
    const struct kiln_backdrop *backdrop = &scene->backdrop;
    uint32_t count = kiln_backdrop_floor_collides(backdrop);
    for (uint32_t i = 0; i < backdrop->object_count; i++)
        count += backdrop->objects[i].collide;
    return count;
}

/* Checks that particles have stopped only where impacts stop them, and ride objects of the scene
 * only where these carry them. */
static bool check_rides(const struct kiln_particle *records, const struct kiln_pool_system *slots,
                        const struct kiln_scene *scene, uint32_t index, const char *path,
                        struct kiln_error *error)
{
    const char *name = scene->systems[index].name;
    const struct kiln_collide *collide = &scene->systems[index].collide;
    const enum kiln_then then = collide->enabled ? collide->then : KILN_THEN_BOUNCE;
    const uint32_t most = then == KILN_THEN_STICK ? count_colliders(scene) : 0;
    for (uint32_t slot = 0; slot < slots->capacity; slot++) {
        const struct kiln_particle particle = records[slots->base + slot];
        if (!particle_has_stopped(particle))
            continue;
        if (then < KILN_THEN_STOP && !kiln_family_lies_from_birth(&scene->systems[index]))
            return kiln_error_set(error, KILN_INVALID_INPUT,
                                  "%s: systems.%s, slot %u: found a particle that has stopped, "
                                  "which nothing stops",
                                  path, name, slot);
        if (particle.velocity_birth.y > most)
            return kiln_error_set(error, KILN_INVALID_INPUT,
                                  "%s: systems.%s, slot %u: object that it rides: found %u, "
                                  "expected 0 to %u",
                                  path, name, slot, particle.velocity_birth.y, most);
    }
    return true;
}

bool kiln_state_check_births(struct kiln_pool *pool, const struct kiln_scene *scene, uint32_t step,
                             const char *path, struct kiln_error *error)
{
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    uint64_t serials[KILN_MAX_SYSTEMS], wait;
    uint32_t order[KILN_MAX_SYSTEMS];
    if (!records)
        return false;
    kiln_family_order(scene, order);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_pool_system *slots = &pool->systems[order[i]];
        const char *name = scene->systems[order[i]].name;
        count_births(scene, order[i], step, serials, &wait);
        if (slots->next_serial != serials[order[i]])
            return kiln_error_set(error, KILN_INVALID_INPUT,
                                  "%s: systems.%s: found %" PRIu64 " births by step %u, expected "
                                  "%" PRIu64,
                                  path, name, slots->next_serial, step, serials[order[i]]);
        if (slots->birth_wait != wait)
            return kiln_error_set(error, KILN_INVALID_INPUT,
                                  "%s: systems.%s: the wait for the next birth: found %" PRIu64
                                  ", expected %" PRIu64,
                                  path, name, slots->birth_wait, wait);
        if (!check_ages(records, slots, scene, order[i], step, path, error) ||
            !check_rides(records, slots, scene, order[i], path, error))
            return false;
    }
    return true;
}
