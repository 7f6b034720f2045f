/* Fuzzes the decoder of layers of EXR files by OpenEXR's C++, which kiln-openexr.so has: deep
 * parts, and the compressions that OpenEXR's C core cannot read. For any input it must return an
 * image within the size limits or an error, and never crash. If this fails, a malicious EXR file
 * may take over kiln-decode, the separate process that decodes untrusted files. */
#include <stdlib.h>

#include "exr_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static bool begun;
    struct kiln_error error = {0};
    if (!begun) {
        setenv("KILN_LIBEXEC_DIR", KILN_MODULES, 1);
        begun = decode_exr_more_begin(&error);
        require(begun, error.message);
    }
    check_exr(data, size);
    return 0;
}
