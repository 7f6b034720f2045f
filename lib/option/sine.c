/* Computes sine and cosine by IEEE sums and products alone. An angle is reduced to a quarter of
 * pi by three parts of pi / 2, each of 33 bits, so that their products with the number of quarters
 * are exact (Cody and Waite 1980). The polynomials are those of Taylor up to x^17: from -pi/4 to
 * pi/4, the first term that is left out is below 2^-56. */
#include "option/sine.h"

#include <math.h>

/* The parts of pi / 2; what they leave out is below 2^-100. */
static const double HALF_PI[3] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};

/* Returns the angle less a whole number of quarters of a turn, and that number modulo 4. */
static double reduce(double angle, unsigned *quarter)
{
    const double count = floor(angle * 0.63661977236758134308 + 0.5);
    *quarter = (unsigned)((long)count & 3);
    return ((angle - count * HALF_PI[0]) - count * HALF_PI[1]) - count * HALF_PI[2];
}

static double sine_near_0(double x)
{
    const double z = x * x;
    double sum = 1.0 / 355687428096000.0;
    sum = sum * z - 1.0 / 1307674368000.0;
    sum = sum * z + 1.0 / 6227020800.0;
    sum = sum * z - 1.0 / 39916800.0;
    sum = sum * z + 1.0 / 362880.0;
    sum = sum * z - 1.0 / 5040.0;
    sum = sum * z + 1.0 / 120.0;
    sum = sum * z - 1.0 / 6.0;
    return x + x * (z * sum);
}

static double cosine_near_0(double x)
{
    const double z = x * x;
    double sum = 1.0 / 20922789888000.0;
    sum = sum * z - 1.0 / 87178291200.0;
    sum = sum * z + 1.0 / 479001600.0;
    sum = sum * z - 1.0 / 3628800.0;
    sum = sum * z + 1.0 / 40320.0;
    sum = sum * z - 1.0 / 720.0;
    sum = sum * z + 1.0 / 24.0;
    return 1.0 - (0.5 * z - z * z * sum);
}

/* Returns the sine of x after a number of quarters of a turn. */
static double turned(double x, unsigned quarter)
{
    const double value = quarter & 1 ? cosine_near_0(x) : sine_near_0(x);
    return quarter & 2 ? -value : value;
}

double kiln_sine(double angle)
{
    unsigned quarter;
    const double rest = reduce(angle, &quarter);
    return turned(rest, quarter);
}

double kiln_cosine(double angle)
{
    unsigned quarter;
    const double rest = reduce(angle, &quarter);
    return turned(rest, quarter + 1);
}
