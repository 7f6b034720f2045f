/* What a machine lacks to render, in words that mend it. */
#ifndef KILN_GPU_ADVICE_H
#define KILN_GPU_ADVICE_H

#include "kiln.h"

/* Writes the packages or permissions that are missing, "" when nothing is. problem says why there
 * are no devices at all. Looks at /dev. */
void kiln_device_advise(const struct kiln_device_info *infos, size_t count, const char *problem,
                        char advice[256]);

#endif
