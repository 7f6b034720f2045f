/* kiln as a process, and what processors worked for it until it came to certain points. */
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
    bool told; /* to be set: the process tells of all points, by events; else the end is known */
    double cpu_s[KILN_PROCESS_POINTS]; /* of all its threads since it was started */
    double elapsed_s;                  /* until its end */
};

/* Runs the program that is running, with these words behind its name, of which the first is the
 * command and NULL ends them, and waits for it. What it prints is dropped. A process that fails is
 * an error with its exit code and its last line; KILN_INTERRUPTED comes after a stop, when the
 * process has ended. */
bool kiln_process_run(const struct kiln_bench_run *run, const char **words,
                      struct kiln_process *process, struct kiln_error *error);

#endif
