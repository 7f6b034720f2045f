/* This header declares the looks of all systems in the form that drawing reads
 * (shared/look_layout.h). */
#ifndef KILN_DRAW_MOMENT_LOOKS_H
#define KILN_DRAW_MOMENT_LOOKS_H

#include "asset/atlas/atlas.h"
#include "scene/scene.h"
#include "shared/look_layout.h"

/* Texels of the table: KILN_LOOK_ROWS rows a system, each of KILN_LOOK_SAMPLES. */
#define KILN_LOOK_TEXELS (KILN_MAX_SYSTEMS * KILN_LOOK_ROWS * KILN_LOOK_SAMPLES)

/* Fills table (KILN_LOOK_TEXELS) with the looks of the scene at a clip time; row r of system s
 * starts at (s * KILN_LOOK_ROWS + r) * KILN_LOOK_SAMPLES. */
void kiln_looks_sample(const struct kiln_scene *scene, float time_s, float4 *table);

/* Returns whether the table depends on the time. */
bool kiln_looks_vary(const struct kiln_scene *scene);

/* Fills in the uniform block of the looks, with the cells that the atlas gave them; systems beyond
 * the scene's get zeros. */
void kiln_looks_fill(const struct kiln_scene *scene, const struct kiln_atlas *atlas,
                     struct kiln_draw_look looks[KILN_MAX_SYSTEMS]);

/* Returns the pattern of the look's spheres, LOOK_*. */
uint32_t kiln_look_pattern(const struct kiln_look *look);

/* Returns whether any system's spheres have a pattern. */
bool kiln_looks_patterned(const struct kiln_scene *scene);

#endif
