/* Writes boxes and balls as OBJ files for tests of mesh colliders, and loads them. */
#ifndef KILN_TESTS_BODIES_H
#define KILN_TESTS_BODIES_H

#include <stdio.h>

#include "asset/geometry/mesh.h"

/* Holds an OBJ file that is being written. */
struct body {
    FILE *out;
    int count; /* vertices of boxes so far; add_ball does not count vertices */
};

/* Adds a box with its centre at (x, y, z), m, and edges of the lengths w, h and d, m, along x, y
 * and z. A negative length turns the box inside out. */
void add_box(struct body *body, double x, double y, double z, double w, double h, double d);

enum { RINGS = 40 };

/* Adds a ball of radius 1 m about the origin: RINGS - 1 rings of 2 * RINGS vertices, and two poles.
 * It must be the only body of its file, since its faces number the vertices from 1. */
void add_ball(struct body *body);

/* Creates an OBJ file without bodies. The caller closes its `out`. */
struct body begin(const char *path);

/* Loads the mesh of an OBJ file. The caller destroys it. An error fails the test. */
struct kiln_mesh *body_load(const char *path);

/* Writes one ball to ball.obj in the working directory, and loads it. */
struct kiln_mesh *body_load_ball(void);

/* Writes an OBJ file with one box about the origin, with edges of the lengths w, h and d, m. */
void body_write_box(const char *path, double w, double h, double d);

#endif
