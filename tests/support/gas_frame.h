/* Draws whole frames of a scene with a domain of gas that a test fills, by all stages. */
#ifndef KILN_TESTS_GAS_FRAME_H
#define KILN_TESTS_GAS_FRAME_H

#include "support/frame.h"

struct kiln_gas;

/* Says what gas a frame has. */
struct gas_frame {
    const char *text;         /* of the scene, without gas */
    const char *overrides[4]; /* of its keys: "KEY=VALUE" */
    size_t count;             /* number of overrides */
    uint32_t steps;           /* that particles are simulated for */
    float smoke, flame;       /* all over a box of 2 m on the middle of the floor y = 0 */
    bool domain;              /* false: the scene has no domain */
    struct kiln_techniques techniques;
};

/* Draws a frame with its layers, which the caller destroys. The gas has extinction 0.5 1/m,
 * intensity 2 and bloom 0.25, and shines by flames alone. device may be NULL. */
struct kiln_picture *gas_frame_draw(struct kiln_device *device, const struct gas_frame *frame);

#endif
