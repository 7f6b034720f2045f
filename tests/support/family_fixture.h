/* Makes a scene with families: systems whose particles are born of other systems' particles, by
 * each event that can give birth (death, bounce and trail). */
#ifndef KILN_TESTS_FAMILY_FIXTURE_H
#define KILN_TESTS_FAMILY_FIXTURE_H

#include "support/scene_fixture.h"

/* Indices of the scene's first systems. */
enum { FAMILY_EMBER, FAMILY_GLOW, FAMILY_STAR, FAMILY_ROCKET, FAMILY_SPARK, FAMILY_RAIN };

/* Makes the scene in *f, with the colliders of fixture_zoo_backdrop. The caller then calls
 * fixture_finish, which gives the systems their slots. */
void fixture_family(struct scene_fixture *f, enum kiln_integration integration);

#endif
