/* Escapes the characters of a text that would act on a terminal or on the text around them. These
 * are Unicode 15's general categories Cc, Zl and Zp and its property "Bidi_Control". */
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
    return c < 0x20 || (c >= 0x7f && c <= 0x9f) || c == 0x61c || c == 0x200e || c == 0x200f ||
           (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
}

static void escape(uint32_t character, bool is_byte, char out[12])
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
            escape(character, length == 0, escaped);
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
