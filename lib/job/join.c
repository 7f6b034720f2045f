/* Joins what shards drew into the whole output: a clip of parts, or a sequence of images with its
 * manifest. All that this takes stands in the shards' journals. */
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/sized.h"
#include "base/text.h"
#include "job/manifest.h"
#include "job/resume.h"
#include "job/stop.h"
#include "output/formats.h"
#include "output/part.h"

struct join {
    const struct kiln_join_params *params;
    struct kiln_stop stop;
    struct kiln_arena *arena;
    struct kiln_journal_head head;
    struct kiln_records records;
    struct kiln_resume resume;
    time_t started;
};

static bool take_finished(void *user, const struct kiln_finished_file *finished,
                          struct kiln_error *error)
{
    struct join *join = user;
    return kiln_resume_take(&join->resume, finished, error);
}

/* Says what is missing: parts of a clip, or frames. */
static bool refuse_missing(const struct join *join, struct kiln_error *error)
{
    enum { MOST = 8 };
    const struct kiln_resume *resume = &join->resume;
    const bool one_file = resume->output.format->one_file;
    struct kiln_text text = {0};
    uint32_t count = 0;
    if (one_file) {
        for (uint32_t part = 0; part < kiln_parts_count(&resume->output); part++) {
            const struct kiln_frame_range range = kiln_part_range(&resume->output, part);
            if (!kiln_records_of(&join->records, range.first)->whole && count++ < MOST)
                kiln_text_add(&text, "%s part %u (frames %u-%u)", count > 1 ? "," : "", part + 1,
                              range.first, range.last);
        }
    } else {
        for (size_t i = 0; i < resume->missing_count; i++) {
            const struct kiln_frame_range *range = &resume->missing[i];
            if (count++ >= MOST)
                continue;
            kiln_text_add(&text, "%s %u", count > 1 ? "," : " frames", range->first);
            if (range->last > range->first)
                kiln_text_add(&text, "-%u", range->last);
        }
    }
    kiln_error_set(error, KILN_IO, "%s: parts are missing or damaged:%s%s", join->params->output,
                   text.data ? text.data : "", count > MOST ? "..." : "");
    kiln_text_free(&text);
    return false;
}

static bool write_manifest(const struct join *join, const struct kiln_render_stats *stats,
                           struct kiln_error *error)
{
    const struct kiln_join_params *params = join->params;
    if (!params->manifest)
        return true;
    const struct kiln_attempt run = {.command = params->command,
                                     .command_count = params->command_count,
                                     .build = params->build,
                                     .techniques = "",
                                     .started = join->started};
    struct kiln_manifest *manifest =
        kiln_manifest_open(&(struct kiln_manifest_params){.path = params->manifest,
                                                          .overwrite = params->overwrite,
                                                          .again = true,
                                                          .scene = join->head.scene,
                                                          .output = params->output,
                                                          .files = &join->resume.output,
                                                          .run = &run},
                           error);
    const bool ok = manifest && kiln_manifest_finish(manifest, &join->records, stats, NULL, error);
    kiln_manifest_close(&manifest);
    return ok;
}

/* Claims the manifest and the output's files, so that the manifest replaces none of them. */
static bool claim(const struct join *join, struct kiln_error *error)
{
    const struct kiln_join_params *params = join->params;
    struct kiln_claims *claims = kiln_claims_create();
    char journal[KILN_PATH_SIZE];
    if (!claims)
        return kiln_error_no_memory(error, "%s", params->output);
    const bool ok =
        kiln_output_claim(&join->head.output, claims, error) &&
        kiln_journal_path(params->output, (struct kiln_shard){0, 0}, journal, error) &&
        kiln_claims_write(claims, journal, "the journal", error) &&
        (!params->manifest || kiln_claims_write(claims, params->manifest, "--manifest", error));
    kiln_claims_destroy(&claims);
    return ok;
}

static bool begin(struct join *join, struct kiln_error *error)
{
    join->arena = kiln_arena_create();
    if (!join->arena)
        return kiln_error_no_memory(error, "%s", join->params->output);
    if (!kiln_journal_find(join->params->output, &join->head, join->arena, error))
        return false;
    struct kiln_output_params *output = &join->head.output;
    output->log = join->params->log;
    output->caller = kiln_stop_caller(&join->stop);
    output->on_finished = (struct kiln_file_listener){take_finished, join};
    output->durable = true;
    output->budget = join->params->budget;
    output->overwrite = join->params->overwrite;
    if (!claim(join, error))
        return false;
    if (!kiln_records_create(&join->records, output->clip, output->clip_count))
        return kiln_error_no_memory(error, "%s", join->params->output);
    return kiln_resume_begin(&join->resume,
                             &(struct kiln_resume_params){.output = output,
                                                          .made_by = join->head.made_by,
                                                          .scene = join->head.scene,
                                                          .keep_journals = true},
                             &join->records, error);
}

static bool run(struct join *join, struct kiln_join_stats *stats, struct kiln_error *error)
{
    struct kiln_resume *resume = &join->resume;
    if (!begin(join, error))
        return false;
    stats->frames = join->records.count;
    stats->parts = kiln_parts_count(&resume->output);
    if (resume->missing_count > 0) {
        kiln_resume_undo(resume);
        return refuse_missing(join, error);
    }
    if (!kiln_resume_merge(resume, error))
        return false;
    stats->was_whole = !resume->output.format->one_file || resume->clip_is_whole;
    const struct kiln_render_stats done = {.kept = join->records.count};
    return (stats->was_whole || kiln_resume_join(resume, error)) &&
           write_manifest(join, &done, error);
}

bool kiln_join(const struct kiln_join_params *given, struct kiln_join_stats *stats,
               struct kiln_error *error)
{
    const double started_s = kiln_clock_seconds();
    struct kiln_join_params params = kiln_join_defaults();
    struct kiln_join_stats done = kiln_join_stats_empty();
    if (!kiln_sized_take(&params, given, "kiln_join_params", error) ||
        !kiln_sized_check(stats, "kiln_join_stats", error))
        return false;
    struct join join = {.params = &params,
                        .started = time(NULL),
                        .stop = {params.stop, params.user, NULL, params.budget, params.cancel}};
    const bool ok = run(&join, &done, error);
    kiln_resume_end(&join.resume);
    kiln_records_free(&join.records);
    kiln_arena_destroy(&join.arena);
    done.total_s = kiln_clock_seconds() - started_s;
    kiln_sized_give(stats, &done);
    return ok;
}
