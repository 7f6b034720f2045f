/* Hands the layers of a frame to a caller (kiln_render_params.picture), whether or not they also go
 * into a file. */
#ifndef KILN_JOB_VIEWS_H
#define KILN_JOB_VIEWS_H

#include "output/output.h"

/* Adds to what is needed of a frame what the caller wants of it. KILN_USAGE for a layer that there
 * is not, with the nearest name. */
bool kiln_views_need(const struct kiln_render_params *params, struct kiln_output_needs *needs,
                     struct kiln_error *error);

/* Tells the caller of each layer that he wants, in his order. */
void kiln_views_show(const struct kiln_render_params *params, const struct kiln_picture *picture);

/* A layer of a picture; false: it does not have it. */
bool kiln_views_find(const struct kiln_picture *picture, const char *name,
                     struct kiln_frame_layer *view);

#endif
