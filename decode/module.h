/* Declares how kiln-decode opens its modules, which are written in C++ and lie beside it. */
#ifndef KILN_DECODE_MODULE_H
#define KILN_DECODE_MODULE_H

#include "base/library.h"

/* Opens a module such as "kiln-openexr.so", as kiln_library_open does. package: what has the
 * library that the module needs. */
bool decode_module_open(const char *module, const char *package,
                        const struct kiln_library_function *functions, size_t count,
                        struct kiln_error *error);

#endif
