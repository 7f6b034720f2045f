/* Meshes for tests, as OBJ files in the folder at hand. */
#ifndef KILN_TESTS_BODIES_H
#define KILN_TESTS_BODIES_H

#include <stdio.h>

#include "asset/geometry/mesh.h"

struct body {
    FILE *out;
    int count; /* of vertices so far */
};

void add_box(struct body *body, double x, double y, double z, double w, double h, double d);

enum { RINGS = 40 };

/* A ball of radius 1 out of RINGS rings of twice as many points. */
void add_ball(struct body *body);

struct body begin(const char *path);
struct kiln_mesh *body_load(const char *path);

/* The mesh of one ball, and its file ball.obj. */
struct kiln_mesh *body_load_ball(void);

/* A file of one box around the origin. */
void body_write_box(const char *path, double w, double h, double d);

#endif
