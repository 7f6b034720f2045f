/* Draws a frame with another build of kiln, so that a report can show how the frame looked when it
 * was accepted. That needs a renderer whose pixels are the same everywhere, so a note says if the
 * hash of the drawn pixels is not the accepted one. */
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

/* The arguments of a command, which lie in the trial's arena. */
struct words {
    struct kiln_trial *trial;
    const char **items;
    size_t count, capacity;
};

static void add(struct words *words, const char *word)
{
    if (words->count + 1 < words->capacity)
        words->items[words->count++] = word;
}

static void add_option(struct words *words, const char *option, const char *value)
{
    add(words, option);
    add(words, value);
}

/* Adds the techniques of the result, "simulate=cpu sort=cpu", as options. */
static void add_techniques(struct words *words)
{
    const char *rest = words->trial->result->techniques;
    while (*rest) {
        const size_t length = strcspn(rest, " ");
        const char *word = kiln_arena_text(words->trial->arena, rest, length);
        if (length > 0 && word)
            add_option(words, "--technique", word);
        rest += length + (rest[length] == ' ');
    }
}

/* Returns the command that renders the test's scene, with its overrides, into a picture; NULL when
 * memory is short. */
static const char **command_of(struct kiln_trial *trial, uint32_t frame, const char *picture)
{
    const struct kiln_test *test = trial->test;
    const bool cpu = strcmp(trial->result->device_name, "cpu") == 0;
    struct words words = {.trial = trial, .capacity = 64 + 2 * test->override_count};
    words.items = kiln_arena_alloc(trial->arena, words.capacity, sizeof *words.items);
    if (!words.items)
        return NULL;
    add(&words, trial->params->against);
    add_option(&words, "render", test->scene);
    for (size_t i = 0; i < test->override_count; i++)
        add_option(&words, "--set", test->overrides[i]);
    add_option(&words, "--frames", kiln_trial_text(trial, "%u", frame));
    add_option(&words, "--device", cpu ? "cpu" : trial->result->device);
    add_option(&words, "--threads", kiln_trial_text(trial, "%u", trial->result->threads));
    if (test->format == KILN_TEST_PNG16)
        add_option(&words, "--png-bits", "16");
    add_techniques(&words);
    add_option(&words, "--output", picture);
    add(&words, "--force");
    add(&words, "--quiet");
    return words.items;
}

/* Runs a command, whose output goes to the file `log`. Returns its exit code, 128 plus the number
 * of the signal that ended it, or a value below 0, with errno, if it cannot be run. */
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
static const char *last_line(struct kiln_trial *trial, const char *log)
{
    enum { MOST = 1 << 20 };
    struct kiln_error ignored = {0};
    size_t size = 0;
    char *text = kiln_text_file_read(log, "a log", MOST, &size, &ignored);
    if (!text)
        return "";
    while (size > 0 && (text[size - 1] == '\n' || text[size - 1] == ' '))
        text[--size] = '\0';
    const char *newline = strrchr(text, '\n');
    const char *line = kiln_trial_text(trial, "%.400s", newline ? newline + 1 : text);
    free(text);
    return line;
}

bool kiln_trial_draw_against(struct kiln_trial *trial, struct kiln_result_frame *frame,
                             const char *picture, struct kiln_error *error)
{
    const char *program = trial->params->against;
    char log[KILN_PATH_SIZE], hash[65];
    struct kiln_error problem = {0};
    bool drawn = false;
    if (!kiln_trial_path(trial, "against.txt", log, error))
        return false;
    const char **command = command_of(trial, frame->number, picture);
    if (!command)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", trial->test->path);
    const int code = run(command, log), failure = errno;
    const char *line = last_line(trial, log);
    unlink(log);
    if (code < 0) {
        kiln_error_set_errno(&problem, KILN_USAGE, failure, "%s cannot be run", program);
        kiln_trial_note(trial, "%s", problem.message);
    } else if (code != 0) {
        kiln_trial_note(trial, "%s does not draw frame %u, exit code %d%s%s", program,
                        frame->number, code, *line ? ": " : "", line);
    } else {
        drawn = kiln_pixel_hash(picture, hash, &problem);
        if (!drawn)
            kiln_trial_note(trial, "%s does not draw frame %u: %s", program, frame->number,
                            problem.message);
    }
    if (!drawn) {
        unlink(picture);
        return true;
    }
    if (*frame->pixels_expected && strcmp(hash, frame->pixels_expected) != 0)
        kiln_trial_note(trial,
                        "%s draws frame %u with other pixels than were accepted%s%s: its version "
                        "differs, or the scene has changed",
                        program, frame->number, *frame->kiln_expected ? " of kiln " : "",
                        frame->kiln_expected);
    return true;
}
