/* This file allocates aligned memory for large arrays. From 2 MiB on, it asks the system for
 * transparent huge pages by madvise, since most systems give them only on request. */
#include "base/pages.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

enum { LARGE_PAGE = 2 << 20, CACHE_LINE = 64 }; /* bytes */

void *kiln_alloc_pages(size_t bytes)
{
    if (bytes > PTRDIFF_MAX - LARGE_PAGE)
        return NULL;
    const size_t alignment = bytes < LARGE_PAGE ? CACHE_LINE : LARGE_PAGE;
    bytes = (bytes / alignment + 1) * alignment; /* at least one byte more, so never 0 bytes */
    void *memory = aligned_alloc(alignment, bytes);
    if (memory && alignment == LARGE_PAGE)
        (void)madvise(memory, bytes, MADV_HUGEPAGE); /* a refusal costs only speed */
    return memory;
}
