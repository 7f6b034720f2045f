/* This file counts the particles that are born in each step, in integers. It sums the rate in units
 * of 2^-32 particle a second times steps_den. One birth is steps_num * 2^32 units, a
 * whole number, so rounding does not accumulate over a run. Only the products need 128 bits. */
#include "particles/births.h"

#include <math.h>

#include "shared/random.h"

__extension__ typedef unsigned __int128 wide;

static uint64_t rate_fixed(float rate)
{
    const float max_rate = 2147483648.0f;
    if (!(rate > 0.0f))
        return 0;
    return (uint64_t)((double)(rate < max_rate ? rate : max_rate) * 4294967296.0);
}

static void add_group(struct kiln_births *births, struct kiln_birth_group group)
{
    if (group.count > UINT32_MAX - births->count)
        group.count = UINT32_MAX - births->count;
    if (group.count == 0 || births->group_count == KILN_MAX_BIRTH_GROUPS)
        return;
    births->groups[births->group_count++] = group;
    births->count += group.count;
}

static void add_rate(const struct kiln_births_source *source, uint32_t step, uint64_t *wait,
                     struct kiln_births *births)
{
    double steps = (double)step - 0.5 - (double)source->warmup_steps;
    float middle_s = (float)(steps * source->steps_den / source->steps_num);
    wide units_per_birth = (wide)source->steps_num << 32;
    wide rate_units = (wide)rate_fixed(source->rate(source->context, middle_s)) * source->steps_den;
    if (*wait >= rate_units) {
        *wait -= (uint64_t)rate_units;
        return;
    }
    wide count = (rate_units - *wait + units_per_birth - 1) / units_per_birth;
    if (count > UINT32_MAX)
        count = UINT32_MAX;
    wide first = ((wide)*wait << 32) / rate_units;
    wide spacing = count > 1 ? (units_per_birth << 32) / rate_units : 0;
    add_group(births, (struct kiln_birth_group){.count = (uint32_t)count,
                                                .first = (uint32_t)first,
                                                .spacing = (uint32_t)spacing});
    *wait = (uint64_t)((*wait + count * units_per_birth - rate_units) % units_per_birth);
}

/* Adds births by the way. The n-th one happens when the way is that of n births. */
static void add_way(const struct kiln_births_source *source, uint32_t step,
                    struct kiln_births *births)
{
    if (!source->by_way || step >= source->way_count)
        return;
    const uint64_t from = source->by_way[step - 1], to = source->by_way[step];
    const uint64_t count = (to >> 32) - (from >> 32);
    if (count == 0 || count > UINT32_MAX)
        return;
    const wide way = to - from;
    const uint64_t until_first = (((from >> 32) + 1) << 32) - from;
    const wide spacing = count > 1 ? ((wide)1 << 64) / way : 0;
    wide first = ((wide)until_first << 32) / way;
    if (first + (count - 1) * spacing > UINT32_MAX) /* the last one is at the very end */
        first--;
    add_group(births, (struct kiln_birth_group){.count = (uint32_t)count,
                                                .first = (uint32_t)first,
                                                .spacing = (uint32_t)spacing,
                                                .kind = BIRTHS_BY_WAY});
}

/* Returns the number of particles of a repetition. purpose: its first random number. */
static uint32_t count_of(const struct kiln_burst *burst, uint32_t stream, uint32_t purpose)
{
    const uint64_t choices = (uint64_t)burst->count[1] - burst->count[0] + 1;
    return burst->count[0] + (uint32_t)(random_bits(stream, purpose) * choices >> 32);
}

/* Adds repetition k of burst number i, if it happens in the step. */
static void add_burst(const struct kiln_births_source *source, uint32_t i, uint32_t k,
                      uint32_t step, struct kiln_births *births)
{
    const struct kiln_burst *burst = &source->bursts[i];
    const uint32_t stream = random_stream(source->random_key, i);
    const uint32_t purpose = RANDOM_BURST + 2 * k;
    double time_s = burst->time_s + k * burst->every_s;
    time_s += burst->jitter_s * (double)random_unit(stream, purpose + 1);
    double steps = time_s * source->steps_num / source->steps_den + (double)source->warmup_steps;
    double parts = floor(steps * 64.0 + 0.5);
    double start = ((double)step - 1.0) * 64.0;
    if (!(parts >= start && parts < start + 64.0))
        return;
    const uint32_t count = count_of(burst, stream, purpose);
    if (births->group_count - births->steady_groups == KILN_MAX_BURSTS)
        births->left_out |= count > 0;
    else
        add_group(births, (struct kiln_birth_group){.count = count,
                                                    .first = (uint32_t)(parts - start) << 26,
                                                    .kind = BIRTHS_BURST});
}

/* Adds the repetitions of burst number i that happen in the step. Looks at all that may: a little
 * more than those whose times without delay lie between the step and the longest delay before
 * it. */
static void add_repetitions(const struct kiln_births_source *source, uint32_t i, uint32_t step,
                            struct kiln_births *births)
{
    const struct kiln_burst *burst = &source->bursts[i];
    const double step_s = (double)source->steps_den / source->steps_num;
    const double start_s = ((double)step - 1.0 - (double)source->warmup_steps) * step_s;
    const double margin_s = step_s / 64.0;
    const double first = (start_s - margin_s - burst->jitter_s - burst->time_s) / burst->every_s;
    const double last = (start_s + step_s + margin_s - burst->time_s) / burst->every_s;
    const double from = fmax(ceil(first) - 1.0, 0.0);
    const double to = fmin(floor(last) + 1.0, (double)burst->most - 1.0);
    if (!(from <= to))
        return;
    for (uint32_t k = (uint32_t)from; k <= (uint32_t)to; k++)
        add_burst(source, i, k, step, births);
}

static void add_bursts(const struct kiln_births_source *source, uint32_t step,
                       struct kiln_births *births)
{
    for (uint32_t i = 0; i < source->burst_count; i++) {
        if (source->bursts[i].every_s > 0.0)
            add_repetitions(source, i, step, births);
        else
            add_burst(source, i, 0, step, births);
    }
}

void kiln_births_step(const struct kiln_births_source *source, uint32_t step, uint64_t *wait,
                      struct kiln_births *births)
{
    births->count = 0;
    births->left_out = false;
    births->group_count = 0;
    add_rate(source, step, wait, births);
    add_way(source, step, births);
    births->steady = births->count;
    births->steady_groups = births->group_count;
    add_bursts(source, step, births);
}

/* Returns the number of steps in the longest life; compares floats as the simulation does. */
uint32_t kiln_births_lifespan(float longest_life_s, float dt_s, uint32_t steps)
{
    double guess = floor((double)longest_life_s / (double)dt_s);
    if (!(guess < (double)steps))
        return steps;
    uint32_t whole = guess > 2.0 ? (uint32_t)guess - 2 : 0;
    while (whole < steps && (float)whole * dt_s < longest_life_s)
        whole++;
    return whole;
}

struct kiln_births_bound kiln_births_bound(const struct kiln_births_source *source, uint32_t steps,
                                           uint32_t lifespan)
{
    uint64_t window = (uint64_t)lifespan + 1;
    struct kiln_births_bound bound = {.capacity = 0};
    uint64_t inside = 0, lead_wait = 0, trail_wait = 0;
    struct kiln_births births;
    for (uint32_t step = 1; step <= steps; step++) {
        kiln_births_step(source, step, &lead_wait, &births);
        bound.total += births.count;
        inside += births.count;
        if (births.left_out && bound.crowded == 0)
            bound.crowded = step;
        if (step > window) {
            kiln_births_step(source, (uint32_t)(step - window), &trail_wait, &births);
            inside -= births.count;
        }
        if (inside > bound.capacity)
            bound.capacity = inside;
    }
    return bound;
}
