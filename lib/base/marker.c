/* Has the table of the markers of servers of continuous integration, each with the place that
 * defines it. Markers that need a control character (sections of GitLab, notes of Jenkins, images
 * of Buildkite) are not here, since no output of kiln has control characters of a text. */
#include "base/marker.h"

#include <string.h>
#include <strings.h>

#include "kiln_program.h"

static const struct {
    const char *text;
    uint8_t before; /* bytes that stay before the sign that breaks the marker */
    bool at_start;  /* the marker counts only at the start of a line, after white space */
} markers[] = {
    /* GitHub's runner, src/Runner.Common/ActionCommand.cs, TryParseV2: "::set-output name=a::b" */
    {"::", 1, true},
    /* TryParse in the same file takes "##[set-env name=A]b", anywhere in a line. Azure Pipelines,
     * "Logging commands", has "##[group]" and its like. */
    {"##[", 1, false},
    /* Azure Pipelines, "Logging commands"; its agent, Microsoft.VisualStudio.Services.Agent/
     * Command.cs, looks for it anywhere in a line: "##vso[task.setvariable variable=A]b" */
    {"##vso[", 1, false},
    /* TeamCity, "Service messages": "##teamcity[setParameter name='a' value='b']" */
    {"##teamcity[", 1, false},
    /* The plugin "JUnit Attachments" of Jenkins, README, and GitLab, "Unit test reports", "View
     * JUnit screenshots": "[[ATTACHMENT|/etc/passwd]]" uploads the file. */
    {"[[ATTACHMENT|", 1, false},
    /* Open Job Description, "How Jobs Are Run", "Stdout/Stderr messages": "openjd_env: PATH=/tmp"
     * sets a variable for all later tasks of a session. */
    {"openjd_", 6, true},
};

size_t kiln_marker_break(const char *text, bool starts_line)
{
    if (*text != ':' && *text != '#' && *text != '[' && *text != 'o' && *text != 'O')
        return 0; /* most characters start no marker */
    for (size_t i = 0; i < sizeof markers / sizeof *markers; i++) {
        if ((starts_line || !markers[i].at_start) &&
            strncasecmp(text, markers[i].text, strlen(markers[i].text)) == 0)
            return markers[i].before;
    }
    return 0;
}

bool kiln_has_marker(const char *text)
{
    bool starts_line = true;
    for (; *text; text++) {
        if (kiln_marker_break(text, starts_line) > 0)
            return true;
        starts_line = kiln_marker_starts_line(*text, starts_line);
    }
    return false;
}

bool kiln_marker_starts_line(char c, bool starts_line)
{
    return c == '\n' || c == '\r' ||
           (starts_line && (c == ' ' || c == '\t' || c == '\v' || c == '\f'));
}

void kiln_marker_write(FILE *out, const char *text,
                       size_t (*put)(FILE *out, const char *text, const void *how), const void *how)
{
    bool starts_line = true;
    while (*text) {
        const char *const end = text + kiln_marker_break(text, starts_line);
        const bool is_marker = end > text;
        starts_line = kiln_marker_starts_line(*text, starts_line);
        do {
            text += put(out, text, how);
        } while (text < end);
        if (is_marker)
            fputc(' ', out);
    }
}
