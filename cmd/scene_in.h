/* Loads the scenes that operands name: a file, or "-", /dev/stdin or /dev/fd/N for a scene that
 * comes through standard input or a pipe of the shell. */
#ifndef KILN_CMD_SCENE_IN_H
#define KILN_CMD_SCENE_IN_H

#include "options.h"

/* Returns whether the operand is read from an open descriptor: "-", /dev/stdin, /dev/fd/N. The
 * files of such a scene lie below the working directory, or below the folder of --asset-root. */
bool scene_in_is_stream(const char *path);

/* Loads a scene from a file or a descriptor, as kiln_scene_load does, and writes the event
 * `loaded`. Errors call "-" standard input. */
struct kiln_scene *scene_in_load(const char *path, const struct kiln_scene_params *params,
                                 struct kiln_error *error);

/* Describes the scene that is being loaded: "loading rain.yaml". Returns false if there is none.
 * Threads that end a program over a limit use it. */
bool scene_in_describe(char out[KILN_MESSAGE_SIZE]);

/* Returns 0, or the exit code after reporting that two operands would read the same descriptor. */
int scene_in_check(const struct arguments *arguments, const char *place);

#endif
