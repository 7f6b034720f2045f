/* Declares how a scene plays a clip of a glTF or GLB file. */
#ifndef KILN_SCENE_ANIMATION_H
#define KILN_SCENE_ANIMATION_H

#include <stdbool.h>
#include <stdint.h>

#include "shared/value.h"

/* A clip of a file (asset/geometry/skin.h, rig.h), which moves a mesh in its own space, or a node.
 */
struct kiln_animation {
    bool enabled;
    const char *clip;               /* the clip's name or number, as written */
    struct kiln_value start, speed; /* s; factor: constant */
    bool loop;
    uint32_t number; /* follows: number of the clip */
    float length;    /* follows: s, length of the clip */
};

/* Returns how far into its clip, s, an animation is at a clip time. */
float kiln_scene_animation_s(const struct kiln_animation *animation, float time_s);
/* Returns whether a clip restarts between two times, of which the second is later. Then *end_s
 * becomes the position in it where it ends. */
bool kiln_scene_animation_ends(const struct kiln_animation *animation, float from_s, float to_s,
                               float *end_s);
/* Returns how fast a clip is played at a clip time, s a second: 0 while it stays at its first or
 * last pose, and from the moment on in which it comes to it. */
float kiln_scene_animation_speed(const struct kiln_animation *animation, float time_s);

#endif
