/* Runs kiln as a process, and measures the CPU time that the process has used at certain points. */
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
    /* set by the caller */
    const char
        *program; /* a path, or a name that is looked for in PATH; NULL: the running program */
    bool reports_events; /* events report all points; else only the end is measured */
    double timeout_s;    /* a process that takes longer is killed, which is an error; 0: no limit */
    /* set by kiln_process_run */
    double cpu_s[KILN_PROCESS_POINTS];   /* CPU time of all threads since the start */
    double clock_s[KILN_PROCESS_POINTS]; /* time by the clock since the start */
    double elapsed_s;                    /* from the start to the end */
    char last_line[KILN_MESSAGE_SIZE];   /* of what it printed, without the newline */
};

/* Starts a program of kiln with these arguments, and waits for it. The first argument is the
 * command, and NULL ends the list. Of what the process prints, the last line is kept. A process
 * that fails is an error with its exit code and its last line. When the caller asks to stop, the
 * process is ended first, and then the function fails with KILN_INTERRUPTED. */
bool kiln_process_run(const struct kiln_bench_run *run, const char **arguments,
                      struct kiln_process *process, struct kiln_error *error);

/* Removes a folder with all that is in it, which processes wrote. What cannot be removed stays. */
void kiln_process_remove_folder(const char *path);

#endif
