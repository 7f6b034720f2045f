/* Computes sine and cosine in double, with the same bits on every machine, for arithmetic in files.
 * The C library's functions differ between systems in their last bit. */
#ifndef KILN_OPTION_SINE_H
#define KILN_OPTION_SINE_H

/* The largest angle, in radians. */
#define KILN_SINE_MOST 1e6

/* Return the sine and the cosine of an angle from -KILN_SINE_MOST to KILN_SINE_MOST, within 2^-50
 * of them. */
double kiln_sine(double angle);
double kiln_cosine(double angle);

#endif
