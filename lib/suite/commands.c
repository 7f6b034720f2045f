/* Makes the commands that run a test again and approve its pictures. A person can type them in the
 * folder from which the run was started. */
#include <string.h>

#include "base/text.h"
#include "suite/trial.h"

static void add_word(struct kiln_text *text, const char *word)
{
    kiln_text_add(text, *word == '-' ? " ./" : " "); /* so that no path is an option */
    kiln_text_add_shell_word(text, word);
}

static void add_option(struct kiln_text *text, const char *option, const char *value)
{
    kiln_text_add(text, " %s", option);
    add_word(text, value);
}

/* Adds options for the run's folders that are not the default ones. The folder GOLDEN is
 * test->golden, which is GOLDEN/NAME, without the name. */
static void add_folders(const struct kiln_trial *trial, struct kiln_text *text, bool golden)
{
    const struct kiln_test *test = trial->test;
    size_t length = strlen(test->golden), name = strlen(test->name);
    const char *folder = NULL;
    if (length > name + 1)
        folder = kiln_arena_text(trial->arena, test->golden, length - name - 1);
    if (golden && folder && strcmp(folder, kiln_suite_defaults().golden) != 0)
        add_option(text, "--golden", folder);
    const char *results = trial->suite->results_folder;
    if (results && strcmp(results, kiln_suite_defaults().results) != 0)
        add_option(text, "--results", results);
}

/* Adds the arguments that select the test: its file and, for one of several devices, its full name.
 */
static void add_selection(const struct kiln_trial *trial, struct kiln_text *text)
{
    const struct kiln_test *test = trial->test;
    if (strcmp(test->name, test->full_name) != 0)
        add_option(text, "--filter", test->full_name);
    add_word(text, test->path);
}

static const char *take(struct kiln_trial *trial, struct kiln_text *text)
{
    trial->no_memory = trial->no_memory || text->failed;
    const char *command = text->failed ? "" : kiln_trial_text(trial, "%s", text->data);
    kiln_text_free(text);
    return command;
}

const char *kiln_trial_rerun_command(struct kiln_trial *trial)
{
    const struct kiln_test_params *params = trial->params;
    struct kiln_text text = {0};
    kiln_text_add(&text, "kiln test");
    add_folders(trial, &text, true);
    if (params->device && !trial->test->device)
        add_option(&text, "--device", params->device);
    for (size_t i = 0; i < params->technique_count; i++)
        add_option(&text, "--technique", params->techniques[i]);
    if (params->repeat > 1)
        kiln_text_add(&text, " --repeat %u", params->repeat);
    kiln_text_add(&text, "%s%s", params->ignore_hashes ? " --ignore-hashes" : "",
                  params->strict ? " --strict" : "");
    if (params->against)
        add_option(&text, "--against", params->against);
    add_selection(trial, &text);
    return take(trial, &text);
}

const char *kiln_trial_approve_command(struct kiln_trial *trial)
{
    struct kiln_text text = {0};
    kiln_text_add(&text, "kiln test approve");
    add_folders(trial, &text, false);
    add_word(&text, trial->test->full_name);
    return take(trial, &text);
}
