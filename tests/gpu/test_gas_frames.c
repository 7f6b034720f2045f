/* Frames with gas on a device: the gas, which is marched on the host or in GL, would be missing in
 * pictures and layers of techniques of GL, or lie elsewhere, or before particles that it is behind.
 */
#include <math.h>

#include "support/device.h"
#include "support/gas_frame.h"

static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [48, 36]}\n"
    "camera: {position: [0, 1, 10], target: [0, 1, 0], fov: 18 deg}\n"
    "backdrop: {haze: 0, objects: [{sphere: {center: [0.8, 0.6, 0], radius: 0.5}}]}\n"
    "systems:\n"
    "  before:\n"
    "    emit: {rate: 60, life: 1 s, from: {point: {origin: [-0.3, 1, 3]}}}\n"
    "    look: {blend: add, shape: point, size: 0.4 m, color: [3, 2, 1]}\n"
    "  within:\n"
    "    emit: {rate: 60, life: 1 s, from: {point: {origin: [-0.6, 0.5, 0.3]}}}\n"
    "    look: {shape: point, size: 0.4 m, opacity: 0.3, color: [1, 2, 3], bloom: 0.5}\n"
    "  behind:\n"
    "    emit: {rate: 60, life: 1 s, from: {point: {origin: [0.2, 1.5, -3]}}}\n"
    "    look: {blend: add, shape: point, size: 0.4 m, color: [1, 1, 3], bloom: 0.5}\n";

static void gas_is_as_on_the_host(void **state)
{
    struct kiln_device *device = *state;
    static const struct {
        const char *override;
        enum kiln_raster_technique raster;
    } cases[] = {{"post.compose=merged", KILN_RASTER_GEOMETRY},
                 {"post.compose=separate", KILN_RASTER_TILED},
                 {"post.compose=alpha", KILN_RASTER_INSTANCED},
                 {"post.compose=oit", KILN_RASTER_TILED},
                 {"camera.shutter.samples=2", KILN_RASTER_TILED},
                 {"camera.aperture=10 cm", KILN_RASTER_TILED},
                 {"post.particles.resolution=half", KILN_RASTER_GEOMETRY},
                 {"post.particles={resolution: half, mixed: true}", KILN_RASTER_TILED}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct gas_frame frame = {.text = SCENE,
                                  .overrides = {cases[i].override},
                                  .count = 1,
                                  .domain = true,
                                  .smoke = 1.0f,
                                  .flame = 0.1f,
                                  .steps = 10,
                                  .techniques = FRAME_CPU};
        struct kiln_picture *host = gas_frame_draw(NULL, &frame);
        frame.techniques = FRAME_GL;
        frame.techniques.raster = cases[i].raster;
        frame.techniques.march = i % 2 ? KILN_MARCH_GL : KILN_MARCH_CPU;
        struct kiln_picture *gl = gas_frame_draw(device, &frame);
        for (int layer = 0; layer < FRAME_LAYERS; layer++) {
            const double off = frame_difference(host, gl, layer);
            if (!(off < 1e-3))
                fail_msg("%s: layer %d differs by %g", cases[i].override, layer, off);
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
