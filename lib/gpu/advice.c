/* This file names the packages and permissions that a machine lacks to render. It judges from the
 * devices that were found and from the device nodes under /dev. */
#include "gpu/advice.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static bool has_gpu_of(const struct kiln_device_info *infos, size_t count, const char *vendor)
{
    for (size_t i = 0; i < count; i++)
        if (infos[i].usable && !infos[i].software &&
            (!vendor || strcasestr(infos[i].vendor, vendor)))
            return true;
    return false;
}

static bool has_software(const struct kiln_device_info *infos, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (infos[i].usable && infos[i].software)
            return true;
    return false;
}

/* Appends a sentence to the advice if all of it fits. */
static void append_sentence(char advice[256], const char *sentence)
{
    size_t used = strlen(advice);
    if (used + strlen(sentence) + 3 > 256)
        return;
    snprintf(advice + used, 256 - used, "%s%s", used ? "; " : "", sentence);
}

/* Names the first render node that this user may not open, since EGL does not list such a GPU at
 * all. The kernel numbers render nodes from 128. */
static void advise_permission(char advice[256])
{
    for (unsigned number = 128; number < 192; number++) {
        char node[64], sentence[160];
        snprintf(node, sizeof node, "/dev/dri/renderD%u", number);
        if (access(node, F_OK) != 0 || access(node, R_OK | W_OK) == 0)
            continue;
        snprintf(sentence, sizeof sentence,
                 "the user has no access to %s; add the user to the group render", node);
        append_sentence(advice, sentence);
        return;
    }
}

void kiln_device_advise(const struct kiln_device_info *infos, size_t count, const char *problem,
                        char advice[256])
{
    advice[0] = '\0';
    if (count == 0) {
        append_sentence(advice, problem);
        return;
    }
    if (access("/dev/nvidia0", F_OK) == 0 && !has_gpu_of(infos, count, "NVIDIA"))
        append_sentence(advice,
                        "an NVIDIA GPU is here, but its EGL is missing; install the package "
                        "libegl-nvidia0, or set NVIDIA_DRIVER_CAPABILITIES=all in a container");
    if (!has_gpu_of(infos, count, NULL))
        advise_permission(advice);
    if (!has_gpu_of(infos, count, NULL) && !has_software(infos, count))
        append_sentence(advice,
                        "software rendering is missing; install the packages libegl-mesa0 and "
                        "libgl1-mesa-dri");
}
