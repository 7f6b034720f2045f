/* A saved state: all that a run carries from one step to the next, in a file. */
#ifndef KILN_JOB_STATE_H
#define KILN_JOB_STATE_H

#include "base/thread.h"
#include "particles/pool.h"

/* What a state is of. Hashes are those of scene/motion.h. */
struct kiln_state_info {
    char motion[65];
    char order[65]; /* of the order that a spread sort keeps, with its technique; "": there is none
                     */
    char kiln[17];  /* the version that saved it */
    uint32_t step;  /* after which it was saved */
    uint32_t frame; /* with an order: the frame that comes next */
    struct kiln_state_hash hash;
    uint64_t alive;                                   /* particles */
    bool spins[KILN_MAX_SYSTEMS];                     /* filled by who reads: which systems spin, */
    struct kiln_canvas_shape shapes[KILN_MAX_MESHES]; /* and what is painted */
    uint32_t shape_count;
};

struct kiln_state {
    struct kiln_state_info info;
    struct kiln_pool *pool;
    uint32_t *slots; /* the kept order: all slots of the pool; NULL: none is saved, or wanted */
    uint32_t turn;   /* and which part of a sort comes next */
};

/* Writes a state beside its place and renames it there; replaces a file only with overwrite.
 * KILN_IO, KILN_DEVICE_FAILED. */
bool kiln_state_write(const struct kiln_state *state, const char *path, bool overwrite,
                      struct kiln_threads *threads, struct kiln_error *error);

/* Reads what a state is of, and checks the whole file: KILN_INVALID_INPUT with the reason when it
 * is no state, one of another format, cut off or changed in any byte. */
bool kiln_state_check(const char *path, struct kiln_state_info *info, struct kiln_error *error);

/* Puts a state into a pool that the same scene initialised, and the order into state->slots if that
 * is not NULL. state->info is filled. After a failure the pool is worth nothing. */
bool kiln_state_read(struct kiln_state *state, const char *path, struct kiln_threads *threads,
                     struct kiln_error *error);

#endif
