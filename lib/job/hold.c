/* Checks the scene and the device of a job, whichever kind of job it is. */
#include "job/hold.h"

#include "base/error.h"
#include "scene/scene.h"

bool kiln_hold_take(const struct kiln_device *device, const struct kiln_scene *scene,
                    struct kiln_error *error)
{
    if (!device || !scene)
        return kiln_error_set(error, KILN_USAGE, "found NULL, expected a %s",
                              device ? "scene" : "device");
    if (!kiln_hold_check(device, scene, error))
        return false;
    if (!pthread_equal(device->thread, pthread_self()))
        return kiln_error_set(error, KILN_USAGE,
                              "the device belongs to another thread: open one in each");
    kiln_handle_begin_job(&device->handle);
    kiln_handle_begin_job(&scene->handle);
    return true;
}

bool kiln_hold_check(const struct kiln_device *device, const struct kiln_scene *scene,
                     struct kiln_error *error)
{
    return kiln_handle_check(&device->handle, KILN_HANDLE_DEVICE, error) &&
           kiln_handle_check(&scene->handle, KILN_HANDLE_SCENE, error);
}

void kiln_hold_release(const struct kiln_device *device, const struct kiln_scene *scene)
{
    kiln_handle_end_job(&device->handle);
    kiln_handle_end_job(&scene->handle);
}
