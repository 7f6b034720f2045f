/* Loads a picture as a GL texture of linear light, for the floor or the sky. */
#ifndef KILN_ASSET_IMAGE_TEXTURE_H
#define KILN_ASSET_IMAGE_TEXTURE_H

#include "asset/loader/loader.h"
#include "gpu/device.h"

struct kiln_texture {
    GLuint gl; /* RGBA16F with mip levels, filtered trilinearly; it repeats in x */
    uint32_t width, height;
};

/* Loads an image file (asset/image/image.h says which); transparent parts are black, light is at
 * most 65504. wrap_y is GL_REPEAT or GL_CLAMP_TO_EDGE. KILN_INVALID_INPUT, too, when it is larger
 * than the device's textures. */
bool kiln_texture_init(struct kiln_texture *texture, struct kiln_device *device,
                       struct kiln_loader *loader, const char *path, GLint wrap_y,
                       struct kiln_error *error);
void kiln_texture_finish(struct kiln_texture *texture);

/* What an equirectangular picture sheds on surfaces: the mean radiance that one facing up receives,
 * and that of the band around the horizon. */
struct kiln_sky_light {
    float up[3], horizon[3];
};

bool kiln_sky_light_measure(struct kiln_sky_light *light, struct kiln_loader *loader,
                            const char *path, struct kiln_error *error);

#endif
