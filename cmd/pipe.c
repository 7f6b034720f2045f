/* Prepares `--output -`: frames go to a copy of standard output's descriptor, and standard output
 * itself becomes standard error, so that nothing but frames goes to the reader.
 *
 * kiln render calls pipe_read before it loads scenes, since jobs depend on whether there is a
 * stream, and pipe_open after that, before it prints the device. pipe_open must stay before the
 * first line of output, which would otherwise be the start of the video. */
#include "pipe.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#include "report.h"

int pipe_read(struct kiln_stream *stream, const struct arguments *arguments)
{
    const struct option_use *output = arguments_last(arguments, "output");
    const bool wanted = output && strcmp(output->text, "-") == 0;
    if (!wanted)
        return arguments_last(arguments, "pipe")
                   ? report(KILN_USAGE, "render: --pipe: needs '--output -'")
                   : 0;
    if (isatty(STDOUT_FILENO))
        return report(KILN_USAGE, "render: --output -: standard output is a terminal, not a pipe");
    stream->format =
        (enum kiln_stream_format)(KILN_STREAM_Y4M + arguments_choice(arguments, "pipe", 0));
    return 0;
}

int pipe_open(struct kiln_stream *stream)
{
    if (stream->format == KILN_STREAM_NONE)
        return 0;
    stream->descriptor = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    if (stream->descriptor >= 0 && dup2(STDERR_FILENO, STDOUT_FILENO) >= 0)
        return 0;
    return report(KILN_IO, "standard output: %s", strerror(errno));
}
