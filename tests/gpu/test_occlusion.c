/* Checks that the depth test rejects billboards behind the scene's surfaces before they are shaded
 * (lib/draw/sprites/occlusion.c), and that this changes no bit of the picture. If this fails,
 * hidden smoke costs as much time as visible smoke, or particles close to surfaces vanish. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "support/cmocka.h"
#include "support/device.h"
#include "support/drawing.h"
#include "support/folders.h"
#include "support/frame.h"
#include "support/pictures.h"

/* The scene of the first test. System `a` has billboards parallel to the picture. System `b` has no
 * particles, but if a test enables it, kiln draws `a` with the shader program for all shapes
 * instead of the one for such billboards. */
static const char CARDS[] =
    "kiln: 1\n"
    "output: {size: [160, 90], fps: 30, frames: 100}\n"
    "simulation: {rate: 60}\n"
    "camera: {position: [0, 0, 10], target: [0, 0, 0], fov: 60 deg, near: 0.1}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 1, life: 10 s}\n"
    "    look: {fade: {in: 0, out: 0}, size: 2 m}\n"
    "  b: {enabled: false, emit: {rate: 1}, look: {shape: point}}\n";

/* Draws 150 billboards 10 m from the camera. Returns how many fragments pass the depth test,
 * including one for each pixel of a wall, wall_m in front of the camera, that fills the depth
 * buffer first. */
static uint32_t shaded(struct kiln_device *device, const char *const *overrides, size_t count,
                       float wall_m)
{
    enum { PARTICLES = 150 };
    struct kiln_particle particles[PARTICLES];
    for (uint32_t i = 0; i < PARTICLES; i++)
        particles[i] = drawing_particle(i, (float3){0.01f * (float)i, 0, 0}, (float3){1, 1, 0});
    struct drawing d;
    drawing_init(&d, device, CARDS, overrides, count);
    drawing_place(&d, particles, PARTICLES, 30);
    GLuint query = 0, passed = 0;
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    drawing_run(&d, PARTICLES, wall_m);
    glEndQuery(GL_SAMPLES_PASSED);
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &passed);
    glDeleteQueries(1, &query);
    drawing_finish(&d);
    return passed;
}

/* All fragments of billboards in front of a wall are shaded, even if the wall is only 10 cm behind
 * them. Behind the wall, none is: only the wall's own fragments pass the depth test. */
static void hidden_billboards_are_not_shaded(void **state)
{
    static const char *const overrides[] = {"systems.b.enabled=true",
                                            "systems.a.look.facing=viewpoint"};
    static const enum kiln_raster_technique techniques[] = {KILN_RASTER_GEOMETRY,
                                                            KILN_RASTER_INSTANCED};
    const uint32_t wall = 160 * 90;
    drawing_most = 150;
    for (int i = 0; i < 4; i++) {
        const size_t count = i < 2 ? 0 : 2;
        drawing_technique = techniques[i % 2];
        uint32_t all = shaded(*state, overrides, count, 12);
        assert_true(all > 2 * wall);
        assert_int_equal(shaded(*state, overrides, count, 10.1f), all);
        assert_int_equal(shaded(*state, overrides, count, 9), wall);
    }
    drawing_technique = KILN_RASTER_GEOMETRY;
}

/* The scene of the second test. Its smoke, fire, axial billboards and lines lie in front of two
 * boxes, behind them, across their surfaces, and around the camera. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [96, 64], fps: 60, frames: 60}\n"
    "camera: {position: [0, 1.2, 1.5], target: [0, 1, 0]}\n"
    "backdrop:\n"
    "  objects:\n"
    "    - box: {center: [-0.4, 1, 0.2], size: [0.5, 3, 0.3]}\n"
    "    - box: {center: [0.8, 1, -1], size: [1, 3, 0.3]}\n"
    "systems:\n"
    "  puffs:\n"
    "    emit: {rate: 0, bursts: {0 s: 200}, life: 9 s, speed: [0, 4]}\n"
    "    collide: none\n"
    "    look: {atlas: 'builtin:smoke', size: 0.7 m, opacity: 0.3, soft: 2}\n"
    "  hard:\n"
    "    emit: {rate: 0, bursts: {0 s: 60}, life: 9 s, speed: [0, 4]}\n"
    "    collide: none\n"
    "    look: {atlas: 'builtin:puff', size: 0.4 m, opacity: 0.5, soft: 0}\n"
    "  fire:\n"
    "    emit: {rate: 0, bursts: {0 s: 60}, life: 9 s, speed: [0, 4]}\n"
    "    collide: none\n"
    "    look: {atlas: 'builtin:puff', blend: add, size: 0.4 m, color: [1, 0.5, 0.2], bloom: 1}\n"
    "  cards:\n"
    "    enabled: false\n"
    "    emit: {rate: 0, bursts: {0 s: 60}, life: 9 s, speed: [0, 4]}\n"
    "    collide: none\n"
    "    look: {atlas: 'builtin:puff', size: 1.5 m, opacity: 0.3, facing: axial, axis: [1, 1, 2]}\n"
    "  lines:\n"
    "    enabled: false\n"
    "    emit: {rate: 0, bursts: {0 s: 60}, life: 9 s, speed: [1, 4]}\n"
    "    collide: none\n"
    "    look: {shape: line, stretch: 0.2 s, line: {width: 2 px}, color: [0.1, 0.4, 0.8]}\n";

static struct kiln_picture *draw(struct kiln_device *device, const struct frame_setting *setting)
{
    return frame_draw(device, SCENE, 20, setting);
}

/* A picture has the same bits with and without the depth test. For the picture without it, another
 * shader occlusion.frag fills the depth buffer with the greatest depth, so that the test rejects
 * nothing. */
static void occlusion_changes_no_bit_of_a_picture(void **state)
{
    static const char *const all = "systems.*.enabled=true",
                             *const literal = "systems.*.look.soft_formula=literal",
                             *const mixed = "post.particles={resolution: half, mixed: true}";
    struct kiln_techniques instanced = FRAME_GL;
    instanced.raster = KILN_RASTER_INSTANCED;
    const struct frame_setting settings[] = {
        {{NULL}, 0, FRAME_GL, 0},
        {{all}, 1, FRAME_GL, 0},
        {{all}, 1, instanced, 0},
        {{all, literal}, 2, FRAME_GL, 0},
        {{all, "post.compose=separate"}, 2, FRAME_GL, 0},
        {{all, "post.compose=oit"}, 2, FRAME_GL, 0},
        {{all, mixed}, 2, FRAME_GL, 0},
        {{all, mixed, "post.compose=oit"}, 3, FRAME_GL, 0},
    };
    struct kiln_device *device = *state;
    const bool software = device->info.software;
    char folder[32], path[128];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/draw/sprites/occlusion.frag", folder);
    test_write_file(path, "void main() { gl_FragDepth = 1.0; }\n"); /* 1: rejects no fragment */
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        device->info.software = false; /* as on a GPU, where the depth test is always used */
        struct kiln_picture *found = draw(*state, &settings[i]);
        setenv("KILN_SHADER_DIR", folder, 1);
        struct kiln_picture *expected = draw(*state, &settings[i]);
        unsetenv("KILN_SHADER_DIR");
        device->info.software = software;
        for (int layer = 0; layer < FRAME_LAYERS; layer++) {
            size_t values =
                (size_t)expected->width * expected->height * expected->layers[layer].channels;
            assert_memory_equal(expected->layers[layer].pixels, found->layers[layer].pixels,
                                values * sizeof(float));
        }
        kiln_picture_destroy(&expected);
        kiln_picture_destroy(&found);
    }
    test_remove_folder(folder);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(hidden_billboards_are_not_shaded),
        test_on_device(occlusion_changes_no_bit_of_a_picture),
    };
    return cmocka_run_group_tests_name("occlusion", tests, test_device_open, test_device_close);
}
