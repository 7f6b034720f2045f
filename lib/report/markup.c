/* Writes templates, text, URLs and base64 into pages. Text goes character by character to the
 * stream, which has a buffer: pages are large, and no copy of them is held. */
#include "report/markup.h"

#include <string.h>

#include "base/error.h"
#include "base/marker.h"
#include "base/shown.h"
#include "base/text.h"

static const struct kiln_markup_field *find_field(const struct kiln_markup_field *fields,
                                                  const char *name, size_t length)
{
    for (; fields->name; fields++)
        if (strlen(fields->name) == length && memcmp(fields->name, name, length) == 0)
            return fields;
    return NULL;
}

bool kiln_markup_write_template(FILE *out, const char *text, const struct kiln_markup_field *fields,
                                struct kiln_error *error)
{
    for (;;) {
        const char *begin = strstr(text, "{{");
        if (!begin) {
            fputs(text, out);
            return true;
        }
        fwrite(text, 1, (size_t)(begin - text), out);
        const char *name = begin + 2, *end = strstr(name, "}}");
        if (!end)
            return kiln_error_set(error, KILN_USAGE, "template: '{{' without '}}': %.40s", begin);
        const struct kiln_markup_field *field = find_field(fields, name, (size_t)(end - name));
        if (!field)
            return kiln_error_set(error, KILN_USAGE, "template: unknown field '%.*s'",
                                  (int)(end - name), name);
        field->write(out, field->user);
        text = end + 2;
    }
}

const char *kiln_markup_entity(char c)
{
    switch (c) {
    case '&':
        return "&amp;";
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '"':
        return "&quot;";
    case '\'':
        return "&#39;";
    default:
        return NULL;
    }
}

/* Returns whether a text begins with a character that XML does not have (controls, U+FFFE and
 * U+FFFF), or with one that changes how a page shows the text around it (overrides of direction, C1
 * controls). */
static bool is_foreign(const char *text)
{
    unsigned char c = (unsigned char)*text;
    uint32_t character;
    if (kiln_shown_character(text, &character) > 1 && kiln_shown_needs_escape(character))
        return true;
    return (c < 0x20 && c != '\n' && c != '\t') || c == 0x7f ||
           strncmp(text, "\xef\xbf\xbe", 3) == 0 || strncmp(text, "\xef\xbf\xbf", 3) == 0;
}

void kiln_markup_write_text(FILE *out, const char *text)
{
    bool starts_line = true;
    while (*text) {
        size_t length = kiln_text_character_length(text);
        const char *entity = kiln_markup_entity(*text);
        const size_t marker = kiln_marker_break(text, starts_line);
        starts_line = kiln_marker_starts_line(*text, starts_line);
        if (length == 0 || is_foreign(text))
            fputs("\xef\xbf\xbd", out);
        else if (marker > 0) /* a page may go to standard output; a browser shows the same text */
            fprintf(out, "&#%d;", *text);
        else if (entity)
            fputs(entity, out);
        else
            fwrite(text, 1, length, out);
        text += length ? length : 1;
    }
}

void kiln_markup_write_url(FILE *out, const char *path)
{
    /* A colon is encoded, since in the first part of a path it would make a scheme. */
    static const char plain[] = "-._~/";
    for (; *path; path++) {
        unsigned char c = (unsigned char)*path;
        bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (letter || strchr(plain, c))
            fputc(c, out);
        else
            fprintf(out, "%%%02X", c);
    }
}

void kiln_markup_write_base64(FILE *out, const void *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *in = bytes;
    char block[4 * 1024];
    size_t used = 0;
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        unsigned bits = (unsigned)in[i] << 16 | (left > 1 ? (unsigned)in[i + 1] << 8 : 0) |
                        (left > 2 ? in[i + 2] : 0u);
        block[used++] = digits[bits >> 18];
        block[used++] = digits[bits >> 12 & 63];
        block[used++] = '=';
        block[used++] = '=';
        if (left > 1)
            block[used - 2] = digits[bits >> 6 & 63];
        if (left > 2)
            block[used - 1] = digits[bits & 63];
        if (used == sizeof block) {
            fwrite(block, 1, used, out);
            used = 0;
        }
    }
    fwrite(block, 1, used, out);
}
