/* Stage 4a: what lies behind the particles, and its depth (Heinz 2019, 3.2.1: render scene). */
#ifndef KILN_DRAW_BACKDROP_H
#define KILN_DRAW_BACKDROP_H

#include "draw/lighting.h"
#include "draw/view.h"
#include "gpu/image.h"

struct kiln_backdrop_stage;

/* Targets of scene size: color (RGBA) and depth (R32F, view-space metres, 1e9 for sky). The images
 * are the caller's and must outlive the stage. */
struct kiln_backdrop_stage *kiln_backdrop_create(struct kiln_device *device,
                                                 const struct kiln_scene *scene,
                                                 struct kiln_image *color, struct kiln_image *depth,
                                                 struct kiln_error *error);
void kiln_backdrop_destroy(struct kiln_backdrop_stage **stage);

/* The scene's meshes in its order; they live as long as the stage. */
struct kiln_mesh *const *kiln_backdrop_meshes(const struct kiln_backdrop_stage *stage);

/* Draws it, unless the picture of the last call still holds. Also uploads the uniform block that
 * lights the particles (KILN_BIND_BACKDROP), and leaves bound what shaders need besides that light
 * surfaces like it does (shaders/draw/surface.glsl); what kiln_lighting_run binds must be bound. */
bool kiln_backdrop_draw(struct kiln_backdrop_stage *stage, const struct kiln_view *view,
                        const struct kiln_lighting *lighting, struct kiln_error *error);

/* What lights the particles, as of the last kiln_backdrop_draw. */
const struct kiln_draw_backdrop *kiln_backdrop_block(const struct kiln_backdrop_stage *stage);

#endif
