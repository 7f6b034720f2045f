/* Compares layers of pictures that hold no light, such as depths, normals and names of objects, by
 * their numbers. */
#ifndef KILN_COMPARE_VALUES_H
#define KILN_COMPARE_VALUES_H

#include "compare/picture.h"

struct kiln_value_difference {
    double largest;     /* infinite where one number is not finite and the other is another one */
    uint64_t differing; /* numbers */
    uint32_t x, y;      /* the first pixel of the largest difference */
};

/* Compares the numbers of two layers of one size, which have any types. Infinite numbers of one
 * sign are equal, and so are those that are none (NaN). masked, a byte a pixel or NULL, is 1 where
 * numbers are not compared. Of layers with different numbers of channels, the common ones count. */
void kiln_values_compare(const struct kiln_asset_image *reference,
                         const struct kiln_asset_image *test, const uint8_t *masked,
                         struct kiln_value_difference *difference);

/* Makes pictures of two layers of one size, in levels alone: the least finite number of both is
 * black, the largest is white. *errors, which the caller frees, gets a number of 0 to 1 a pixel:
 * its difference, as a part of `largest`, which kiln_values_compare has found. False with
 * KILN_DEVICE_FAILED when memory is short. */
bool kiln_values_show(const struct kiln_asset_image *const images[2], const uint8_t *masked,
                      double largest, struct kiln_compare_picture *pictures[2], float **errors,
                      struct kiln_error *error);

#endif
