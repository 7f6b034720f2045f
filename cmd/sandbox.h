/* Confines the process of a command to the files of its job, for --sandbox and the environment's
 * KILN_SANDBOX. */
#ifndef KILN_CMD_SANDBOX_H
#define KILN_CMD_SANDBOX_H

#include "command.h"

#define SANDBOX_OPTION                                                                             \
    {                                                                                              \
        .name = "sandbox", .value_is_optional = true, .kind = OPTION_CHOICE,                       \
        .placeholder = "on|require|off",                                                           \
        .help = "Give up all rights that the job does not need, on the device 'cpu': other "       \
                "files, sockets, other programs. With 'require', the command ends with exit code " \
                "5 where the kernel cannot do that (see 'kiln devices').",                         \
        .fallback = "the environment's KILN_SANDBOX, or else off"                                  \
    }

/* Closes all descriptors that the process was started with, except the standard streams and those
 * that an argument names ("/dev/fd/63", "ndjson:fd=3"), if --sandbox or KILN_SANDBOX asks for a
 * sandbox. A job that is taken over could use them. Call it before kiln opens a file. */
void sandbox_close_inherited(const struct arguments *arguments);

/* Confines the process to the files that its arguments name, if --sandbox or KILN_SANDBOX asks for
 * that, and sets *sandboxed then. Call it before the first thread starts. Returns 0, or the exit
 * code after reporting. */
int sandbox_enter(const struct command *command, const struct arguments *arguments,
                  bool *sandboxed);

#endif
