/* Files that have their names: their sizes and hashes, and which ones a clip consists of. */
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/pattern.h"
#include "output/formats.h"

bool kiln_whole_measure(struct kiln_whole *whole, struct kiln_error *error)
{
    struct stat status;
    if (stat(whole->path, &status) != 0 || !kiln_hash_sha256_file(whole->path, whole->sha256))
        return kiln_error_set_errno(error, KILN_IO, errno, "%s: the file cannot be read again",
                                    whole->path);
    whole->bytes = (uint64_t)status.st_size;
    return true;
}

bool kiln_output_clip_file(const struct kiln_output_params *params, uint32_t index, char *path,
                           struct kiln_error *error)
{
    const struct kiln_format *format = params->format;
    struct kiln_path_pattern pattern;
    char clip[KILN_PATH_SIZE];
    path[0] = '\0';
    if (!kiln_path_pattern_parse(&pattern, params->path, KILN_NUMBER_NEVER, error) ||
        !kiln_path_pattern_format(&pattern, 0, clip, sizeof clip))
        return false;
    if (index == 0) {
        memcpy(path, clip, sizeof clip);
        return true;
    }
    const char *ending = format->beside ? format->beside(params, index - 1) : NULL;
    return !ending || kiln_format_beside(clip, ending, path);
}
