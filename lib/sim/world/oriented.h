/* Makes the colliders that have frames of their own, which may turn (shared/collide_oriented.h). */
#ifndef KILN_SIM_WORLD_ORIENTED_H
#define KILN_SIM_WORLD_ORIENTED_H

#include "scene/scene.h"
#include "shared/layout.h"

/* m: half the edge of the world. Particles farther out are lost; planes and floors end here. */
#define KILN_WORLD 2097152.0f

/* Returns the rotation from one unit quaternion to another, the shorter way: a unit axis, and the
 * angle in w, rad; all 0 for a turn as small as the rounding of poses. */
float4 kiln_spin_between_turns(const double from[4], const double to[4]);

/* Returns whether an object collides in a frame of its own. */
bool kiln_object_is_oriented(const struct kiln_object *object);

/* Returns the kind of such a collider, COLLIDER_*. */
uint kiln_oriented_kind(const struct kiln_object *object);

/* Makes the collider of a step between two clip times, but for its kind.
 * kiln_object_is_oriented(object) holds. */
struct kiln_collider kiln_oriented_collider(const struct kiln_scene *scene,
                                            const struct kiln_object *object, float start_s,
                                            float end_s);

/* Returns the whole rotation of an object in a step, axis times angle, rad. An object that is round
 * about an axis may turn about it by its node, which the collider need not know. spin: that of its
 * collider. */
float3 kiln_object_turn(const struct kiln_scene *scene, const struct kiln_object *object,
                        float start_s, float end_s, float4 spin);

#endif
