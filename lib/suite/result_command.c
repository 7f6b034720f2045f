/* Checks the commands of a result, which reports offer for copying. A command is split into its
 * words, each word is compared with what kiln test would have written, and the command is built
 * anew. What only the maker of the result could know, and what could do harm, is left out: another
 * program to run, and folders to write into other than below the working directory. */
#include <string.h>

#include "base/text.h"
#include "suite/result_member.h"
#include "suite/test_file.h"

enum { MOST_WORDS = 256 };

struct words {
    struct kiln_arena *arena;
    const char *items[MOST_WORDS + 1]; /* ends with NULL */
    size_t count;
    bool failed; /* a text is no list of words, or memory was short */
};

/* ---- Splitting ------------------------------------------------------------------------------- */

/* Reads a sign of $'...', which kiln_text_add_shell_word writes: three octal digits, or the sign
 * itself. */
static const char *take_escape(const char *text, struct kiln_text *word)
{
    if (*text < '0' || *text > '7') {
        kiln_text_add(word, "%.1s", text);
        return *text ? text + 1 : text;
    }
    unsigned code = 0;
    int digits = 0;
    for (; digits < 3 && text[digits] >= '0' && text[digits] <= '7'; digits++)
        code = code * 8 + (unsigned)(text[digits] - '0');
    if (code > 0)
        kiln_text_add(word, "%c", (char)code);
    return text + digits;
}

/* Reads what is in quotes, from behind the first quote. Returns the place behind the last one, or
 * NULL without it. */
static const char *take_quoted(const char *text, bool escapes, struct kiln_text *word)
{
    while (*text && *text != '\'') {
        if (escapes && *text == '\\') {
            text = take_escape(text + 1, word);
        } else {
            kiln_text_add(word, "%c", *text++);
        }
    }
    return *text ? text + 1 : NULL;
}

/* Reads one word. Returns the place behind it, or NULL when the quotes are wrong. */
static const char *take_word(const char *text, struct kiln_text *word)
{
    kiln_text_add(word, "%s", "");
    while (text && *text && *text != ' ') {
        if (*text == '\'') {
            text = take_quoted(text + 1, false, word);
        } else if (text[0] == '$' && text[1] == '\'') {
            text = take_quoted(text + 2, true, word);
        } else {
            text += *text == '\\' && text[1];
            kiln_text_add(word, "%c", *text++);
        }
    }
    return text;
}

static void split(struct words *words, const char *command)
{
    while (command && *command && words->count < MOST_WORDS) {
        struct kiln_text word = {0};
        command = take_word(command, &word);
        const char *copy =
            word.failed ? NULL : kiln_arena_text(words->arena, word.data, word.length);
        words->failed = words->failed || !copy;
        words->items[words->count++] = copy;
        kiln_text_free(&word);
        if (command)
            command += *command == ' ';
    }
    words->failed = words->failed || !command || *command;
}

/* ---- Checking -------------------------------------------------------------------------------- */

struct checking {
    const struct kiln_result *result;
    const char *results; /* the folder of results that the user names, or NULL */
    struct kiln_text *out;
    bool approves;
};

/* Returns whether a relative path stays below its start. */
static bool stays_below(const char *path)
{
    if (*path == '/' || *path == '-' || *path == '~')
        return false;
    for (const char *part = path; *part;) {
        const size_t length = strcspn(part, "/");
        if (length == 2 && memcmp(part, "..", 2) == 0)
            return false;
        part += length + (part[length] == '/');
    }
    return *path != '\0';
}

/* Compares a word with the start of a text of the result, where bytes that are no UTF-8 became
 * U+FFFD when it was written. Returns the rest of the text, or NULL where they differ. */
static const char *match(const char *word, const char *text)
{
    static const char replacement[] = "\xef\xbf\xbd";
    if (*text == '-' && strncmp(word, "./", 2) == 0) /* so that no path is an option */
        word += 2;
    while (*word) {
        const size_t length = kiln_text_character_length(word);
        const char *const expected = length > 0 ? word : replacement;
        const size_t bytes = length > 0 ? length : strlen(replacement);
        if (strncmp(text, expected, bytes) != 0)
            return NULL;
        text += bytes;
        word += length > 0 ? length : 1;
    }
    return text;
}

/* Returns whether a folder of goldens is that of the result: GOLDEN/NAME without the name. */
static bool is_golden_folder(const struct checking *c, const char *folder)
{
    const char *name = c->result->name, *rest = match(folder, c->result->golden);
    const size_t length = strcspn(name, "@");
    return rest && *rest == '/' && strlen(rest + 1) == length &&
           strncmp(rest + 1, name, length) == 0;
}

/* Returns whether a word is the path of the test. It must not be taken for an option, nor for the
 * second word of a command, such as `kiln test approve`. */
static bool is_test(const struct checking *c, const char *word)
{
    if (*word == '-' || !kiln_test_file_is_yaml(word))
        return false;
    const char *rest = *c->result->test ? match(word, c->result->test) : NULL;
    return rest && *rest == '\0';
}

static bool is_number(const char *word)
{
    const size_t length = strlen(word);
    return length > 0 && length <= 9 && strspn(word, "0123456789") == length;
}

static bool is_technique(const char *word)
{
    return strchr(word, '=') && !word[strspn(word, "abcdefghijklmnopqrstuvwxyz0123456789=:,.-_")];
}

enum verdict { REFUSED, LEFT_OUT, KEPT };

/* Decides what becomes of an option of a command with its value. */
static enum verdict judge_option(const struct checking *c, const char *option, const char *value)
{
    if (*value == '-')
        return REFUSED;
    if (strcmp(option, "--golden") == 0) {
        if (!is_golden_folder(c, value))
            return REFUSED;
        return !c->approves || stays_below(value) ? KEPT : LEFT_OUT;
    }
    if (strcmp(option, "--results") == 0)
        return LEFT_OUT;
    if (c->approves)
        return REFUSED;
    if (strcmp(option, "--against") == 0) /* a program that would be run */
        return LEFT_OUT;
    const bool fits = strcmp(option, "--filter") == 0      ? strcmp(value, c->result->name) == 0
                      : strcmp(option, "--repeat") == 0    ? is_number(value)
                      : strcmp(option, "--technique") == 0 ? is_technique(value)
                                                           : strcmp(option, "--device") == 0;
    return fits ? KEPT : REFUSED;
}

static void keep(const struct checking *c, const char *word)
{
    kiln_text_add(c->out, " ");
    kiln_text_add_shell_word(c->out, word);
}

/* Adds the folder from which the result was read, where it is not the usual one. */
static void add_results(const struct checking *c)
{
    if (!c->results || strcmp(c->results, kiln_suite_defaults().results) == 0)
        return;
    keep(c, "--results");
    kiln_text_add(c->out, *c->results == '-' ? " ./" : " ");
    kiln_text_add_shell_word(c->out, c->results);
}

/* Checks the words after those of the command, of which one must name the test, and adds what is
 * kept. */
static bool rebuild(const struct checking *c, const char *const *words)
{
    bool names_test = false;
    for (const char *word; (word = *words); words++) {
        const bool is_flag =
            !c->approves && (strcmp(word, "--ignore-hashes") == 0 || strcmp(word, "--strict") == 0);
        const bool is_name = c->approves && strcmp(word, c->result->name) == 0;
        const bool is_operand = is_name || is_test(c, word);
        names_test = names_test || is_operand;
        if (is_flag || is_operand) {
            keep(c, word);
            continue;
        }
        const char *value = words[1];
        const enum verdict verdict = value ? judge_option(c, word, value) : REFUSED;
        if (verdict == REFUSED)
            return false;
        if (verdict == KEPT) {
            keep(c, word);
            keep(c, value);
        }
        words++;
    }
    return names_test;
}

const char *kiln_result_command(struct kiln_arena *arena, const struct kiln_result *result,
                                const char *command, const char *results, bool approves)
{
    static const char *const starts[] = {"kiln", "test", "approve"};
    const size_t start = approves ? 3 : 2;
    struct words *words = kiln_arena_alloc(arena, 1, sizeof *words);
    if (!words)
        return NULL;
    words->arena = arena;
    split(words, command);
    if (words->failed || words->count <= start)
        return NULL;
    for (size_t i = 0; i < start; i++) {
        if (strcmp(words->items[i], starts[i]) != 0)
            return NULL;
    }
    struct kiln_text out = {0};
    kiln_text_add(&out, "kiln test%s", approves ? " approve" : "");
    const struct checking c = {result, results, &out, approves};
    add_results(&c);
    const bool good = rebuild(&c, words->items + start) && !out.failed;
    const char *copy = good ? kiln_arena_text(arena, out.data, out.length) : NULL;
    kiln_text_free(&out);
    return copy;
}
