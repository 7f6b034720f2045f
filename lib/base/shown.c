/* Escapes the characters of a text that would act on a terminal or on the text around them, or that
 * nobody sees. These are Unicode 15's general categories Cc, Zl, Zp and Zs but the usual space, and
 * its properties "Bidi_Control" and "Default_Ignorable_Code_Point". */
#include "base/shown.h"

#include <stdio.h>
#include <string.h>

#include "base/text.h"

size_t kiln_shown_character(const char *text, uint32_t *character)
{
    static const uint8_t payload[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
    const unsigned char *bytes = (const unsigned char *)text;
    const size_t length = kiln_text_character_length(text);
    *character = bytes[0];
    if (length == 0)
        return 0;
    *character &= payload[length];
    for (size_t i = 1; i < length; i++)
        *character = *character << 6 | (bytes[i] & 0x3f);
    return length;
}

bool kiln_shown_needs_escape(uint32_t c)
{
    static const uint32_t ranges[][2] = {
        {0x0, 0x1f},        {0x7f, 0xa0},     {0xad, 0xad},       {0x34f, 0x34f},
        {0x61c, 0x61c},     {0x115f, 0x1160}, {0x1680, 0x1680},   {0x17b4, 0x17b5},
        {0x180b, 0x180f},   {0x2000, 0x200f}, {0x2028, 0x202f},   {0x205f, 0x206f},
        {0x3000, 0x3000},   {0x3164, 0x3164}, {0xfe00, 0xfe0f},   {0xfeff, 0xfeff},
        {0xffa0, 0xffa0},   {0xfff0, 0xfff8}, {0x1bca0, 0x1bca3}, {0x1d173, 0x1d17a},
        {0xe0000, 0xe0fff},
    };
    bool needs = false;
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        needs = needs || (c >= ranges[i][0] && c <= ranges[i][1]);
    return needs;
}

void kiln_shown_escape(uint32_t character, bool is_byte, char out[12])
{
    if (character == '\n' || character == '\r' || character == '\t')
        snprintf(out, 12, "\\%c", character == '\n' ? 'n' : character == '\r' ? 'r' : 't');
    else if (is_byte || character < 0x80)
        snprintf(out, 12, "\\x%02x", character);
    else
        snprintf(out, 12, "\\u%04x", character);
}

void kiln_shown(char *out, size_t room, const char *text)
{
    size_t used = 0;
    while (*text) {
        char escaped[12];
        uint32_t character;
        size_t length = kiln_shown_character(text, &character);
        const bool escapes = length == 0 || kiln_shown_needs_escape(character);
        if (escapes)
            kiln_shown_escape(character, length == 0, escaped);
        const char *piece = escapes ? escaped : text;
        const size_t size = escapes ? strlen(escaped) : length;
        if (used + size >= room)
            break;
        memcpy(out + used, piece, size);
        used += size;
        text += length ? length : 1;
    }
    if (room > 0)
        out[used] = '\0';
}
