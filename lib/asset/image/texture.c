/* This file loads a picture into a GL texture of linear light, one row at a time. It also measures
 * the light of a sky picture from above and from the horizon. */
#include "asset/image/texture.h"

#include <math.h>
#include <stdlib.h>

#include "asset/image/image.h"
#include "asset/image/linear.h"
#include "base/error.h"
#include "shared/exact.h"

static bool upload(const struct kiln_asset_image *image, const char *path, struct kiln_error *error)
{
    float *row = malloc((size_t)image->width * 3 * sizeof *row);
    if (!row)
        return kiln_error_no_memory(error, "%s", path);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (uint32_t y = 0; y < image->height; y++) {
        kiln_linear_row(image, y, row);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, (GLint)y, (GLsizei)image->width, 1, GL_RGB, GL_FLOAT,
                        row);
    }
    free(row);
    return true;
}

bool kiln_texture_init(struct kiln_texture *texture, struct kiln_device *device,
                       struct kiln_loader *loader, const char *path, GLint wrap_y,
                       struct kiln_error *error)
{
    *texture = (struct kiln_texture){.gl = 0};
    struct kiln_asset_image *image = kiln_asset_image_load(loader, path, error);
    if (!image)
        return false;
    uint32_t most = (uint32_t)device->info.max_texture_size;
    bool ok = image->width <= most && image->height <= most;
    if (!ok) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the picture has %u x %u pixels; %s takes at most %u a side", path,
                       image->width, image->height, device->info.name, most);
    } else {
        texture->width = image->width;
        texture->height = image->height;
        glGenTextures(1, &texture->gl);
        glBindTexture(GL_TEXTURE_2D, texture->gl);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, (GLsizei)image->width, (GLsizei)image->height, 0,
                     GL_RGB, GL_FLOAT, NULL);
        ok = upload(image, path, error);
        glGenerateMipmap(GL_TEXTURE_2D);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_y);
        kiln_device_label(device, GL_TEXTURE, texture->gl, "picture");
        ok = kiln_device_check(device, "picture", error) && ok;
    }
    kiln_asset_image_destroy(&image);
    if (!ok)
        kiln_texture_finish(texture);
    return ok;
}

void kiln_texture_finish(struct kiln_texture *texture)
{
    if (texture->gl)
        glDeleteTextures(1, &texture->gl);
    *texture = (struct kiln_texture){.gl = 0};
}

/* Weighted sums over the rows of a sky picture: for the light on a horizontal plane, and for the
 * light near the horizon. */
struct sky_sums {
    double up[3], horizon[3];
    double up_weight, horizon_weight;
    double around[KILN_SKY_PARTS][3], around_weight; /* over the rows nearest to the horizon */
};

/* Adds a row to the colours at the horizon. A part of the picture that is narrower than a pixel
 * takes the pixel that it lies in. */
static void add_around(struct sky_sums *sums, const float *rgb, uint32_t width)
{
    for (uint32_t i = 0; i < KILN_SKY_PARTS; i++) {
        const uint32_t from = (uint32_t)((uint64_t)i * width / KILN_SKY_PARTS);
        uint32_t to = (uint32_t)((uint64_t)(i + 1) * width / KILN_SKY_PARTS);
        to = to > from ? to : from + 1;
        for (uint32_t x = from; x < to; x++) {
            for (uint32_t c = 0; c < 3; c++)
                sums->around[i][c] += (double)rgb[3 * x + c] / (to - from);
        }
    }
    sums->around_weight += 1.0;
}

static void add_row(struct sky_sums *sums, const float *rgb, uint32_t width, float elevation)
{
    /* radians, about 6 degrees below to 11 degrees above the horizon */
    const float low = -0.1f, high = 0.2f;
    double mean[3] = {0};
    for (uint32_t x = 0; x < width; x++) {
        for (int c = 0; c < 3; c++)
            mean[c] += (double)rgb[3 * x + (uint32_t)c] / width;
    }
    const struct exact_angle angle = exact_sincos(elevation);
    double area = (double)angle.cosine, facing = fmax((double)angle.sine, 0.0);
    double near = elevation > low && elevation < high ? 1.0 : 0.0;
    for (int c = 0; c < 3; c++) {
        sums->up[c] += mean[c] * area * facing;
        sums->horizon[c] += mean[c] * area * near;
    }
    sums->up_weight += area * facing;
    sums->horizon_weight += area * near;
}

/* Returns whether a row of a picture is one of those nearest to its horizon: within 3 degrees, or
 * the two about the middle. */
static bool is_at_horizon(uint32_t y, uint32_t height)
{
    const double rows = fmax(1.0, (double)height / 60.0);
    return fabs((double)y + 0.5 - 0.5 * (double)height) < rows;
}

bool kiln_sky_light_measure(struct kiln_sky_light *light, struct kiln_loader *loader,
                            const char *path, struct kiln_error *error)
{
    *light = (struct kiln_sky_light){.up = {0}};
    struct kiln_asset_image *image = kiln_asset_image_load_sky(loader, path, error);
    if (!image)
        return false;
    float *row = malloc((size_t)image->width * 3 * sizeof *row);
    struct sky_sums sums = {.up_weight = 0.0};
    for (uint32_t y = 0; row && y < image->height; y++) {
        float elevation = 3.14159265f * (0.5f - ((float)y + 0.5f) / (float)image->height);
        kiln_linear_row(image, y, row);
        add_row(&sums, row, image->width, elevation);
        if (is_at_horizon(y, image->height))
            add_around(&sums, row, image->width);
    }
    for (int i = 0; i < KILN_SKY_PARTS * 3; i++)
        light->around[i / 3][i % 3] =
            (float)(sums.around[i / 3][i % 3] / fmax(sums.around_weight, 1.0));
    for (int c = 0; c < 3; c++) {
        light->up[c] = (float)(sums.up[c] / fmax(sums.up_weight, 1e-12));
        light->horizon[c] = (float)(sums.horizon[c] / fmax(sums.horizon_weight, 1e-12));
    }
    /* A picture with few rows may have none near the horizon. */
    if (sums.horizon_weight <= 0.0) {
        for (int c = 0; c < 3; c++)
            light->horizon[c] = light->up[c];
    }
    bool ok = row != NULL || kiln_error_no_memory(error, "%s", path);
    free(row);
    kiln_asset_image_destroy(&image);
    return ok;
}
