/* Writes, checks and reads saved states: files with all data that a run carries from one simulation
 * step to the next. */
#ifndef KILN_JOB_STATE_H
#define KILN_JOB_STATE_H

#include "base/thread.h"
#include "job/state_visit.h"
#include "particles/history.h"

/* Identifies a state. scene/motion.h makes the hashes. */
struct kiln_state_info {
    char motion[65];
    /* hash of what decides the history that a stage keeps, with its technique; "": none is kept */
    char history[65];
    char kiln[17];  /* the version of kiln that saved the state */
    uint32_t step;  /* the step after which the state was saved */
    uint32_t frame; /* the number of the next frame, if a history is saved */
    struct kiln_state_hash hash;
    uint64_t alive; /* number of living particles */
    /* set when a state is read: the systems whose particles spin */
    bool spins[KILN_MAX_SYSTEMS];
    bool travels[KILN_MAX_SYSTEMS]; /* those whose particles have ways */
    /* set when a state is read: the sizes of the painted canvases */
    struct kiln_canvas_shape shapes[KILN_MAX_MESHES];
    uint32_t shape_count;
};

/* The most bytes of a state's head: of the line "kiln state 1" with the head's size and CRC, of the
 * identity with the counts, of each system, of each painted mesh and of each domain of gas. */
enum {
    KILN_STATE_MAX_HEAD =
        21 + 180 + 24 * KILN_MAX_SYSTEMS + 12 * KILN_MAX_MESHES + KILN_STATE_GAS_HEAD * KILN_MAX_GAS
};

struct kiln_state {
    struct kiln_state_info info;
    struct kiln_pool *pool;
    struct kiln_history_words history; /* of_slots: NULL if none is saved or wanted */
};

/* Writes a state to a temporary file and renames it to its path. An existing file is replaced only
 * with `overwrite`. KILN_IO, KILN_DEVICE_FAILED. */
bool kiln_state_write(const struct kiln_state *state, const char *path, bool overwrite,
                      struct kiln_threads *threads, struct kiln_error *error);

/* Reads the identity of a state and checks the whole file. KILN_INVALID_INPUT with the reason when
 * the file is no state, has another format, is cut off or has a changed byte. */
bool kiln_state_check(const char *path, struct kiln_state_info *info, struct kiln_error *error);

/* Reads a state into a pool that was initialised for the same scene, and the history into
 * state->history if its of_slots is not NULL. Fills state->info. Fails with KILN_INVALID_INPUT also
 * for values that no step makes (job/state_check.h). After a failure the pool must not be used. */
bool kiln_state_read(struct kiln_state *state, const char *path, struct kiln_threads *threads,
                     struct kiln_error *error);

#endif
