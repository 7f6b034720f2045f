/* Opens the files that a scene names, below the asset root and nowhere else, even if links are
 * swapped meanwhile, and hands out the processes that decode them. */
#include "asset/loader/loader.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/file_in.h"
#include "base/hash.h"
#include "base/log.h"

struct known {
    struct known *next;
    uint32_t size[2];
    char path[];
};

struct kiln_loader {
    struct kiln_loader_params params;
    struct kiln_caller caller;
    struct kiln_loader_warn warn;
    bool is_counted;       /* true: files are not counted any more */
    pthread_mutex_t mutex; /* guards the members below */
    struct kiln_helper *idle[KILN_DECODE_KIND_COUNT];
    struct known *known;
    uint64_t largest_picture; /* bytes */
};

/* ---- creating and destroying ----------------------------------------------------------------- */

static bool ask(void *user, struct kiln_error *error)
{
    const struct kiln_loader_params *params = user;
    if (kiln_cancel_is_requested(params->cancel) || (params->stop && params->stop(params->user)))
        return kiln_error_set(error, KILN_INTERRUPTED,
                              "stopped while reading the files of a scene");
    return kiln_budget_is_kept(params->budget, error);
}

struct kiln_loader *kiln_loader_create(const struct kiln_loader_params *params)
{
    struct kiln_loader *loader = calloc(1, sizeof *loader);
    if (!loader)
        return NULL;
    if (pthread_mutex_init(&loader->mutex, NULL) != 0) {
        free(loader);
        return NULL;
    }
    loader->params = *params;
    loader->caller = (struct kiln_caller){ask, &loader->params};
    return loader;
}

void kiln_loader_rest(struct kiln_loader *loader)
{
    if (!loader)
        return;
    pthread_mutex_lock(&loader->mutex);
    for (int i = 0; i < KILN_DECODE_KIND_COUNT; i++)
        kiln_helper_end(&loader->idle[i]);
    pthread_mutex_unlock(&loader->mutex);
}

void kiln_loader_destroy(struct kiln_loader **loader)
{
    struct kiln_loader *ending = *loader;
    if (!ending)
        return;
    kiln_loader_rest(ending);
    for (struct known *one = ending->known, *next; one; one = next) {
        next = one->next;
        free(one);
    }
    pthread_mutex_destroy(&ending->mutex);
    free(ending);
    *loader = NULL;
}

void kiln_loader_stop_counting(struct kiln_loader *loader, struct kiln_budget *budget)
{
    if (!loader)
        return;
    loader->params.budget = budget;
    loader->is_counted = true;
}

const struct kiln_caller *kiln_loader_caller(const struct kiln_loader *loader)
{
    return loader ? &loader->caller : NULL;
}

struct kiln_budget *kiln_loader_budget(const struct kiln_loader *loader)
{
    return loader && !loader->is_counted ? loader->params.budget : NULL;
}

/* ---- warnings -------------------------------------------------------------------------------- */

void kiln_loader_set_warn(struct kiln_loader *loader, struct kiln_loader_warn warn)
{
    if (loader)
        loader->warn = warn;
}

void kiln_loader_warn(const struct kiln_loader *loader, const char *path, const char *format, ...)
{
    char text[KILN_MESSAGE_SIZE];
    va_list args;
    if (!loader || !loader->warn.write)
        return;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    loader->warn.write(loader->warn.user, path, text);
}

void kiln_loader_log(void *log, const char *path, const char *text)
{
    kiln_log_write(log, KILN_LOG_WARNING, "%s: %s", path, text);
}

/* ---- files ----------------------------------------------------------------------------------- */

static int open_file(const struct kiln_loader *loader, const struct kiln_loader_file *file,
                     struct kiln_error *error)
{
    const char *root = loader ? loader->params.root : NULL;
    const char *relative = root ? kiln_path_below(file->path, root) : NULL;
    if (root && !relative) {
        kiln_error_set(error, KILN_INVALID_INPUT, "%s: the path leads outside the asset root",
                       file->path);
        return -1;
    }
    const int found = root ? kiln_file_open_below(root, relative, KILN_FILE_FLAGS)
                           : open(file->path, KILN_FILE_FLAGS);
    if (found < 0 && root && (errno == EXDEV || errno == ELOOP))
        kiln_error_set(error, KILN_INVALID_INPUT, "%s: the path leads outside the asset root",
                       file->path);
    else if (found < 0)
        kiln_error_set_errno(error, KILN_IO, errno, "%s: the %s cannot be opened", file->path,
                             file->what);
    return found;
}

int kiln_loader_open(struct kiln_loader *loader, const struct kiln_loader_file *file, size_t *size,
                     struct kiln_error *error)
{
    int opened = open_file(loader, file, error);
    if (opened >= 0 &&
        !(kiln_file_check(opened, file->path, file->what, file->allowed, size, error) &&
          kiln_file_check_size(file->path, file->what, *size, file->most_bytes, error) &&
          kiln_budget_take(kiln_loader_budget(loader), KILN_LIMIT_asset_bytes, *size, file->path,
                           error))) {
        close(opened);
        opened = -1;
    }
    return opened;
}

unsigned char *kiln_loader_read(struct kiln_loader *loader, const struct kiln_loader_file *file,
                                size_t *size, struct kiln_error *error)
{
    const int opened = kiln_loader_open(loader, file, size, error);
    if (opened < 0)
        return NULL;
    unsigned char *bytes = kiln_file_read_bytes(opened, file->path, file->what, *size, error);
    close(opened);
    return bytes;
}

int kiln_loader_file_of(const void *bytes, size_t size, const char *name, struct kiln_error *error)
{
    const int file = memfd_create("kiln", MFD_CLOEXEC);
    for (size_t done = 0; file >= 0 && done < size;) {
        const ssize_t written = pwrite(file, (const char *)bytes + done, size - done, (off_t)done);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0) {
            kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno, "out of memory for %s", name);
            close(file);
            return -1;
        }
        done += (size_t)written;
    }
    if (file < 0)
        kiln_error_set_errno(error, KILN_DEVICE_FAILED, errno, "out of memory for %s", name);
    return file;
}

bool kiln_loader_hash(struct kiln_loader *loader, const struct kiln_loader_file *file, char hex[65],
                      struct kiln_error *error)
{
    const int opened = open_file(loader, file, error);
    if (opened < 0)
        return false;
    const bool ok = kiln_hash_sha256_descriptor(opened, hex) ||
                    kiln_error_set_errno(error, KILN_IO, errno, "%s: the %s cannot be read",
                                         file->path, file->what);
    close(opened);
    return ok;
}

/* ---- processes ------------------------------------------------------------------------------- */

struct kiln_helper *kiln_loader_take(struct kiln_loader *loader, enum kiln_decode_kind kind,
                                     struct kiln_error *error)
{
    struct kiln_helper *helper = NULL;
    if (loader) {
        pthread_mutex_lock(&loader->mutex);
        helper = loader->idle[kind];
        loader->idle[kind] = NULL;
        pthread_mutex_unlock(&loader->mutex);
    }
    if (helper && !kiln_helper_is_waiting(helper))
        kiln_helper_end(&helper);
    const uint64_t most_memory =
        loader ? kiln_budget_left(loader->params.budget, KILN_LIMIT_memory) : UINT64_MAX;
    if (!helper) {
        helper = kiln_helper_start(kind, most_memory, kiln_loader_caller(loader), error);
        if (helper && loader)
            kiln_helper_count(helper, loader->params.budget);
    }
    if (helper)
        kiln_helper_begin(helper);
    return helper;
}

void kiln_loader_give_back(struct kiln_loader *loader, struct kiln_helper **helper)
{
    if (loader && *helper && !kiln_helper_is_broken(*helper)) {
        struct kiln_helper **place = &loader->idle[kiln_helper_kind(*helper)];
        pthread_mutex_lock(&loader->mutex);
        if (!*place) {
            *place = *helper;
            *helper = NULL;
        }
        pthread_mutex_unlock(&loader->mutex);
    }
    kiln_helper_end(helper);
}

/* ---- sizes of pictures ----------------------------------------------------------------------- */

bool kiln_loader_knows_size(struct kiln_loader *loader, const char *path, uint32_t size[2])
{
    if (!loader)
        return false;
    pthread_mutex_lock(&loader->mutex);
    const struct known *one = loader->known;
    while (one && strcmp(one->path, path) != 0)
        one = one->next;
    if (one)
        memcpy(size, one->size, sizeof one->size);
    pthread_mutex_unlock(&loader->mutex);
    return one != NULL;
}

/* If memory is short, the size is not kept, and the picture will be decoded once more. */
void kiln_loader_remember_size(struct kiln_loader *loader, const char *path, const uint32_t size[2])
{
    const size_t length = strlen(path) + 1;
    struct known *one = loader ? malloc(sizeof *one + length) : NULL;
    if (!one)
        return;
    memcpy(one->size, size, sizeof one->size);
    memcpy(one->path, path, length);
    pthread_mutex_lock(&loader->mutex);
    one->next = loader->known;
    loader->known = one;
    pthread_mutex_unlock(&loader->mutex);
}

void kiln_loader_add_picture(struct kiln_loader *loader, uint64_t bytes)
{
    if (!loader)
        return;
    pthread_mutex_lock(&loader->mutex);
    if (bytes > loader->largest_picture)
        loader->largest_picture = bytes;
    pthread_mutex_unlock(&loader->mutex);
}

uint64_t kiln_loader_largest_picture(struct kiln_loader *loader)
{
    if (!loader)
        return 0;
    pthread_mutex_lock(&loader->mutex);
    const uint64_t bytes = loader->largest_picture;
    pthread_mutex_unlock(&loader->mutex);
    return bytes;
}
