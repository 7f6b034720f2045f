/* Opens the files in a folder of results below that folder, without links at their end. Names are
 * checked by the rules by which kiln makes them, so that no folder can have a name that a report, a
 * shell or a log would take for something else. */
#include "suite/result_file.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "base/error.h"
#include "base/file.h"
#include "base/file_in.h"
#include "suite/golden.h"
#include "suite/test_name.h"

/* ---- Names ----------------------------------------------------------------------------------- */

bool kiln_result_name_is_valid(const char *name)
{
    char test[KILN_TEST_MAX_NAME + 1], device[KILN_DEVICE_NAME_SIZE];
    const size_t length = strcspn(name, "@");
    if (length >= sizeof test)
        return false;
    memcpy(test, name, length);
    test[length] = '\0';
    const bool is_path =
        *test != '/' && !strstr(test, "//") && length > 0 && test[length - 1] != '/';
    if (!is_path || !kiln_test_name_is_valid(test))
        return false;
    if (name[length] == '\0')
        return true;
    const char *const given = name + length + 1;
    if (strlen(given) >= sizeof device)
        return false;
    kiln_device_name(given, device);
    return *device && strcmp(device, given) == 0;
}

bool kiln_result_file_is_name(const char *name)
{
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                  "._-";
    return *name && *name != '.' && *name != '-' && !name[strspn(name, allowed)];
}

/* ---- Files ----------------------------------------------------------------------------------- */

static int open_file(const struct kiln_result_place *place, const struct kiln_result_file *file,
                     char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    char below[KILN_PATH_SIZE];
    if (!kiln_path_join(below, place->name, file->name, error) ||
        !kiln_path_join(path, place->results, below, error))
        return -1;
    const int opened = kiln_file_open_below(place->results, below, KILN_FILE_FLAGS | O_NOFOLLOW);
    if (opened < 0 && (errno == EXDEV || errno == ELOOP))
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the path is a link, or leads by one out of the folder of results; "
                       "allowed are plain files below %s",
                       path, place->results);
    else if (opened < 0)
        kiln_error_set_errno(error, KILN_IO, errno, "%s: the %s cannot be opened", path,
                             file->what);
    return opened;
}

int kiln_result_file_open(const struct kiln_result_place *place,
                          const struct kiln_result_file *file, char path[KILN_PATH_SIZE],
                          size_t *size, struct kiln_error *error)
{
    const int opened = open_file(place, file, path, error);
    if (opened >= 0 && !(kiln_file_check(opened, path, file->what, file->allowed, size, error) &&
                         kiln_file_check_size(path, file->what, *size, file->limit, error))) {
        close(opened);
        return -1;
    }
    return opened;
}

struct kiln_result_file kiln_result_picture(const char *name)
{
    return (struct kiln_result_file){.name = name,
                                     .what = "image",
                                     .allowed = KILN_IMAGE_FORMATS,
                                     .limit = KILN_MAX_IMAGE_BYTES};
}

unsigned char *kiln_result_picture_read(const struct kiln_result_place *place, const char *name,
                                        size_t *size, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    const struct kiln_result_file picture = kiln_result_picture(name);
    const int file = kiln_result_file_open(place, &picture, path, size, error);
    if (file < 0)
        return NULL;
    unsigned char *bytes = kiln_file_read_bytes(file, path, picture.what, *size, error);
    close(file);
    return bytes;
}

/* ---- Folders --------------------------------------------------------------------------------- */

bool kiln_result_folder_check(const struct kiln_result_place *place, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct stat status;
    if (!kiln_path_join(path, place->results, place->name, error))
        return false;
    for (char *slash = path + strlen(place->results); slash; slash = strchr(slash + 1, '/')) {
        char *const end = strchr(slash + 1, '/');
        if (end)
            *end = '\0';
        const bool is_link = lstat(path, &status) == 0 && S_ISLNK(status.st_mode);
        if (is_link)
            return kiln_error_set(error, KILN_USAGE,
                                  "%s: the folder of a result is a link; results need folders of "
                                  "their own",
                                  path);
        if (end)
            *end = '/';
    }
    return true;
}
