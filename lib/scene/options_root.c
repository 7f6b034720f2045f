/* This file has the option tables of the top of a scene: its output, clock, camera and systems. */
#include "scene/rows.h"

#define FILLS struct kiln_camera

TABLE(shutter) = {
    INTEGER(VIEW, "samples", shutter_samples, 1, 256, "1",
            "Number of moments whose mean is a frame. 1 gives a sharp picture. A moment that lies "
            "within a simulation step is drawn between the states before and after that step."),
    {ROW(VIEW, "angle", number, shutter_angle, "180 deg",
         "Shutter angle: 360 deg keeps the shutter open for the whole time of a frame."),
     LIMITS(KILN_ANGLE, KILN_DEG(1), KILN_DEG(360))},
    {ROW(VIEW, "phase", number, shutter_phase, "0 deg",
         "Part of a frame's time, of 360 deg, after which the first moment lies: of a sharp "
         "picture, its only one. Clips of several phases are the frames of a slow motion of the "
         "same simulation."),
     LIMITS(KILN_ANGLE, 0, KILN_DEG(360))},
    END,
};

TABLE(camera) = {
    ATTACH(
        IF_CAMERA_IS_ATTACHED,
        "Node that the camera lies in. `position` and `target` are then in the node's frame, and "
        "the node's y is up; without them, the camera is in the node and looks along its z."),
    VECTOR(VIEW, "position", position, KILN_METRES, -FAR, FAR, TIME(1), "[0, 1.5, 6]",
           "Position of the eye."),
    VECTOR(VIEW, "target", target, KILN_METRES, -FAR, FAR, TIME(2), "[0, 1, 0]",
           "Point that the camera looks at."),
    VALUE(LOOK, "fov", fov, KILN_ANGLE, KILN_DEG(1), KILN_DEG(170), TIME(3), "45 deg",
          "Vertical field of view."),
    VALUE(LOOK, "roll", roll, KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600), TIME(4), "0 deg",
          "Angle by which the camera is turned about its line of sight."),
    VALUE(LOOK, "near", near_plane, KILN_METRES, 0.001, 100, TIME(5), "0.05 m",
          "Distance of the near plane; nothing nearer than this is drawn."),
    VALUE(
        VIEW, "aperture", aperture, KILN_METRES, 0, 10, TIME(6), "0 m",
        "Diameter of the lens, which blurs what is out of focus: a point at distance d is a disc "
        "of diameter aperture * |d - focus| / d in the plane of focus. 0 m is a pinhole, which "
        "blurs nothing. It takes output.samples or camera.shutter.samples: of one moment, a frame "
        "shows what a pinhole does, and a warning says so."),
    {ROW(VIEW, "focus", value, focus, "target",
         "Distance along the line of sight at which the picture is sharp. target is the distance "
         "of the point that the camera looks at."),
     LIMITS(KILN_METRES, 0.001, 1000000), .clocks = TIME(7), .special_word = "target"},
    GROUP(VIEW, "shutter", shutter, "Motion blur: a frame is the mean of several moments."),
    END,
};

#undef FILLS
#define FILLS struct kiln_scene

TABLE(output) = {
    {ROW(LOOK, "size", pair, size, "[1280, 720]", "Width and height of the pictures."),
     LIMITS(KILN_PIXELS, KILN_MIN_EDGE, KILN_MAX_EDGE)},
    INTEGER(VIEW, "samples", pixel_samples, 1, 256, "1",
            "Number of places in each pixel whose mean is its colour, by a filter that reaches a "
            "pixel beyond its middle: 4 or 16 for a still with smooth edges. A frame is drawn once "
            "for each of them; moments of the shutter count as such."),
    {ROW(VIEW, "fps", rational, fps, "30",
         "Frames a second: 30, 12.5 or 30000/1001. 29.97 is 30000/1001, as broadcast means it; "
         "so are 23.976, 47.952, 59.94 and 119.88."),
     LIMITS(KILN_PLAIN, 1, KILN_MAX_RATE)},
    {ROW(LOOK, "frames", integer, frames, "150", "Number of frames in the clip."),
     LIMITS(KILN_PLAIN, 1, KILN_MAX_FRAMES), .instead_of = "duration"},
    {ROW_OF_ALL(
         LOOK, "duration", duration, "none",
         "Length of the clip, in place of `frames`, which it rounds to whole frames. A time of "
         "keys may be a part of the clip, such as 50 %."),
     LIMITS(KILN_SECONDS, 0, KILN_MAX_FRAMES), .special_word = "none", .is_unprinted = true,
     .instead_of = "frames"},
    END,
};

static const char *const integrations[] = {
    [KILN_INTEGRATE_SEMI_IMPLICIT] = "semi_implicit",
    [KILN_INTEGRATE_POSITION_FIRST] = "position_first",
    [KILN_INTEGRATE_TRAPEZOID] = "trapezoid",
    [KILN_INTEGRATE_RK4] = "rk4",
    NULL,
};

TABLE(simulation) = {
    {ROW(MOTION, "rate", rational, rate, "auto",
         "Simulation steps a second, a whole multiple of output.fps. `auto` takes the smallest "
         "rate that is at least 60."),
     LIMITS(KILN_PLAIN, 1, 100000), .special_word = "auto"},
    {ROW(MOTION, "warmup", number, warmup_s, "0 s",
         "Time that is simulated before the first frame, in whole steps. Clip time is negative "
         "during the warm-up."),
     LIMITS(KILN_SECONDS, 0, 100000)},
    CHOICE(
        MOTION, "integration", integration, integrations, "semi_implicit",
        "How a step integrates the motion. `semi_implicit` moves a particle by its new velocity, "
        "`position_first` by its old velocity. `trapezoid` moves it by the mean of both, with an "
        "error of second order in the step. rk4 evaluates the forces four times, with an error "
        "of fourth order."),
    BOUNDS(MOTION, "bounds", bounds, "none",
           "Box outside of which particles die, for systems without bounds of their own."),
    END,
};

PUBLIC_TABLE(kiln_options_root) = {
    INTEGER(LOOK, "kiln", format_version, 1, 1, NULL, "Version of the scene format."),
    RESOLVED(MOTION, include, "include",
             "Scene files whose keys lie under those of this one: mappings merge, and where both "
             "have a value, that of this file is taken."),
    RESOLVED(
        MOTION, params, "params",
        "Parameters. A value $name is that of the parameter, and \"= 2 * $name\" is arithmetic "
        "with it."),
    INTEGER(MOTION, "seed", seed, 0, UINT32_MAX, "0",
            "Another seed gives another run of the same scene."),
    GROUP(VIEW, "output", output, "The clip."),
    GROUP(MOTION, "simulation", simulation, "The clock of the simulation."),
    {MEMBERS_OF_MAP(OF_NODES, "nodes", nodes, kiln_options_node, node_count, "{}",
                    "Places that move and turn, by their names. The camera, emitters, objects and "
                    "lights may be attached to them."),
     .is_counted = true},
    GROUP_AT(VIEW, "camera", camera, camera, "The camera that takes the pictures."),
    GROUP_AT(MOTION, "backdrop", backdrop, kiln_options_backdrop,
             "Sky, sun, floor, objects and lights around the particles."),
    MAP(MOTION, "systems", systems, kiln_options_system, system_count, "{}",
        "The particle systems by their names."),
    {MEMBERS_OF_MAP(OF_GAS, "gas", gas, kiln_options_gas, gas_count, "{}",
                    "Domains in which smoke and fire flow, by their names."),
     .is_hidden_if_empty = true},
    GROUP_AT(LOOK, "post", post, kiln_options_post,
             "Post-processing: composition, bloom, exposure and tone mapping turn light into the "
             "picture."),
    END,
};
