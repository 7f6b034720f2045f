/* This file finds systems whose particles move so little in a step that rounding their positions
 * changes their speed.
 *
 * A position is a 32-bit float. The floats next to x lie an ulp apart: 2^-17 m at 100 m. A step
 * adds velocity * dt and rounds the sum to the nearest float, so it is wrong by up to half an ulp.
 * At a constant velocity, each step is rounded the same way, so that the error of the speed does
 * not vanish on average: a step of 50 ulps is true to 1 %, and one of less than half an ulp does
 * nothing.
 *
 * The speed that is compared is an estimate from above: births, air and accelerations are added, as
 * if all had one direction. Of a range of speeds at birth, it takes the value that a quarter of the
 * births stay below. Nothing is said where the speed or the place is not known before the run: with
 * grids of air, points of attraction, regions of forces, interactions, an inherited velocity, or an
 * emitter that is attached to a node. */
#include "scene/small_steps.h"

#include <math.h>
#include <stdio.h>

#include "scene/scene.h"

enum { TRUE_ULPS = 50 }; /* half an ulp is 1 % of these */

static float ulp_at(float metres)
{
    return nextafterf(metres, INFINITY) - metres;
}

double kiln_small_steps_true_speed(float place, double rate)
{
    return TRUE_ULPS * (double)ulp_at(place) * rate;
}

/* Returns the greatest magnitude of a value at any time. */
static float most(const struct kiln_scene *scene, const struct kiln_value *value)
{
    return fmaxf(fabsf(kiln_scene_value_max(scene, value)),
                 fabsf(kiln_scene_value_min(scene, value)));
}

static float most_length(const struct kiln_scene *scene, const struct kiln_value3 *vector)
{
    const float x = most(scene, &vector->x), y = most(scene, &vector->y);
    const float z = most(scene, &vector->z);
    return sqrtf(x * x + y * y + z * z);
}

static const struct kiln_value *component(const struct kiln_value3 *vector, int axis)
{
    return axis == 0 ? &vector->x : axis == 1 ? &vector->y : &vector->z;
}

/* ---- speed ----------------------------------------------------------------------------------- */

/* Returns the speed at birth that a quarter of the births stay below; if the range begins at 0, a
 * quarter of its upper end. */
static float slow_birth(const struct kiln_scene *scene, const struct kiln_emitter *emit)
{
    const float low = kiln_scene_value_max(scene, &emit->speed.min);
    const float high = kiln_scene_value_max(scene, &emit->speed.max);
    return low + 0.25f * (high - low);
}

/* Sums up what forces do: the speed of moving air, accelerations, the rate at which particles take
 * up the air's velocity, and the lowest limit of the speed. */
struct drive {
    float air, acceleration, pull, limit;
    bool known;
};

static void add_air(struct drive *drive, const struct kiln_scene *scene,
                    const struct kiln_force *force, float air)
{
    const float pull = most(scene, &force->pull);
    drive->known &= force->mode == KILN_WIND_PULL || air == 0.0f;
    drive->air += pull > 0.0f ? air : 0.0f;
    drive->pull += pull;
}

static void add_force(struct drive *drive, const struct kiln_scene *scene,
                      const struct kiln_force *force)
{
    const float strength = most(scene, &force->strength);
    drive->known &= !force->region.enabled;
    switch (force->kind) {
    case KILN_FORCE_GRAVITY:
        drive->acceleration += most_length(scene, &force->acceleration);
        break;
    case KILN_FORCE_DRAG:
        drive->pull += most(scene, &force->pull);
        break;
    case KILN_FORCE_WIND:
        add_air(drive, scene, force, most_length(scene, &force->air));
        break;
    case KILN_FORCE_CURL:
        add_air(drive, scene, force, strength);
        break;
    case KILN_FORCE_VORTEX:
        add_air(drive, scene, force,
                strength + most(scene, &force->inward) + most(scene, &force->lift));
        break;
    case KILN_FORCE_LIMIT:
        drive->limit = fminf(drive->limit, most(scene, &force->speed));
        break;
    case KILN_FORCE_FIELD:
    case KILN_FORCE_ATTRACT:
        drive->known &= strength == 0.0f;
        break;
    default:
        drive->known = false;
    }
}

/* Estimates a speed of particles that live for `life_s`; infinity where it is not known. */
static float find_speed(const struct kiln_scene *scene, const struct kiln_system *system,
                        float life_s)
{
    struct drive drive = {.limit = INFINITY,
                          .known = system->interaction_count == 0 &&
                                   most(scene, &system->emit.inherit) == 0.0f};
    for (uint32_t i = 0; i < system->force_count; i++)
        add_force(&drive, scene, &system->forces[i]);
    /* the terminal speed, or the mean speed of particles that do not reach it */
    const float fall = drive.acceleration / fmaxf(drive.pull, 2.0f / life_s);
    const float speed = slow_birth(scene, &system->emit) + drive.air + fall;
    return drive.known ? fminf(speed, drive.limit) : INFINITY;
}

/* ---- place ----------------------------------------------------------------------------------- */

/* Returns whether particles can have a velocity along an axis. */
static bool moves_along(const struct kiln_scene *scene, const struct kiln_system *system, int axis)
{
    const struct kiln_emitter *emit = &system->emit;
    return emit->outward || system->force_count > 0 || system->collide.enabled ||
           emit->parent.enabled || most(scene, &emit->angle) > 0.0f ||
           most(scene, component(&emit->direction, axis)) > 0.0f;
}

/* Returns how far from the origin the shape of an emitter reaches along an axis. Children are born
 * around their parents, at the places of whose births they are counted. */
static float find_reach(const struct kiln_scene *scene, const struct kiln_system *system, int axis)
{
    const struct kiln_emitter *emit = &system->emit;
    float reach = most(scene, component(&emit->origin, axis)) + most(scene, &emit->radius);
    if (emit->shape == KILN_EMITTER_BOX || emit->shape == KILN_EMITTER_LINE)
        reach += 0.5f * most(scene, component(&emit->size, axis));
    const struct kiln_parent *parent = &emit->parent;
    return parent->enabled ? reach + find_reach(scene, &scene->systems[parent->system], axis)
                           : reach;
}

/* ---- warning --------------------------------------------------------------------------------- */

static void warn(struct kiln_reader *reader, const struct kiln_node *root,
                 const struct kiln_system *system, float speed, float place)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const double rate = (double)scene->rate.num / (double)scene->rate.den;
    const double ulp = (double)ulp_at(place), error = 0.5 * ulp * rate / (double)speed;
    char path[128], loss[64];
    snprintf(path, sizeof path, "systems.%s.%s", system->name,
             slow_birth(scene, &system->emit) > 0.0f ? "emit.speed" : "forces");
    if (error < 1.0)
        snprintf(loss, sizeof loss, "their speed is up to %.2g %% off", 100.0 * error);
    else
        snprintf(loss, sizeof loss, "they may not move at all");
    kiln_reader_warn_at(reader, root, path,
                        "a step of particles at %.3g m/s is %.2g m, and positions %.*f m from the "
                        "origin are multiples of %.2g m, so that %s; at %.6g steps a second, "
                        "speeds from %.3g m/s on are true to 1 %% there: lower simulation.rate, "
                        "or move the scene to the origin",
                        (double)speed, (double)speed / rate, place < 10.0f ? 2 : 0, (double)place,
                        ulp, loss, rate, kiln_small_steps_true_speed(place, rate));
}

static void check_system(struct kiln_reader *reader, const struct kiln_node *root,
                         const struct kiln_system *system)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const float end_s = kiln_scene_time(scene, kiln_scene_frame_step(scene, scene->frames - 1));
    const float start_s = kiln_scene_time(scene, 0);
    const float life_s = fminf(most(scene, &system->emit.life.max), end_s - start_s);
    const float speed = life_s > 0.0f ? find_speed(scene, system, life_s) : 0.0f;
    const double rate = (double)scene->rate.num / (double)scene->rate.den;
    float place = 0.0f;
    for (int axis = 0; axis < 3; axis++) {
        if (moves_along(scene, system, axis))
            place = fmaxf(place, find_reach(scene, system, axis));
    }
    /* a particle that flies straight ahead gets farther away, where the ulp is greater */
    place += speed * life_s;
    if (speed > 0.0f && isfinite(place) && (double)speed < kiln_small_steps_true_speed(place, rate))
        warn(reader, root, system, speed, place);
}

void kiln_small_steps_warn(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (scene->systems[i].enabled && !scene->systems[i].emit.attach.name)
            check_system(reader, root, &scene->systems[i]);
    }
}
