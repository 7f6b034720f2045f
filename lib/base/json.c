/* This file writes JSON: manifests, journals, results, reports, and the events and output of the
 * program. No other file writes JSON's brackets, commas and quotes. Each open object or array
 * remembers whether it has an item, so that a comma comes before the next one, and the indentation
 * of its items. All bytes go straight to the sink, so a document is never held as a whole. */
#include "base/json.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/marker.h"
#include "base/shown.h"

static struct kiln_json start(bool (*write)(void *, const char *, size_t), void *sink)
{
    return (struct kiln_json){
        .write = write, .sink = sink, .spaces = -1, .levels = {{.spaces = -1}}};
}

static bool write_to_file(void *sink, const char *bytes, size_t length)
{
    return fwrite(bytes, 1, length, sink) == length;
}

struct kiln_json kiln_json_to_file(FILE *out)
{
    return start(write_to_file, out);
}

static bool write_to_text(void *sink, const char *bytes, size_t length)
{
    struct kiln_text *text = sink;
    kiln_text_add(text, "%.*s", (int)length, bytes);
    return !text->failed;
}

struct kiln_json kiln_json_to_text(struct kiln_text *text)
{
    return start(write_to_text, text);
}

static void put_bytes(struct kiln_json *json, const char *bytes, size_t length)
{
    if (!json->failed && length > 0)
        json->failed = !json->write(json->sink, bytes, length);
}

static void put(struct kiln_json *json, const char *text)
{
    put_bytes(json, text, strlen(text));
}

/* Returns whether an item or a bracket with this indentation begins a line; -1 is for none. */
static bool begins_line(const struct kiln_json *json, int spaces)
{
    return spaces >= 0 && !json->one_line;
}

/* Begins a line, with spaces before what follows. */
static void begin_line(struct kiln_json *json, int spaces)
{
    put(json, "\n");
    for (int i = 0; i < spaces; i++)
        put(json, " ");
}

/* Writes the escape sequence for the character, or the invalid byte, at c. Returns false if it
 * needs none. The first sign of a marker of a CI server is escaped, too: readers of JSON get the
 * same text. No string starts a line. */
static bool escape(const struct kiln_json *json, const char *c, char out[8])
{
    unsigned char byte = (unsigned char)*c;
    uint32_t character;
    const bool valid = kiln_shown_character(c, &character) > 0;
    bool markup = json->style == KILN_JSON_SCRIPT && strchr("<>&", *c) != NULL;
    if (!valid)
        snprintf(out, 8, "\\ufffd");
    else if (byte == '"' || byte == '\\')
        snprintf(out, 8, "\\%c", byte);
    else if (kiln_shown_needs_escape(character) || markup || kiln_marker_break(c, false) > 0)
        snprintf(out, 8, "\\u%04x", character);
    else
        return false;
    return true;
}

static void put_string(struct kiln_json *json, const char *string)
{
    char escaped[8];
    put(json, "\"");
    const char *plain = string; /* the text from here to c is not written yet */
    for (const char *c = string; *c;) {
        if (!escape(json, c, escaped)) {
            c += kiln_text_character_length(c);
            continue;
        }
        const size_t length = kiln_text_character_length(c);
        put_bytes(json, plain, (size_t)(c - plain));
        put(json, escaped);
        plain = c += length > 0 ? length : 1;
    }
    put(json, plain);
    put(json, "\"");
}

/* Writes the comma, the line break and the name that come before a value. */
static void begin_item(struct kiln_json *json, const char *key)
{
    struct kiln_json_level *level = &json->levels[json->depth];
    const bool needs_key = level->bracket == '}' && !json->has_key;
    const bool second_document = !level->bracket && level->filled;
    json->failed |= needs_key != (key != NULL) || second_document;
    if (json->has_key) {
        json->has_key = false;
        return;
    }
    const int spaces = json->spaces >= 0 ? json->spaces : level->spaces;
    put(json, level->filled ? "," : "");
    if (begins_line(json, spaces))
        begin_line(json, spaces);
    else
        put(json, level->filled && json->style == KILN_JSON_SPACED ? " " : "");
    level->filled = true;
    json->spaces = -1;
    if (key) {
        put_string(json, key);
        put(json, json->style == KILN_JSON_SPACED ? ": " : ":");
    }
}

static void begin_level(struct kiln_json *json, const char *key, const char *open, char bracket)
{
    begin_item(json, key);
    put(json, open);
    if (json->depth == KILN_JSON_MAX_DEPTH)
        json->failed = true;
    else
        json->levels[++json->depth] = (struct kiln_json_level){.bracket = bracket, .spaces = -1};
}

static void end_level(struct kiln_json *json, int spaces)
{
    const struct kiln_json_level *level = &json->levels[json->depth];
    if (json->depth == 0 || json->has_key) {
        json->failed = true;
        return;
    }
    if (level->filled && begins_line(json, spaces))
        begin_line(json, spaces);
    put_bytes(json, &level->bracket, 1);
    json->spaces = -1;
    json->depth--;
}

void kiln_json_key(struct kiln_json *json, const char *key)
{
    begin_item(json, key);
    json->has_key = true;
}

void kiln_json_begin_object(struct kiln_json *json, const char *key)
{
    begin_level(json, key, "{", '}');
}

void kiln_json_begin_array(struct kiln_json *json, const char *key)
{
    begin_level(json, key, "[", ']');
}

void kiln_json_end(struct kiln_json *json)
{
    end_level(json, -1);
}

void kiln_json_end_indented(struct kiln_json *json, int spaces)
{
    end_level(json, spaces);
}

void kiln_json_indent_items(struct kiln_json *json, int spaces)
{
    json->levels[json->depth].spaces = spaces;
}

void kiln_json_indent_next(struct kiln_json *json, int spaces)
{
    json->spaces = spaces;
}

bool kiln_json_finish(struct kiln_json *json)
{
    put(json, "\n");
    json->failed |= json->depth > 0 || json->has_key;
    json->levels[0].filled = false; /* so that another document may follow */
    return !json->failed;
}

/* ---- Values --------------------------------------------------------------------------------- */

void kiln_json_raw(struct kiln_json *json, const char *key, const char *text)
{
    begin_item(json, key);
    put(json, text);
}

void kiln_json_null(struct kiln_json *json, const char *key)
{
    kiln_json_raw(json, key, "null");
}

void kiln_json_bool(struct kiln_json *json, const char *key, bool value)
{
    kiln_json_raw(json, key, value ? "true" : "false");
}

void kiln_json_string(struct kiln_json *json, const char *key, const char *value)
{
    if (!value) {
        kiln_json_null(json, key);
        return;
    }
    begin_item(json, key);
    put_string(json, value);
}

void kiln_json_format(struct kiln_json *json, const char *key, const char *format, ...)
{
    char *value = NULL;
    va_list args;
    va_start(args, format);
    int length = vasprintf(&value, format, args);
    va_end(args);
    if (length < 0) {
        json->failed = true;
        return;
    }
    kiln_json_string(json, key, value);
    free(value);
}

void kiln_json_int(struct kiln_json *json, const char *key, int64_t value)
{
    char text[32];
    snprintf(text, sizeof text, "%" PRId64, value);
    kiln_json_raw(json, key, text);
}

void kiln_json_uint(struct kiln_json *json, const char *key, uint64_t value)
{
    char text[32];
    snprintf(text, sizeof text, "%" PRIu64, value);
    kiln_json_raw(json, key, text);
}

/* JSON has no numbers for infinities and NaN: the style SPACED writes null for them, and SCRIPT a
 * string. */
static void put_not_finite(struct kiln_json *json, const char *key, double value)
{
    if (json->style == KILN_JSON_SPACED)
        kiln_json_null(json, key);
    else
        kiln_json_string(json, key, isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
}

void kiln_json_number(struct kiln_json *json, const char *key, double value)
{
    char text[32];
    if (!isfinite(value)) {
        put_not_finite(json, key, value);
        return;
    }
    kiln_text_from_double(text, value);
    kiln_json_raw(json, key, text);
}

void kiln_json_rounded(struct kiln_json *json, const char *key, double value, int digits)
{
    char text[32];
    if (!isfinite(value)) {
        put_not_finite(json, key, value);
        return;
    }
    kiln_text_from_rounded(text, value, digits);
    kiln_json_raw(json, key, text);
}

void kiln_json_time(struct kiln_json *json, const char *key, double value)
{
    if (!(value < 1e15)) { /* NaN, or too large for whole thousandths */
        kiln_json_number(json, key, value);
        return;
    }
    /* The seconds and their thousandths are printed as whole numbers, since printf's decimal point
     * depends on the locale. */
    uint64_t thousandths = value > 0 ? (uint64_t)(value * 1000.0 + 0.5) : 0;
    char text[32];
    snprintf(text, sizeof text, "%" PRIu64 ".%03u", thousandths / 1000,
             (unsigned)(thousandths % 1000));
    kiln_json_raw(json, key, text);
}

void kiln_json_pair(struct kiln_json *json, const char *key, uint64_t first, uint64_t second)
{
    kiln_json_begin_array(json, key);
    kiln_json_uint(json, NULL, first);
    kiln_json_uint(json, NULL, second);
    kiln_json_end(json);
}

void kiln_json_strings(struct kiln_json *json, const char *key, const char *const *values,
                       size_t count)
{
    kiln_json_begin_array(json, key);
    for (size_t i = 0; i < count; i++)
        kiln_json_string(json, NULL, values[i]);
    kiln_json_end(json);
}
