/* Reads scenes as commands name them: a file, or "-" and its relatives for a scene that comes
 * through standard input or a pipe of the shell. */
#ifndef KILN_CMD_SCENE_IN_H
#define KILN_CMD_SCENE_IN_H

#include "options.h"

/* Whether the operand is read from an open descriptor: "-", /dev/stdin, /dev/fd/N. What such a
 * scene names lies below the working directory, unless --asset-root says another folder. */
bool scene_in_is_stream(const char *path);

/* kiln_scene_load for both, which tells the event `loaded`. Errors of "-" call it standard input.
 */
struct kiln_scene *scene_in_load(const char *path, const struct kiln_scene_params *params,
                                 struct kiln_error *error);

/* Describes the scene that a thread is just loading: "loading rain.yaml"; false if none is. For
 * threads that end a program which is over a limit. */
bool scene_in_describe(char out[KILN_MESSAGE_SIZE]);

/* Returns 0, or the exit code after reporting that two operands would read the same descriptor. */
int scene_in_check(const struct arguments *arguments, const char *place);

#endif
