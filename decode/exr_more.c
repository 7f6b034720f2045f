/* This file decodes the channels of one layer of an OpenEXR file by OpenEXR's C++ library, which
 * lies in the module kiln-openexr.so beside kiln-decode. A file comes here if OpenEXR's C core
 * cannot decode it. DWAA and DWAB are decoded by floats and the processor's vectors, so their
 * pixels may differ a little from machine to machine. */
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

bool decode_exr_more(struct exr_reading *reading, bool deep)
{
    const struct exr_box *data = &reading->data;
    struct kiln_error *error = reading->picture->error;
    char message[256] = "";
    struct kiln_openexr_request request = {
        .bytes = reading->picture->bytes,
        .size = reading->picture->size,
        .part = reading->part,
        .data_window = {data->left, data->top, (int32_t)(data->left + (int64_t)data->width - 1),
                        (int32_t)(data->top + (int64_t)data->height - 1)},
        .deep = deep,
    };
    for (int role = 0; role < EXR_ROLES; role++) {
        struct kiln_openexr_channel *channel = &request.channels[role];
        channel->name = reading->layer.names[role];
        channel->sampling = role < EXR_RY ? 1 : reading->layer.sampling;
        channel->first =
            decode_exr_target(reading, (enum exr_role)role, &channel->step, &channel->stride);
    }
    switch (module.kiln_openexr_read(&request, message, sizeof message)) {
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
