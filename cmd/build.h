/* Names the build of kiln that is running. */
#ifndef KILN_CMD_BUILD_H
#define KILN_CMD_BUILD_H

/* Returns the version and, where it is known, the commit: "0.2.0 (254e4dc)". A '+' after the commit
 * means that files have changed since. */
const char *build_name(void);

#endif
