/* Escapes the characters of a text that would act on a terminal or on the text around them, or that
 * nobody sees, and breaks markers of servers of continuous integration. The characters are Unicode
 * 15's general categories Cc, Zl, Zp and Zs but the usual space, and its properties "Bidi_Control"
 * and "Default_Ignorable_Code_Point". */
#include "base/shown.h"

#include <stdio.h>
#include <string.h>

#include "base/marker.h"
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

/* Writes how the first character of a text is shown, of at most 11 bytes. Returns the number of
 * bytes of the text that this stands for. */
static size_t show_character(const char *text, bool starts_line, char out[12])
{
    uint32_t character;
    const size_t length = kiln_shown_character(text, &character);
    const size_t before = kiln_marker_break(text, starts_line);
    if (before > 0)
        snprintf(out, 12, "%.*s ", (int)before, text);
    else if (length == 0 || kiln_shown_needs_escape(character))
        kiln_shown_escape(character, length == 0, out);
    else
        snprintf(out, 12, "%.*s", (int)length, text);
    return before > 0 ? before : length > 0 ? length : 1;
}

void kiln_shown(char *out, size_t room, const char *text)
{
    size_t used = 0;
    bool starts_line = true;
    while (*text) {
        char shown[12];
        const size_t length = show_character(text, starts_line, shown), size = strlen(shown);
        starts_line = kiln_marker_starts_line(*text, starts_line);
        if (used + size >= room)
            break;
        memcpy(out + used, shown, size);
        used += size;
        text += length;
    }
    if (room > 0)
        out[used] = '\0';
}
