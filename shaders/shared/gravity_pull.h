/* Computes how strongly a source of gravity pulls. shared/interact_gravity.h includes this file for
 * single numbers, lib/sim/crowd/gravity_simd.c for vectors of them, so it has no guard. Before it,
 * each of them defines:
 *   PULL, PULL_FN              the type of a number, and what stands before functions
 *   PULL_BITS, PULL_OF_BITS    the bits of a number as an unsigned integer, and back
 *   PULL_RSQRT, PULL_A_METRE   the names of the functions here */

/* Returns 1 / sqrt(x) with a relative error of 8e-7 for 2^-30 <= x <= 2^60. It has one step less
 * than exact_rsqrt, from a better guess, since gravity spends most of its time here (constants: J.
 * Kadlec 2010). */
PULL_FN PULL PULL_RSQRT(PULL x)
{
    EXACT PULL guess = PULL_OF_BITS(0x5f1ffff9u - (PULL_BITS(x) >> 1u));
    EXACT PULL square = (x * guess) * guess;
    EXACT PULL better = guess * (0.703952253f * (2.38924456f - square));
    EXACT PULL halved = 0.5f * x;
    EXACT PULL rest = 1.5f - (halved * better) * better;
    EXACT PULL y = better * rest;
    return y;
}

/* Returns the acceleration by a source that is (x, y, z) away, m, for each metre of that way.
 * strength: acceleration at 1 m, in m/s^2; softening_square: m^2. */
PULL_FN PULL PULL_A_METRE(PULL x, PULL y, PULL z, float strength, float softening_square)
{
    EXACT PULL square = ((x * x + y * y) + z * z) + softening_square;
    EXACT PULL inverse = PULL_RSQRT(square);
    EXACT PULL pull = ((inverse * inverse) * inverse) * strength;
    return pull;
}
