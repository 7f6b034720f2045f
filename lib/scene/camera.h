/* Declares the camera of a scene. */
#ifndef KILN_SCENE_CAMERA_H
#define KILN_SCENE_CAMERA_H

#include <stdint.h>

#include "scene/node.h"
#include "shared/value.h"

struct kiln_camera {
    struct kiln_attach attach;           /* position and target lie in this node */
    struct kiln_value3 position, target; /* m */
    struct kiln_value fov;               /* rad, vertical */
    struct kiln_value roll;              /* rad */
    struct kiln_value near_plane;        /* m */
    struct kiln_value aperture;          /* m: diameter of the lens; 0: a pinhole */
    struct kiln_value focus;             /* m; KILN_VALUE_BY_WORD: the target's distance */
    uint32_t shutter_samples;            /* moments of a frame that are averaged */
    double shutter_angle;                /* rad; with a full turn, the shutter is always open */
    double shutter_phase;                /* rad from the frame's own time to the first moment */
};

#endif
