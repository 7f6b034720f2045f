/* Writes OpenVDB files of gas whose content is known: write FOLDER. read.sh has OpenVDB's own tools
 * read them. */
#include <stdio.h>
#include <string.h>

#include "output/gas_vdb.h"
#include "support/gas_fixture.h"

static struct kiln_gas gas;

static bool write_file(const char *folder, const char *name, const struct kiln_gas_vdb *params)
{
    struct kiln_error error = kiln_error_empty();
    struct kiln_temporary file = {.target = NULL};
    char path[512];
    uint64_t voxels;
    snprintf(path, sizeof path, "%s/%s.vdb", folder, name);
    const bool ok = kiln_temporary_open(&file, path, &error) &&
                    kiln_gas_vdb_write(params, &file, NULL, NULL, &voxels, &error) &&
                    kiln_temporary_commit(&file, true, &error);
    if (!ok)
        fprintf(stderr, "%s: %s\n", path, error.message);
    return ok;
}

int main(int argc, char **argv)
{
    static const struct kiln_vdb_meta metas[] = {
        {.name = "creator", .text = "kiln"},
        {.name = "gas", .text = "fire"},
        {.name = "frame", .type = KILN_VDB_INT32, .integer = 12},
        {.name = "time", .type = KILN_VDB_DOUBLE, .number = 0.5},
    };
    /* a quarter turn about y: x of the node is -z of the world */
    const struct kiln_node_frame frame = {.at = {10, 20, 30},
                                          .turn = {0, 0.70710678118654757, 0, 0.70710678118654757},
                                          .scale = 2,
                                          .velocity = {0, 0, -7}};
    const struct kiln_gas_shape shape = {.cells = {16, 32, 48}, .cell = 0.25f};
    struct kiln_gas empty;
    if (argc != 2)
        return 2;
    gas_fixture_ball(&gas, 48, 0.125f, 0.3f, 0.5f, 0.25f);
    struct kiln_gas_vdb params = {
        .gas = &gas,
        .shape = &gas.shape,
        .kelvin_of = {300, 1300},
        .kelvin = true,
        .cutoff = 0.001f,
        .extinction = 4,
        .albedo = {0.5f, 0.25f, 0.125f},
        .metas = metas,
        .meta_count = sizeof metas / sizeof *metas,
        .uuid = "01234567-89ab-8def-8123-456789abcdef",
    };
    bool ok = write_file(argv[1], "float", &params);
    params.half = params.z_up = true;
    ok = ok && write_file(argv[1], "half", &params);
    params.half = params.z_up = params.kelvin = false;
    params.frame = &frame;
    ok = ok && write_file(argv[1], "node", &params);
    kiln_gas_init(&empty, &shape);
    params.frame = NULL;
    params.gas = &empty;
    params.shape = &shape;
    ok = ok && write_file(argv[1], "empty", &params);
    params.half = true;
    ok = ok && write_file(argv[1], "empty_half", &params);
    kiln_gas_finish(&gas);
    return ok ? 0 : 1;
}
