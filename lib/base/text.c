/* Reads and writes numbers, suggests the name that a misspelt one may have meant, and adds to text
 * buffers that grow: formatted text, JSON strings and words for a shell. Numbers are read and
 * written in the C locale, whatever locale the process has set, so that a scene means the same
 * everywhere. */
#include "base/text.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json.h"
#include "base/shown.h"

bool kiln_text_to_double(const char *text, double *value)
{
    /* strtod also takes leading blanks, hexadecimal, "inf" and "nan", none of which is a number in
     * a scene. */
    if (strspn(text, "+-.0123456789eE") != strlen(text) || *text == '\0')
        return false;
    locale_t c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!c_locale)
        return false;
    char *end = NULL;
    double result = strtod_l(text, &end, c_locale);
    freelocale(c_locale);
    if (end == text || *end != '\0' || !isfinite(result))
        return false;
    *value = result;
    return true;
}

bool kiln_text_to_uint64(const char *text, uint64_t *value)
{
    size_t length = strlen(text);
    if (length == 0 || length > 20 || strspn(text, "0123456789") != length)
        return false;
    errno = 0;
    unsigned long long result = strtoull(text, NULL, 10);
    if (errno != 0)
        return false;
    *value = result;
    return true;
}

void kiln_text_from_rounded(char out[32], double value, int digits)
{
    locale_t c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    locale_t old = c_locale ? uselocale(c_locale) : (locale_t)0;
    snprintf(out, 32, "%.*g", digits, value);
    if (c_locale) {
        uselocale(old);
        freelocale(c_locale);
    }
}

void kiln_text_from_float(char out[32], float value)
{
    for (int digits = 6; digits <= 9; digits++) {
        double read = 0;
        kiln_text_from_rounded(out, (double)value, digits);
        if (kiln_text_to_double(out, &read) && (float)read == value)
            return;
    }
}

void kiln_text_from_double(char out[32], double value)
{
    for (int digits = 6; digits <= 17; digits++) {
        double read = 0;
        kiln_text_from_rounded(out, value, digits);
        if (kiln_text_to_double(out, &read) && read == value)
            return;
    }
}

enum { MAX_NAME = 64 };

/* Computes the optimal string alignment distance: the least number of edits that turn one name into
 * the other, where an edit inserts, deletes or replaces a character or swaps two adjacent ones. */
static size_t edit_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    size_t row[3][MAX_NAME + 1];
    for (size_t j = 0; j <= b_length; j++)
        row[0][j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        size_t *now = row[i % 3], *above = row[(i + 2) % 3], *two_above = row[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            size_t best = above[j - 1] + (a[i - 1] != b[j - 1]);
            if (above[j] + 1 < best)
                best = above[j] + 1;
            if (now[j - 1] + 1 < best)
                best = now[j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                two_above[j - 2] + 1 < best)
                best = two_above[j - 2] + 1;
            now[j] = best;
        }
    }
    return row[a_length % 3][b_length];
}

const char *kiln_text_nearest(const char *name, const char *const *candidates, size_t count)
{
    size_t length = strlen(name);
    if (length == 0 || length > MAX_NAME)
        return NULL;
    const char *nearest = NULL;
    size_t limit = length <= 3 ? 1 : length <= 6 ? 2 : 3;
    for (size_t i = 0; i < count; i++) {
        size_t candidate_length = strlen(candidates[i]);
        if (candidate_length > MAX_NAME)
            continue;
        size_t distance = edit_distance(name, length, candidates[i], candidate_length);
        /* A text that takes as many edits as the candidate has characters is no misspelling. */
        if (distance <= limit && distance < candidate_length) {
            nearest = candidates[i];
            limit = distance == 0 ? 0 : distance - 1; /* the next one must be nearer */
        }
    }
    return nearest;
}

void kiln_text_add(struct kiln_text *text, const char *format, ...)
{
    if (text->failed)
        return;
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int length = vsnprintf(NULL, 0, format, args);
    va_end(args);
    size_t needed = text->length + (length > 0 ? (size_t)length : 0) + 1;
    if (length >= 0 && needed > text->capacity) {
        size_t capacity = needed < 256 ? 256 : needed + needed / 2;
        char *data = realloc(text->data, capacity);
        if (data) {
            text->data = data;
            text->capacity = capacity;
        }
    }
    if (length < 0 || needed > text->capacity) {
        text->failed = true;
    } else {
        vsnprintf(text->data + text->length, text->capacity - text->length, format, again);
        text->length += (size_t)length;
    }
    va_end(again);
}

void kiln_text_free(struct kiln_text *text)
{
    free(text->data);
    *text = (struct kiln_text){0};
}

size_t kiln_text_character_length(const char *text)
{
    const unsigned char *s = (const unsigned char *)text;
    if (s[0] < 0x80)
        return 1;
    size_t length = s[0] >= 0xf0 ? 4 : s[0] >= 0xe0 ? 3 : 2;
    if (s[0] < 0xc2 || s[0] > 0xf4)
        return 0;
    for (size_t i = 1; i < length; i++) {
        if ((s[i] & 0xc0) != 0x80)
            return 0;
    }
    bool overlong = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xf0 && s[1] < 0x90);
    bool surrogate = s[0] == 0xed && s[1] > 0x9f;
    bool beyond = s[0] == 0xf4 && s[1] > 0x8f;
    return overlong || surrogate || beyond ? 0 : length;
}

void kiln_text_add_json(struct kiln_text *text, const char *string)
{
    struct kiln_json json = kiln_json_to_text(text);
    kiln_json_string(&json, NULL, string);
}

/* Returns whether a word has a character that must not come to a terminal as it is. A terminal may
 * act on it even within quotes, when a person pastes the word. */
static bool acts_on_terminal(const char *word)
{
    uint32_t character;
    for (size_t length; *word; word += length) {
        length = kiln_shown_character(word, &character);
        if (length == 0 || kiln_shown_needs_escape(character))
            return true;
    }
    return false;
}

/* Adds $'...' (POSIX.1-2024, 2.2.4), of which every byte but printable ASCII is written in octal.
 */
static void add_escaped_word(struct kiln_text *text, const char *word)
{
    kiln_text_add(text, "$'");
    for (const char *c = word; *c; c++) {
        if (*c < ' ' || *c > '~') /* a byte above 127 is negative where char has a sign */
            kiln_text_add(text, "\\%03o", (unsigned char)*c);
        else
            kiln_text_add(text, "%s%c", *c == '\'' || *c == '\\' ? "\\" : "", *c);
    }
    kiln_text_add(text, "'");
}

void kiln_text_add_shell_word(struct kiln_text *text, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_@%+=:,./-";
    if (acts_on_terminal(word)) {
        add_escaped_word(text, word);
        return;
    }
    /* zsh reads "=ls" as the path of a program, and fish "%self" as its process. */
    bool quoted = !*word || strchr("=%", *word) || word[strspn(word, plain)];
    kiln_text_add(text, quoted ? "'" : "");
    for (const char *c = word; *c; c++)
        kiln_text_add(text, "%s%c", *c == '\'' ? "'\\'" : "", *c);
    kiln_text_add(text, quoted ? "'" : "");
}

bool kiln_write_shell_word(FILE *out, const char *word)
{
    struct kiln_text text = {0};
    kiln_text_add_shell_word(&text, word);
    bool written = !text.failed && fputs(text.data, out) >= 0;
    kiln_text_free(&text);
    return written;
}
