/* This file finds emitters that nodes swing round by a large part of a turn in a step.
 *
 * A node that turns about one axis is exact between two steps, however fast
 * (sim/world/emit_frame.c). A node on the arm of one that turns goes along a cubic, which leaves
 * the circle: by 0.3 % of the arm if it goes round by 60 degrees in a step, by 1.5 % if by 90
 * degrees, by 21 % if by 180. */
#include "scene/fast_nodes.h"

#include <math.h>
#include <stdio.h>

#include "scene/double3.h"
#include "scene/scene.h"
#include "shared/exact.h"

enum { MOST_SAMPLES = 256 }; /* steps of a clip that are looked at */

static const double QUARTER = 1.5707963267948966;

/* Finds the node whose turning moves another one along a circle: the nearest one above it that does
 * not have the same origin. Returns false if there is none. */
static bool find_center(const struct kiln_scene *scene, uint32_t node, uint32_t *center)
{
    const struct kiln_scene_node *n = &scene->nodes[node];
    while (n->parent.name) {
        const struct kiln_value3 *at = &n->position.value;
        *center = n->parent.node;
        if (n->position.path.points.count > 0 || !kiln_value3_is_constant(at) ||
            at->x.constant != 0.0f || at->y.constant != 0.0f || at->z.constant != 0.0f)
            return true;
        n = &scene->nodes[n->parent.node];
    }
    return false;
}

/* Returns by how much a node turns in a step, at most, rad. */
static double most_turn(const struct kiln_scene *scene, uint32_t node)
{
    const uint32_t steps = kiln_scene_frame_step(scene, scene->frames - 1);
    const uint32_t stride = steps / MOST_SAMPLES + 1;
    double most = 0;
    for (uint32_t step = 0; step <= steps; step += stride) {
        const float time_s = kiln_scene_time(scene, step);
        const struct kiln_node_frame frame = kiln_node_frame_at(scene, node, time_s, time_s);
        most = fmax(most, double3_length(frame.spin));
    }
    return most * (double)scene->rate.den / (double)scene->rate.num;
}

static void check_system(struct kiln_reader *reader, const struct kiln_node *root,
                         const struct kiln_system *system)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    uint32_t center;
    if (!find_center(scene, system->emit.attach.node, &center))
        return;
    const double turn = most_turn(scene, center);
    if (!(turn > QUARTER * 1.001))
        return;
    const double rate = (double)scene->rate.num / (double)scene->rate.den;
    const struct exact_angle half = exact_sincos((float)(0.5 * turn));
    const double off = fabs((double)half.cosine + 0.25 * turn * (double)half.sine - 1);
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.attach", system->name);
    kiln_reader_warn_at(
        reader, root, path,
        "the node goes round '%s', which turns by up to %.3g deg in a step, so that "
        "births between two steps are up to %.2g %% of its distance beside the "
        "circle: let simulation.rate be %.6g or more",
        scene->nodes[center].name, turn / QUARTER * 90, 100 * off,
        rate * ceil(turn / QUARTER / 1.001));
}

void kiln_fast_nodes_warn(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (scene->systems[i].enabled && scene->systems[i].emit.attach.name)
            check_system(reader, root, &scene->systems[i]);
    }
}
