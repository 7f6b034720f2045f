/* Fuzzes the image loader: any bytes are an image within the limits or an error, never a crash. */
#include "fuzz.h"
#include "image_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    check_image(kiln_asset_image_parse(data, size, "fuzz", &error), &error);
    return 0;
}
