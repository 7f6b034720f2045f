/* Runs the suite `forces` of `kiln bench`, which measures the simulation by each force and by each
 * integrator. */
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
    return kiln_bench_add_note(
        run->bench, error, "After the row without a force is subtracted, 1 ms is 1 ns a particle.");
}
