/* Reads and writes GOLDEN/TEST/expect.yaml, which records what was accepted of a test and lies
 * beside its golden pictures.
 *
 *     kiln_expect: 1
 *     scene_hash: 3f...          of the accepted scene, which lies beside this file as scene.yaml
 *     techniques: [simulate=cpu, sort=cpu, raster=geometry]
 *     limits: {flip.mean: 0.004} these override the test's limits; `reason` says why
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
 * A pixel hash counts only while the golden picture that it was accepted with is still found for
 * that device: `golden` is the hash of that picture's pixels. A test that keeps hashes alone has no
 * pictures and no `golden`.
 */
#ifndef KILN_SUITE_EXPECT_H
#define KILN_SUITE_EXPECT_H

#include "base/text.h"
#include "suite/suite.h"

struct kiln_expect_pixels {
    const char *device; /* a device's name, see kiln_device_name */
    const char *hash;   /* SHA-256 of the decoded pixels */
    const char *golden; /* the same hash of the golden picture; NULL if none is kept */
    const char *kiln;   /* version and commit of the kiln that drew them, or NULL */
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
    bool missing;           /* there is no expect.yaml */
    bool hashes_only;       /* the test keeps hashes alone: techniques are not written */
    const char *scene_hash; /* SHA-256 of the accepted scene, or NULL */
    const char **techniques;
    size_t technique_count;
    struct kiln_expect_value *limits, *measured;
    size_t limit_count, measured_count;
    const char *reason;
    double warn;                  /* a score; below 0: the test's own value */
    struct kiln_test_mask *masks; /* in the file, paths of pictures are relative to its folder */
    size_t mask_count;
    struct kiln_expect_frame *frames; /* ascending */
    size_t frame_count;
};

/* Reads GOLDEN/expect.yaml into the arena. Without such a file, `missing` is set and the rest is
 * empty. Returns NULL with KILN_INVALID_INPUT and the place of the fault, KILN_IO or
 * KILN_DEVICE_FAILED. */
struct kiln_expect *kiln_expect_read(struct kiln_arena *arena, const char *golden,
                                     struct kiln_error *error);

/* Reads the text of an expect.yaml, which must end in a zero byte that size does not count. */
struct kiln_expect *kiln_expect_parse(struct kiln_arena *arena, const char *text, size_t size,
                                      const char *golden, struct kiln_error *error);

/* Adds the text of the file to `text`. Returns false when memory is short. */
bool kiln_expect_print(const struct kiln_expect *expect, const char *golden,
                       struct kiln_text *text);

/* Writes GOLDEN/expect.yaml, whole or not at all; makes missing folders. Comments in the file are
 * lost. KILN_IO; KILN_INVALID_INPUT if the file could not be read again, as with too many entries.
 */
bool kiln_expect_write(const struct kiln_expect *expect, const char *golden,
                       struct kiln_error *error);

/* Returns the entry of a frame, or NULL. */
struct kiln_expect_frame *kiln_expect_find(const struct kiln_expect *expect, uint32_t number);

/* Records what was accepted of a frame: adds an entry for the device of `pixels`, or replaces that
 * device's entry. The texts are copied. If state is NULL, the recorded state stays; if pixels is
 * NULL, no entry changes. Returns false when memory is short. */
bool kiln_expect_accept(struct kiln_arena *arena, struct kiln_expect *expect, uint32_t number,
                        const char *state, const struct kiln_expect_pixels *pixels);

/* Replaces the techniques by those of a run, such as "simulate=cpu sort=cpu". Returns false when
 * memory is short. */
bool kiln_expect_set_techniques(struct kiln_arena *arena, struct kiln_expect *expect,
                                const char *techniques);

#endif
