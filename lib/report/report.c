/* Holds the table of formats of reports, and writes reports to files or to standard output. A file
 * that kiln has not written as a report of that format is replaced only by --force. */
#include "report/report.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file_in.h"
#include "base/temporary.h"

static const struct kiln_report_format *const formats[] = {
    &kiln_report_junit, &kiln_report_json, &kiln_report_tap, &kiln_report_github, &kiln_report_html,
};
enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

static const struct kiln_report_format *find_format(const char *name, struct kiln_error *error)
{
    char allowed[256] = "";
    size_t length = 0;
    for (size_t i = 0; i < FORMAT_COUNT; i++) {
        if (strcmp(formats[i]->name, name) == 0)
            return formats[i];
        length += (size_t)snprintf(allowed + length, sizeof allowed - length, "%s%s", i ? ", " : "",
                                   formats[i]->name);
    }
    kiln_error_set(error, KILN_USAGE, "'%s' is not a format of a report; there are %s", name,
                   allowed);
    return NULL;
}

/* Writes a report to a stream. Any write may fail; the stream is checked once at the end. */
static bool write_to(const struct kiln_report_format *format, const struct kiln_results *results,
                     const struct kiln_results_output *output, FILE *out, struct kiln_error *error)
{
    errno = 0;
    if (!format->write(results, output, out, error))
        return false;
    if (fflush(out) == 0 && !ferror(out))
        return true;
    const char *name = strcmp(output->path, "-") == 0 ? "standard output" : output->path;
    return kiln_error_set_errno(error, KILN_IO, errno ? errno : EIO,
                                "%s: the report cannot be written", name);
}

/* Opens another stream on the file. The caller closes the stream before it commits the file. */
static FILE *open_stream(const struct kiln_temporary *file)
{
    int copy = dup(file->file);
    FILE *out = copy < 0 ? NULL : fdopen(copy, "wb");
    if (!out && copy >= 0)
        close(copy);
    return out;
}

/* Returns whether a file is a report of the format that kiln wrote; false if it cannot be read. It
 * may lie in the folder of a stranger's results, so it is not waited for. */
static bool is_own(const struct kiln_report_format *format, const char *path)
{
    char start[256] = "";
    const size_t length = format->start ? strlen(format->start) : 0;
    const int file = length > 0 ? open(path, KILN_FILE_FLAGS) : -1;
    bool own = file >= 0 && length <= sizeof start &&
               pread(file, start, length, 0) == (ssize_t)length &&
               memcmp(start, format->start, length) == 0;
    if (file >= 0)
        close(file);
    return own;
}

/* Checks that the file may be replaced. An empty file may always be, since nothing is lost. */
static bool check_target(const struct kiln_report_format *format,
                         const struct kiln_results_output *output, struct kiln_error *error)
{
    struct stat status;
    if (!kiln_target_check(output->path, true, error))
        return false;
    return output->overwrite || stat(output->path, &status) != 0 || status.st_size == 0 ||
           is_own(format, output->path) ||
           kiln_error_set(error, KILN_USAGE,
                          "%s: the file exists, and %s did not write it (--force replaces it)",
                          output->path, format->option);
}

bool kiln_results_claim(const struct kiln_results_output *output, struct kiln_claims *claims,
                        struct kiln_error *error)
{
    const struct kiln_report_format *format = find_format(output->format, error);
    if (!format)
        return false;
    return strcmp(output->path, "-") == 0 ||
           (kiln_claims_write(claims, output->path, format->option, error) &&
            check_target(format, output, error));
}

static bool write_file(const struct kiln_report_format *format, const struct kiln_results *results,
                       const struct kiln_results_output *output, struct kiln_error *error)
{
    struct kiln_temporary file = {0};
    if (!check_target(format, output, error) || !kiln_make_parent_folders(output->path, error) ||
        !kiln_temporary_open(&file, output->path, error))
        return false;
    FILE *out = open_stream(&file);
    bool good = out && write_to(format, results, output, out, error);
    if (!out || (fclose(out) != 0 && good))
        good = kiln_error_set_errno(error, KILN_IO, errno, "%s: the report cannot be written",
                                    output->path);
    if (good)
        return kiln_temporary_commit(&file, true, error);
    kiln_temporary_discard(&file);
    return false;
}

bool kiln_results_write(const struct kiln_results *results,
                        const struct kiln_results_output *output, struct kiln_error *error)
{
    const struct kiln_report_format *format = find_format(output->format, error);
    if (!format)
        return false;
    if (strcmp(output->path, "-") == 0)
        return write_to(format, results, output, stdout, error);
    return write_file(format, results, output, error);
}

bool kiln_write_reports(FILE *out)
{
    fprintf(out, "Reports of golden-image tests:\n\n");
    for (size_t i = 0; i < FORMAT_COUNT; i++)
        fprintf(out, "  %-7s %s\n", formats[i]->name, formats[i]->help);
    return !ferror(out);
}
