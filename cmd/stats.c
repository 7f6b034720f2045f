/* Reports of a finished job on standard output. */
#include "stats.h"

#include <inttypes.h>
#include <sys/resource.h>

#include "progress.h"

/* The most memory that the process has had at once. */
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

void print_result(const struct job_result *result)
{
    const struct kiln_render_stats *stats = result->stats;
    printf("%s", result->output ? stats->first_file : result->scene);
    if (!result->output)
        printf(": nothing written");
    else if (stats->files > 1)
        printf(" and %u more", stats->files - 1);
    printf(": %u frame%s in %.3f s\n", stats->frames, plural(stats->frames), stats->total_s);
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

static void print_choices_json(const struct kiln_render_stats *stats)
{
    printf(", \"chosen\": [");
    for (uint32_t i = 0; i < stats->choice_count; i++) {
        const struct kiln_technique_choice *choice = &stats->choices[i];
        printf("%s{\"stage\": \"%s\", \"technique\": \"%s\", \"why\": ", i ? ", " : "",
               choice->stage, choice->name);
        if (choice->why)
            kiln_write_json_string(stdout, choice->why);
        else
            printf("null");
        printf("}");
    }
    printf("]");
}

static void print_text_member(const char *key, const char *value)
{
    printf(", \"%s\": ", key);
    if (value)
        kiln_write_json_string(stdout, value);
    else
        printf("null");
}

void print_result_json(const struct job_result *result, bool with_stats)
{
    const struct kiln_render_stats *stats = result->stats;
    char state[STATE_TEXT_SIZE];
    printf("{\"event\": \"result\"");
    print_text_member("scene", result->scene);
    print_text_member("output", result->output);
    print_text_member("first_file", result->output ? stats->first_file : NULL);
    printf(", \"frames\": %u, \"total_s\": %.3f", stats->frames, stats->total_s);
    if (with_stats) {
        printf(", \"setup_s\": %.3f, \"steps\": %" PRIu64 ", \"pass_ms\": ", stats->setup_s,
               stats->steps);
        print_pass_json(stats->pass_ms);
        printf(", \"alive\": %" PRIu64 ", \"particle_capacity\": %" PRIu64
               ", \"particle_bytes\": %" PRIu64 ", \"peak_memory_bytes\": %" PRIu64,
               stats->alive, stats->particle_capacity, stats->particle_bytes, peak_memory_bytes());
        print_text_member("techniques", stats->techniques);
        print_choices_json(stats);
        print_text_member("scene_hash", result->info->hash);
        print_text_member("state", state_text(state, stats->state));
    }
    printf("}\n");
}
