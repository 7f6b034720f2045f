/* This file makes the colliders that may turn: it finds their poses at both ends of a step and the
 * one rotation between them, about a fixed axis, the shorter way. All arithmetic is rounded alike
 * on every host. */
#include "sim/world/oriented.h"

#include <math.h>

#include "base/matrix.h"
#include "shared/exact.h"

/* Turns by less than this angle, rad, count as none, since it is the rounding of the poses. */
static const float LEAST_TURN = 4e-6f;

bool kiln_object_is_oriented(const struct kiln_object *object)
{
    switch (object->kind) {
    case KILN_OBJECT_BOX:
        return kiln_object_is_oriented_box(object);
    case KILN_OBJECT_CYLINDER:
        return object->attach.name || !kiln_value3_is_constant(&object->axis);
    case KILN_OBJECT_CAPSULE:
    case KILN_OBJECT_PLANE:
    case KILN_OBJECT_CONE:
        return true;
    case KILN_OBJECT_SPHERE:
    case KILN_OBJECT_MESH:
    case KILN_OBJECT_TERRAIN:
        break;
    }
    return false;
}

static float4 with_w(float3 v, float w)
{
    return FLOAT4(exact_canon(v.x), exact_canon(v.y), exact_canon(v.z), exact_canon(w));
}

/* ---- quaternions ----------------------------------------------------------------------------- */

/* Scales a quaternion to length 1 by the root of exact.h, and leaves no denormals. */
static void make_unit(versor q)
{
    glm_vec4_scale(q, exact_rsqrt(glm_vec4_norm2(q)), q);
    for (int i = 0; i < 4; i++)
        q[i] = exact_canon(q[i]);
}

/* Makes the pose that turns about x, then about y, then about z. */
static void pose_of_angles(float3 angles, versor pose)
{
    const struct exact_angle x = exact_sincos(0.5f * angles.x), y = exact_sincos(0.5f * angles.y);
    const struct exact_angle z = exact_sincos(0.5f * angles.z);
    versor about_x = {x.sine, 0.0f, 0.0f, x.cosine};
    versor about_y = {0.0f, y.sine, 0.0f, y.cosine};
    versor about_z = {0.0f, 0.0f, z.sine, z.cosine}, about_both;
    glm_quat_mul(about_y, about_x, about_both);
    glm_quat_mul(about_z, about_both, pose);
    make_unit(pose);
}

/* Makes the pose that takes y to a unit vector by the smallest rotation. A vector that points down
 * is reached from -y, since the smallest rotation from y is ill defined there. */
static void pose_of_axis(float3 axis, versor pose)
{
    const float sign = axis.y >= 0.0f ? 1.0f : -1.0f;
    versor shortest = {sign * axis.z, 0.0f, -sign * axis.x, 1.0f + sign * axis.y};
    versor over = {1.0f, 0.0f, 0.0f, 0.0f}; /* half a turn about x */
    make_unit(shortest);
    if (axis.y >= 0.0f)
        glm_vec4_copy(shortest, pose);
    else
        glm_quat_mul(shortest, over, pose);
}

/* Returns the angle from 0 to a quarter turn with this sine and cosine, which may have a common
 * factor. */
static float angle_of(float sine, float cosine)
{
    const float eighth = 0.785398163f;
    bool steep = sine > cosine;
    float less = steep ? cosine : sine, more = steep ? sine : cosine;
    bool wide = less > 0.414213562f * more;
    float ratio = wide ? exact_div(less - more, less + more) : exact_div(less, more);
    float z = ratio * ratio;
    float p = ((8.05374449e-2f * z - 1.38776856e-1f) * z + 1.99777106e-1f) * z - 3.33329492e-1f;
    float angle = ratio + ratio * (z * p) + (wide ? eighth : 0.0f);
    return steep ? 2.0f * eighth - angle : angle;
}

/* Returns a rotation as an axis and an angle. */
static float4 spin_of(versor turn)
{
    const float3 v = FLOAT3(turn[0], turn[1], turn[2]);
    float sine = float3_length(v), angle = 2.0f * angle_of(sine, exact_abs(turn[3]));
    if (!(angle >= LEAST_TURN))
        return FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
    float3 axis = float3_normalize(v, FLOAT3(0.0f, 1.0f, 0.0f));
    return with_w(axis, turn[3] < 0.0f ? -angle : angle);
}

/* Returns the rotation from one unit vector to another, as an axis and an angle. */
static float4 spin_between(float3 from, float3 to)
{
    float3 across = float3_cross(from, to);
    /* a rotation by the angle, before normalisation */
    versor turn = {across.x, across.y, across.z, 1.0f + float3_dot(from, to)};
    make_unit(turn);
    return spin_of(turn);
}

/* Returns the rotation from one pose to another, as an axis and an angle. */
static float4 spin_from(versor from, versor to)
{
    versor back, turn;
    glm_quat_conjugate(from, back);
    glm_quat_mul(to, back, turn);
    return spin_of(turn);
}

float4 kiln_spin_between_turns(const double from[4], const double to[4])
{
    versor turn = {
        (float)(to[0] * from[3] - to[3] * from[0] - to[1] * from[2] + to[2] * from[1]),
        (float)(to[1] * from[3] - to[3] * from[1] - to[2] * from[0] + to[0] * from[2]),
        (float)(to[2] * from[3] - to[3] * from[2] - to[0] * from[1] + to[1] * from[0]),
        (float)(to[3] * from[3] + to[0] * from[0] + to[1] * from[1] + to[2] * from[2]),
    };
    make_unit(turn);
    return spin_of(turn);
}

/* ---- colliders ------------------------------------------------------------------------------- */

/* An object at a time. */
struct place {
    float3 center;
    float radius;
    float3 extent;
    float3 axis; /* axis of capsules, cylinders and planes */
    versor pose;
};

/* Turns the pose of an attached object as its node is turned. */
static void attach_pose(const struct kiln_scene *scene, const struct kiln_object *object,
                        float time_s, versor pose)
{
    if (!object->attach.name)
        return;
    const struct kiln_node_frame frame =
        kiln_node_frame_at(scene, object->attach.node, time_s, time_s);
    versor outer, inner;
    for (int i = 0; i < 4; i++)
        outer[i] = (float)frame.turn[i];
    glm_vec4_copy(pose, inner);
    glm_quat_mul(outer, inner, pose);
    make_unit(pose);
}

static struct place place_at(const struct kiln_scene *scene, const struct kiln_object *object,
                             float time_s)
{
    struct place place = {.center = kiln_object_center(scene, object, time_s)};
    if (object->kind == KILN_OBJECT_BOX) {
        place.extent = float3_scale(kiln_object_size(scene, object, time_s), 0.5f);
        pose_of_angles(kiln_scene_value3(scene, &object->rotation, time_s), place.pose);
        attach_pose(scene, object, time_s, place.pose);
        return place;
    }
    place.axis =
        float3_normalize(kiln_object_axis(scene, object, time_s), FLOAT3(0.0f, 1.0f, 0.0f));
    pose_of_axis(place.axis, place.pose);
    if (object->kind != KILN_OBJECT_PLANE) {
        place.radius = kiln_object_length(scene, object, &object->radius, time_s);
        place.extent.y = 0.5f * kiln_object_length(scene, object, &object->height, time_s);
    }
    return place;
}

/* Returns half the size of a shape's bounding box; if it turns, the box holds it in all poses. */
static float3 reach_of(const struct kiln_object *object, struct place place, bool turns)
{
    const float3 e = place.extent;
    /* the margin covers rounding */
    const float margin = 1e-5f + 1e-6f * (place.radius + e.x + e.y + e.z);
    if (object->kind == KILN_OBJECT_PLANE)
        return FLOAT3(KILN_WORLD, KILN_WORLD, KILN_WORLD);
    if (turns) {
        float reach = place.radius + float3_length(e) + margin;
        return FLOAT3(reach, reach, reach);
    }
    if (object->kind == KILN_OBJECT_BOX) {
        const float half[3] = {e.x, e.y, e.z};
        vec3 reach = {margin, margin, margin};
        mat3 rotation;
        glm_quat_mat3(place.pose, rotation);
        for (int c = 0; c < 3; c++) {
            vec3 size;
            glm_vec3_abs(rotation[c], size);
            glm_vec3_muladds(size, half[c], reach);
        }
        return FLOAT3(reach[0], reach[1], reach[2]);
    }
    const float around = margin + place.radius;
    return FLOAT3(around + e.y * exact_abs(place.axis.x), around + e.y * exact_abs(place.axis.y),
                  around + e.y * exact_abs(place.axis.z));
}

uint kiln_oriented_kind(const struct kiln_object *object)
{
    switch (object->kind) {
    case KILN_OBJECT_BOX:
        return COLLIDER_ORIENTED_BOX;
    case KILN_OBJECT_CAPSULE:
        return COLLIDER_CAPSULE;
    case KILN_OBJECT_PLANE:
        return COLLIDER_PLANE;
    case KILN_OBJECT_CONE:
        return COLLIDER_CONE;
    default:
        return COLLIDER_ORIENTED_CYLINDER;
    }
}

/* Returns how far the edges of a cone's base move outwards while its surfaces do so by 1 m: the
 * sharper the edge, the farther. */
static float edge_growth(struct place place)
{
    const float tall = 2.0f * place.extent.y;
    const float side = sqrtf(tall * tall + place.radius * place.radius);
    const float aside = (place.radius + side) / tall;
    return 1.0001f * sqrtf(1.0f + aside * aside);
}

struct kiln_collider kiln_oriented_collider(const struct kiln_scene *scene,
                                            const struct kiln_object *object, float start_s,
                                            float end_s)
{
    struct place start = place_at(scene, object, start_s);
    struct place end = place_at(scene, object, end_s);
    const float4 spin = object->kind == KILN_OBJECT_BOX ? spin_from(start.pose, end.pose)
                                                        : spin_between(start.axis, end.axis);
    const bool turns = spin.w != 0.0f;
    const float3 reach = reach_of(object, start, turns);
    const float3 reach_end = reach_of(object, end, turns);
    return (struct kiln_collider){
        .min = with_w(float3_sub(start.center, reach), 0.0f),
        .max = with_w(float3_add(start.center, reach), 0.0f),
        .min_end = with_w(float3_sub(end.center, reach_end), 0.0f),
        .max_end = with_w(float3_add(end.center, reach_end), 0.0f),
        .center = with_w(start.center, start.radius),
        .center_end = with_w(end.center, end.radius),
        .axis = with_w(start.axis, 0.0f),
        .extent = with_w(start.extent, 0.0f),
        .extent_end = with_w(end.extent, 0.0f),
        .pose = FLOAT4(start.pose[0], start.pose[1], start.pose[2], start.pose[3]),
        .spin = spin,
        .steepest = object->kind == KILN_OBJECT_CONE
                        ? exact_max(edge_growth(start), edge_growth(end))
                        : 0.0f,
    };
}

/* Makes the quaternion of a rotation, an axis and an angle. */
static void turn_of(float4 spin, double turn[4])
{
    const struct exact_angle half = exact_sincos(0.5f * spin.w);
    turn[0] = (double)(spin.x * half.sine);
    turn[1] = (double)(spin.y * half.sine);
    turn[2] = (double)(spin.z * half.sine);
    turn[3] = (double)half.cosine;
}

/* Multiplies quaternions: y turns by b, then by a. */
static void multiply_turns(const double a[4], const double b[4], double y[4])
{
    y[0] = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
    y[1] = a[3] * b[1] + a[1] * b[3] + a[2] * b[0] - a[0] * b[2];
    y[2] = a[3] * b[2] + a[2] * b[3] + a[0] * b[1] - a[1] * b[0];
    y[3] = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
}

/* Returns the rotation of an object that is attached: that of its axis in the node, then that of
 * the node. */
static float4 attached_spin(const struct kiln_scene *scene, const struct kiln_object *object,
                            float start_s, float end_s)
{
    const uint32_t node = object->attach.node;
    const struct kiln_node_frame start = kiln_node_frame_at(scene, node, start_s, start_s);
    const struct kiln_node_frame end = kiln_node_frame_at(scene, node, end_s, end_s);
    const float3 up = FLOAT3(0.0f, 1.0f, 0.0f);
    const float3 from = float3_normalize(kiln_scene_value3(scene, &object->axis, start_s), up);
    const float3 to = float3_normalize(kiln_scene_value3(scene, &object->axis, end_s), up);
    double within[4], whole[4];
    if (object->kind == KILN_OBJECT_SPHERE || kiln_value3_is_constant(&object->axis))
        return kiln_spin_between_turns(start.turn, end.turn);
    turn_of(spin_between(from, to), within);
    multiply_turns(end.turn, within, whole);
    return kiln_spin_between_turns(start.turn, whole);
}

float3 kiln_object_turn(const struct kiln_scene *scene, const struct kiln_object *object,
                        float start_s, float end_s, float4 spin)
{
    if (object->attach.name && object->kind != KILN_OBJECT_BOX)
        spin = attached_spin(scene, object, start_s, end_s);
    const float3 axis = FLOAT3(spin.x, spin.y, spin.z), turn = float3_scale(axis, spin.w);
    return FLOAT3(exact_canon(turn.x), exact_canon(turn.y), exact_canon(turn.z));
}
