/* Prints what a finished job did: the result line, and --stats as text or JSON. */
#ifndef KILN_CMD_STATS_H
#define KILN_CMD_STATS_H

#include "kiln_program.h"

struct job_result {
    const char *scene;
    const char *output; /* as it was given; NULL: nothing was written */
    bool is_shard;
    const struct kiln_scene_info *info;
    const struct kiln_render_stats *stats;
};

/* Prints the line "fire.mp4: 150 frames in 12.3 s". */
void print_result(const struct job_result *result);

/* Prints --stats as a table: passes, totals, particles, memory. */
void print_stats_text(const struct job_result *result);

/* Writes the event `result`, with the statistics if asked for. */
void print_result_json(const struct job_result *result, bool with_stats);

#endif
