/* Measures files that are whole (size and hash), and lists the files that an output consists of. */
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/pattern.h"
#include "base/ranges.h"
#include "output/formats.h"

bool kiln_finished_file_measure(struct kiln_finished_file *finished, struct kiln_error *error)
{
    struct stat status;
    if (stat(finished->path, &status) != 0 ||
        !kiln_hash_sha256_file(finished->path, finished->sha256))
        return kiln_error_set_errno(error, KILN_IO, errno, "%s: the file cannot be read again",
                                    finished->path);
    finished->bytes = (uint64_t)status.st_size;
    return true;
}

bool kiln_output_clip_file(const struct kiln_output_params *params, uint32_t index, char *path,
                           struct kiln_error *error)
{
    const struct kiln_format *format = params->format;
    char clip[KILN_PATH_SIZE];
    path[0] = '\0';
    if (!kiln_output_file(params, 0, clip, error))
        return false;
    if (index == 0) {
        memcpy(path, clip, sizeof clip);
        return true;
    }
    const char *ending = format->beside ? format->beside(params, index - 1) : NULL;
    return !ending || kiln_format_beside(clip, ending, path);
}

enum kiln_numbering kiln_output_numbering(const struct kiln_output_params *params)
{
    if (params->format->one_file)
        return KILN_NUMBER_NEVER;
    bool one = params->clip_count == 1 && params->clip[0].first == params->clip[0].last;
    return one ? KILN_NUMBER_IF_ASKED : KILN_NUMBER_ALWAYS;
}

bool kiln_output_file(const struct kiln_output_params *params, uint32_t frame,
                      char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    struct kiln_path_pattern pattern;
    if (!kiln_path_pattern_parse(&pattern, params->path, kiln_output_numbering(params), error))
        return false;
    return kiln_path_pattern_format(&pattern, frame, path, KILN_PATH_SIZE) ||
           kiln_error_set(error, KILN_USAGE, "%s: the path is too long", params->path);
}

uint32_t kiln_output_file_count(const struct kiln_output_params *params)
{
    const struct kiln_format *format = params->format;
    uint32_t count =
        format->one_file ? 1 : (uint32_t)kiln_ranges_count(params->clip, params->clip_count);
    for (uint32_t i = 0; format->beside && format->beside(params, i); i++)
        count++;
    return count;
}
