/* Prints the reports of a finished job on standard output: the result line, and --stats as text or
 * JSON. */
#include "stats.h"

#include <inttypes.h>
#include <sys/resource.h>

#include "event.h"
#include "progress.h"
#include "report.h"

/* Returns the most memory that the process has had at once. */
static uint64_t peak_memory_bytes(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss * 1024 : 0;
}

static double bytes_per_particle(const struct kiln_render_stats *stats)
{
    return stats->particle_capacity
               ? (double)stats->particle_bytes / (double)stats->particle_capacity
               : 0;
}

static const char *plural(uint32_t count)
{
    return count == 1 ? "" : "s";
}

static void print_shard_result(const struct job_result *result)
{
    const struct kiln_render_stats *stats = result->stats;
    const uint32_t parts = stats->end_part - stats->first_part;
    if (parts == 0) {
        print_name(result->output);
        printf(": this shard has none of its parts\n");
        return;
    }
    print_name(result->output);
    printf(": part%s %u", plural(parts), stats->first_part + 1);
    if (parts > 1)
        printf("-%u", stats->end_part);
    if (stats->frames == 0) {
        printf(": whole already, %u frame%s kept\n", stats->kept, plural(stats->kept));
        return;
    }
    printf(": %u frame%s in %.3f s", stats->frames, plural(stats->frames), stats->total_s);
    if (stats->kept > 0)
        printf(", %u kept", stats->kept);
    printf("\n");
}

void print_result(const struct job_result *result)
{
    const struct kiln_render_stats *stats = result->stats;
    if (result->is_shard) {
        print_shard_result(result);
        return;
    }
    print_name(result->output ? stats->first_file : result->scene);
    if (!result->output)
        printf(": nothing written");
    else if (stats->files > 1)
        printf(" and %u more", stats->files - 1);
    printf(": %u frame%s in %.3f s", stats->frames, plural(stats->frames), stats->total_s);
    if (stats->kept > 0)
        printf(", %u kept", stats->kept);
    printf("\n");
}

static void print_row(const char *name, double total_ms, const struct kiln_render_stats *stats)
{
    double frames = stats->frames ? (double)stats->frames : 1;
    double all_ms = stats->total_s * 1000;
    printf("  %-12s %12.3f %12.3f %8.1f %%\n", name, total_ms, total_ms / frames,
           all_ms > 0 ? 100 * total_ms / all_ms : 0.0);
}

void print_stats_text(const struct job_result *result)
{
    const struct kiln_render_stats *stats = result->stats;
    char state[STATE_TEXT_SIZE];
    printf("  %-12s %12s %12s %10s\n", "pass", "ms", "ms a frame", "of total");
    for (int pass = 0; pass < KILN_PASS_COUNT; pass++)
        print_row(kiln_pass_name((enum kiln_pass)pass), stats->pass_ms[pass], stats);
    print_row("set-up", stats->setup_s * 1000, stats);
    print_row("total", stats->total_s * 1000, stats);
    printf("  steps        %" PRIu64 "\n", stats->steps);
    printf("  particles    %" PRIu64 " alive, %" PRIu64 " slots, %" PRIu64 " bytes (%.1f a slot)\n",
           stats->alive, stats->particle_capacity, stats->particle_bytes,
           bytes_per_particle(stats));
    printf("  memory       %.1f MiB at the peak\n", (double)peak_memory_bytes() / 1048576);
    printf("  techniques   %s\n", stats->techniques);
    for (uint32_t i = 0; i < stats->choice_count; i++) {
        const struct kiln_technique_choice *choice = &stats->choices[i];
        printf("  %-12s %s=%s: %s\n", i ? "" : "chosen", choice->stage, choice->name,
               choice->why ? choice->why : "as asked for");
    }
    printf("  scene        %s\n", result->info->hash);
    printf("  state        %s\n", state_text(state, stats->state));
}

static void add_choices(struct kiln_json *json, const struct kiln_render_stats *stats)
{
    kiln_json_begin_array(json, "chosen");
    for (uint32_t i = 0; i < stats->choice_count; i++) {
        const struct kiln_technique_choice *choice = &stats->choices[i];
        kiln_json_begin_object(json, NULL);
        kiln_json_string(json, "stage", choice->stage);
        kiln_json_string(json, "technique", choice->name);
        kiln_json_string(json, "why", choice->why);
        kiln_json_end(json);
    }
    kiln_json_end(json);
}

static void add_stats(struct kiln_json *json, const struct job_result *result)
{
    const struct kiln_render_stats *stats = result->stats;
    char state[STATE_TEXT_SIZE];
    kiln_json_time(json, "setup_s", stats->setup_s);
    kiln_json_uint(json, "steps", stats->steps);
    add_passes(json, stats->pass_ms);
    kiln_json_uint(json, "alive", stats->alive);
    kiln_json_uint(json, "particle_capacity", stats->particle_capacity);
    kiln_json_uint(json, "particle_bytes", stats->particle_bytes);
    kiln_json_uint(json, "peak_memory_bytes", peak_memory_bytes());
    kiln_json_string(json, "techniques", stats->techniques);
    add_choices(json, stats);
    kiln_json_string(json, "scene_hash", result->info->hash);
    kiln_json_string(json, "state", state_text(state, stats->state));
}

void print_result_json(const struct job_result *result, bool with_stats)
{
    const struct kiln_render_stats *stats = result->stats;
    struct kiln_json json = event_begin("result");
    kiln_json_string(&json, "scene", result->scene);
    kiln_json_string(&json, "output", result->output);
    kiln_json_string(&json, "first_file", result->output ? stats->first_file : NULL);
    kiln_json_uint(&json, "frames", stats->frames);
    kiln_json_uint(&json, "kept", stats->kept);
    kiln_json_time(&json, "total_s", stats->total_s);
    if (with_stats)
        add_stats(&json, result);
    event_end(&json);
}
