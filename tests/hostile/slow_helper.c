/* lib/asset/loader/helper.c: a kiln-decode that is taken over cannot make kiln wait for longer than
 * the limit of a request, however it spreads its answer, and its processor time counts for the job
 * while it runs. The decoder is compromised.c, and the limit is short, so that the test is.
 *
 *     slow_helper FOLDER [SECONDS]
 *
 * FOLDER has the program; SECONDS is the limit instead. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "asset/loader/loader.h"
#include "base/clock.h"

static int failed;

/* Asks the decoder to misbehave in a way, and checks that kiln ends the wait in time. */
static void expect_end(const char *how, double most_s)
{
    static char bytes[256 * 256 * 4];
    struct kiln_error error = {0};
    char said[KILN_MESSAGE_SIZE];
    struct kiln_decode_answer answer;
    struct kiln_decode_request request = {.format = KILN_PICTURE_PNG};
    setenv("KILN_COMPROMISED", how, 1);
    struct kiln_helper *helper = kiln_helper_start(KILN_DECODE_PNG, UINT64_MAX, NULL, &error);
    if (!helper) {
        printf("%s: %s\n", how, error.message);
        failed = 1;
        return;
    }
    snprintf(said, sizeof said, "decoding took longer than %g s", most_s);
    kiln_helper_limit_time(helper, most_s);
    kiln_helper_begin(helper);
    const double start_s = kiln_clock_seconds();
    bool ok = kiln_helper_send(helper, &request, sizeof request, -1, &error);
    const unsigned expected = 1u << KILN_DECODE_PIXELS | 1u << KILN_DECODE_NEEDS_FILE;
    while (ok && kiln_clock_seconds() - start_s < 3 * most_s + 10) {
        const struct kiln_decode_file file = {.is_open = 0};
        ok = kiln_helper_answer(helper, NULL, expected, &answer, &error) &&
             (answer.what == KILN_DECODE_NEEDS_FILE
                  ? kiln_helper_send(helper, &file, sizeof file, -1, &error)
                  : kiln_helper_receive(helper, NULL, bytes, sizeof bytes, &error));
    }
    const double took_s = kiln_clock_seconds() - start_s;
    const bool right = !ok && error.code == KILN_INVALID_INPUT && took_s >= most_s &&
                       strcmp(error.message, said) == 0 && kiln_helper_is_broken(helper);
    printf("%s: %.2f s, %s\n", how, took_s, ok ? "no end" : error.message);
    failed |= !right || took_s > most_s + 2;
    kiln_helper_end(&helper);
}

/* Lets the decoder work without an answer, in a job whose limit of processor time is far below that
 * of the decoder. */
static void expect_end_of_job(void)
{
    struct kiln_error error = {0};
    struct kiln_decode_answer answer;
    struct kiln_decode_request request = {.format = KILN_PICTURE_PNG};
    struct kiln_limits limits = kiln_limits_empty();
    limits.most[KILN_LIMIT_cpu] = 300;
    setenv("KILN_COMPROMISED", "busy", 1);
    struct kiln_budget *budget = kiln_budget_create(&limits);
    const struct kiln_loader_params params = {.budget = budget};
    struct kiln_loader *loader = kiln_loader_create(&params);
    struct kiln_helper *helper = kiln_loader_take(loader, KILN_DECODE_PNG, &error);
    const double start_s = kiln_clock_seconds();
    if (helper) {
        kiln_helper_limit_time(helper, 10.0);
        kiln_helper_send(helper, &request, sizeof request, -1, &error);
        kiln_helper_answer(helper, kiln_loader_caller(loader), 1u << KILN_DECODE_PIXELS, &answer,
                           &error);
    }
    const double took_s = kiln_clock_seconds() - start_s;
    printf("busy: %.2f s, %s\n", took_s, error.message);
    failed |= error.code != KILN_OVER_LIMIT || took_s > 5.0;
    kiln_helper_end(&helper);
    kiln_loader_destroy(&loader);
    kiln_budget_destroy(&budget);
}

int main(int argc, char **argv)
{
    const double most_s = argc > 2 ? strtod(argv[2], NULL) : 0.5;
    if (argc < 2 || setenv("KILN_LIBEXEC_DIR", argv[1], 1) != 0)
        return 2;
    expect_end("drip", most_s);
    expect_end("wants-slowly", most_s);
    expect_end("silent", most_s);
    expect_end_of_job();
    return failed;
}
