/* This file takes a picture out of a helper's answer. A malicious file may have taken over the
 * helper that decoded it, so sizes are held to the limits before they are multiplied, and floats
 * must be finite. */
#include "asset/image/received.h"

#include <math.h>
#include <stdlib.h>

#include "base/budget.h"
#include "base/error.h"

uint64_t kiln_received_most_pixels(const struct kiln_loader *loader)
{
    const uint64_t left = kiln_budget_left(kiln_loader_budget(loader), KILN_LIMIT_asset_pixels);
    return left < KILN_MAX_IMAGE_PIXELS ? left : KILN_MAX_IMAGE_PIXELS;
}

static bool is_sound(const struct kiln_decode_answer *answer)
{
    return answer->width >= 1 && answer->height >= 1 && answer->width <= KILN_MAX_IMAGE_EDGE &&
           answer->height <= KILN_MAX_IMAGE_EDGE &&
           (uint64_t)answer->width * answer->height <= KILN_MAX_IMAGE_PIXELS &&
           answer->channels >= 1 && answer->channels <= 4 && answer->type <= KILN_IMAGE_F32 &&
           answer->srgb <= 1 && answer->premultiplied <= 1 && answer->pages >= 1 &&
           answer->pages <= KILN_MAX_IMAGE_PAGES;
}

static bool are_finite(const struct kiln_asset_image *image)
{
    const float *values = image->pixels;
    const size_t count = (size_t)image->width * image->height * 4;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i]))
            return false;
    }
    return true;
}

static bool receive_pixels(const struct kiln_received *received, struct kiln_asset_image *image,
                           struct kiln_error *reason)
{
    const size_t bytes = kiln_asset_image_bytes(image);
    image->pixels = malloc(bytes);
    if (!image->pixels)
        return kiln_error_no_memory(reason, "the pixels");
    if (!kiln_helper_receive(received->helper, kiln_loader_caller(received->loader), image->pixels,
                             bytes, reason))
        return false;
    return image->type != KILN_IMAGE_F32 || !received->finite || are_finite(image) ||
           kiln_error_set(reason, KILN_INVALID_INPUT,
                          "the image is cut short, or has pixels that are not finite numbers");
}

/* Counts the pixels of a picture in the budget. Of a video, whose frames are in memory one at a
 * time, only the largest frame counts. */
static bool count_pixels(struct kiln_received *received, uint64_t pixels, struct kiln_error *reason)
{
    const uint64_t more = pixels > received->counted ? pixels - received->counted : 0;
    received->counted += more;
    return kiln_budget_take(kiln_loader_budget(received->loader), KILN_LIMIT_asset_pixels, more,
                            received->name, reason);
}

struct kiln_asset_image *kiln_received_image(struct kiln_received *received, unsigned expected,
                                             struct kiln_error *reason)
{
    struct kiln_decode_answer answer = {.what = KILN_DECODE_FAILED};
    const bool answered = kiln_helper_answer(received->helper, kiln_loader_caller(received->loader),
                                             expected, &answer, reason);
    if (answer.what == KILN_DECODE_FAILED && answer.code == KILN_OVER_LIMIT)
        received->refused = (uint64_t)answer.width * answer.height;
    received->needs_other = answered && answer.what == KILN_DECODE_NEEDS_OTHER;
    if (!answered || answer.what != KILN_DECODE_PIXELS)
        return NULL;
    struct kiln_asset_image *image = calloc(1, sizeof *image);
    bool ok = image || kiln_error_no_memory(reason, "a picture");
    ok = ok && (is_sound(&answer) || kiln_error_set(reason, KILN_INVALID_INPUT,
                                                    "the decoder returned inconsistent data"));
    if (ok) {
        *image = (struct kiln_asset_image){.width = answer.width,
                                           .height = answer.height,
                                           .channels = answer.channels,
                                           .type = (enum kiln_image_type)answer.type,
                                           .srgb = answer.srgb,
                                           .premultiplied = answer.premultiplied,
                                           .pages = answer.pages};
        ok = count_pixels(received, (uint64_t)answer.width * answer.height, reason) &&
             receive_pixels(received, image, reason);
    }
    if (!ok) {
        /* pixels may be left in the socket, so the process cannot be asked again */
        kiln_helper_break(received->helper);
        kiln_asset_image_destroy(&image);
    }
    return image;
}

bool kiln_received_fail(const struct kiln_received *received, const struct kiln_error *reason,
                        struct kiln_error *error)
{
    /* The helper stopped at the number of pixels that the budget had left. The budget makes the
     * error message. */
    if (received->refused > 0 &&
        !kiln_budget_take(kiln_loader_budget(received->loader), KILN_LIMIT_asset_pixels,
                          received->refused, received->name, error))
        return false;
    return kiln_helper_fail(received->name, reason, error);
}
