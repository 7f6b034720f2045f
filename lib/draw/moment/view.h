/* This header declares the view of a frame, computed from the scene's camera. */
#ifndef KILN_DRAW_MOMENT_VIEW_H
#define KILN_DRAW_MOMENT_VIEW_H

#include "scene/instant.h"
#include "shared/draw_layout.h"

/* Returns the view of scene->camera at an instant; animated values of the camera are those of that
 * clip time. */
struct kiln_view kiln_view_compute(const struct kiln_scene *scene, struct kiln_instant instant);

/* Returns the view for a smaller picture, of which a pixel covers factor x factor pixels of the
 * given view. Where the view's size is not a multiple of the factor, the picture reaches beyond the
 * view by the same length on both sides. */
struct kiln_view kiln_view_coarse(const struct kiln_view *view, uint32_t factor);

/* Returns the view direction in world space, unit length. */
float3 kiln_view_forward(const struct kiln_view *view);

#endif
