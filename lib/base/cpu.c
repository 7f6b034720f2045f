/* Finds the name of the processor: the first model name in /proc/cpuinfo. Where there is none, the
 * name is the machine's architecture, as uname gives it. */
#include "base/cpu.h"

#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>

static void take_value(char name[128], const char *value)
{
    value += strspn(value, " \t:");
    snprintf(name, 128, "%.*s", (int)strcspn(value, "\n"), value);
}

void kiln_cpu_name(char name[128])
{
    static const char key[] = "model name";
    char line[512];
    name[0] = '\0';
    FILE *file = fopen("/proc/cpuinfo", "re");
    while (file && !*name && fgets(line, sizeof line, file)) {
        if (strncmp(line, key, sizeof key - 1) == 0)
            take_value(name, line + sizeof key - 1);
    }
    if (file)
        fclose(file);
    struct utsname system;
    if (!*name && uname(&system) == 0)
        snprintf(name, 128, "%.127s", system.machine);
}
