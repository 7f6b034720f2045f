/* Checks the frames, limits and outputs of all jobs of a file. Frames and limits are read by the
 * parsers of --frames and --limits. A job would report the same mistakes when its turn comes, but
 * that may be hours later. */
#include "batch_check.h"

#include <stdlib.h>
#include <string.h>

#include "frames.h"
#include "jobs.h"

static bool out_of_memory(struct kiln_error *error)
{
    *error = (struct kiln_error){.code = KILN_DEVICE_FAILED,
                                 .message = "out of memory for checking jobs"};
    return false;
}

static bool check_frames(const struct kiln_batch *batch, size_t index, struct kiln_error *error)
{
    const struct kiln_batch_text *frames = &kiln_batch_job(batch, index)->frames;
    struct frame_spec spec;
    struct frame_piece_place wrong;
    if (!frames->text)
        return true;
    if (frame_spec_parse(frames->text, &spec, &wrong)) {
        frame_spec_free(&spec);
        return true;
    }
    if (wrong.no_memory)
        return out_of_memory(error);
    return kiln_batch_refuse(batch, index, frames, "frames", error, "found '%.*s', expected %s",
                             (int)wrong.length, frames->text + wrong.start, FRAMES_EXPECTED);
}

static bool check_limits(const struct kiln_batch *batch, size_t index, struct kiln_error *error)
{
    const struct kiln_batch_text *text = &kiln_batch_job(batch, index)->limits;
    struct kiln_limits limits = kiln_limits_empty();
    if (!text->text || kiln_limits_parse(&limits, text->text, error))
        return true;
    const struct kiln_error reason = *error;
    return reason.code == KILN_USAGE &&
           kiln_batch_refuse(batch, index, text, "limits", error, "%s", reason.message);
}

/* Returns whether the names of an output's files contain the numbers of frames. */
static bool has_frame_numbers(const char *name, const char *frames)
{
    const char *slash = strrchr(name, '/');
    return kiln_output_is_images(name) &&
           (strpbrk(slash ? slash : name, "#%") || !frames || frames[strspn(frames, "0123456789")]);
}

/* Claims a file for a job, and refuses the job if another one has claimed it. Jobs may write to the
 * same pattern of numbered images, unless they have the same text of frames. */
static bool claim(const struct kiln_batch *batch, size_t index, const struct kiln_batch_text *file,
                  const char *key, const char *suffix, struct kiln_claims *claims,
                  struct kiln_error *error)
{
    const struct kiln_batch_job *job = kiln_batch_job(batch, index);
    const char *frames = job->frames.text;
    char *name = job_file_name(file->text, job->scene, suffix, file == &job->output),
         *claim_name = NULL;
    const bool numbers = name && file == &job->output && has_frame_numbers(name, frames);
    if (!name ||
        (numbers && asprintf(&claim_name, "%s of %s%s", name, frames ? "frames " : "all frames",
                             frames ? frames : "") < 0)) {
        free(name);
        return out_of_memory(error);
    }
    bool ok = kiln_claims_write(claims, claim_name ? claim_name : name, job->name, error);
    const struct kiln_error reason = *error;
    if (!ok && reason.code == KILN_USAGE)
        ok = kiln_batch_refuse(batch, index, file, key, error, "%s", reason.message);
    free(name);
    free(claim_name);
    return ok;
}

static bool claim_files(const struct kiln_batch *batch, size_t index, const char *suffix,
                        struct kiln_claims *claims, struct kiln_error *error)
{
    const struct kiln_batch_job *job = kiln_batch_job(batch, index);
    if (strcmp(job->output.text, "-") == 0)
        return kiln_batch_refuse(batch, index, &job->output, "output", error,
                                 "a job cannot write to standard output; name a file");
    return (strcmp(job->output.text, "none") == 0 ||
            claim(batch, index, &job->output, "output", suffix, claims, error)) &&
           (!job->manifest.text ||
            claim(batch, index, &job->manifest, "manifest", ".json", claims, error));
}

bool batch_check(const struct kiln_batch *batch, const char *suffix, struct kiln_error *error)
{
    struct kiln_claims *claims = kiln_claims_create();
    bool ok = claims || out_of_memory(error);
    for (size_t i = 0; ok && i < kiln_batch_count(batch); i++)
        ok = check_frames(batch, i, error) && check_limits(batch, i, error) &&
             claim_files(batch, i, suffix, claims, error);
    kiln_claims_destroy(&claims);
    return ok;
}
