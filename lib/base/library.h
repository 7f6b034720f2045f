/* Opens shared libraries when they are needed, so that a run that does not need them neither waits
 * for them nor fails without them. */
#ifndef KILN_BASE_LIBRARY_H
#define KILN_BASE_LIBRARY_H

#include <stddef.h>

#include "kiln.h"

/* A member of a struct that points to the function of a header with that name. */
#define KILN_LIBRARY_POINTER(function) __typeof__(function) *function;

struct kiln_library_function {
    const char *name;
    void *pointer; /* to a function pointer, which is set */
};

/* Opens a library ("libassimp.so.5"), which stays open until the program ends, and finds functions
 * in it. KILN_IO with the package of Debian that brings it when there is none; or when it lacks a
 * function, and then pointers are in an unknown state. For one thread at a time. */
bool kiln_library_open(const char *file, const char *package,
                       const struct kiln_library_function *functions, size_t count,
                       struct kiln_error *error);

#endif
