/* Fuzzes the decoder of layers of EXR files by OpenEXR's C core: for any input it must return an
 * image within the size limits or an error, and never crash. Files that need OpenEXR's C++ are not
 * decoded here. If this fails, a malicious EXR file may take over
 * kiln-decode, the separate process that decodes untrusted files. */
#include "decode.h"
#include "fuzz.h"
#include "image_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const layers[] = {"beauty", "fire", "depth", "N", "left.id"};
    fuzz_taken = false;
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        struct kiln_error error = {0};
        struct decode_picture picture = {.bytes = data,
                                         .size = size,
                                         .format = KILN_PICTURE_EXR,
                                         .layer = layers[i],
                                         .most_pixels = KILN_MAX_IMAGE_PIXELS,
                                         .error = &error};
        fuzz_taken = check_image(decode_exr(&picture), &error) || fuzz_taken;
    }
    return 0;
}
