/* Calls libdeflate, which is opened when a small PNG is written, so that no other run waits for
 * it. The table of its functions is state of this file, since a process opens a library once. */
#include "output/png_small.h"

#include <libdeflate.h>
#include <pthread.h>
#include <stdlib.h>

#include "base/library.h"

enum { LEVEL = 12 }; /* libdeflate's highest level */

#define FUNCTIONS(F)                                                                               \
    F(libdeflate_alloc_compressor)                                                                 \
    F(libdeflate_zlib_compress_bound)                                                              \
    F(libdeflate_zlib_compress)                                                                    \
    F(libdeflate_free_compressor)

static struct {
    FUNCTIONS(KILN_LIBRARY_POINTER)
} library;

bool kiln_png_small_open(struct kiln_error *error)
{
#define FIND(function) {#function, &library.function},
    static const struct kiln_library_function functions[] = {FUNCTIONS(FIND)};
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    static bool is_open;
    pthread_mutex_lock(&mutex);
    if (!is_open)
        is_open = kiln_library_open("libdeflate.so.0", "libdeflate0", functions,
                                    sizeof functions / sizeof *functions, error);
    const bool ok = is_open;
    pthread_mutex_unlock(&mutex);
    return ok;
}

uint8_t *kiln_png_small_compress(const uint8_t *bytes, size_t size, size_t *written)
{
    struct libdeflate_compressor *compressor = library.libdeflate_alloc_compressor(LEVEL);
    if (!compressor)
        return NULL;
    const size_t room = library.libdeflate_zlib_compress_bound(compressor, size);
    uint8_t *out = malloc(room);
    if (out)
        *written = library.libdeflate_zlib_compress(compressor, bytes, size, out, room);
    library.libdeflate_free_compressor(compressor);
    return out;
}
