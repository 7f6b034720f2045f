/* This header declares the advice on a machine that cannot render: which packages to install or
 * which permission to grant. */
#ifndef KILN_GPU_ADVICE_H
#define KILN_GPU_ADVICE_H

#include "kiln.h"

/* Writes which packages or permissions are missing, or "" if none is. problem becomes the advice if
 * count is 0. The function reads /dev. */
void kiln_device_advise(const struct kiln_device_info *infos, size_t count, const char *problem,
                        char advice[256]);

#endif
