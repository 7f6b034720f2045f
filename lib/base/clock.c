/* Reads the clocks of the system. */
#include "base/clock.h"

#include <sys/resource.h>
#include <time.h>

double kiln_clock_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double kiln_clock_thread_seconds(void)
{
    struct timespec worked = {0};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &worked);
    return (double)worked.tv_sec + 1e-9 * (double)worked.tv_nsec;
}

double kiln_clock_cpu_seconds(void)
{
    struct timespec worked = {0};
    struct rusage ended = {0};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &worked);
    getrusage(RUSAGE_CHILDREN, &ended);
    return (double)worked.tv_sec + 1e-9 * (double)worked.tv_nsec +
           (double)(ended.ru_utime.tv_sec + ended.ru_stime.tv_sec) +
           1e-6 * (double)(ended.ru_utime.tv_usec + ended.ru_stime.tv_usec);
}
