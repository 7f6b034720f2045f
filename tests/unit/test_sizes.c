/* The most particles of a scene, stepped and drawn on the host. If it failed, particles in slots
 * beyond 2^24 would be lost, or drawn with the numbers of others. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/frame.h"
#include "support/parts.h"

enum { LAST = 4096, WIDTH = 64, HEIGHT = 36 };

/* The first system has most particles and lies on the left. The second one has the last slots; it
 * lies on the right, and its particles have other colours and places the one than the other. */
static const char dust[] =
    "kiln: 1\n"
    "output: {size: [%d, %d], fps: 60, frames: 3}\n"
    "camera: {position: [0, 0, 10], target: [0, 0, 0], fov: 40 deg}\n"
    "backdrop: {floor: none, sun: {color: 0}}\n"
    "systems:\n"
    "  most: {emit: {bursts: {0 s: %d}, life: 100 s, speed: 1,\n"
    "         from: {box: {origin: [-3, 0, 0], size: [2, 2, 2]}}},\n"
    "         look: {blend: %s, size: 2 cm}}\n"
    "  last: {emit: {bursts: {0 s: %d}, life: 100 s, speed: 1, from: {box: {origin: [3, 0, 0],\n"
    "         size: [2, 2, 2], angle: 180 deg}}},\n"
    "         look: {blend: %s, size: 8 cm, scale: [0.2, 2]}}\n";

static struct kiln_picture *draw(const char *blend, int most)
{
    const struct frame_setting setting = {.techniques = FRAME_CPU};
    char text[1024];
    snprintf(text, sizeof text, dust, WIDTH, HEIGHT, most, blend, LAST, blend);
    return frame_draw(NULL, text, 2, &setting);
}

/* The last system looks the same behind few slots and behind the most. */
static void check_blend(const char *blend)
{
    const int most = test_is_full() ? KILN_MAX_PARTICLES - LAST : 1 << 17;
    struct kiln_picture *few = draw(blend, 8), *many = draw(blend, most);
    const uint32_t channels = few->layers[FRAME_BEAUTY].channels;
    const float *a = few->layers[FRAME_BEAUTY].pixels, *b = many->layers[FRAME_BEAUTY].pixels;
    double left_off = 0, right_off = 0, right = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT * channels; i++) {
        const bool is_right = i / channels % WIDTH >= WIDTH / 2;
        *(is_right ? &right_off : &left_off) += fabs((double)a[i] - (double)b[i]);
        right += is_right ? fabs((double)b[i]) : 0.0;
    }
    assert_true(left_off > 0.1);      /* most particles are drawn, too */
    if (!(right_off <= 1e-6 * right)) /* sums of alpha are rounded in pieces of sprites */
        fail_msg("%s: off by %g of %g", blend, right_off, right);
    kiln_picture_destroy(&few);
    kiln_picture_destroy(&many);
}

static void the_last_slots_are_drawn_in_order(void **state)
{
    (void)state;
    check_blend("alpha");
}

static void the_last_slots_are_added(void **state)
{
    (void)state;
    check_blend("add");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_slots_are_drawn_in_order),
        cmocka_unit_test(the_last_slots_are_added),
    };
    return cmocka_run_group_tests_name("sizes", tests, NULL, NULL);
}
