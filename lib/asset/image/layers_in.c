/* This file reads the layers of an EXR file from a kiln-decode process, which decodes them in one
 * order for every file, so that those of two files can be compared one by one. */
#include "asset/image/layers_in.h"

#include <stdlib.h>
#include <unistd.h>

#include "asset/image/animated.h"
#include "asset/image/received.h"
#include "base/error.h"

struct kiln_layers_in {
    char *path;
    const char *wanted; /* name of a layer, or NULL for all */
    int file;           /* -1: no process has to be asked */
    struct kiln_received received;
    uint32_t count;                  /* of the layers that were read */
    struct kiln_asset_image *single; /* of a format without layers */
    bool has_ended;
};

/* Asks a process of a kind for the layers. */
static bool ask(struct kiln_layers_in *layers, enum kiln_decode_kind kind, struct kiln_error *error)
{
    struct kiln_received *received = &layers->received;
    struct kiln_decode_request request = {.format = KILN_PICTURE_EXR,
                                          .layers = true,
                                          .most_bytes = KILN_MAX_IMAGE_BYTES,
                                          .most_pixels =
                                              kiln_received_most_pixels(received->loader)};
    struct kiln_error reason = {0};
    const int length =
        snprintf(request.layer, sizeof request.layer, "%s", layers->wanted ? layers->wanted : "");
    if (length < 0 || (size_t)length >= sizeof request.layer)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: no layer '%s'", layers->path,
                              layers->wanted);
    received->helper = kiln_loader_take(received->loader, kind, error);
    return received->helper &&
           (kiln_helper_send(received->helper, &request, sizeof request, layers->file, &reason) ||
            kiln_received_fail(received, &reason, error));
}

static bool begin(struct kiln_layers_in *layers, struct kiln_error *error)
{
    struct kiln_loader *loader = layers->received.loader;
    const struct kiln_loader_file named = {layers->path, "image", KILN_IMAGE_FORMATS,
                                           KILN_MAX_IMAGE_BYTES};
    size_t size = 0;
    layers->file = kiln_loader_open(loader, &named, &size, error);
    if (layers->file < 0)
        return false;
    if (kiln_file_is_exr(layers->file))
        return ask(layers, KILN_DECODE_EXR, error);
    close(layers->file);
    layers->file = -1;
    layers->single = kiln_asset_image_load_layer(loader, layers->path,
                                                 layers->wanted ? layers->wanted : "beauty", error);
    return layers->single != NULL;
}

struct kiln_layers_in *kiln_layers_in_open(struct kiln_loader *loader, const char *path,
                                           const char *layer, struct kiln_error *error)
{
    struct kiln_layers_in *layers = calloc(1, sizeof *layers);
    char *copy = layers ? strdup(path) : NULL;
    if (!copy) {
        free(layers);
        kiln_error_no_memory(error, "opening the layers of %s", path);
        return NULL;
    }
    *layers = (struct kiln_layers_in){.path = copy, .wanted = layer, .file = -1};
    layers->received = (struct kiln_received){.loader = loader, .name = copy, .layers = true};
    if (!begin(layers, error))
        kiln_layers_in_close(&layers);
    return layers;
}

/* Gives the process back if it waits for another file, and ends it otherwise. */
static void let_go(struct kiln_layers_in *layers)
{
    struct kiln_received *received = &layers->received;
    if (received->helper && !layers->has_ended)
        kiln_helper_break(received->helper);
    if (received->helper)
        kiln_loader_give_back(received->loader, &received->helper);
}

void kiln_layers_in_close(struct kiln_layers_in **layers)
{
    if (!*layers)
        return;
    let_go(*layers);
    if ((*layers)->file >= 0)
        close((*layers)->file);
    kiln_asset_image_destroy(&(*layers)->single);
    free((*layers)->path);
    free(*layers);
    *layers = NULL;
}

/* Waits for the next layer. *image is NULL behind the last one, and if the process cannot decode
 * the file. */
static bool receive(struct kiln_layers_in *layers, struct kiln_asset_image **image,
                    struct kiln_error *error)
{
    struct kiln_received *received = &layers->received;
    /* A process of the second kind needs no further one, unless a file has taken it over. */
    const bool first = layers->count == 0 && kiln_helper_kind(received->helper) == KILN_DECODE_EXR;
    const unsigned other = first ? 1u << KILN_DECODE_NEEDS_OTHER : 0;
    struct kiln_error reason = {0};
    kiln_helper_begin(received->helper);
    *image = kiln_received_image(received, 1u << KILN_DECODE_PIXELS | 1u << KILN_DECODE_END | other,
                                 &reason);
    layers->has_ended = !*image && reason.code == KILN_OK;
    return reason.code == KILN_OK || kiln_received_fail(received, &reason, error);
}

/* Checks that the layers come in their order, so that none comes twice. last: the name of the one
 * before. */
static bool check_order(struct kiln_layers_in *layers, const char *last, struct kiln_error *error)
{
    layers->count++;
    return layers->count <= KILN_MAX_IMAGE_LAYERS &&
                   (layers->count == 1 || kiln_order_layers(last, layers->received.layer) < 0)
               ? true
               : kiln_error_set(error, KILN_INVALID_INPUT,
                                "%s: the decoder returned inconsistent data", layers->path);
}

bool kiln_layers_in_read(struct kiln_layers_in *layers, struct kiln_image_layer *layer,
                         struct kiln_error *error)
{
    struct kiln_received *received = &layers->received;
    char last[KILN_LAYER_NAME_SIZE];
    *layer = (struct kiln_image_layer){.name = "beauty", .image = layers->single};
    layers->single = NULL;
    if (layer->image || layers->file < 0 || layers->has_ended)
        return true;
    memcpy(last, received->layer, sizeof last);
    if (!receive(layers, &layer->image, error))
        return false;
    if (!layer->image && received->needs_other) {
        let_go(layers);
        layers->has_ended = false;
        if (!ask(layers, KILN_DECODE_OPENEXR, error) || !receive(layers, &layer->image, error))
            return false;
    }
    if (!layer->image)
        return true;
    memcpy(layer->name, received->layer, sizeof layer->name);
    layer->data = received->data;
    if (check_order(layers, last, error))
        return true;
    kiln_asset_image_destroy(&layer->image);
    return false;
}
