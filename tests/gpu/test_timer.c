/* Checks kiln_timer (lib/gpu/timer.h), which measures how long each pass of a frame takes: the
 * times of a pass that runs twice are added, work on the host is measured, and GL work is charged
 * to the pass that submits it. If this fails, benchmarks charge time to the wrong pass. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "gpu/timer.h"
#include "support/cmocka.h"
#include "support/device.h"

static void sleep_ms(long ms)
{
    const struct timespec time = {.tv_nsec = ms * 1000000};
    nanosleep(&time, NULL);
}

static void run_pass(struct kiln_timer *timer, enum kiln_pass pass, long ms)
{
    kiln_timer_begin(timer, pass);
    sleep_ms(ms);
    kiln_timer_end(timer);
}

static void check_host_passes(struct kiln_timer *timer)
{
    double ms[KILN_PASS_COUNT];
    const double start = kiln_clock_seconds();
    run_pass(timer, KILN_PASS_simulate, 20);
    run_pass(timer, KILN_PASS_sort, 5);
    run_pass(timer, KILN_PASS_simulate, 20);
    kiln_timer_collect(timer, ms);
    const double elapsed_ms = (kiln_clock_seconds() - start) * 1e3;
    assert_true(ms[KILN_PASS_simulate] >= 38);
    assert_true(ms[KILN_PASS_sort] >= 4);
    double sum = 0;
    for (size_t i = 0; i < KILN_PASS_COUNT; i++)
        sum += ms[i];
    assert_true(sum <= elapsed_ms + 1);
    assert_true(ms[KILN_PASS_bloom] == 0);

    /* After kiln_timer_collect, the times of the next frame start at 0. */
    kiln_timer_collect(timer, ms);
    for (size_t i = 0; i < KILN_PASS_COUNT; i++)
        assert_true(ms[i] == 0);
}

static void host_passes_add_up(void **state)
{
    (void)state;
    struct kiln_timer *timer = kiln_timer_create(NULL);
    assert_non_null(timer);
    check_host_passes(timer);
    kiln_timer_destroy(&timer);
    assert_null(timer);
    kiln_timer_destroy(&timer);
}

static void host_passes_count_on_a_device(void **state)
{
    struct kiln_timer *timer = kiln_timer_create(*state);
    assert_non_null(timer);
    check_host_passes(timer);
    kiln_timer_destroy(&timer);
}

/* Work on the host is measured also if the timer uses GL timestamp queries, as on a GPU. The test
 * makes the timer use them even if the device is software GL. */
static void host_passes_count_beside_queries(void **state)
{
    struct kiln_device *device = *state;
    const bool software = device->info.software;
    device->info.software = false;
    struct kiln_timer *timer = kiln_timer_create(device);
    device->info.software = software;
    assert_non_null(timer);
    check_host_passes(timer);
    check_host_passes(timer);
    kiln_timer_destroy(&timer);
}

/* GL work is charged to the pass that submits it, and not to the later pass that waits for its
 * result. Eight clears of a large image are quick to submit and slow to do; the second pass reads a
 * texel of the image and so waits for them. */
static void gl_work_is_charged_to_its_pass(void **state)
{
    GLuint texture = 0, framebuffer = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, 2048, 2048);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0);
    glFinish();

    struct kiln_timer *timer = kiln_timer_create(*state);
    double ms[KILN_PASS_COUNT];
    const double start = kiln_clock_seconds();
    kiln_timer_begin(timer, KILN_PASS_bloom);
    for (int i = 0; i < 8; i++) {
        const float color[4] = {(float)i, 0, 0, 1};
        glClearBufferfv(GL_COLOR, 0, color);
    }
    kiln_timer_end(timer);
    kiln_timer_begin(timer, KILN_PASS_readback);
    float texel[4];
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, texel);
    kiln_timer_end(timer);
    kiln_timer_collect(timer, ms);
    const double elapsed_ms = (kiln_clock_seconds() - start) * 1e3;
    assert_true(texel[0] == 7);
    assert_true(ms[KILN_PASS_bloom] > 0);
    assert_true(ms[KILN_PASS_bloom] + ms[KILN_PASS_readback] <= elapsed_ms + 1);
    /* On software GL the timer waits for the clears at the end of their pass, so that reading a
     * texel is quick. */
    assert_true(ms[KILN_PASS_bloom] > ms[KILN_PASS_readback] ||
                !kiln_device_get_info(*state)->software);
    kiln_timer_destroy(&timer);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
}

static void passes_have_their_names(void **state)
{
    (void)state;
    assert_string_equal(kiln_pass_name(KILN_PASS_simulate), "simulate");
    assert_string_equal(kiln_pass_name(KILN_PASS_output), "output");
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(host_passes_add_up),
        test_on_device(host_passes_count_on_a_device),
        test_on_device(host_passes_count_beside_queries),
        test_on_device(gl_work_is_charged_to_its_pass),
        cmocka_unit_test(passes_have_their_names),
    };
    return cmocka_run_group_tests_name("timer", tests, test_device_open, test_device_close);
}
