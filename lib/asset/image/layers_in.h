/* Reads the layers of a picture, one after the other. */
#ifndef KILN_ASSET_IMAGE_LAYERS_IN_H
#define KILN_ASSET_IMAGE_LAYERS_IN_H

#include <string.h>

#include "asset/image/image.h"

struct kiln_image_layer {
    char name[KILN_LAYER_NAME_SIZE]; /* "beauty" is the picture */
    bool data;                       /* the numbers are no light, such as depths and names */
    struct kiln_asset_image *image;
};

/* Returns the order of two layers: the picture, then all others by their names. */
static inline int kiln_order_layers(const char *a, const char *b)
{
    const int first = strcmp(a, "beauty") != 0, second = strcmp(b, "beauty") != 0;
    return first != second ? first - second : strcmp(a, b);
}

struct kiln_layers_in;

/* Opens a picture. layer: the name of the one layer that is wanted; NULL: all. Formats other than
 * EXR have one, "beauty". The loader may be NULL. Fails like kiln_asset_image_load_layer; faults of
 * a layer are found when it is read. */
struct kiln_layers_in *kiln_layers_in_open(struct kiln_loader *loader, const char *path,
                                           const char *layer, struct kiln_error *error);
void kiln_layers_in_close(struct kiln_layers_in **layers);

/* Decodes the next layer, in the order of kiln_order_layers. Returns true with the image, which the
 * caller destroys, or with NULL behind the last layer. Floats are not made finite, and data of
 * whole numbers are of type KILN_IMAGE_U32. */
bool kiln_layers_in_read(struct kiln_layers_in *layers, struct kiln_image_layer *layer,
                         struct kiln_error *error);

#endif
