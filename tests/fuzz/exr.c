/* Fuzzes the decoder of layers of EXR files by OpenEXR's C core: for any input it must return an
 * image within the size limits or an error, and never crash. Files that need OpenEXR's C++ are not
 * decoded here. If this fails, a malicious EXR file may take over kiln-decode, the separate process
 * that decodes untrusted files. */
#include "exr_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    check_exr(data, size);
    return 0;
}
