/* Checks order-independent transparency (post.compose=oit): in each pixel, nearer fragments of
 * particles cover farther ones, by every technique of stage `raster` and for any number of
 * fragments. If this fails, billboards that cross each other are drawn in a wrong order, or dense
 * smoke loses fragments. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/text.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/frame.h"
#include "support/parts.h"
#include "support/pictures.h"

enum { WIDTH = 96, HEIGHT = 64, STEPS = 20 };

static const char *const OIT = "post.compose=oit";
static const char *const MERGED = "post.compose=merged";

/* Two stacks of billboards with the same centre, seen from above. The red billboards stand upright
 * and the green ones are parallel to the picture, so that the upper half of the red ones is nearer
 * than the green ones, and the lower half is farther. */
static const char CARDS[] =
    "kiln: 1\n"
    "output: {size: [96, 64], fps: 60, frames: 60}\n"
    "camera: {position: [0, 4, 3], target: [0, 1, 0]}\n"
    "backdrop: {floor: none}\n"
    "systems:\n"
    "  red:\n"
    "    emit: {rate: 0, bursts: {0 s: 20}, life: 9 s, speed: 0, from: {point: {origin: [0, 1, "
    "0]}}}\n"
    "    look: {atlas: 'builtin:puff', fade: {in: 0, out: 0}, size: 2 m, facing: axial, rotation: "
    "0 deg, color: [1, 0, "
    "0],\n"
    "           opacity: 0.9, thickness: 0}\n"
    "  green:\n"
    "    emit: {rate: 0, bursts: {0 s: 20}, life: 9 s, speed: 0, from: {point: {origin: [0, 1, "
    "0]}}}\n"
    "    look: {atlas: 'builtin:puff', fade: {in: 0, out: 0}, size: 2 m, rotation: 0 deg, color: "
    "[0, 1, 0],\n"
    "           opacity: 0.9, thickness: 0}\n"
    "post: {bloom: {kind: none}}\n";

/* Returns (red - green) / (red + green) for the twelve middle columns of the rows `from` to `to` -
 * 1: 1 for red alone, -1 for green alone. */
static double redness(const struct kiln_picture *picture, int from, int to)
{
    double red = 0, green = 0;
    for (int y = from; y < to; y++) {
        for (int x = WIDTH / 2 - 6; x < WIDTH / 2 + 6; x++) {
            const float *pixel = picture->layers[FRAME_SMOKE].pixels + 4 * (y * WIDTH + x);
            red += (double)pixel[0];
            green += (double)pixel[1];
        }
    }
    assert_true(red + green > 1.0);
    return (red - green) / (red + green);
}

/* With oit, crossing billboards are sorted in each pixel: red covers green in the upper half, green
 * covers red in the lower half. With merged, which sorts whole billboards by their centres, one
 * colour covers the other in both halves. */
static void crossing_billboards_are_sorted_by_pixel(void **state)
{
    static const struct kiln_techniques *const techniques[] = {&FRAME_CPU, &FRAME_GL};
    for (int i = 0; i < 2; i++) {
        const struct frame_setting oit = {{OIT}, 1, *techniques[i], 0};
        const struct frame_setting merged = {{MERGED}, 1, *techniques[i], 0};
        struct kiln_picture *cross = frame_draw(*state, CARDS, STEPS, &oit);
        struct kiln_picture *flat = frame_draw(*state, CARDS, STEPS, &merged);
        assert_true(redness(cross, 20, 29) > 0.2 && redness(cross, 35, 44) < -0.2);
        assert_true(redness(flat, 20, 29) * redness(flat, 35, 44) > 0.04);
        kiln_picture_destroy(&cross);
        kiln_picture_destroy(&flat);
    }
}

/* A scene with a flame inside a round puff of smoke, 1 cm nearer to the camera than the puff's
 * centre. */
static const char FLAME[] =
    "kiln: 1\n"
    "output: {size: [96, 64], fps: 60, frames: 60}\n"
    "camera: {position: [0, 1, 4], target: [0, 1, 0]}\n"
    "backdrop: {floor: none}\n"
    "systems:\n"
    "  puff:\n"
    "    emit: {rate: 0, bursts: {0 s: 1}, life: 9 s, speed: 0, from: {point: {origin: [0, 1, "
    "0]}}}\n"
    "    look: {atlas: 'builtin:puff', fade: {in: 0, out: 0}, size: 2 m, color: 0, opacity: 0.9, "
    "thickness: 1}\n"
    "  flame:\n"
    "    emit: {rate: 0, bursts: {0 s: 1}, life: 9 s, speed: 0,\n"
    "           from: {point: {origin: [0, 1, 0.01]}}}\n"
    "    look: {atlas: 'builtin:puff', fade: {in: 0, out: 0}, blend: add, size: 0.6 m, color: [4, "
    "2, 1], bloom: 1,\n"
    "           thickness: 0}\n"
    "post: {bloom: {strength: 0}}\n";

/* Draws FLAME, and returns the sum of red over a layer (FRAME_*) of the picture. */
static double light_of(struct kiln_device *device, const struct frame_setting *setting, int layer)
{
    struct kiln_picture *picture = frame_draw(device, FLAME, STEPS, setting);
    double sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        sum += (double)picture->layers[layer].pixels[4 * i];
    kiln_picture_destroy(&picture);
    return sum;
}

/* With oit, a round puff dims the glow of a flame inside it only by its front half. A flat puff
 * (thickness 0) does not dim a flame that is 1 cm in front of it. With merged, puffs have no
 * thickness, so the round puff does not dim it either. */
static void a_puff_half_covers_a_flame_within(void **state)
{
    static const char *const flat = "systems.puff.look.thickness=0";
    static const char *const behind = "systems.flame.emit.from.point.origin=[0, 1, -2]";
    static const char *const front = "systems.flame.emit.from.point.origin=[0, 1, 1.5]";
    const struct frame_setting inside = {{OIT}, 1, FRAME_CPU, 0};
    const struct frame_setting inside_flat = {{OIT, flat}, 2, FRAME_CPU, 0};
    const struct frame_setting merged = {{MERGED}, 1, FRAME_CPU, 0};
    double half = light_of(*state, &inside, FRAME_BLOOM);
    double all = light_of(*state, &inside_flat, FRAME_BLOOM);
    assert_true(half < 0.8 * all && half > 0.2 * all);
    assert_true(fabs(light_of(*state, &merged, FRAME_BLOOM) / all - 1.0) < 1e-5);
    /* If the flame is entirely in front of the puff or behind it, oit draws the same picture as
     * merged. */
    for (int i = 0; i < 2; i++) {
        const struct frame_setting oit = {{OIT, i ? behind : front}, 2, FRAME_CPU, 0};
        const struct frame_setting by_middle = {{MERGED, i ? behind : front}, 2, FRAME_CPU, 0};
        struct kiln_picture *a = frame_draw(*state, FLAME, STEPS, &oit);
        struct kiln_picture *b = frame_draw(*state, FLAME, STEPS, &by_middle);
        for (int layer = 0; layer < FRAME_LAYERS; layer++)
            assert_true(frame_difference(a, b, layer) < 1e-5);
        kiln_picture_destroy(&a);
        kiln_picture_destroy(&b);
    }
}

/* A scene in which many puffs, billboards about an axis, flames and lines cross each other and a
 * box. */
static const char CROWD[] =
    "kiln: 1\n"
    "output: {size: [96, 64], fps: 60, frames: 60}\n"
    "camera: {position: [0, 1.5, 2.4], target: [0, 1, 0]}\n"
    "backdrop: {objects: [{box: {center: [0.4, 1, 0.2], size: [0.3, 3, 0.3]}}]}\n"
    "systems:\n"
    "  puffs:\n"
    "    emit: {rate: 0, bursts: {0 s: 80}, life: 9 s, speed: [0, 2]}\n"
    "    collide: none\n"
    "    look: {atlas: 'builtin:puff', size: 3.5 m, opacity: 0.2, lit: 1, bloom: 0.1}\n"
    "  cards:\n"
    "    emit: {rate: 0, bursts: {0 s: 40}, life: 9 s, speed: [0, 2]}\n"
    "    collide: none\n"
    "    look: {atlas: 'builtin:puff', size: 1.5 m, opacity: 0.3, facing: axial, axis: [1, 1, 0]}\n"
    "  flames:\n"
    "    emit: {rate: 0, bursts: {0 s: 100}, life: 9 s, speed: [0, 2]}\n"
    "    collide: none\n"
    "    look: {atlas: 'builtin:puff', blend: add, size: 0.8 m, color: [0.1, 0.05, 0.02], bloom: "
    "1}\n"
    "  lines:\n"
    "    emit: {rate: 0, bursts: {0 s: 40}, life: 9 s, speed: [1, 2]}\n"
    "    collide: none\n"
    "    look: {shape: line, stretch: 0.2 s, line: {width: 2 px}, color: [0.1, 0.4, 0.8]}\n"
    "  unseen: # beside the picture, as far as the others\n"
    "    emit: {rate: 0, bursts: {0 s: 1}, life: 9 s, speed: 0,\n"
    "           from: {box: {origin: [90, 1, 0], size: [1, 1, 9]}}}\n"
    "    look: {atlas: 'builtin:puff', opacity: 0.2, shadow: 0, lit: 0}\n";

static void techniques_agree(void **state)
{
    static const char *const half = "post.particles={resolution: half, mixed: true}";
    struct kiln_techniques instanced = FRAME_GL;
    struct kiln_techniques tiled = FRAME_GL;
    instanced.raster = KILN_RASTER_INSTANCED;
    tiled.raster = KILN_RASTER_TILED;
    const struct frame_setting settings[] = {
        {{OIT}, 1, FRAME_CPU, 0},       {{OIT}, 1, FRAME_GL, 0},       {{OIT}, 1, instanced, 0},
        {{OIT, half}, 2, FRAME_CPU, 0}, {{OIT, half}, 2, FRAME_GL, 0}, {{OIT}, 1, tiled, 0}};
    struct kiln_picture *pictures[6];
    for (int i = 0; i < 6; i++)
        pictures[i] = frame_draw(*state, CROWD, STEPS, &settings[i]);
    for (int layer = 0; layer < FRAME_LAYERS; layer++) {
        /* off[3] compares half with full resolution; the others compare techniques */
        const double off[5] = {frame_difference(pictures[0], pictures[1], layer),
                               frame_difference(pictures[1], pictures[2], layer),
                               frame_difference(pictures[3], pictures[4], layer),
                               frame_difference(pictures[0], pictures[3], layer),
                               frame_difference(pictures[1], pictures[5], layer)};
        print_message("%d: %.2g %.2g %.2g %.2g %.2g\n", layer, off[0], off[1], off[2], off[3],
                      off[4]);
        const double same = 1e-5 + 2 * test_rounding();
        assert_true(off[4] < same);
        assert_true(off[0] < 5e-3 && off[1] < same && off[2] < 5e-3 && off[3] < 0.1);
    }
    for (int i = 0; i < 6; i++)
        kiln_picture_destroy(&pictures[i]);
}

/* A scene with very many particles in one place. Its pixels have so many fragments that GL sorts a
 * pixel's list in several merge passes, and blends a long list in several spans, since llvmpipe
 * ends an invocation's loops that run too long. With 40000 puffs, raster=cpu has more fragments
 * than its memory holds (KILN_PACKET_PIXELS), and draws rows several times. */
static const char PILE[] =
    "kiln: 1\n"
    "output: {size: [96, 64], fps: 60, frames: 60}\n"
    "camera: {position: [0, 1, 4], target: [0, 1, 0]}\n"
    "backdrop: {floor: none}\n"
    "systems:\n"
    "  puffs:\n"
    "    emit: {rate: 0, bursts: {0 s: 3000}, life: 9 s, speed: [0, 0.3],\n"
    "           from: {point: {origin: [0, 1, 0]}}}\n"
    "    look: {atlas: 'builtin:puff', size: 0.2 m, opacity: 0.002, fade: {in: 0, out: 0}}\n"
    "  flames:\n"
    "    emit: {rate: 0, bursts: {0 s: 700}, life: 9 s, speed: [0, 0.3],\n"
    "           from: {point: {origin: [0, 1, 0]}}}\n"
    "    look: {atlas: 'builtin:puff', blend: add, size: 0.5 m, color: [0.1, 0.05, 0.02],\n"
    "           opacity: 0.02, fade: {in: 0, out: 0}, thickness: 0}\n";

static void lists_of_any_length_are_sorted(void **state)
{
    static const char *const counts[] = {"systems.puffs.emit.bursts={0 s: 300}",
                                         "systems.puffs.emit.bursts={0 s: 3000}",
                                         "systems.puffs.emit.bursts={0 s: 40000}"};
    static const char *const faint[] = {"systems.puffs.look.opacity=0.02",
                                        "systems.puffs.look.opacity=0.002",
                                        "systems.puffs.look.opacity=0.0002"};
    for (int i = 0; i < 3; i++) {
        const struct frame_setting cpu = {{OIT, counts[i], faint[i]}, 3, FRAME_CPU, 0};
        const struct frame_setting gl = {{OIT, counts[i], faint[i]}, 3, FRAME_GL, 0};
        struct kiln_picture *expected = frame_draw(*state, PILE, STEPS, &cpu);
        struct kiln_picture *found = frame_draw(*state, PILE, STEPS, &gl);
        for (int layer = FRAME_FIRE; layer < FRAME_LAYERS; layer++) {
            double off = frame_difference(expected, found, layer);
            print_message("%s, layer %d: %.2g\n", counts[i], layer, off);
            assert_true(off < 5e-3);
        }
        kiln_picture_destroy(&expected);
        kiln_picture_destroy(&found);
    }
}

static void assert_same_layer(const struct kiln_picture *a, const struct kiln_picture *b, int layer,
                              int from)
{
    const size_t channels = a->layers[layer].channels, row = WIDTH * channels;
    for (size_t y = 0; y < HEIGHT; y++) {
        const size_t at = y * row + (size_t)from * channels;
        assert_memory_equal(a->layers[layer].pixels + at, b->layers[layer].pixels + at,
                            (size_t)(WIDTH - from) * channels * sizeof(float));
    }
}

static void assert_same_pixels(const struct kiln_picture *a, const struct kiln_picture *b)
{
    for (int layer = 0; layer < FRAME_LAYERS; layer++)
        assert_same_layer(a, b, layer, 0);
}

/* A device that allows only small storage blocks draws the same picture in parts. If a block is too
 * small for the list of a single pixel, or for the table of all pixels' lists (8 bytes a pixel), an
 * error says what to do. */
static void small_storage_blocks_are_respected(void **state)
{
    static const char *const more = "systems.puffs.emit.bursts={0 s: 2000}";
    struct kiln_device *device = *state;
    const int64_t before = device->info.max_storage_block_bytes, least = WIDTH * HEIGHT * 8;
    const struct frame_setting setting = {{OIT}, 1, FRAME_GL, 0},
                               full = {{OIT, more}, 2, FRAME_GL, 0};
    struct kiln_error places = {0}, lists = {0}, none = {0};
    struct kiln_picture *whole = frame_draw(device, CROWD, STEPS, &setting);
    device->info.max_storage_block_bytes = least;
    struct kiln_picture *parts = frame_try(device, CROWD, STEPS, &setting, &none);
    struct kiln_picture *too_many = frame_try(device, CROWD, STEPS, &full, &lists);
    device->info.max_storage_block_bytes = least - 1;
    struct kiln_picture *too_large = frame_try(device, CROWD, STEPS, &setting, &places);
    device->info.max_storage_block_bytes = before;
    assert_string_equal(none.message, "");
    assert_same_pixels(whole, parts);
    assert_true(!too_many && !too_large);
    char end[256]; /* what follows the number of fragments, which differs between devices */
    snprintf(end, sizeof end,
             " fragments; a storage block of %s takes at most 1536: use raster=cpu, or fewer "
             "particles in one place",
             device->info.name);
    expect_error_around(&lists, KILN_DEVICE_FAILED, end, "post.compose: oit: a pixel has ");
    expect_error(&places, KILN_DEVICE_FAILED,
                 "post.compose: oit of 96 x 64 pixels needs a storage block of 49152 bytes; %s "
                 "allows 49151: use raster=cpu, or a smaller picture",
                 device->info.name);
    kiln_picture_destroy(&whole);
    kiln_picture_destroy(&parts);
}

/* If a driver counts fewer fragments than it writes, the surplus fragments are dropped and do not
 * overwrite the lists of other pixels. To imitate such a driver, a changed shader counts no
 * fragments in the left half of the picture. */
static void lists_do_not_outgrow_their_counts(void **state)
{
    static const char counts[] = "if (!writes) {";
    const struct frame_setting setting = {{OIT}, 1, FRAME_GL, 0};
    struct kiln_picture *whole = frame_draw(*state, CROWD, STEPS, &setting);
    char folder[32], path[128];
    test_make_folder(folder);
    char *text = test_read_file(KILN_SOURCE_DIR "/shaders/draw/sprites/particles_list.frag");
    char *place = strstr(text, counts);
    assert_non_null(place);
    struct kiln_text changed = {0};
    kiln_text_add(&changed, "%.*s%s if (gl_FragCoord.x < 48.0) return; %s", (int)(place - text),
                  text, counts, place + strlen(counts));
    snprintf(path, sizeof path, "%s/draw/sprites/particles_list.frag", folder);
    test_write_file(path, changed.data);
    setenv("KILN_SHADER_DIR", folder, 1);
    struct kiln_picture *half = frame_draw(*state, CROWD, STEPS, &setting);
    unsetenv("KILN_SHADER_DIR");
    assert_same_layer(whole, half, FRAME_SMOKE, WIDTH / 2);
    for (int y = 0; y < HEIGHT; y++)
        assert_true(half->layers[FRAME_SMOKE].pixels[4 * (size_t)y * WIDTH + 3] == 0.0f);
    kiln_picture_destroy(&whole);
    kiln_picture_destroy(&half);
    kiln_text_free(&changed);
    free(text);
    test_remove_folder(folder);
}

static void the_number_of_threads_changes_nothing(void **state)
{
    const struct frame_setting one = {{OIT}, 1, FRAME_CPU, 1}, three = {{OIT}, 1, FRAME_CPU, 3};
    struct kiln_picture *a = frame_draw(*state, CROWD, STEPS, &one);
    struct kiln_picture *b = frame_draw(*state, CROWD, STEPS, &three);
    assert_same_pixels(a, b);
    kiln_picture_destroy(&a);
    kiln_picture_destroy(&b);
}

/* Particles outside the picture change no pixel. raster=cpu makes sprites in batches of
 * SORTED_AT_A_TIME, and selects from each batch the sprites that touch the tiles being drawn; 1.1
 * million unseen particles add batches. */
static void unseen_pieces_change_nothing(void **state)
{
    static const char *const many = "systems.unseen.emit.bursts={0 s: 1100000}";
    const struct frame_setting few = {{OIT}, 1, FRAME_CPU, 0},
                               more = {{OIT, many}, 2, FRAME_CPU, 0};
    struct kiln_picture *a = frame_draw(*state, CROWD, STEPS, &few);
    struct kiln_picture *b = frame_draw(*state, CROWD, STEPS, &more);
    assert_same_pixels(a, b);
    kiln_picture_destroy(&a);
    kiln_picture_destroy(&b);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest full[] = {
        test_on_device(lists_of_any_length_are_sorted),
    };
    static const struct CMUnitTest tests[] = {
        test_on_device(crossing_billboards_are_sorted_by_pixel),
        test_on_device(a_puff_half_covers_a_flame_within),
        test_on_device(techniques_agree),
        test_on_device(small_storage_blocks_are_respected),
        test_on_device(lists_do_not_outgrow_their_counts),
        test_on_device(the_number_of_threads_changes_nothing),
        test_on_device(unseen_pieces_change_nothing),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, tests, sizeof tests / sizeof *tests);
    test_list_add_full(&list, full, sizeof full / sizeof *full);
    return test_list_run(&list, "oit", argc, argv, test_device_open, test_device_close);
}
