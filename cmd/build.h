/* Names the build of kiln that is running. */
#ifndef KILN_CMD_BUILD_H
#define KILN_CMD_BUILD_H

/* "0.2.0 (254e4dc)": the version, and the commit where one is known; a '+' behind it says that
 * files have changed since. */
const char *build_name(void);

#endif
