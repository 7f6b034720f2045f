/* Wall-clock time for reports; nothing that reaches a picture may depend on it. */
#ifndef KILN_BASE_CLOCK_H
#define KILN_BASE_CLOCK_H

/* Seconds of a clock that never jumps, from an arbitrary start. */
double kiln_clock_seconds(void);

#endif
