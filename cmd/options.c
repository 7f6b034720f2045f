/* Parses the arguments of a command by the command's table of options. Used options and operands
 * end up in a struct arguments; a wrong option or value is reported with what is allowed. This file
 * also gives commands the value of an option by its name.
 *
 * The main function calls arguments_parse before it runs a command, and kiln figure --check does
 * for the command that a figure came from. So all values have been checked before a command does
 * any work. This file knows no option by name: a new option is a row of a command's table. A new
 * kind of value is a member of enum option_kind and a case of read_value. */
#include "options.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>

#include "foreign.h"
#include "report.h"

/* The most names of a table that are compared with a misspelled option. */
enum { MAX_OPTIONS = 64 };

/* Holds the state of arguments_parse. */
struct parser {
    struct arguments *arguments;
    const struct option *options;
    size_t option_count;
    const char *place;
    int argc, next; /* argv[next] is read next */
    char **argv;
};

static bool is_name(const char *name, const char *text, size_t length)
{
    return name && strlen(name) == length && strncmp(name, text, length) == 0;
}

const struct option *option_of_name(const struct option *options, size_t count, const char *name,
                                    size_t length)
{
    for (size_t i = 0; i < count; i++) {
        if (is_name(options[i].name, name, length) || is_name(options[i].older_name, name, length))
            return &options[i];
    }
    return NULL;
}

const struct option *option_of_letter(const struct option *options, size_t count, char letter)
{
    for (size_t i = 0; letter && i < count; i++) {
        if (options[i].letter == letter || options[i].older_letter == letter ||
            options[i].lost_letter == letter)
            return &options[i];
    }
    return NULL;
}

const char *suggest(char out[SUGGESTION_SIZE], const char *prefix, const char *found,
                    const char *const *names, size_t count)
{
    const char *nearest = kiln_text_nearest(found, names, count);
    out[0] = '\0';
    if (nearest)
        snprintf(out, SUGGESTION_SIZE, " (did you mean '%s%s'?)", prefix, nearest);
    return out;
}

/* Suggests what to type instead of an unknown option: kiln's spelling of another program's option,
 * else the nearest of its own names. */
static void suggest_option(const struct parser *parser, const char *typed, char out[FOREIGN_SIZE])
{
    if (foreign_suggest(out, typed, parser->options, parser->option_count))
        return;
    const char *name = typed + strspn(typed, "-");
    const struct option *option =
        option_of_name(parser->options, parser->option_count, name, strlen(name));
    if (option) { /* one dash is missing; the name may be an older one */
        snprintf(out, FOREIGN_SIZE, " (did you mean '--%s'?)", option->name);
        return;
    }
    const char *names[MAX_OPTIONS];
    size_t count = 0;
    for (; count < parser->option_count && count < MAX_OPTIONS; count++)
        names[count] = parser->options[count].name;
    char suggestion[SUGGESTION_SIZE];
    snprintf(out, FOREIGN_SIZE, "%s", suggest(suggestion, "--", name, names, count));
}

static int unknown_option(const struct parser *parser, const char *argument)
{
    char name[64], advice[FOREIGN_SIZE];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(argument, "="), argument);
    suggest_option(parser, name, advice);
    return report(KILN_USAGE, "%s: unknown option '%.*s'%s", parser->place,
                  (int)strcspn(argument, "="), argument, advice);
}

static int wrong_value(const struct parser *parser, const struct option_use *use,
                       const char *expected)
{
    return report(KILN_USAGE, "%s: --%s: found '%s', expected %s", parser->place, use->option->name,
                  use->text, expected);
}

static int read_choice(const struct parser *parser, struct option_use *use)
{
    size_t length = strlen(use->text);
    const char *word = use->option->placeholder;
    for (size_t i = 0;; i++) {
        size_t word_length = strcspn(word, "|");
        if (word_length == length && strncmp(word, use->text, length) == 0) {
            use->choice = i;
            return 0;
        }
        if (word[word_length] == '\0')
            break;
        word += word_length + 1;
    }
    char expected[128];
    snprintf(expected, sizeof expected, "one of %s", use->option->placeholder);
    return wrong_value(parser, use, expected);
}

static int read_integer(const struct parser *parser, struct option_use *use)
{
    const struct option *option = use->option;
    if (kiln_text_to_uint64(use->text, &use->integer[0]) &&
        (double)use->integer[0] >= option->min && (double)use->integer[0] <= option->max)
        return 0;
    char expected[96];
    snprintf(expected, sizeof expected, "a whole number from %.0f to %.0f", option->min,
             option->max);
    return wrong_value(parser, use, expected);
}

static int read_number(const struct parser *parser, struct option_use *use)
{
    const struct option *option = use->option;
    if (kiln_text_to_double(use->text, &use->number) && use->number >= option->min &&
        use->number <= option->max)
        return 0;
    char expected[96];
    snprintf(expected, sizeof expected, "a number from %g to %g", option->min, option->max);
    return wrong_value(parser, use, expected);
}

static int read_time(const struct parser *parser, struct option_use *use)
{
    const struct option *option = use->option;
    if (kiln_text_to_seconds(use->text, &use->number) && use->number >= option->min &&
        use->number <= option->max)
        return 0;
    char expected[96];
    snprintf(expected, sizeof expected,
             "a time from %g s to %.0f s, as a number of seconds or in ms, s, min or h",
             option->min, option->max);
    return wrong_value(parser, use, expected);
}

/* Reads two positive whole numbers with a separator between them. */
static bool read_two(const char *text, char separator, uint64_t numbers[2])
{
    char first[24] = "";
    const char *middle = strchr(text, separator);
    if (!middle || (size_t)(middle - text) >= sizeof first)
        return false;
    snprintf(first, sizeof first, "%.*s", (int)(middle - text), text);
    return kiln_text_to_uint64(first, &numbers[0]) && numbers[0] > 0 &&
           kiln_text_to_uint64(middle + 1, &numbers[1]) && numbers[1] > 0;
}

/* Reads X,Y,WxH, four whole numbers of 32 bits; W and H are positive. */
static bool read_rect(const char *text, uint64_t numbers[4])
{
    for (int i = 0; i < 2; i++) {
        char number[12] = "";
        size_t length = strcspn(text, ",");
        if (text[length] == '\0' || length >= sizeof number)
            return false;
        snprintf(number, sizeof number, "%.*s", (int)length, text);
        if (!kiln_text_to_uint64(number, &numbers[i]) || numbers[i] > UINT32_MAX)
            return false;
        text += length + 1;
    }
    return read_two(text, 'x', numbers + 2) && numbers[2] <= UINT32_MAX && numbers[3] <= UINT32_MAX;
}

static bool is_ratio(const char *text)
{
    uint64_t ratio[2];
    double number;
    return read_two(text, '/', ratio) || (kiln_text_to_double(text, &number) && number > 0);
}

/* Returns whether a text is KEY=VALUE, or with `commas` several of them with commas between them.
 * A key has at least one character. */
static bool are_pairs(const char *text, bool commas)
{
    for (;;) {
        size_t length = commas ? strcspn(text, ",") : strlen(text);
        const char *equals = memchr(text, '=', length);
        if (!equals || equals == text)
            return false;
        if (text[length] == '\0')
            return true;
        text += length + 1;
    }
}

static int read_grid(const struct parser *parser, struct option_use *use)
{
    double most = use->option->max;
    if (read_two(use->text, 'x', use->integer) && (double)use->integer[0] <= most &&
        (double)use->integer[1] <= most)
        return 0;
    char expected[96];
    snprintf(expected, sizeof expected, "COLUMNSxROWS, such as 8x8, with at most %.0f of each",
             most);
    return wrong_value(parser, use, expected);
}

/* Reads ranges of frames with commas between them. The message names the range that is wrong. */
static int read_frames(const struct parser *parser, struct option_use *use)
{
    struct frame_piece_place wrong;
    if (frame_spec_parse(use->text, &use->frames, &wrong))
        return 0;
    if (wrong.no_memory)
        return report_no_memory();
    if (!strchr(use->text, ','))
        return wrong_value(parser, use, FRAMES_EXPECTED);
    return report(KILN_USAGE, "%s: --%s: found '%.*s' in '%s', expected " FRAMES_EXPECTED,
                  parser->place, use->option->name, (int)wrong.length, use->text + wrong.start,
                  use->text);
}

static int read_value(const struct parser *parser, struct option_use *use)
{
    switch (use->option->kind) {
    case OPTION_FLAG:
        return 0;
    case OPTION_TEXT:
        return *use->text ? 0 : wrong_value(parser, use, use->option->placeholder);
    case OPTION_CHOICE:
        return read_choice(parser, use);
    case OPTION_INTEGER:
        return read_integer(parser, use);
    case OPTION_NUMBER:
        return read_number(parser, use);
    case OPTION_TIME:
        return read_time(parser, use);
    case OPTION_SIZE:
        return read_two(use->text, 'x', use->integer)
                   ? 0
                   : wrong_value(parser, use, "WxH in pixels, such as 1280x720");
    case OPTION_GRID:
        return read_grid(parser, use);
    case OPTION_RATIO:
        return is_ratio(use->text)
                   ? 0
                   : wrong_value(parser, use, "a rate such as 30, 29.97 or 30000/1001");
    case OPTION_RECT:
        return read_rect(use->text, use->integer)
                   ? 0
                   : wrong_value(parser, use, "X,Y,WxH in pixels, such as 0,0,320x24");
    case OPTION_PART:
        return read_two(use->text, '/', use->integer) && use->integer[0] <= use->integer[1] &&
                       use->integer[1] <= UINT32_MAX
                   ? 0
                   : wrong_value(parser, use, "I/N, the I-th of N parts, such as 1/4");
    case OPTION_FRAMES:
        return read_frames(parser, use);
    case OPTION_PAIRS:
        return are_pairs(use->text, use->option->splits_at_commas)
                   ? 0
                   : wrong_value(parser, use, use->option->placeholder);
    }
    return 0;
}

/* Returns whether a word is an option: two dashes, or one and the letter of an option. "-" and
 * "-30" are values. */
static bool looks_like_option(const struct parser *parser, const char *word)
{
    return strncmp(word, "--", 2) == 0 ||
           (word[0] == '-' && word[1] && !word[2] &&
            option_of_letter(parser->options, parser->option_count, word[1]));
}

/* Returns whether the next word is the value of an option in its older spelling. */
static bool value_follows(const struct parser *parser, const struct option *option)
{
    const char *next = parser->next < parser->argc ? parser->argv[parser->next] : NULL;
    return next && option->value_may_be_separate &&
           (strcmp(next, "-") == 0 || fnmatch(option->files, next, 0) == 0);
}

/* Records the use of an option and reads its value. `joined` is the value if it came in the same
 * word as the option, else NULL; then the value is the next word. */
static int use_option(struct parser *parser, const struct option *option, const char *joined)
{
    struct option_use *use = &parser->arguments->uses[parser->arguments->use_count++];
    *use = (struct option_use){.option = option, .text = joined};
    if (option->kind == OPTION_FLAG && joined)
        return report(KILN_USAGE, "%s: --%s: takes no value, found '%s'", parser->place,
                      option->name, joined);
    const bool follows = !joined && value_follows(parser, option);
    if (follows) {
        char old[64], now[64];
        snprintf(old, sizeof old, "'--%s %s'", option->name, option->placeholder);
        snprintf(now, sizeof now, "'--%s=%s'", option->name, option->placeholder);
        report_deprecated(parser->place, old, now);
    }
    if (option->kind == OPTION_FLAG || (option->value_is_optional && !joined && !follows))
        return 0;
    if (!joined) {
        const char *next = parser->next < parser->argc ? parser->argv[parser->next] : NULL;
        if (!next)
            return report(KILN_USAGE, "%s: --%s: needs a value, %s", parser->place, option->name,
                          option->placeholder);
        if (looks_like_option(parser, next))
            return report(KILN_USAGE,
                          "%s: --%s: needs a value, %s, found '%s' (a value that looks like an "
                          "option is joined: --%s=%s)",
                          parser->place, option->name, option->placeholder, next, option->name,
                          next);
        use->text = next;
        parser->next++;
    }
    return read_value(parser, use);
}

/* Warns of an older spelling of an option; `typed` has its dashes. */
static void warn_of_older(const struct parser *parser, const char *typed,
                          const struct option *option)
{
    char now[64];
    snprintf(now, sizeof now, "--%s", option->name);
    report_deprecated(parser->place, typed, now);
}

static int read_long(struct parser *parser, const char *argument)
{
    const size_t length = strcspn(argument + 2, "=");
    const struct option *option =
        option_of_name(parser->options, parser->option_count, argument + 2, length);
    if (!option)
        return unknown_option(parser, argument);
    if (!is_name(option->name, argument + 2, length)) {
        char typed[64];
        snprintf(typed, sizeof typed, "%.*s", (int)length + 2, argument);
        warn_of_older(parser, typed, option);
    }
    const char *equals = argument + 2 + length;
    return use_option(parser, option, *equals ? equals + 1 : NULL);
}

/* Reports a word of letters after one dash, of which `letter` is no option. The message is about
 * the whole word if that is an option of another program ("-crf") or nearly the name of one of this
 * command's options ("-quiet"); otherwise it names the letter. */
static int unknown_letter(const struct parser *parser, const char *argument, char letter)
{
    char advice[FOREIGN_SIZE];
    const char typed[] = {'-', letter, '\0'};
    if (argument[2] == '\0')
        return unknown_option(parser, argument);
    suggest_option(parser, argument, advice);
    if (*advice)
        return unknown_option(parser, argument);
    if (!foreign_suggest(advice, typed, parser->options, parser->option_count))
        *advice = '\0';
    return report(KILN_USAGE, "%s: unknown option '-%c' in '%s'%s", parser->place, letter, argument,
                  advice);
}

/* Uses the option of a letter. `joined` is the rest of the word as in use_option. */
static int use_letter(struct parser *parser, char letter, const char *joined)
{
    const char typed[] = {'-', letter, '\0'};
    const struct option *option = option_of_letter(parser->options, parser->option_count, letter);
    if (option->lost_letter == letter)
        return report(KILN_USAGE, "%s: %s is --%s in other commands; write '--%s %s'",
                      parser->place, typed, option->lost_to, option->name, option->placeholder);
    if (option->older_letter == letter)
        warn_of_older(parser, typed, option);
    return use_option(parser, option, joined);
}

/* Reads options by their letters. As POSIX says, several letters may follow one dash: flags, and at
 * the end an option with a value. The value is the rest of the word or the next word: "-qo r.png"
 * and "-qor.png" are the same. No option is used before all letters of the word are known. */
static int read_short(struct parser *parser, const char *argument)
{
    if (option_of_name(parser->options, parser->option_count, argument + 1, strlen(argument + 1)))
        return unknown_option(parser, argument); /* "-output" is not "-o utput" */
    size_t count = 0;                            /* letters of the word that are options */
    const struct option *option;
    do {
        const char letter = argument[1 + count++];
        option = option_of_letter(parser->options, parser->option_count, letter);
        if (!option)
            return unknown_letter(parser, argument, letter);
    } while (option->kind == OPTION_FLAG && argument[1 + count]);
    int code = 0;
    for (size_t i = 1; i <= count && code == 0; i++) {
        const char *rest = i == count && argument[1 + count] ? argument + 1 + count : NULL;
        code = use_letter(parser, argument[i], rest);
    }
    return code;
}

int arguments_parse(struct arguments *arguments, const struct option *options, size_t option_count,
                    const char *place, int argc, char **argv)
{
    /* The most options that the arguments can have: every letter of an argument may be one. */
    size_t most = 1;
    for (int i = 0; i < argc; i++)
        most += argv[i][0] == '-' ? strlen(argv[i]) : 1;
    *arguments = (struct arguments){.uses = calloc(most, sizeof *arguments->uses),
                                    .operands = calloc(most, sizeof *arguments->operands),
                                    .argv = (const char *const *)argv,
                                    .argc = argc > 0 ? (size_t)argc : 0};
    if (!arguments->uses || !arguments->operands)
        return report_no_memory();
    struct parser parser = {.arguments = arguments,
                            .options = options,
                            .option_count = option_count,
                            .place = place,
                            .argc = argc,
                            .argv = argv};
    bool options_ended = false;
    while (parser.next < argc) {
        const char *argument = argv[parser.next++];
        int code = 0;
        if (options_ended || argument[0] != '-' || argument[1] == '\0')
            arguments->operands[arguments->operand_count++] = argument;
        else if (strcmp(argument, "--") == 0)
            options_ended = true;
        else
            code =
                argument[1] == '-' ? read_long(&parser, argument) : read_short(&parser, argument);
        if (code)
            return code;
    }
    return 0;
}

void arguments_free(struct arguments *arguments)
{
    for (size_t i = 0; i < arguments->use_count; i++)
        frame_spec_free(&arguments->uses[i].frames);
    free(arguments->uses);
    free(arguments->operands);
    *arguments = (struct arguments){0};
}

const struct option_use *arguments_last(const struct arguments *arguments, const char *name)
{
    for (size_t i = arguments->use_count; i > 0; i--) {
        if (strcmp(arguments->uses[i - 1].option->name, name) == 0)
            return &arguments->uses[i - 1];
    }
    return NULL;
}

bool arguments_flag(const struct arguments *arguments, const char *name)
{
    return arguments_last(arguments, name) != NULL;
}

const char *arguments_text(const struct arguments *arguments, const char *name,
                           const char *fallback)
{
    const struct option_use *use = arguments_last(arguments, name);
    return use ? use->text : fallback;
}

uint32_t arguments_integer(const struct arguments *arguments, const char *name, uint32_t fallback)
{
    const struct option_use *use = arguments_last(arguments, name);
    return use ? (uint32_t)use->integer[0] : fallback;
}

double arguments_number(const struct arguments *arguments, const char *name, double fallback)
{
    const struct option_use *use = arguments_last(arguments, name);
    return use ? use->number : fallback;
}

size_t arguments_choice(const struct arguments *arguments, const char *name, size_t fallback)
{
    const struct option_use *use = arguments_last(arguments, name);
    return use ? use->choice : fallback;
}

int frames_choose(struct frame_list *list, const struct option_use *frames, const char *place,
                  const char *clip, uint32_t last)
{
    uint32_t frame = 0;
    switch (frame_list_create(list, &frames->frames, last, &frame)) {
    case FRAMES_OK:
        return 0;
    case FRAMES_NO_MEMORY:
        return report_no_memory();
    case FRAMES_BEYOND:
        break;
    }
    return report(KILN_USAGE, "%s: --%s: found frame %u, but '%s' has frames 0-%u", place,
                  frames->option->name, frame, clip, last);
}

bool value_list_create(struct value_list *list, const struct arguments *arguments, const char *name)
{
    *list = (struct value_list){0};
    size_t size = 1, most = 1;
    for (size_t i = 0; i < arguments->use_count; i++) {
        if (strcmp(arguments->uses[i].option->name, name) != 0)
            continue;
        size += strlen(arguments->uses[i].text) + 1;
        most++;
        for (const char *c = arguments->uses[i].text; *c; c++)
            most += *c == ',';
    }
    list->cut = calloc(size, 1);
    list->items = calloc(most, sizeof *list->items);
    if (!list->cut || !list->items)
        return false;
    char *end = list->cut;
    for (size_t i = 0; i < arguments->use_count; i++) {
        const struct option_use *use = &arguments->uses[i];
        if (strcmp(use->option->name, name) != 0)
            continue;
        size_t length = strlen(use->text) + 1;
        char *rest = memcpy(end, use->text, length);
        end += length;
        if (!use->option->splits_at_commas)
            list->items[list->count++] = rest;
        else
            for (char *piece = strsep(&rest, ","); piece; piece = strsep(&rest, ","))
                list->items[list->count++] = piece;
    }
    return true;
}

void value_list_free(struct value_list *list)
{
    free(list->items);
    free(list->cut);
    *list = (struct value_list){0};
}
