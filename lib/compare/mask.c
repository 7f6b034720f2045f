/* Makes masks from rectangles and pictures, and applies them to pairs of pictures. Masked pixels
 * are made equal before anything is measured. So no metric needs to know of masks, and a filter
 * that reaches over a mask's edge finds no step there. */
#include "compare/mask.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"

static void add_rectangle(struct kiln_mask *mask, const struct kiln_compare_mask *rectangle)
{
    uint64_t right = (uint64_t)rectangle->x + rectangle->width;
    uint64_t bottom = (uint64_t)rectangle->y + rectangle->height;
    if (rectangle->x >= mask->width)
        return;
    size_t width = (size_t)(right < mask->width ? right : mask->width) - rectangle->x;
    for (size_t y = rectangle->y; y < bottom && y < mask->height; y++)
        memset(mask->masked + y * mask->width + rectangle->x, 1, width);
}

static bool is_black(const struct kiln_asset_image *image, size_t pixel)
{
    for (size_t i = 4 * pixel; i < 4 * pixel + 3; i++) {
        switch (image->type) {
        case KILN_IMAGE_U8:
            if (((const uint8_t *)image->pixels)[i] != 0)
                return false;
            break;
        case KILN_IMAGE_U16:
            if (((const uint16_t *)image->pixels)[i] != 0)
                return false;
            break;
        case KILN_IMAGE_U32:
            if (((const uint32_t *)image->pixels)[i] != 0)
                return false;
            break;
        case KILN_IMAGE_F32: /* NaN is not black, so it is judged */
            if (!(((const float *)image->pixels)[i] <= 0.0f))
                return false;
            break;
        }
    }
    return true;
}

static bool add_picture(struct kiln_mask *mask, const char *path, struct kiln_error *error)
{
    struct kiln_asset_image *image = kiln_asset_image_load_data(NULL, path, error);
    if (!image) {
        if (error->code == KILN_IO)
            error->code = KILN_INVALID_INPUT;
        return false;
    }
    bool fits = image->width == mask->width && image->height == mask->height;
    for (size_t i = 0; fits && i < (size_t)mask->width * mask->height; i++)
        mask->masked[i] |= is_black(image, i);
    if (!fits)
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the mask has %u x %u pixels, the pictures %u x %u", path, image->width,
                       image->height, mask->width, mask->height);
    kiln_asset_image_destroy(&image);
    return fits;
}

bool kiln_mask_make(struct kiln_mask *mask, const struct kiln_compare_mask *masks, size_t count,
                    uint32_t width, uint32_t height, struct kiln_error *error)
{
    size_t pixels = (size_t)width * height;
    struct kiln_mask made = {.width = width, .height = height, .masked = calloc(pixels, 1)};
    bool ok = true;
    kiln_mask_finish(mask);
    if (!made.masked) {
        kiln_error_no_memory(error, "a mask of %zu pixels", pixels);
        return false;
    }
    for (size_t i = 0; ok && i < count; i++) {
        if (masks[i].picture)
            ok = add_picture(&made, masks[i].picture, error);
        else
            add_rectangle(&made, &masks[i]);
    }
    if (ok && !memchr(made.masked, 0, pixels))
        ok = kiln_error_set(error, KILN_USAGE,
                            "the masks cover all %u x %u pixels: nothing is left to judge", width,
                            height);
    if (ok)
        *mask = made;
    else
        kiln_mask_finish(&made);
    return ok;
}

void kiln_mask_finish(struct kiln_mask *mask)
{
    free(mask->masked);
    *mask = (struct kiln_mask){0};
}

void kiln_mask_apply(const struct kiln_mask *mask, const struct kiln_compare_picture *reference,
                     struct kiln_compare_picture *test)
{
    for (size_t i = 0; i < (size_t)mask->width * mask->height; i++) {
        if (!mask->masked[i])
            continue;
        for (size_t c = 3 * i; c < 3 * i + 3; c++) {
            test->linear[c] = reference->linear[c];
            test->levels[c] = reference->levels[c];
        }
        if (test->alpha && reference->alpha)
            test->alpha[i] = reference->alpha[i];
    }
}
