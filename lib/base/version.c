/* Returns the version of the library with which a program runs. The program may have been compiled
 * with the kiln.h of another version. */
#include "kiln.h"

const char *kiln_version(void)
{
    return KILN_VERSION;
}
