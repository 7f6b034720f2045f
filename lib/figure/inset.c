/* Converts insets, which a request gives in pixels or in parts of a picture's size, to pixels, and
 * checks that they lie in the picture. */
#include "figure/inset.h"

#include "base/error.h"

struct kiln_rect kiln_inset_rect(const struct kiln_figure_inset *inset, uint32_t width,
                                 uint32_t height)
{
    double sx = inset->parts ? width : 1, sy = inset->parts ? height : 1;
    return (struct kiln_rect){(uint32_t)(inset->x * sx + 0.5), (uint32_t)(inset->y * sy + 0.5),
                              (uint32_t)(inset->width * sx + 0.5),
                              (uint32_t)(inset->height * sy + 0.5)};
}

/* Returns whether an inset's numbers are in a range that converts to pixels without overflow; false
 * also for NaN. */
static bool is_in_range(const struct kiln_figure_inset *inset)
{
    double most = inset->parts ? 1 : 65535;
    return inset->x >= 0 && inset->y >= 0 && inset->x <= most && inset->y <= most &&
           inset->width > 0 && inset->height > 0 && inset->width <= most && inset->height <= most;
}

bool kiln_insets_check(const struct kiln_figure_params *params, uint32_t width, uint32_t height,
                       struct kiln_error *error)
{
    if (params->inset_count > KILN_MAX_INSETS)
        return kiln_error_set(error, KILN_USAGE, "found %zu insets; up to %d fit below a panel",
                              params->inset_count, (int)KILN_MAX_INSETS);
    for (size_t i = 0; i < params->inset_count; i++) {
        const struct kiln_figure_inset *inset = &params->insets[i];
        struct kiln_rect rect = {0};
        if (is_in_range(inset))
            rect = kiln_inset_rect(inset, width, height);
        if (rect.width == 0 || rect.height == 0 || rect.x + rect.width > width ||
            rect.y + rect.height > height)
            return kiln_error_set(
                error, KILN_USAGE,
                "--inset %g,%g,%gx%g: found a part that is not in a picture of %u x %u", inset->x,
                inset->y, inset->width, inset->height, width, height);
    }
    return true;
}
