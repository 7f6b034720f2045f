/* Finds, hashes, locks and accepts the golden pictures of a test, which are found by their names:
 *
 *     frame_0024.png              the default
 *     frame_0024@llvmpipe.png     for devices that are named "llvmpipe" or "llvmpipe-..."
 *     frame_0024~2.png            an alternative to the default picture
 *     frame_0024@llvmpipe~2.png   an alternative to the device's picture
 *
 * Of the device names that fit a device, the longest counts: the pictures with that name,
 * alternatives included, are the goldens. If no name fits, the pictures without a device are the
 * goldens. update.c accepts pictures in a run and approve.c from its results, both by these
 * functions and under this lock; nothing else writes goldens.
 */
#ifndef KILN_SUITE_GOLDEN_H
#define KILN_SUITE_GOLDEN_H

#include "kiln_program.h"
#include "suite/expect.h"

enum { KILN_MAX_GOLDENS = 16, KILN_DEVICE_NAME_SIZE = 128 };

/* Makes a device's name for files and expect.yaml: its GL renderer in lower case, with one '-' for
 * each run of characters other than letters, digits and dots: "llvmpipe-llvm-15.0.6-256-bits",
 * "nvidia-h200-pcie-sse2". */
void kiln_device_name(const char *renderer, char name[KILN_DEVICE_NAME_SIZE]);

/* Returns the suffix of a test's pictures, ".png" or ".exr". */
const char *kiln_test_suffix(const struct kiln_test *test);

struct kiln_goldens {
    size_t count;
    char paths[KILN_MAX_GOLDENS][KILN_PATH_SIZE]; /* ascending by the number after '~' */
    char device[KILN_DEVICE_NAME_SIZE];           /* the device in their names, "" without one */
};

/* Finds the goldens of a frame by the names in the folder; no file is opened. If there is none,
 * that is no error, and paths[0] is the name that a golden would have. KILN_IO when the folder
 * cannot be read, KILN_INVALID_INPUT for more than KILN_MAX_GOLDENS and for malformed names, such
 * as frame_0024~1.png. */
bool kiln_goldens_find(const struct kiln_test *test, uint32_t frame, const char *device_name,
                       struct kiln_goldens *goldens, struct kiln_error *error);

/* Chooses the path of a picture that is to be accepted: that of the frame's first golden, one for
 * the device alone, or that of a new alternative. */
bool kiln_goldens_place(const struct kiln_test *test, uint32_t frame, const char *device_name,
                        enum kiln_approve_as as, char path[KILN_PATH_SIZE],
                        struct kiln_error *error);

/* Locks a test's goldens, so that processes that accept pictures wait for each other. Makes the
 * folder if it is missing. Returns the lock, or a value below 0 with KILN_IO. */
int kiln_goldens_lock(const struct kiln_test *test, struct kiln_error *error);
void kiln_goldens_unlock(int lock);

/* Copies a file and replaces its target, whole or not at all; makes missing folders. KILN_IO,
 * KILN_INVALID_INPUT when `from` is no regular file. */
bool kiln_file_copy(const char *from, const char *to, struct kiln_error *error);

/* Computes the SHA-256 of a decoded picture: its size, channels, type, transfer function, whether
 * it is premultiplied, and its pixels. Fails as kiln_asset_image_load does. */
bool kiln_pixel_hash(const char *path, char hex[65], struct kiln_error *error);

/* Computes it from the bytes of a file; name stands for the file in messages. */
bool kiln_pixel_hash_of(const void *bytes, size_t size, const char *name, char hex[65],
                        struct kiln_error *error);

/* Does the same, and warns of what is wrong with a file that is read all the same. */
bool kiln_pixel_hash_warned(const char *path, const struct kiln_log *log, char hex[65],
                            struct kiln_error *error);

/* Accepts one picture, the bytes of a file. They are written to its place, which path receives,
 * unless a picture with the same pixels is there or the test keeps hashes alone; path is then that
 * of expect.yaml. An alternative is not written if any golden of the frame has its pixels. The
 * state and the hash of the pixels go into expect. The caller holds the lock, and writes expect and
 * the scene afterwards. KILN_IO, KILN_DEVICE_FAILED. */
struct kiln_acceptance {
    uint32_t frame;
    const void *bytes; /* of the picture's file */
    size_t size;
    const char *pixels; /* kiln_pixel_hash_of the bytes */
    const char *state;  /* NULL: the recorded state stays */
    const char *device_name;
    enum kiln_approve_as as;
    const char *golden; /* path of the golden to replace; NULL: the frame's first */
    const char *build;  /* version and commit of kiln, or NULL */
};
bool kiln_goldens_accept(struct kiln_arena *arena, const struct kiln_test *test,
                         struct kiln_expect *expect, const struct kiln_acceptance *acceptance,
                         char path[KILN_PATH_SIZE], struct kiln_error *error);

/* Writes the accepted scene, a text as kiln_scene_print writes it, to scene.yaml beside the
 * goldens. The caller holds the lock. KILN_IO. */
bool kiln_goldens_write_scene(const struct kiln_test *test, const char *text,
                              struct kiln_error *error);

#endif
