/* Fuzzes the reader of EXR layers in the same way. */
#include "asset/image/exr_in.h"
#include "fuzz.h"
#include "image_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const layers[] = {"beauty", "fire", "depth"};
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        struct kiln_error error = {0};
        check_image(kiln_exr_parse(data, size, "fuzz", layers[i], &error), &error);
    }
    return 0;
}
