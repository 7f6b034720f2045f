/* Declares a writer of JSON. This header is part of kiln_program.h, which includes it. */
#ifndef KILN_JSON_H
#define KILN_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Styles of JSON. A caller names members and says where lines begin; the writer adds quotes, commas
 * and colons. These calls write {"frame": 7, "name": "campfire"}:
 *
 *     struct kiln_json json = kiln_json_to_file(stdout);
 *     kiln_json_begin_object(&json, NULL);
 *     kiln_json_uint(&json, "frame", 7);
 *     kiln_json_string(&json, "name", "campfire");
 *     kiln_json_end(&json);
 *     bool written = kiln_json_finish(&json);
 *
 * The text does not depend on the locale. Only the last call has to be checked: after a failure,
 * nothing more is written and `failed` stays true. */
enum kiln_json_style {
    KILN_JSON_SPACED, /* {"a": 1, "b": 2}; null stands for infinity and NaN */
    /* Fits into a <script> element of a page: {"a":1,"b":2} without '<', '>' and '&'. The strings
     * "inf", "-inf" and "nan" stand for what is no number in JSON. */
    KILN_JSON_SCRIPT
};

enum { KILN_JSON_MAX_DEPTH = 64 }; /* objects and arrays that may be open at a time */

/* An open object or array; only the writer looks into it. */
struct kiln_json_level {
    char bracket; /* its closing bracket; 0: this is the document */
    bool filled;  /* it has an item, after which there must be a comma */
    int spaces; /* indentation of items, each of which begins a line; -1: they go on in the line */
};

struct kiln_json {
    bool (*write)(void *sink, const char *bytes, size_t length); /* returns false on failure */
    void *sink;
    enum kiln_json_style style;
    bool one_line; /* no item begins a line, whatever the calls say */
    bool failed;   /* the sink failed, memory was short, or the calls made no JSON */
    /* The members below are the writer's own. */
    bool has_key; /* the key of the next value is written */
    int spaces;   /* indentation of the next item, which begins a line; -1: as the level says */
    size_t depth; /* number of open levels besides the document */
    struct kiln_json_level levels[KILN_JSON_MAX_DEPTH + 1];
};

/* Returns a writer to a stream, which the writer neither flushes nor closes. For another sink,
 * replace `write` and `sink`; `style` and `one_line` may be changed before the first value. */
struct kiln_json kiln_json_to_file(FILE *out);

/* Ends the document and its line; another document may follow. Returns false when anything failed
 * since the writer was made, or when something is still open. A stream may fail later, when it
 * writes what its buffer holds. */
bool kiln_json_finish(struct kiln_json *json);

/* Write a key alone, or open an object or array. `key` names a member of an object. It is NULL for
 * an entry of an array, for the document itself, and for the value after kiln_json_key, which
 * writes the key of a value that another function writes. In keys and strings, U+FFFD replaces each
 * byte that is not UTF-8. */
void kiln_json_key(struct kiln_json *json, const char *key);
void kiln_json_begin_object(struct kiln_json *json, const char *key);
void kiln_json_begin_array(struct kiln_json *json, const char *key);

/* Close the innermost object or array: kiln_json_end behind its last item, kiln_json_end_indented
 * on a line of its own with `spaces` before the bracket. An empty one is closed where it was
 * opened. */
void kiln_json_end(struct kiln_json *json);
void kiln_json_end_indented(struct kiln_json *json, int spaces);

/* Put items of the innermost object or array on lines of their own, with `spaces` before them:
 * kiln_json_indent_items all that follow, kiln_json_indent_next the next item alone. */
void kiln_json_indent_items(struct kiln_json *json, int spaces);
void kiln_json_indent_next(struct kiln_json *json, int spaces);

/* Write values. A string that is NULL is written as null. */
void kiln_json_string(struct kiln_json *json, const char *key, const char *value);
void kiln_json_format(struct kiln_json *json, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4))); /* writes a formatted string */
void kiln_json_bool(struct kiln_json *json, const char *key, bool value);
void kiln_json_null(struct kiln_json *json, const char *key);
void kiln_json_int(struct kiln_json *json, const char *key, int64_t value);
void kiln_json_uint(struct kiln_json *json, const char *key, uint64_t value);

/* Write numbers: kiln_json_number with the fewest digits that read back as the same value,
 * kiln_json_rounded with `digits` significant digits (at most 17), kiln_json_time with three
 * decimals, where a negative time becomes 0.000. */
void kiln_json_number(struct kiln_json *json, const char *key, double value);
void kiln_json_rounded(struct kiln_json *json, const char *key, double value, int digits);
void kiln_json_time(struct kiln_json *json, const char *key, double value);

/* Write a text that is JSON already; an array of two whole numbers; an array of strings. */
void kiln_json_raw(struct kiln_json *json, const char *key, const char *text);
void kiln_json_pair(struct kiln_json *json, const char *key, uint64_t first, uint64_t second);
void kiln_json_strings(struct kiln_json *json, const char *key, const char *const *values,
                       size_t count);

#endif
