/* Writes a mesh that is skinned to a chain of three joints as a glTF file in memory, and loads it,
 * for tests of skinned meshes. */
#include "support/rig.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/errors.h"

/* Format for snprintf of the glTF file. Its arguments are, in order: `second`, `skin`, `attributes`
 * and `animations` of struct variant; the buffer views; the buffer's size, bytes; the buffer in
 * base64. Accessors 0 to 9 are the members of struct rig in order, where `turns` has three
 * accessors, one for each joint. Accessors 10 and 11 are only the first key frame of the times and
 * of the first joint's rotations. */
static const char JSON[] =
    "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0, 4]}],"
    " \"nodes\": [{\"name\": \"hips\", \"children\": [1]},"
    " {\"name\": \"%s\", \"children\": [2], \"translation\": [0, 1, 0], \"scale\": [1, 1, 1]},"
    " {\"name\": \"head\", \"translation\": [0, 1, 0]},"
    " {\"name\": \"unused\"}, {\"name\": \"body\", \"mesh\": 0%s}],"
    " \"skins\": [{\"joints\": [0, 1, 2], \"inverseBindMatrices\": 2}],"
    " \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0%s}, \"indices\": 8}]}],"
    " %s"
    " \"accessors\": ["
    "{\"bufferView\": 0, \"componentType\": 5126, \"count\": 12, \"type\": \"VEC3\","
    " \"min\": [-9, -9, -9], \"max\": [9, 9, 9]},"
    "{\"bufferView\": 1, \"componentType\": 5126, \"count\": 12, \"type\": \"VEC4\"},"
    "{\"bufferView\": 2, \"componentType\": 5126, \"count\": 3, \"type\": \"MAT4\"},"
    "{\"bufferView\": 3, \"componentType\": 5126, \"count\": 4, \"type\": \"SCALAR\","
    " \"min\": [0], \"max\": [2]},"
    "{\"bufferView\": 4, \"componentType\": 5126, \"count\": 4, \"type\": \"VEC4\"},"
    "{\"bufferView\": 4, \"byteOffset\": 64, \"componentType\": 5126, \"count\": 4,"
    " \"type\": \"VEC4\"},"
    "{\"bufferView\": 4, \"byteOffset\": 128, \"componentType\": 5126, \"count\": 4,"
    " \"type\": \"VEC4\"},"
    "{\"bufferView\": 5, \"componentType\": 5126, \"count\": 4, \"type\": \"VEC3\"},"
    "{\"bufferView\": 6, \"componentType\": 5123, \"count\": 12, \"type\": \"SCALAR\"},"
    "{\"bufferView\": 7, \"componentType\": 5121, \"count\": 12, \"type\": \"VEC4\"},"
    "{\"bufferView\": 3, \"componentType\": 5126, \"count\": 1, \"type\": \"SCALAR\","
    " \"min\": [0], \"max\": [0]},"
    "{\"bufferView\": 4, \"componentType\": 5126, \"count\": 1, \"type\": \"VEC4\"}],"
    " \"bufferViews\": [%s],"
    " \"buffers\": [{\"byteLength\": %zu, \"uri\": \"data:application/octet-stream;base64,%s\"}]}";

const struct variant SOUND = {"chest", SKIN, ", \"WEIGHTS_0\": 1, \"JOINTS_0\": 9", WAVE, "LINEAR"};

static void to_base64(const void *data, size_t size, char *out)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *b = data; /* the caller pads it with zeros to a multiple of three bytes */
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = (uint32_t)b[i] << 16 | (uint32_t)b[i + 1] << 8 | b[i + 2];
        for (int k = 0; k < 4; k++)
            *out++ = digits[bits >> (18 - 6 * k) & 63];
    }
    *out = '\0';
}

const char *to_gltf(const struct rig *rig, const struct variant *variant)
{
    static char text[16384];
    char base64[8192], animations[2048], views[1024] = "";
    unsigned char bytes[sizeof *rig / 3 * 3 + 3] = {0};
    static const size_t offsets[] = {offsetof(struct rig, positions),
                                     offsetof(struct rig, weights),
                                     offsetof(struct rig, inverse),
                                     offsetof(struct rig, times),
                                     offsetof(struct rig, turns),
                                     offsetof(struct rig, moves),
                                     offsetof(struct rig, triangles),
                                     offsetof(struct rig, joints),
                                     sizeof(struct rig)};
    size_t length = 0;
    for (int i = 0; i < 8; i++)
        length += (size_t)snprintf(views + length, sizeof views - length,
                                   "%s{\"buffer\": 0, \"byteOffset\": %zu, \"byteLength\": %zu}",
                                   i ? ", " : "", offsets[i], offsets[i + 1] - offsets[i]);
    memcpy(bytes, rig, sizeof *rig);
    to_base64(bytes, sizeof bytes, base64);
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    snprintf(animations, sizeof animations, variant->animations, variant->interpolation);
#pragma GCC diagnostic pop
    snprintf(text, sizeof text, JSON, variant->second, variant->skin, variant->attributes,
             animations, views, sizeof bytes, base64);
    return text;
}

struct kiln_skin *parse(const struct rig *rig, const struct variant *variant)
{
    struct kiln_error error = {0};
    const char *text = to_gltf(rig, variant);
    struct kiln_skin *skin = kiln_skin_parse(text, strlen(text), "rig.gltf", &error);
    if (!skin)
        fail_msg("%s", error.message);
    return skin;
}

void refuse(const struct rig *rig, const struct variant *variant, const char *reason)
{
    struct kiln_error error = {0};
    const char *text = to_gltf(rig, variant);
    assert_null(kiln_skin_parse(text, strlen(text), "rig.gltf", &error));
    expect_error(&error, KILN_INVALID_INPUT, "rig.gltf: %s", reason);
}

void set_turn(float out[4], const double axis[3], double angle)
{
    for (int c = 0; c < 3; c++)
        out[c] = (float)(axis[c] * sin(0.5 * angle));
    out[3] = (float)cos(0.5 * angle);
}

/* Returns a pseudo-random number from 0 to 1, and advances the generator's state. */
static double chance(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

struct rig still_rig(void)
{
    struct rig rig = {.times = {0.0f, 0.5f, 1.25f, 2.0f}};
    uint32_t state = 5;
    for (int i = 0; i < VERTICES; i++) {
        for (int c = 0; c < 3; c++)
            rig.positions[i][c] = (float)(chance(&state) * 3.0 - (c == 1 ? 0.0 : 1.5));
        rig.weights[i][0] = 1.0f;
        rig.triangles[i / 3][i % 3] = (uint16_t)i;
    }
    for (int j = 0; j < JOINTS; j++) {
        for (int c = 0; c < 4; c++)
            rig.inverse[j][5 * c] = 1.0f;
        rig.inverse[j][13] = (float)-j;
        for (int k = 0; k < KEYS; k++)
            rig.turns[j][k][3] = 1.0f;
    }
    return rig;
}

struct rig waving_rig(void)
{
    struct rig rig = still_rig();
    uint32_t state = 11;
    for (int i = 0; i < VERTICES; i++) {
        double parts[JOINTS] = {chance(&state), chance(&state), chance(&state)};
        double sum = parts[0] + parts[1] + parts[2];
        for (int j = 0; j < JOINTS; j++) {
            rig.weights[i][j] = (float)(parts[j] / sum);
            rig.joints[i][j] = (uint8_t)j;
        }
    }
    for (int k = 0; k < KEYS - 1; k++) {
        for (int j = 0; j < JOINTS; j++) {
            double a = 6.28 * chance(&state), b = 6.28 * chance(&state);
            const double axis[3] = {cos(a) * cos(b), sin(a) * cos(b), sin(b)};
            set_turn(rig.turns[j][k], axis, 3.0 * chance(&state));
        }
        for (int c = 0; c < 3; c++)
            rig.moves[k][c] = (float)chance(&state);
    }
    for (int j = 0; j < JOINTS; j++)
        memcpy(rig.turns[j][KEYS - 1], rig.turns[j][0], sizeof rig.turns[j][0]);
    memcpy(rig.moves[KEYS - 1], rig.moves[0], sizeof rig.moves[0]);
    return rig;
}
