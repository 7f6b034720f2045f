/* Fuzzes the PNG decoder of kiln-decode, the separate process that decodes strangers' files: any
 * bytes must give an image within the limits or an error, never a crash. If this fails, a malicious
 * PNG file may take over kiln-decode. */
#include "decode.h"
#include "fuzz.h"
#include "image_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    struct decode_picture picture = {.bytes = data,
                                     .size = size,
                                     .format = KILN_PICTURE_PNG,
                                     .most_pixels = KILN_MAX_IMAGE_PIXELS,
                                     .error = &error};
    fuzz_taken = check_image(decode_png(&picture), &error);
    return 0;
}
