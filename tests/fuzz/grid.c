/* Fuzzes the reader of kiln-grid files, which hold vector fields such as wind. Any bytes must give
 * an error, or a grid of finite samples whose number is within the limit. If this fails, a damaged
 * grid file crashes kiln or moves particles to NaN. */
#include <math.h>

#include "asset/geometry/grid_in.h"
#include "fuzz.h"
#include "image_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct kiln_error error = {0};
    struct kiln_grid_file *grid = kiln_grid_parse(data, size, "fuzz", &error);
    require(grid || (error.code != KILN_OK && *error.message), "an error without a message");
    fuzz_taken = grid != NULL;
    const size_t count = grid ? (size_t)grid->size[0] * grid->size[1] * grid->size[2] : 0;
    require(count <= KILN_MAX_GRID_SAMPLES, "a grid beyond the limits");
    for (size_t i = 0; i < 3 * count; i++)
        require(isfinite(grid->samples[i / 3][i % 3]), "a sample is not finite");
    kiln_grid_destroy(&grid);
    return 0;
}
