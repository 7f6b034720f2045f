/* compare REFERENCE TEST [LIMIT...]: tests whether two pictures look the same. Limits are those of
 * `kiln compare`, such as flip.mean=0.02. The exit code is 1 when the pictures look different. */
#include <kiln.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: compare REFERENCE TEST [LIMIT...]\n");
        return KILN_USAGE;
    }
    struct kiln_compare_params params = kiln_compare_defaults();
    params.reference = argv[1];
    params.test = argv[2];
    params.limits = (const char *const *)argv + 3;
    params.limit_count = (size_t)argc - 3;

    struct kiln_error error = kiln_error_empty();
    struct kiln_compare_result result = kiln_compare_result_empty();
    if (!kiln_compare(&params, &result, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return (int)error.code;
    }
    for (size_t i = 0; i < result.column_count; i++) {
        const struct kiln_compare_column *column = &result.columns[i];
        if (column->limited)
            printf("%s %.4g, the limit is %.4g\n", column->name, result.worst[i], column->limit);
    }
    printf("%s\n", result.same ? "they look the same" : "they look different");
    return result.same ? 0 : KILN_FRAME_FAILED;
}
