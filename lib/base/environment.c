/* This file reads variables of the environment. Nothing in kiln changes one. */
#include <stdlib.h>

#include "kiln_program.h"

const char *kiln_environment(const char *name)
{
    const char *value = getenv(name); /* NOLINT(concurrency-mt-unsafe): only read */
    return value && *value ? value : NULL;
}
