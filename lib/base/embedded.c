/* Finds an embedded file by its path. The tables are short, so they are searched from the start. */
#include "base/embedded.h"

#include <stddef.h>
#include <string.h>

const char *kiln_embedded_find(const struct kiln_embedded_file *table, const char *path)
{
    for (; table->path; table++)
        if (strcmp(table->path, path) == 0)
            return table->text;
    return NULL;
}
