/* Makes domains of gas whose contents are known, for tests of what reads them. */
#ifndef KILN_TESTS_GAS_FIXTURE_H
#define KILN_TESTS_GAS_FIXTURE_H

#include "particles/gas.h"

/* Makes a domain of n^3 cells of a size, which stands on the middle of the floor y = 0, with a ball
 * in its middle of `radius` in parts of the domain's edge. Within the ball smoke is `smoke`, which
 * falls to 0 over two cells at its border; temperature and flame are `heat` in its upper half. Air
 * moves upwards at 1 m/s. The caller finishes it. */
void gas_fixture_ball(struct kiln_gas *gas, int32_t n, float cell, float radius, float smoke,
                      float heat);

/* Makes a domain of 2 m and cells^3 cells in the same place, with a ball of smoke, in the upper
 * half of which flames are a thin shell. The smoke is of lumps, so that its density changes from
 * cell to cell. The caller finishes it. */
void gas_fixture_lumps(struct kiln_gas *gas, int32_t cells);

/* Makes a domain of n^3 cells in the same place that is filled evenly. The caller finishes it. */
void gas_fixture_full(struct kiln_gas *gas, int32_t n, float cell, float smoke, float temperature,
                      float flame);

#endif
