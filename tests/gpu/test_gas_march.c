/* The march through gas in GL: each kind of gas, and all that lies before it or lights it, would
 * look other than on the host. Pictures, layers and depths of half opacity are compared pixel by
 * pixel; gpu.gas_depth compares the profiles. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "draw/volume/volume_gl.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/gas_fixture.h"
#include "support/gas_view.h"

enum { SIZE = GAS_VIEW_SIZE, FLOATS = GAS_VIEW_FLOATS, PIXELS = FLOATS / 4 };

/* Holds what a march draws. */
struct drawn {
    float picture[FLOATS], layer[FLOATS], halfway_m[PIXELS];
};

static void light(struct gas_view *f)
{
    f->light.sky_top = f->light.sky_horizon = FLOAT4(0.5f, 0.8f, 1.2f, 0.0f);
    f->light.sun_direction = FLOAT4(0.48f, 0.6f, 0.64f, 0.0f);
    f->light.sun_color = FLOAT4(3.0f, 2.5f, 2.0f, 0.0f);
}

static struct kiln_gas *add(struct gas_view *f)
{
    const struct kiln_gas_look look = {.extinction = gas_view_value(4.0f),
                                       .albedo = gas_view_value3(0.4f, 0.6f, 0.8f),
                                       .scattering = gas_view_value(0.5f),
                                       .intensity = gas_view_value(9.0f),
                                       .absorption = gas_view_value(1.0f),
                                       .bloom = gas_view_value(0.5f),
                                       .glow = gas_view_value(1.0f),
                                       .lights = true};
    light(f);
    return gas_view_add(f, look);
}

static void add_lumps(struct gas_view *f)
{
    gas_fixture_lumps(add(f), 64);
}

/* The scene ends within the gas on the left, and before it at the top. */
static void end_in_gas(struct gas_view *f)
{
    struct kiln_error error = {0};
    add_lumps(f);
    float *depth = kiln_image_host(&f->depth, KILN_OVERWRITE, &error);
    for (int i = 0; i < PIXELS; i++)
        depth[i] = i / SIZE < SIZE / 4 ? 5.0f : i % SIZE < SIZE / 2 ? 9.9f : 1e9f;
}

static void look_from_within(struct gas_view *f)
{
    add_lumps(f);
    f->moment.view.eye.z = 0.4f;
}

/* Two domains before each other, one of them in a node that turns and scales. */
static void add_two(struct gas_view *f)
{
    add_lumps(f);
    struct kiln_gas *gas = add(f);
    gas_fixture_ball(gas, 32, 1.0f / 32.0f, 0.4f, 1.0f, 0.5f);
    f->scene->gas[1].attach = (struct kiln_attach){.name = "cart", .node = 0};
    gas->shape.corner = FLOAT3(-0.7f, 1.0f, -2.0f);
}

static void veil(struct gas_view *f)
{
    add_lumps(f);
    f->light.floor_params = FLOAT4(0.0f, 1.0f, 0.1f, 0.3f);
    f->light.sky_horizon.w = 2.0f;
}

/* Replaces an even domain by one whose cells also have colours, or ways. */
static void fill(struct kiln_gas *gas, struct kiln_gas_shape shape)
{
    srand(5);
    kiln_gas_finish(gas);
    kiln_gas_init(gas, &shape);
    assert_true(kiln_gas_set_window(gas, (struct kiln_gas_place){0, 0, 0}, shape.cells));
    for (size_t i = 0; i < 64; i++) {
        assert_true(kiln_gas_brick_take(gas, &gas->brick[i]));
        gas->has_gas[i] = 1;
        for (int k = 0; k < GAS_BRICK_CELLS; k++) {
            float *cell = gas->brick[i].now + (ptrdiff_t)k * GAS_CARRIED;
            cell[GAS_SMOKE] = 0.5f;
            cell[GAS_FLAME] = i % 8 < 2 ? 0.2f : 0.0f;
            cell[GAS_TEMPERATURE] = 0.8f;
        }
        for (int k = 0; k < (shape.detailed ? 2 : 1) * GAS_BRICK_CELLS * GAS_CARRIED; k++)
            gas->brick[i].extras[k] = 0.2f * (float)(rand() % 1001) / 1000.0f;
    }
}

static void add_colored(struct gas_view *f)
{
    struct kiln_gas *gas = add(f);
    gas_fixture_full(gas, 32, 2.0f / 32.0f, 0.0f, 0.0f, 0.0f);
    struct kiln_gas_shape shape = gas->shape;
    shape.colored = true;
    fill(gas, shape);
}

static void add_detailed(struct gas_view *f, uint32_t detail)
{
    struct kiln_gas *gas = add(f);
    gas_fixture_full(gas, 32, 2.0f / 32.0f, 0.0f, 0.0f, 0.0f);
    struct kiln_gas_shape shape = gas->shape;
    shape.detailed = true;
    f->scene->gas[0].detail = detail;
    fill(gas, shape);
}

static void add_fine(struct gas_view *f)
{
    add_detailed(f, 2);
}

static void add_finest(struct gas_view *f)
{
    add_detailed(f, 4);
}

static void draw(struct kiln_device *device, void (*set_up)(struct gas_view *f), struct drawn *to)
{
    struct gas_view f;
    struct kiln_error error = {0};
    gas_view_open_on(&f, device);
    f.layers = true;
    set_up(&f);
    memcpy(to->picture, gas_view_draw(&f), sizeof to->picture);
    memcpy(to->layer, kiln_image_host(&f.layer, KILN_READ, &error), sizeof to->layer);
    memcpy(to->halfway_m, kiln_image_host(&f.halfway, KILN_READ, &error), sizeof to->halfway_m);
    gas_view_close(&f);
}

/* Returns by how much a picture is off, in parts of its brightest light. */
static double difference(const float *found, const float *expected)
{
    double most = 0.0, brightest = 0.0;
    for (int i = 0; i < FLOATS; i++) {
        most = fmax(most, fabs((double)found[i] - (double)expected[i]));
        brightest = fmax(brightest, (double)expected[i]);
    }
    assert_true(brightest > 0.05);
    return most / brightest;
}

/* Counts the pixels whose depths of half opacity are more than 1 mm apart. */
static int count_apart(const float *found, const float *expected)
{
    int count = 0;
    for (int i = 0; i < PIXELS; i++)
        count += !(fabsf(found[i] - expected[i]) < 1e-3f);
    return count;
}

static void gas_is_as_on_the_host(void **state)
{
    static const struct {
        const char *name;
        void (*set_up)(struct gas_view *f);
    } cases[] = {{"lumps of smoke and a shell of flames", add_lumps},
                 {"the scene ends in the gas", end_in_gas},
                 {"the camera is in the gas", look_from_within},
                 {"two domains", add_two},
                 {"haze", veil},
                 {"colours", add_colored},
                 {"noise", add_fine},
                 {"two octaves of noise", add_finest}};
    static struct drawn host, gl;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        draw(NULL, cases[i].set_up, &host);
        draw(*state, cases[i].set_up, &gl);
        const double picture = difference(gl.picture, host.picture);
        const double layer = difference(gl.layer, host.layer);
        const int apart = count_apart(gl.halfway_m, host.halfway_m);
        if (picture > 1e-3 || layer > 1e-3 || apart > 4)
            fail_msg("%s: the picture is off by %.5f, the layer by %.5f, and %d depths are apart",
                     cases[i].name, picture, layer, apart);
    }
}

/* Draws gas on a device that allows so few bytes a storage block, and again on the device as it is.
 * Returns the first error. */
static struct kiln_error draw_in(struct kiln_device *device, int32_t cells, long long bytes)
{
    struct kiln_error error = {0}, other = {0};
    struct gas_view f;
    gas_view_open_on(&f, device);
    gas_fixture_lumps(add(&f), cells);
    f.scene->gas[0].shape = f.pool.gas[0].shape;
    struct kiln_threads *threads = kiln_threads_create(1);
    struct kiln_volume_stage *stage = kiln_volume_create(&f.moment, false, threads, &error);
    const struct kiln_volume_draw gas = {.moment = &f.moment,
                                         .pool = &f.pool,
                                         .backdrop = &f.light,
                                         .depth = &f.depth,
                                         .profiles = true};
    assert_true(kiln_volume_use_gl(stage, device, &error));
    const long long allowed = device->info.max_storage_block_bytes;
    device->info.max_storage_block_bytes = bytes;
    assert_false(kiln_volume_draw(stage, &gas, &error));
    device->info.max_storage_block_bytes = allowed;
    assert_true(kiln_volume_draw(stage, &gas, &other));
    kiln_volume_destroy(&stage);
    kiln_threads_destroy(&threads);
    gas_view_close(&f);
    return error;
}

static void storage_blocks_that_are_too_small_are_an_error(void **state)
{
    struct kiln_device *device = *state;
    struct kiln_error error = draw_in(device, 64, 1 << 18);
    expect_error_around(&error, KILN_DEVICE_FAILED,
                        "allows 262144: use march=cpu, or a smaller picture, or larger cells",
                        "gas needs a storage block of ");
    error = draw_in(device, 16, 1 << 18);
    expect_error(&error, KILN_DEVICE_FAILED,
                 "the profiles of gas take more than the 262144 bytes that %s allows a storage "
                 "block: use march=cpu, or a smaller picture",
                 device->info.name);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        test_on_device(gas_is_as_on_the_host),
        test_on_device(storage_blocks_that_are_too_small_are_an_error)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
