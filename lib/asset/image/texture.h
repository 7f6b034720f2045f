/* Loads a picture as a GL texture of linear light, for the floor or the sky. */
#ifndef KILN_ASSET_IMAGE_TEXTURE_H
#define KILN_ASSET_IMAGE_TEXTURE_H

#include "asset/loader/loader.h"
#include "gpu/device.h"

struct kiln_texture {
    GLuint gl; /* RGBA16F with mip levels, filtered trilinearly; it repeats in x */
    uint32_t width, height;
};

/* Loads an image file of a format of asset/image/image.h. Transparent parts are black, light is at
 * most 65504. wrap_y is GL_REPEAT or GL_CLAMP_TO_EDGE. Errors are those of kiln_asset_image_load,
 * and KILN_INVALID_INPUT when the picture is larger than the device's textures. */
bool kiln_texture_init(struct kiln_texture *texture, struct kiln_device *device,
                       struct kiln_loader *loader, const char *path, GLint wrap_y,
                       struct kiln_error *error);
void kiln_texture_finish(struct kiln_texture *texture);

enum { KILN_SKY_PARTS = 32 };

/* Light of an equirectangular picture on surfaces: the mean radiance that a surface facing up
 * receives, and that of the band around the horizon. `around` has the radiance right at the
 * horizon, of equal parts of the picture from its left to its right. */
struct kiln_sky_light {
    float up[3], horizon[3];
    float around[KILN_SKY_PARTS][3];
};

bool kiln_sky_light_measure(struct kiln_sky_light *light, struct kiln_loader *loader,
                            const char *path, struct kiln_error *error);

#endif
