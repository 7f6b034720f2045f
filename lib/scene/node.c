/* This file computes the frames of nodes, and takes what is attached to a node to the world.
 *
 * A frame is the product of those of its chain of parents. Its rates follow from those of values
 * and paths by the rules of differentiation, so that a simulation knows the way of a node between
 * two steps to the fourth order. */
#include "scene/node.h"

#include <math.h>
#include <string.h>

#include "base/matrix.h"
#include "scene/double3.h"
#include "scene/node_cache.h"
#include "scene/scene.h"
#include "shared/exact.h"
#include "shared/random.h"

/* ---- quaternions: x, y, z, w ----------------------------------------------------------------- */

/* Rotates v by a unit quaternion. */
static void rotate(double y[3], const double turn[4], const double v[3])
{
    double across[3], more[3];
    double3_cross(across, turn, v);
    double3_cross(more, turn, across);
    for (int c = 0; c < 3; c++)
        y[c] = v[c] + 2 * (turn[3] * across[c] + more[c]);
}

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
    rotate(of_y, about_z, (const double[3]){0, (double)rates.y, 0});
    rotate(of_x, about_both, (const double[3]){(double)rates.x, 0, 0});
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
    rotate(spin, heading, frame->spin);
    for (int c = 0; c < 3; c++)
        frame->spin[c] = spin[c] + place->spin[c];
}

/* Returns the frame of a node in that of its parent. */
static struct kiln_node_frame own_frame(const struct kiln_scene_node *node, const struct moments *m)
{
    struct kiln_node_frame frame = {.scale = (double)value_at(m->keys, node->scale, m->now),
                                    .growth = (double)rate_of(m, &node->scale)};
    set_rotation(&frame, m, &node->rotation);
    if (node->position.path.points.count > 0) {
        const struct kiln_path_place place =
            kiln_path_at(&node->position.path, m->now.time_s, m->rates.time_s);
        memcpy(frame.at, place.at, sizeof frame.at);
        memcpy(frame.velocity, place.velocity, sizeof frame.velocity);
        if (node->heading == KILN_HEADING_PATH)
            set_heading(&frame, &place, node->ahead);
        return frame;
    }
    const float3 at = value3_at(m->keys, node->position.value, m->now);
    const float3 velocity = rates_of(m, &node->position.value);
    memcpy(frame.at, (const double[3]){(double)at.x, (double)at.y, (double)at.z}, sizeof frame.at);
    memcpy(frame.velocity,
           (const double[3]){(double)velocity.x, (double)velocity.y, (double)velocity.z},
           sizeof frame.velocity);
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
    rotate(at, parent->turn, own->at);
    rotate(spin, parent->turn, own->spin);
    for (int c = 0; c < 3; c++)
        inside[c] = parent->growth * own->at[c] + parent->scale * own->velocity[c];
    rotate(moved, parent->turn, inside);
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
    frame = own_frame(&scene->nodes[node], m);
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
    for (const struct kiln_attach *parent = &scene->nodes[node].parent; parent->name;
         parent = &scene->nodes[parent->node].parent) {
        const struct kiln_node_frame outer = known_frame(scene, parent->node, &m);
        frame = inside_of(&outer, &frame);
    }
    if (cache)
        kiln_node_cache_keep(cache, KILN_NODE_FRAME_WORLD, node, time_s, rate_s, &frame);
    return frame;
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

struct kiln_node_step kiln_node_step_at(const struct kiln_scene *scene, uint32_t node,
                                        uint32_t step)
{
    const double dt_s = (double)scene->rate.den / (double)scene->rate.num;
    const float start_s = kiln_scene_time(scene, step - 1), end_s = kiln_scene_time(scene, step);
    const struct moments first = moments_at(scene, start_s, start_s);
    const struct moments last = moments_at(scene, end_s, nextafterf(end_s, -INFINITY));
    struct kiln_node_step found = {.start = known_frame(scene, node, &first),
                                   .end = known_frame(scene, node, &last)};
    found.on = found.end;
    found.jumps = go_on(&found.start, &found.on, dt_s);
    for (const struct kiln_attach *parent = &scene->nodes[node].parent; parent->name;
         parent = &scene->nodes[parent->node].parent) {
        const struct kiln_node_frame start = known_frame(scene, parent->node, &first);
        const struct kiln_node_frame end = known_frame(scene, parent->node, &last);
        struct kiln_node_frame on = end;
        found.jumps |= go_on(&start, &on, dt_s);
        found.start = inside_of(&start, &found.start);
        found.end = inside_of(&end, &found.end);
        found.on = inside_of(&on, &found.on);
    }
    return found;
}

/* ---- questions ------------------------------------------------------------------------------- */

bool kiln_node_stands(const struct kiln_scene *scene, uint32_t node)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    const bool stands = n->position.path.points.count == 0 &&
                        kiln_value3_is_constant(&n->position.value) &&
                        kiln_value3_is_constant(&n->rotation) && n->scale.count == 0;
    return stands && (!n->parent.name || kiln_node_stands(scene, n->parent.node));
}

bool kiln_node_carries(const struct kiln_scene *scene, uint32_t node, uint32_t other)
{
    while (other != node && scene->nodes[other].parent.name)
        other = scene->nodes[other].parent.node;
    return other == node;
}

/* ---- what is attached ------------------------------------------------------------------------ */

static float3 rotated(const struct kiln_node_frame *frame, float3 v, double scale)
{
    double y[3];
    rotate(y, frame->turn, (const double[3]){(double)v.x, (double)v.y, (double)v.z});
    return FLOAT3((float)(y[0] * scale), (float)(y[1] * scale), (float)(y[2] * scale));
}

float3 kiln_attached_point(const struct kiln_scene *scene, const struct kiln_attach *attach,
                           float3 point, float time_s)
{
    if (!attach->name)
        return point;
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    double y[3];
    rotate(y, frame.turn, (const double[3]){(double)point.x, (double)point.y, (double)point.z});
    return FLOAT3((float)(frame.at[0] + y[0] * frame.scale),
                  (float)(frame.at[1] + y[1] * frame.scale),
                  (float)(frame.at[2] + y[2] * frame.scale));
}

float3 kiln_attached_vector(const struct kiln_scene *scene, const struct kiln_attach *attach,
                            float3 vector, float time_s)
{
    if (!attach->name)
        return vector;
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    return rotated(&frame, vector, 1);
}

float kiln_attached_length(const struct kiln_scene *scene, const struct kiln_attach *attach,
                           float length, float time_s)
{
    if (!attach->name)
        return length;
    return (float)(kiln_node_frame_at(scene, attach->node, time_s, time_s).scale * (double)length);
}

void kiln_attached_rotation(const struct kiln_scene *scene, const struct kiln_attach *attach,
                            float columns[3][3], float time_s)
{
    if (!attach->name)
        return;
    const struct kiln_node_frame frame = kiln_node_frame_at(scene, attach->node, time_s, time_s);
    for (int c = 0; c < 3; c++) {
        const float3 y = rotated(&frame, FLOAT3(columns[c][0], columns[c][1], columns[c][2]), 1);
        columns[c][0] = y.x;
        columns[c][1] = y.y;
        columns[c][2] = y.z;
    }
}

float3 kiln_object_center(const struct kiln_scene *scene, const struct kiln_object *object,
                          float time_s)
{
    return kiln_attached_point(scene, &object->attach,
                               kiln_scene_value3(scene, &object->center, time_s), time_s);
}

float3 kiln_object_size(const struct kiln_scene *scene, const struct kiln_object *object,
                        float time_s)
{
    const float3 size = kiln_scene_value3(scene, &object->size, time_s);
    if (!object->attach.name)
        return size;
    return float3_scale(size, kiln_attached_length(scene, &object->attach, 1.0f, time_s));
}

float3 kiln_object_axis(const struct kiln_scene *scene, const struct kiln_object *object,
                        float time_s)
{
    return kiln_attached_vector(scene, &object->attach,
                                kiln_scene_value3(scene, &object->axis, time_s), time_s);
}

float kiln_object_length(const struct kiln_scene *scene, const struct kiln_object *object,
                         const struct kiln_value *length, float time_s)
{
    return kiln_attached_length(scene, &object->attach, kiln_scene_value(scene, length, time_s),
                                time_s);
}

void kiln_object_rotation(const struct kiln_scene *scene, const struct kiln_object *object,
                          float time_s, float columns[3][3])
{
    kiln_scene_rotation(kiln_scene_value3(scene, &object->rotation, time_s), columns);
    kiln_attached_rotation(scene, &object->attach, columns, time_s);
}

struct kiln_camera_stand kiln_scene_camera_at(const struct kiln_scene *scene, float time_s)
{
    const struct kiln_camera *camera = &scene->camera;
    const float3 eye = kiln_scene_value3(scene, &camera->position, time_s);
    const float3 target = kiln_scene_value3(scene, &camera->target, time_s);
    const float3 way = float3_sub(target, eye);
    const float square = float3_dot(way, way);
    const float rise = square < KILN_CAMERA_NO_WAY ? 0.0f : way.y / sqrtf(square);
    float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    /* Where the camera looks straight down or up, the frame's up cannot be the picture's up. */
    if (fabsf(rise) > 0.9999f)
        up = FLOAT3(0.0f, 0.0f, rise > 0.0f ? 1.0f : -1.0f);
    return (struct kiln_camera_stand){
        .eye = kiln_attached_point(scene, &camera->attach, eye, time_s),
        .way = kiln_attached_vector(scene, &camera->attach, way, time_s),
        .distance = kiln_attached_length(scene, &camera->attach, sqrtf(square), time_s),
        .up = kiln_attached_vector(scene, &camera->attach, up, time_s),
    };
}
