/* Declares the functions that the program kiln has in addition to the library's. It is the one
 * header that cmd/ includes. It is not installed, and may change with every version. Errors and the
 * functions that destroy objects follow the rules of kiln.h. */
#ifndef KILN_PROGRAM_H
#define KILN_PROGRAM_H

#include "kiln.h"

/* The files that a call reads and writes, each identified by the file that its path leads to. A
 * caller declares all of them before the work begins: so no file is written that is also read, and
 * none is written twice. */
struct kiln_claims;
struct kiln_claims *kiln_claims_create(void); /* NULL when memory is short */
void kiln_claims_destroy(struct kiln_claims **claims);

/* Declare a file that the call reads or writes. `what` names the file in messages: "a texture",
 * "--manifest". KILN_USAGE when the file was declared before and one of the two declarations is to
 * write it, or when the absolute path of a file to write is KILN_PATH_SIZE or longer;
 * KILN_DEVICE_FAILED when memory is short. A file to read whose path is that long is ignored. */
bool kiln_claims_read(struct kiln_claims *claims, const char *path, const char *what,
                      struct kiln_error *error);
bool kiln_claims_write(struct kiln_claims *claims, const char *path, const char *what,
                       struct kiln_error *error);

/* Does what kiln_claims_read does, for a file that was opened. `status` is what fstat says of it,
 * so it is claimed even if another file has its path by now. */
struct stat;
bool kiln_claims_read_open(struct kiln_claims *claims, const char *path, const char *what,
                           const struct stat *status, struct kiln_error *error);

/* Visits the absolute path of each declared file to read that exists, in no particular order. */
void kiln_claims_visit_read(const struct kiln_claims *claims,
                            void (*visit)(void *user, const char *path), void *user);

/* Declares the files that a job reads (the scene and its assets) and writes. KILN_USAGE when a file
 * would be written that is also read, or written twice, when the output has no known format, or
 * when the ranges do not suit it. kiln_render makes this check for its own job. */
bool kiln_render_claim(const struct kiln_scene *scene, const struct kiln_render_params *params,
                       struct kiln_claims *claims, struct kiln_error *error);

/* Does the same for an export, whose files may not exist unless they are overwritten. kiln_export
 * makes this check for its own job. */
bool kiln_export_claim(const struct kiln_scene *scene, const struct kiln_export_params *params,
                       struct kiln_claims *claims, struct kiln_error *error);

/* Does what kiln_compare does, in a call that also writes `file` (NULL: it does not) for an option:
 * KILN_USAGE where that file is compared or written as well. */
bool kiln_compare_with_output(const struct kiln_compare_params *params, const char *file,
                              const char *option, struct kiln_compare_result *result,
                              struct kiln_error *error);

/* The suffix of files of saved states. Commands write no other files with this suffix. */
#define KILN_STATE_SUFFIX ".kilnstate"

/* ---- Words for people ----------------------------------------------------------------------- */

/* In this section, functions that write to a stream return false when that fails or memory is
 * short. */

/* Write the reference of every scene key, for people, and the JSON schema, for editors. */
bool kiln_scene_write_reference(FILE *out);

/* Writes those keys of the reference that lie at or below a key, such as systems.fire.look, and
 * mention a text; NULL: all. *count: how many were written. */
bool kiln_scene_write_keys(FILE *out, const char *below, const char *text, size_t *count);

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
    const char *choices;  /* that its value may be, "true|false", perhaps beside others; or NULL */
    bool holds_keys;
    bool in_file_only; /* it is resolved before --set */
};

/* Visits all keys in the order of the reference. The texts are valid during the visit. Returns
 * false when memory is short. */
bool kiln_scene_visit_keys(void (*visit)(void *user, const struct kiln_option_key *key),
                           void *user);

/* Returns the introduction of the reference, a static text. */
const char *kiln_scene_introduction(void);

/* Returns whether a scene file is opened below the asset root: whether its path, as it is given,
 * enters the root. Such a file is read only if it lies there (kiln_scene_load). */
bool kiln_scene_is_below(const char *path, const char *asset_root);

/* Visits the names of the entries of `key`, such as "systems", in a scene file and its
 * includes, even if the scene is not valid. Returns false with the error of kiln_scene_load when a
 * file cannot be read as YAML. */
bool kiln_scene_visit_names(const char *path, const char *key,
                            void (*visit)(void *user, const char *name), void *user,
                            struct kiln_error *error);

/* A clip of a mesh. */
struct kiln_mesh_clip {
    const char *name; /* may be empty */
    double seconds;
};

/* A mesh that a scene names. */
struct kiln_mesh_info {
    const char *path; /* from the asset root */
    const char *format;
    uint32_t triangles, vertices;
    float min[3], max[3]; /* bounds of the rest pose, in units of the file */
    uint32_t joints;      /* bones that move vertices */
    uint32_t morph_targets;
    const struct kiln_mesh_clip *clips;
    uint32_t clip_count;
    const char *open;  /* where it is open; "": it is closed */
    const char *looks; /* materials and colours of vertices: a line each */
    const char *notes; /* what was changed or left out: a line each */
    double thinnest;   /* of a closed mesh: its thinnest part, in units of the file; or infinite */
};

/* Visits the meshes of a scene, in the order of their paths; the texts are valid during the visit.
 * Measuring a large mesh takes seconds. Returns false when memory is short. */
bool kiln_scene_visit_meshes(const struct kiln_scene *scene,
                             void (*visit)(void *user, const struct kiln_mesh_info *info),
                             void *user);

/* A domain of gas of a scene. */
struct kiln_gas_info {
    const char *name;
    bool enabled;
    uint32_t cells[3];
    double cell_m;         /* m: edge of a cell */
    uint64_t memory_bytes; /* that it takes where gas fills it */
    uint32_t substeps;     /* least steps of the gas in one of the scene */
};

/* Visits the domains of gas of a scene in their order. */
void kiln_scene_visit_gas(const struct kiln_scene *scene,
                          void (*visit)(void *user, const struct kiln_gas_info *info), void *user);

/* Writes the techniques of each stage and their purposes, for people. */
bool kiln_write_techniques(FILE *out);

/* Visits each technique as "stage=name". */
void kiln_visit_techniques(void (*visit)(void *user, const char *name, const char *help),
                           void *user);

/* Writes the outputs that this build supports, and their options, for people. */
bool kiln_write_outputs(FILE *out);

/* Returns whether the quality changes an output of this name. Also true for a name that is no
 * output: another check reports it. */
bool kiln_output_has_quality(const char *path);

/* Returns whether an output of this name is one file a frame, and not a clip. */
bool kiln_output_is_images(const char *path);

/* Visits the templates of scenes: their names, and summaries of what they show. */
void kiln_visit_templates(void (*visit)(void *user, const char *name, const char *summary),
                          void *user);

/* Writes the names and summaries of the templates, for people. */
bool kiln_write_templates(FILE *out);

/* Returns the text of a template, below a line that tells editors where the schema is. The caller
 * frees it. Returns NULL with KILN_USAGE for an unknown name, or KILN_DEVICE_FAILED when memory is
 * short. */
char *kiln_template_scene(const char *name, struct kiln_error *error);

/* Writes the text of a template into a file, which appears under its name when it is whole; makes
 * missing folders. KILN_USAGE for an unknown name, and for a file that exists without `overwrite`;
 * KILN_IO; KILN_DEVICE_FAILED. */
bool kiln_template_write(const char *name, const char *path, bool overwrite,
                         struct kiln_error *error);

/* Writes the table of limits, for people. */
bool kiln_write_limits(FILE *out);

/* Writes the metrics of comparisons and their purposes, for people. */
bool kiln_write_metrics(FILE *out);

/* Visits the metrics that have a fixed name. */
void kiln_visit_metrics(void (*visit)(void *user, const char *name, const char *help), void *user);

/* The largest text of a scene, in bytes. */
enum { KILN_MAX_SCENE_SIZE = 4 << 20 };

/* ---- Text files ------------------------------------------------------------------------------ */

struct kiln_text_file;

/* Opens a text file that appears under its name when it is closed; makes missing folders. Returns
 * NULL with KILN_USAGE when the file exists and `overwrite` is not set, or with KILN_IO. */
struct kiln_text_file *kiln_text_file_open(const char *path, bool overwrite,
                                           struct kiln_error *error);

/* Returns the stream to print into. kiln_text_file_close closes it. */
FILE *kiln_text_file_stream(const struct kiln_text_file *text);

/* Gives the file its name or, without `keep`, removes it. On KILN_IO it is removed, too. */
bool kiln_text_file_close(struct kiln_text_file **text, bool keep, struct kiln_error *error);

/* ---- Text: as kiln reads and writes it, for programs that take the same --------------------- */

/* Read a whole text as a decimal number, whose point is '.' in any locale. They return false when
 * the text is not a finite number, or not one that fits. */
bool kiln_text_to_double(const char *text, double *value);
bool kiln_text_to_uint64(const char *text, uint64_t *value);

/* Returns the value of a variable of the environment; NULL where it is not set or empty. */
const char *kiln_environment(const char *name);

/* Reads a whole text as a time: seconds, or a number with one of the units ms, s, min and h. */
bool kiln_text_to_seconds(const char *text, double *seconds);

/* Returns the candidate nearest to `name` by edit distance (a swap of adjacent characters counts
 * once), or NULL when none is near enough to be a misspelling. */
const char *kiln_text_nearest(const char *name, const char *const *candidates, size_t count);

/* Writes a word, quoted if need be, so that a shell reads it as one word. Returns false when
 * writing fails. */
bool kiln_write_shell_word(FILE *out, const char *word);

/* Copies an untrusted text so that it has no effect on a terminal, a log or a page: controls,
 * overrides of direction and bytes that are not UTF-8 become escapes such as \n, \x1b or \u202e,
 * and a blank breaks what a server of continuous integration would take for a command, such as
 * "##vso[", or "::" at the start. A text that was copied so before stays as it is. A text longer
 * than `room` is cut between characters. `out` may not be `text`. Messages of errors and of the log
 * are already copied so. */
void kiln_shown(char *out, size_t room, const char *text);

/* Returns whether a text has such a command of a server anywhere, or at its start. */
bool kiln_has_marker(const char *text);

#include "kiln_batch.h"
#include "kiln_bench.h"
#include "kiln_figure.h"
#include "kiln_json.h"
#include "kiln_test.h"

#endif
