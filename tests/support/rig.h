/* Makes glTF files of a skinned mesh, whose vertices follow a chain of three joints along y, 1 m
 * apart, for tests of lib/asset/geometry/skin.h. A variant of the file can have a fault for which
 * kiln must refuse the file. */
#ifndef KILN_TESTS_RIG_H
#define KILN_TESTS_RIG_H

#include "asset/geometry/skin.h"

enum { JOINTS = 3, KEYS = 4, VERTICES = 12, TRIANGLES = 4 };

/* Holds the numbers of the file. The file's binary buffer is a copy of this struct, and each member
 * is a buffer view. */
struct rig {
    float positions[VERTICES][3];
    float weights[VERTICES][4];
    float inverse[JOINTS][16];    /* inverse bind matrices, by columns */
    float times[KEYS];            /* times of the key frames, s */
    float turns[JOINTS][KEYS][4]; /* rotations of the joints, quaternions */
    float moves[KEYS][3];         /* translations of the first joint, m */
    uint16_t triangles[TRIANGLES][3];
    uint8_t joints[VERTICES][4];
};

/* Holds parts of the file's JSON text. A test copies SOUND and changes a member to get another
 * file, such as a faulty one. */
struct variant {
    const char *second;            /* name of the second joint */
    const char *skin, *attributes; /* JSON added to the mesh's node; to the vertices' attributes */
    const char *animations;        /* member "animations"; one %s stands for the interpolation */
    const char *interpolation;     /* "LINEAR" is the only one that kiln takes */
};

/* The JSON of channels and samplers that rotate the joints 0, `node` and 2, and move joint 0.
 * `node` is a string, "1" in a file without faults. */
#define CHANNELS(node)                                                                             \
    "\"channels\": [{\"sampler\": 0, \"target\": {\"node\": 0, \"path\": \"rotation\"}},"          \
    " {\"sampler\": 1, \"target\": {\"node\": " node ", \"path\": \"rotation\"}},"                 \
    " {\"sampler\": 2, \"target\": {\"node\": 2, \"path\": \"rotation\"}},"                        \
    " {\"sampler\": 3, \"target\": {\"node\": 0, \"path\": \"translation\"}}],"                    \
    " \"samplers\": [{\"input\": 3, \"output\": 4}, {\"input\": 3, \"output\": 5},"                \
    " {\"input\": 3, \"interpolation\" : \"%s\", \"output\": 6}, {\"input\": 3, \"output\": 7}]"

/* The JSON of the skin and of the animation of a file without faults. */
#define SKIN ", \"skin\": 0"
#define WAVE "\"animations\": [{\"name\": \"wave\", " CHANNELS("1") "}],"

/* The variant without faults. */
extern const struct variant SOUND;

/* Returns the text of a glTF file. It is valid until the next call. */
const char *to_gltf(const struct rig *rig, const struct variant *variant);

/* Loads the skin of a glTF file. The caller destroys it. An error fails the test. */
struct kiln_skin *parse(const struct rig *rig, const struct variant *variant);

/* Fails unless loading fails with KILN_INVALID_INPUT and the message "rig.gltf: " + reason. */
void refuse(const struct rig *rig, const struct variant *variant, const char *reason);

/* Sets the quaternion `out` to the rotation by an angle, rad, about a unit axis. */
void set_turn(float out[4], const double axis[3], double angle);

/* Returns a rig whose joints keep still, and whose vertices all follow the first joint. */
struct rig still_rig(void);

/* Returns a rig whose joints all move at random, and whose vertices follow all joints with random
 * weights. The last key frame equals the first. */
struct rig waving_rig(void);

#endif
