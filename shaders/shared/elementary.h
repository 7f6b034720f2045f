/* Computes reciprocals, roots, exponentials, logarithms, sines and cosines from + - * and bits, so
 * that they are the same on every device (docs/determinism.md, 1). Each takes arguments within the
 * range where its polynomial serves; callers see to the others.
 *
 * shared/exact.h includes this file for single numbers, base/lane_math.h for vectors, so it
 * has no guard. Before that, each of them defines:
 *   ELEMENT, ELEMENT_INT                the type of a number, and of its bits as a signed integer
 *   ELEMENT_FN                          what stands before functions
 *   ELEMENT_BITS, ELEMENT_OF_BITS, ELEMENT_TRUNCATE, ELEMENT_WHOLE    conversions
 *   ELEMENT_FLOOR                       rounding down
 *   ELEMENT_RCP and so on               the names of the functions here */

/* Returns 1 / a within 1.5 ulp for 2^-100 <= a <= 2^100: a first guess from the exponent (off by at
 * most 5.1 %) and three Newton steps. */
ELEMENT_FN ELEMENT ELEMENT_RCP(ELEMENT a)
{
    EXACT ELEMENT y = ELEMENT_OF_BITS(0x7ef311c7 - ELEMENT_BITS(a));
    EXACT ELEMENT e = 2.0f - a * y;
    y = y * e;
    e = 2.0f - a * y;
    y = y * e;
    e = 1.0f - a * y;
    y = y + y * e;
    return y;
}

/* Returns 1 / sqrt(x) within 1.5 ulp for 2^-100 <= x <= 2^100. */
ELEMENT_FN ELEMENT ELEMENT_RSQRT(ELEMENT x)
{
    EXACT ELEMENT y = ELEMENT_OF_BITS(0x5f375a86 - (ELEMENT_BITS(x) >> 1));
    EXACT ELEMENT h = 0.5f * x;
    EXACT ELEMENT e = 1.5f - (h * y) * y;
    y = y * e;
    e = 1.5f - (h * y) * y;
    y = y * e;
    e = 0.5f - (h * y) * y;
    y = y + y * e;
    return y;
}

/* Returns e^x within 1e-7 of its size for |x| <= 69. */
ELEMENT_FN ELEMENT ELEMENT_EXP(ELEMENT x)
{
    EXACT ELEMENT halves = x * 1.44269504f + 0.5f;
    EXACT ELEMENT n = ELEMENT_FLOOR(halves);
    EXACT ELEMENT r = x - n * 0.693115234375f;
    r = r - n * 3.19461833e-5f;
    EXACT ELEMENT high = 0.0416665501f + r * (0.00836377387f + r * 0.00139269266f);
    EXACT ELEMENT p = 0.5f + r * (0.166665734f + r * high);
    EXACT ELEMENT y = 1.0f + (r + (r * r) * p);
    EXACT ELEMENT power = ELEMENT_OF_BITS((ELEMENT_TRUNCATE(n) + 127) * 8388608);
    EXACT ELEMENT scaled = y * power;
    return scaled;
}

/* Returns log2(x) within 2e-7 of the greater of 1 and its size for 2^-100 <= x <= 2^100. */
ELEMENT_FN ELEMENT ELEMENT_LOG2(ELEMENT x)
{
    ELEMENT_INT bits = ELEMENT_BITS(x);
    ELEMENT_INT exponent = (bits - 0x3f3504f3) >> 23; /* so that the rest is 0.707 to 1.414 */
    EXACT ELEMENT f = ELEMENT_OF_BITS(bits - exponent * 8388608) - 1.0f;
    EXACT ELEMENT high =
        -0.239169881f + f * (0.216078226f + f * (-0.205861881f + f * 0.123109685f));
    EXACT ELEMENT middle = 0.480910753f + f * (-0.360693268f + f * (0.287903261f + f * high));
    EXACT ELEMENT p = f * (1.44269502f + f * (-0.721347468f + f * middle));
    EXACT ELEMENT y = ELEMENT_WHOLE(exponent) + p;
    return y;
}

/* Returns x less `quarter` quarter turns, for |x| <= 8192 and the nearest whole number of them:
 * they are subtracted in three parts, so short that the first two products are exact. */
ELEMENT_FN ELEMENT ELEMENT_REST(ELEMENT x, ELEMENT quarter)
{
    EXACT ELEMENT r = x - quarter * 1.5703125f;
    r = r - quarter * 0.000483751297f;
    r = r - quarter * 7.54978995e-8f;
    return r;
}

/* ELEMENT_SINE and ELEMENT_COSINE return sine and cosine within 1e-7 for |r| <= pi / 4; z: the
 * square of r. */
ELEMENT_FN ELEMENT ELEMENT_SINE(ELEMENT r, ELEMENT z)
{
    EXACT ELEMENT p = -0.166666646f + z * (0.00833273656f + z * -0.000195853732f);
    EXACT ELEMENT s = r + r * (z * p);
    return s;
}

ELEMENT_FN ELEMENT ELEMENT_COSINE(ELEMENT z)
{
    EXACT ELEMENT p = 0.0416666646f + z * (-0.00138882913f + z * 2.45454191e-5f);
    EXACT ELEMENT c = (1.0f - 0.5f * z) + (z * z) * p;
    return c;
}
