/* This file reads ICC profiles that have a curve for each channel and a matrix (ICC.1:2022). The
 * profile comes from a stranger's file: every offset and count is checked before it is used. */
#include <string.h>

#include "decode.h"

enum {
    HEAD = 128,       /* bytes of the header; the number of tags follows */
    MOST_TAGS = 1024, /* real profiles have about 20 */
};

static uint32_t word(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* Returns a signed number of 16 bits and 16 bits of fraction. */
static double fixed(const uint8_t *at)
{
    return (double)(int32_t)word(at) / 65536.0;
}

struct tag {
    const uint8_t *bytes; /* NULL: the profile lacks it */
    size_t size;
};

static struct tag find_tag(const uint8_t *profile, size_t size, const char name[5])
{
    const uint32_t count = word(profile + HEAD);
    for (uint32_t i = 0; i < count && i < MOST_TAGS && HEAD + 4 + 12 * (size_t)(i + 1) <= size;
         i++) {
        const uint8_t *entry = profile + HEAD + 4 + 12 * (size_t)i;
        const size_t at = word(entry + 4), length = word(entry + 8);
        if (memcmp(entry, name, 4) == 0 && at <= size && length <= size - at && length >= 12)
            return (struct tag){profile + at, length};
    }
    return (struct tag){NULL, 0};
}

/* Reads a curve of the type 'curv': none, a power, or a table. */
static bool read_table(struct tag tag, struct kiln_curve *curve)
{
    const uint32_t count = word(tag.bytes + 8);
    if (count > (tag.size - 12) / 2)
        return false;
    *curve = kiln_power_curve(1.0f);
    if (count == 1)
        curve->gamma = (float)(tag.bytes[12] << 8 | tag.bytes[13]) / 256.0f;
    if (count >= 2) {
        curve->table = tag.bytes + 12;
        curve->count = count;
    }
    return true;
}

/* Reads a curve of the type 'para', of five kinds with 1 to 7 numbers. */
static bool read_numbers(struct tag tag, struct kiln_curve *curve)
{
    static const uint8_t counts[] = {1, 3, 4, 5, 7};
    const uint32_t kind = (uint32_t)tag.bytes[8] << 8 | tag.bytes[9];
    if (kind >= sizeof counts || tag.size < 12 + (size_t)4 * counts[kind])
        return false;
    float n[7] = {0};
    for (uint32_t i = 0; i < counts[kind]; i++)
        n[i] = (float)fixed(tag.bytes + 12 + (size_t)4 * i);
    *curve = (struct kiln_curve){.gamma = n[0], .a = kind > 0 ? n[1] : 1.0f, .b = n[2]};
    if (kind == 1 || kind == 2) { /* below the place where a x + b is 0 it is constant */
        if (n[1] == 0.0f)
            return false;
        curve->d = -n[2] / n[1];
        curve->e = curve->f = n[3];
    } else if (kind >= 3) {
        curve->c = n[3];
        curve->d = n[4];
        curve->e = n[5];
        curve->f = n[6];
    }
    return curve->gamma >= 0.0f && curve->gamma < 100.0f;
}

static bool read_curve(const uint8_t *profile, size_t size, const char name[5],
                       struct kiln_curve *curve)
{
    const struct tag tag = find_tag(profile, size, name);
    if (!tag.bytes)
        return false;
    if (memcmp(tag.bytes, "curv", 4) == 0)
        return read_table(tag, curve);
    return memcmp(tag.bytes, "para", 4) == 0 && read_numbers(tag, curve);
}

static enum decode_profile read_grey(const uint8_t *profile, size_t size, struct kiln_color *color)
{
    if (!read_curve(profile, size, "kTRC", &color->curves[0]))
        return DECODE_PROFILE_NONE;
    color->curves[1] = color->curves[2] = color->curves[0];
    memset(color->to_srgb, 0, sizeof color->to_srgb);
    for (int i = 0; i < 3; i++)
        color->to_srgb[i][i] = 1.0;
    return DECODE_PROFILE_COLOR;
}

static enum decode_profile read_rgb(const uint8_t *profile, size_t size, struct kiln_color *color)
{
    static const char columns[3][5] = {"rXYZ", "gXYZ", "bXYZ"};
    static const char curves[3][5] = {"rTRC", "gTRC", "bTRC"};
    double xyz[3][3];
    for (int i = 0; i < 3; i++) {
        const struct tag tag = find_tag(profile, size, columns[i]);
        if (!tag.bytes || tag.size < 20 || memcmp(tag.bytes, "XYZ ", 4) != 0 ||
            !read_curve(profile, size, curves[i], &color->curves[i]))
            return DECODE_PROFILE_NONE;
        for (int k = 0; k < 3; k++)
            xyz[k][i] = fixed(tag.bytes + 8 + 4 * (size_t)k);
    }
    return kiln_columns_to_srgb(xyz, color->to_srgb) ? DECODE_PROFILE_COLOR : DECODE_PROFILE_NONE;
}

enum decode_profile decode_icc(const uint8_t *profile, size_t size, uint32_t channels,
                               struct kiln_color *color)
{
    if (size < HEAD + 4 || memcmp(profile + 36, "acsp", 4) != 0)
        return DECODE_PROFILE_NONE;
    const char *space = channels == 1 ? "GRAY" : channels == 3 ? "RGB " : "CMYK";
    if (memcmp(profile + 16, space, 4) != 0)
        return DECODE_PROFILE_NONE;
    /* Tables say more than a matrix where a profile has both. */
    if (channels == 4 || find_tag(profile, size, "A2B0").bytes)
        return DECODE_PROFILE_TABLES;
    return channels == 1 ? read_grey(profile, size, color) : read_rgb(profile, size, color);
}
