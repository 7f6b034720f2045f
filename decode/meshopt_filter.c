/* This file undoes the filters of the glTF extension KHR_meshopt_compression, which store unit
 * vectors, quaternions, floats and colours in fewer bits. All sums are in double, and numbers are
 * rounded to the nearest, halves away from 0, so that every processor gets the same. */
#include <math.h>
#include <string.h>

#include "meshopt.h"

static int read_signed(const unsigned char *at, uint32_t bytes)
{
    return bytes == 1 ? (int)(int8_t)at[0] : (int)(int16_t)(uint16_t)(at[0] | at[1] << 8);
}

static void write_rounded(unsigned char *at, uint32_t bytes, double value)
{
    const int rounded = (int)(value + (value < 0.0 ? -0.5 : 0.5));
    at[0] = (unsigned char)(rounded & 255);
    if (bytes == 2)
        at[1] = (unsigned char)(rounded >> 8 & 255);
}

/* Unit vectors by their place on an octahedron. The third number is the largest that there is. */
static void undo_octahedral(unsigned char *at, uint32_t bytes)
{
    const double most = bytes == 1 ? 127.0 : 32767.0;
    const int one = read_signed(at + 2 * (size_t)bytes, bytes);
    double v[3];
    v[0] = one != 0 ? read_signed(at, bytes) / (double)one : 0.0;
    v[1] = one != 0 ? read_signed(at + bytes, bytes) / (double)one : 0.0;
    v[2] = 1.0 - fabs(v[0]) - fabs(v[1]);
    const double fold = v[2] < 0.0 ? -v[2] : 0.0;
    v[0] -= v[0] >= 0.0 ? fold : -fold;
    v[1] -= v[1] >= 0.0 ? fold : -fold;
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (size_t c = 0; c < 3; c++)
        write_rounded(at + c * bytes, bytes, v[c] / length * most);
}

/* Quaternions by their three smaller components. The fourth number has the scale, and in its two
 * lowest bits which component is the largest. */
static void undo_quaternion(unsigned char *at)
{
    const double half_root = 0.70710678118654752440;
    const int code = read_signed(at + 6, 2);
    const double scale = half_root / (code | 3);
    double v[3], rest = 1.0;
    for (size_t c = 0; c < 3; c++) {
        v[c] = read_signed(at + 2 * c, 2) * scale;
        v[c] = fabs(v[c]) <= 1.0 ? v[c] : 0.0;
        rest -= v[c] * v[c];
    }
    const size_t largest = (size_t)(code & 3);
    for (size_t c = 0; c < 3; c++)
        write_rounded(at + (largest + 1 + c) % 4 * 2, 2, v[c] * 32767.0);
    write_rounded(at + largest * 2, 2, sqrt(rest > 0.0 ? rest : 0.0) * 32767.0);
}

/* Floats as 24 bits of a number and 8 of an exponent of two. */
static void undo_exponential(unsigned char *at)
{
    const uint32_t word =
        at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
    const int exponent = (int)(int8_t)(word >> 24);
    const int32_t low = (int32_t)(word & 0xffffff), mantissa = low - (low >> 23 << 24);
    const float value = (float)ldexp((double)mantissa, exponent);
    memcpy(at, &value,
           sizeof value); /* the floats of a buffer are little-endian, as this machine */
}

/* The filter of colours is not undone, since kiln uses no colours of a mesh. */
bool meshopt_unfilter(const struct meshopt_stream *stream, unsigned char *elements)
{
    const uint32_t stride = stream->stride;
    const bool fits = stream->filter == MESHOPT_QUATERNION    ? stride == 8
                      : stream->filter == MESHOPT_EXPONENTIAL ? stride % 4 == 0
                      : stream->filter == MESHOPT_NONE        ? true
                                                              : stride == 4 || stride == 8;
    if (!fits)
        return false;
    for (uint32_t i = 0; i < stream->count; i++) {
        unsigned char *at = elements + (size_t)i * stride;
        if (stream->filter == MESHOPT_OCTAHEDRAL)
            undo_octahedral(at, stride / 4);
        else if (stream->filter == MESHOPT_QUATERNION)
            undo_quaternion(at);
        for (uint32_t k = 0; stream->filter == MESHOPT_EXPONENTIAL && k < stride; k += 4)
            undo_exponential(at + k);
    }
    return true;
}
