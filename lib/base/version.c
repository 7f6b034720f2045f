/* Returns the version of the library, for callers whose header may be of another version. */
#include "kiln.h"

const char *kiln_version(void)
{
    return KILN_VERSION;
}
