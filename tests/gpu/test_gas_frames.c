/* Frames with gas on a device: the gas, which is marched on the host, would be missing in pictures
 * and layers of techniques of GL, or lie elsewhere. */
#include <math.h>

#include "support/device.h"
#include "support/gas_frame.h"

static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [48, 36]}\n"
    "camera: {position: [0, 1, 10], target: [0, 1, 0], fov: 18 deg}\n"
    "backdrop: {haze: 0, objects: [{sphere: {center: [0.8, 0.6, 0], radius: 0.5}}]}\n"
    "systems:\n"
    "  fire:\n"
    "    emit: {rate: 60, life: 1 s, from: {point: {origin: [-0.3, 1, 3]}}}\n"
    "    look: {blend: add, shape: point, size: 0.4 m, color: [3, 2, 1]}\n";

static void gas_is_as_on_the_host(void **state)
{
    struct kiln_device *device = *state;
    static const char *const compose[] = {"post.compose=merged", "post.compose=separate",
                                          "post.compose=alpha", "camera.shutter.samples=2"};
    for (int i = 0; i < 4; i++) {
        struct gas_frame frame = {.text = SCENE,
                                  .overrides = {compose[i]},
                                  .count = 1,
                                  .domain = true,
                                  .smoke = 1.0f,
                                  .flame = 0.1f,
                                  .steps = 10,
                                  .techniques = FRAME_CPU};
        struct kiln_picture *host = gas_frame_draw(NULL, &frame);
        frame.techniques = FRAME_GL;
        struct kiln_picture *gl = gas_frame_draw(device, &frame);
        for (int layer = 0; layer < FRAME_LAYERS; layer++) {
            const double off = frame_difference(host, gl, layer);
            if (!(off < 0.02))
                fail_msg("%s: layer %d differs by %g", compose[i], layer, off);
        }
        kiln_picture_destroy(&host);
        kiln_picture_destroy(&gl);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {test_on_device(gas_is_as_on_the_host)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
