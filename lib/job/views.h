/* Hands the layers of a frame to a caller (kiln_render_params.picture), whether or not they also go
 * into a file. */
#ifndef KILN_JOB_VIEWS_H
#define KILN_JOB_VIEWS_H

#include "output/output.h"

/* Adds the layers that the caller wants to the needs of a frame. KILN_USAGE for an unknown layer,
 * with the nearest name, and for one of gas in a scene without gas. */
bool kiln_views_need(const struct kiln_scene *scene, const struct kiln_render_params *params,
                     struct kiln_output_needs *needs, struct kiln_error *error);

/* Calls the caller's callback with each wanted layer, in the caller's order. */
void kiln_views_show(const struct kiln_render_params *params, const struct kiln_picture *picture);

/* Finds a layer of a picture; false: the picture does not have it. */
bool kiln_views_find(const struct kiln_picture *picture, const char *name,
                     struct kiln_frame_layer *view);

#endif
