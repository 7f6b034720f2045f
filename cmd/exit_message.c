/* Ends the program with one last line on standard error and with an exit code. Stdio is not used,
 * since a thread that hangs may hold its lock. A stalled reader of standard error must not block
 * the end, so poll checks first: a pipe that is ready takes PIPE_BUF bytes. */
#include "exit_message.h"

#include <poll.h>
#include <string.h>
#include <unistd.h>

#include "event.h"

static const char prefix[] = "kiln: ";

_Noreturn void exit_with_message(const char *line, int code)
{
    kiln_abandon_outputs();
    events_write_final(strncmp(line, prefix, sizeof prefix - 1) ? line : line + sizeof prefix - 1,
                       code);
    if (poll(&(struct pollfd){.fd = STDERR_FILENO, .events = POLLOUT}, 1, 0) == 1) {
        const ssize_t written = write(STDERR_FILENO, line, strlen(line));
        (void)written;
    }
    _exit(code);
}
