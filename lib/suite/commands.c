/* Makes the commands that run a test again and approve its pictures. A person can type them in the
 * folder from which the run was started. The program of --against is left out: it does not change
 * the verdict, and a result must not name a program to run. result_command.c knows every word that
 * this file writes, and refuses others. */
#include <string.h>

#include "base/text.h"
#include "suite/test_case.h"

static void add_argument(struct kiln_text *text, const char *argument)
{
    kiln_text_add(text, *argument == '-' ? " ./" : " "); /* so that no path is an option */
    kiln_text_add_shell_word(text, argument);
}

static void add_option(struct kiln_text *text, const char *option, const char *value)
{
    kiln_text_add(text, " %s", option);
    add_argument(text, value);
}

/* Adds options for the run's folders that are not the default ones. The folder GOLDEN is
 * test->golden, which is GOLDEN/NAME, without the name. */
static void add_folders(const struct kiln_test_case *test_case, struct kiln_text *text)
{
    const struct kiln_test *test = test_case->test;
    size_t length = strlen(test->golden), name = strlen(test->name);
    const char *folder = NULL;
    if (length > name + 1)
        folder = kiln_arena_text(test_case->arena, test->golden, length - name - 1);
    const char *results = test_case->suite->results_folder;
    if (results && strcmp(results, kiln_suite_defaults().results) != 0)
        add_option(text, "--results", results);
    if (folder && strcmp(folder, kiln_suite_defaults().golden) != 0)
        add_option(text, "--golden", folder);
}

/* Adds the arguments that select the test: its file and, for one of several devices, its full name.
 */
static void add_selection(const struct kiln_test_case *test_case, struct kiln_text *text)
{
    const struct kiln_test *test = test_case->test;
    if (strcmp(test->name, test->full_name) != 0)
        add_option(text, "--filter", test->full_name);
    add_argument(text, test->path);
}

static const char *finish_command(struct kiln_test_case *test_case, struct kiln_text *text)
{
    test_case->no_memory = test_case->no_memory || text->failed;
    const char *command = text->failed ? "" : kiln_test_case_text(test_case, "%s", text->data);
    kiln_text_free(text);
    return command;
}

const char *kiln_test_case_rerun_command(struct kiln_test_case *test_case)
{
    const struct kiln_test_params *params = test_case->params;
    struct kiln_text text = {0};
    kiln_text_add(&text, "kiln test");
    add_folders(test_case, &text);
    if (params->device && !test_case->test->device)
        add_option(&text, "--device", params->device);
    for (size_t i = 0; i < params->technique_count; i++)
        add_option(&text, "--technique", params->techniques[i]);
    if (params->repeat > 1)
        kiln_text_add(&text, " --repeat %u", params->repeat);
    kiln_text_add(&text, "%s%s", params->ignore_hashes ? " --ignore-hashes" : "",
                  params->strict ? " --strict" : "");
    add_selection(test_case, &text);
    return finish_command(test_case, &text);
}

const char *kiln_test_case_approve_command(struct kiln_test_case *test_case)
{
    struct kiln_text text = {0};
    kiln_text_add(&text, "kiln test approve");
    add_folders(test_case, &text);
    const struct kiln_test *test = test_case->test;
    const bool by_name = test_case->suite->is_found_by_name;
    if (by_name || strcmp(test->name, test->full_name) != 0)
        add_argument(&text, test->full_name);
    if (!by_name)
        add_argument(&text, test->path);
    return finish_command(test_case, &text);
}
