/* Runs kiln as a process, and measures the processor time that it has used when it comes to certain
 * points. */
#ifndef KILN_BENCH_PROCESS_H
#define KILN_BENCH_PROCESS_H

#include "bench/contest.h"

/* The points of a process that renders: a device was opened, the first frame was drawn, the last
 * frame was drawn, the process has ended. */
enum kiln_process_point {
    KILN_PROCESS_DEVICE,
    KILN_PROCESS_FIRST,
    KILN_PROCESS_LAST,
    KILN_PROCESS_END,
    KILN_PROCESS_POINTS
};

struct kiln_process {
    bool told; /* set by the caller: events report all points; else only the end is known */
    double cpu_s[KILN_PROCESS_POINTS]; /* of all its threads since it was started */
    double elapsed_s;                  /* until its end */
};

/* Starts the running program anew with `words` as its arguments, and waits for it. The first word
 * is the command, and NULL ends the words. What the process prints is dropped. A process that fails
 * is an error with its exit code and its last line. A stop is the error KILN_INTERRUPTED, which
 * comes when the process has ended. */
bool kiln_process_run(const struct kiln_bench_run *run, const char **words,
                      struct kiln_process *process, struct kiln_error *error);

#endif
