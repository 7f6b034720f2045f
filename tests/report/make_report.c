/* Writes a large HTML report for the test of the report in a browser: make_report FOLDER COUNT
 * writes FOLDER/report.html with COUNT tests of small pictures. All texts of the first test are
 * HTML and scripts, which the page must show and not execute. */
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/error.h"
#include "base/text.h"
#include "output/formats.h"
#include "report/report.h"

enum { WIDTH = 160, HEIGHT = 90, MAX_COUNT = 10000, FRAMES = 2 };

#define HOSTILE                                                                                    \
    "</script><script>window.harmed=1</script><!-- <img src=x onerror='window.harmed=2'> \" & "    \
    "\xe2\x80\xa8"

struct maker {
    struct kiln_arena *arena;
    struct kiln_results results;
    const char *folder;
    struct kiln_error error;
};

__attribute__((format(printf, 2, 3))) static char *text_of(struct maker *maker, const char *format,
                                                           ...)
{
    char text[KILN_PATH_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return kiln_arena_text(maker->arena, text, strlen(text));
}

/* ---- Pictures ----------------------------------------------------------------------------- */

/* Fills a picture with a gradient and noise, so that its file has a realistic size. */
static void paint(uint8_t *pixels, uint32_t seed)
{
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        uint32_t x = i % WIDTH, y = i / WIDTH, noise = (i * 2654435761u + seed * 40503u) >> 28;
        pixels[4 * i] = (uint8_t)(x + noise);
        pixels[4 * i + 1] = (uint8_t)(y + seed + noise);
        pixels[4 * i + 2] = (uint8_t)(seed * 31);
        pixels[4 * i + 3] = 255;
    }
}

static bool encode(const struct kiln_picture *picture, struct kiln_temporary *file,
                   struct kiln_error *error)
{
    const struct kiln_output_params no_scene = {0};
    return kiln_png_write(&no_scene, picture, file, NULL, error) &&
           kiln_temporary_commit(file, true, error);
}

static bool write_picture(struct maker *maker, const char *path, uint32_t seed)
{
    struct kiln_temporary file = {0};
    struct kiln_picture *picture =
        kiln_picture_create(WIDTH, HEIGHT, 8, NULL, NULL, 0, &maker->error);
    if (picture)
        paint(picture->display, seed);
    bool ok = picture && kiln_make_parent_folders(path, &maker->error) &&
              kiln_temporary_open(&file, path, &maker->error) &&
              encode(picture, &file, &maker->error);
    kiln_temporary_discard(&file);
    kiln_picture_destroy(&picture);
    return ok;
}

/* ---- Tests -------------------------------------------------------------------------------- */

static struct kiln_result *add_test(struct maker *maker, const char *name,
                                    enum kiln_test_status status)
{
    struct kiln_result *result = kiln_arena_alloc(maker->arena, 1, sizeof *result);
    kiln_result_init(result, name);
    result->status = status;
    result->code = status == KILN_TEST_FAIL ? KILN_FRAME_FAILED : KILN_OK;
    result->message = status == KILN_TEST_FAIL ? "flip.mean 0.02 is beyond the limit 0.01" : "";
    result->started = "2026-01-31T12:00:00Z";
    result->total_s = 1.25;
    result->column_count = 1;
    result->columns[0] = (struct kiln_compare_column){
        .name = "flip.mean", .unit = "", .limited = true, .limit = 0.01};
    result->frame_count = FRAMES;
    result->frames = kiln_arena_alloc(maker->arena, FRAMES, sizeof *result->frames);
    maker->results.tests[maker->results.count] = result;
    maker->results.folders[maker->results.count++] = text_of(maker, "%s/%s", maker->folder, name);
    maker->results.total_s += result->total_s;
    return result;
}

static bool fill_frame(struct maker *maker, struct kiln_result *result, uint32_t index,
                       uint32_t seed)
{
    struct kiln_result_frame *frame = &result->frames[index];
    const char *folder = maker->results.folders[maker->results.count - 1];
    kiln_result_frame_init(frame, 24 + index);
    frame->status = result->status;
    frame->judged_by = KILN_JUDGED_BY_METRICS;
    frame->message = result->message;
    frame->picture = text_of(maker, "frame_%04u.png", frame->number);
    bool same = result->status == KILN_TEST_PASS;
    frame->reference =
        same ? frame->picture : text_of(maker, "frame_%04u.reference.png", frame->number);
    frame->measured = true;
    frame->score = result->status == KILN_TEST_FAIL   ? 2
                   : result->status == KILN_TEST_WARN ? 0.8
                                                      : 0;
    frame->values[0] = 0.01 * frame->score;
    frame->beyond[0] = result->status == KILN_TEST_FAIL;
    return write_picture(maker, text_of(maker, "%s/%s", folder, frame->picture), seed + index) &&
           (same || write_picture(maker, text_of(maker, "%s/%s", folder, frame->reference), seed));
}

static void make_hostile(struct kiln_result *result)
{
    static struct kiln_result_change change = {HOSTILE, HOSTILE, HOSTILE, HOSTILE};
    static const char *note = HOSTILE;
    result->message = result->about = result->test = result->scene = result->golden = HOSTILE;
    result->device = result->driver = result->log = result->techniques = HOSTILE;
    result->scene_hash = result->rerun = result->approve = HOSTILE;
    result->changes = &change;
    result->notes = &note;
    result->change_count = result->note_count = 1;
}

static bool make_test(struct maker *maker, uint32_t number)
{
    static const char *const rooms[] = {"effects", "post", "sim", "draw"};
    enum kiln_test_status status = number % 97 == 0   ? KILN_TEST_FAIL
                                   : number % 53 == 3 ? KILN_TEST_WARN
                                                      : KILN_TEST_PASS;
    struct kiln_result *result =
        add_test(maker, text_of(maker, "%s/case_%04u", rooms[number % 4], number), status);
    for (uint32_t i = 0; i < FRAMES; i++)
        if (!fill_frame(maker, result, i, number))
            return false;
    if (number == 0)
        make_hostile(result);
    return true;
}

static bool make_report(struct maker *maker, const char *count_text)
{
    uint64_t count = 0;
    if (!kiln_text_to_uint64(count_text, &count) || count > MAX_COUNT)
        return kiln_error_set(&maker->error, KILN_USAGE, "expected a number up to %d", MAX_COUNT);
    for (uint32_t i = 0; i < count; i++)
        if (!make_test(maker, i))
            return false;
    const struct kiln_results_output output = {
        .format = "html", .path = text_of(maker, "%s/report.html", maker->folder)};
    return kiln_results_write(&maker->results, &output, &maker->error);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fputs("usage: make_report FOLDER COUNT\n", stderr);
        return KILN_USAGE;
    }
    struct maker maker = {.arena = kiln_arena_create(), .folder = argv[1]};
    maker.results = (struct kiln_results){
        .arena = maker.arena,
        .tests = kiln_arena_alloc(maker.arena, MAX_COUNT, sizeof *maker.results.tests),
        .folders = kiln_arena_alloc(maker.arena, MAX_COUNT, sizeof *maker.results.folders),
        .started = "2026-01-31T12:00:00Z",
    };
    bool ok = make_report(&maker, argv[2]);
    if (!ok)
        fprintf(stderr, "%s\n", maker.error.message);
    kiln_arena_destroy(&maker.arena);
    return ok ? 0 : (int)maker.error.code;
}
