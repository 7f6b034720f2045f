/* Writes meshes for tests as OBJ files, and loads them. */
#ifndef KILN_TESTS_BODIES_H
#define KILN_TESTS_BODIES_H

#include <stdio.h>

#include "asset/geometry/mesh.h"

/* An OBJ file that is being written. */
struct body {
    FILE *out;
    int count; /* vertices of boxes so far */
};

/* Adds a box with its middle at (x, y, z) and edges of w, h and d. */
void add_box(struct body *body, double x, double y, double z, double w, double h, double d);

enum { RINGS = 40 };

/* Adds a ball of radius 1 about the origin, with RINGS - 1 rings of 2 * RINGS points and two poles.
 * It must come first in its file. */
void add_ball(struct body *body);

/* Opens a file to add bodies to; the caller closes its `out`. */
struct body begin(const char *path);
/* Loads the mesh of a file, which the caller destroys. */
struct kiln_mesh *body_load(const char *path);

/* Writes ball.obj with one ball, and loads it. */
struct kiln_mesh *body_load_ball(void);

/* Writes a file with one box about the origin. */
void body_write_box(const char *path, double w, double h, double d);

#endif
