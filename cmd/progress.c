/* Prints the progress of a job. Times come from the renderer, so that nothing here needs a clock.
 */
#include "progress.h"

#include <inttypes.h>

#include "event.h"

static const double tty_interval_s = 0.1, lines_interval_s = 5.0;

void progress_start(struct progress *progress, enum progress_mode mode)
{
    *progress = (struct progress){.mode = mode};
}

const char *state_text(char out[STATE_TEXT_SIZE], struct kiln_state_hash state)
{
    snprintf(out, STATE_TEXT_SIZE, "%08" PRIx32 "%08" PRIx32, state.lane[0], state.lane[1]);
    return out;
}

void add_passes(struct kiln_json *json, const double pass_ms[KILN_PASS_COUNT])
{
    kiln_json_begin_object(json, "pass_ms");
    for (int pass = 0; pass < KILN_PASS_COUNT; pass++)
        kiln_json_time(json, kiln_pass_name((enum kiln_pass)pass), pass_ms[pass]);
    kiln_json_end(json);
}

/* Formats a time: "1:05" or "2:00:05". */
static const char *duration_text(char out[32], double seconds)
{
    uint64_t whole = (uint64_t)(seconds + 0.5);
    if (whole >= 3600)
        snprintf(out, 32, "%" PRIu64 ":%02" PRIu64 ":%02" PRIu64, whole / 3600, whole / 60 % 60,
                 whole % 60);
    else
        snprintf(out, 32, "%" PRIu64 ":%02" PRIu64, whole / 60, whole % 60);
    return out;
}

/* Formats the line: "fire.yaml: 12 of 24 frames, 3.4 a second, 0:04 left". */
static void describe(char out[KILN_MESSAGE_SIZE], const char *scene,
                     const struct kiln_progress *frame)
{
    char name[KILN_MESSAGE_SIZE / 2], time[32], rate[64] = "", left[64] = "";
    kiln_shown(name, sizeof name, scene);
    if (frame->elapsed_s > 0)
        snprintf(rate, sizeof rate, ", %.1f a second", (double)frame->done / frame->elapsed_s);
    if (frame->eta_s >= 0)
        snprintf(left, sizeof left, ", %s left", duration_text(time, frame->eta_s));
    snprintf(out, KILN_MESSAGE_SIZE, "%s: %u of %u frames%s%s", name, frame->done, frame->total,
             rate, left);
}

void progress_write_openjd(const char *scene, const struct kiln_progress *frame, size_t job,
                           size_t jobs)
{
    char text[KILN_MESSAGE_SIZE];
    describe(text, scene, frame);
    event_progress((uint64_t)job * frame->total + frame->done, (uint64_t)jobs * frame->total, text);
}

void progress_write_event(const char *scene, const struct kiln_progress *frame,
                          const struct kiln_written *file)
{
    char state[STATE_TEXT_SIZE];
    struct kiln_json json = event_begin("frame");
    kiln_json_string(&json, "scene", scene);
    kiln_json_uint(&json, "frame", frame->frame);
    kiln_json_uint(&json, "done", frame->done);
    kiln_json_uint(&json, "total", frame->total);
    kiln_json_time(&json, "elapsed_s", frame->elapsed_s);
    if (frame->eta_s >= 0)
        kiln_json_time(&json, "eta_s", frame->eta_s);
    else
        kiln_json_null(&json, "eta_s");
    kiln_json_uint(&json, "alive", frame->alive);
    kiln_json_string(&json, "state", state_text(state, frame->state));
    add_passes(&json, frame->pass_ms);
    if (file) {
        kiln_json_string(&json, "file", file->file);
        kiln_json_uint(&json, "bytes", file->bytes);
        kiln_json_string(&json, "sha256", file->sha256);
    }
    event_end(&json);
}

void progress_show(struct progress *progress, const char *scene, const struct kiln_progress *frame)
{
    if (progress->mode == PROGRESS_NDJSON || progress->mode == PROGRESS_NONE)
        return;
    bool tty = progress->mode == PROGRESS_TTY;
    bool last = frame->done == frame->total;
    bool first = tty && !progress->line_shown;
    double interval_s = tty ? tty_interval_s : lines_interval_s;
    if (last && !tty) /* the result line follows */
        return;
    if (!first && !last && frame->elapsed_s - progress->last_s < interval_s)
        return;
    progress->last_s = frame->elapsed_s;
    progress->line_shown = tty;
    if (tty)
        fputc('\r', stderr);
    char text[KILN_MESSAGE_SIZE];
    describe(text, scene, frame);
    fputs(text, stderr);
    fputs(tty ? "\033[K" : "\n", stderr);
}

void progress_clear(struct progress *progress)
{
    if (progress->line_shown)
        fputs("\r\033[K", stderr);
    progress->line_shown = false;
}
