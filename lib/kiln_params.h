/* Declares what the values of a scene come from: its parameters, and the files that it was read
 * from. This header is part of kiln.h, which includes it. */
#ifndef KILN_PARAMS_H
#define KILN_PARAMS_H

#include "kiln.h"

#ifdef __cplusplus
extern "C" {
#endif

enum kiln_param_kind {
    KILN_PARAM_NUMBER,
    KILN_PARAM_INTEGER,
    KILN_PARAM_COLOR,
    KILN_PARAM_VECTOR,
    KILN_PARAM_CHOICE,
    KILN_PARAM_SWITCH,
    KILN_PARAM_TEXT,
    KILN_PARAM_FILE
};

/* Returns the word for a kind, as a scene writes it: "number". */
KILN_API const char *kiln_param_kind_name(enum kiln_param_kind kind);

/* A parameter of a scene, for a caller that asks people for its value. The texts live as long as
 * the scene. Values are JSON, as a file of parameters may have them and as an override
 * "params.NAME=VALUE" takes them: numbers are in `unit`, and angles are texts with their unit. */
struct kiln_scene_param {
    size_t size;
    const char *name;
    const char *help; /* "" without one */
    enum kiln_param_kind kind;
    bool has_min, has_max;
    const char *unit;         /* of its numbers, such as "s"; "" for none */
    const char *value;        /* that the scene was loaded with */
    const char *fallback;     /* the default that the scene declares */
    double min, max;          /* in `unit`, of a number, an integer, or each part of a vector */
    const char *const *words; /* of a choice */
    size_t word_count;
    const char *place;  /* of the declaration: "scene.yaml:3:3" */
    const char *schema; /* JSON schema of its values */
};
KILN_EMPTY(kiln_scene_param, kiln_scene_param_empty)

/* Lists the parameters of a scene, in the order of its file and its includes, into up to `capacity`
 * entries. The entries lie `stride` bytes apart, and the caller sets the size of each. Returns how
 * many parameters there are, which may be more than capacity. */
KILN_API size_t kiln_scene_list_params(const struct kiln_scene *scene,
                                       struct kiln_scene_param *params, size_t stride,
                                       size_t capacity);

/* Writes the scene as kiln_scene_print does, with a comment behind each line that says from which
 * file and line it came, or "default". The scene was loaded with keep_origins; otherwise returns
 * false. */
KILN_API bool kiln_scene_print_origins(const struct kiln_scene *scene, FILE *out);

#ifdef __cplusplus
}
#endif

#endif
