/* kiln devices: what can render here, and what is missing. */
#include <inttypes.h>

#include "command.h"
#include "report.h"

enum { MAX_DEVICES = 64 };

static const struct option options[] = {
    {.name = "json", .kind = OPTION_FLAG, .help = "Print JSON instead of text."},
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

static void print_json_text(const char *key, const char *value)
{
    printf("\"%s\": ", key);
    kiln_write_json_string(stdout, value);
    fputs(", ", stdout);
}

static void print_json_bool(const char *key, bool value)
{
    printf("\"%s\": %s, ", key, value ? "true" : "false");
}

static void print_json(const struct kiln_device_info *info)
{
    printf("    {\"index\": %u, ", info->index);
    print_json_text("name", info->name);
    print_json_text("vendor", info->vendor);
    print_json_text("gl_version", info->gl_version);
    print_json_text("platform", info->platform);
    print_json_bool("gl", info->gl);
    print_json_bool("software", info->software);
    print_json_bool("usable", info->usable);
    print_json_text("problem", info->problem);
    print_json_bool("exact", info->exact);
    if (!info->gl) {
        print_json_text("vectors", info->vectors);
        printf("\"threads\": %u}", info->threads);
        return;
    }
    printf("\"max_work_group_invocations\": %d, \"max_shared_memory_bytes\": %d, "
           "\"max_storage_block_bytes\": %" PRId64 ", \"max_texture_size\": %d, "
           "\"max_array_layers\": %d}",
           info->max_work_group_invocations, info->max_shared_memory_bytes,
           info->max_storage_block_bytes, info->max_texture_size, info->max_array_layers);
}

static int run(const struct arguments *arguments)
{
    bool json = arguments_last(arguments, "json") != NULL;
    struct kiln_device_info infos[MAX_DEVICES];
    char advice[256] = "";
    size_t count = kiln_device_list(infos, MAX_DEVICES, advice);
    if (count > MAX_DEVICES)
        count = MAX_DEVICES;

    if (json)
        printf("{\n  \"devices\": [");
    for (size_t i = 0; i < count; i++) {
        if (json) {
            printf(i ? ",\n" : "\n");
            print_json(&infos[i]);
        } else {
            print_text(&infos[i]);
        }
    }
    if (json) {
        printf("%s],\n  \"advice\": ", count ? "\n  " : "");
        kiln_write_json_string(stdout, advice);
        printf("\n}\n");
    } else if (advice[0]) {
        printf("advice: %s\n", advice);
    }
    return 0;
}

const struct command devices_command = {
    .name = "devices",
    .summary = "list what can render on this machine, and what is missing",
    .operands = "",
    .description =
        "Lists this machine without OpenGL, called '" KILN_DEVICE_CPU
        "', on which every stage runs "
        "in threads and vectors, with the same pixels on every machine; then every device that "
        "OpenGL offers without a display, with its limits. Such a device is "
        "usable with OpenGL 4.3 or later; it is exact when it passed the probe of the arithmetic "
        "that the simulation needs, and otherwise particles move on the CPU. A software device is "
        "a rasteriser on the CPU. Advice names what is missing and the package that brings it.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .most_operands = 0,
    .run = run,
};
