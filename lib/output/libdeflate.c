/* Opens and calls libdeflate. The table of its functions is state of this file, since a process
 * opens a library once. */
#include "output/libdeflate.h"

#include <libdeflate.h>
#include <pthread.h>

#include "base/library.h"

#define FUNCTIONS(F)                                                                               \
    F(libdeflate_alloc_compressor)                                                                 \
    F(libdeflate_zlib_compress_bound)                                                              \
    F(libdeflate_zlib_compress)                                                                    \
    F(libdeflate_free_compressor)

static struct {
    FUNCTIONS(KILN_LIBRARY_POINTER)
} library;

bool kiln_libdeflate_open(struct kiln_error *error)
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

/* A kiln_compressor is libdeflate's own. */
static struct libdeflate_compressor *own(struct kiln_compressor *compressor)
{
    return (struct libdeflate_compressor *)compressor;
}

struct kiln_compressor *kiln_compressor_create(int level)
{
    return (struct kiln_compressor *)library.libdeflate_alloc_compressor(level);
}

void kiln_compressor_destroy(struct kiln_compressor **compressor)
{
    if (*compressor)
        library.libdeflate_free_compressor(own(*compressor));
    *compressor = NULL;
}

size_t kiln_compressor_room(struct kiln_compressor *compressor, size_t size)
{
    return library.libdeflate_zlib_compress_bound(own(compressor), size);
}

size_t kiln_compressor_run(struct kiln_compressor *compressor, const void *bytes, size_t size,
                           void *out, size_t room)
{
    return library.libdeflate_zlib_compress(own(compressor), bytes, size, out, room);
}
