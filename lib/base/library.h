/* Opens shared libraries when they are needed, so that a run that does not need them neither waits
 * for them nor fails without them. */
#ifndef KILN_BASE_LIBRARY_H
#define KILN_BASE_LIBRARY_H

#include <stddef.h>

#include "kiln.h"

/* Declares a struct member that points to the header's function of the same name. */
#define KILN_LIBRARY_POINTER(function) __typeof__(function) *function;

struct kiln_library_function {
    const char *name;
    void *pointer; /* address of the function pointer to set */
};

/* Opens a library ("libtiff.so.6"), which stays open until the program ends, and finds functions
 * in it. KILN_IO, with the Debian package that has it, when there is no such library. KILN_IO also
 * when it lacks a function; then the pointers are in an unknown state. Only one thread may call at
 * a time. */
bool kiln_library_open(const char *file, const char *package,
                       const struct kiln_library_function *functions, size_t count,
                       struct kiln_error *error);

#endif
