/* Compares what kiln reads of glTF files with what three.js reads of them. If this fails, kiln
 * misreads a kind of glTF file, or no longer refuses one that it cannot read.
 *
 * It runs as `gltf_compare CASES FOLDER`. CASES has a line for each file:
 *   FILE same             as in FOLDER/FILE.expect, which expect.mjs writes and describes
 *   FILE noted NOTE       the same, with this note to the user
 *   FILE any              the same, with any notes or none
 *   FILE refused MESSAGE  kiln refuses it with this message
 * FILE is a path from the folder of CASES. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/skin.h"
#include "base/error.h"

static const uint32_t MARK = 0x58454c47;

/* Differences that are allowed: of positions as a part of the mesh's size, and of unit normals. */
static const double MOST_DISTANCE = 1e-5, MOST_TURN = 1e-4;

enum { REST_NUMBERS = 8, POSE_NUMBERS = 6 };

struct expected {
    unsigned char *bytes;
    size_t size, at;
};

static int failures;
static double farthest, most_turned; /* the largest differences of all files */

static void complain(const char *file, const char *what)
{
    fprintf(stderr, "%s: %s\n", file, what);
    failures++;
}

/* ---- reading --------------------------------------------------------------------------------- */

static bool read_expected(const char *path, struct expected *expected)
{
    FILE *file = fopen(path, "rb");
    *expected = (struct expected){.bytes = malloc(256 << 20)};
    if (!file || !expected->bytes)
        return false;
    expected->size = fread(expected->bytes, 1, 256 << 20, file);
    fclose(file);
    return expected->size > 0;
}

/* Returns the next numbers; NULL: there are fewer. */
static const void *take(struct expected *expected, size_t count)
{
    const unsigned char *from = expected->bytes + expected->at;
    if (count > (expected->size - expected->at) / 4)
        return NULL;
    expected->at += 4 * count;
    return from;
}

static uint32_t take_word(struct expected *expected)
{
    uint32_t word = 0;
    const void *from = take(expected, 1);
    if (from)
        memcpy(&word, from, sizeof word);
    return word;
}

static float take_float(struct expected *expected)
{
    const uint32_t word = take_word(expected);
    float number;
    memcpy(&number, &word, sizeof number);
    return number;
}

/* ---- comparing ------------------------------------------------------------------------------- */

/* Returns how far numbers differ; those that are not expected are not compared. */
static double differ(const float *expected, const float *found, int count)
{
    double most = 0.0;
    for (int i = 0; i < count; i++) {
        if (!isnan(expected[i]))
            most = fmax(most, fabs((double)expected[i] - (double)found[i]));
    }
    return most;
}

struct difference {
    double distance, turn, uv;
};

/* Compares the corners of a triangle, which may begin with any of them. */
static struct difference compare_triangle(const struct kiln_mesh *mesh, const uint32_t corners[3],
                                          const float *expected, int numbers)
{
    struct difference best = {INFINITY, INFINITY, INFINITY};
    for (size_t first = 0; first < 3; first++) {
        struct difference now = {0, 0, 0};
        for (size_t k = 0; k < 3; k++) {
            const float *e = expected + k * (size_t)numbers;
            const uint32_t vertex = corners[(first + k) % 3];
            now.distance = fmax(now.distance, differ(e, mesh->vertices[vertex], 3));
            now.turn = fmax(now.turn, differ(e + 3, mesh->vertices[vertex] + 3, 3));
            if (mesh->uvs && numbers == REST_NUMBERS)
                now.uv = fmax(now.uv, differ(e + 6, mesh->uvs[vertex], 2));
        }
        if (now.distance < best.distance)
            best = now;
    }
    return best;
}

static double size_of(const struct kiln_mesh *mesh)
{
    double size = 1e-30;
    for (int c = 0; c < 3; c++)
        size = fmax(size, (double)mesh->max[c] - (double)mesh->min[c]);
    return size;
}

/* Compares all triangles. what: for messages. */
static void compare_mesh(const char *file, const char *what, const struct kiln_mesh *mesh,
                         struct expected *expected, uint32_t triangles, int numbers)
{
    const float *from = take(expected, (size_t)triangles * 3 * (size_t)numbers);
    struct difference most = {0, 0, 0};
    char text[200];
    if (mesh->triangle_count != triangles || !from) {
        snprintf(text, sizeof text, "%s: %u triangles, expected %u", what, mesh->triangle_count,
                 triangles);
        complain(file, text);
        return;
    }
    for (uint32_t i = 0; i < triangles; i++) {
        const struct difference one = compare_triangle(
            mesh, mesh->triangles[i], from + (size_t)i * 3 * (size_t)numbers, numbers);
        most.distance = fmax(most.distance, one.distance);
        most.turn = fmax(most.turn, one.turn);
        most.uv = fmax(most.uv, one.uv);
    }
    most.distance /= size_of(mesh);
    farthest = fmax(farthest, most.distance);
    most_turned = fmax(most_turned, most.turn);
    snprintf(text, sizeof text,
             "%s: positions differ by %.3g of the size, normals by %.3g, texture coordinates by "
             "%.3g",
             what, most.distance, most.turn, most.uv);
    if (!(most.distance <= MOST_DISTANCE && most.turn <= MOST_TURN && most.uv <= MOST_DISTANCE))
        complain(file, text);
}

/* ---- files ----------------------------------------------------------------------------------- */

static void compare_clips(const char *file, const char *path, struct expected *expected,
                          uint32_t triangles)
{
    struct kiln_error error = {0};
    const uint32_t clips = take_word(expected);
    if (clips == 0)
        return;
    struct kiln_skin *skin = kiln_skin_load(NULL, path, &error);
    struct kiln_mesh *mesh = skin ? kiln_mesh_copy(kiln_skin_mesh(skin)) : NULL;
    if (!mesh)
        complain(file, error.message);
    for (uint32_t i = 0; mesh && i < clips; i++) {
        const float length = take_float(expected), found = kiln_skin_clip_length(skin, i);
        char what[64];
        if (!(fabsf(length - found) <= 1e-5f * fmaxf(1.0f, length)))
            complain(file, "a clip has another length");
        for (int k = 0; k < 3; k++) {
            const float seconds = take_float(expected);
            snprintf(what, sizeof what, "clip %u at %g s", i, (double)seconds);
            kiln_skin_pose_mesh(skin, i, seconds, mesh);
            compare_mesh(file, what, mesh, expected, triangles, POSE_NUMBERS);
        }
    }
    kiln_mesh_destroy(&mesh);
    kiln_skin_destroy(&skin);
}

static void expect_refusal(const char *file, const char *path, const char *reason)
{
    struct kiln_error error = {0};
    char message[KILN_MESSAGE_SIZE + KILN_PATH_SIZE];
    struct kiln_mesh *mesh = kiln_mesh_load(NULL, path, &error);
    snprintf(message, sizeof message, "%s: %s", path, reason);
    if (mesh)
        complain(file, "it is not refused");
    else if (strcmp(error.message, message) != 0)
        complain(file, error.message);
    kiln_mesh_destroy(&mesh);
}

/* note: what is to be noted; NULL: anything. */
static void compare_file(const char *file, const char *path, const char *folder, const char *note)
{
    struct kiln_error error = {0};
    struct expected expected;
    char of[KILN_PATH_SIZE];
    const size_t start = (size_t)snprintf(of, sizeof of, "%s/", folder);
    snprintf(of + start, sizeof of - start, "%s.expect", file);
    for (char *c = of + start; *c; c++) {
        if (*c == '/')
            *c = '_';
    }
    if (!read_expected(of, &expected) || take_word(&expected) != MARK) {
        complain(file, "there is no expectation");
        free(expected.bytes);
        return;
    }
    const uint32_t triangles = take_word(&expected);
    const bool uvs = take_word(&expected) != 0;
    if (triangles == 0) {
        expect_refusal(file, path, "the mesh has no triangles");
        free(expected.bytes);
        return;
    }
    struct kiln_mesh *mesh = (uvs ? kiln_mesh_load_unwrapped : kiln_mesh_load)(NULL, path, &error);
    if (mesh) {
        compare_mesh(file, "at rest", mesh, &expected, triangles, REST_NUMBERS);
        if (note && strcmp(mesh->notes, note) != 0)
            complain(file, *mesh->notes ? mesh->notes : "there is no note");
        compare_clips(file, path, &expected, triangles);
    } else {
        complain(file, error.message);
    }
    kiln_mesh_destroy(&mesh);
    free(expected.bytes);
}

/* Splits a line of the cases: a file's name, which may have spaces, ends with " same" and so on. */
static bool run_case(char *line, const char *cases, const char *folder)
{
    static const char *const verdicts[] = {" same", " noted ", " refused ", " any"};
    char path[KILN_PATH_SIZE];
    const char *slash = strrchr(cases, '/');
    line[strcspn(line, "\n")] = '\0';
    if (*line == '\0' || *line == '#')
        return false;
    for (int i = 0; i < 4; i++) {
        char *at = strstr(line, verdicts[i]);
        if (!at)
            continue;
        *at = '\0';
        const char *rest = at + strlen(verdicts[i]);
        snprintf(path, sizeof path, "%.*s%s", *line == '/' || !slash ? 0 : (int)(slash - cases) + 1,
                 cases, line);
        if (i == 2)
            expect_refusal(line, path, rest);
        else
            compare_file(line, path, folder, i == 1 ? rest : i == 3 ? NULL : "");
        return true;
    }
    complain(line, "the line has no verdict");
    return true;
}

int main(int argc, char **argv)
{
    char line[2048];
    int count = 0;
    FILE *cases = argc == 3 ? fopen(argv[1], "r") : NULL;
    if (!cases)
        return 2;
    while (fgets(line, sizeof line, cases))
        count += run_case(line, argv[1], argv[2]);
    fclose(cases);
    printf("%d files, %d failures; positions differ by at most %.3g of the size, normals by %.3g\n",
           count, failures, farthest, most_turned);
    return count == 0 || failures > 0;
}
