/* Allocates memory in transparent huge pages. It asks for them by madvise, since most systems give
 * them only on request. */
#include "base/pages.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

enum { LARGE_PAGE = 2 << 20, CACHE_LINE = 64 };

void *kiln_alloc_pages(size_t bytes)
{
    if (bytes > PTRDIFF_MAX - LARGE_PAGE)
        return NULL;
    const size_t page = bytes < LARGE_PAGE ? CACHE_LINE : LARGE_PAGE;
    bytes = (bytes / page + 1) * page;
    void *memory = aligned_alloc(page, bytes);
    if (memory && page == LARGE_PAGE)
        (void)madvise(memory, bytes, MADV_HUGEPAGE); /* a refusal costs only speed */
    return memory;
}
