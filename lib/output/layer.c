/* Writes one layer of a frame, or pixels that a program made itself, as a PNG or an EXR. The pixels
 * are copied into a picture first: rows may have gaps in the caller's memory, and encoders read
 * rows without gaps. */
#include <string.h>

#include "base/error.h"
#include "base/sized.h"
#include "output/formats.h"

static bool is_float(const struct kiln_frame_layer *layer)
{
    return layer->samples == KILN_SAMPLES_FLOAT;
}

static size_t sample_bytes(const struct kiln_frame_layer *layer)
{
    return is_float(layer) ? 4 : layer->samples == KILN_SAMPLES_UINT16 ? 2 : 1;
}

static bool check(const struct kiln_frame_layer *layer, const char *path, struct kiln_error *error)
{
    const uint64_t row = (uint64_t)layer->width * layer->channels * sample_bytes(layer);
    if (layer->width < 1 || layer->width > KILN_MAX_EDGE || layer->height < 1 ||
        layer->height > KILN_MAX_EDGE)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: found %u x %u pixels; allowed are 1 to %d a side", path,
                              layer->width, layer->height, KILN_MAX_EDGE);
    if (layer->samples > KILN_SAMPLES_FLOAT)
        return kiln_error_set(error, KILN_USAGE, "%s: there are no samples of kind %d", path,
                              (int)layer->samples);
    if (layer->channels != 4 && !(is_float(layer) && layer->channels == 1))
        return kiln_error_set(error, KILN_USAGE, "%s: found %u channels; allowed are %s", path,
                              layer->channels, is_float(layer) ? "4 or 1" : "4");
    if (!layer->pixels || layer->row_bytes < row)
        return kiln_error_set(error, KILN_USAGE, "%s: found rows of %zu bytes; %u pixels have %zu",
                              path, layer->pixels ? layer->row_bytes : 0, layer->width,
                              (size_t)row);
    return true;
}

static const struct kiln_format *find_format(const struct kiln_frame_layer *layer, const char *path,
                                             struct kiln_error *error)
{
    const struct kiln_format *format = is_float(layer) ? &kiln_format_exr : &kiln_format_png;
    const char *dot = strrchr(path, '.');
    if (dot && strcmp(dot, format->suffix) == 0)
        return format;
    kiln_error_set(error, KILN_USAGE, "%s: %s samples go into a file '*%s'", path,
                   is_float(layer) ? "float" : "integer", format->suffix);
    return NULL;
}

static bool is_opaque(const struct kiln_picture *picture)
{
    const size_t count = (size_t)picture->width * picture->height;
    const uint8_t *bytes = picture->display;
    const uint16_t *words = picture->display;
    for (size_t i = 0; i < count; i++) {
        if (picture->bits == 8 ? bytes[4 * i + 3] < UINT8_MAX : words[4 * i + 3] < UINT16_MAX)
            return false;
    }
    return true;
}

static struct kiln_picture *copy(const struct kiln_frame_layer *layer, struct kiln_error *error)
{
    const char *name = layer->layer ? layer->layer : layer->channels == 1 ? "depth" : "beauty";
    const uint32_t bits = is_float(layer) ? 0 : 8 * (uint32_t)sample_bytes(layer);
    struct kiln_picture *picture = kiln_picture_create(
        layer->width, layer->height, bits, &name, &layer->channels, is_float(layer) ? 1 : 0, error);
    if (!picture)
        return NULL;
    const size_t row = (size_t)layer->width * layer->channels * sample_bytes(layer);
    const uint8_t *from = layer->pixels;
    uint8_t *to = bits > 0 ? picture->display : (void *)picture->layers[0].pixels;
    for (uint32_t y = 0; y < layer->height; y++)
        memcpy(to + y * row, from + y * layer->row_bytes, row);
    picture->frame = layer->frame;
    picture->has_alpha = bits > 0 ? !is_opaque(picture) : true;
    return picture;
}

static bool encode(const struct kiln_format *format, const struct kiln_picture *picture,
                   struct kiln_temporary *file, struct kiln_error *error)
{
    const struct kiln_output_params params = {
        .width = picture->width,
        .height = picture->height,
        .alpha = picture->has_alpha,
        .png_bits = picture->bits,
        .exr_bits = 32,
    };
    if (!format->check(&params, error))
        return false;
    void *encoder = format->open(&params, file, error);
    const bool ok = encoder && format->encode(encoder, picture, error) &&
                    (!format->finish || format->finish(encoder, NULL, error));
    if (encoder)
        format->close(encoder);
    return ok;
}

bool kiln_layer_write(const struct kiln_frame_layer *given, const char *path, bool overwrite,
                      struct kiln_error *error)
{
    struct kiln_frame_layer layer = kiln_frame_layer_empty();
    if (!kiln_sized_take(&layer, given, "kiln_frame_layer", error) || !check(&layer, path, error))
        return false;
    const struct kiln_format *format = find_format(&layer, path, error);
    if (!format || !kiln_target_check(path, overwrite, error) ||
        !kiln_make_parent_folders(path, error))
        return false;
    struct kiln_picture *picture = copy(&layer, error);
    struct kiln_temporary file = {0};
    const bool ok = picture && kiln_temporary_open(&file, path, error) &&
                    encode(format, picture, &file, error) &&
                    kiln_temporary_commit(&file, overwrite, error);
    kiln_temporary_discard(&file);
    kiln_picture_destroy(&picture);
    return ok;
}
