/* Opens shared libraries by the dynamic linker (dlopen), and finds functions in them by their
 * names. */
#include "base/library.h"

#include <dlfcn.h>
#include <string.h>

#include "base/error.h"

bool kiln_library_open(const char *file, const char *package,
                       const struct kiln_library_function *functions, size_t count,
                       struct kiln_error *error)
{
    void *library = dlopen(file, RTLD_LAZY | RTLD_LOCAL);
    if (!library) {
        const char *reason = dlerror(); /* NOLINT(concurrency-mt-unsafe): it is glibc's */
        return kiln_error_set(error, KILN_IO,
                              "the library %s cannot be loaded; install Debian's package %s (%s)",
                              file, package, reason ? reason : "the reason is unknown");
    }
    for (size_t i = 0; i < count; i++) {
        void *found = dlsym(library, functions[i].name);
        if (!found)
            return kiln_error_set(error, KILN_IO, "the library %s has no function %s", file,
                                  functions[i].name);
        /* In POSIX, a pointer to an object can hold a pointer to a function. */
        memcpy(functions[i].pointer, &found, sizeof found);
    }
    return true;
}
