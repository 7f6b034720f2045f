/* This header declares the view of a frame, computed from the scene's camera. */
#ifndef KILN_DRAW_MOMENT_VIEW_H
#define KILN_DRAW_MOMENT_VIEW_H

#include "scene/scene.h"
#include "shared/draw_layout.h"

/* Returns the view of scene->camera after `step` steps. Camera values are read at that clip
 * time. */
struct kiln_view kiln_view_compute(const struct kiln_scene *scene, uint32_t step);

/* Returns the same view for a picture whose pixels are as large as factor x factor of the view's.
 * Where the view's size is no multiple of the factor, the picture reaches beyond it by the same on
 * both sides. */
struct kiln_view kiln_view_coarse(const struct kiln_view *view, uint32_t factor);

/* Returns the view direction in world space, unit length. */
float3 kiln_view_forward(const struct kiln_view *view);

#endif
