/* Runs the suite `colliders` of `kiln bench`, which measures the simulation of particles that
 * bounce off each kind of collider, and the time to build the volume of a mesh. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "bench/suite.h"

/* The mesh of the rows below is a ring (a torus), as wide as the cloud is high. The suite writes
 * its file, since scenes of the library have no files of their own. */
#define RING "mesh: {file: ring.obj, position: [0, 2, 0], collide: true, "
enum { AROUND = 96, ACROSS = 48 }; /* quads along the ring and its tube, two triangles each */
#define TURNING  "rotation: [90 deg, 0 deg, {keys: {0 s: 0 deg, 10 s: 600 deg}}]"
#define STANDING "rotation: [90 deg, 0 deg, 0 deg]"

static const struct {
    const char *name, *object;
} ROWS[] = {
    {"none", ""},
    {"sphere", "sphere: {center: [0, 2, 0], radius: 1.5}"},
    {"box", "box: {center: [0, 2, 0], size: [3, 2, 1.5]}"},
    {"turning box",
     "box: {center: [0, 2, 0], size: [3, 2, 1.5], rotation: [0 deg, 0 deg, {keys: {0 s: 0 deg, "
     "10 s: 600 deg}}]}"},
    {"height field", "terrain: {size: [12, 1.2, 8], samples: [257, 257], hills: 3 m}"},
    {"distance field", RING STANDING "}"},
    {"distance field, turning", RING TURNING "}"},
    {"depth maps", RING STANDING ", collider: depth_maps}"},
    {"depth maps, turning", RING TURNING ", collider: depth_maps}"},
    {"volume", RING STANDING ", collider: volume}"},
    {"volume, turning", RING TURNING ", collider: volume}"},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

static bool write_ring(const char *path, struct kiln_error *error)
{
    FILE *out = fopen(path, "w");
    if (!out)
        return kiln_error_set(error, KILN_IO, "%s: cannot be written", path);
    const double turn = 6.28318530717958648;
    for (int i = 0; i < AROUND; i++)
        for (int k = 0; k < ACROSS; k++) {
            const double r = 1.4 + 0.4 * cos(turn * k / ACROSS);
            fprintf(out, "v %.6f %.6f %.6f\n", r * cos(turn * i / AROUND),
                    0.4 * sin(turn * k / ACROSS), r * sin(turn * i / AROUND));
        }
    for (int i = 0; i < AROUND; i++)
        for (int k = 0; k < ACROSS; k++) {
            const int a = i * ACROSS, b = (i + 1) % AROUND * ACROSS, next = (k + 1) % ACROSS;
            fprintf(out, "f %d %d %d %d\n", a + k + 1, a + next + 1, b + next + 1, b + k + 1);
        }
    if (fclose(out) == 0)
        return true;
    return kiln_error_set(error, KILN_IO, "%s: cannot be written", path);
}

static bool run_row(const struct kiln_bench_run *run, const char *root, const char *name,
                    const char *object, double particles, double x, struct kiln_error *error)
{
    struct kiln_settings settings = {.asset_root = root};
    char objects[320];
    snprintf(objects, sizeof objects, "backdrop.objects=[%s]", object);
    kiln_set(run, &settings, "systems.*.forces=[gravity: [0, -4, 0]]");
    kiln_set(run, &settings, "backdrop.floor.collide=false");
    kiln_set(run, &settings, objects);
    return kiln_compare_cloud(run, &settings, particles, name, x, error);
}

static bool run_particles(const struct kiln_bench_run *run, const char *root,
                          struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "colliders",
        .title = "Simulation by the object that a cloud of particles bounces off",
        .sweep = "particles",
        .unit = "ms",
    };
    const double particles = run->params->quick ? 10000 : 1000000;
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < ROW_COUNT; i++)
        if (!run_row(run, root, ROWS[i].name, ROWS[i].object, particles, particles, error))
            return false;
    return kiln_bench_add_note(
        run->bench, error,
        "After the row without a collider is subtracted, 1 ms is 1 ns a particle, whether it "
        "touches the collider or not. A volume that turns is also built in each step.");
}

/* Measures steps with two particles only, so that a step takes as long as building the collider's
 * volume. */
static bool run_building(const struct kiln_bench_run *run, const char *root,
                         struct kiln_error *error)
{
    static const int cells[] = {16, 32, 48, 64, 96, 128};
    const struct kiln_bench_part part = {
        .name = "volumes",
        .title = "A step with a volume that turns: building it (Drone 2007, 7.5.2.1)",
        .sweep = "cells along its longest edge",
        .unit = "ms",
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
        char object[256];
        snprintf(object, sizeof object, RING TURNING ", collider: volume, cells: %d}", cells[i]);
        if (!run_row(run, root, "9,216 triangles", object, 2, cells[i], error))
            return false;
    }
    return kiln_bench_note_growth(run, error);
}

bool kiln_suite_colliders(const struct kiln_bench_run *run, struct kiln_error *error)
{
    char root[KILN_PATH_SIZE], path[KILN_PATH_SIZE];
    if (!kiln_path_join(root, run->params->scratch, "kiln-bench-XXXXXX", error))
        return false;
    if (!mkdtemp(root))
        return kiln_error_set(error, KILN_IO, "%s: no folder for a mesh can be made there",
                              run->params->scratch);
    const bool done = kiln_path_join(path, root, "ring.obj", error) && write_ring(path, error) &&
                      run_particles(run, root, error) && run_building(run, root, error);
    unlink(path);
    rmdir(root);
    return done;
}
