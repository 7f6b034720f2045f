/* Copies structs that begin with their own size between the library and a caller that may have been
 * built against another version. The first member of such a struct is a size_t with the bytes of
 * the whole struct. A member that only one of the two versions has is not copied. */
#include "base/sized.h"

#include <string.h>

#include "base/error.h"

enum { MOST_BYTES = 1 << 20 }; /* every struct is far smaller */

static size_t size_of(const void *sized)
{
    size_t size;
    memcpy(&size, sized, sizeof size);
    return size;
}

bool kiln_sized_check(const void *sized, const char *what, struct kiln_error *error)
{
    const size_t size = sized ? size_of(sized) : sizeof(size_t);
    return (size >= sizeof(size_t) && size <= MOST_BYTES) ||
           kiln_error_set(
               error, KILN_USAGE,
               "struct %s: the size is %zu; fill the struct first by its function in the "
               "header, as kiln_render_defaults() fills a kiln_render_params",
               what, size);
}

bool kiln_sized_take(void *own, const void *given, const char *what, struct kiln_error *error)
{
    const size_t own_size = size_of(own);
    if (!kiln_sized_check(given, what, error))
        return false;
    if (given) {
        const size_t size = size_of(given);
        memcpy(own, given, size < own_size ? size : own_size);
        memcpy(own, &own_size, sizeof own_size);
    }
    return true;
}

void kiln_sized_give(void *out, const void *own)
{
    if (!out)
        return;
    const size_t own_size = size_of(own), size = size_of(out);
    memcpy(out, own, size < own_size ? size : own_size);
    memcpy(out, &size, sizeof size);
}
