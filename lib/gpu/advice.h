/* This header declares the advice on a machine that cannot render: it names what to install or
 * permit. */
#ifndef KILN_GPU_ADVICE_H
#define KILN_GPU_ADVICE_H

#include "kiln.h"

/* Writes which packages or permissions are missing, or "" when none is. problem says why there are
 * no devices at all. The function looks at /dev. */
void kiln_device_advise(const struct kiln_device_info *infos, size_t count, const char *problem,
                        char advice[256]);

#endif
