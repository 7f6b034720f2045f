/* Draws a frame with another kiln program, which `kiln test --against PROGRAM` names, so that a
 * report can show how the frame looked when it was accepted. lib/suite/judge.c asks for it when the
 * pixels of the frame have changed. The picture shows the accepted frame only if the program draws
 * the accepted pixels on this machine. Otherwise a note says that their hashes differ.
 *
 * The program may be an older kiln. If it refuses an option, a note says so, and the test goes
 * on. */
#include "suite/against.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "suite/golden.h"

/* The arguments of a command, which lie in the test case's arena. */
struct arguments {
    struct kiln_test_case *test_case;
    const char **items;
    size_t count, capacity;
};

/* Adds an argument. command_of makes room for all of them and for the NULL after the last, which is
 * there already, since an arena gives zeroed memory. */
static void add(struct arguments *arguments, const char *argument)
{
    if (arguments->count + 1 < arguments->capacity)
        arguments->items[arguments->count++] = argument;
}

static void add_option(struct arguments *arguments, const char *option, const char *value)
{
    add(arguments, option);
    add(arguments, value);
}

/* Adds an option for each technique of the result, which has them in one text such as
 * "simulate=cpu sort=cpu". */
static void add_techniques(struct arguments *arguments)
{
    const char *rest = arguments->test_case->result->techniques;
    while (*rest) {
        const size_t length = strcspn(rest, " ");
        const char *technique = kiln_arena_text(arguments->test_case->arena, rest, length);
        if (length > 0 && technique)
            add_option(arguments, "--technique", technique);
        rest += length + (rest[length] == ' ');
    }
}

/* Returns the command that renders the test's scene, with its overrides, into a picture; NULL when
 * memory is short. */
static const char **command_of(struct kiln_test_case *test_case, uint32_t frame,
                               const char *picture)
{
    const struct kiln_test *test = test_case->test;
    const bool cpu = strcmp(test_case->result->device_name, "cpu") == 0;
    struct arguments arguments = {.test_case = test_case,
                                  .capacity = 64 + 2 * test->override_count};
    arguments.items =
        kiln_arena_alloc(test_case->arena, arguments.capacity, sizeof *arguments.items);
    if (!arguments.items)
        return NULL;
    add(&arguments, test_case->params->against);
    add(&arguments, "render");
    add(&arguments, test->scene);
    for (size_t i = 0; i < test->override_count; i++)
        add_option(&arguments, "--set", test->overrides[i]);
    add_option(&arguments, "--frames", kiln_test_case_text(test_case, "%u", frame));
    add_option(&arguments, "--device", cpu ? "cpu" : test_case->result->device);
    add_option(&arguments, "--threads",
               kiln_test_case_text(test_case, "%u", test_case->result->threads));
    if (test->format == KILN_TEST_PNG16)
        add_option(&arguments, "--png-bits", "16");
    add_techniques(&arguments);
    add_option(&arguments, "--output", picture);
    add(&arguments, "--force");
    add(&arguments, "--quiet");
    return arguments.items;
}

/* Runs a command, whose output goes to the file `log`. Returns its exit code, 128 plus the number
 * of the signal that ended it. If it cannot be run, sets errno and returns a value below 0. */
static int run(const char **command, const char *log)
{
    posix_spawn_file_actions_t actions;
    pid_t process;
    int status = 0, failure = posix_spawn_file_actions_init(&actions);
    if (!failure) {
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log, O_WRONLY | O_CREAT | O_TRUNC,
                                         0644);
        posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
        /* The cast is safe: posix_spawnp does not change the arguments. */
        failure =
            posix_spawnp(&process, command[0], &actions, NULL, (char *const *)command, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    errno = failure;
    if (failure)
        return -1;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR)
        continue;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/* Returns the last line of a log, or "". */
static const char *last_line(struct kiln_test_case *test_case, const char *log)
{
    enum { MAX_LOG_SIZE = 1 << 20 };
    struct kiln_error ignored = {0};
    size_t size = 0;
    char *text = kiln_text_file_read(log, "a log", MAX_LOG_SIZE, &size, &ignored);
    if (!text)
        return "";
    while (size > 0 && (text[size - 1] == '\n' || text[size - 1] == ' '))
        text[--size] = '\0';
    const char *newline = strrchr(text, '\n');
    const char *line = kiln_test_case_text(test_case, "%.400s", newline ? newline + 1 : text);
    free(text);
    return line;
}

bool kiln_test_case_draw_against(struct kiln_test_case *test_case, struct kiln_result_frame *frame,
                                 const char *picture, struct kiln_error *error)
{
    const char *program = test_case->params->against;
    char log[KILN_PATH_SIZE], hash[65];
    const bool known = *frame->kiln_expected != '\0';
    struct kiln_error problem = {0};
    bool drawn = false;
    if (!kiln_test_case_path(test_case, "against.txt", log, error))
        return false;
    const char **command = command_of(test_case, frame->number, picture);
    if (!command)
        return kiln_error_no_memory(error, "%s", test_case->test->path);
    const int code = run(command, log), failure = errno;
    const char *line = last_line(test_case, log);
    unlink(log);
    if (code < 0) {
        kiln_error_set_errno(&problem, KILN_USAGE, failure, "%s cannot be run", program);
        kiln_test_case_note(test_case, "%s", problem.message);
    } else if (code != 0) {
        kiln_test_case_note(test_case, "%s failed to draw frame %u, exit code %d%s%s", program,
                            frame->number, code, *line ? ": " : "", line);
    } else {
        drawn = kiln_pixel_hash(picture, hash, &problem);
        if (!drawn)
            kiln_test_case_note(test_case, "%s failed to draw frame %u: %s", program, frame->number,
                                problem.message);
    }
    if (!drawn) {
        unlink(picture);
        return true;
    }
    if (*frame->pixels_expected && strcmp(hash, frame->pixels_expected) != 0)
        kiln_test_case_note(
            test_case,
            "%s draws frame %u with other pixels than the accepted ones%s%s%s: the program, the "
            "scene or the driver differs",
            program, frame->number, known ? ", which kiln " : "", frame->kiln_expected,
            known ? " drew" : "");
    return true;
}
