/* This header declares the looks of all systems in the form that drawing reads
 * (shared/look_layout.h). */
#ifndef KILN_DRAW_MOMENT_LOOKS_H
#define KILN_DRAW_MOMENT_LOOKS_H

#include "asset/atlas/atlas.h"
#include "draw/moment/look_values.h"
#include "scene/scene.h"
#include "shared/look_layout.h"

/* The temperature of a cell's cool parts divided by the temperature of its hot parts. */
#define KILN_LOOK_COOL_SHARE 0.72f

/* The table's number of texels without values over other clocks: a system has KILN_LOOK_ROWS rows
 * of KILN_LOOK_SAMPLES texels. */
#define KILN_LOOK_TEXELS (KILN_MAX_SYSTEMS * KILN_LOOK_ROWS * KILN_LOOK_SAMPLES)

/* Fills table with the looks of the scene at a clip time; row r of system s starts at (s *
 * KILN_LOOK_ROWS + r) * KILN_LOOK_SAMPLES. Values over other clocks than the time and a particle's
 * life are 1 (look_values.h). */
void kiln_looks_sample(const struct kiln_scene *scene, float time_s, float4 *table);

/* Returns whether the table depends on the clip time, so that it must be sampled for each frame. */
bool kiln_looks_vary(const struct kiln_scene *scene);

/* Fills in the uniform block of the looks, with the cells that the systems have in the atlas.
 * Elements beyond the scene's number of systems become 0. */
void kiln_looks_fill(const struct kiln_scene *scene, const struct kiln_atlas *atlas,
                     const struct kiln_look_program programs[KILN_MAX_SYSTEMS],
                     struct kiln_draw_look looks[KILN_MAX_SYSTEMS]);

/* Returns the pattern of the look's spheres, LOOK_*. */
uint32_t kiln_look_pattern(const struct kiln_look *look);

/* Returns whether the spheres of any enabled system have a pattern. */
bool kiln_looks_patterned(const struct kiln_scene *scene);

#endif
