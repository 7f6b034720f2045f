/* Implements frames that a program keeps. Such a frame shares its picture with the output, which
 * may still be encoding it. Therefore no pixel is copied, and the pixels must not be written to. */
#include "job/frame.h"

#include <stdlib.h>

#include "base/error.h"
#include "base/sized.h"
#include "job/views.h"

struct kiln_frame {
    struct kiln_picture *picture;
};

struct kiln_frame *kiln_frame_create(struct kiln_picture *picture, struct kiln_error *error)
{
    struct kiln_frame *frame = malloc(sizeof *frame);
    if (frame) {
        frame->picture = picture;
        return frame;
    }
    kiln_picture_destroy(&picture);
    kiln_error_no_memory(error, "a frame");
    return NULL;
}

void kiln_frame_destroy(struct kiln_frame **frame)
{
    if (!frame || !*frame)
        return;
    kiln_picture_destroy(&(*frame)->picture);
    free(*frame);
    *frame = NULL;
}

bool kiln_frame_get_layer(const struct kiln_frame *frame, const char *name,
                          struct kiln_frame_layer *layer, struct kiln_error *error)
{
    struct kiln_frame_layer found;
    if (!kiln_sized_check(layer, "kiln_frame_layer", error))
        return false;
    if (!kiln_views_find(frame->picture, name, &found))
        return kiln_error_set(error, KILN_USAGE, "frame %u has no layer '%s'",
                              frame->picture->frame, name);
    kiln_sized_give(layer, &found);
    return true;
}
