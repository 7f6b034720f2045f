/* Places and poses at both ends of a step, and the one turn between them: about a fixed axis, the
 * shorter way. All of it is in arithmetic that every host rounds alike. */
#include "sim/world/turned.h"

#include "shared/exact.h"

/* Less is no turn: the rounding of the poses, rad. */
static const float LEAST_TURN = 4e-6f;

bool kiln_turned_is(const struct kiln_object *object)
{
    switch (object->kind) {
    case KILN_OBJECT_BOX:
        return kiln_object_is_turned_box(object);
    case KILN_OBJECT_CYLINDER:
        return !kiln_value3_is_constant(&object->axis);
    case KILN_OBJECT_CAPSULE:
    case KILN_OBJECT_PLANE:
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

static float4 product(float4 a, float4 b)
{
    return FLOAT4(a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                  a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
                  a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
                  a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
}

static float4 unit(float4 q)
{
    float r = exact_rsqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return FLOAT4(exact_canon(q.x * r), exact_canon(q.y * r), exact_canon(q.z * r),
                  exact_canon(q.w * r));
}

/* About x, then about y, then about z. */
static float4 pose_of_angles(float3 angles)
{
    const struct exact_angle x = exact_sincos(0.5f * angles.x), y = exact_sincos(0.5f * angles.y);
    const struct exact_angle z = exact_sincos(0.5f * angles.z);
    const float4 about_x = FLOAT4(x.sine, 0.0f, 0.0f, x.cosine);
    const float4 about_y = FLOAT4(0.0f, y.sine, 0.0f, y.cosine);
    const float4 about_z = FLOAT4(0.0f, 0.0f, z.sine, z.cosine);
    return unit(product(about_z, product(about_y, about_x)));
}

/* Takes y to a unit vector, the shortest way; what points down comes by way of -y, where that is
 * well defined. */
static float4 pose_of_axis(float3 axis)
{
    if (axis.y >= 0.0f)
        return unit(FLOAT4(axis.z, 0.0f, -axis.x, 1.0f + axis.y));
    const float4 over = FLOAT4(1.0f, 0.0f, 0.0f, 0.0f); /* half a turn about x */
    return product(unit(FLOAT4(-axis.z, 0.0f, axis.x, 1.0f - axis.y)), over);
}

/* The angle of 0 to a quarter turn with this sine and cosine, up to a common factor. */
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

/* A turn as an axis and an angle. */
static float4 spin_of(float4 turn)
{
    const float3 v = FLOAT3(turn.x, turn.y, turn.z);
    float sine = float3_length(v), angle = 2.0f * angle_of(sine, exact_abs(turn.w));
    if (!(angle >= LEAST_TURN))
        return FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
    float3 axis = float3_normalize(v, FLOAT3(0.0f, 1.0f, 0.0f));
    return with_w(axis, turn.w < 0.0f ? -angle : angle);
}

/* From one unit vector to another. */
static float4 spin_between(float3 from, float3 to)
{
    float3 across = float3_cross(from, to);
    float cosine = float3_dot(from, to);
    /* The quaternion of half of that angle. */
    return spin_of(unit(FLOAT4(across.x, across.y, across.z, 1.0f + cosine)));
}

/* ---- colliders ------------------------------------------------------------------------------- */

/* The object at a time. */
struct place {
    float3 center;
    float radius;
    float3 extent;
    float3 axis; /* of all but boxes */
    float4 pose;
};

static struct place place_at(const struct kiln_scene *scene, const struct kiln_object *object,
                             float time_s)
{
    struct place place = {.center = kiln_scene_value3(scene, &object->center, time_s)};
    if (object->kind == KILN_OBJECT_BOX) {
        place.extent = float3_scale(kiln_scene_value3(scene, &object->size, time_s), 0.5f);
        place.pose = pose_of_angles(kiln_scene_value3(scene, &object->rotation, time_s));
        return place;
    }
    place.axis =
        float3_normalize(kiln_scene_value3(scene, &object->axis, time_s), FLOAT3(0.0f, 1.0f, 0.0f));
    place.pose = pose_of_axis(place.axis);
    if (object->kind != KILN_OBJECT_PLANE) {
        place.radius = kiln_scene_value(scene, &object->radius, time_s);
        place.extent.y = 0.5f * kiln_scene_value(scene, &object->height, time_s);
    }
    return place;
}

/* Half of what bounds a shape: in all poses, if it turns. */
static float3 reach_of(const struct kiln_object *object, const struct place *place, bool turns)
{
    const float3 e = place->extent;
    const float margin = 1e-5f + 1e-6f * (place->radius + e.x + e.y + e.z); /* of rounding */
    if (object->kind == KILN_OBJECT_PLANE)
        return FLOAT3(KILN_WORLD, KILN_WORLD, KILN_WORLD);
    if (turns) {
        float reach = place->radius + float3_length(e) + margin;
        return FLOAT3(reach, reach, reach);
    }
    if (object->kind == KILN_OBJECT_BOX) {
        const float4 q = place->pose;
        float xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, xy = q.x * q.y, xz = q.x * q.z;
        float yz = q.y * q.z, xw = q.x * q.w, yw = q.y * q.w, zw = q.z * q.w;
        return FLOAT3(
            margin + exact_abs(1.0f - 2.0f * (yy + zz)) * e.x + exact_abs(2.0f * (xy - zw)) * e.y +
                exact_abs(2.0f * (xz + yw)) * e.z,
            margin + exact_abs(2.0f * (xy + zw)) * e.x + exact_abs(1.0f - 2.0f * (xx + zz)) * e.y +
                exact_abs(2.0f * (yz - xw)) * e.z,
            margin + exact_abs(2.0f * (xz - yw)) * e.x + exact_abs(2.0f * (yz + xw)) * e.y +
                exact_abs(1.0f - 2.0f * (xx + yy)) * e.z);
    }
    const float around = margin + place->radius;
    return FLOAT3(around + e.y * exact_abs(place->axis.x), around + e.y * exact_abs(place->axis.y),
                  around + e.y * exact_abs(place->axis.z));
}

static uint kind_of(const struct kiln_object *object)
{
    switch (object->kind) {
    case KILN_OBJECT_BOX:
        return COLLIDER_TURNED_BOX;
    case KILN_OBJECT_CAPSULE:
        return COLLIDER_CAPSULE;
    case KILN_OBJECT_PLANE:
        return COLLIDER_PLANE;
    default:
        return COLLIDER_TURNED_CYLINDER;
    }
}

struct kiln_collider kiln_turned_collider(const struct kiln_scene *scene,
                                          const struct kiln_object *object, float start_s,
                                          float end_s)
{
    const struct place start = place_at(scene, object, start_s);
    const struct place end = place_at(scene, object, end_s);
    const float4 back = FLOAT4(-start.pose.x, -start.pose.y, -start.pose.z, start.pose.w);
    const float4 spin = object->kind == KILN_OBJECT_BOX ? spin_of(product(end.pose, back))
                                                        : spin_between(start.axis, end.axis);
    const bool turns = spin.w != 0.0f;
    const float3 reach = reach_of(object, &start, turns);
    const float3 reach_end = reach_of(object, &end, turns);
    return (struct kiln_collider){
        .min = with_w(float3_sub(start.center, reach), 0.0f),
        .max = with_w(float3_add(start.center, reach), 0.0f),
        .min_end = with_w(float3_sub(end.center, reach_end), 0.0f),
        .max_end = with_w(float3_add(end.center, reach_end), 0.0f),
        .center = with_w(start.center, start.radius),
        .center_end = with_w(end.center, end.radius),
        .axis = with_w(start.axis, 0.0f),
        .kind = kind_of(object),
        .extent = with_w(start.extent, 0.0f),
        .extent_end = with_w(end.extent, 0.0f),
        .pose = start.pose,
        .spin = spin,
    };
}
