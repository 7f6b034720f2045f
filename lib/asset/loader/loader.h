/* What reads the files that a scene names: it opens them below the asset root and nowhere else,
 * counts them in the scene's budget, and has those that strangers' formats are in decoded by
 * processes of kiln-decode, which it starts when they are needed and keeps for the next file. */
#ifndef KILN_ASSET_LOADER_LOADER_H
#define KILN_ASSET_LOADER_LOADER_H

#include "asset/loader/helper.h"

struct kiln_loader_params {
    const char *root;         /* absolute folder, as realpath gives it; NULL: any file */
    bool (*stop)(void *user); /* asked while something is decoded; NULL: nobody */
    void *user;
    const struct kiln_cancel *cancel;
    struct kiln_budget *budget; /* NULL: nothing is counted */
};

/* For any threads. NULL when memory is short. What params point to must outlive it. */
struct kiln_loader;
struct kiln_loader *kiln_loader_create(const struct kiln_loader_params *params);
void kiln_loader_destroy(struct kiln_loader **loader);

/* Ends the processes that wait; more may be started later. Does nothing for NULL. */
void kiln_loader_rest(struct kiln_loader *loader);

/* Counts no file from now on: what is loaded once more, for drawing, was counted before. The
 * budget, or NULL, is from now on that of the job: its memory and its time. Does nothing for a
 * loader of NULL. */
void kiln_loader_stop_counting(struct kiln_loader *loader, struct kiln_budget *budget);

/* Never NULL, and never forgetting: what kiln_loader_params had. */
const struct kiln_caller *kiln_loader_caller(const struct kiln_loader *loader);
struct kiln_budget *kiln_loader_budget(const struct kiln_loader *loader);

/* Describes a file as it is given by people. */
struct kiln_loader_file {
    const char *path;    /* absolute where there is a root */
    const char *what;    /* for messages: "image" */
    const char *allowed; /* "PNG or EXR" */
    size_t most_bytes;
};

/* Opens a regular file for reading, without waiting for what is a FIFO or device. Its descriptor,
 * which the caller closes, or -1: KILN_IO when it cannot be opened, KILN_INVALID_INPUT when it is
 * something else, too large, or leads out of the root by a link or "..", KILN_OVER_LIMIT. A loader
 * of NULL opens any file and counts nothing. */
int kiln_loader_open(struct kiln_loader *loader, const struct kiln_loader_file *file, size_t *size,
                     struct kiln_error *error);

/* The bytes of such a file, which the caller frees, or NULL. */
unsigned char *kiln_loader_read(struct kiln_loader *loader, const struct kiln_loader_file *file,
                                size_t *size, struct kiln_error *error);

/* A file in memory with a copy of these bytes: its descriptor, which the caller closes, or -1 with
 * KILN_DEVICE_FAILED. name is for messages. */
int kiln_loader_file_of(const void *bytes, size_t size, const char *name, struct kiln_error *error);

/* SHA-256 of such a file, in hex. */
bool kiln_loader_hash(struct kiln_loader *loader, const struct kiln_loader_file *file, char hex[65],
                      struct kiln_error *error);

/* A process of that kind, which waits for a request, for the caller alone; NULL: as
 * kiln_helper_start. It goes back to the loader or, if it is broken or the loader NULL, ends. */
struct kiln_helper *kiln_loader_take(struct kiln_loader *loader, enum kiln_decode_kind kind,
                                     struct kiln_error *error);
void kiln_loader_give_back(struct kiln_loader *loader, struct kiln_helper **helper);

/* The size of a picture that was checked before, so that it need not be decoded, or counted, again
 * to know it. False: it was not. */
bool kiln_loader_knows(struct kiln_loader *loader, const char *path, uint32_t size[2]);
void kiln_loader_remember(struct kiln_loader *loader, const char *path, const uint32_t size[2]);

#endif
