/* This file computes the frames of nodes.
 *
 * A frame is the product of those of its chain of parents, and of the pose that a file of nodes
 * has. Its rates follow from those of values and paths by the rules of differentiation, so that a
 * simulation knows the way of a node between two steps to the fourth order. */
#include "scene/node.h"

#include <math.h>
#include <string.h>

#include "asset/geometry/rig.h"
#include "base/matrix.h"
#include "scene/double3.h"
#include "scene/node_cache.h"
#include "scene/scene.h"
#include "shared/exact.h"
#include "shared/random.h"

/* ---- quaternions: x, y, z, w ----------------------------------------------------------------- */

/* Computes the rotation by b, then by a. y may be neither of them. */
static void multiply(double y[4], const double a[4], const double b[4])
{
    double square = 0;
    y[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
    y[1] = a[3] * b[1] + a[1] * b[3] + a[2] * b[0] - a[0] * b[2];
    y[2] = a[3] * b[2] + a[2] * b[3] + a[0] * b[1] - a[1] * b[0];
    y[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
    for (int c = 0; c < 4; c++)
        square += y[c] * y[c];
    for (int c = 0; c < 4; c++)
        y[c] /= sqrt(square);
}

/* Makes the quaternion of a rotation about one axis, by half of the angle. */
static void about_axis(double y[4], int axis, struct exact_angle half)
{
    y[0] = y[1] = y[2] = 0;
    y[axis] = (double)half.sine;
    y[3] = (double)half.cosine;
}

void kiln_node_turn_of_angles(float3 angles, double turn[4])
{
    double x[4], y[4], z[4], both[4];
    about_axis(x, 0, exact_sincos(0.5f * angles.x));
    about_axis(y, 1, exact_sincos(0.5f * angles.y));
    about_axis(z, 2, exact_sincos(0.5f * angles.z));
    multiply(both, y, x);
    multiply(turn, z, both);
}

/* Makes the quaternion of the rotation that takes z to `ahead` and y to `up`. */
static void turn_of_frame(double turn[4], const double ahead[3], const double up[3])
{
    double m[3][3]; /* columns */
    double3_cross(m[0], up, ahead);
    memcpy(m[1], up, sizeof m[1]);
    memcpy(m[2], ahead, sizeof m[2]);
    const double trace = m[0][0] + m[1][1] + m[2][2];
    if (trace > 0) {
        const double s = 2 * sqrt(1 + trace);
        turn[0] = (m[1][2] - m[2][1]) / s;
        turn[1] = (m[2][0] - m[0][2]) / s;
        turn[2] = (m[0][1] - m[1][0]) / s;
        turn[3] = 0.25 * s;
        return;
    }
    const int i = m[0][0] > m[1][1] ? (m[0][0] > m[2][2] ? 0 : 2) : (m[1][1] > m[2][2] ? 1 : 2);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = 2 * sqrt(1 + m[i][i] - m[j][j] - m[k][k]);
    turn[i] = 0.25 * s;
    turn[j] = (m[i][j] + m[j][i]) / s;
    turn[k] = (m[i][k] + m[k][i]) / s;
    turn[3] = (m[j][k] - m[k][j]) / s;
}

/* The rotation that takes the axis that is ahead to z, for each word of `ahead`. */
#define ROOT_HALF 0.70710678118654752
static const double TO_Z[][4] = {
    [KILN_AHEAD_Z] = {0, 0, 0, 1},
    [KILN_AHEAD_Y] = {ROOT_HALF, 0, 0, ROOT_HALF},
    [KILN_AHEAD_X] = {0, -ROOT_HALF, 0, ROOT_HALF},
    [KILN_AHEAD_MINUS_Z] = {0, 1, 0, 0},
    [KILN_AHEAD_MINUS_Y] = {-ROOT_HALF, 0, 0, ROOT_HALF},
    [KILN_AHEAD_MINUS_X] = {0, ROOT_HALF, 0, ROOT_HALF},
};

/* ---- frames ---------------------------------------------------------------------------------- */

/* The two moments of a frame, for values. */
struct moments {
    const float4 *keys;
    struct value_clocks now, rates;
};

/* Returns whether a value that repeats is at its last key at a time. It is so only by rounding,
 * since there the next turn begins; but a last key has no slope. */
static bool is_at_last_key(const struct moments *m, const struct kiln_value *value)
{
    return value->count > 0 && VALUE_CLOCK(value->how) == KILN_CLOCK_TIME &&
           VALUE_REPEAT(value->how) != VALUE_HOLDS &&
           value_repeated(m->keys, *value, m->rates.time_s).x >=
               m->keys[value->first + value->count - 1].x;
}

static float rate_of(const struct moments *m, const struct kiln_value *value)
{
    struct value_clocks clocks = m->rates;
    const float side = clocks.time_s < m->now.time_s ? -INFINITY : INFINITY;
    const int ulps = is_at_last_key(m, value) ? 4 : 0;
    for (int i = 0; i < ulps; i++)
        clocks.time_s = nextafterf(clocks.time_s, side);
    return value_rate_at(m->keys, *value, clocks);
}

static float3 rates_of(const struct moments *m, const struct kiln_value3 *value)
{
    return FLOAT3(rate_of(m, &value->x), rate_of(m, &value->y), rate_of(m, &value->z));
}

/* Sets the rotation by angles, and the spin that their rates are. */
static void set_rotation(struct kiln_node_frame *frame, const struct moments *m,
                         const struct kiln_value3 *rotation)
{
    const float3 angles = value3_at(m->keys, *rotation, m->now), rates = rates_of(m, rotation);
    double about_z[4], about_both[4], y[4], of_y[3], of_x[3];
    kiln_node_turn_of_angles(angles, frame->turn);
    about_axis(about_z, 2, exact_sincos(0.5f * angles.z));
    about_axis(y, 1, exact_sincos(0.5f * angles.y));
    multiply(about_both, about_z, y);
    double3_rotate(of_y, about_z, (const double[3]){0, (double)rates.y, 0});
    double3_rotate(of_x, about_both, (const double[3]){(double)rates.x, 0, 0});
    for (int c = 0; c < 3; c++)
        frame->spin[c] = of_x[c] + of_y[c] + (c == 2 ? (double)rates.z : 0);
}

/* Turns a frame along its path, outside of its own rotation. */
static void set_heading(struct kiln_node_frame *frame, const struct kiln_path_place *place,
                        enum kiln_ahead ahead)
{
    double along[4], heading[4], inside[4], spin[3];
    turn_of_frame(along, place->ahead, place->up);
    multiply(heading, along, TO_Z[ahead]);
    memcpy(inside, frame->turn, sizeof inside);
    multiply(frame->turn, heading, inside);
    double3_rotate(spin, heading, frame->spin);
    for (int c = 0; c < 3; c++)
        frame->spin[c] = spin[c] + place->spin[c];
}

/* Returns the frame of a place, a rotation by angles and a scale. */
static struct kiln_node_frame frame_of(const struct moments *m, const struct kiln_value3 *position,
                                       const struct kiln_value3 *rotation,
                                       const struct kiln_value *scale)
{
    const float3 at = value3_at(m->keys, *position, m->now), velocity = rates_of(m, position);
    struct kiln_node_frame frame = {
        .at = {(double)at.x, (double)at.y, (double)at.z},
        .velocity = {(double)velocity.x, (double)velocity.y, (double)velocity.z},
        .scale = (double)value_at(m->keys, *scale, m->now),
        .growth = (double)rate_of(m, scale),
    };
    set_rotation(&frame, m, rotation);
    return frame;
}

/* Returns the frame in its parent that a node would have without its file. */
static struct kiln_node_frame frame_of_keys(const struct kiln_scene *scene,
                                            const struct kiln_scene_node *node,
                                            const struct moments *m)
{
    if (node->mesh) {
        const struct kiln_object *object = &scene->backdrop.objects[node->object];
        return frame_of(m, &object->center, &object->rotation, &object->scale);
    }
    struct kiln_node_frame frame =
        frame_of(m, &node->position.value, &node->rotation, &node->scale);
    if (node->position.path.points.count > 0) {
        const struct kiln_path_place place =
            kiln_path_at(&node->position.path, m->now.time_s, m->rates.time_s);
        memcpy(frame.at, place.at, sizeof frame.at);
        memcpy(frame.velocity, place.velocity, sizeof frame.velocity);
        if (node->heading == KILN_HEADING_PATH)
            set_heading(&frame, &place, node->ahead);
    }
    return frame;
}

/* Returns the frame of a node of a file in the file's space. */
static struct kiln_node_frame frame_of_file(const struct kiln_scene *scene, uint32_t node,
                                            const struct moments *m)
{
    const struct kiln_animation *animation = kiln_node_animation(scene, node);
    struct kiln_rig_moment moment = {.clip = KILN_RIG_AT_REST};
    if (animation)
        moment = (struct kiln_rig_moment){
            .clip = animation->number,
            .seconds = kiln_scene_animation_s(animation, m->now.time_s),
            .rate_seconds = kiln_scene_animation_s(animation, m->rates.time_s),
            .rate_is_behind = animation->speed.constant < 0.0f,
            .clip_s_each_s = (double)kiln_scene_animation_speed(animation, m->rates.time_s),
        };
    const struct kiln_scene_node *n = &scene->nodes[node];
    const struct kiln_rig_pose pose = kiln_rig_pose_at(n->rig, n->rig_node, &moment);
    struct kiln_node_frame frame = {.scale = pose.scale, .growth = pose.growth};
    memcpy(frame.at, pose.at, sizeof frame.at);
    memcpy(frame.velocity, pose.velocity, sizeof frame.velocity);
    memcpy(frame.spin, pose.spin, sizeof frame.spin);
    turn_of_frame(frame.turn, pose.ahead, pose.up);
    return frame;
}

/* Returns a frame that lies in another one, in the world. */
static struct kiln_node_frame inside_of(const struct kiln_node_frame *parent,
                                        const struct kiln_node_frame *own)
{
    struct kiln_node_frame frame = {.scale = parent->scale * own->scale,
                                    .growth =
                                        parent->growth * own->scale + parent->scale * own->growth};
    double at[3], moved[3], carried[3], spin[3], inside[3];
    double3_rotate(at, parent->turn, own->at);
    double3_rotate(spin, parent->turn, own->spin);
    for (int c = 0; c < 3; c++)
        inside[c] = parent->growth * own->at[c] + parent->scale * own->velocity[c];
    double3_rotate(moved, parent->turn, inside);
    for (int c = 0; c < 3; c++)
        at[c] *= parent->scale;
    double3_cross(carried, parent->spin, at);
    for (int c = 0; c < 3; c++) {
        frame.at[c] = parent->at[c] + at[c];
        frame.velocity[c] = parent->velocity[c] + carried[c] + moved[c];
        frame.spin[c] = parent->spin[c] + spin[c];
    }
    multiply(frame.turn, parent->turn, own->turn);
    return frame;
}

/* Returns the frame of a node in that of its parent. */
static struct kiln_node_frame own_frame(const struct kiln_scene *scene, uint32_t node,
                                        const struct moments *m)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    const struct kiln_node_frame outer = frame_of_keys(scene, n, m);
    if (!n->rig)
        return outer;
    const struct kiln_node_frame inner = frame_of_file(scene, node, m);
    return inside_of(&outer, &inner);
}

static struct moments moments_at(const struct kiln_scene *scene, float time_s, float rate_s)
{
    const uint32_t key = random_noise_key(scene->seed);
    return (struct moments){scene->keys, value_clocks_at(time_s, key, key),
                            value_clocks_at(rate_s, key, key)};
}

/* Does own_frame for a node that others may have asked for. */
static struct kiln_node_frame known_frame(const struct kiln_scene *scene, uint32_t node,
                                          const struct moments *m)
{
    struct kiln_node_cache *cache = scene->node_cache;
    const float time_s = m->now.time_s, rate_s = m->rates.time_s;
    struct kiln_node_frame frame;
    if (cache && kiln_node_cache_find(cache, KILN_NODE_FRAME_OWN, node, time_s, rate_s, &frame))
        return frame;
    frame = own_frame(scene, node, m);
    if (cache)
        kiln_node_cache_keep(cache, KILN_NODE_FRAME_OWN, node, time_s, rate_s, &frame);
    return frame;
}

struct kiln_node_frame kiln_node_frame_at(const struct kiln_scene *scene, uint32_t node,
                                          float time_s, float rate_s)
{
    struct kiln_node_cache *cache = scene->node_cache;
    struct kiln_node_frame frame;
    if (cache && kiln_node_cache_find(cache, KILN_NODE_FRAME_WORLD, node, time_s, rate_s, &frame))
        return frame;
    const struct moments m = moments_at(scene, time_s, rate_s);
    frame = known_frame(scene, node, &m);
    for (const struct kiln_attach *parent = kiln_node_outer(scene, node); parent->name;
         parent = kiln_node_outer(scene, parent->node)) {
        const struct kiln_node_frame outer = known_frame(scene, parent->node, &m);
        frame = inside_of(&outer, &frame);
    }
    if (cache)
        kiln_node_cache_keep(cache, KILN_NODE_FRAME_WORLD, node, time_s, rate_s, &frame);
    return frame;
}

struct kiln_node_frame kiln_object_frame_at(const struct kiln_scene *scene,
                                            const struct kiln_object *object, float time_s,
                                            float rate_s)
{
    const struct moments m = moments_at(scene, time_s, rate_s);
    const struct kiln_node_frame frame =
        frame_of(&m, &object->center, &object->rotation, &object->scale);
    if (!object->attach.name)
        return frame;
    const struct kiln_node_frame outer =
        kiln_node_frame_at(scene, object->attach.node, time_s, rate_s);
    return inside_of(&outer, &frame);
}

/* ---- steps ----------------------------------------------------------------------------------- */

/* Returns how far a quantity may come from where the mean of its rates at both ends of a step would
 * bring it. A corner of its curve within the step explains the difference of the rates, and a bend
 * a part of the rates. What is farther has jumped. */
static double explained(const double from[3], const double to[3], double dt_s)
{
    const double change[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    return dt_s * (double3_length(change) + 0.25 * (double3_length(from) + double3_length(to)));
}

static bool place_jumps(const struct kiln_node_frame *start, const struct kiln_node_frame *end,
                        double dt_s)
{
    double off[3];
    for (int c = 0; c < 3; c++)
        off[c] = end->at[c] - start->at[c] - 0.5 * dt_s * (start->velocity[c] + end->velocity[c]);
    return double3_length(off) >
           explained(start->velocity, end->velocity, dt_s) + 1e-6 * (1 + double3_length(start->at));
}

/* Rotates a pose further by a spin that lasts for a time. */
static void spin_on(double y[4], const double turn[4], const double spin[3], double time_s)
{
    const double rate = double3_length(spin);
    const struct exact_angle half = exact_sincos((float)(0.5 * rate * time_s));
    double by[4] = {0, 0, 0, (double)half.cosine};
    for (int c = 0; c < 3 && rate > 0; c++)
        by[c] = spin[c] / rate * (double)half.sine;
    multiply(y, by, turn);
}

static bool turn_jumps(const struct kiln_node_frame *start, const struct kiln_node_frame *end,
                       double dt_s)
{
    const double limit = explained(start->spin, end->spin, dt_s) + 1e-4;
    double mean[3], wanted[4], off[4];
    if (limit > 3.14)
        return false;
    for (int c = 0; c < 3; c++)
        mean[c] = 0.5 * (start->spin[c] + end->spin[c]);
    spin_on(wanted, start->turn, mean, dt_s);
    multiply(off, end->turn, (const double[4]){-wanted[0], -wanted[1], -wanted[2], wanted[3]});
    return double3_length(off) > (double)exact_sincos((float)(0.5 * limit)).sine;
}

static bool scale_jumps(const struct kiln_node_frame *start, const struct kiln_node_frame *end,
                        double dt_s)
{
    const double off = end->scale - start->scale - 0.5 * dt_s * (start->growth + end->growth);
    const double from[3] = {start->growth, 0, 0}, to[3] = {end->growth, 0, 0};
    return fabs(off) > explained(from, to, dt_s) + 1e-6 * start->scale;
}

/* Lets what jumps between the frames of a node at both ends of a step go on as before instead: the
 * place, the rotation and the scale, each by itself. Returns whether something jumps. */
static bool go_on(const struct kiln_node_frame *start, struct kiln_node_frame *end, double dt_s)
{
    const bool place = place_jumps(start, end, dt_s), turn = turn_jumps(start, end, dt_s);
    const bool scale = scale_jumps(start, end, dt_s);
    if (place) {
        memcpy(end->velocity, start->velocity, sizeof end->velocity);
        for (int c = 0; c < 3; c++)
            end->at[c] = start->at[c] + dt_s * start->velocity[c];
    }
    if (turn) {
        memcpy(end->spin, start->spin, sizeof end->spin);
        spin_on(end->turn, start->turn, start->spin, dt_s);
    }
    if (scale) {
        const double grown = start->scale + dt_s * start->growth;
        end->scale = grown > 0 ? grown : start->scale;
        end->growth = grown > 0 ? start->growth : 0;
    }
    return place || turn || scale;
}

/* The moments of a step, and its length, s. */
struct step_moments {
    struct moments first, last;
    double dt_s;
};

static struct step_moments moments_of(const struct kiln_scene *scene, uint32_t step)
{
    const float start_s = kiln_scene_time(scene, step - 1), end_s = kiln_scene_time(scene, step);
    return (struct step_moments){
        .first = moments_at(scene, start_s, start_s),
        .last = moments_at(scene, end_s, nextafterf(end_s, -INFINITY)),
        .dt_s = (double)scene->rate.den / (double)scene->rate.num,
    };
}

/* Returns the frames in the world of what has two frames in a node, or in the world itself. */
static struct kiln_node_step step_in(const struct kiln_scene *scene,
                                     const struct kiln_attach *outer, const struct step_moments *m,
                                     const struct kiln_node_frame *first,
                                     const struct kiln_node_frame *last)
{
    struct kiln_node_step found = {.start = *first, .end = *last, .on = *last};
    found.jumps = go_on(first, &found.on, m->dt_s);
    for (; outer->name; outer = kiln_node_outer(scene, outer->node)) {
        const struct kiln_node_frame start = known_frame(scene, outer->node, &m->first);
        const struct kiln_node_frame end = known_frame(scene, outer->node, &m->last);
        struct kiln_node_frame on = end;
        found.jumps |= go_on(&start, &on, m->dt_s);
        found.start = inside_of(&start, &found.start);
        found.end = inside_of(&end, &found.end);
        found.on = inside_of(&on, &found.on);
    }
    return found;
}

struct kiln_node_step kiln_node_step_at(const struct kiln_scene *scene, uint32_t node,
                                        uint32_t step)
{
    const struct step_moments m = moments_of(scene, step);
    const struct kiln_node_frame first = known_frame(scene, node, &m.first);
    const struct kiln_node_frame last = known_frame(scene, node, &m.last);
    return step_in(scene, kiln_node_outer(scene, node), &m, &first, &last);
}

struct kiln_node_step kiln_object_step_at(const struct kiln_scene *scene,
                                          const struct kiln_object *object, uint32_t step)
{
    const struct step_moments m = moments_of(scene, step);
    const struct kiln_node_frame first =
        frame_of(&m.first, &object->center, &object->rotation, &object->scale);
    const struct kiln_node_frame last =
        frame_of(&m.last, &object->center, &object->rotation, &object->scale);
    return step_in(scene, &object->attach, &m, &first, &last);
}

/* ---- questions ------------------------------------------------------------------------------- */

const struct kiln_attach *kiln_node_outer(const struct kiln_scene *scene, uint32_t node)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    return n->mesh ? &scene->backdrop.objects[n->object].attach : &n->parent;
}

const struct kiln_animation *kiln_node_animation(const struct kiln_scene *scene, uint32_t node)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    const struct kiln_animation *animation =
        n->mesh ? &scene->backdrop.objects[n->object].animation : &n->animation;
    return n->rig && animation->enabled ? animation : NULL;
}

static bool are_constant(const struct kiln_value3 *position, const struct kiln_value3 *rotation,
                         const struct kiln_value *scale)
{
    return kiln_value3_is_constant(position) && kiln_value3_is_constant(rotation) &&
           scale->count == 0;
}

bool kiln_node_stands(const struct kiln_scene *scene, uint32_t node)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    const struct kiln_object *object = n->mesh ? &scene->backdrop.objects[n->object] : NULL;
    const struct kiln_attach *outer = kiln_node_outer(scene, node);
    const bool stands =
        n->position.path.points.count == 0 && !kiln_node_animation(scene, node) &&
        are_constant(&n->position.value, &n->rotation, &n->scale) &&
        (!object || are_constant(&object->center, &object->rotation, &object->scale));
    return stands && (!outer->name || kiln_node_stands(scene, outer->node));
}

bool kiln_node_carries(const struct kiln_scene *scene, uint32_t node, uint32_t other)
{
    const struct kiln_attach *outer = kiln_node_outer(scene, other);
    while (other != node && outer->name) {
        other = outer->node;
        outer = kiln_node_outer(scene, other);
    }
    return other == node;
}
