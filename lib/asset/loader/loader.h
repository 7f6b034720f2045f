/* Reads the files that a scene names. A loader opens them below the asset root and nowhere else,
 * and counts them in the scene's budget. Formats of untrusted files are decoded by processes of
 * kiln-decode, which the loader starts when they are needed and keeps for the next file. */
#ifndef KILN_ASSET_LOADER_LOADER_H
#define KILN_ASSET_LOADER_LOADER_H

#include "asset/loader/helper.h"

struct kiln_loader_params {
    const char *root;         /* absolute folder, as from realpath; NULL: any file may be opened */
    bool (*stop)(void *user); /* is asked while a file is decoded; true: stop; NULL: never */
    void *user;
    const struct kiln_cancel *cancel;
    struct kiln_budget *budget; /* NULL: nothing is counted */
};

/* A callback that receives what is wrong with a file that is read all the same, in one line of text
 * that a decoder may have made up. It may be called from any thread that uses the loader. */
struct kiln_loader_warn {
    void (*write)(void *user, const char *path, const char *text); /* NULL: nobody is warned */
    void *user;
};

/* Creates a loader, which any threads may use at once. NULL when memory is short. All that params
 * points to must outlive it. */
struct kiln_loader;
struct kiln_loader *kiln_loader_create(const struct kiln_loader_params *params);
void kiln_loader_destroy(struct kiln_loader **loader);

/* Ends the processes that wait for requests; more may be started later. Does nothing for NULL. */
void kiln_loader_rest(struct kiln_loader *loader);

/* Stops counting files, since files that are loaded again for drawing were counted before. From now
 * on, the budget (or NULL) is that of the job, for memory and time. Does nothing for NULL. */
void kiln_loader_stop_counting(struct kiln_loader *loader, struct kiln_budget *budget);

/* kiln_loader_set_warn names the callback for warnings; no other thread may use the loader
 * meanwhile. kiln_loader_warn calls it. kiln_loader_log is such a callback: it writes the path and
 * the text to a struct kiln_log, which is its user. All do nothing for a loader of NULL. */
void kiln_loader_set_warn(struct kiln_loader *loader, struct kiln_loader_warn warn);
void kiln_loader_warn(const struct kiln_loader *loader, const char *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void kiln_loader_log(void *log, const char *path, const char *text);

/* Returns the caller made of kiln_loader_params; never NULL, also for a loader of NULL. */
const struct kiln_caller *kiln_loader_caller(const struct kiln_loader *loader);
struct kiln_budget *kiln_loader_budget(const struct kiln_loader *loader);

/* Describes a file for opening and for messages. */
struct kiln_loader_file {
    const char *path;    /* absolute if there is a root */
    const char *what;    /* kind of file for messages: "image" */
    const char *allowed; /* allowed formats for messages: "PNG or EXR" */
    size_t most_bytes;
};

/* Opens a regular file for reading, without waiting if it is a FIFO or a device. Returns its
 * descriptor, which the caller closes, or -1: KILN_IO when it cannot be opened; KILN_INVALID_INPUT
 * when it is no regular file, too large, or outside of the root by a link or ".."; KILN_OVER_LIMIT.
 * A loader of NULL opens any file and counts nothing. */
int kiln_loader_open(struct kiln_loader *loader, const struct kiln_loader_file *file, size_t *size,
                     struct kiln_error *error);

/* Reads a file that kiln_loader_open would open. The caller frees the bytes. NULL with an error. */
unsigned char *kiln_loader_read(struct kiln_loader *loader, const struct kiln_loader_file *file,
                                size_t *size, struct kiln_error *error);

/* Makes a file in memory with a copy of these bytes. Returns its descriptor, which the caller
 * closes, or -1 with KILN_DEVICE_FAILED. name is for messages. */
int kiln_loader_file_of(const void *bytes, size_t size, const char *name, struct kiln_error *error);

/* Computes the SHA-256, in hex, of a file that kiln_loader_open would open. */
bool kiln_loader_hash(struct kiln_loader *loader, const struct kiln_loader_file *file, char hex[65],
                      struct kiln_error *error);

/* kiln_loader_take lends a process of a kind that waits for a request; NULL with the errors of
 * kiln_helper_start. Only the caller may use it. kiln_loader_give_back returns it to the loader; a
 * broken process, or one taken from a loader of NULL, is ended. */
struct kiln_helper *kiln_loader_take(struct kiln_loader *loader, enum kiln_decode_kind kind,
                                     struct kiln_error *error);
void kiln_loader_give_back(struct kiln_loader *loader, struct kiln_helper **helper);

/* kiln_loader_knows_size gives width and height of a picture that was checked before, so that it
 * need not be decoded or counted again. It returns false if the picture was not checked.
 * kiln_loader_remember_size keeps the size of a picture that was checked. kiln_loader_add_picture
 * takes note of the bytes of a picture that was decoded, and kiln_loader_largest_picture returns
 * those of the largest one; 0 for a loader of NULL. */
bool kiln_loader_knows_size(struct kiln_loader *loader, const char *path, uint32_t size[2]);
void kiln_loader_remember_size(struct kiln_loader *loader, const char *path,
                               const uint32_t size[2]);
void kiln_loader_add_picture(struct kiln_loader *loader, uint64_t bytes);
uint64_t kiln_loader_largest_picture(struct kiln_loader *loader);

#endif
