/* Measures time for reports. Nothing that reaches a picture may depend on it. */
#ifndef KILN_BASE_CLOCK_H
#define KILN_BASE_CLOCK_H

/* Seconds of a clock that never jumps, from an arbitrary start. */
double kiln_clock_seconds(void);

/* Seconds that processors have worked for this process, all of its threads together, and for
 * processes that it started, once they have ended. */
double kiln_clock_cpu_seconds(void);

/* Seconds that a processor has worked for the calling thread. */
double kiln_clock_thread_seconds(void);

#endif
