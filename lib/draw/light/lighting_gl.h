/* A kiln_lighting_gl holds the light of a frame as textures for programs in GL. The textures are
 * updated when a stage binds them. */
#ifndef KILN_DRAW_LIGHT_LIGHTING_GL_H
#define KILN_DRAW_LIGHT_LIGHTING_GL_H

#include "draw/light/lighting.h"
#include "gpu/device.h"

/* Names what frames of a scene may have: smoke that dims lights, a sun, lamps or light of fire,
 * opaque particles, those among them that are meshes with silhouettes, shadows of meshes and of
 * opaque particles from lamps. */
struct kiln_lighting_textures {
    bool smoke, sun, lamps, solids, instances, lamp_maps, lamp_solids;
};

/* Returns NULL when memory is short. */
struct kiln_lighting_gl *kiln_lighting_gl_create(struct kiln_device *device,
                                                 const struct kiln_lighting_textures *needed);
void kiln_lighting_gl_destroy(struct kiln_lighting_gl **gl);

/* Binds the grids of smoke (draw/light/smoke_shadow.glsl), the lists of solids
 * (draw/light/solid_shadow.glsl) and the part of the sun that each particle sees
 * (KILN_UNIT_SUN_SHADE), where the frame has them. */
bool kiln_lighting_bind(const struct kiln_lighting *lighting, struct kiln_error *error);

#endif
