/* Reads what a path to compare stands for, frame by frame: a picture, a folder of pictures, a
 * numbered pattern, or a video. */
#ifndef KILN_COMPARE_FOOTAGE_H
#define KILN_COMPARE_FOOTAGE_H

#include "asset/image/layers_in.h"
#include "kiln_program.h"

enum kiln_footage_kind {
    KILN_FOOTAGE_STILL,
    KILN_FOOTAGE_FOLDER,   /* frames are ordered and paired by file name, and numbered in that order
                              from 0 */
    KILN_FOOTAGE_NUMBERED, /* frames are paired by number */
    KILN_FOOTAGE_VIDEO,    /* frames are paired by number, counted from 0 */
};

struct kiln_footage;

/* Opens a path and lists its frames. layer: the layer of pictures that is wanted, which must
 * outlive the footage; NULL: all. NULL with KILN_INVALID_INPUT when there is nothing that can be
 * read, KILN_USAGE for a pattern that makes no sense, KILN_DEVICE_FAILED when memory is short. */
struct kiln_footage *kiln_footage_open(const char *path, const char *layer,
                                       struct kiln_error *error);
void kiln_footage_close(struct kiln_footage **footage);

/* Names the log that gets what is wrong with files that are read all the same; it must outlive the
 * footage. */
void kiln_footage_set_log(struct kiln_footage *footage, const struct kiln_log *log);

enum kiln_footage_kind kiln_footage_kind(const struct kiln_footage *footage);
const char *kiln_footage_path(const struct kiln_footage *footage);

/* A frame that is next to be taken. */
struct kiln_footage_frame {
    const char *name; /* the name of its file, or its number; valid until the next call */
    uint32_t number;
};

/* Finds the next frame without taking it; returns false at the end. Only kiln_footage_take finds
 * out whether the frame can be decoded. */
bool kiln_footage_peek(struct kiln_footage *footage, struct kiln_footage_frame *frame);

/* Makes the path of the file of the frame that kiln_footage_peek found. KILN_INVALID_INPUT when it
 * is too long. */
bool kiln_footage_file(const struct kiln_footage *footage, char path[KILN_PATH_SIZE],
                       struct kiln_error *error);

/* Visits all frames, also those that were taken already; of a video, whose count is not known, it
 * visits only the first frame. Stops and returns false when a visit does. */
bool kiln_footage_visit(const struct kiln_footage *footage,
                        bool (*visit)(void *user, const struct kiln_footage_frame *frame),
                        void *user);

/* Declares the files of the footage as read; `what` as in kiln_claims_read. */
bool kiln_footage_claim(const struct kiln_footage *footage, const char *what,
                        struct kiln_claims *claims, struct kiln_error *error);

/* Decodes the picture of the frame that kiln_footage_peek found and goes on to the next one. The
 * caller destroys the picture. Returns NULL with the error. A video ends at its first error. */
struct kiln_asset_image *kiln_footage_take(struct kiln_footage *footage, struct kiln_error *error);
void kiln_footage_skip(struct kiln_footage *footage);

/* Returns whether a video has ended at an error. */
bool kiln_footage_has_failed(const struct kiln_footage *footage);

/* Opens the layers of the frame that kiln_footage_peek found, in the place of kiln_footage_take. A
 * frame of a video has one, "beauty". */
bool kiln_footage_open_layers(struct kiln_footage *footage, struct kiln_error *error);

/* Decodes the next layer, in the order of kiln_order_layers. Returns true with the image, which the
 * caller destroys, or with NULL behind the last layer. */
bool kiln_footage_next_layer(struct kiln_footage *footage, struct kiln_image_layer *layer,
                             struct kiln_error *error);

#endif
