/* Compares the poses of nodes of glTF files with those of three.js: `gltf_nodes FOLDER` reads
 * FOLDER/expect.txt, which nodes.mjs writes and describes. If this fails, nodes and cameras of
 * files are elsewhere than where the program that wrote the file shows them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/rig.h"

/* The differences that are allowed, of places as a part of their size. */
static const double MOST = 1e-5;

struct line {
    char file[64];
    int clip;
    float seconds;
    char node[16];
    double at[3], ahead[3], up[3], scale;
};

/* Reads a line. False: the file ends. */
static bool read_line(FILE *file, struct line *l)
{
    char text[1024], *rest = text;
    if (!fgets(text, sizeof text, file))
        return false;
    snprintf(l->file, sizeof l->file, "%s", strsep(&rest, " "));
    double numbers[13] = {0};
    for (int i = 0; i < 13 && rest; i++)
        numbers[i] = strtod(rest, &rest);
    l->clip = (int)numbers[0];
    l->seconds = (float)numbers[1];
    snprintf(l->node, sizeof l->node, "%d", (int)numbers[2]);
    memcpy(l->at, numbers + 3, sizeof l->at);
    memcpy(l->ahead, numbers + 6, sizeof l->ahead);
    memcpy(l->up, numbers + 9, sizeof l->up);
    l->scale = numbers[12];
    return true;
}

static double difference(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Returns the largest difference of a line. */
static double compare(const struct kiln_rig *rig, const struct line *l)
{
    struct kiln_error error = {0};
    uint32_t node = 0;
    if (!kiln_rig_find_node(rig, l->node, false, l->file, &node, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return INFINITY;
    }
    const struct kiln_rig_moment moment = {.clip =
                                               l->clip < 0 ? KILN_RIG_AT_REST : (uint32_t)l->clip,
                                           .seconds = l->seconds,
                                           .rate_seconds = l->seconds,
                                           .clip_s_each_s = 1};
    const struct kiln_rig_pose pose = kiln_rig_pose_at(rig, node, &moment);
    const double size = 1 + fabs(l->at[0]) + fabs(l->at[1]) + fabs(l->at[2]);
    const double place = difference(pose.at, l->at) / size;
    const double turn = fmax(difference(pose.ahead, l->ahead), difference(pose.up, l->up));
    const double off = fmax(fmax(place, turn), fabs(pose.scale / l->scale - 1));
    if (!(off <= MOST))
        fprintf(stderr,
                "%s: node %s at %g s of clip %d: place [%g, %g, %g], not [%g, %g, %g]; turned by "
                "%g; scale %g, not %g\n",
                l->file, l->node, (double)l->seconds, l->clip, pose.at[0], pose.at[1], pose.at[2],
                l->at[0], l->at[1], l->at[2], turn, pose.scale, l->scale);
    return off;
}

int main(int argc, char **argv)
{
    char path[4096], open[64] = "";
    struct kiln_rig *rig = NULL;
    struct line line;
    double most = 0;
    int count = 0, failures = 0;
    snprintf(path, sizeof path, "%s/expect.txt", argc == 2 ? argv[1] : "");
    FILE *expected = fopen(path, "r");
    while (expected && failures < 20 && read_line(expected, &line)) {
        struct kiln_error error = {0};
        if (strcmp(open, line.file) != 0) {
            kiln_rig_destroy(&rig);
            snprintf(open, sizeof open, "%s", line.file);
            snprintf(path, sizeof path, "%s/%s", argv[1], line.file);
            rig = kiln_rig_load(NULL, path, &error);
        }
        if (!rig) {
            fprintf(stderr, "%s\n", error.message);
            break;
        }
        const double off = compare(rig, &line);
        most = fmax(most, off);
        failures += !(off <= MOST);
        count++;
    }
    const bool is_read = expected && feof(expected);
    kiln_rig_destroy(&rig);
    if (expected)
        fclose(expected);
    printf("%d poses of nodes, within %.2g of those of three.js\n", count, most);
    return failures == 0 && is_read && count > 300 ? 0 : 1;
}
