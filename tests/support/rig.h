/* Makes glTF files of a chain of bones along y, each a metre long. */
#ifndef KILN_TESTS_RIG_H
#define KILN_TESTS_RIG_H

#include "asset/geometry/skin.h"

enum { JOINTS = 3, KEYS = 4, VERTICES = 12, TRIANGLES = 4 };

struct rig {
    float positions[VERTICES][3];
    float weights[VERTICES][4];
    float inverse[JOINTS][16]; /* bind matrices, by columns */
    float times[KEYS];
    float turns[JOINTS][KEYS][4];
    float moves[KEYS][3]; /* places of the first joint, m */
    uint16_t triangles[TRIANGLES][3];
    uint8_t joints[VERTICES][4];
};

/* Texts of the file. A test changes one of SOUND to get a faulty file. */
struct variant {
    const char *second; /* name of the second joint */
    const char *skin, *attributes;
    const char *animations; /* with one %s: the interpolation */
    const char *interpolation;
};

#define CHANNELS(node)                                                                             \
    "\"channels\": [{\"sampler\": 0, \"target\": {\"node\": 0, \"path\": \"rotation\"}},"          \
    " {\"sampler\": 1, \"target\": {\"node\": " node ", \"path\": \"rotation\"}},"                 \
    " {\"sampler\": 2, \"target\": {\"node\": 2, \"path\": \"rotation\"}},"                        \
    " {\"sampler\": 3, \"target\": {\"node\": 0, \"path\": \"translation\"}}],"                    \
    " \"samplers\": [{\"input\": 3, \"output\": 4}, {\"input\": 3, \"output\": 5},"                \
    " {\"input\": 3, \"interpolation\" : \"%s\", \"output\": 6}, {\"input\": 3, \"output\": 7}]"

#define SKIN ", \"skin\": 0"
#define WAVE "\"animations\": [{\"name\": \"wave\", " CHANNELS("1") "}],"

extern const struct variant SOUND;

/* Returns the text of the glTF file, valid until the next call. */
const char *to_gltf(const struct rig *rig, const struct variant *variant);
/* Returns the skin of the file, which the caller destroys; an error fails the test. */
struct kiln_skin *parse(const struct rig *rig, const struct variant *variant);
/* Fails unless the file is refused with a message that contains the reason. */
void refuse(const struct rig *rig, const struct variant *variant, const char *reason);

/* Sets a quaternion to the rotation by an angle, rad, about a unit axis. */
void set_turn(float out[4], const double axis[3], double angle);

/* Returns a rig that does not move, and whose vertices all follow the first bone. */
struct rig still_rig(void);

/* Returns a rig in which all bones move; the last key equals the first. */
struct rig waving_rig(void);

#endif
