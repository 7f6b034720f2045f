/* Finds the tests that the operands and options of a command select. */
#include "test_select.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "report.h"

bool operand_is_path(const char *operand)
{
    size_t length = strlen(operand);
    return access(operand, F_OK) == 0 ||
           (length > 5 && strcmp(operand + length - 5, ".yaml") == 0) ||
           (length > 4 && strcmp(operand + length - 4, ".yml") == 0) ||
           (length > 0 && operand[length - 1] == '/');
}

/* Suggests a command for a misspelled second word: `kiln test aprove x`. */
static void suggest_command(const char *command, const char *word)
{
    const char *names[MAX_COMMANDS];
    size_t count = 0, length = strlen(command);
    for (size_t i = 0; commands[i]; i++) {
        if (command_is_under(commands[i], command))
            names[count++] = commands[i]->name + length + 1;
    }
    const char *nearest = kiln_text_nearest(word, names, count);
    if (nearest && !operand_is_path(word))
        report(KILN_USAGE, "%s: '%s' is no command either (did you mean 'kiln %s %s'?)", command,
               word, command, nearest);
}

static int report_none(const char *command, const struct arguments *arguments,
                       const struct kiln_suite_params *params)
{
    if (params->shards > 1)
        return report(KILN_USAGE, "%s: --shard: part %u of %u has no tests; take fewer parts",
                      command, params->shard, params->shards);
    return report(KILN_USAGE,
                  "%s: no tests found in '%s'; a test is a file *.test.yaml, or a scene (YAML with "
                  "the key 'kiln')",
                  command, arguments->operand_count == 0 ? "." : params->paths[0]);
}

int select_tests(struct kiln_suite **suite, const struct arguments *arguments, const char *command)
{
    *suite = NULL;
    struct value_list filters;
    const char **paths = calloc(arguments->operand_count + 1, sizeof *paths);
    const char **names = calloc(arguments->operand_count + arguments->use_count + 1, sizeof *names);
    bool ok = value_list_create(&filters, arguments, "filter") && paths && names;
    int code = ok ? 0 : report_no_memory();
    if (ok) {
        struct kiln_suite_params params = kiln_suite_defaults();
        params.paths = paths;
        params.names = names;
        for (size_t i = 0; i < arguments->operand_count; i++) {
            if (operand_is_path(arguments->operands[i]))
                paths[params.path_count++] = arguments->operands[i];
            else
                names[params.name_count++] = arguments->operands[i];
        }
        for (size_t i = 0; i < filters.count; i++)
            names[params.name_count++] = filters.items[i];
        if (params.path_count == 0)
            paths[params.path_count++] = ".";
        params.golden = arguments_text(arguments, "golden", params.golden);
        params.results = arguments_text(arguments, "results", DEFAULT_RESULTS);
        params.asset_root = arguments_text(arguments, "asset-root", NULL);
        const struct option_use *shard = arguments_last(arguments, "shard");
        params.shard = shard ? (uint32_t)shard->integer[0] : 0;
        params.shards = shard ? (uint32_t)shard->integer[1] : 0;
        struct kiln_error error = {0};
        *suite = kiln_suite_load(&params, &error);
        if (!*suite) {
            code = report_error(&error);
            if (error.code == KILN_USAGE && arguments->operand_count > 0)
                suggest_command(command, arguments->operands[0]);
        } else if (kiln_suite_count(*suite) == 0) {
            code = report_none(command, arguments, &params);
        }
    }
    value_list_free(&filters);
    free(paths);
    free(names);
    return code;
}
