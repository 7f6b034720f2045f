/* Holds the main function: it picks the subcommand, reads its options and runs it. */
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "build.h"
#include "command.h"
#include "event.h"
#include "json_output.h"
#include "limits.h"
#include "report.h"
#include "sandbox.h"
#include "signals.h"

const struct command *const commands[] = {&render_command,
                                          &bake_command,
                                          &export_command,
                                          &plan_command,
                                          &join_command,
                                          &encode_command,
                                          &compare_command,
                                          &test_command,
                                          &test_approve_command,
                                          &test_calibrate_command,
                                          &test_report_command,
                                          &test_list_command,
                                          &figure_command,
                                          &figure_sheet_command,
                                          &figure_triptych_command,
                                          &figure_strip_command,
                                          &bench_command,
                                          &new_command,
                                          &check_command,
                                          &params_command,
                                          &devices_command,
                                          &help_command,
                                          NULL};

size_t command_names(const char *names[MAX_COMMANDS])
{
    size_t count = 0;
    for (; commands[count] && count < MAX_COMMANDS; count++)
        names[count] = commands[count]->name;
    return count;
}

/* Returns whether `name` is "FIRST SECOND". */
static bool is_name(const char *name, const char *first, const char *second)
{
    size_t length = strlen(first);
    return strncmp(name, first, length) == 0 && name[length] == ' ' &&
           strcmp(name + length + 1, second) == 0;
}

const struct command *command_find(const char *first, const char *second)
{
    const struct command *found =
        strcmp(first, complete_command.name) == 0 ? &complete_command : NULL;
    for (size_t i = 0; commands[i]; i++) {
        if (second && is_name(commands[i]->name, first, second))
            return commands[i];
        if (strcmp(commands[i]->name, first) == 0)
            found = commands[i];
    }
    return found;
}

bool command_is_under(const struct command *command, const char *group)
{
    size_t length = strlen(group);
    return strncmp(command->name, group, length) == 0 && command->name[length] == ' ';
}

/* Opens /dev/null for each standard stream that is closed. Otherwise the next file that is opened
 * would get its descriptor, and messages would end up in a picture. /dev/null is opened for the
 * wrong direction, so that using the stream fails as it does when it is closed. */
static void occupy_standard_streams(void)
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++) {
        if (fcntl(stream, F_GETFD) < 0)
            open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
}

/* Makes a job of --batch end with the process that started it, even if that process is killed. */
static void end_with_parent(void)
{
    const char *parent = kiln_environment("KILN_BATCH_PROCESS");
    uint64_t process;
    if (!parent || !kiln_text_to_uint64(parent, &process) || process != (uint64_t)getppid())
        return;
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (process != (uint64_t)getppid()) /* the parent has died already */
        raise(SIGTERM);
}

/* Bytes that the main thread's stack gets at the start, and that its limit must allow it with the
 * arguments and the environment, which it holds. Rendering, which needs the most of it, takes less
 * than 200 KiB. */
enum { STACK_SIZE = 1 << 19, STACK_LIMIT = 1 << 20 };

/* Writes to the end of STACK_SIZE bytes. The system keeps a stack as large as it ever was. */
__attribute__((noinline)) static void extend_stack(void)
{
    volatile char stack[STACK_SIZE];
    stack[0] = 0;
    (void)stack[0];
}

/* Takes the memory of the stack while its lack can be told. Later, a stack that cannot grow would
 * end the program with SIGSEGV. */
static int reserve_stack(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < STACK_LIMIT)
        return report(KILN_DEVICE_FAILED,
                      "the stack may have %ju KiB (ulimit -s); needed are %d KiB",
                      (uintmax_t)limit.rlim_cur >> 10, STACK_LIMIT >> 10);
    void *room = mmap(NULL, STACK_SIZE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (room == MAP_FAILED)
        return report(KILN_DEVICE_FAILED, "out of memory for a stack of %d KiB", STACK_SIZE >> 10);
    munmap(room, STACK_SIZE);
    extend_stack();
    return 0;
}

static int check_operands(const struct command *command, const struct arguments *arguments)
{
    if (arguments->operand_count < command->least_operands)
        return report(KILN_USAGE, "%s: needs %s", command->name, command->operands);
    if (arguments->operand_count > command->most_operands)
        return report(KILN_USAGE, "%s: one operand too many, '%s'", command->name,
                      arguments->operands[command->most_operands]);
    return 0;
}

/* Checks the environment of a command that does work; commands that only explain need no check. */
static int check_environment(const struct command *command)
{
    struct kiln_error error = {0};
    if (command == &help_command || command == &complete_command || kiln_environment_check(&error))
        return 0;
    return report(error.code, "%s", error.message);
}

/* Returns whether a command has an option of this name. */
static bool has_option(const struct command *command, const char *name)
{
    for (size_t i = 0; i < command->option_count; i++) {
        if (strcmp(command->options[i].name, name) == 0)
            return true;
    }
    return false;
}

static int run_command(const struct command *command, int argc, char **argv)
{
    struct arguments arguments;
    int code = arguments_parse(&arguments, command->options, command->option_count, command->name,
                               argc, argv);
    if (code == 0 && arguments_last(&arguments, "help")) {
        help_print_command(command);
    } else if (code == 0) {
        code = check_operands(command, &arguments);
        if (code == 0)
            code = check_environment(command);
        struct limits limits = {.budget = NULL};
        /* A batch passes --sandbox and --limits on to its jobs. It has none itself, since a sandbox
         * would keep it from starting them. */
        const bool is_batch = arguments_last(&arguments, "batch") != NULL;
        const bool has_sandbox = !is_batch && has_option(command, "sandbox");
        if (code == 0 && has_sandbox)
            sandbox_close_inherited(&arguments);
        if (code == 0) /* before the sandbox, which might forbid the file of events */
            code = events_open(command, &arguments);
        if (code == 0 && has_sandbox) /* before any thread starts */
            code = sandbox_enter(command, &arguments, &arguments.sandboxed);
        if (code == 0 && !is_batch && has_option(command, "limits"))
            code = limits_begin(&limits, command->name, &arguments);
        arguments.budget = limits.budget;
        if (code == 0)
            code = command->run(&arguments);
        limits_end(&limits);
        code = events_close(json_output_close(code));
    }
    arguments_free(&arguments);
    return code;
}

static int unknown_command(const char *name)
{
    if (kiln_is_scene_name(name))
        return report(KILN_USAGE, "a command is missing: 'kiln render %s' renders a scene", name);
    const char *names[MAX_COMMANDS + 2];
    size_t count = command_names(names);
    names[count++] = "--version";
    names[count++] = "--help";
    char suggestion[SUGGESTION_SIZE];
    return report(KILN_USAGE, "unknown %s '%s'%s; 'kiln help' lists the commands",
                  name[0] == '-' ? "option" : "command", name,
                  suggest(suggestion, "", name, names, count));
}

int main(int argc, char **argv)
{
    occupy_standard_streams();
    end_with_parent();
    signal(SIGCHLD, SIG_DFL); /* if it were ignored, the exit status of kiln-decode would be lost */
    signal(SIGPIPE, SIG_IGN); /* a failed write is reported instead */
    signal(SIGXFSZ, SIG_IGN); /* a write beyond the limit of a file's size, too */
    signals_install_abort();
    if (reserve_stack() != 0)
        return KILN_DEVICE_FAILED;
    const char *name = argc > 1 ? argv[1] : "";
    if (argc < 2) {
        help_print_overview(stderr);
        return KILN_USAGE;
    }
    if (strcmp(name, "--version") == 0) {
        printf("kiln %s\n", build_name());
        return report_finish(0);
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
        help_print_overview(stdout);
        return report_finish(0);
    }
    const struct command *command = command_find(name, argc > 2 ? argv[2] : NULL);
    if (!command)
        return unknown_command(name);
    int words = strchr(command->name, ' ') ? 2 : 1;
    return report_finish(run_command(command, argc - 1 - words, argv + 1 + words));
}
