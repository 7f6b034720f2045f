/* Declares how a file says what its numbers mean as colours, and the conversion of pixels to
 * sRGB. All arithmetic is the same on every processor. */
#ifndef KILN_ASSET_IMAGE_COLOR_H
#define KILN_ASSET_IMAGE_COLOR_H

#include "asset/image/image.h"

/* Gives the light of a number of the file; both are 0 to 1. Without a table it is
 * (a x + b)^gamma + e for x >= d, and c x + f below (ICC.1:2022, 10.18). */
struct kiln_curve {
    float gamma, a, b, c, d, e, f;
    const uint8_t *table; /* numbers of 16 bits, the high byte first; it outlives the curve */
    uint32_t count;       /* of the table, at least 2 */
};

struct kiln_color {
    struct kiln_curve curves[3];
    double to_srgb[3][3]; /* turns light of the file's primaries into light of sRGB's */
};

/* Places of the primaries and of white in the chromaticity diagram of CIE 1931. */
struct kiln_primaries {
    double red[2], green[2], blue[2], white[2];
};

extern const struct kiln_primaries kiln_rec709;

struct kiln_curve kiln_power_curve(float gamma);
struct kiln_curve kiln_srgb_curve(void);

/* Returns the light of a number, 0 to 1. */
float kiln_curve_at(const struct kiln_curve *curve, float x);

/* Finds the light of sRGB's primaries by that of others, adapting white by Bradford's matrix.
 * False: the primaries are no triangle around white. */
bool kiln_primaries_to_srgb(const struct kiln_primaries *primaries, double to_srgb[3][3]);

/* Finds how much each primary adds to the luminance of a colour. False: as above. */
bool kiln_primaries_luminance(const struct kiln_primaries *primaries, double weights[3]);

/* Returns whether primaries are those of Rec. 709 up to the rounding of writers. */
bool kiln_primaries_are_rec709(const struct kiln_primaries *primaries);

/* Finds the light of sRGB's primaries by XYZ whose white is that of sRGB, with Y 1. */
bool kiln_xyz_to_srgb(double to_srgb[3][3]);

/* Computes the matrix of kiln_primaries_to_srgb from the columns of a profile: XYZ of red, green
 * and blue for the white D50. */
bool kiln_columns_to_srgb(const double xyz[3][3], double to_srgb[3][3]);

/* Converts linear light of RGBA pixels to sRGB's primaries. Light outside of sRGB becomes negative.
 * Alpha is not changed. */
void kiln_light_convert(const double to_srgb[3][3], float *pixels, size_t count);

/* Returns whether a colour converts no number of 8 bits by more than one level: then the file
 * means sRGB. */
bool kiln_color_is_srgb(const struct kiln_color *color);

/* Converts pixels of integers to sRGB of the same depth. Light outside of sRGB is clipped. Grey
 * stays grey: only the first curve counts. Alpha is not changed. */
bool kiln_color_convert(const struct kiln_color *color, struct kiln_asset_image *image);

/* Says what the numbers of a CIELAB picture are. L* is 0 to 100 for 0 to `brightest`; a* and b* are
 * the numbers less 128, or less 128 * 256 and divided by 256. */
struct kiln_lab {
    double white[2]; /* its place in the chromaticity diagram */
    double brightest;
};

/* Places white of the connection space of ICC profiles in the chromaticity diagram. */
#define KILN_WHITE_D50                                                                             \
    {                                                                                              \
        0.9642 / (0.9642 + 1.0 + 0.8249), 1.0 / (0.9642 + 1.0 + 0.8249)                            \
    }

/* Converts pixels of CIELAB, integers, to sRGB of the same depth. Light outside of sRGB is clipped.
 * Alpha is not changed. False: white is none. */
bool kiln_lab_convert(const struct kiln_lab *lab, struct kiln_asset_image *image);

#endif
