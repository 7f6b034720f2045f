/* Allocates memory for large arrays, such as images and particles. */
#ifndef KILN_BASE_PAGES_H
#define KILN_BASE_PAGES_H

#include <stddef.h>

/* Allocates memory of undefined contents, aligned to 64 bytes, and from 2 MiB on in large pages
 * where the system has them: there are fewer page faults, and fewer addresses to translate. The
 * caller frees it with free(). `bytes` may be 0. NULL when memory is short. */
void *kiln_alloc_pages(size_t bytes);

#endif
