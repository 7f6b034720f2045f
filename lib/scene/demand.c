/* How many particles a system can have at once, before a run. Rates are summed in 48.16 fixed
 * point, each step rounded up: no less than the births of a run, whose own sums round to 32 bits,
 * and too many by one slot in 65536 steps. */
#include <math.h>

#include "scene/validate.h"

enum { FRACTION_BITS = 16 };

/* Births owed to one step. */
static uint64_t owed_in_step(const struct kiln_scene *scene, const struct kiln_system *system,
                             uint32_t step)
{
    double before = (double)step - 1 - (double)scene->warmup_steps;
    double middle_s = (before + 0.5) * (double)scene->rate.den / (double)scene->rate.num;
    double rate = (double)kiln_scene_value(scene, &system->emit.rate, (float)middle_s);
    return rate > 0 ? (uint64_t)ceil(rate * (double)scene->dt_s * (1 << FRACTION_BITS)) : 0;
}

/* The step that a burst falls into; 0 when it is before the run. */
static double burst_step(const struct kiln_scene *scene, const struct kiln_burst *burst)
{
    double steps = burst->time_s * (double)scene->rate.num / (double)scene->rate.den;
    double step = floor(steps) + (double)scene->warmup_steps + 1;
    return step < 0 ? 0 : step;
}

struct kiln_demand kiln_demand(const struct kiln_scene *scene, const struct kiln_system *system)
{
    if (!system->enabled)
        return (struct kiln_demand){.slots = 1};
    const struct kiln_emitter *emit = &system->emit;
    uint32_t last = kiln_scene_frame_step(scene, scene->frames - 1);
    /* A particle born in a step has its slot until it is seen dead in a later one; two more steps
     * cover the rounding of ages and of a burst's time. */
    double life_s = (double)kiln_scene_value_max(scene, &emit->life.max);
    double window = ceil(life_s / (double)scene->dt_s) + 3;

    uint64_t owed = 0, total = 0, most = 0;
    uint32_t arriving = 0, leaving = 0; /* the next burst to enter and to leave the window */
    const uint64_t one = UINT64_C(1) << FRACTION_BITS;
    for (uint32_t step = 1; step <= last; step++) {
        uint64_t now = owed_in_step(scene, system, step);
        for (; arriving < emit->burst_count &&
               burst_step(scene, &emit->bursts[arriving]) <= (double)step;
             arriving++)
            now += emit->bursts[arriving].count * one;
        owed += now;
        total += now;
        double gone = (double)step - window;
        if (gone >= 1)
            owed -= owed_in_step(scene, system, (uint32_t)gone);
        for (; leaving < arriving && burst_step(scene, &emit->bursts[leaving]) <= gone; leaving++)
            owed -= emit->bursts[leaving].count * one;
        most = owed > most ? owed : most;
    }
    return (struct kiln_demand){.slots = (most >> FRACTION_BITS) + 1,
                                .births = (total >> FRACTION_BITS) + 1};
}
