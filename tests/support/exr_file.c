/* Writes EXR files by the layout of their documentation (OpenEXR File Layout). */
#include "support/exr_file.h"

#include <string.h>

#include "support/cmocka.h"

static void put(struct exr_bytes *bytes, const void *data, size_t size)
{
    assert_true(bytes->size + size <= sizeof bytes->data);
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
}

static void put_word(struct exr_bytes *bytes, uint32_t word)
{
    const unsigned char data[4] = {(unsigned char)word, (unsigned char)(word >> 8),
                                   (unsigned char)(word >> 16), (unsigned char)(word >> 24)};
    put(bytes, data, 4);
}

static void put_attribute(struct exr_bytes *bytes, const char *name, const char *type,
                          uint32_t size)
{
    put(bytes, name, strlen(name) + 1);
    put(bytes, type, strlen(type) + 1);
    put_word(bytes, size);
}

static void put_window(struct exr_bytes *bytes, const char *name, const int32_t window[4])
{
    put_attribute(bytes, name, "box2i", 16);
    for (int i = 0; i < 4; i++)
        put_word(bytes, (uint32_t)window[i]);
}

void exr_file_write(struct exr_bytes *bytes, const struct exr_channel *channels, size_t count,
                    const int32_t data[4], const int32_t display[4])
{
    uint32_t list = 1, width = (uint32_t)(data[2] - data[0] + 1);
    uint32_t height = (uint32_t)(data[3] - data[1] + 1), line = 0;
    bytes->size = 0;
    put_word(bytes, 20000630);
    put_word(bytes, 2);
    for (size_t i = 0; i < count; i++) {
        list += (uint32_t)strlen(channels[i].name) + 17;
        line += width * (channels[i].type == 1 ? 2 : 4);
    }
    put_attribute(bytes, "channels", "chlist", list);
    for (size_t i = 0; i < count; i++) {
        put(bytes, channels[i].name, strlen(channels[i].name) + 1);
        put_word(bytes, channels[i].type);
        put_word(bytes, 0);
        put_word(bytes, channels[i].sampling ? channels[i].sampling : 1);
        put_word(bytes, channels[i].sampling ? channels[i].sampling : 1);
    }
    put(bytes, "", 1);
    put_attribute(bytes, "compression", "compression", 1);
    put(bytes, "", 1);
    put_window(bytes, "dataWindow", data);
    put_window(bytes, "displayWindow", display);
    put_attribute(bytes, "lineOrder", "lineOrder", 1);
    put(bytes, "", 1);
    put_attribute(bytes, "pixelAspectRatio", "float", 4);
    put_word(bytes, 0x3f800000);
    put_attribute(bytes, "screenWindowCenter", "v2f", 8);
    put_word(bytes, 0);
    put_word(bytes, 0);
    put_attribute(bytes, "screenWindowWidth", "float", 4);
    put_word(bytes, 0x3f800000);
    put(bytes, "", 1);
    const size_t table = bytes->size;
    for (uint32_t y = 0; y < height && height < 100; y++) {
        put_word(bytes, (uint32_t)(table + (size_t)8 * height + (size_t)y * (8 + line)));
        put_word(bytes, 0);
    }
    for (uint32_t y = 0; y < height && height < 100; y++) {
        put_word(bytes, (uint32_t)data[1] + y);
        put_word(bytes, line);
        for (size_t i = 0; i < count; i++) {
            for (uint32_t x = 0; x < width; x++) {
                const unsigned char sample[4] = {(unsigned char)channels[i].bits,
                                                 (unsigned char)(channels[i].bits >> 8),
                                                 (unsigned char)(channels[i].bits >> 16),
                                                 (unsigned char)(channels[i].bits >> 24)};
                put(bytes, sample, channels[i].type == 1 ? 2 : 4);
            }
        }
    }
}
