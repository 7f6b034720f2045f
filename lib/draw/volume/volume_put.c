/* This file puts the planes of a picture of gas to images. Pixels in tiles that no gas touches are
 * skipped. */
#include "draw/volume/volume_put.h"

#include <string.h>

/* Calls a function for each pixel of row `y` in tiles with gas. */
static void put_row(const struct kiln_volume_put *job, size_t y,
                    void (*put)(const struct kiln_volume_put *job, size_t first))
{
    const size_t across = kiln_tiles_along(job->width);
    const uint8_t *touched = job->touched + y / VOLUME_TILE * across;
    for (size_t x = 0; x < job->width; x++)
        if (touched[x / VOLUME_TILE])
            put(job, 4 * (y * job->width + x));
}

static void put_under(const struct kiln_volume_put *job, size_t first)
{
    const float *smoke = job->planes->smoke + first;
    const float *flame = job->planes->flame + first;
    float *to = job->to + first;
    const enum kiln_volume_light_of light = job->light;
    const float left = light == KILN_VOLUME_SHINE ? 1.0f : 1.0f - to[3];
    for (int c = 0; c < 3; c++)
        to[c] += left * (light == KILN_VOLUME_ALL     ? smoke[c] + flame[c]
                         : light == KILN_VOLUME_SMOKE ? smoke[c]
                                                      : flame[c]);
    if (light == KILN_VOLUME_ALL || light == KILN_VOLUME_SMOKE)
        to[3] += left * smoke[3];
}

static void put_glow(const struct kiln_volume_put *job, size_t first)
{
    const float *glow = job->planes->glow + first;
    const float hidden = job->light == KILN_VOLUME_SHINE ? 0.0f : job->planes->smoke[first + 3];
    float *to = job->to + first;
    for (int c = 0; c < 3; c++)
        to[c] = (job->light == KILN_VOLUME_SMOKE ? 0.0f : glow[c]) + (1.0f - hidden) * to[c];
    to[3] = hidden + (1.0f - hidden) * to[3];
}

static void put_layer(const struct kiln_volume_put *job, size_t first)
{
    memcpy(job->to + first, job->planes->flame + first, 3 * sizeof *job->to);
    job->to[first + 3] = job->planes->smoke[first + 3];
}

static void clear_row(const struct kiln_volume_put *job, size_t y)
{
    const size_t row = 4 * (size_t)job->width;
    memset(job->to + y * row, 0, row * sizeof *job->to);
}

void kiln_volume_clear_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_volume_put *job = context;
    const size_t row = 4 * (size_t)job->width, bytes = (end - begin) * row * sizeof(float);
    memset(job->planes->smoke + begin * row, 0, bytes);
    memset(job->planes->flame + begin * row, 0, bytes);
    if (job->planes->glow)
        memset(job->planes->glow + begin * row, 0, bytes);
}

void kiln_volume_put_under_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t y = begin; y < end; y++)
        put_row(context, y, put_under);
}

void kiln_volume_put_glow_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct kiln_volume_put *job = context;
    for (size_t y = begin; y < end; y++) {
        if (!job->keep)
            clear_row(job, y);
        put_row(job, y, put_glow);
    }
}

void kiln_volume_put_layer_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t y = begin; y < end; y++) {
        clear_row(context, y);
        put_row(context, y, put_layer);
    }
}
