/* This file remembers frames of nodes at the last few moments: the start and the end of a step, and
 * the moment that is drawn. A frame that is found has the same bits as one that is computed, so
 * nothing depends on which thread asks first. */
#include "scene/node_cache.h"

#include <pthread.h>
#include <string.h>

#include "scene/node.h"

enum { MOMENTS = 6, KINDS = 2 };

struct moment {
    float time_s, rate_s;
    uint64_t used; /* the greater, the later; 0: never */
    bool *known;   /* of each node its own frame, then of each node that in the world */
    struct kiln_node_frame *frames;
};

struct kiln_node_cache {
    pthread_mutex_t mutex; /* guards the members below */
    uint32_t node_count;
    uint64_t uses;
    struct moment moments[MOMENTS];
};

struct kiln_node_cache *kiln_node_cache_create(struct kiln_arena *arena, uint32_t node_count)
{
    struct kiln_node_cache *cache = kiln_arena_alloc(arena, 1, sizeof *cache);
    if (!cache)
        return NULL;
    cache->node_count = node_count;
    for (int i = 0; i < MOMENTS; i++) {
        struct moment *moment = &cache->moments[i];
        moment->known = kiln_arena_alloc(arena, (size_t)KINDS * node_count, sizeof *moment->known);
        moment->frames =
            kiln_arena_alloc(arena, (size_t)KINDS * node_count, sizeof *moment->frames);
        if (!moment->known || !moment->frames)
            return NULL;
    }
    return pthread_mutex_init(&cache->mutex, NULL) == 0 ? cache : NULL;
}

void kiln_node_cache_finish(struct kiln_node_cache *cache)
{
    if (cache)
        pthread_mutex_destroy(&cache->mutex);
}

/* Returns the moment of these times; if it is not known, the one that was not used for the longest
 * time, which it then is, without frames. */
static struct moment *take_moment(struct kiln_node_cache *cache, float time_s, float rate_s)
{
    struct moment *found = NULL, *oldest = cache->moments;
    for (int i = 0; i < MOMENTS; i++) {
        struct moment *moment = &cache->moments[i];
        if (moment->used > 0 && moment->time_s == time_s && moment->rate_s == rate_s)
            found = moment;
        if (moment->used < oldest->used)
            oldest = moment;
    }
    if (!found) {
        found = oldest;
        found->time_s = time_s;
        found->rate_s = rate_s;
        memset(found->known, 0, (size_t)KINDS * cache->node_count * sizeof *found->known);
    }
    found->used = ++cache->uses;
    return found;
}

bool kiln_node_cache_find(struct kiln_node_cache *cache, enum kiln_node_frame_kind kind,
                          uint32_t node, float time_s, float rate_s, struct kiln_node_frame *frame)
{
    const size_t place = (size_t)kind * cache->node_count + node;
    pthread_mutex_lock(&cache->mutex);
    const struct moment *moment = take_moment(cache, time_s, rate_s);
    const bool known = moment->known[place];
    if (known)
        *frame = moment->frames[place];
    pthread_mutex_unlock(&cache->mutex);
    return known;
}

void kiln_node_cache_keep(struct kiln_node_cache *cache, enum kiln_node_frame_kind kind,
                          uint32_t node, float time_s, float rate_s,
                          const struct kiln_node_frame *frame)
{
    const size_t place = (size_t)kind * cache->node_count + node;
    pthread_mutex_lock(&cache->mutex);
    struct moment *moment = take_moment(cache, time_s, rate_s);
    moment->frames[place] = *frame;
    moment->known[place] = true;
    pthread_mutex_unlock(&cache->mutex);
}
