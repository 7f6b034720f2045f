/* Names the build of kiln that is running. The name goes into `kiln --version`, events, manifests
 * and the expect.yaml of tests, so that these tell which kiln made them.
 *
 * KILN_COMMIT is "" where no commit is known. Each build of the program makes commit.h, but writes
 * it only if the commit has changed (cmake/commit.cmake). Only this file includes commit.h, so that
 * a new commit compiles only this file anew. */
#include "build.h"

#include "commit.h"
#include "kiln_program.h"

const char *build_name(void)
{
    return *KILN_COMMIT ? KILN_VERSION " (" KILN_COMMIT ")" : KILN_VERSION;
}
