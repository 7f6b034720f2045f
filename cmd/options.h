/* Declares the options of the command line. The parser, the errors, --help and the man page all
 * come from one row per option. */
#ifndef KILN_CMD_OPTIONS_H
#define KILN_CMD_OPTIONS_H

#include "frames.h"

enum option_kind {
    OPTION_FLAG,
    OPTION_TEXT,    /* anything but an empty text */
    OPTION_CHOICE,  /* one of the words of its placeholder, "a|b|c" */
    OPTION_INTEGER, /* min to max */
    OPTION_NUMBER,  /* min to max, a decimal fraction */
    OPTION_TIME,    /* min to max, in s; with a unit or without */
    OPTION_SIZE,    /* WxH */
    OPTION_GRID,    /* COLUMNSxROWS, each up to max */
    OPTION_RATIO,   /* N/D or a decimal fraction */
    OPTION_RECT,    /* X,Y,WxH */
    OPTION_PART,    /* I/N: the I-th of N parts */
    OPTION_FRAMES,  /* 0-149,200 or 170- or last or 0-100/10 */
    OPTION_PAIRS,   /* KEY=VALUE; more of them after commas where splits_at_commas is set */
};

/* Says whether a command reads or writes the file, folder or pattern of files that an argument
 * names. */
enum file_access { ACCESS_NONE, ACCESS_READ, ACCESS_WRITE };

struct option {
    const char *name;       /* without its dashes; it means the same in every command */
    char letter;            /* short form, or 0; it belongs to one name in all commands */
    const char *older_name; /* an older spelling, which works with a warning; or NULL */
    char older_letter;      /* an older short form, which works with a warning; or 0 */
    char lost_letter;       /* an older short form, which is refused; or 0 */
    const char *lost_to;    /* the option of other commands that has the lost letter, "dry-run" */
    bool repeats;           /* every use counts; otherwise, only the last use */
    bool
        value_is_optional; /* the value may be left out, and must be joined by '=' if it is there */
    bool value_may_be_separate; /* with value_is_optional: the value may be the next argument, an
                                   older spelling, if it is "-" or matches `files` */
    bool splits_at_commas;
    enum option_kind kind;
    const char *placeholder; /* stands for the value in the help; NULL for a flag */
    const char *help;        /* what it does, as one or two sentences */
    const char *fallback;    /* the default, for the help; or NULL */
    const char *scene_key;   /* the key of the scene that it sets, or NULL */
    const char *files;       /* shell pattern of its files, "*.png"; NULL: any */
    enum file_access access; /* what it does with its value, if that is a path */
    double min, max;
};

/* One use of an option, whose value was checked. */
struct option_use {
    const struct option *option;
    const char *text;    /* the value; NULL for a flag, or where it was left out */
    uint64_t integer[4]; /* OPTION_INTEGER; OPTION_SIZE, _GRID: width, height; _RECT: x, y, width,
                            height; _PART: I, N */
    double number;       /* OPTION_NUMBER; OPTION_TIME: seconds */
    size_t choice;       /* OPTION_CHOICE: index of the word; 0 where it was left out */
    struct frame_spec frames;
};

/* The parsed command line of a command: options and operands, each in the order in which they were
 * given. */
struct arguments {
    struct option_use *uses;
    size_t use_count;
    const char **operands;
    size_t operand_count;
    const char *const *argv; /* all arguments, as they were given */
    size_t argc;
    struct kiln_budget *budget; /* set before the command runs; NULL: no limits */
    bool sandboxed; /* set before the command runs: the process is confined to the device cpu */
};

/* Reads argv, whose texts must outlive the arguments. Options and operands may come in any order,
 * "--" ends the options. Returns 0, or the exit code after reporting what was found and what is
 * allowed; `place` ("render") starts the message. The arguments must be freed in both cases. */
int arguments_parse(struct arguments *arguments, const struct option *options, size_t option_count,
                    const char *place, int argc, char **argv);
void arguments_free(struct arguments *arguments);

/* Return the option of a name, of which `length` bytes count, or of a letter; NULL if there is
 * none. Older spellings are known, too, also those that arguments_parse refuses. */
const struct option *option_of_name(const struct option *options, size_t count, const char *name,
                                    size_t length);
const struct option *option_of_letter(const struct option *options, size_t count, char letter);

/* Returns the last use of the option of that name, or NULL. */
const struct option_use *arguments_last(const struct arguments *arguments, const char *name);

/* Return the value of the last use, or the fallback if the option is not used. arguments_flag
 * returns whether it is used. */
bool arguments_flag(const struct arguments *arguments, const char *name);
const char *arguments_text(const struct arguments *arguments, const char *name,
                           const char *fallback);
uint32_t arguments_integer(const struct arguments *arguments, const char *name, uint32_t fallback);
double arguments_number(const struct arguments *arguments, const char *name, double fallback);
size_t arguments_choice(const struct arguments *arguments, const char *name, size_t fallback);

/* Fills in the frames that a use of --frames chooses from a clip whose last frame is `last`.
 * Returns 0, or the exit code after reporting that there is no such frame; `place` starts the
 * message, `clip` names the clip in it. The list must be freed in both cases. */
int frames_choose(struct frame_list *list, const struct option_use *frames, const char *place,
                  const char *clip, uint32_t last);

/* The values of all uses of an option, in order. A value with commas is split if the option has
 * splits_at_commas. */
struct value_list {
    const char **items; /* point into `cut` */
    size_t count;
    char *cut;
};

/* Collects the values of the option of that name. Returns false when memory is short. The list must
 * be freed in both cases. */
bool value_list_create(struct value_list *list, const struct arguments *arguments,
                       const char *name);
void value_list_free(struct value_list *list);

/* Writes " (did you mean 'rate'?)" if `found` is a misspelling of one of the names, else "".
 * `prefix` goes before the name. Returns out. */
enum { SUGGESTION_SIZE = 96 };
const char *suggest(char out[SUGGESTION_SIZE], const char *prefix, const char *found,
                    const char *const *names, size_t count);

#endif
