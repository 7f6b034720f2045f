/* This file reads lines, words and numbers of text files.
 *
 * A decimal becomes a float by one rounding. It is computed in double, whose error is at most two
 * units in the last place there, and is rounded to float if that error cannot matter. Otherwise the
 * C library, which rounds correctly, decides. */
#include "words.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- lines ----------------------------------------------------------------------------------- */

struct decode_text decode_text_begin(const void *bytes, size_t size)
{
    struct decode_text text = {.at = bytes, .end = (const char *)bytes + size, .line_end = '\r'};
    if (size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0)
        text.at += 3;
    if (size > 0 && memchr(bytes, '\n', size))
        text.line_end = '\n';
    return text;
}

/* Returns whether a line that ends before `end` is joined with the next one. */
static bool is_joined(const char *start, const char *end)
{
    if (end > start && end[-1] == '\r')
        end--;
    return end > start && end[-1] == '\\';
}

bool decode_text_line(struct decode_text *text, struct decode_line *line)
{
    text->number += 1 + text->joined;
    text->joined = 0;
    if (text->at == text->end)
        return false;
    const char *start = text->at, *from = start, *end;
    for (;;) {
        end = memchr(from, text->line_end, (size_t)(text->end - from));
        if (!end || !text->joins_lines || !is_joined(start, end))
            break;
        from = end + 1;
        text->joined++;
    }
    *line = (struct decode_line){start, end ? end : text->end};
    text->at = end ? end + 1 : text->end;
    return true;
}

/* ---- words ----------------------------------------------------------------------------------- */

static bool is_blank(char c)
{
    return (unsigned char)c <= ' ';
}

bool decode_line_word(struct decode_line *line, struct decode_word *word)
{
    const char *at = line->at, *end = line->end;
    for (;;) {
        while (at < end && is_blank(*at))
            at++;
        const char *start = at;
        while (at < end && !is_blank(*at))
            at++;
        *word = (struct decode_word){start, (size_t)(at - start)};
        /* a backslash before the end of a line is a blank, if lines are joined */
        if (at < end && (*at == '\n' || *at == '\r') && at > start && at[-1] == '\\')
            word->length--;
        if (word->length > 0 || at == end)
            break;
    }
    line->at = at;
    return word->length > 0;
}

struct decode_word decode_line_rest(struct decode_line *line)
{
    struct decode_word first = {line->at, 0}, word;
    if (decode_line_word(line, &word)) {
        first = word;
        while (decode_line_word(line, &word))
            first.length = (size_t)(word.start + word.length - first.start);
    }
    return first;
}

bool decode_word_is(const struct decode_word *word, const char *text)
{
    return strlen(text) == word->length && memcmp(text, word->start, word->length) == 0;
}

bool decode_word_is_like(const struct decode_word *word, const char *text)
{
    for (size_t i = 0; i < word->length; i++) {
        const char c = word->start[i];
        if ((c >= 'A' && c <= 'Z' ? (char)(c + 'a' - 'A') : c) != text[i])
            return false;
    }
    return text[word->length] == '\0';
}

const char *decode_wide_encoding(const void *bytes, size_t size)
{
    static const char utf_16[] = "UTF-16", utf_32[] = "UTF-32";
    const unsigned char *b = bytes;
    if (size < 4)
        return NULL;
    if (memcmp(b, "\xff\xfe\0\0", 4) == 0 || memcmp(b, "\0\0\xfe\xff", 4) == 0)
        return utf_32;
    if (memcmp(b, "\xff\xfe", 2) == 0 || memcmp(b, "\xfe\xff", 2) == 0)
        return utf_16;
    if (b[0] != 0 && b[1] == 0 && b[2] != 0 && b[3] == 0) /* without a byte order mark */
        return utf_16;
    return b[0] == 0 && b[1] != 0 && b[2] == 0 && b[3] != 0 ? utf_16 : NULL;
}

/* ---- numbers --------------------------------------------------------------------------------- */

enum {
    MOST_POWER = 22,         /* of ten that a double holds exactly */
    MOST_EXPONENT = 1 << 20, /* where more digits of an exponent do not matter */
    LONGEST_NUMBER = 1023,
};

struct decimal {
    uint64_t digits;     /* the first 19 significant ones */
    int64_t exponent;    /* of ten */
    bool negative, more; /* more: other digits follow */
};

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Reads the digits before or behind the point. Returns whether there are any. Digits that do not
 * fit count as zeros. */
static bool take_digits(const char **at, const char *end, bool behind, struct decimal *out)
{
    const uint64_t full = 1000000000000000000;
    const char *start = *at;
    for (; *at < end && is_digit(**at); ++*at) {
        const bool fits = out->digits < full;
        if (fits)
            out->digits = out->digits * 10 + (uint64_t)(**at - '0');
        out->more = out->more || !fits;
        out->exponent += (behind ? 0 : 1) - (fits ? 1 : 0);
    }
    return *at > start;
}

/* Reads the exponent behind an "e". */
static bool take_exponent(const char **at, const char *end, struct decimal *out)
{
    const bool negative = *at < end && **at == '-';
    int64_t value = 0;
    if (*at < end && (**at == '-' || **at == '+'))
        ++*at;
    const char *start = *at;
    for (; *at < end && is_digit(**at); ++*at)
        value = value < MOST_EXPONENT ? value * 10 + (**at - '0') : value;
    out->exponent += negative ? -value : value;
    return *at > start;
}

static bool take_decimal(const char *at, const char *end, struct decimal *out)
{
    *out = (struct decimal){.negative = at < end && *at == '-'};
    if (at < end && (*at == '-' || *at == '+'))
        at++;
    bool any = take_digits(&at, end, false, out);
    if (at < end && *at == '.') {
        at++;
        any = take_digits(&at, end, true, out) || any;
    }
    if (any && at < end && (*at == 'e' || *at == 'E')) {
        at++;
        any = take_exponent(&at, end, out);
    }
    return any && at == end;
}

/* Rounds a decimal to float by way of double. False: the error of the double might matter. */
static bool round_quickly(const struct decimal *decimal, float *value)
{
    static const double powers[MOST_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const int64_t power = decimal->exponent < 0 ? -decimal->exponent : decimal->exponent;
    if (decimal->more || (power > MOST_POWER && decimal->digits != 0))
        return false;
    double exact = (double)decimal->digits;
    if (decimal->digits != 0)
        exact = decimal->exponent < 0 ? exact / powers[power] : exact * powers[power];
    /* The last 29 bits of a double do not fit into a float. Near their middle, rounding is left to
     * the library, as it is where floats have fewer bits or none. */
    const int64_t middle = 1 << 28, most_error = 4;
    uint64_t bits;
    memcpy(&bits, &exact, sizeof bits);
    const int64_t from_middle = (int64_t)(bits & (2 * (uint64_t)middle - 1)) - middle;
    if ((exact < 1e-37 && exact != 0) || exact > 1e38 ||
        (from_middle >= -most_error && from_middle <= most_error))
        return false;
    *value = (float)(decimal->negative ? -exact : exact);
    return true;
}

/* Lets the C library round a number. Only numbers that nobody writes are too long for it here. */
static bool round_slowly(const struct decode_word *word, float *value)
{
    char text[LONGEST_NUMBER + 1];
    locale_t c_locale =
        word->length <= LONGEST_NUMBER ? newlocale(LC_ALL_MASK, "C", (locale_t)0) : (locale_t)0;
    if (!c_locale)
        return false;
    memcpy(text, word->start, word->length);
    text[word->length] = '\0';
    *value = strtof_l(text, NULL, c_locale);
    freelocale(c_locale);
    return true;
}

/* Returns whether a word is one that C libraries print for infinity or for what is no number: inf,
 * nan, -nan(ind), 1.#IND00, 1.#QNAN. */
static bool is_no_number(const struct decode_word *word)
{
    const size_t sign = word->length > 0 && (word->start[0] == '-' || word->start[0] == '+');
    const struct decode_word three = {word->start + sign, 3};
    if (word->length - sign < 3)
        return false;
    return decode_word_is_like(&three, "inf") || decode_word_is_like(&three, "nan") ||
           (is_digit(three.start[0]) && memcmp(three.start + 1, ".#", 2) == 0);
}

bool decode_word_float(const struct decode_word *word, float *value)
{
    struct decimal decimal;
    if (take_decimal(word->start, word->start + word->length, &decimal))
        return round_quickly(&decimal, value) || round_slowly(word, value);
    *value = NAN;
    return is_no_number(word);
}

bool decode_word_integer(const struct decode_word *word, int64_t *value)
{
    enum { MOST_DIGITS = 18 };
    const bool negative = word->length > 0 && word->start[0] == '-';
    const size_t sign = negative || (word->length > 0 && word->start[0] == '+');
    if (word->length <= sign || word->length > sign + MOST_DIGITS)
        return false;
    int64_t number = 0;
    for (size_t i = sign; i < word->length; i++) {
        if (!is_digit(word->start[i]))
            return false;
        number = number * 10 + (word->start[i] - '0');
    }
    *value = negative ? -number : number;
    return true;
}
