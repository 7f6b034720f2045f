/* Sprites before, within and behind gas by the rasters of GL, which read the profiles of the gas: a
 * picture would show sprites through gas that hides them, or gas through sprites before it. Whole
 * pictures are compared with the reference of unit.gas_depth. */
#include "draw/sprites/gas_before.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/gas_depth.h"
#include "support/parts.h"

/* A short run of the tests leaves out `geometry`, which has the fragment shader of `instanced`. */
static void check(struct kiln_device *device, bool by_fragment, bool half, float extinction)
{
    static const enum kiln_raster_technique techniques[] = {
        KILN_RASTER_TILED, KILN_RASTER_INSTANCED, KILN_RASTER_GEOMETRY};
    for (size_t i = 0; i < (test_is_full() ? 3u : 2u); i++) {
        struct gas_depth f;
        gas_depth_open(&f, &(struct gas_depth_setting){.device = device,
                                                       .technique = techniques[i],
                                                       .extinction = extinction,
                                                       .by_fragment = by_fragment,
                                                       .half = half});
        gas_depth_check(&f);
        gas_depth_close(&f);
    }
}

static void sprites_are_blended_with_thin_gas(void **state)
{
    check(*state, false, false, 1.0f);
}

static void sprites_are_blended_with_thick_gas(void **state)
{
    check(*state, false, false, 8.0f);
}

static void lists_of_fragments_are_blended_with_gas(void **state)
{
    check(*state, true, false, 8.0f);
}

static void pixels_without_a_ray_are_means(void **state)
{
    check(*state, false, true, 8.0f);
}

/* Profiles of march=gl, read by the host and by GL. */
static void the_march_in_gl_writes_profiles(void **state)
{
    static const float extinctions[] = {1.0f, 8.0f};
    for (size_t i = 0; i < 4; i++) {
        struct gas_depth f;
        gas_depth_open(&f, &(struct gas_depth_setting){.device = *state,
                                                       .technique = i % 2 ? KILN_RASTER_TILED
                                                                          : KILN_RASTER_CPU,
                                                       .march_in_gl = true,
                                                       .extinction = extinctions[i / 2]});
        gas_depth_check(&f);
        gas_depth_close(&f);
    }
}

/* The most that the profiles could take is 2.1 MB. */
static void profiles_are_written_in_parts(void **state)
{
    struct kiln_device *device = *state;
    struct gas_depth f;
    const long long allowed = device->info.max_storage_block_bytes;
    device->info.max_storage_block_bytes = 1 << 20;
    gas_depth_open(&f, &(struct gas_depth_setting){.device = device,
                                                   .technique = KILN_RASTER_CPU,
                                                   .march_in_gl = true,
                                                   .extinction = 8.0f,
                                                   .half = true});
    gas_depth_check(&f);
    gas_depth_close(&f);
    device->info.max_storage_block_bytes = allowed;
}

/* A picture of 2^32 pixels has a profile for each of them, of which a texel has four. */
static void profiles_that_are_too_large_are_an_error(void **state)
{
    struct kiln_device *device = *state;
    struct kiln_error error = {0};
    struct kiln_volume_profiles profiles = {
        .count = 1, .width = 1 << 16, .height = 1 << 16, .across = 1 << 13, .tiles = 1 << 26};
    const struct kiln_tile_gas gas = {.profiles = &profiles};
    struct kiln_gas_before *before = kiln_gas_before_create(device, &error);
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    assert_non_null(before);
    if (most > 1 << 30)
        skip();
    assert_false(kiln_gas_before_bind(before, &gas, &error));
    expect_error(&error, KILN_DEVICE_FAILED,
                 "gas in a picture of 65536 x 65536 pixels needs a buffer texture of 1090519040 "
                 "texels; %s allows %d: use raster=cpu, or a smaller picture",
                 device->info.name, most);
    kiln_gas_before_destroy(&before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {test_on_device(sprites_are_blended_with_thin_gas),
                                       test_on_device(sprites_are_blended_with_thick_gas),
                                       test_on_device(lists_of_fragments_are_blended_with_gas),
                                       test_on_device(pixels_without_a_ray_are_means),
                                       test_on_device(the_march_in_gl_writes_profiles),
                                       test_on_device(profiles_are_written_in_parts),
                                       test_on_device(profiles_that_are_too_large_are_an_error)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
