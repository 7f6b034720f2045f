/* Finds, hashes, locks and accepts the golden pictures of a test, which are found by their names:
 *
 *     frame_0024.png              the default
 *     frame_0024@llvmpipe.png     for devices whose name is or starts with that, "llvmpipe-..."
 *     frame_0024~2.png            another picture that is right, of the default
 *     frame_0024@llvmpipe~2.png   another picture that is right, of the device's
 *
 * The pictures of the most specific name of a device count, its default and alternatives together.
 * Where a device has none, the pictures without a device count. update.c accepts pictures in a run
 * and approve.c from its results, both by these functions and under this lock; nothing else writes
 * goldens.
 */
#ifndef KILN_SUITE_GOLDEN_H
#define KILN_SUITE_GOLDEN_H

#include "kiln_program.h"
#include "suite/expect.h"

enum { KILN_MAX_GOLDENS = 16, KILN_DEVICE_NAME_SIZE = 128 };

/* Makes a device's name for files and expect.yaml: its GL renderer in lower case, with runs of
 * anything but letters, digits and dots as one '-': "llvmpipe-llvm-15.0.6-256-bits",
 * "nvidia-h200-pcie-sse2". */
void kiln_device_name(const char *renderer, char name[KILN_DEVICE_NAME_SIZE]);

/* Returns the suffix of a test's pictures, ".png" or ".exr". */
const char *kiln_test_suffix(const struct kiln_test *test);

struct kiln_goldens {
    size_t count;
    char paths[KILN_MAX_GOLDENS][KILN_PATH_SIZE]; /* the main one first */
    char device[KILN_DEVICE_NAME_SIZE];           /* the device in their names; "": the default's */
};

/* Finds the accepted pictures of a frame. It is no error if there is none: paths[0] is then the
 * name that a golden would have. A file with a golden's name counts, whatever it is: reading it
 * will tell. KILN_IO when the folder cannot be read, KILN_INVALID_INPUT for more than
 * KILN_MAX_GOLDENS, and for names that are nearly those of goldens. */
bool kiln_goldens_find(const struct kiln_test *test, uint32_t frame, const char *device_name,
                       struct kiln_goldens *goldens, struct kiln_error *error);

/* Finds where a picture would be accepted: in place of the first golden, for the device alone, or
 * as one more. */
bool kiln_goldens_place(const struct kiln_test *test, uint32_t frame, const char *device_name,
                        enum kiln_approve_as as, char path[KILN_PATH_SIZE],
                        struct kiln_error *error);

/* Locks a test's goldens, so that processes that accept pictures wait for each other. Makes the
 * folder. Returns a value below 0 with KILN_IO. */
int kiln_goldens_lock(const struct kiln_test *test, struct kiln_error *error);
void kiln_goldens_unlock(int lock);

/* Copies a file to another name, whole or not at all, replacing it; makes missing folders. KILN_IO,
 * KILN_INVALID_INPUT when `from` is no regular file. */
bool kiln_file_copy(const char *from, const char *to, struct kiln_error *error);

/* Computes SHA-256 of a picture as it is decoded: size, channels, type, how light is encoded, and
 * pixels. Fails as kiln_asset_image_load does. */
bool kiln_pixel_hash(const char *path, char hex[65], struct kiln_error *error);

/* Accepts one picture. The picture goes to its place, unless a picture of the same pixels is there
 * (as one more: anywhere among the frame's) or the test keeps hashes alone. State and pixels go
 * into expect. The caller holds the lock, and writes expect and the scene. path gets the place.
 * KILN_INVALID_INPUT when the picture cannot be decoded, KILN_IO, KILN_DEVICE_FAILED. */
struct kiln_acceptance {
    uint32_t frame;
    const char *picture; /* a file */
    const char *state;   /* NULL leaves what is there */
    const char *device_name;
    enum kiln_approve_as as;
    const char *golden; /* the golden to replace; NULL: the first of the frame's */
    const char *build;  /* of kiln, or NULL */
};
bool kiln_goldens_accept(struct kiln_arena *arena, const struct kiln_test *test,
                         struct kiln_expect *expect, const struct kiln_acceptance *acceptance,
                         char path[KILN_PATH_SIZE], struct kiln_error *error);

/* Writes the accepted scene beside the goldens, scene.yaml: text as kiln_scene_print writes it. The
 * caller holds the lock. KILN_IO. */
bool kiln_goldens_write_scene(const struct kiln_test *test, const char *text,
                              struct kiln_error *error);

#endif
