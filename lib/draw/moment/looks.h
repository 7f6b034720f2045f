/* The looks of all systems, ready to be read while drawing (shared/look_layout.h). */
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

/* Whether the table depends on the time at all. */
bool kiln_looks_vary(const struct kiln_scene *scene);

/* The rest of the looks, with the cells that the atlas gave them; of systems beyond the scene's,
 * zeros. */
void kiln_looks_fill(const struct kiln_scene *scene, const struct kiln_atlas *atlas,
                     struct kiln_draw_look looks[KILN_MAX_SYSTEMS]);

/* The pattern of the spheres, LOOK_*. */
uint32_t kiln_look_pattern(const struct kiln_look *look);

/* Whether any system's spheres have one. */
bool kiln_looks_patterned(const struct kiln_scene *scene);

#endif
