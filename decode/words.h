/* Declares readers of text: lines, the words in them, and numbers. Nothing here depends on the
 * locale, and text need not end with a zero. */
#ifndef KILN_DECODE_WORDS_H
#define KILN_DECODE_WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct decode_text {
    const char *at, *end;
    size_t number; /* of the line that was taken last, from 1 */
    char line_end; /* '\n', or '\r' in a file without any '\n' */
    /* a backslash at the end of a line joins the next line to it, as in OBJ; the number is that of
     * the first line */
    bool joins_lines;
    size_t joined; /* lines that the last one took beyond its first */
};

struct decode_line {
    const char *at, *end;
};

/* A word is a run of characters that are no blanks. */
struct decode_word {
    const char *start;
    size_t length;
};

/* Begins to read a text, behind a byte order mark of UTF-8. */
struct decode_text decode_text_begin(const void *bytes, size_t size);

/* Takes the next line. False: there is none. */
bool decode_text_line(struct decode_text *text, struct decode_line *line);

/* Takes the next word of a line. False: there is none. */
bool decode_line_word(struct decode_line *line, struct decode_word *word);

/* Takes the rest of a line, without blanks around it: names may have blanks in them. */
struct decode_word decode_line_rest(struct decode_line *line);

bool decode_word_is(const struct decode_word *word, const char *text);

/* Compares without regard to the case of ASCII letters. `text` is in lower case. */
bool decode_word_is_like(const struct decode_word *word, const char *text);

/* Rounds a decimal to the nearest float, once. Words for infinity and for what is no number, as C
 * libraries print them, are read as NaN. False: the word is not a number. */
bool decode_word_float(const struct decode_word *word, float *value);

/* Reads an integer of at most 18 digits with an optional sign. False: the word is none. */
bool decode_word_integer(const struct decode_word *word, int64_t *value);

/* Returns the name of the encoding if a text is in UTF-16 or UTF-32, which no mesh is written in;
 * else NULL. */
const char *decode_wide_encoding(const void *bytes, size_t size);

#endif
