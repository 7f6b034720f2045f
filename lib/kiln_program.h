/* Declares the functions that the program kiln has in addition to the library's. It is the one
 * header that cmd/ includes. It is not installed, and may change with every version. */
#ifndef KILN_PROGRAM_H
#define KILN_PROGRAM_H

#include "kiln.h"

/* The files that a call reads and those that it writes, each known by where its path leads. Whoever
 * declares all before the work begins writes nothing that is read, and nothing twice. */
struct kiln_claims;
struct kiln_claims *kiln_claims_create(void); /* NULL when memory is short */
void kiln_claims_destroy(struct kiln_claims **claims);

/* Declares a file that the call reads, or writes; `what` stands for it in messages: "a texture",
 * "--manifest". KILN_USAGE when the call writes it already, or reads what is to be written,
 * KILN_DEVICE_FAILED when memory is short. A path that leads nowhere is read by nobody. */
bool kiln_claims_read(struct kiln_claims *claims, const char *path, const char *what,
                      struct kiln_error *error);
bool kiln_claims_write(struct kiln_claims *claims, const char *path, const char *what,
                       struct kiln_error *error);

/* Visits the absolute path of each file that is read and is there, in no order. */
void kiln_claims_visit_read(const struct kiln_claims *claims,
                            void (*visit)(void *user, const char *path), void *user);

/* Declares what the job reads (the scene and its files) and writes. KILN_USAGE when a file would be
 * written that is read, or twice; also when the output is no format, or the ranges make no sense
 * for it. kiln_render does that itself, for its one job. */
bool kiln_render_claim(const struct kiln_scene *scene, const struct kiln_render_params *params,
                       struct kiln_claims *claims, struct kiln_error *error);

/* Does what kiln_compare does, in a call that also writes `file` (NULL: it does not) for an option:
 * KILN_USAGE where that file is compared or written as well. */
bool kiln_compare_beside(const struct kiln_compare_params *params, const char *file,
                         const char *option, struct kiln_compare_result *result,
                         struct kiln_error *error);

/* The suffix of files of saved states. Commands write no other file under such a name. */
#define KILN_STATE_SUFFIX ".kilnstate"

/* ---- Words for people ----------------------------------------------------------------------- */

/* The reference of every scene key, for people, and the JSON schema, for editors. */
bool kiln_scene_write_reference(FILE *out);
bool kiln_scene_write_schema(FILE *out);

/* A key of a file, in words for people. */
struct kiln_option_key {
    const char *path;     /* "systems.NAME.emit.rate"; N stands for an entry of a list */
    const char *help;     /* what it is for */
    const char *variant;  /* the word of `field` that it belongs to, or NULL */
    const char *shortcut; /* the key inside that a bare value means, or NULL */
    const char *allowed;  /* of its value; NULL when it only holds other keys */
    const char *varies;   /* "over time", or NULL */
    const char *fallback; /* the default; NULL with `allowed`: must be given */
    const char *words;    /* that its value may be, "true|false", perhaps beside others; or NULL */
    bool holds_keys;
};

/* Visits all keys in the order of the reference; texts last for a visit. False: memory is short. */
bool kiln_scene_visit_keys(void (*visit)(void *user, const struct kiln_option_key *key),
                           void *user);

/* What the reference says before the keys. */
const char *kiln_scene_introduction(void);

/* Visits the names of the systems in a scene file, whatever else may be wrong with it. False when
 * it cannot be read as YAML, with the error of kiln_scene_load. */
bool kiln_scene_visit_systems(const char *path, void (*visit)(void *user, const char *name),
                              void *user, struct kiln_error *error);

/* The techniques of each stage and what each is for, for people. */
bool kiln_write_techniques(FILE *out);

/* Visits each as "stage=name". */
void kiln_visit_techniques(void (*visit)(void *user, const char *name, const char *help),
                           void *user);

/* The outputs that this build can write, and their options, for people. */
bool kiln_write_outputs(FILE *out);

/* Whether a quality makes a difference to an output of such a name. True also where nothing can be
 * written by it: what is wrong with the name is said elsewhere. */
bool kiln_output_has_quality(const char *path);

/* Whether an output of such a name is a file a frame, and not a clip. */
bool kiln_output_is_images(const char *path);

/* Visits the scenes to begin with: their names, and what each shows. */
void kiln_visit_templates(void (*visit)(void *user, const char *name, const char *summary),
                          void *user);

/* The same, for people. */
bool kiln_write_templates(FILE *out);

/* The text of a scene to begin with, below a line that tells editors where the schema is. The
 * caller frees it. NULL with KILN_USAGE for an unknown name, or KILN_DEVICE_FAILED when memory is
 * short. */
char *kiln_template_scene(const char *name, struct kiln_error *error);

/* Writes that text into a file, which appears under its name when it is whole; makes missing
 * folders. KILN_USAGE also when there is one and overwrite is not set; KILN_IO; else as above. */
bool kiln_template_write(const char *name, const char *path, bool overwrite,
                         struct kiln_error *error);

/* The table of limits, for people. */
bool kiln_write_limits(FILE *out);

/* The metrics and what each is for, for people. */
bool kiln_write_metrics(FILE *out);

/* Visits those with names of their own. */
void kiln_visit_metrics(void (*visit)(void *user, const char *name, const char *help), void *user);

/* Of the text of a scene, in bytes. */
enum { KILN_MAX_SCENE_SIZE = 4 << 20 };

/* ---- Text files ------------------------------------------------------------------------------ */

struct kiln_text_file;

/* Opens a text file that appears under its name when it is closed; makes missing folders.
 * KILN_USAGE when there is one and overwrite is not set, KILN_IO. */
struct kiln_text_file *kiln_text_file_open(const char *path, bool overwrite,
                                           struct kiln_error *error);

/* Returns the stream to print into, which kiln_text_file_close closes. */
FILE *kiln_text_file_stream(const struct kiln_text_file *text);

/* Gives the file its name, or without `keep` removes it. KILN_IO: then nothing is left of it. */
bool kiln_text_file_close(struct kiln_text_file **text, bool keep, struct kiln_error *error);

/* ---- Text: as kiln reads and writes it, for programs that take the same --------------------- */

/* A whole text as a decimal number, its point '.' in any locale; false when it is no finite one. */
bool kiln_text_to_double(const char *text, double *value);
bool kiln_text_to_uint64(const char *text, uint64_t *value);

/* A whole text as a time: seconds, or a number with one of the units ms, s, min and h. */
bool kiln_text_to_seconds(const char *text, double *seconds);

/* The candidate nearest to name by edit distance (swapped neighbours count once), or NULL when
 * none is near enough to be a misspelling. */
const char *kiln_text_nearest(const char *name, const char *const *candidates, size_t count);

/* Writes a word so that a shell takes it as one. */
bool kiln_write_shell_word(FILE *out, const char *word);

/* Copies a text out of a file so that a terminal, a log or a page shows it and does nothing else:
 * controls, overrides of direction and bytes that are no UTF-8 stand as \n, \x1b or \u202e. A text
 * that was shown before stays as it is. What does not fit is left out, characters being whole. out
 * may not be text. Messages of errors and the log are shown already. */
void kiln_shown(char *out, size_t room, const char *text);

#include "kiln_batch.h"
#include "kiln_bench.h"
#include "kiln_figure.h"
#include "kiln_json.h"
#include "kiln_test.h"

#endif
