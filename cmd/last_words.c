/* A reader of standard error that has stalled must not keep the program, so it is asked first: a
 * pipe that is ready takes PIPE_BUF bytes. Stdio's lock may be held by whoever hangs. */
#include "last_words.h"

#include <poll.h>
#include <string.h>
#include <unistd.h>

#include "event.h"

static const char prefix[] = "kiln: ";

_Noreturn void end_with_words(const char *line, int code)
{
    kiln_abandon_outputs();
    events_last_words(strncmp(line, prefix, sizeof prefix - 1) ? line : line + sizeof prefix - 1,
                      code);
    if (poll(&(struct pollfd){.fd = STDERR_FILENO, .events = POLLOUT}, 1, 0) == 1) {
        const ssize_t written = write(STDERR_FILENO, line, strlen(line));
        (void)written;
    }
    _exit(code);
}
