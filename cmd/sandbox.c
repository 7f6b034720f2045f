/* Confines the process of a command to the files that its arguments name. The `access` of an
 * option's row and of a command says whether the command reads or writes the file that stands
 * there; so an option that names a file needs its `access`, or the sandbox refuses the file.
 *
 * The main function calls sandbox_enter before it runs a command that has --sandbox. That must come
 * before the first thread starts and before any file of the arguments is read, and after the file
 * of events is opened, which may lie elsewhere. */
#include "sandbox.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "report.h"
#include "scene_in.h"

enum mode { MODE_ON, MODE_REQUIRE, MODE_OFF };

struct allowed_paths {
    const char **readable, **writable;
    size_t readable_count, writable_count;
    char **folders; /* the names in `readable` that must be freed: folders of files */
    size_t folder_count;
};

/* ---- what the arguments name ----------------------------------------------------------------- */

/* Makes a file that an operand names readable. Pictures that a scene uses lie in the scene's
 * folder, so normally the whole folder becomes readable. With `root`, the folder of --asset-root,
 * only the file does. A file in the root is readable with it and gets no right of its own, since
 * the path might lead elsewhere by now. A symbolic link elsewhere is left out: whoever made it
 * could lead it to any file. */
static bool add_file(struct allowed_paths *allowed, const char *path, const char *root)
{
    struct stat status;
    if (root) {
        if (!kiln_scene_is_below(path, root) &&
            (lstat(path, &status) != 0 || !S_ISLNK(status.st_mode)))
            allowed->readable[allowed->readable_count++] = path;
        return true;
    }
    char *folder = malloc(strlen(path) + 2);
    if (!folder)
        return false;
    strcpy(folder, path);
    folder[strcspn(folder, "{#%")] = '\0'; /* the folder of numbered frames */
    char *slash = strrchr(folder, '/');
    strcpy(slash ? slash : folder, slash ? "/" : ".");
    allowed->folders[allowed->folder_count++] = folder;
    allowed->readable[allowed->readable_count++] = folder;
    return true;
}

/* Returns whether the value of an option that names a file to write means no file: "-" is standard
 * output, and "none" is no output. */
static bool is_no_file(const char *path)
{
    return strcmp(path, "-") == 0 || strcmp(path, "none") == 0;
}

/* Collects the files of all arguments. Returns false when memory is short. */
static bool collect(struct allowed_paths *allowed, const struct command *command,
                    const struct arguments *arguments)
{
    const size_t count = arguments->use_count + arguments->operand_count + 1;
    const char *root = arguments_text(arguments, "asset-root", NULL);
    allowed->readable = calloc(2 * count, sizeof *allowed->readable);
    allowed->writable = calloc(count, sizeof *allowed->writable);
    allowed->folders = calloc(count, sizeof *allowed->folders);
    if (!allowed->readable || !allowed->writable || !allowed->folders)
        return false;
    for (size_t i = 0; i < arguments->use_count; i++) {
        const struct option_use *use = &arguments->uses[i];
        if (!use->text)
            continue;
        if (use->option->access == ACCESS_READ)
            allowed->readable[allowed->readable_count++] = use->text;
        else if (use->option->access == ACCESS_WRITE && !is_no_file(use->text))
            allowed->writable[allowed->writable_count++] = use->text;
    }
    for (size_t i = 0; i < arguments->operand_count; i++) {
        const char *path = arguments->operands[i];
        const bool stream = scene_in_is_stream(path);
        if (command->access == ACCESS_WRITE)
            allowed->writable[allowed->writable_count++] = path;
        else if (!(stream && root) && !add_file(allowed, stream ? "-" : path, root))
            return false;
    }
    return true;
}

static void free_allowed_paths(struct allowed_paths *allowed)
{
    for (size_t i = 0; i < allowed->folder_count; i++)
        free(allowed->folders[i]);
    free(allowed->folders);
    free(allowed->readable);
    free(allowed->writable);
}

/* ---- entering -------------------------------------------------------------------------------- */

/* Reads the mode that KILN_SANDBOX sets; --sandbox may replace it. Returns false if it is none. */
static bool read_environment(enum mode *mode)
{
    static const char *const modes[] = {"on", "require", "off"};
    const char *text = kiln_environment("KILN_SANDBOX");
    *mode = MODE_OFF;
    if (!text)
        return true;
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
        if (strcmp(text, modes[i]) == 0) {
            *mode = (enum mode)i;
            return true;
        }
    }
    return false;
}

static int confine(const struct command *command, const struct arguments *arguments, enum mode mode)
{
    struct allowed_paths allowed = {NULL, NULL, 0, 0, NULL, 0};
    struct kiln_error error = {0};
    int code = 0;
    if (!collect(&allowed, command, arguments)) {
        code = report_no_memory();
    } else {
        const struct kiln_sandbox_params params = {.size = sizeof params,
                                                   .readable = allowed.readable,
                                                   .readable_count = allowed.readable_count,
                                                   .writable = allowed.writable,
                                                   .writable_count = allowed.writable_count,
                                                   .required = mode == MODE_REQUIRE};
        code = kiln_sandbox_enter(&params, &error) ? 0 : report_error(&error);
    }
    free_allowed_paths(&allowed);
    return code;
}

/* ---- descriptors of others ------------------------------------------------------------------- */

/* Finds the least descriptor from `first` on that a text names, as in "ndjson:fd=3" or
 * "/dev/fd/63". Returns `least` if it names none below that. */
static unsigned least_named(const char *text, unsigned first, unsigned least)
{
    for (const char *at = text; at && (at = strstr(at, "fd"));) {
        at += 2;
        if (*at != '=' && *at != '/')
            continue;
        const unsigned long number = strtoul(at + 1, NULL, 10);
        if (number >= first && number < least)
            least = (unsigned)number;
    }
    return least;
}

static void close_from_to(unsigned first, unsigned last)
{
    if (close_range(first, last, 0) == 0)
        return;
    const long most = sysconf(_SC_OPEN_MAX); /* the kernel or a container has no close_range */
    for (unsigned file = first; file <= last && file < (unsigned long)most; file++)
        close((int)file);
}

void sandbox_close_inherited(const struct arguments *arguments)
{
    enum mode mode;
    if (!read_environment(&mode) || arguments_choice(arguments, "sandbox", mode) == MODE_OFF)
        return;
    for (unsigned first = STDERR_FILENO + 1, next; first < INT_MAX; first = next + 1) {
        next = INT_MAX;
        for (size_t i = 0; i < arguments->use_count; i++)
            next = least_named(arguments->uses[i].text, first, next);
        for (size_t i = 0; i < arguments->operand_count; i++)
            next = least_named(arguments->operands[i], first, next);
        if (next > first)
            close_from_to(first, next - 1);
    }
}

/* ---- the whole ------------------------------------------------------------------------------- */

int sandbox_enter(const struct command *command, const struct arguments *arguments, bool *sandboxed)
{
    const char *device = arguments_text(arguments, "device", KILN_DEVICE_CPU);
    enum mode mode;
    if (!read_environment(&mode))
        return report(KILN_USAGE, "KILN_SANDBOX: found '%s'; allowed are on, require or off",
                      kiln_environment("KILN_SANDBOX"));
    mode = (enum mode)arguments_choice(arguments, "sandbox", mode);
    if (mode == MODE_OFF)
        return 0;
    if (strcmp(device, KILN_DEVICE_CPU) != 0)
        return report(KILN_USAGE,
                      "%s: --device %s: not allowed with a sandbox; a sandbox is for the device "
                      "'" KILN_DEVICE_CPU
                      "', because drivers of OpenGL need more rights than a job does",
                      command->name, device);
    *sandboxed = true;
    return confine(command, arguments, mode);
}
