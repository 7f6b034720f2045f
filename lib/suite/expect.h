/* Reads and writes what was accepted of a test: GOLDEN/TEST/expect.yaml, beside its pictures.
 *
 *     kiln_expect: 1
 *     scene_hash: 3f...          of the scene that was accepted, which is beside it as scene.yaml
 *     techniques: [simulate=cpu, sort=cpu, raster=geometry]
 *     limits: {flip.mean: 0.004} over those of the test; reason says why
 *     reason: ...
 *     warn: 0.5
 *     masks: [{rect: [0, 0, 40, 20], reason: ...}]
 *     measured: {flip.mean: 0.001}   the worst values of calibration
 *     frames:
 *       24:
 *         state: 13e7be772847a38f
 *         pixels:
 *           cpu: {hash: ..., golden: ..., kiln: 0.2.0 (254e4dc)}
 *
 * A pixel hash is believed only while the golden that it was accepted with is still the one that is
 * found for that device: `golden` is the hash of that picture's pixels. A test whose goldens are
 * hashes has no pictures, and no `golden`.
 */
#ifndef KILN_SUITE_EXPECT_H
#define KILN_SUITE_EXPECT_H

#include "base/text.h"
#include "suite/suite.h"

struct kiln_expect_pixels {
    const char *device; /* a device's name, see kiln_device_name */
    const char *hash;   /* SHA-256 of the decoded pixels */
    const char *golden; /* that hash of the golden it was accepted with; NULL: without a picture */
    const char *kiln;   /* the kiln that was accepted, by version and commit, or NULL */
};

struct kiln_expect_frame {
    uint32_t number;
    const char *state; /* 16 hex digits, or NULL */
    struct kiln_expect_pixels *pixels;
    size_t pixel_count;
};

struct kiln_expect_value {
    const char *metric;
    double value;
};

struct kiln_expect {
    bool missing;           /* there is no such file */
    bool bare;              /* the test keeps hashes: hashes are all that is written */
    const char *scene_hash; /* NULL: not known */
    const char **techniques;
    size_t technique_count;
    struct kiln_expect_value *limits, *measured;
    size_t limit_count, measured_count;
    const char *reason;
    double warn;                  /* below 0: the test's */
    struct kiln_test_mask *masks; /* pictures as they can be opened; in the file, from its folder */
    size_t mask_count;
    struct kiln_expect_frame *frames; /* ascending */
    size_t frame_count;
};

/* Reads GOLDEN/expect.yaml into the arena; when there is none, everything is empty. NULL with
 * KILN_INVALID_INPUT and the place, KILN_IO, KILN_DEVICE_FAILED. */
struct kiln_expect *kiln_expect_read(struct kiln_arena *arena, const char *golden,
                                     struct kiln_error *error);

/* Reads the text of an expect.yaml, which must end in a zero byte that size does not count. */
struct kiln_expect *kiln_expect_parse(struct kiln_arena *arena, const char *text, size_t size,
                                      const char *golden, struct kiln_error *error);

/* Makes the text of the file; false when memory is short. */
bool kiln_expect_print(const struct kiln_expect *expect, const char *golden,
                       struct kiln_text *text);

/* Writes GOLDEN/expect.yaml, whole or not at all; makes missing folders. Comments in the file are
 * lost. KILN_IO; KILN_INVALID_INPUT when it could not be read again (too many entries). */
bool kiln_expect_write(const struct kiln_expect *expect, const char *golden,
                       struct kiln_error *error);

/* Returns the entry of a frame, or NULL. */
struct kiln_expect_frame *kiln_expect_find(const struct kiln_expect *expect, uint32_t number);

/* Notes what was accepted of a frame on a device: adds an entry, or replaces that device's. The
 * entries of other devices stay. The texts are copied; state NULL leaves what is there, pixels NULL
 * adds none. False when memory is short. */
bool kiln_expect_accept(struct kiln_arena *arena, struct kiln_expect *expect, uint32_t number,
                        const char *state, const struct kiln_expect_pixels *pixels);

/* Takes over the techniques of a run, "simulate=cpu sort=cpu". False when memory is short. */
bool kiln_expect_set_techniques(struct kiln_arena *arena, struct kiln_expect *expect,
                                const char *techniques);

#endif
