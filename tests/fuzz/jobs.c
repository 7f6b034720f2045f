/* Fuzzes the reader of batch files, which list the jobs of `kiln render --batch` as YAML or as
 * lines of JSON. From any bytes it must read at least one job, whose values are in the ranges of
 * their keys, or report an error with a message. If this fails, a wrong batch file crashes kiln or
 * starts a job with values that no check has seen. */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "kiln_program.h"

static void check_job(const struct kiln_batch_job *job)
{
    require(*job->name && *job->scene && *job->output.text, "a text is missing");
    require(job->output.line > 0 && job->output.column > 0, "an output without a place");
    require(!job->frames.text || *job->frames.text, "frames are an empty text");
    require(job->timeout_s >= 0 && job->timeout_s <= 1e7, "a timeout is out of its range");
    for (size_t i = 0; i < job->override_count; i++)
        require(strchr(job->overrides[i], '='), "an override without a value");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    fuzz_taken = false;
    for (int format = KILN_BATCH_YAML; format <= KILN_BATCH_LINES; format++) {
        struct kiln_error error = kiln_error_empty();
        struct kiln_batch *batch =
            kiln_batch_parse(text, size, "x/jobs", (enum kiln_batch_format)format, &error);
        require(batch || (error.code != KILN_OK && *error.message), "an error without a text");
        require(!batch || kiln_batch_count(batch) > 0, "a file without a job");
        for (size_t i = 0; batch && i < kiln_batch_count(batch); i++)
            check_job(kiln_batch_job(batch, i));
        fuzz_taken = fuzz_taken || batch;
        kiln_batch_destroy(&batch);
    }
    free(text);
    return 0;
}
