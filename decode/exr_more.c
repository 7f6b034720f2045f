/* This file decodes the channels of layers of an OpenEXR file by OpenEXR's C++ library, which
 * lies in the module kiln-openexr.so beside kiln-decode. A file comes here if OpenEXR's C core
 * cannot decode it. DWAA and DWAB are decoded by floats and the processor's vectors, so their
 * pixels may differ a little from machine to machine. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "exr.h"
#include "exr_module.h"
#include "module.h"

static struct {
    __typeof__(kiln_openexr_read) *kiln_openexr_read;
} module;

bool decode_exr_more_begin(struct kiln_error *error)
{
    static const struct kiln_library_function functions[] = {
        {"kiln_openexr_read", &module.kiln_openexr_read}};
    return decode_module_open("kiln-openexr.so", "libopenexr-3-1-30", functions, 1, error);
}

bool decode_exr_more_is_ready(void)
{
    return module.kiln_openexr_read != NULL;
}

/* Lists where the samples of the layers' channels go. Returns how many channels there are. */
static size_t list_channels(const struct exr_reading *readings, size_t count,
                            struct kiln_openexr_channel *channels)
{
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        const struct exr_layer *layer = &readings[i].layer;
        for (int role = 0; role < EXR_ROLES; role++) {
            struct kiln_openexr_channel channel = {.name = layer->names[role],
                                                   .sampling = role < EXR_RY ? 1 : layer->sampling,
                                                   .whole = layer->is_whole};
            channel.first = decode_exr_target(&readings[i], (enum exr_role)role, &channel.step,
                                              &channel.stride);
            if (channel.first)
                channels[used++] = channel;
        }
    }
    return used;
}

bool decode_exr_more(struct exr_reading *readings, size_t count)
{
    const struct exr_box *data = &readings->data;
    struct kiln_error *error = readings->picture->error;
    char message[256] = "";
    struct kiln_openexr_channel *channels = calloc(count * EXR_ROLES, sizeof *channels);
    if (!channels)
        return decode_out_of_memory(error);
    const struct kiln_openexr_request request = {
        .bytes = readings->picture->bytes,
        .size = readings->picture->size,
        .part = readings->part,
        .data_window = {data->left, data->top, (int32_t)(data->left + (int64_t)data->width - 1),
                        (int32_t)(data->top + (int64_t)data->height - 1)},
        .deep = readings->deep,
        .channels = channels,
        .channel_count = list_channels(readings, count, channels),
    };
    const enum kiln_openexr_result result =
        module.kiln_openexr_read(&request, message, sizeof message);
    free(channels);
    switch (result) {
    case KILN_OPENEXR_DONE:
        return true;
    case KILN_OPENEXR_NO_MEMORY:
        return decode_out_of_memory(error);
    case KILN_OPENEXR_BROKEN:
        break;
    }
    return kiln_error_set(error, KILN_INVALID_INPUT, "the EXR image is broken or cut short (%s)",
                          message);
}
