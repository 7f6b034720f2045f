/* Confines a command to its job: --sandbox and the environment's KILN_SANDBOX. */
#ifndef KILN_CMD_SANDBOX_H
#define KILN_CMD_SANDBOX_H

#include "command.h"

#define SANDBOX_OPTION                                                                             \
    {                                                                                              \
        .name = "sandbox", .value_may_go = true, .kind = OPTION_CHOICE,                            \
        .placeholder = "on|require|off",                                                           \
        .help = "Give up all rights that the job does not need, on the device 'cpu': files "       \
                "elsewhere, sockets, other programs. With 'require' it is exit code 5 where the "  \
                "kernel cannot do that (see 'kiln devices').",                                     \
        .fallback = "the environment's KILN_SANDBOX, or else off"                                  \
    }

/* Before the first thread of a command that has the option: confines the process to the files that
 * its arguments name. Returns 0, or the exit code after reporting. Where it confines, *sandboxed is
 * set. */
int sandbox_enter(const struct command *command, const struct arguments *arguments,
                  bool *sandboxed);

#endif
