/* lib/job/plan: estimates of tasks. If this test fails, a plan gives a task less than no time. */
#include <string.h>

#include "kiln.h"
#include "kiln_job.h"
#include "support/cmocka.h"

enum { TASKS = 4 };

static void note(void *user, const struct kiln_plan *plan, const struct kiln_plan_task *task)
{
    double *seconds = user;
    (void)plan;
    assert_in_range(task->index, 0, TASKS - 1);
    seconds[task->index] = task->cpu_s;
}

/* The particles are large when they are born, and tiny when few of them are left, so the frame that
 * is measured as the lightest one takes much less than its number of particles tells. */
static void no_task_takes_less_than_no_time(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\noutput: {size: [64, 36], fps: 30, frames: 240}\n"
        "camera: {position: [0, 1, 4], target: [0, 1, 0]}\n"
        "systems:\n"
        "  a:\n"
        "    emit: {bursts: {0: 20000}, life: [0.2 s, 3 s], from: {box: {size: [1, 1, 1]}}}\n"
        "    look: {blend: add, size: {life: {0: 3, 0.5: 0.001, 1: 0}}}\n";
    double seconds[TASKS] = {0};
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_parse(text, strlen(text), "test.yaml", NULL, &error);
    assert_string_equal(error.message, "");
    struct kiln_device_params cpu = kiln_device_defaults();
    cpu.wanted = KILN_DEVICE_CPU;
    struct kiln_device *device = kiln_device_open(&cpu, &error);
    assert_non_null(device);
    struct kiln_plan plan = kiln_plan_empty();
    struct kiln_plan_params params = kiln_plan_defaults();
    params.tasks = TASKS;
    params.task = note;
    params.user = seconds;
    assert_true(kiln_plan_tasks(device, scene, &params, &plan, &error));
    for (int i = 0; i < TASKS; i++)
        assert_true(seconds[i] > 0.0);
    kiln_device_close(&device);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_task_takes_less_than_no_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
