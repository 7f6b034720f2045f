/* Allocates memory that has one owner and is freed together: that of a scene, a renderer or a
 * frame. */
#ifndef KILN_BASE_ARENA_H
#define KILN_BASE_ARENA_H

#include <stddef.h>

struct kiln_arena;

/* NULL when memory is short. */
struct kiln_arena *kiln_arena_create(void);
void kiln_arena_destroy(struct kiln_arena **arena);

/* count * size zeroed bytes, aligned for any type; NULL when memory is short or the product
 * overflows. Lives as long as the arena. Not thread-safe. */
void *kiln_arena_alloc(struct kiln_arena *arena, size_t count, size_t size);

/* Copies the first length bytes of text and adds a terminating zero. NULL when memory is short. */
char *kiln_arena_text(struct kiln_arena *arena, const char *text, size_t length);

/* Formats a text as printf does. NULL when memory is short. */
char *kiln_arena_format(struct kiln_arena *arena, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
