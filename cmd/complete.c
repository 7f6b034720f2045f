/* Runs kiln complete, which prints the possible continuations of a command line. It uses the tables
 * of commands and options that the parser reads. The scripts in cmd/completion call it at each
 * press of Tab and pass its lines to their shell. No list of commands has it, since people do not
 * type it. */
#include <string.h>

#include "command.h"
#include "report.h"
#include "test_select.h"

#define SCENE_FILES "*.y*ml"

/* The command line up to the word that is being typed, which is its last word. */
struct line {
    const char *const *words;
    size_t count;
    const char *typed;
    const struct command *command;
    const struct option *pending; /* the option whose value is being typed, or NULL */
    const char *operand;          /* the first operand, or NULL */
    size_t operand_count;
    const char *results; /* the value of --results */
    bool options_ended;
};

/* The text that is completed: it follows the first `prefix_length` bytes of the typed word, which
 * stay as they are, and begins with `rest`. */
struct value {
    const struct line *line;
    const struct option *option; /* the option whose value is completed; NULL: an operand */
    size_t prefix_length;
    const char *rest;
    const char *part;   /* of a scene key: the text after its last dot */
    char printed[4096]; /* what was printed: parts of keys, each between newlines; or the last stage
                         */
};

/* Returns whether a text can stand in a line. A control character in it would end the line or a
 * column, so that the rest would be taken for another continuation. */
static bool fits_line(const char *text)
{
    for (; *text; text++) {
        if ((unsigned char)*text < ' ' || *text == 0x7f)
            return false;
    }
    return true;
}

/* Prints a line for the script, unless the text cannot stand in one. Its kind is "word"; "part",
 * after which the shell adds no space; or "folder" or "file:PATTERN", for which the shell lists the
 * files that follow the text. Only a folder or file may have an empty text, since shells read
 * consecutive tabs as one. */
static void print_line(const char *kind, const struct value *value, const char *text,
                       const char *note)
{
    if (!fits_line(text) || !fits_line(value->line->typed))
        return;
    printf("%s\t%.*s%s\t%s\n", kind, (int)value->prefix_length, value->line->typed, text, note);
}

/* Prints a word if it starts with what is typed. */
static void print_if_prefix(const struct value *value, const char *kind, const char *word,
                            const char *note)
{
    if (strncmp(word, value->rest, strlen(value->rest)) == 0)
        print_line(kind, value, word, note);
}

/* Prints those of the words "a|b|c" that start with what is typed. */
static void print_choices(const struct value *value, const char *words)
{
    while (*words) {
        char word[64];
        size_t length = strcspn(words, "|");
        snprintf(word, sizeof word, "%.*s", (int)length, words);
        print_if_prefix(value, "word", word, "");
        words += length + (words[length] == '|');
    }
}

/* Limits the completion to the text after the last separator, if there is one. */
static void skip_past(struct value *value, char separator)
{
    const char *last = strrchr(value->rest, separator);
    if (last) {
        value->rest = last + 1;
        value->prefix_length = (size_t)(value->rest - value->line->typed);
    }
}

/* ---- Keys of a scene ------------------------------------------------------------------------ */

/* Returns whether a part of a path stands for any entry: NAME of a map, N of a list. */
static bool is_entry(const char *part)
{
    return *part >= 'A' && *part <= 'Z';
}

/* Compares the path of a key with a typed key, part by part; an entry of the path (NAME or N) fits
 * any part. Returns the part of the path that stands at the last typed part, and sets *part to that
 * typed part. Returns NULL if the parts before it differ. */
static const char *match_path(const char *path, const char *typed, const char **part)
{
    for (;;) {
        size_t length = strcspn(path, "."), typed_length = strcspn(typed, ".");
        if (typed[typed_length] == '\0') {
            *part = typed;
            return path;
        }
        bool fits = is_entry(path) ? typed_length > 0
                                   : typed_length == length && strncmp(path, typed, length) == 0;
        if (!fits || path[length] == '\0')
            return NULL;
        path += length + 1;
        typed += typed_length + 1;
    }
}

/* Prints a part of a key that fits the typed parts, unless it was printed before. */
static void print_part(struct value *value, const char *part, char end, const char *note)
{
    char line[128];
    size_t used = strlen(value->printed);
    int length = snprintf(line, sizeof line, "\n%s%c\n", part, end);
    if (length < 0 || (size_t)length >= sizeof line || strstr(value->printed, line) ||
        strncmp(line + 1, value->part, strlen(value->part)) != 0)
        return;
    snprintf(value->printed + used, sizeof value->printed - used, "%s", line);
    line[length - 1] = '\0';
    const struct value place = {.line = value->line,
                                .prefix_length = (size_t)(value->part - value->line->typed)};
    print_line("part", &place, line + 1, note);
}

static void print_system(void *user, const char *name)
{
    print_part(user, name, '.', "a system");
}

static void print_node(void *user, const char *name)
{
    print_part(user, name, '.', "a node");
}

static void print_entries(struct value *value, bool named)
{
    if (strstr(value->printed, "\n*.\n"))
        return;
    struct kiln_error error = {0};
    print_part(value, "*", '.', "every entry");
    if (!named)
        print_part(value, "0", '.', "the first entry");
    else if (value->line->operand && strncmp(value->rest, "nodes.", strlen("nodes.")) == 0)
        kiln_scene_visit_names(value->line->operand, "nodes", print_node, value, &error);
    else if (value->line->operand)
        kiln_scene_visit_names(value->line->operand, "systems", print_system, value, &error);
}

static void print_param(void *user, const char *name)
{
    print_part(user, name, '=', "a parameter");
}

/* Prints "params.", or the parameters of the scene behind it. */
static void print_params(struct value *value)
{
    static const char key[] = "params.";
    struct kiln_error error = {0};
    const size_t length = sizeof key - 1;
    value->part = value->rest;
    if (strncmp(value->rest, key, length) != 0) {
        print_part(value, "params", '.', "values of parameters");
        return;
    }
    value->part = value->rest + length;
    if (value->line->operand)
        kiln_scene_visit_names(value->line->operand, "params", print_param, value, &error);
}

static void print_domain(void *user, const char *name)
{
    print_if_prefix(user, "word", name, "a domain of gas");
}

/* Prints the domains of gas of the scene. */
static void print_domains(struct value *value)
{
    struct kiln_error error = {0};
    if (value->line->operand)
        kiln_scene_visit_names(value->line->operand, "gas", print_domain, value, &error);
}

static void print_key(void *user, const struct kiln_option_key *key)
{
    struct value *value = user;
    const char *part = match_path(key->path, value->rest, &value->part);
    if (!part || key->in_file_only)
        return;
    if (is_entry(part)) {
        print_entries(value, part[1] == 'A');
        return;
    }
    char name[96];
    size_t length = strcspn(part, ".");
    snprintf(name, sizeof name, "%.*s", (int)length, part);
    if (part[length] == '.')
        print_part(value, name, '.', "");
    else if (!key->holds_keys || key->choices || key->shortcut)
        print_part(value, name, '=', key->help);
}

/* Prints the words that the typed key takes as its value, for KEY=WORD. */
static void print_key_words(void *user, const struct kiln_option_key *key)
{
    const struct value *value = user;
    const char *part = NULL, *end = key->choices ? match_path(key->path, value->part, &part) : NULL;
    if (end && strcmp(end, part) == 0)
        print_choices(value, key->choices);
}

/* Completes KEY=VALUE. `separator` is ',' where several values may follow the key, ';' where
 * several pairs may follow one another, or 0. */
static void print_pair(struct value *value, char separator)
{
    if (separator == ';')
        skip_past(value, ';');
    const char *equals = strchr(value->rest, '=');
    if (!equals) {
        print_params(value);
        kiln_scene_visit_keys(print_key, value);
        return;
    }
    char key[256];
    snprintf(key, sizeof key, "%.*s", (int)(equals - value->rest), value->rest);
    value->part = key;
    value->rest = equals + 1;
    value->prefix_length = (size_t)(value->rest - value->line->typed);
    if (separator == ',')
        skip_past(value, ',');
    kiln_scene_visit_keys(print_key_words, value);
}

static void print_set(struct value *value)
{
    print_pair(value, '\0');
}

static void print_sweep(struct value *value)
{
    if (!strchr(value->rest, '=')) {
        print_if_prefix(value, "part", "frame=", "frames of the clip");
        print_if_prefix(value, "part", "time=", "times in seconds");
    }
    print_pair(value, ',');
}

static void print_variant(struct value *value)
{
    print_pair(value, ';');
}

/* ---- What placeholders stand for ------------------------------------------------------------ */

static void print_matching(const struct value *value, const char *fallback)
{
    char kind[64];
    const char *files = value->option ? value->option->files : NULL;
    snprintf(kind, sizeof kind, "file:%s", files ? files : fallback);
    print_line(kind, value, "", "");
}

static void print_files(struct value *value)
{
    print_matching(value, "*");
}

static void print_scenes(struct value *value)
{
    print_matching(value, SCENE_FILES);
}

static void print_folders(struct value *value)
{
    print_line("folder", value, "", "");
}

/* Prints the tests of the last run whose names start with what is typed. */
static void print_tests(struct value *value)
{
    struct kiln_error error = {0};
    struct kiln_results *results = kiln_results_load(&value->line->results, 1, &error);
    size_t count = results ? kiln_results_summary(results).tests : 0;
    for (size_t i = 0; i < count; i++)
        print_if_prefix(value, "word", kiln_results_name(results, i), "");
    kiln_results_destroy(&results);
}

/* Prints the names of devices that are known without starting OpenGL, which is slow. */
static void print_devices(struct value *value)
{
    print_if_prefix(value, "word", KILN_DEVICE_CPU, "this machine without OpenGL");
    print_if_prefix(value, "word", "software", "the first software device of OpenGL");
}

static void print_technique(void *user, const char *name, const char *help)
{
    print_if_prefix(user, "word", name, help);
}

static void print_techniques(struct value *value)
{
    kiln_visit_techniques(print_technique, value);
}

/* Prints the name of a stage once. The techniques of a stage are visited in succession, so only the
 * name of the last stage is kept. */
static void print_stage(void *user, const char *name, const char *help)
{
    (void)help;
    struct value *value = user;
    char stage[32];
    snprintf(stage, sizeof stage, "%.*s", (int)strcspn(name, "="), name);
    if (strcmp(stage, value->printed) == 0)
        return;
    memcpy(value->printed, stage, sizeof stage);
    print_if_prefix(value, "word", stage, "");
}

static void print_stages(struct value *value)
{
    kiln_visit_techniques(print_stage, value);
}

static void print_suite(void *user, const struct kiln_bench_suite *suite)
{
    print_if_prefix(user, "word", suite->name, suite->help);
}

static void print_suites(struct value *value)
{
    kiln_visit_benches(print_suite, value);
}

static void print_template(void *user, const char *name, const char *summary)
{
    print_if_prefix(user, "word", name, summary);
}

static void print_templates(struct value *value)
{
    kiln_visit_templates(print_template, value);
}

static void print_metric(void *user, const char *name, const char *help)
{
    char text[KILN_METRIC_NAME_SIZE + 1];
    snprintf(text, sizeof text, "%s=", name);
    print_if_prefix(user, "part", text, help);
}

static void print_metrics(struct value *value)
{
    kiln_visit_metrics(print_metric, value);
}

static void print_topic(void *user, const char *name, const char *summary)
{
    print_if_prefix(user, "word", name, summary);
}

/* Prints the second words of the two-word commands that begin with `first`. */
static void print_second_words(const struct value *value, const char *first)
{
    for (size_t i = 0; commands[i]; i++) {
        if (command_is_under(commands[i], first))
            print_if_prefix(value, "word", commands[i]->name + strlen(first) + 1,
                            commands[i]->summary);
    }
}

static void print_commands(const struct value *value)
{
    for (size_t i = 0; commands[i]; i++) {
        if (!strchr(commands[i]->name, ' '))
            print_if_prefix(value, "word", commands[i]->name, commands[i]->summary);
    }
}

static void print_topics(struct value *value)
{
    if (value->line->operand) {
        print_second_words(value, value->line->operand);
    } else {
        print_commands(value);
        help_visit_topics(print_topic, value);
    }
}

static void print_events(struct value *value)
{
    print_if_prefix(value, "word", "ndjson", "lines of JSON on standard output");
    print_if_prefix(value, "word", "openjd", "lines of Open Job Description on standard output");
}

static const struct {
    const char *placeholder;
    void (*print)(struct value *value);
} placeholders[] = {
    {"SCENE", print_scenes},         {"PATH", print_scenes},
    {"CLIP", print_files},           {"FILE", print_files},
    {"FRAMES", print_files},         {"OUTPUT", print_files},
    {"PROGRAM", print_files},        {"REFERENCE", print_files},
    {"TEST", print_files},           {"FOLDER", print_folders},
    {"STATES", print_folders},       {"NAME", print_tests},
    {"PATTERN", print_tests},        {"TOPIC", print_topics},
    {"DEVICE", print_devices},       {"STAGE=NAME", print_techniques},
    {"METRIC=VALUE", print_metrics}, {"KEY=VALUE", print_set},
    {"KEY=VALUE,...", print_sweep},  {"KEY=VALUE;...", print_variant},
    {"TEMPLATE", print_templates},   {"STAGE", print_stages},
    {"FIGURE", print_files},         {"SUITE", print_suites},
    {"STREAM", print_events},        {"JOBS", print_files},
    {"DOMAIN", print_domains},
};

static void complete_placeholder(struct value *value, const char *placeholder, size_t length)
{
    for (size_t i = 0; i < sizeof placeholders / sizeof *placeholders; i++) {
        if (strlen(placeholders[i].placeholder) == length &&
            strncmp(placeholders[i].placeholder, placeholder, length) == 0)
            placeholders[i].print(value);
    }
}

/* ---- The command line ----------------------------------------------------------------------- */

/* Finds the option of "--name" or "--name=VALUE"; *attached is the value, or NULL. */
static const struct option *find_long(const struct command *command, const char *word,
                                      const char **attached)
{
    const size_t length = strcspn(word + 2, "=");
    *attached = word[2 + length] ? word + 3 + length : NULL;
    return option_of_name(command->options, command->option_count, word + 2, length);
}

/* Finds the last option of "-n", "-qn" or "-qnVALUE"; *attached is the value, or NULL. */
static const struct option *find_short(const struct command *command, const char *word,
                                       const char **attached)
{
    const struct option *option = NULL;
    *attached = NULL;
    while (*++word) {
        option = option_of_letter(command->options, command->option_count, *word);
        if (!option)
            return NULL;
        if (option->kind != OPTION_FLAG) {
            *attached = word[1] ? word + 1 : NULL;
            return option;
        }
    }
    return option;
}

static const struct option *find_option(const struct command *command, const char *word,
                                        const char **attached)
{
    return word[1] == '-' ? find_long(command, word, attached)
                          : find_short(command, word, attached);
}

/* Reads the words between the command and the typed word, as arguments_parse would. */
static void read_words(struct line *line, size_t first)
{
    for (size_t i = first; i + 1 < line->count; i++) {
        const char *word = line->words[i], *attached = NULL;
        if (line->options_ended || word[0] != '-' || word[1] == '\0') {
            line->operand = line->operand ? line->operand : word;
            line->operand_count++;
            continue;
        }
        line->options_ended = strcmp(word, "--") == 0;
        const struct option *option =
            line->options_ended ? NULL : find_option(line->command, word, &attached);
        if (!option || option->kind == OPTION_FLAG)
            continue;
        if (!attached && !option->value_is_optional) {
            if (i + 2 == line->count)
                line->pending = option;
            else
                attached = line->words[++i];
        }
        if (attached && strcmp(option->name, "results") == 0)
            line->results = attached;
    }
}

/* Completes the value of an option; `typed` is where the value starts in the word. */
static void print_option_values(const struct line *line, const struct option *option,
                                const char *typed)
{
    struct value value = {.line = line,
                          .option = option,
                          .prefix_length = (size_t)(typed - line->typed),
                          .rest = typed};
    if (option->kind == OPTION_FLAG)
        return;
    if (option->splits_at_commas)
        skip_past(&value, ',');
    if (option->kind == OPTION_CHOICE)
        print_choices(&value, option->placeholder);
    else
        complete_placeholder(&value, option->placeholder, strlen(option->placeholder));
}

static void print_options(const struct line *line)
{
    const struct value value = {.line = line, .rest = line->typed};
    for (size_t i = 0; i < line->command->option_count; i++) {
        char name[64];
        snprintf(name, sizeof name, "--%s", line->command->options[i].name);
        print_if_prefix(&value, "word", name, line->command->options[i].help);
    }
}

/* Completes an operand by the words of the synopsis, such as "[PATH | NAME]...". */
static void print_operands(const struct line *line)
{
    struct value value = {.line = line, .rest = line->typed};
    if (line->count == 2)
        print_second_words(&value, line->command->name);
    if (line->operand_count >= line->command->most_operands)
        return;
    for (const char *word = line->command->operands; *word;) {
        size_t length = strspn(word, "ABCDEFGHIJKLMNOPQRSTUVWXYZ");
        complete_placeholder(&value, word, length);
        word += length > 0 ? length : 1;
    }
}

static int run(const struct arguments *arguments)
{
    struct line line = {.words = arguments->operands,
                        .count = arguments->operand_count,
                        .typed = arguments->operands[arguments->operand_count - 1],
                        .results = DEFAULT_RESULTS};
    if (line.count == 1) {
        const struct value value = {.line = &line, .rest = line.typed};
        print_commands(&value);
        print_if_prefix(&value, "word", "--help", "list commands and topics");
        print_if_prefix(&value, "word", "--version", "say which kiln this is");
        return 0;
    }
    line.command = command_find(line.words[0], line.count > 2 ? line.words[1] : NULL);
    if (!line.command)
        return 0;
    read_words(&line, strchr(line.command->name, ' ') ? 2 : 1);
    const char *value = NULL;
    bool is_option = !line.options_ended && line.typed[0] == '-';
    const struct option *option =
        is_option && line.typed[1] ? find_option(line.command, line.typed, &value) : NULL;
    if (line.pending)
        print_option_values(&line, line.pending, line.typed);
    else if (option && value)
        print_option_values(&line, option, value);
    else if (is_option)
        print_options(&line);
    else
        print_operands(&line);
    return 0;
}

static const struct option options[] = {HELP_OPTION};

const struct command complete_command = {
    .name = "complete",
    .summary = "say what may follow on a command line",
    .operands = "-- WORD...",
    .description =
        "For the scripts that let bash, zsh and fish complete command lines of kiln. The "
        "WORDs are a command line without 'kiln'; the last WORD is complete up to the "
        "cursor. The command prints a line for each continuation, with tabs between its "
        "kind, its text and its meaning. The kind is word, part (no space follows it), "
        "folder, or file:PATTERN; for the last two, the shell finds the files.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = SIZE_MAX,
    .run = run,
};
