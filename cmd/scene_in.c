/* Loads the scene that an operand names: a file, or a descriptor that is open already. Commands
 * that take scenes (render, check, plan, bake) call scene_in_load for each, on the main thread.
 *
 * A file is loaded by kiln_scene_load, which refuses a named FIFO: opening it would wait for a
 * writer that may never come. "-", /dev/stdin and /dev/fd/N name a descriptor that is open when
 * kiln starts, so the scene is read from it here and then parsed. Such a scene has no folder, so
 * the paths in it start at the working directory, or at the folder of --asset-root.
 *
 * Two other threads look at `loading`: those of watchdog.c and limits.c end the program and name
 * the scene in their last line. So it is atomic, and it points to an operand or a constant, which
 * stays valid after the scene is loaded. */
#include "scene_in.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "event.h"
#include "report.h"

enum { NO_DESCRIPTOR = -1 };

static const char *_Atomic loading; /* the scene that is being loaded, or NULL */

/* Returns the descriptor that an operand stands for, or NO_DESCRIPTOR. */
static int descriptor_of(const char *path)
{
    static const char *const folders[] = {"/dev/fd/", "/proc/self/fd/"};
    if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdin") == 0)
        return STDIN_FILENO;
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        const size_t length = strlen(folders[i]);
        uint64_t number;
        if (strncmp(path, folders[i], length) == 0 && kiln_text_to_uint64(path + length, &number) &&
            number <= INT32_MAX)
            return (int)number;
    }
    return NO_DESCRIPTOR;
}

bool scene_in_is_stream(const char *path)
{
    return descriptor_of(path) != NO_DESCRIPTOR;
}

static const char *name_of(const char *path)
{
    return strcmp(path, "-") == 0 ? "standard input" : path;
}

/* Returns whether to repeat a read that failed. Yes after a signal that does not stop the program,
 * and yes for a descriptor in non-blocking mode, once it has something to read. */
static bool should_retry_read(int file, const struct kiln_scene_params *params)
{
    if (errno == EAGAIN && poll(&(struct pollfd){.fd = file, .events = POLLIN}, 1, -1) > 0)
        return true;
    return errno == EINTR && !(params->stop && params->stop(params->user));
}

/* Reads to the end, but at most one byte more than a scene may have: kiln_scene_parse then refuses
 * the scene as too large. Returns false with errno when reading fails. */
static bool read_all(int file, char *text, size_t *size, const struct kiln_scene_params *params)
{
    while (*size <= KILN_MAX_SCENE_SIZE) {
        const ssize_t got = read(file, text + *size, KILN_MAX_SCENE_SIZE + 1 - *size);
        if (got == 0)
            return true;
        if (got < 0 && !should_retry_read(file, params))
            return false;
        *size += got > 0 ? (size_t)got : 0;
    }
    return true;
}

static struct kiln_scene *load(const char *path, const struct kiln_scene_params *params,
                               struct kiln_error *error)
{
    const int file = descriptor_of(path);
    if (file == NO_DESCRIPTOR)
        return kiln_scene_load(path, params, error);
    const char *name = name_of(path);
    struct kiln_scene *scene = NULL;
    size_t size = 0;
    char *text = malloc(KILN_MAX_SCENE_SIZE + 1);
    if (!text) {
        error->code = KILN_DEVICE_FAILED;
        snprintf(error->message, sizeof error->message, "out of memory for reading %s", name);
    } else if (!read_all(file, text, &size, params)) {
        error->code = errno == EINTR ? KILN_INTERRUPTED : KILN_IO;
        snprintf(error->message, sizeof error->message, "%s: the scene cannot be read: %s", name,
                 strerror(errno)); /* NOLINT(concurrency-mt-unsafe): one thread calls it */
    } else {
        scene = kiln_scene_parse(text, size, name, params, error);
    }
    free(text);
    return scene;
}

struct kiln_scene *scene_in_load(const char *path, const struct kiln_scene_params *params,
                                 struct kiln_error *error)
{
    loading = name_of(path);
    struct kiln_scene *scene = load(path, params, error);
    loading = NULL;
    if (scene) {
        struct kiln_scene_info info = kiln_scene_info_empty();
        kiln_scene_get_info(scene, &info);
        event_loaded(path, &info);
    }
    return scene;
}

bool scene_in_describe(char out[KILN_MESSAGE_SIZE])
{
    const char *path = loading;
    char shown[KILN_MESSAGE_SIZE - 16];
    if (!path)
        return false;
    kiln_shown(shown, sizeof shown, path);
    snprintf(out, KILN_MESSAGE_SIZE, "loading %s", shown);
    return true;
}

int scene_in_check(const struct arguments *arguments, const char *place)
{
    for (size_t i = 0; i < arguments->operand_count; i++) {
        const int file = descriptor_of(arguments->operands[i]);
        for (size_t j = 0; j < i && file != NO_DESCRIPTOR; j++) {
            if (descriptor_of(arguments->operands[j]) == file)
                return report(KILN_USAGE, "%s: %s can be read only once", place,
                              name_of(arguments->operands[i]));
        }
    }
    return 0;
}
