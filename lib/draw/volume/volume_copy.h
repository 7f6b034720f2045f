/* Copies the gas of a domain to the blocks that are drawn. */
#ifndef KILN_DRAW_VOLUME_VOLUME_COPY_H
#define KILN_DRAW_VOLUME_VOLUME_COPY_H

#include "draw/volume/volume_field.h"

/* Fills all blocks of a field, whose bricks are known, with gas without light. */
void kiln_volume_copy(const struct kiln_volume_field *field, const struct kiln_volume_seen *seen,
                      struct kiln_threads *threads);

#endif
