/* A kiln_history is what a technique of a drawing stage keeps from frame to frame, so that a frame
 * depends on the frames before it. The frame loop and saved states use it through the functions
 * below, and know nothing else of the technique. */
#ifndef KILN_PARTICLES_HISTORY_H
#define KILN_PARTICLES_HISTORY_H

#include "particles/pool.h"

/* A history as words, between two moments. Its technique gives the words their meaning. */
struct kiln_history_words {
    uint32_t *of_slots; /* a word for each slot of the pool */
    uint32_t of_whole;  /* and one word more */
};

/* The functions of a technique that keeps a history. */
struct kiln_history_kind {
    /* Takes up the particles of a moment as a camera sees them. It must be called in order for each
     * moment that could be drawn, before the moment is drawn, and also if it is not drawn. Every
     * call must pass a pool with the same slots. eye: m; forward: unit length. */
    bool (*advance)(void *technique, struct kiln_pool *pool, float3 eye, float3 forward,
                    struct kiln_error *error);
    /* Writes the history to words->of_slots, for which the caller has room, and words->of_whole. */
    bool (*save)(void *technique, const struct kiln_pool *pool, struct kiln_history_words *words,
                 struct kiln_error *error);
    /* Takes a saved history up. Fails with KILN_INVALID_INPUT for words that no history has. */
    bool (*restore)(void *technique, const struct kiln_pool *pool,
                    const struct kiln_history_words *words, struct kiln_error *error);
};

struct kiln_history {
    const struct kiln_history_kind *kind; /* NULL: the technique keeps no history */
    void *technique;                      /* first argument of the functions */
};

#endif
