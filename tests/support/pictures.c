/* Makes pictures whose pixels follow from formulas and writes them as files, and makes, counts and
 * removes files and temporary folders, for tests of output. */
#include "support/pictures.h"

#include <dirent.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"

const char test_scene_hash[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

static const char *const test_layer_names[] = {"beauty", "depth", "fire"};
static const uint32_t test_layer_channels[] = {4, 1, 4};

/* Returns a triangle wave, which rises from 0 to 200 and falls again within a period of 400. */
static uint32_t test_wave(uint32_t phase)
{
    return phase % 400 < 200 ? phase % 400 : 400 - phase % 400;
}

uint32_t test_level(uint32_t frame, uint32_t width, uint32_t x, uint32_t y, int channel)
{
    uint32_t ramp = x * 200 / width;
    uint32_t level[4] = {20 + ramp, 220 - ramp, 30 + test_wave(ramp + y + frame * 4),
                         255 - test_wave(y)};
    return level[channel];
}

float test_layer_value(uint32_t frame, uint32_t x, uint32_t y, uint32_t layer, uint32_t channel)
{
    return (float)(x + 3 * y + 7 * layer + frame) * 0.125f - (float)channel;
}

struct kiln_output_params test_output_params(const char *path, const struct kiln_frame_range *range)
{
    return (struct kiln_output_params){
        .path = path,
        .width = 64,
        .height = 36,
        .fps_num = 30,
        .fps_den = 1,
        .ranges = range,
        .range_count = 1,
        .threads = 2,
        .png_bits = 8,
        .exr_bits = 16,
        .quality = 80,
        .scene_hash = test_scene_hash,
        .seed = 4000000007u,
    };
}

struct kiln_picture *test_picture(const struct kiln_output *output,
                                  const struct kiln_output_params *params, uint32_t frame)
{
    struct kiln_output_needs needs = kiln_output_needs(output);
    struct kiln_error error = {0};
    struct kiln_picture *picture =
        kiln_picture_create(params->width, params->height, needs.bits, test_layer_names,
                            test_layer_channels, needs.layers ? 3 : 0, &error);
    assert_non_null(picture);
    picture->frame = frame;
    picture->has_alpha = params->alpha;
    for (uint32_t y = 0; y < params->height; y++) {
        for (uint32_t x = 0; x < params->width; x++) {
            size_t pixel = (size_t)y * params->width + x;
            for (int c = 0; c < 4; c++) {
                uint32_t level = test_level(frame, params->width, x, y, c);
                if (c == 3 && !params->alpha)
                    level = 255;
                if (needs.bits == 8)
                    ((uint8_t *)picture->display)[pixel * 4 + (size_t)c] = (uint8_t)level;
                if (needs.bits == 16)
                    ((uint16_t *)picture->display)[pixel * 4 + (size_t)c] =
                        (uint16_t)(level * 256 + x);
            }
            for (uint32_t i = 0; i < picture->layer_count; i++) {
                struct kiln_layer *layer = &picture->layers[i];
                for (uint32_t c = 0; c < layer->channels; c++)
                    layer->pixels[pixel * layer->channels + c] =
                        test_layer_value(frame, x, y, i, c);
            }
        }
    }
    return picture;
}

bool test_write_all(const struct kiln_output_params *params, struct kiln_error *error)
{
    struct kiln_output *output = kiln_output_open(params, error);
    bool good = output != NULL;
    for (size_t i = 0; good && i < params->range_count; i++) {
        for (uint32_t f = params->ranges[i].first; good && f <= params->ranges[i].last; f++)
            good = kiln_output_write(output, test_picture(output, params, f), error);
    }
    good = good && kiln_output_finish(output, error);
    kiln_output_close(&output);
    return good;
}

void test_make_folder(char folder[32])
{
    snprintf(folder, 32, "/tmp/kiln-output-XXXXXX");
    assert_non_null(mkdtemp(folder));
}

int test_count_files(const char *folder)
{
    int count = 0;
    DIR *entries = opendir(folder);
    assert_non_null(entries);
    for (struct dirent *entry = readdir(entries); entry; entry = readdir(entries))
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(entries);
    return count;
}

static int test_remove_entry(const char *path, const struct stat *status, int kind,
                             struct FTW *place)
{
    (void)status;
    (void)kind;
    (void)place;
    return remove(path);
}

void test_remove_folder(const char *folder)
{
    assert_int_equal(nftw(folder, test_remove_entry, 8, FTW_DEPTH | FTW_PHYS), 0);
}
