/* Checks the names of tests, and sanitizes invalid ones. kiln_suite_load does both once it has
 * found the tests (suite/suite.c). A test with an invalid name ends as an error, and the sanitized
 * name stands for it in the results.
 *
 * A name becomes a folder of goldens and of results, and an argument of the commands that reports
 * print. So none of its parts may be hidden or be "..", and it may not look like an option. A rule
 * that is made stricter renames tests whose goldens exist. Which characters are letters follows
 * from a table and not from the locale, so that a name is valid on every machine or on none. */
#include "suite/test_name.h"

#include <stdint.h>
#include <string.h>

#include "base/text.h"

/* Blocks above U+00C0 without letters: signs, spaces, invisible characters and overrides of
 * direction, private use, and codes that are no characters. */
static const uint32_t no_letters[][2] = {
    {0xd7, 0xd7},     {0xf7, 0xf7},     {0x2000, 0x2bff},    {0x2e00, 0x2e7f},
    {0x3000, 0x3004}, {0x3008, 0x3020}, {0xe000, 0xf8ff},    {0xfe00, 0xfe6f},
    {0xfeff, 0xfeff}, {0xfff0, 0xffff}, {0xe0000, 0x10ffff},
};

/* Returns the code of a character of 2 to 4 bytes. Its bytes are valid UTF-8, since
 * kiln_text_character_length has found its length. */
static uint32_t decode(const char *text, size_t length)
{
    uint32_t code = (unsigned char)text[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++)
        code = code << 6 | ((unsigned char)text[i] & 0x3fu);
    return code;
}

/* Returns the bytes of the character that starts a text, or 0 where it cannot be in a name. */
static size_t name_character(const char *text)
{
    static const char ascii[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                "0123456789._-/";
    size_t length = kiln_text_character_length(text);
    if (length < 2)
        return length == 1 && *text && strchr(ascii, *text) ? 1 : 0;
    uint32_t code = decode(text, length);
    for (size_t i = 0; i < sizeof no_letters / sizeof *no_letters; i++) {
        if (code >= no_letters[i][0] && code <= no_letters[i][1])
            return 0;
    }
    return code >= 0xc0 ? length : 0;
}

bool kiln_test_name_is_valid(const char *name)
{
    size_t length = strlen(name);
    bool hidden = *name == '.' || strstr(name, "/.");
    if (length == 0 || length > KILN_TEST_MAX_NAME || hidden || *name == '-')
        return false;
    while (*name) {
        size_t bytes = name_character(name);
        if (bytes == 0)
            return false;
        name += bytes;
    }
    return true;
}

const char *kiln_test_name_sanitize(struct kiln_arena *arena, const char *name)
{
    /* The arena's bytes are zero, so the text always ends. */
    char *sanitized = kiln_arena_alloc(arena, KILN_TEST_MAX_NAME + 1, 1);
    size_t used = 0;
    for (const char *c = name; sanitized && *c;) {
        size_t bytes = name_character(c);
        bool first = used == 0 || sanitized[used - 1] == '/';
        bool wrong = bytes == 0 || (first && (*c == '.' || *c == '-' || *c == '/'));
        size_t step = bytes > 0 ? bytes : 1;
        if (used + step > KILN_TEST_MAX_NAME)
            break;
        memcpy(sanitized + used, wrong ? "____" : c, step);
        used += step;
        c += step;
    }
    if (sanitized && used == 0)
        sanitized[0] = '_';
    return sanitized;
}
