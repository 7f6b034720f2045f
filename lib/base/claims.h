/* The files that one call reads and those that it writes, so that none is written twice and none
 * that is read is lost. A file is known by where its path leads, however it is spelt. */
#ifndef KILN_BASE_CLAIMS_H
#define KILN_BASE_CLAIMS_H

#include "kiln.h"

/* Declares a file that the call reads, wherever that is (`path`); a path that leads nowhere is
 * nobody's file, and whoever reads it says so. `what` stands for it in messages: "a texture".
 * KILN_USAGE when the call writes it, KILN_DEVICE_FAILED when memory is short. */
bool kiln_claims_read(struct kiln_claims *claims, const char *path, const char *what,
                      struct kiln_error *error);

#endif
