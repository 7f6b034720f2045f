/* This file poses the nodes of glTF files: it reads the keys of a clip at a moment, and multiplies
 * the transforms of a node and of those above it, together with their rates. A rate is that of the
 * curve itself and no difference of two moments, so that a simulation knows a node's way between
 * two steps.
 *
 * Numbers that are within bounds may multiply to ones that are not: a pose is bounded at the end.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/rig_kept.h"

static const double MOST_SCALE = 1e6; /* of a pose */
/* Ratio of two scales below which they count as one, since programs round them. */
static const double NEARLY_ONE = 1.001;

/* ---- tracks ---------------------------------------------------------------------------------- */

/* A value of up to four numbers, and how fast it changes, per second of the clip. */
struct quantity {
    double value[4], rate[4];
};

/* Two keys between which a moment is, and what part of the time between them has gone. */
struct between {
    const struct kiln_skin_key *a, *b; /* the same before the first key, and from the last one on */
    double t, length_s;
};

/* is_behind: a moment at a key is between that key and the one before it. */
static struct between find_keys(const struct kiln_rig *rig, const struct kiln_skin_track *track,
                                float seconds, bool is_behind)
{
    const uint32_t parts = kiln_skin_parts(track), count = track->count / parts;
    const struct kiln_skin_key *keys = rig->keys + track->first;
    /* the last key at or before the moment is in low .. high - 1 */
    uint32_t low = 0, high = count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        const float at = keys[(size_t)middle * parts].seconds;
        *(at < seconds || (at == seconds && !is_behind) ? &low : &high) = middle;
    }
    const float at = keys[(size_t)low * parts].seconds;
    const bool is_first = at > seconds || (at == seconds && is_behind);
    const uint32_t next = is_first || low + 1 == count ? low : low + 1;
    struct between found = {&keys[(size_t)low * parts], &keys[(size_t)next * parts], 0, 1};
    if (next > low) {
        found.length_s = (double)found.b->seconds - (double)at;
        found.t = ((double)seconds - (double)at) / found.length_s;
    }
    return found;
}

/* Gets the value of a key as doubles; a rotation gets length 1. part: of a cubic spline's key. */
static void get_value(const struct kiln_skin_key *key, uint32_t part, bool turns, double out[4])
{
    for (int c = 0; c < 4; c++)
        out[c] = (double)key[part].value[c];
    if (turns)
        kiln_rig_make_unit(out);
}

/* Computes sin(t angle) / sin(angle) and its derivative by t from the cosine of an angle of at most
 * a quarter turn, by the series of skin.c to the precision of doubles. */
static void part_of_turn(double t, double cosine, double *part, double *slope)
{
    enum { TERMS = 56 };
    const double x = cosine - 1;
    double term = t, term_slope = 1;
    *part = t;
    *slope = 1;
    for (int i = 1; i <= TERMS; i++) {
        const double n = (double)i, odd = 2 * n + 1;
        const double factor = (t * t / (n * odd) - n / odd) * x;
        term_slope = term_slope * factor + term * (2 * t / (n * odd) * x);
        term *= factor;
        *part += term;
        *slope += term_slope;
    }
}

/* Goes from one rotation to another the shorter way, at constant speed. */
static void turn_between(const struct between *keys, struct quantity *out)
{
    double a[4], b[4], from, to, from_slope, to_slope, cosine = 0;
    get_value(keys->a, 0, true, a);
    get_value(keys->b, 0, true, b);
    for (int c = 0; c < 4; c++)
        cosine += a[c] * b[c];
    const double sign = cosine < 0 ? -1 : 1;
    part_of_turn(1 - keys->t, sign * cosine, &from, &from_slope);
    part_of_turn(keys->t, sign * cosine, &to, &to_slope);
    for (int c = 0; c < 4; c++) {
        out->value[c] = from * a[c] + sign * to * b[c];
        out->rate[c] = (sign * to_slope * b[c] - from_slope * a[c]) / keys->length_s;
    }
}

/* Goes along a cubic Hermite spline (glTF 2.0, appendix C.5). */
static void spline_between(const struct between *keys, bool turns, struct quantity *out)
{
    const double t = keys->t;
    double from[4], leaving[4], to[4], arriving[4];
    const double t2 = t * t, t3 = t2 * t, length_s = keys->length_s;
    get_value(keys->a, 1, turns, from);
    get_value(keys->a, 2, false, leaving);
    get_value(keys->b, 1, turns, to);
    get_value(keys->b, 0, false, arriving);
    for (int c = 0; c < 4; c++) {
        out->value[c] = (2 * t3 - 3 * t2 + 1) * from[c] +
                        length_s * (t3 - 2 * t2 + t) * leaving[c] + (3 * t2 - 2 * t3) * to[c] +
                        length_s * (t3 - t2) * arriving[c];
        out->rate[c] = (6 * t2 - 6 * t) / length_s * (from[c] - to[c]) +
                       (3 * t2 - 4 * t + 1) * leaving[c] + (3 * t2 - 2 * t) * arriving[c];
    }
}

/* Reads a track between two keys, or at one of them. */
static struct quantity read_keys(const struct kiln_skin_track *track, const struct between *keys,
                                 bool turns)
{
    struct quantity out = {.rate = {0}};
    const uint32_t interpolation = keys->a == keys->b ? KILN_SKIN_STEP : track->interpolation;
    double b[4];
    if (interpolation == KILN_SKIN_CUBIC) {
        spline_between(keys, turns, &out);
    } else if (interpolation == KILN_SKIN_LINEAR && turns) {
        turn_between(keys, &out);
    } else {
        get_value(keys->a, kiln_skin_parts(track) / 2, turns, out.value);
        get_value(keys->b, kiln_skin_parts(track) / 2, turns, b);
        for (int c = 0; c < 4 && interpolation == KILN_SKIN_LINEAR; c++) {
            out.rate[c] = (b[c] - out.value[c]) / keys->length_s;
            out.value[c] += keys->t * (b[c] - out.value[c]);
        }
    }
    return out;
}

/* Reads a track, if it has keys, into a quantity that is the one at rest before. */
static void read_track(const struct kiln_rig *rig, const struct kiln_skin_track *track, bool turns,
                       const struct kiln_rig_moment *moment, struct quantity *out)
{
    if (track->count == 0)
        return;
    const struct between now = find_keys(rig, track, moment->seconds, false);
    const struct between then = find_keys(rig, track, moment->rate_seconds, moment->rate_is_behind);
    *out = read_keys(track, &now, turns);
    const struct quantity rates = read_keys(track, &then, turns);
    memcpy(out->rate, rates.rate, sizeof out->rate);
    if (turns) {
        /* the rate becomes that of the rotation at its own moment: an angular velocity */
        const double *q = rates.value, *r = rates.rate;
        const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        const double half[3] = {
            q[3] * r[0] - r[3] * q[0] - r[1] * q[2] + r[2] * q[1],
            q[3] * r[1] - r[3] * q[1] - r[2] * q[0] + r[0] * q[2],
            q[3] * r[2] - r[3] * q[2] - r[0] * q[1] + r[1] * q[0],
        };
        for (int c = 0; c < 3; c++)
            out->rate[c] = square > 1e-12 ? 2 * half[c] / square : 0;
        kiln_rig_make_unit(out->value);
    }
}

/* ---- transforms ------------------------------------------------------------------------------ */

/* A transform and its rates, per second of the clip. */
struct transform {
    double axes[3][3], axis_rates[3][3]; /* columns */
    double at[3], velocity[3];
};

static void cross(double y[3], const double a[3], const double b[3])
{
    y[0] = a[1] * b[2] - a[2] * b[1];
    y[1] = a[2] * b[0] - a[0] * b[2];
    y[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Finds the columns of the rotation by a quaternion of length 1. */
static void find_axes(const double q[4], double axes[3][3])
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double columns[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
        {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
        {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
    };
    memcpy(axes, columns, sizeof columns);
}

static const struct kiln_skin_channel *find_channel(const struct kiln_rig *rig, uint32_t clip,
                                                    uint32_t node)
{
    if (clip == KILN_RIG_AT_REST || rig->clips[clip].count == 0)
        return NULL;
    const struct kiln_skin_channel wanted = {.node = node};
    return bsearch(&wanted, rig->channels + rig->clips[clip].first, rig->clips[clip].count,
                   sizeof wanted, kiln_rig_by_node);
}

/* Returns the transform of a node to the space of its parent. */
static struct transform local_of(const struct kiln_rig *rig, uint32_t number,
                                 const struct kiln_rig_moment *moment)
{
    const struct kiln_rig_node *node = &rig->nodes[number];
    const struct kiln_skin_channel *channel = find_channel(rig, moment->clip, number);
    struct transform out = {.velocity = {0}};
    if (!channel) {
        for (int c = 0; c < 3; c++) {
            out.at[c] = node->local[c][3];
            for (int k = 0; k < 3; k++)
                out.axes[k][c] = node->local[c][k];
        }
        return out;
    }
    struct quantity move = {.rate = {0}}, turn = {.rate = {0}}, scale = {.rate = {0}};
    memcpy(move.value, node->move, sizeof node->move);
    memcpy(turn.value, node->turn, sizeof node->turn);
    memcpy(scale.value, node->scale, sizeof node->scale);
    read_track(rig, &channel->tracks[KILN_CHANNEL_MOVE], false, moment, &move);
    read_track(rig, &channel->tracks[KILN_CHANNEL_TURN], true, moment, &turn);
    read_track(rig, &channel->tracks[KILN_CHANNEL_SCALE], false, moment, &scale);
    double axes[3][3];
    find_axes(turn.value, axes);
    for (int k = 0; k < 3; k++) {
        double spun[3];
        cross(spun, turn.rate, axes[k]);
        out.at[k] = move.value[k];
        out.velocity[k] = move.rate[k];
        for (int c = 0; c < 3; c++) {
            out.axes[k][c] = axes[k][c] * scale.value[k];
            out.axis_rates[k][c] = spun[c] * scale.value[k] + axes[k][c] * scale.rate[k];
        }
    }
    return out;
}

/* Multiplies the columns of a matrix by a vector. */
static void apply(const double m[3][3], const double v[3], double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = m[0][c] * v[0] + m[1][c] * v[1] + m[2][c] * v[2];
}

/* Returns the transform that goes through `inner`, then through `outer`. */
static struct transform product(const struct transform *outer, const struct transform *inner)
{
    struct transform out;
    double by_rate[3], by_axes[3];
    for (int k = 0; k < 3; k++) {
        apply(outer->axes, inner->axes[k], out.axes[k]);
        apply(outer->axes, inner->axis_rates[k], by_axes);
        apply(outer->axis_rates, inner->axes[k], by_rate);
        for (int c = 0; c < 3; c++)
            out.axis_rates[k][c] = by_axes[c] + by_rate[c];
    }
    apply(outer->axes, inner->at, out.at);
    apply(outer->axes, inner->velocity, by_axes);
    apply(outer->axis_rates, inner->at, by_rate);
    for (int c = 0; c < 3; c++) {
        out.at[c] += outer->at[c];
        out.velocity[c] = outer->velocity[c] + by_axes[c] + by_rate[c];
    }
    return out;
}

/* ---- poses ----------------------------------------------------------------------------------- */

/* Bounds a number that only a faulty file makes too large. */
static double bounded(double x, double most)
{
    return x >= -most ? (x <= most ? x : most) : (x < -most ? -most : 0);
}

/* The length below which a vector has no direction. */
static const double LEAST_LENGTH = 1e-9;

/* Scales a vector to length 1, and makes its rate that of the direction. False: it has none. */
static bool make_direction(double v[3], double rate[3], double *length, double *growth)
{
    *length = sqrt(dot(v, v));
    if (!(*length > LEAST_LENGTH && *length < 1e18))
        return false;
    for (int c = 0; c < 3; c++) {
        v[c] /= *length;
        rate[c] /= *length;
    }
    const double along = dot(v, rate);
    *growth = along * *length;
    for (int c = 0; c < 3; c++)
        rate[c] -= along * v[c];
    return true;
}

/* Finds the frame of a transform: z keeps its direction, and y is made perpendicular to it. False:
 * there is none, since the node has a scale of 0. */
static bool find_frame(const struct transform *of, struct kiln_rig_pose *pose)
{
    double ahead_rate[3], up_rate[3], right[3], across[3], ignored[2], scale, growth;
    memcpy(pose->ahead, of->axes[2], sizeof pose->ahead);
    memcpy(ahead_rate, of->axis_rates[2], sizeof ahead_rate);
    if (!make_direction(pose->ahead, ahead_rate, &scale, &growth))
        return false;
    const double along = dot(pose->ahead, of->axes[1]);
    const double along_rate = dot(ahead_rate, of->axes[1]) + dot(pose->ahead, of->axis_rates[1]);
    for (int c = 0; c < 3; c++) {
        pose->up[c] = of->axes[1][c] - along * pose->ahead[c];
        up_rate[c] = of->axis_rates[1][c] - along * ahead_rate[c] - along_rate * pose->ahead[c];
    }
    if (!make_direction(pose->up, up_rate, &ignored[0], &ignored[1]))
        return false;
    cross(right, pose->up, pose->ahead);
    /* In a frame that turns, each axis changes by spin x axis. */
    cross(across, pose->ahead, ahead_rate);
    const double roll = dot(right, up_rate);
    for (int c = 0; c < 3; c++)
        pose->spin[c] = across[c] - roll * pose->ahead[c];
    pose->scale = scale;
    pose->growth = growth;
    return true;
}

struct kiln_rig_pose kiln_rig_pose_at(const struct kiln_rig *rig, uint32_t node,
                                      const struct kiln_rig_moment *moment)
{
    const double most = (double)KILN_SKIN_FARTHEST, speed = moment->clip_s_each_s;
    struct transform all = local_of(rig, node, moment);
    for (; rig->nodes[node].parent != node; node = rig->nodes[node].parent) {
        const struct transform outer = local_of(rig, rig->nodes[node].parent, moment);
        all = product(&outer, &all);
    }
    struct kiln_rig_pose pose = {.scale = KILN_RIG_LEAST_SCALE};
    if (!find_frame(&all, &pose))
        pose = (struct kiln_rig_pose){
            .ahead = {0, 0, 1}, .up = {0, 1, 0}, .scale = KILN_RIG_LEAST_SCALE};
    for (int c = 0; c < 3; c++) {
        pose.at[c] = bounded(all.at[c], most);
        pose.velocity[c] = bounded(speed * all.velocity[c], most);
        pose.spin[c] = bounded(speed * pose.spin[c], most);
    }
    pose.growth = bounded(speed * pose.growth, most);
    pose.scale =
        pose.scale > KILN_RIG_LEAST_SCALE ? bounded(pose.scale, MOST_SCALE) : KILN_RIG_LEAST_SCALE;
    return pose;
}

/* ---- one scale for all axes ------------------------------------------------------------------ */

static bool is_one_scale(const double axes[3])
{
    const double least = fmin(fmin(axes[0], axes[1]), axes[2]);
    const double most = fmax(fmax(axes[0], axes[1]), axes[2]);
    return least >= KILN_RIG_LEAST_SCALE && most <= NEARLY_ONE * least;
}

/* Returns whether a scale is one along all axes; otherwise tells of it. */
static bool check_scale(const struct kiln_rig_node *node, const double axes[3],
                        struct kiln_rig_scale *found)
{
    if (is_one_scale(axes))
        return true;
    const bool has_frame = fabs(axes[1]) > LEAST_LENGTH && fabs(axes[2]) > LEAST_LENGTH;
    found->name = node->name;
    found->number = node->number;
    memcpy(found->axes, axes, sizeof found->axes);
    found->taken = has_frame ? fmax(fabs(axes[2]), KILN_RIG_LEAST_SCALE) : KILN_RIG_LEAST_SCALE;
    return false;
}

bool kiln_rig_find_scale(const struct kiln_rig *rig, uint32_t node, uint32_t clip,
                         struct kiln_rig_scale *found)
{
    for (;; node = rig->nodes[node].parent) {
        const struct kiln_rig_node *at = &rig->nodes[node];
        const struct kiln_skin_channel *channel = find_channel(rig, clip, node);
        const struct kiln_skin_track *track = channel ? &channel->tracks[KILN_CHANNEL_SCALE] : NULL;
        const uint32_t count = track ? track->count : 0;
        if (count == 0 && !check_scale(at, at->scale, found))
            return true;
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t parts = kiln_skin_parts(track);
            double axes[4];
            get_value(&rig->keys[track->first + i], 0, false, axes);
            if (i % parts == parts / 2 && !check_scale(at, axes, found))
                return true;
        }
        if (at->parent == node)
            return false;
    }
}
