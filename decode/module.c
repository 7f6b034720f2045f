/* This file opens the modules of kiln-decode, before the process is confined: they lie beside the
 * program, or in the folder that the environment names for kiln's own programs. */
#include "module.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "kiln_program.h"

static bool find_module(const char *module, char path[KILN_PATH_SIZE])
{
    char program[KILN_PATH_SIZE];
    const ssize_t got = readlink("/proc/self/exe", program, sizeof program - 1);
    program[got > 0 ? got : 0] = '\0';
    const char *slash = strrchr(program, '/');
    if (slash &&
        snprintf(path, KILN_PATH_SIZE, "%.*s/%s", (int)(slash - program), program, module) <
            KILN_PATH_SIZE &&
        access(path, R_OK) == 0)
        return true;
    const char *set = kiln_environment("KILN_LIBEXEC_DIR");
    return set && snprintf(path, KILN_PATH_SIZE, "%s/%s", set, module) < KILN_PATH_SIZE;
}

bool decode_module_open(const char *module, const char *package,
                        const struct kiln_library_function *functions, size_t count,
                        struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    return (find_module(module, path) ||
            kiln_error_set(error, KILN_DEVICE_FAILED, "the module %s of kiln is missing",
                           module)) &&
           kiln_library_open(path, package, functions, count, error);
}
