/* Writes and reads the first line of a journal, which says of which job it is. The ranges of frames
 * are one text, "0-149,200-299", since a flipbook may have thousands of them. */
#include "job/journal_head.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/text.h"
#include "output/formats.h"
#include "output/part_file.h"

bool kiln_journal_head_make(struct kiln_journal_head *head, const struct kiln_output_params *output,
                            const char *made_by, const char *scene)
{
    *head = (struct kiln_journal_head){.output = *output, .made_by = made_by, .scene = scene};
    return kiln_clip_hash(output, head->job);
}

static void write_frames(struct kiln_json *json, const struct kiln_output_params *output)
{
    struct kiln_text text = {0};
    for (size_t i = 0; i < output->clip_count; i++)
        kiln_text_add(&text, "%s%u-%u", i ? "," : "", output->clip[i].first, output->clip[i].last);
    json->failed |= text.failed;
    kiln_json_string(json, "frames", text.data);
    kiln_text_free(&text);
}

void kiln_journal_head_write(struct kiln_json *json, const struct kiln_journal_head *head)
{
    const struct kiln_output_params *output = &head->output;
    const struct kiln_flipbook *flipbook = &output->flipbook;
    kiln_json_uint(json, "kiln_journal", KILN_JOURNAL_VERSION);
    kiln_json_string(json, "scene", output->scene_hash);
    kiln_json_string(json, "job", head->job);
    kiln_json_string(json, "made_by", head->made_by);
    kiln_json_uint(json, "seed", output->seed);
    kiln_json_pair(json, "size", output->width, output->height);
    kiln_json_pair(json, "fps", output->fps_num, output->fps_den);
    write_frames(json, output);
    kiln_json_uint(json, "alpha", output->alpha);
    kiln_json_uint(json, "png_bits", output->png_bits);
    kiln_json_uint(json, "exr_bits", output->exr_bits);
    kiln_json_uint(json, "quality", output->quality);
    kiln_json_pair(json, "flipbook", flipbook->columns, flipbook->rows);
    kiln_json_uint(json, "flipbook_padding", flipbook->padding);
    kiln_json_uint(json, "flipbook_premultiplied", flipbook->premultiplied);
    kiln_json_uint(json, "flipbook_motion", kiln_flipbook_motion_number(flipbook));
    kiln_json_uint(json, "flipbook_fade", flipbook->fade);
    kiln_json_string(json, "manifest", head->scene);
}

/* ---- reading --------------------------------------------------------------------------------- */

/* The members of a line. `bad` becomes true and stays so at a member with an invalid value,
 * `starved` at a member for which memory was short. */
struct members {
    const struct kiln_node *line;
    struct kiln_arena *arena;
    bool bad, starved;
};

static uint32_t number_of(struct members *m, const struct kiln_node *node)
{
    uint64_t value = 0;
    m->bad |= !node || node->kind != KILN_NODE_SCALAR || !kiln_text_to_uint64(node->text, &value) ||
              value > UINT32_MAX;
    return (uint32_t)value;
}

/* Marks a line as bad whose number is above the limit. No scene has such a number, and later code
 * allocates and loops by it. */
static void check_range(struct members *m, uint64_t value, uint64_t least, uint64_t most)
{
    m->bad |= value < least || value > most;
}

static uint32_t take_number(struct members *m, const char *key)
{
    return number_of(m, kiln_node_entry(m->line, key));
}

static void take_pair(struct members *m, const char *key, uint32_t *first, uint32_t *second)
{
    const struct kiln_node *node = kiln_node_entry(m->line, key);
    const bool is_pair = node && node->kind == KILN_NODE_LIST && node->count == 2;
    *first = number_of(m, is_pair ? node->first : NULL);
    *second = number_of(m, is_pair ? node->first->next : NULL);
}

static const char *take_text(struct members *m, const char *key)
{
    const struct kiln_node *node = kiln_node_entry(m->line, key);
    const bool is_text = node && node->kind == KILN_NODE_SCALAR;
    const char *text = is_text ? kiln_arena_text(m->arena, node->text, strlen(node->text)) : NULL;
    m->starved |= is_text && !text;
    m->bad |= !text;
    return text ? text : "";
}

/* Reads a number at the start of a text and moves past it. */
static uint32_t parse_number(struct members *m, const char **text)
{
    char digits[16] = "";
    const size_t length = strspn(*text, "0123456789");
    uint64_t value = 0;
    m->bad |= length == 0 || length >= sizeof digits;
    if (m->bad)
        return 0;
    memcpy(digits, *text, length);
    m->bad |= !kiln_text_to_uint64(digits, &value) || value >= KILN_MAX_FRAMES;
    *text += length;
    return (uint32_t)value;
}

static void take_frames(struct members *m, struct kiln_output_params *output)
{
    const char *text = take_text(m, "frames");
    size_t room = 1;
    for (const char *c = text; *c; c++)
        room += *c == ',';
    struct kiln_frame_range *clip = kiln_arena_alloc(m->arena, room, sizeof *clip);
    m->starved |= !clip;
    m->bad |= !clip;
    uint64_t next = 0;
    for (size_t i = 0; i < room && !m->bad; i++) {
        clip[i].first = parse_number(m, &text);
        m->bad |= *text++ != '-';
        if (m->bad)
            return;
        clip[i].last = parse_number(m, &text);
        m->bad |= clip[i].first < next || clip[i].last < clip[i].first ||
                  *text != (i + 1 < room ? ',' : '\0');
        text += i + 1 < room;
        next = (uint64_t)clip[i].last + 1;
    }
    output->clip = output->ranges = clip;
    output->clip_count = output->range_count = room;
}

static void take_settings(struct members *m, struct kiln_output_params *output)
{
    output->scene_hash = take_text(m, "scene");
    output->seed = take_number(m, "seed");
    take_pair(m, "size", &output->width, &output->height);
    take_pair(m, "fps", &output->fps_num, &output->fps_den);
    check_range(m, output->width, KILN_MIN_EDGE, KILN_MAX_EDGE);
    check_range(m, output->height, KILN_MIN_EDGE, KILN_MAX_EDGE);
    check_range(m, output->fps_den, 1, UINT32_MAX);
    check_range(m, output->fps_num, output->fps_den, (uint64_t)output->fps_den * KILN_MAX_RATE);
    take_frames(m, output);
    output->alpha = take_number(m, "alpha") != 0;
    output->png_bits = take_number(m, "png_bits");
    output->exr_bits = take_number(m, "exr_bits");
    output->quality = take_number(m, "quality");
    take_pair(m, "flipbook", &output->flipbook.columns, &output->flipbook.rows);
    output->flipbook.padding = take_number(m, "flipbook_padding");
    output->flipbook.premultiplied = take_number(m, "flipbook_premultiplied") != 0;
    const uint32_t motion = take_number(m, "flipbook_motion");
    output->flipbook.motion = motion > 0;
    output->flipbook.green_down = motion == 2;
    if (kiln_node_entry(m->line, "flipbook_fade")) /* absent in journals of earlier versions */
        output->flipbook.fade = take_number(m, "flipbook_fade");
}

bool kiln_journal_head_read(struct kiln_journal_head *head, const char *journal, const char *path,
                            const struct kiln_node *line, struct kiln_arena *arena,
                            struct kiln_error *error)
{
    struct members m = {.line = line, .arena = arena};
    struct kiln_output_params output = {.path = path, .threads = 1};
    if (take_number(&m, "kiln_journal") != KILN_JOURNAL_VERSION || m.bad)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the file is not a journal that this kiln reads", journal);
    take_settings(&m, &output);
    const char *made_by = take_text(&m, "made_by"), *scene = take_text(&m, "manifest");
    const char *job = take_text(&m, "job");
    if (m.starved)
        return kiln_error_no_memory(error, "%s", journal);
    if (m.bad)
        return kiln_error_set(error, KILN_USAGE, "%s: the journal is damaged", journal);
    output = kiln_output_complete(&output, error);
    if (!output.format || !output.format->check(&output, error))
        return false;
    if (!kiln_journal_head_make(head, &output, made_by, scene))
        return kiln_error_no_memory(error, "%s", journal);
    return strcmp(head->job, job) == 0 ||
           kiln_error_set(error, KILN_USAGE, "%s: the journal belongs to another output than %s",
                          journal, path);
}
