/* Casts rays at the simple shapes of small scenes in double precision (`light`), and compares the
 * backdrop that kiln draws with the result (`compare`). The ray caster is simple enough to be the
 * reference for all techniques that draw backdrops. */
#ifndef KILN_TESTS_RAY_CASTER_H
#define KILN_TESTS_RAY_CASTER_H

#include <math.h>

#include "draw/backdrop/backdrop.h"

enum { WIDTH = 128, HEIGHT = 72 };

/* The beginning of each scene's text: a picture of WIDTH x HEIGHT pixels, the camera and the floor.
 * The sky is black, so that only the sun and lamps give light. The exposure is so low that the
 * samples of a pixel at an edge weigh nearly the same, so that the pixel is their mean
 * (shared/edge_mean.h). */
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

/* A vector x, y, z of the world. */
struct vec {
    double v[3];
};

/* Returns o + t * d. */
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

/* Kinds of shapes. A FLOOR is the plane y = 0. */
enum kind { FLOOR, BOX, SPHERE, CYLINDER, MESH, CAPSULE, PLANE };

struct shape {
    enum kind kind;
    struct vec center, half_size, axis, albedo; /* axis: unit; centre, half size: m */
    double radius, half_height;                 /* m; half_height of a capsule is without caps */
    struct vec angles;            /* of a box: rotations about x, then y, then z, rad */
    const struct kiln_mesh *mesh; /* scaled by `scale`, then rotated about y by `angle`, rad */
    double angle, scale;
};

/* The position of the camera of HEAD, m, and the direction of its ray through a point of the
 * picture, in px from the top left. The point eye + t * direction has view depth t. */
extern const struct vec eye;
struct vec pixel_ray(double px, double py);

/* ---- pictures -------------------------------------------------------------------------------- */

/* Holds a drawn backdrop, and all that was made to draw it. `finish` frees it. */
struct picture {
    struct kiln_scene *scene;
    struct kiln_image color, depth;
    struct kiln_moment *moment;
    struct kiln_threads *threads;
    struct kiln_lighting_stage *lights;
    struct kiln_backdrop_stage *stage;
    const float *colors, *depths; /* RGBA; view depth, m */
};

/* Draw the backdrop of a scene's text with the technique backdrop_technique (backdrops.h). The
 * caller frees the result by `finish`. draw_below finds assets below the folder asset_root, and
 * `draw` below scenes/. */
struct picture draw_below(void *device, const char *text, const char *asset_root);
struct picture draw(void *device, const char *text);
void finish(struct picture *p);

/* Describes what the ray caster draws: shapes in the light of the sun or of one lamp. */
struct expected {
    const struct shape *shapes;
    int count;
    struct vec sun;    /* unit direction towards the sun */
    double sun_radius; /* angular radius of its disc, rad */
    double tolerance;  /* largest absolute difference of red light; white in full sun has 1 */
    /* A lamp instead of the sun: its centre, m; its radius, m; its red light, or 0 for no lamp. */
    struct vec lamp;
    double lamp_radius, lamp_color;
    struct vec lamp_facing;         /* unit direction in which a spot or a rectangle shines */
    double lamp_inner, lamp_outer;  /* half angles of a spot's cones, rad; outer 0: no spot */
    struct vec lamp_right, lamp_up; /* from a rectangle's centre to its edges, m; 0: no rectangle */
};

/* Returns the red light that the surface at a point of the picture, px from the top left, sends to
 * the eye. The lamp lights it or, if there is no lamp, a sun of irradiance pi. Sets *depth to the
 * view depth, m, or to 1e9 for the sky. */
double light(const struct expected *e, double px, double py, double *depth);

/* Compares every step-th pixel of every step-th row with the ray caster. Leaves out pixels within
 * which the expected light or depth changes much, such as edges, where the picture is a mean of
 * samples. Fails if a pixel differs, or if a quarter of the pixels or more are left out. */
void compare(const struct picture *p, const struct expected *e, int step);

/* Draws a scene and returns the sum of the picture's red light. */
double sum_of_red(void *device, const char *text);

#endif
