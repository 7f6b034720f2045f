/* This file reads a JSON text into a list of values, in the order in which they begin. The list
 * comes from one pass without recursion, since an untrusted file decides how deep it is nested. */
#include "json.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "decode.h"

/* ---- reading --------------------------------------------------------------------------------- */

/* What may come next in the text. */
enum expected {
    A_VALUE,
    A_VALUE_OR_END, /* after '[' */
    A_KEY,
    A_KEY_OR_END, /* after '{' */
    A_COMMA_OR_END,
    NOTHING,
};

struct reading {
    struct json *json;
    size_t size, at;
    uint32_t open; /* the innermost object or array that has not ended; JSON_NONE: none */
    enum expected expected;
    struct kiln_error *error;
};

static bool refuse(const struct reading *r)
{
    size_t line = 1;
    for (size_t i = 0; i < r->at && i < r->size; i++)
        line += r->json->text[i] == '\n';
    if (r->at >= r->size)
        return kiln_error_set(r->error, KILN_INVALID_INPUT, "the JSON is cut short");
    return kiln_error_set(r->error, KILN_INVALID_INPUT, "line %zu of the JSON is broken", line);
}

static struct json_value *add(struct reading *r, uint32_t kind)
{
    struct json *json = r->json;
    if (json->count == json->capacity) {
        /* a value takes a byte of the text or more, so the sum stays below 2^32 */
        json->capacity = json->capacity + json->capacity / 2 + 64;
        struct json_value *more = realloc(json->values, json->capacity * sizeof *more);
        if (!more) {
            decode_out_of_memory(r->error);
            return NULL;
        }
        json->values = more;
    }
    struct json_value *value = &json->values[json->count++];
    *value = (struct json_value){
        .start = (uint32_t)r->at, .end = (uint32_t)r->at, .next = json->count, .kind = kind};
    return value;
}

static bool is_space(char c)
{
    return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Adds a string; escapes are checked when it is decoded. */
static bool read_string(struct reading *r)
{
    const char *text = r->json->text;
    r->at++;
    struct json_value *value = add(r, '"');
    if (!value)
        return false;
    for (; r->at < r->size && text[r->at] != '"'; r->at++) {
        if ((unsigned char)text[r->at] < ' ')
            return refuse(r);
        if (text[r->at] == '\\')
            r->at++;
    }
    if (r->at >= r->size)
        return refuse(r);
    value->end = (uint32_t)r->at++;
    return true;
}

static size_t skip_digits(const struct reading *r, size_t at)
{
    while (at < r->size && is_digit(r->json->text[at]))
        at++;
    return at;
}

static bool read_number(struct reading *r)
{
    const char *text = r->json->text;
    struct json_value *value = add(r, '0');
    if (!value)
        return false;
    size_t at = r->at + (text[r->at] == '-');
    const bool has_zero = at < r->size && text[at] == '0';
    size_t end = has_zero ? at + 1 : skip_digits(r, at);
    bool good = end > at;
    if (end < r->size && text[end] == '.') {
        at = end + 1;
        end = skip_digits(r, at);
        good = good && end > at;
    }
    if (end < r->size && (text[end] == 'e' || text[end] == 'E')) {
        at = end + 1;
        at += at < r->size && (text[at] == '+' || text[at] == '-');
        end = skip_digits(r, at);
        good = good && end > at;
    }
    if (good) {
        value->end = (uint32_t)end;
        r->at = end;
    }
    return good || refuse(r);
}

static bool read_word(struct reading *r)
{
    static const char *const words[] = {"true", "false", "null"};
    for (size_t i = 0; i < 3; i++) {
        const size_t length = strlen(words[i]);
        if (r->size - r->at >= length && memcmp(r->json->text + r->at, words[i], length) == 0) {
            struct json_value *value = add(r, (uint32_t)(unsigned char)words[i][0]);
            r->at += length;
            if (value)
                value->end = (uint32_t)r->at;
            return value != NULL;
        }
    }
    return refuse(r);
}

/* Begins an object or an array. While it is open, its `end` is the number of the one around it. */
static bool open_list(struct reading *r, char kind)
{
    struct json_value *value = add(r, (uint32_t)(unsigned char)kind);
    if (!value)
        return false;
    value->end = r->open;
    r->open = r->json->count - 1;
    r->at++;
    r->expected = kind == '{' ? A_KEY_OR_END : A_VALUE_OR_END;
    return true;
}

static void close_list(struct reading *r)
{
    struct json_value *value = &r->json->values[r->open];
    r->open = value->end;
    r->at++;
    value->end = (uint32_t)r->at;
    value->next = r->json->count;
    r->expected = r->open == JSON_NONE ? NOTHING : A_COMMA_OR_END;
}

static bool read_value(struct reading *r)
{
    const char c = r->json->text[r->at];
    if (c == '{' || c == '[')
        return open_list(r, c);
    const bool ok = c == '"'                  ? read_string(r)
                    : c == '-' || is_digit(c) ? read_number(r)
                                              : read_word(r);
    r->expected = r->open == JSON_NONE ? NOTHING : A_COMMA_OR_END;
    return ok;
}

static void skip_spaces(struct reading *r)
{
    while (r->at < r->size && is_space(r->json->text[r->at]))
        r->at++;
}

static bool read_key(struct reading *r)
{
    if (r->json->text[r->at] != '"')
        return refuse(r);
    if (!read_string(r))
        return false;
    skip_spaces(r);
    if (r->at >= r->size || r->json->text[r->at] != ':')
        return refuse(r);
    r->at++;
    r->expected = A_VALUE;
    return true;
}

static bool read_next(struct reading *r)
{
    const char c = r->json->text[r->at];
    const bool in_object = r->open != JSON_NONE && r->json->values[r->open].kind == '{';
    if (r->open != JSON_NONE && c == (in_object ? '}' : ']') &&
        (r->expected == A_KEY_OR_END || r->expected == A_VALUE_OR_END ||
         r->expected == A_COMMA_OR_END)) {
        close_list(r);
        return true;
    }
    switch (r->expected) {
    case A_VALUE:
    case A_VALUE_OR_END:
        return read_value(r);
    case A_KEY:
    case A_KEY_OR_END:
        return read_key(r);
    case A_COMMA_OR_END:
        if (c != ',')
            return refuse(r);
        r->at++;
        r->expected = in_object ? A_KEY : A_VALUE;
        return true;
    case NOTHING:
        break;
    }
    return refuse(r);
}

bool json_init(struct json *json, const char *text, size_t size, struct kiln_error *error)
{
    static const char mark[3] = {'\xef', '\xbb', '\xbf'};
    *json = (struct json){.text = text};
    struct reading r = {.json = json, .size = size, .open = JSON_NONE, .error = error};
    if (size > UINT32_MAX - 1)
        return kiln_error_set(error, KILN_INVALID_INPUT, "the JSON is longer than 4 GiB");
    if (size >= sizeof mark && memcmp(text, mark, sizeof mark) == 0)
        r.at = sizeof mark; /* the byte order mark that some editors write */
    for (;;) {
        skip_spaces(&r);
        if (r.at >= size)
            return r.expected == NOTHING || refuse(&r);
        if (!read_next(&r))
            return false;
    }
}

void json_finish(struct json *json)
{
    free(json->values);
    *json = (struct json){.text = NULL};
}

/* ---- lists ----------------------------------------------------------------------------------- */

static bool has_kind(const struct json *json, uint32_t value, char kind)
{
    return value < json->count && json->values[value].kind == (uint32_t)(unsigned char)kind;
}

bool json_is_object(const struct json *json, uint32_t value)
{
    return has_kind(json, value, '{');
}

bool json_is_array(const struct json *json, uint32_t value)
{
    return has_kind(json, value, '[');
}

bool json_is_true(const struct json *json, uint32_t value)
{
    return has_kind(json, value, 't');
}

uint32_t json_first(const struct json *json, uint32_t list)
{
    if (!json_is_object(json, list) && !json_is_array(json, list))
        return JSON_NONE;
    return json->values[list].next > list + 1 ? list + 1 : JSON_NONE;
}

uint32_t json_value_of(uint32_t key)
{
    return key == JSON_NONE ? JSON_NONE : key + 1;
}

uint32_t json_after(const struct json *json, uint32_t list, uint32_t value)
{
    const uint32_t last = json_is_object(json, list) ? json_value_of(value) : value;
    const uint32_t next = json->values[last].next;
    return next < json->values[list].next ? next : JSON_NONE;
}

uint32_t json_count(const struct json *json, uint32_t array)
{
    uint32_t count = 0;
    if (!json_is_array(json, array))
        return 0;
    for (uint32_t i = json_first(json, array); i != JSON_NONE; i = json_after(json, array, i))
        count++;
    return count;
}

uint32_t json_member(const struct json *json, uint32_t object, const char *key)
{
    uint32_t found = JSON_NONE;
    if (!json_is_object(json, object))
        return JSON_NONE;
    for (uint32_t i = json_first(json, object); i != JSON_NONE; i = json_after(json, object, i)) {
        if (json_is(json, i, key))
            found = json_value_of(i);
    }
    return found;
}

/* ---- values ---------------------------------------------------------------------------------- */

bool json_number(const struct json *json, uint32_t value, double *number)
{
    char text[64];
    if (!has_kind(json, value, '0'))
        return false;
    const struct json_value *v = &json->values[value];
    const size_t length = v->end - v->start;
    if (length >= sizeof text)
        return false;
    memcpy(text, json->text + v->start, length);
    text[length] = '\0';
    const double read = strtod(text, NULL); /* the process has the locale "C" */
    *number = read;
    return read - read == 0.0;
}

bool json_index(const struct json *json, uint32_t value, uint32_t *number)
{
    double read = 0.0;
    if (!json_number(json, value, &read) || !(read >= 0.0 && read < (double)UINT32_MAX))
        return false;
    *number = (uint32_t)read;
    return (double)*number == read;
}

static int hex_of(char c)
{
    return is_digit(c)            ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Reads the four digits of an escape such as \u0041; -1: there are none. */
static long read_hex(const char *text, const char *end)
{
    long code = 0;
    if (end - text < 4)
        return -1;
    for (int i = 0; i < 4; i++) {
        const int digit = hex_of(text[i]);
        if (digit < 0)
            return -1;
        code = code * 16 + digit;
    }
    return code;
}

enum { REPLACEMENT = 0xfffd };

/* Reads the escape after a backslash, and returns its character. */
static uint32_t read_escape(const char **at, const char *end)
{
    static const char names[] = "bfnrt", meant[] = "\b\f\n\r\t";
    const char c = *(*at)++;
    const char *name = c ? strchr(names, c) : NULL;
    if (c != 'u')
        return name ? (uint32_t)(unsigned char)meant[name - names] : (uint32_t)(unsigned char)c;
    const long high = read_hex(*at, end);
    if (high < 0)
        return REPLACEMENT;
    *at += 4;
    const bool paired =
        high >= 0xd800 && high < 0xdc00 && end - *at >= 6 && (*at)[0] == '\\' && (*at)[1] == 'u';
    const long low = paired ? read_hex(*at + 2, end) : -1;
    if (low >= 0xdc00 && low < 0xe000) {
        *at += 6;
        return (uint32_t)(0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00));
    }
    return high >= 0xd800 && high < 0xe000 ? REPLACEMENT : (uint32_t)high;
}

/* Writes a character as UTF-8; returns the number of bytes. */
static size_t put_character(uint32_t code, char out[4])
{
    if (code == 0)
        code = REPLACEMENT;
    if (code < 0x80) {
        out[0] = (char)code;
        return 1;
    }
    const size_t more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    static const unsigned first[] = {0, 0xc0, 0xe0, 0xf0};
    out[0] = (char)(first[more] | code >> 6 * more);
    for (size_t i = 1; i <= more; i++)
        out[i] = (char)(0x80 | (code >> 6 * (more - i) & 0x3f));
    return more + 1;
}

size_t json_text(const struct json *json, uint32_t value, char *text, size_t size)
{
    size_t length = 0;
    text[0] = '\0';
    if (!has_kind(json, value, '"'))
        return 0;
    const struct json_value *v = &json->values[value];
    const char *at = json->text + v->start, *end = json->text + v->end;
    bool fits = true;
    while (at < end) {
        char character[4] = {*at++};
        size_t bytes = 1;
        if (character[0] == '\\' && at < end)
            bytes = put_character(read_escape(&at, end), character);
        fits = fits && length + bytes < size;
        if (fits) {
            memcpy(text + length, character, bytes);
            text[length + bytes] = '\0';
        }
        length += bytes;
    }
    return length;
}

bool json_is(const struct json *json, uint32_t value, const char *text)
{
    char own[64];
    if (!has_kind(json, value, '"'))
        return false;
    const struct json_value *v = &json->values[value];
    const size_t length = strlen(text);
    const char *start = json->text + v->start;
    if (!memchr(start, '\\', v->end - v->start))
        return v->end - v->start == length && memcmp(start, text, length) == 0;
    return json_text(json, value, own, sizeof own) == length && length < sizeof own &&
           strcmp(own, text) == 0;
}
