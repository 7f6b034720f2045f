/* Draws domains of gas by the stage of gas alone, for tests of its pixels. The camera looks along
 * -z at the middle of domains of 2 m that stand on the floor, 10 m away. */
#ifndef KILN_TESTS_GAS_VIEW_H
#define KILN_TESTS_GAS_VIEW_H

#include "draw/volume/volume.h"

enum {
    GAS_VIEW_SIZE = 65, /* pixels of the picture's edges */
    GAS_VIEW_FLOATS = GAS_VIEW_SIZE * GAS_VIEW_SIZE * 4,
    /* the first float of the pixel in the middle */
    GAS_VIEW_MIDDLE = (GAS_VIEW_SIZE * (GAS_VIEW_SIZE / 2) + GAS_VIEW_SIZE / 2) * 4,
};

struct gas_view {
    struct kiln_device *device; /* marches through the gas; NULL: the host does */
    struct kiln_scene *scene;
    struct kiln_moment moment;
    struct kiln_pool pool;
    struct kiln_image depth, picture;
    bool layers; /* gas_view_draw also draws these: the depth of half opacity, and the gas alone */
    struct kiln_image halfway, layer;
    struct kiln_draw_backdrop light;
    const struct kiln_lighting *lighting; /* what is in the way of lamps; NULL: nothing */
    uint32_t threads;
};

/* Opens a scene without domains, in darkness, with nothing behind it. Its node `cart` is at (3, -2,
 * 1), turned by 90 degrees about y, and scales by 2. */
void gas_view_open(struct gas_view *f);

/* Does what gas_view_open does, for the technique march=gl of a device. */
void gas_view_open_on(struct gas_view *f, struct kiln_device *device);

/* Closes the scene, and frees the gas of its domains. */
void gas_view_close(struct gas_view *f);

/* Adds a domain, whose gas the caller makes. Temperatures 0 and 1 are 900 and 2250 K. */
struct kiln_gas *gas_view_add(struct gas_view *f, struct kiln_gas_look look);

/* Draws the picture anew, by the width of vectors and the threads that `f` has. */
const float *gas_view_draw(struct gas_view *f);

/* Fails the test if the picture depends on the level of vectors, or on threads. */
void gas_view_assert_bits(struct gas_view *f);

/* Return values that do not change. */
struct kiln_value gas_view_value(float x);
struct kiln_value3 gas_view_value3(float x, float y, float z);

#endif
