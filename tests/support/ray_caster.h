/* Compares the backdrop of small scenes with a simple ray caster in double precision. */
#ifndef KILN_TESTS_RAY_CASTER_H
#define KILN_TESTS_RAY_CASTER_H

#include <math.h>

#include "draw/backdrop/backdrop.h"

enum { WIDTH = 128, HEIGHT = 72 };

/* The beginning of the scenes. The sky is black, so all light is the sun's. The exposure is so low
 * that a pixel at an edge is the mean of its samples (shared/edge_mean.h). */
#define HEAD                                                                                       \
    "kiln: 1\n"                                                                                    \
    "output: {size: [128, 72], frames: 1}\n"                                                       \
    "post: {exposure: -16}\n"                                                                      \
    "camera: {position: [0, 2.5, 5], target: [0, 0.5, 0], fov: 40 deg}\n"                          \
    "backdrop:\n"                                                                                  \
    "  haze: 0\n"                                                                                  \
    "  sky: {top: 0, horizon: 0}\n"                                                                \
    "  floor: {color: [0.6, 0.5, 0.4]}\n"

/* ---- the reference --------------------------------------------------------------------------- */

struct vec {
    double v[3];
};

static inline struct vec along(struct vec o, struct vec d, double t)
{
    return (struct vec){{o.v[0] + t * d.v[0], o.v[1] + t * d.v[1], o.v[2] + t * d.v[2]}};
}

static inline double dot(struct vec a, struct vec b)
{
    return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

static inline struct vec unit(struct vec a)
{
    double length = sqrt(dot(a, a));
    return (struct vec){{a.v[0] / length, a.v[1] / length, a.v[2] / length}};
}

enum kind { FLOOR, BOX, SPHERE, CYLINDER, MESH, CAPSULE, PLANE };

struct shape {
    enum kind kind;
    struct vec center, half_size, axis, albedo;
    double radius, half_height;
    struct vec angles;            /* rotation of a box about x, then y, then z, rad */
    const struct kiln_mesh *mesh; /* scaled by `scale` and rotated about y by `angle`, rad */
    double angle, scale;
};

/* The place of the camera of HEAD, and its ray through a place of the picture, px. */
extern const struct vec eye;
struct vec pixel_ray(double px, double py);

/* ---- pictures -------------------------------------------------------------------------------- */

struct picture {
    struct kiln_scene *scene;
    struct kiln_image color, depth;
    struct kiln_moment *moment;
    struct kiln_threads *threads;
    struct kiln_lighting_stage *lights;
    struct kiln_backdrop_stage *stage;
    const float *colors, *depths;
};

/* Draw the backdrop of a scene. Assets lie below asset_root; `draw` takes those of scenes/. */
struct picture draw_below(void *device, const char *text, const char *asset_root);
struct picture draw(void *device, const char *text);
void finish(struct picture *p);

struct expected {
    const struct shape *shapes;
    int count;
    struct vec sun;    /* unit, towards the sun */
    double sun_radius; /* rad */
    double tolerance;  /* of the colour, in parts of full sun */
    /* A lamp in place of the sun: where it is, m; its radius, m; its colour, 0: none. */
    struct vec lamp;
    double lamp_radius, lamp_color;
    struct vec lamp_facing;         /* unit, where a spot or a rectangle shines */
    double lamp_inner, lamp_outer;  /* angles of a spot's cones, rad; outer 0: no spot */
    struct vec lamp_right, lamp_up; /* from a rectangle's centre to its edges, m; 0: no rectangle */
};

/* Returns the red light along the ray of a pixel, by the lamp or for an irradiance of pi by the
 * sun, and sets *depth to the distance t along the ray, or 1e9 for the sky. */
double light(const struct expected *e, double px, double py, double *depth);

/* Compares every step-th pixel with the ray caster. Pixels over which the expected light or depth
 * changes much are left out; at least three quarters must be compared. */
void compare(const struct picture *p, const struct expected *e, int step);

/* Draws a scene and returns the sum of the picture's red light. */
double sum_of_red(void *device, const char *text);

#endif
