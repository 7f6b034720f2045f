/* This file counts what a job takes (pixels, bytes, triangles), measures its time and memory, and
 * compares all of them with the job's limits. An amount that is refused stays in the sum, so every
 * later amount is refused as well, until kiln_budget_reset. */
#include "base/budget.h"

#include <inttypes.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/sized.h"

enum unit { COUNT, BYTES, TIME };

static const struct {
    const char *name;
    enum unit unit;
    const char *noun;
} limit_words[] = {
#define ROW(name, unit, noun) [KILN_LIMIT_##name] = {#name, unit, noun},
    KILN_LIMITS(ROW)
#undef ROW
};

struct kiln_budget {
    struct kiln_limits limits;
    double started_s, started_cpu_s;
    uint64_t started_peak; /* system_peak at the start */
    /* Sums of the counted amounts. The entry of `memory` is the peak; those of `time` and `cpu` are
     * not used. */
    _Atomic uint64_t taken[KILN_LIMIT_COUNT];
    _Atomic int64_t running_us; /* processor time of processes that run */
};

/* Returns the most bytes of this process that were ever in memory, as the system counts them. The
 * count begins with what the process that started this one had in memory. */
static uint64_t system_peak(void)
{
    struct rusage used = {0};
    return getrusage(RUSAGE_SELF, &used) == 0 ? (uint64_t)used.ru_maxrss * 1024 : 0;
}

struct kiln_budget *kiln_budget_create(const struct kiln_limits *limits)
{
    struct kiln_budget *budget = calloc(1, sizeof *budget);
    struct kiln_error ignored = {0};
    if (budget) {
        budget->limits = kiln_limits_empty();
        if (!kiln_sized_take(&budget->limits, limits, "kiln_limits", &ignored)) {
            free(budget);
            return NULL;
        }
        budget->started_s = kiln_clock_seconds();
        budget->started_cpu_s = kiln_clock_cpu_seconds();
        budget->started_peak = system_peak();
    }
    return budget;
}

void kiln_budget_destroy(struct kiln_budget **budget)
{
    if (!budget)
        return;
    free(*budget);
    *budget = NULL;
}

/* ---- messages -------------------------------------------------------------------------------- */

const char *kiln_limit_name(enum kiln_limit limit)
{
    return limit_words[limit].name;
}

void kiln_limit_format(enum kiln_limit limit, uint64_t amount, char text[32])
{
    static const char *const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    double bytes = (double)amount;
    size_t unit = 0;
    if (limit_words[limit].unit == COUNT) {
        snprintf(text, 32, "%" PRIu64, amount);
    } else if (limit_words[limit].unit == TIME) {
        snprintf(text, 32, "%.10g s", (double)amount / 1e3);
    } else {
        for (; bytes >= 1024.0 && unit + 1 < sizeof units / sizeof *units; unit++)
            bytes /= 1024.0;
        snprintf(text, 32, "%.4g %s", bytes, units[unit]);
    }
}

bool kiln_budget_allows(const struct kiln_budget *budget, enum kiln_limit limit, uint64_t amount,
                        char text[160])
{
    const uint64_t most = budget ? budget->limits.most[limit] : 0;
    if (most == 0 || amount <= most)
        return true;
    char found[32], allowed[32];
    kiln_limit_format(limit, amount, found);
    kiln_limit_format(limit, most, allowed);
    if (strcmp(found, allowed) == 0) { /* amounts of bytes that are rounded to the same text */
        snprintf(found, sizeof found, "%" PRIu64 " bytes", amount);
        snprintf(allowed, sizeof allowed, "%" PRIu64 " bytes", most);
    }
    snprintf(text, 160, "%s %s, and the limit `%s` is %s", found, limit_words[limit].noun,
             limit_words[limit].name, allowed);
    return false;
}

/* ---- counting -------------------------------------------------------------------------------- */

bool kiln_budget_take(struct kiln_budget *budget, enum kiln_limit limit, uint64_t amount,
                      const char *what, struct kiln_error *error)
{
    char text[160];
    if (!budget)
        return true;
    const uint64_t taken = atomic_fetch_add(&budget->taken[limit], amount) + amount;
    return kiln_budget_allows(budget, limit, taken, text) ||
           kiln_error_set(error, KILN_OVER_LIMIT, "%s: %s", what, text);
}

static uint64_t taken_of(struct kiln_budget *budget, enum kiln_limit limit)
{
    return atomic_load(&budget->taken[limit]);
}

uint64_t kiln_budget_left(struct kiln_budget *budget, enum kiln_limit limit)
{
    if (!budget || budget->limits.most[limit] == 0)
        return UINT64_MAX;
    const uint64_t most = budget->limits.most[limit], taken = taken_of(budget, limit);
    return taken < most ? most - taken : 0;
}

void kiln_budget_add_running(struct kiln_budget *budget, int64_t microseconds)
{
    if (budget)
        atomic_fetch_add(&budget->running_us, microseconds);
}

void kiln_budget_reset(struct kiln_budget *budget, enum kiln_limit limit)
{
    if (budget)
        atomic_store(&budget->taken[limit], 0);
}

/* Returns the bytes of this process that are in memory. Where /proc is not mounted, or cannot be
 * read, the peak stands in for them, once it has grown since the budget began: before, it may be
 * that of another process. */
static uint64_t resident_bytes(const struct kiln_budget *budget)
{
    char text[64] = "";
    FILE *file = fopen("/proc/self/statm", "re");
    const bool found = file && fgets(text, sizeof text, file);
    if (file)
        fclose(file);
    /* The first number is the size of the process, the second is its resident part, in pages. */
    const char *second = found ? strchr(text, ' ') : NULL;
    if (second)
        return strtoull(second, NULL, 10) * (uint64_t)sysconf(_SC_PAGESIZE);
    const uint64_t peak = system_peak();
    return peak > budget->started_peak ? peak : 0;
}

static uint64_t milliseconds(double seconds)
{
    return (uint64_t)(seconds * 1e3);
}

/* Returns the most memory that any call has measured, so that once a check has failed, every later
 * check fails, too. */
static uint64_t peak_bytes(struct kiln_budget *budget)
{
    const uint64_t now = resident_bytes(budget);
    uint64_t peak = atomic_load(&budget->taken[KILN_LIMIT_memory]);
    while (now > peak &&
           !atomic_compare_exchange_weak(&budget->taken[KILN_LIMIT_memory], &peak, now))
        continue;
    return now > peak ? now : peak;
}

bool kiln_budget_is_kept(struct kiln_budget *budget, struct kiln_error *error)
{
    char text[160];
    if (!budget)
        return true;
    const uint64_t *most = budget->limits.most;
    const uint64_t time = milliseconds(kiln_clock_seconds() - budget->started_s);
    const double running_s = 1e-6 * (double)atomic_load(&budget->running_us);
    const uint64_t cpu = milliseconds(kiln_clock_cpu_seconds() + running_s - budget->started_cpu_s);
    if (kiln_budget_allows(budget, KILN_LIMIT_time, time, text) &&
        kiln_budget_allows(budget, KILN_LIMIT_cpu, cpu, text) &&
        (most[KILN_LIMIT_memory] == 0 ||
         kiln_budget_allows(budget, KILN_LIMIT_memory, peak_bytes(budget), text)))
        return true;
    return kiln_error_set(error, KILN_OVER_LIMIT, "the job has taken %s", text);
}
