/* Allocates, shares and frees pictures: the pixels of one frame between the renderer and an
 * encoder. */
#include <stdlib.h>

#include "base/error.h"
#include "base/pages.h"
#include "output/output.h"

/* Returns the bytes of width * height pixels, or 0 when there are none or too many. */
static size_t pixel_bytes(uint32_t width, uint32_t height, size_t bytes_per_pixel)
{
    uint64_t pixels = (uint64_t)width * height;
    return pixels > SIZE_MAX / bytes_per_pixel ? 0 : (size_t)pixels * bytes_per_pixel;
}

struct kiln_picture *kiln_picture_create(uint32_t width, uint32_t height, uint32_t bits,
                                         const char *const *names, const uint32_t *channels,
                                         uint32_t layer_count, struct kiln_error *error)
{
    struct kiln_picture *picture = calloc(1, sizeof *picture);
    bool good = picture && layer_count <= KILN_MAX_LAYERS && width > 0 && height > 0;
    if (good && bits > 0) {
        size_t size = pixel_bytes(width, height, bits / 8 * (size_t)4);
        picture->display = size > 0 ? kiln_alloc_pages(size) : NULL;
        good = picture->display != NULL;
    }
    for (uint32_t i = 0; good && i < layer_count; i++) {
        size_t size = pixel_bytes(width, height, channels[i] * sizeof(float));
        picture->layers[i] =
            (struct kiln_layer){names[i], channels[i], size > 0 ? kiln_alloc_pages(size) : NULL};
        picture->layer_count = i + 1;
        good = picture->layers[i].pixels != NULL;
    }
    if (!good) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "no memory for a picture of %u x %u pixels",
                       width, height);
        kiln_picture_destroy(&picture);
        return NULL;
    }
    picture->width = width;
    picture->height = height;
    picture->bits = bits;
    return picture;
}

struct kiln_picture *kiln_picture_share(struct kiln_picture *picture)
{
    atomic_fetch_add(&picture->others, 1);
    return picture;
}

void kiln_picture_destroy(struct kiln_picture **picture)
{
    struct kiln_picture *p = *picture;
    *picture = NULL;
    if (!p || atomic_fetch_sub(&p->others, 1) > 0)
        return;
    free(p->display);
    for (uint32_t i = 0; i < p->layer_count; i++)
        free(p->layers[i].pixels);
    free(p);
}
