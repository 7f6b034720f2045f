/* Names the parts of a step that a scene may lack. A kernel of GLSL gets masks of the parts that
 * its systems use (lib/sim/step/uses.c) as constants, and compilers leave out the rest: a value
 * that has keys costs a search of the key table wherever it is evaluated, which is most of what a
 * kernel would otherwise have to compile. A kernel without masks, and C, have all parts. */
#ifndef KILN_SHARED_USES_H
#define KILN_SHARED_USES_H

#include "shared/layout.h"

/* VALUE_OF, VALUE3_OF and VALUE_RATE_OF do value_at, value3_at and value_rate_at for one of the
 * values below. The word SIM_KEYS or VALUE_KEYS stands before the value, as for the functions. */

/* Values that may have keys, by which USES_KEYS counts them. */
#define KEYED_LIFE            0u
#define KEYED_SPEED           1u
#define KEYED_ORIGIN          2u
#define KEYED_DIRECTION       3u
#define KEYED_SIZE            4u
#define KEYED_ANGLE           5u
#define KEYED_RADIUS          6u
#define KEYED_INHERIT         7u
#define KEYED_TURN            8u
#define KEYED_RANDOMNESS      9u
#define KEYED_SLOWDOWN        10u
#define KEYED_RESTITUTION     11u
#define KEYED_FRICTION        12u
#define KEYED_FORCE_VECTOR    13u
#define KEYED_FORCE_SECOND    14u
#define KEYED_FORCE_STRENGTH  15u
#define KEYED_FORCE_PULL      16u
#define KEYED_FORCE_QUADRATIC 17u
#define KEYED_FORCE_SCALE     18u
#define KEYED_CHANCE          19u

/* The bits of USES_FORCES that say whether any force acts in a region alone, and whether any force
 * or region lies in a node. */
#define FORCE_IN_REGION 31u
#define FORCE_IN_NODE   30u

/* The bit of USES_DEMITTERS for demitters that lie in nodes. */
#define DEMITTER_IN_NODE 0u

#ifdef GL_core_profile

#ifndef USES_KEYS /* of KEYED_* */
#define USES_KEYS 0xffffffffu
#endif
#ifndef USES_FORCES /* of FORCE_* */
#define USES_FORCES 0xffffffffu
#endif
#ifndef USES_DEMITTERS /* of DEMITTER_IN_NODE */
#define USES_DEMITTERS 0xffffffffu
#endif
#ifndef USES_EMITTERS /* of EMIT_* */
#define USES_EMITTERS 0xffffffffu
#endif
#ifndef USES_COLLIDERS /* of COLLIDER_* */
#define USES_COLLIDERS 0xffffffffu
#endif
#ifndef USES_COLLIDE /* of COLLIDE_* */
#define USES_COLLIDE 0xffffffffu
#endif
#ifndef USES_BIRTHS /* of BORN_OF_* */
#define USES_BIRTHS 0xffffffffu
#endif

#ifndef USES_THEN /* of THEN_* */
#define USES_THEN 0xffffffffu
#endif

#ifdef USES_INTEGRATION /* the scene's INTEGRATE_* */
#define STEP_INTEGRATION USES_INTEGRATION
#else
#define STEP_INTEGRATION STEP(integration)
#endif

#define USES(mask, part)      ((((mask) >> (part)) & 1u) != 0u)
#define USES_ANY(mask, parts) (((mask) & (parts)) != 0u)

#define VALUE_OF(keyed, value, clocks)                                                             \
    (USES(USES_KEYS, keyed) ? value_at(value, clocks) : (value).constant)
#define VALUE3_OF(keyed, value, clocks)                                                            \
    (USES(USES_KEYS, keyed) ? value3_at(value, clocks)                                             \
                            : FLOAT3((value).x.constant, (value).y.constant, (value).z.constant))
#define VALUE_RATE_OF(keyed, value, clocks)                                                        \
    (USES(USES_KEYS, keyed) ? value_rate_at(value, clocks) : 0.0f)

#else

#define STEP_INTEGRATION      STEP(integration)
#define USES(mask, part)      true
#define USES_ANY(mask, parts) true

#define VALUE_OF(keyed, value, clocks)      value_at(value, clocks)
#define VALUE3_OF(keyed, value, clocks)     value3_at(value, clocks)
#define VALUE_RATE_OF(keyed, value, clocks) value_rate_at(value, clocks)

#endif
#endif
