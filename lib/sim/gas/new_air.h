/* Sets the velocity of air that a window reaches when it is moved. */
#ifndef KILN_SIM_GAS_NEW_AIR_H
#define KILN_SIM_GAS_NEW_AIR_H

#include "sim/gas/pass.h"

/* Says how air that is at rest in the world moves in a domain: its velocity at the origin of the
 * domain's frame, m/s, and how it turns about it, rad/s. */
struct gas_rest {
    float velocity[3], spin[3];
};

/* Lets the air be at rest in the world that the window did not have when it was `old_cells` at
 * `old_at`. Its arrays have zeros there. */
void gas_new_air_rest(struct kiln_gas *gas, struct kiln_gas_place old_at,
                      struct kiln_gas_place old_cells, const struct gas_rest *rest);

/* Lets forces have moved this air, too, which is at rest so far. It goes on as the nearest air of
 * the old window does where the same forces act on both. Where there was no window, it has come to
 * the velocity that winds give to air at rest in blown_s seconds, at the drag of the domain, 1/s.
 */
void gas_new_air_blown(struct kiln_gas *gas, struct kiln_gas_place old_at,
                       struct kiln_gas_place old_cells, const struct gas_rest *rest,
                       const struct gas_lattice *forces, float blown_s, float drag);

/* Finds between what velocities the air beyond open sides of the window is, into forces->least and
 * most: that of air at rest, and that which winds on the window's borders would give it in the end.
 *
 * Air that flows in from there is like the air at the border only within these. Without a limit it
 * would bring as much momentum as the air at the border has, and nothing but pressure would ever
 * slow it: the wind that a fire draws would grow until it blows the fire out (Braack et al.,
 * "Directional Do-Nothing Condition for the Navier-Stokes Equations", 2014). */
void gas_new_air_bounds(struct gas_lattice *forces, const struct kiln_gas *gas,
                        const struct gas_rest *rest, float drag);

#endif
