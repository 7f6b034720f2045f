/* Refuses texts with characters that the font of figures lacks. The font would draw a box for such
 * a character, which might be noticed only in print. */
#include "figure/lettering.h"

#include "base/error.h"
#include "base/text.h"
#include "figure/font.h"

enum { PLACE_SIZE = 320 };

bool kiln_lettering_check(const char *text, const char *place, struct kiln_error *error)
{
    uint32_t code, count = 1;
    const char *found = kiln_font_missing(text, &code);
    if (!found)
        return true;
    for (const char *c = text; c < found; count++)
        kiln_font_next(&c);
    size_t length = kiln_text_character_length(found);
    if (length == 0)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: character %u: found the byte %02x, which is not UTF-8", place,
                              count, (unsigned char)*found);
    return kiln_error_set(
        error, KILN_USAGE,
        "%s: character %u: found '%.*s' (U+%04X), for which figures have no glyph; they have "
        "glyphs for Latin, Greek, dashes, quotes and mathematics",
        place, count, (int)length, found, code);
}

bool kiln_lettering_check_label(const char *label, size_t panel, struct kiln_error *error)
{
    char place[PLACE_SIZE];
    snprintf(place, sizeof place, "the label of panel %zu, '%.200s' (--label sets another one)",
             panel + 1, label);
    return kiln_lettering_check(label, place, error);
}

/* Checks that the text of --alt is UTF-8. It is not drawn, so it may be in any script. */
static bool check_utf8(const char *text, struct kiln_error *error)
{
    const char *c = text;
    for (size_t length; *c; c += length) {
        length = kiln_text_character_length(c);
        if (length == 0)
            return kiln_error_set(
                error, KILN_USAGE,
                "--alt: found the byte %02x behind %zu others, which is not UTF-8",
                (unsigned char)*c, (size_t)(c - text));
    }
    return true;
}

bool kiln_lettering_check_request(const struct kiln_figure_params *params, struct kiln_error *error)
{
    if (params->title && !kiln_lettering_check(params->title, "--title", error))
        return false;
    if (params->alt && !check_utf8(params->alt, error))
        return false;
    for (size_t i = 0; i < params->label_count; i++) {
        char place[PLACE_SIZE];
        snprintf(place, sizeof place, "--label '%.200s'", params->labels[i]);
        if (!kiln_lettering_check(params->labels[i], place, error))
            return false;
    }
    return true;
}
