/* A kiln_gas_before keeps the profiles of gas in GL (draw/volume/volume_profile.h), where shaders
 * blend particles with it (shaders/draw/sprites/gas_before.glsl). */
#ifndef KILN_DRAW_SPRITES_GAS_BEFORE_H
#define KILN_DRAW_SPRITES_GAS_BEFORE_H

#include "draw/sprites/tile.h"
#include "gpu/buffer.h"

struct kiln_gas_before;

/* Returns the definitions of shaders that blend particles of a scene with its gas: none without
 * gas. */
const char *kiln_gas_before_defines(const struct kiln_scene *scene);

/* Returns NULL with an error. device must outlive the result. */
struct kiln_gas_before *kiln_gas_before_create(struct kiln_device *device,
                                               struct kiln_error *error);
void kiln_gas_before_destroy(struct kiln_gas_before **gas);

/* Sends the gas of a pass, NULL if there is none, and binds it to KILN_BIND_GAS and
 * KILN_UNIT_PROFILES. Passes of a moment share what was sent. Fails with KILN_DEVICE_FAILED, and
 * advice in the message, where the profiles are too large for a buffer texture of the device. */
bool kiln_gas_before_bind(struct kiln_gas_before *gas, const struct kiln_tile_gas *of,
                          struct kiln_error *error);

#endif
