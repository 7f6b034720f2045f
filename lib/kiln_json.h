/* Declares a writer of JSON. This header is part of kiln_program.h, which includes it. */
#ifndef KILN_JSON_H
#define KILN_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Writing JSON. The caller names members and says where lines begin; the writer adds quotes, commas
 * and colons. These calls write {"frame": 7, "name": "campfire"}:
 *
 *     struct kiln_json json = kiln_json_to_file(stdout);
 *     kiln_json_begin_object(&json, NULL);
 *     kiln_json_uint(&json, "frame", 7);
 *     kiln_json_string(&json, "name", "campfire");
 *     kiln_json_end(&json);
 *     bool written = kiln_json_finish(&json);
 *
 * Nothing depends on the locale. No call but the last has to be checked: after a failure nothing
 * more is written, and `failed` stays true. */
enum kiln_json_style {
    KILN_JSON_SPACED, /* {"a": 1, "b": 2}; null stands for infinity and NaN */
    /* Fits into a <script> element of a page: {"a":1,"b":2} without '<', '>' and '&'. The strings
     * "inf", "-inf" and "nan" stand for what is no number in JSON. */
    KILN_JSON_SCRIPT
};

enum { KILN_JSON_MAX_DEPTH = 64 }; /* objects and arrays that may be open at a time */

/* An open object or array; only the writer looks into it. */
struct kiln_json_level {
    char bracket; /* the one that closes it; 0: this is the document */
    bool filled;  /* has an item, after which there must be a comma */
    int spaces;   /* before each item, which begins a line; -1: items go on in the line */
};

struct kiln_json {
    bool (*write)(void *sink, const char *bytes, size_t length); /* false: it could not */
    void *sink;
    enum kiln_json_style style;
    bool one_line; /* no item begins a line, whatever the calls say */
    bool failed;   /* the sink, or for want of memory, or the calls made no JSON */
    bool has_key;  /* the writer's own, as the rest: the name of the next value is written */
    int spaces;    /* before the next item; -1: as the level says */
    size_t depth;
    struct kiln_json_level levels[KILN_JSON_MAX_DEPTH + 1];
};

/* A writer to a stream, which it neither flushes nor closes. For another sink, replace `write` and
 * `sink`; `style` and `one_line` may be changed before anything is written. */
struct kiln_json kiln_json_to_file(FILE *out);

/* Ends the document and its line; another document may follow. Returns false when anything failed
 * since the writer was made, or when something is still open. A stream may fail later, when it
 * writes what its buffer holds. */
bool kiln_json_finish(struct kiln_json *json);

/* `key` names a member of an object. It is NULL for an entry of an array, for the document itself
 * and for the value after kiln_json_key, with which a caller names what another function writes. In
 * keys and strings U+FFFD stands for each byte that is no UTF-8. */
void kiln_json_key(struct kiln_json *json, const char *key);
void kiln_json_begin_object(struct kiln_json *json, const char *key);
void kiln_json_begin_array(struct kiln_json *json, const char *key);

/* Closes the innermost object or array: behind its last item, or on a line of its own with so many
 * spaces before the bracket. An empty one is always closed where it was opened. */
void kiln_json_end(struct kiln_json *json);
void kiln_json_end_line(struct kiln_json *json, int spaces);

/* From here on each item of the innermost object or array has a line of its own, with so many
 * spaces before it; kiln_json_line is for the next item alone. */
void kiln_json_lines(struct kiln_json *json, int spaces);
void kiln_json_line(struct kiln_json *json, int spaces);

/* Values. A string that is NULL is written as null. */
void kiln_json_string(struct kiln_json *json, const char *key, const char *value);
void kiln_json_format(struct kiln_json *json, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4))); /* a string */
void kiln_json_bool(struct kiln_json *json, const char *key, bool value);
void kiln_json_null(struct kiln_json *json, const char *key);
void kiln_json_int(struct kiln_json *json, const char *key, int64_t value);
void kiln_json_uint(struct kiln_json *json, const char *key, uint64_t value);

/* Numbers: in the fewest digits that read back as the same; rounded to so many significant digits
 * (at most 17); a time to three decimals, a negative one as 0.000. */
void kiln_json_number(struct kiln_json *json, const char *key, double value);
void kiln_json_rounded(struct kiln_json *json, const char *key, double value, int digits);
void kiln_json_time(struct kiln_json *json, const char *key, double value);

/* A text that is JSON already; an array of two whole numbers; one of strings. */
void kiln_json_raw(struct kiln_json *json, const char *key, const char *text);
void kiln_json_pair(struct kiln_json *json, const char *key, uint64_t first, uint64_t second);
void kiln_json_strings(struct kiln_json *json, const char *key, const char *const *values,
                       size_t count);

#endif
