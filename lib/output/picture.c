/* Allocates, shares and frees pictures: the pixels of one frame between the renderer and an
 * encoder. */
#include <pthread.h>
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
        kiln_error_no_memory(error, "a picture of %u x %u pixels", width, height);
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

static void free_picture(struct kiln_picture *picture)
{
    free(picture->display);
    for (uint32_t i = 0; i < picture->layer_count; i++)
        free(picture->layers[i].pixels);
    free(picture);
}

/* ---- spare pictures -------------------------------------------------------------------------- */

struct kiln_spare_pictures {
    pthread_mutex_t mutex;
    struct kiln_picture *first; /* of a list by next_spare */
    size_t in_use;              /* pictures that will come back */
    bool closed;                /* nobody takes any more; the last picture in use frees this */
};

struct kiln_spare_pictures *kiln_spare_pictures_create(void)
{
    struct kiln_spare_pictures *spares = calloc(1, sizeof *spares);
    if (spares)
        pthread_mutex_init(&spares->mutex, NULL);
    return spares;
}

static void free_spares(struct kiln_spare_pictures *spares)
{
    pthread_mutex_destroy(&spares->mutex);
    free(spares);
}

void kiln_spare_pictures_destroy(struct kiln_spare_pictures **spares)
{
    struct kiln_spare_pictures *s = *spares;
    if (!s)
        return;
    *spares = NULL;
    pthread_mutex_lock(&s->mutex);
    struct kiln_picture *picture = s->first;
    s->first = NULL;
    s->closed = true;
    const bool last = s->in_use == 0;
    pthread_mutex_unlock(&s->mutex);
    while (picture) {
        struct kiln_picture *next = picture->next_spare;
        free_picture(picture);
        picture = next;
    }
    if (last)
        free_spares(s);
}

struct kiln_picture *kiln_spare_pictures_take(struct kiln_spare_pictures *spares)
{
    pthread_mutex_lock(&spares->mutex);
    struct kiln_picture *picture = spares->first;
    if (picture) {
        spares->first = picture->next_spare;
        spares->in_use++;
    }
    pthread_mutex_unlock(&spares->mutex);
    if (!picture)
        return NULL;
    picture->next_spare = NULL;
    picture->has_alpha = picture->is_data = false;
    atomic_store(&picture->others, 0);
    return picture;
}

void kiln_spare_pictures_add(struct kiln_spare_pictures *spares, struct kiln_picture *picture)
{
    pthread_mutex_lock(&spares->mutex);
    spares->in_use++;
    pthread_mutex_unlock(&spares->mutex);
    picture->spares = spares;
}

/* Takes a picture back from its last holder. */
static void take_back(struct kiln_spare_pictures *spares, struct kiln_picture *picture)
{
    pthread_mutex_lock(&spares->mutex);
    spares->in_use--;
    const bool closed = spares->closed, last = closed && spares->in_use == 0;
    if (!closed) {
        picture->next_spare = spares->first;
        spares->first = picture;
    }
    pthread_mutex_unlock(&spares->mutex);
    if (closed)
        free_picture(picture);
    if (last)
        free_spares(spares);
}

void kiln_picture_destroy(struct kiln_picture **picture)
{
    struct kiln_picture *p = *picture;
    *picture = NULL;
    if (!p || atomic_fetch_sub(&p->others, 1) > 0)
        return;
    if (p->spares)
        take_back(p->spares, p);
    else
        free_picture(p);
}
