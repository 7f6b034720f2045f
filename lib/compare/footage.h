/* What a path to compare stands for: a picture, a folder of pictures, a numbered pattern, a video;
 * read frame by frame. */
#ifndef KILN_COMPARE_FOOTAGE_H
#define KILN_COMPARE_FOOTAGE_H

#include "asset/image/image.h"
#include "kiln_program.h"

enum kiln_footage_kind {
    KILN_FOOTAGE_STILL,
    KILN_FOOTAGE_FOLDER,   /* ordered and paired by file name; numbered in that order from 0 */
    KILN_FOOTAGE_NUMBERED, /* by number */
    KILN_FOOTAGE_VIDEO,    /* by number, counted from 0 */
};

struct kiln_footage;

/* Lists what there is. layer (see image.h) must outlive it. NULL with KILN_INVALID_INPUT when there
 * is nothing that can be read, KILN_USAGE for a pattern that makes no sense, KILN_DEVICE_FAILED
 * when memory is short. */
struct kiln_footage *kiln_footage_open(const char *path, const char *layer,
                                       struct kiln_error *error);
void kiln_footage_close(struct kiln_footage **footage);

enum kiln_footage_kind kiln_footage_kind(const struct kiln_footage *footage);
const char *kiln_footage_path(const struct kiln_footage *footage);

/* The next frame. */
struct kiln_footage_frame {
    const char *name; /* of its file, or its number; until the next call */
    uint32_t number;
};

/* False at the end. What cannot be decoded is found by take. */
bool kiln_footage_peek(struct kiln_footage *footage, struct kiln_footage_frame *frame);

/* The file of the frame that peek told of. KILN_INVALID_INPUT when its path is too long. */
bool kiln_footage_file(const struct kiln_footage *footage, char path[KILN_PATH_SIZE],
                       struct kiln_error *error);

/* Visits the frames that are known to be there, wherever reading has come to: all, but only the
 * first of a video. False as soon as a visit is. */
bool kiln_footage_visit(const struct kiln_footage *footage,
                        bool (*visit)(void *user, const struct kiln_footage_frame *frame),
                        void *user);

/* Declares its files as read; `what` as in kiln_claims_read. */
bool kiln_footage_claim(const struct kiln_footage *footage, const char *what,
                        struct kiln_claims *claims, struct kiln_error *error);

/* Decodes the frame that peek told of, which the caller destroys, and goes on to the next; NULL
 * with the error. A video ends at its first error. */
struct kiln_asset_image *kiln_footage_take(struct kiln_footage *footage, struct kiln_error *error);
void kiln_footage_skip(struct kiln_footage *footage);

#endif
