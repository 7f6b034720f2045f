/* Runs the suite `forces` of `kiln bench`, which measures the simulation by each force and by each
 * integrator, and winds against the same winds baked. */
#include <stdio.h>

#include "bench/suite.h"

#define VORTEX "vortex: {inward: 0.3, lift: 0.5, pull: 2"

static const struct {
    const char *name, *forces, *integration;
} ROWS[] = {
    {"none", "[]", NULL},
    {"gravity", "[gravity: [0, 0, 0]]", NULL},
    {"drag", "[drag: 0.5]", NULL},
    {"quadratic drag", "[drag: {strength: 0, quadratic: 1}]", NULL},
    {"wind", "[wind: [1, 0, 0]]", NULL},
    {"curl, an octave", "[curl: 1]", NULL},
    {"attract", "[attract: 1]", NULL},
    {"vortex, rankine", "[" VORTEX "}]", NULL},
    {"vortex, lamb_oseen", "[" VORTEX ", profile: lamb_oseen}]", NULL},
    {"vortex, trapezoid", "[" VORTEX "}]", "trapezoid"},
    {"vortex, rk4", "[" VORTEX "}]", "rk4"},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

/* ---- baked winds ----------------------------------------------------------------------------- */

#define FIELDS                                                                                     \
    "curl: {scale: 1.5, octaves: 3, drift: [0, 0.5, 0]}, vortex: {position: [-1, 0, 0], inward: "  \
    "0.3}, "                                                                                       \
    "vortex: {position: [1, 0, 0], lift: 0.5}"
#define BAKED(cells)                                                                               \
    "[wind: {baked: {box: {center: [0, 2, 0], size: [6, 6, 6]}, " cells ", of: [" FIELDS "]}}]"

static const struct {
    const char *name, *forces;
} WINDS[] = {
    {"none", "[]"},
    {"three octaves and two vortices", "[" FIELDS "]"},
    {"baked, 32 cells", BAKED("cells: 32")},
    {"baked, 32 cells, every 4 steps", BAKED("cells: 32, every: 4")},
    {"baked, 64 cells", BAKED("cells: 64")},
    {"baked, 64 cells, every 4 steps", BAKED("cells: 64, every: 4")},
};

/* Measures particles of one system, which has one grid, in a cube. */
static bool compare_winds(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "baked winds",
        .title = "Four steps in winds, and in the same winds baked (Heinz 2019, 2.2.5)",
        .sweep = "particles",
        .unit = "ms",
    };
    const double particles = run->params->quick ? 10000 : 160000;
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < sizeof WINDS / sizeof *WINDS; i++) {
        struct kiln_settings settings = {.count = 0};
        char forces[400];
        snprintf(forces, sizeof forces, "systems.smoke.forces=%s", WINDS[i].forces);
        kiln_set(run, &settings, "simulation.rate=240"); /* each frame writes each grid */
        kiln_set(run, &settings, "systems.*.collide=none");
        kiln_set(run, &settings, "systems.fire.enabled=false");
        kiln_set(
            run, &settings,
            "systems.smoke.emit.from=box: {origin: [0, 2, 0], size: [4, 4, 4], angle: 180 deg}");
        kiln_set(run, &settings, forces);
        if (!kiln_compare_cloud(run, &settings, 2 * particles, WINDS[i].name, particles, error))
            return false;
    }
    return kiln_bench_add_note(run->bench, error,
                               "160,000 particles of one system. A frame has four steps, so each "
                               "frame writes the grids of `every 4 steps` once.");
}

bool kiln_suite_forces(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "forces",
        .title = "Simulation by its force and integrator, without collision",
        .sweep = "particles",
        .unit = "ms",
    };
    const double particles = run->params->quick ? 10000 : 1000000;
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < ROW_COUNT; i++) {
        struct kiln_settings settings = {.count = 0};
        char forces[160];
        snprintf(forces, sizeof forces, "systems.*.forces=%s", ROWS[i].forces);
        kiln_set(run, &settings, "systems.*.collide=none");
        kiln_set(run, &settings, forces);
        if (ROWS[i].integration) {
            char integration[64];
            snprintf(integration, sizeof integration, "simulation.integration=%s",
                     ROWS[i].integration);
            kiln_set(run, &settings, integration);
        }
        if (!kiln_compare_cloud(run, &settings, particles, ROWS[i].name, particles, error))
            return false;
    }
    return kiln_bench_add_note(run->bench, error,
                               "After the row without a force is subtracted, 1 ms is 1 ns a "
                               "particle.") &&
           compare_winds(run, error);
}
