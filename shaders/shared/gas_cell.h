/* Computes what happens in one cell of gas in a step. It uses + - *, comparisons and bits, so that
 * it gives the same bits on every device (shared/exact.h). A file that includes this one defines
 * before:
 *   REAL, REAL_FN, TRUTH         the type of a number (or of a vector of numbers), what stands
 * before functions, and the type of a comparison REAL_ALL(x)                  a float that all
 * cells share as a REAL REAL_SELECT(holds, yes, no)  a choice REAL_MIN, REAL_MAX           the
 * second operand where both are equal REAL_RCP(x)                  1 / x for x from 2^-100 to 2^100
 * (shared/elementary.h) */
#ifndef KILN_SHARED_GAS_CELL_H
#define KILN_SHARED_GAS_CELL_H

#include "shared/gas_layout.h"

/* Values below this count as none. So what fades ends, and no denormal is stored. */
#define GAS_NONE 1e-6f

struct gas_carried {
    REAL smoke, temperature, fuel, flame;
    REAL burnt; /* fuel that burns in the step */
};

REAL_FN REAL gas_snapped(REAL x)
{
    EXACT REAL none = REAL_ALL(0.0f);
    EXACT REAL y = REAL_SELECT(x > GAS_NONE, x, none);
    return y;
}

/* Burns fuel that is hot enough, and lets flames, smoke and heat fade. What burns expands: the gas
 * in the cell is thinned by as much as its volume grows, or else the expansion would multiply the
 * fuel. */
REAL_FN S(gas_carried) gas_burn(S(gas_carried) now, S(kiln_gas_step) step)
{
    EXACT REAL none = REAL_ALL(0.0f);
    EXACT REAL one = REAL_ALL(1.0f);
    EXACT REAL most = REAL_ALL(0.9f);
    EXACT REAL hottest = REAL_ALL(step.hottest);
    EXACT REAL fuel = REAL_MAX(now.fuel, none);
    EXACT REAL warm = REAL_MAX(now.temperature, none);
    EXACT REAL temperature = REAL_MIN(warm, hottest);
    EXACT REAL flame = REAL_MAX(now.flame, none);
    EXACT REAL could = fuel * step.burnt;
    EXACT REAL burnt = REAL_SELECT(temperature > step.ignition, could, none);
    EXACT REAL larger = 1.0f + burnt * step.expand;
    EXACT REAL thin = REAL_RCP(larger);
    fuel = (fuel - burnt) * thin;
    temperature = temperature + burnt * step.heat;
    flame = REAL_MAX(flame - step.flame_fade, burnt * step.flame_gain);
    flame = REAL_MIN(flame, one);
    EXACT REAL smoke = (now.smoke * thin) * step.smoke_left + burnt * step.soot;
    EXACT REAL eaten = REAL_MIN(flame * step.smoke_burnt, most);
    smoke = smoke * (1.0f - eaten);
    EXACT REAL cube = (temperature * temperature) * temperature;
    EXACT REAL slower = 1.0f + step.cool * cube;
    EXACT REAL cooled = REAL_RCP(slower);
    temperature = temperature * cooled - step.cool_even;
    S(gas_carried) after;
    after.smoke = gas_snapped(smoke);
    after.temperature = gas_snapped(temperature);
    after.fuel = gas_snapped(fuel);
    after.flame = gas_snapped(flame);
    after.burnt = burnt;
    return after;
}

#endif
