/* One scene with every way to be born of another particle. */
#ifndef KILN_TESTS_FAMILY_FIXTURE_H
#define KILN_TESTS_FAMILY_FIXTURE_H

#include "support/scene_fixture.h"

enum { FAMILY_EMBER, FAMILY_GLOW, FAMILY_STAR, FAMILY_ROCKET, FAMILY_SPARK, FAMILY_RAIN };

/* Without the slots: fixture_finish gives them. */
void fixture_family(struct scene_fixture *f, enum kiln_integration integration);

#endif
