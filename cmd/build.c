/* Names the build of kiln that is running. */
#include "build.h"

#include "commit.h"
#include "kiln_program.h"

const char *build_name(void)
{
    return *KILN_COMMIT ? KILN_VERSION " (" KILN_COMMIT ")" : KILN_VERSION;
}
