/* This file has the option tables of the nodes of a scene, and of their paths. option/rows.h and
 * scene/rows.h define the macros of the rows; FILLS is the struct that the next tables fill. */
#include "option/value_form.h"
#include "scene/rows.h"

#define FILLS struct kiln_path

TABLE(path_rows) = {
    {ROW(OF_NODE, "points", points, points, NULL,
         "Points of the path, in the parent's frame, two at least. The path is a smooth curve "
         "through all of them, in their order: a centripetal Catmull-Rom spline."),
     LIMITS(KILN_METRES, -FAR, FAR)},
    {ROW(OF_NODE, "over", range, over, NULL,
         "Clip times at which the node leaves the first point and reaches the last. Before and "
         "after, it stays there."),
     LIMITS(KILN_SECONDS, -FAR, 1000000), .is_of_clip = true},
    CHOICE(OF_NODE, "ease", ease, kiln_value_eases, "linear",
           "How the node goes through the length of the path: linear at one speed, smooth from "
           "rest to rest, in from rest, out to rest; step jumps at the end of the time."),
    BOOLEAN(OF_NODE, "closed", closed, "false",
            "The path goes on from its last point to its first, and ends there."),
    END,
};

#undef FILLS
#define FILLS struct kiln_node_position

TABLE(place_rows) = {
    GROUP_AT(OF_NODE, "path", path, path_rows, "The node moves along a curve through points."),
    END,
};

#undef FILLS
#define FILLS struct kiln_scene_node

static const char *const headings[] = {
    [KILN_HEADING_FIXED] = "fixed",
    [KILN_HEADING_PATH] = "path",
    NULL,
};

static const char *const aheads[] = {
    [KILN_AHEAD_Z] = "z",
    [KILN_AHEAD_Y] = "y",
    [KILN_AHEAD_X] = "x",
    [KILN_AHEAD_MINUS_Z] = "-z",
    [KILN_AHEAD_MINUS_Y] = "-y",
    [KILN_AHEAD_MINUS_X] = "-x",
    NULL,
};

TABLE(file_animation) = {
    ANIMATION(IF_NODE_IS_OF_FILE, animation.),
    END,
};

PUBLIC_TABLE(kiln_options_node) = {
    {ROW(OF_NODE, "parent", attach, parent, "none",
         "Node in whose frame this one lies. A parent may have a parent."),
     .special_word = "none"},
    {ROW(OF_NODE, "position", place, position, "[0, 0, 0]",
         "Place of the node: a vector, or a path that it moves along."),
     LIMITS(KILN_METRES, -FAR, FAR), .clocks = TIME(70), .members = place_rows},
    VECTOR(OF_NODE, "rotation", rotation, KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600), TIME(71),
           "[0, 0, 0]", "Angles about x, then y, then z; with a heading, within it."),
    CHOICE(OF_NODE, "heading", heading, headings, "fixed",
           "`path` turns the node along the path of its position. Its y is up at the first point, "
           "or -z with `ahead: y` and z with `ahead: -y`. It is carried along the path without "
           "roll."),
    CHOICE(OF_NODE, "ahead", ahead, aheads, "z", "The axis that `heading: path` turns ahead."),
    VALUE(OF_NODE, "scale", scale, KILN_PLAIN, 0.000001, FAR, TIME(72), "1",
          "Factor on places and sizes of what lies in the node."),
    {ROW(IF_NODE_IS_OF_FILE, "file", gltf, file, "none",
         "A glTF or GLB file, whose space is that of position, rotation and scale. The node then "
         "is where a node of the file is.")},
    {ROW(IF_NODE_IS_OF_FILE, "node", part, file_node, "none",
         "The node of the file. If it has a camera, a camera attached here looks along -z and "
         "takes the field of view of that camera.")},
    SWITCH(IF_NODE_IS_OF_FILE, "animation", file_animation, animation.enabled, "{}",
           "An animation of the file, which moves the node. A file without animations needs none."),
    {ROW(IF_NODE_IS_JOINT, "mesh", object, mesh, "none",
         "A mesh of the backdrop. The node then is where a joint of that mesh is; it "
         "has no parent, position, rotation and scale of its own.")},
    {ROW(IF_NODE_IS_JOINT, "joint", part, joint, "none",
         "The joint, or another node of the mesh's file. It follows the mesh and its animation.")},
    END,
};
