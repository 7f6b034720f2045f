/* Runs kiln devices, which lists the devices that can render on this machine and says what is
 * missing. */
#include <inttypes.h>
#include <stdio.h>

#include "command.h"
#include "event.h"
#include "json_output.h"
#include "report.h"

enum { MAX_DEVICES = 64 };

static const struct option options[] = {
    JSON_OPTION("one object."),
    {.name = "force", .kind = OPTION_FLAG, .help = "Replace a file of --json that exists."},
    EVENTS_OPTION,
    HELP_OPTION,
};

static const char *yes_or_no(bool value)
{
    return value ? "yes" : "no";
}

static const char *kind_of(const struct kiln_device_info *info)
{
    return !info->gl ? "no OpenGL" : info->software ? "software" : "gpu";
}

static void print_text(const struct kiln_device_info *info)
{
    printf("%u: %s\n", info->index, info->name);
    printf("    kind      %s\n", kind_of(info));
    printf("    usable    %s\n", yes_or_no(info->usable));
    if (info->problem[0])
        printf("    problem   %s\n", info->problem);
    printf("    exact     %s\n", yes_or_no(info->exact));
    if (!info->gl) {
        printf("    vectors   %s\n", info->vectors);
        printf("    threads   %u\n", info->threads);
        return;
    }
    printf("    vendor    %s\n", info->vendor);
    printf("    OpenGL    %s\n", info->gl_version);
    printf("    platform  %s\n", info->platform);
    printf("    limits    %d invocations a work group, %d bytes shared, %" PRId64
           " bytes a storage block,\n"
           "              textures %d wide, %d layers\n",
           info->max_work_group_invocations, info->max_shared_memory_bytes,
           info->max_storage_block_bytes, info->max_texture_size, info->max_array_layers);
}

/* Prints which parts of --sandbox the kernel supports. */
static void print_sandbox(void)
{
    struct kiln_sandbox_support has = kiln_sandbox_support_empty();
    kiln_sandbox_get_support(&has);
    char landlock[32] = "no Landlock";
    if (has.landlock > 0)
        snprintf(landlock, sizeof landlock, "Landlock %d", has.landlock);
    printf("sandbox: %s, %s%s\n", landlock, has.seccomp ? "seccomp" : "no seccomp",
           has.off ? " (off in this build, which has sanitizers)" : "");
}

static void add_sandbox(struct kiln_json *json)
{
    struct kiln_sandbox_support has = kiln_sandbox_support_empty();
    kiln_sandbox_get_support(&has);
    kiln_json_begin_object(json, "sandbox");
    kiln_json_int(json, "landlock", has.landlock);
    kiln_json_bool(json, "seccomp", has.seccomp);
    kiln_json_end(json);
}

static void add_device(struct kiln_json *json, const struct kiln_device_info *info)
{
    kiln_json_begin_object(json, NULL);
    kiln_json_uint(json, "index", info->index);
    kiln_json_string(json, "name", info->name);
    kiln_json_string(json, "vendor", info->vendor);
    kiln_json_string(json, "gl_version", info->gl_version);
    kiln_json_string(json, "platform", info->platform);
    kiln_json_bool(json, "gl", info->gl);
    kiln_json_bool(json, "software", info->software);
    kiln_json_bool(json, "usable", info->usable);
    kiln_json_string(json, "problem", info->problem);
    kiln_json_bool(json, "exact", info->exact);
    if (info->gl) {
        kiln_json_int(json, "max_work_group_invocations", info->max_work_group_invocations);
        kiln_json_int(json, "max_shared_memory_bytes", info->max_shared_memory_bytes);
        kiln_json_int(json, "max_storage_block_bytes", info->max_storage_block_bytes);
        kiln_json_int(json, "max_texture_size", info->max_texture_size);
        kiln_json_int(json, "max_array_layers", info->max_array_layers);
    } else {
        kiln_json_string(json, "vectors", info->vectors);
        kiln_json_uint(json, "threads", info->threads);
    }
    kiln_json_end(json);
}

static void print_json(FILE *out, const struct kiln_device_info *infos, size_t count,
                       const char *advice)
{
    struct kiln_json json;
    if (!json_output_begin(&json, out))
        return;
    kiln_json_begin_array(&json, "devices");
    kiln_json_indent_items(&json, 4);
    for (size_t i = 0; i < count; i++)
        add_device(&json, &infos[i]);
    kiln_json_end_indented(&json, 2);
    add_sandbox(&json);
    kiln_json_string(&json, "advice", advice);
    json_output_end(&json);
}

static int run(const struct arguments *arguments)
{
    struct kiln_device_info infos[MAX_DEVICES];
    char advice[256] = "";
    for (size_t i = 0; i < MAX_DEVICES; i++)
        infos[i] = kiln_device_info_empty();
    size_t count = kiln_device_list(infos, sizeof *infos, MAX_DEVICES, advice);
    if (count > MAX_DEVICES)
        count = MAX_DEVICES;
    FILE *out;
    const int code = json_output_open("devices", arguments, &out);
    if (code)
        return code;
    print_json(out, infos, count, advice);
    if (out == stdout)
        return 0;
    for (size_t i = 0; i < count; i++)
        print_text(&infos[i]);
    print_sandbox();
    if (advice[0])
        printf("advice: %s\n", advice);
    return 0;
}

const struct command devices_command = {
    .name = "devices",
    .summary = "list what can render on this machine, and what is missing",
    .operands = "",
    .description =
        "Lists this machine without OpenGL, called '" KILN_DEVICE_CPU
        "', and every device that OpenGL offers without a display. Without OpenGL, every stage "
        "runs in threads and vectors, with the same pixels on every machine. Each OpenGL device is "
        "listed with its limits. It is usable with OpenGL 4.3 or later. It is exact when it passed "
        "the probe of the arithmetic that the simulation needs; with a device that is not exact, "
        "particles move on the CPU. A software device is a rasteriser on the CPU. The last entry "
        "is what the kernel has for --sandbox. Advice names what is missing and the package that "
        "brings it.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = 0,
    .run = run,
};
