/* Makes a scene in which particles are born of other particles in every way that there is. */
#ifndef KILN_TESTS_FAMILY_FIXTURE_H
#define KILN_TESTS_FAMILY_FIXTURE_H

#include "support/scene_fixture.h"

enum { FAMILY_EMBER, FAMILY_GLOW, FAMILY_STAR, FAMILY_ROCKET, FAMILY_SPARK, FAMILY_RAIN };

/* Adds the systems to a fixture. They have no slots until fixture_finish. */
void fixture_family(struct scene_fixture *f, enum kiln_integration integration);

#endif
