/* Opens the device that a command's options choose. */
#include "device.h"

#include "report.h"

struct kiln_device *open_device(const struct arguments *arguments,
                                const struct value_list *techniques, int *code)
{
    struct kiln_error error = {0};
    struct kiln_device_params params = kiln_device_defaults();
    params.wanted =
        arguments_text(arguments, "device", arguments->sandboxed ? KILN_DEVICE_CPU : NULL);
    params.gl = kiln_techniques_need_gl(techniques->items, techniques->count);
    params.log = report_log();
    struct kiln_device *device = kiln_device_open(&params, &error);
    if (!device)
        *code = report_error(&error);
    return device;
}
