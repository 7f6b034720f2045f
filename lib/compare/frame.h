/* Compares one frame of two sides: the layers of both, one pair at a time. */
#ifndef KILN_COMPARE_FRAME_H
#define KILN_COMPARE_FRAME_H

#include "base/arena.h"
#include "compare/difference.h"
#include "compare/footage.h"
#include "compare/mask.h"
#include "compare/metric.h"

/* What all frames of a comparison have in common. */
struct kiln_frame_comparer {
    const struct kiln_compare_params *params;
    struct kiln_footage *footage[2]; /* reference, test */
    struct kiln_metric_set set;
    struct kiln_difference_plan diff, error_map; /* if the params have them */
    struct kiln_mask mask;                       /* made for the previous picture's size */
    struct kiln_threads *threads;
    bool hdr; /* result: FLIP judged the last colours by several exposures */
};

/* Compares the frame that both sides have next, and goes on to the one after it on both, also when
 * it fails. frame: has its name and size; everything else is filled. Its texts and layers lie in
 * the arena. number: for the pictures of the difference, which are written. A frame that cannot be
 * read is no failure, but has the verdict; *fault gets its error. Fails with KILN_IO if a picture
 * cannot be written, with KILN_USAGE for masks that leave nothing, or when memory is short. */
bool kiln_frame_compare(struct kiln_frame_comparer *comparer, struct kiln_compare_frame *frame,
                        uint32_t number, struct kiln_arena *arena, struct kiln_error *fault,
                        struct kiln_error *error);

void kiln_frame_comparer_finish(struct kiln_frame_comparer *comparer);

#endif
