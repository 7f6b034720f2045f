/* Simulates a list scheduler, whose only state is the time at which each worker becomes free. */
#include "bench/schedule.h"

double kiln_schedule_s(const double *tasks_s, size_t count, uint32_t workers)
{
    double free_s[KILN_MAX_WORKERS] = {0}, last_s = 0.0;
    for (size_t i = 0; i < count; i++) {
        uint32_t next = 0;
        for (uint32_t k = 1; k < workers; k++) {
            if (free_s[k] < free_s[next])
                next = k;
        }
        free_s[next] += tasks_s[i];
        if (free_s[next] > last_s)
            last_s = free_s[next];
    }
    return last_s;
}
