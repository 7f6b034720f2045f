#include "suite/golden.h"

void kiln_device_name(const char *renderer, char name[KILN_DEVICE_NAME_SIZE])
{
    size_t length = 0;
    bool gap = false;
    for (const char *c = renderer; *c; c++) {
        bool capital = *c >= 'A' && *c <= 'Z';
        bool kept = capital || (*c >= 'a' && *c <= 'z') || (*c >= '0' && *c <= '9') || *c == '.';
        if (kept && length + 2 + gap > KILN_DEVICE_NAME_SIZE)
            break;
        if (kept && gap && length > 0)
            name[length++] = '-';
        if (kept)
            name[length++] = capital ? (char)(*c - 'A' + 'a') : *c;
        gap = !kept;
    }
    name[length] = '\0';
}
