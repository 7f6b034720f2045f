/* Divides a clip into parts, writes and checks the files of parts, and joins them into the clip. */
#include "output/part.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zstd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/ranges.h"
#include "base/unpack.h"
#include "output/part_packets.h"

enum { END = UINT32_MAX, LEVEL = 1, SECONDS = 2, MOST_FRAMES = 600 };

uint32_t kiln_part_frames(uint32_t fps_num, uint32_t fps_den)
{
    const uint64_t frames = (uint64_t)fps_num * SECONDS / fps_den;
    return frames < 1 ? 1 : frames > MOST_FRAMES ? MOST_FRAMES : (uint32_t)frames;
}

/* ---- frames ---------------------------------------------------------------------------------- */

static uint32_t clip_frames(const struct kiln_output_params *params)
{
    return (uint32_t)kiln_ranges_count(params->clip, params->clip_count);
}

static uint32_t frame_at(const struct kiln_output_params *params, uint32_t position)
{
    return kiln_ranges_at(params->clip, params->clip_count, position);
}

static uint32_t part_length(const struct kiln_output_params *params)
{
    return kiln_part_frames(params->fps_num, params->fps_den);
}

uint32_t kiln_parts_count(const struct kiln_output_params *params)
{
    return (clip_frames(params) - 1) / part_length(params) + 1;
}

uint32_t kiln_part_of(const struct kiln_output_params *params, uint32_t frame)
{
    uint32_t position = 0;
    kiln_ranges_find(params->clip, params->clip_count, frame, &position);
    return position / part_length(params);
}

/* Returns the number of frames of a part. */
static uint32_t count_in(const struct kiln_output_params *params, uint32_t part)
{
    const uint32_t rest = clip_frames(params) - part * part_length(params);
    return rest < part_length(params) ? rest : part_length(params);
}

struct kiln_frame_range kiln_part_range(const struct kiln_output_params *params, uint32_t part)
{
    const uint32_t first = part * part_length(params);
    return (struct kiln_frame_range){frame_at(params, first),
                                     frame_at(params, first + count_in(params, part) - 1)};
}

bool kiln_part_path(const struct kiln_output_params *params, uint32_t part,
                    char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    char name[32];
    snprintf(name, sizeof name, "%05u.part", part);
    return kiln_path_join(path, params->parts, name, error);
}

/* ---- writing --------------------------------------------------------------------------------- */

struct kiln_part_writer {
    const struct kiln_output_params *params;
    struct kiln_part_head head;
    struct kiln_temporary file;
    struct kiln_part_out out;
    struct kiln_part_packets *packets; /* NULL: the file has pictures instead of packets */
    uint32_t frames;                   /* number of frames that were written */
    void *packed;
    size_t room;
};

/* Returns whether the files of parts have packets of the encoder; else they have pictures. */
static bool keeps_packets(const struct kiln_output_params *params)
{
    return params->format->video && params->format->video->parts;
}

static bool fill_head(const struct kiln_output_params *params, uint32_t part,
                      struct kiln_part_head *head, struct kiln_error *error)
{
    *head = (struct kiln_part_head){.part = part,
                                    .parts = kiln_parts_count(params),
                                    .first = part * part_length(params),
                                    .frames = count_in(params, part),
                                    .packets = keeps_packets(params)};
    kiln_part_made_by(head->made_by);
    return kiln_clip_hash(params, head->clip) || kiln_error_no_memory(error, "%s", params->path);
}

struct kiln_part_writer *kiln_part_writer_open(const struct kiln_output_params *params,
                                               uint32_t part, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct kiln_part_writer *writer = calloc(1, sizeof *writer);
    if (!writer) {
        kiln_error_no_memory(error, "%s", params->path);
        return NULL;
    }
    writer->params = params;
    bool ok = kiln_part_path(params, part, path, error) &&
              fill_head(params, part, &writer->head, error) &&
              kiln_temporary_open(&writer->file, path, error);
    writer->file.budget = params->budget;
    if (ok) {
        writer->file.durable = params->durable;
        kiln_part_begin(&writer->out, &writer->file, &writer->head);
    }
    if (ok && keeps_packets(params)) {
        writer->packets = kiln_part_packets_open(params, part == 0, &writer->out, error);
        ok = writer->packets != NULL;
    }
    if (!ok)
        kiln_part_writer_close(&writer);
    return writer;
}

void kiln_part_writer_close(struct kiln_part_writer **writer)
{
    struct kiln_part_writer *w = *writer;
    if (!w)
        return;
    kiln_part_packets_close(&w->packets);
    kiln_temporary_discard(&w->file);
    free(w->packed);
    free(w);
    *writer = NULL;
}

static bool write_picture(struct kiln_part_writer *writer, const struct kiln_picture *picture,
                          struct kiln_error *error)
{
    const size_t size = (size_t)picture->width * picture->height * picture->bits / 2;
    writer->room = ZSTD_compressBound(size);
    if (!writer->packed)
        writer->packed = malloc(writer->room);
    if (!writer->packed)
        return kiln_error_no_memory(error, "%s", writer->params->path);
    const size_t packed =
        ZSTD_compress(writer->packed, writer->room, picture->display, size, LEVEL);
    if (ZSTD_isError(packed) || packed >= END)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: a frame of %zu bytes cannot be kept",
                              writer->params->path, size);
    kiln_part_add_word(&writer->out, (uint32_t)packed);
    kiln_part_add_word(&writer->out, picture->has_alpha);
    kiln_part_add(&writer->out, writer->packed, packed);
    return true;
}

bool kiln_part_write(struct kiln_part_writer *writer, const struct kiln_picture *picture,
                     struct kiln_error *error)
{
    writer->frames++;
    return writer->packets ? kiln_part_packets_write(writer->packets, picture, error)
                           : write_picture(writer, picture, error);
}

bool kiln_part_finish(struct kiln_part_writer *writer, struct kiln_error *error)
{
    if (writer->frames != writer->head.frames)
        return kiln_error_set(error, KILN_USAGE, "%s: found %u of the %u frames of part %u",
                              writer->params->path, writer->frames, writer->head.frames,
                              writer->head.part);
    if (writer->packets && !kiln_part_packets_finish(writer->packets, error))
        return false;
    kiln_part_add_word(&writer->out, END);
    kiln_part_end(&writer->out);
    return kiln_temporary_commit(&writer->file, true, error);
}

/* ---- checking and joining -------------------------------------------------------------------- */

/* Opens the file of a part and compares its head with the expected one. */
static bool open_part(const struct kiln_output_params *params, uint32_t part, const char *path,
                      struct kiln_part_in *in, struct kiln_error *error)
{
    struct kiln_part_head wanted;
    if (!fill_head(params, part, &wanted, error) || !kiln_part_open(in, path, error))
        return false;
    const struct kiln_part_head *head = &in->head;
    bool ok = true;
    if (strcmp(head->clip, wanted.clip) != 0)
        ok = kiln_part_refuse(
            in, "the part belongs to another clip: of another scene, size, quality or other frames",
            error);
    else if (strcmp(head->made_by, wanted.made_by) != 0)
        ok = kiln_error_set(error, KILN_INVALID_INPUT, "%s: the part was made by %s; this is %s",
                            path, head->made_by, wanted.made_by);
    else if (head->part != part || head->parts != wanted.parts || head->first != wanted.first ||
             head->frames != wanted.frames || head->packets != wanted.packets)
        ok = kiln_part_refuse(in, "the file is another part of the clip", error);
    if (!ok)
        kiln_part_close(in);
    return ok;
}

bool kiln_part_check(const struct kiln_output_params *params, uint32_t part,
                     struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct kiln_part_in in;
    if (!kiln_part_path(params, part, path, error) || !open_part(params, part, path, &in, error))
        return false;
    kiln_part_close(&in);
    return true;
}

/* Returns whether an entry is the file of a part, such as "00007.part". */
static int is_part(const struct dirent *entry)
{
    const size_t digits = strspn(entry->d_name, "0123456789");
    return digits > 0 && strcmp(entry->d_name + digits, ".part") == 0;
}

void kiln_parts_remove(const char *folder)
{
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, is_part, NULL);
    for (int i = 0; i < count; i++) {
        char path[KILN_PATH_SIZE];
        if (snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name) < KILN_PATH_SIZE)
            unlink(path);
        if (i == 0)
            kiln_temporary_sweep(path);
        free(entries[i]);
    }
    free(entries);
    rmdir(folder);
}

/* Reads `size` packed bytes and unpacks them to `room` bytes. */
static bool read_packed(struct kiln_part_in *in, uint32_t size, void *out, size_t room,
                        struct kiln_error *error)
{
    if (size > ZSTD_compressBound(room))
        return kiln_part_refuse(in, "the part of a clip is damaged", error);
    void *packed = malloc((size_t)size + 1);
    if (!packed)
        return kiln_error_no_memory(error, "%s", in->path);
    bool ok = kiln_part_read(in, packed, size, error);
    if (ok) {
        size_t got = 0;
        const enum kiln_code outcome = kiln_unpack(out, room, packed, size, &got);
        ok = outcome == KILN_OK && got == room;
        if (outcome == KILN_DEVICE_FAILED)
            kiln_error_no_memory(error, "%s", in->path);
        else if (!ok)
            kiln_part_refuse(in, "the part of a clip is damaged", error);
    }
    free(packed);
    return ok;
}

/* Reads the picture of the next frame; NULL with an error. */
static struct kiln_picture *read_picture(const struct kiln_output_params *params,
                                         struct kiln_part_in *in, uint32_t frame,
                                         struct kiln_error *error)
{
    const uint32_t bits = params->format->needs(params).bits;
    uint32_t size = 0, has_alpha = 0;
    if (!kiln_part_read_word(in, &size, error) || !kiln_part_read_word(in, &has_alpha, error))
        return NULL;
    struct kiln_picture *picture =
        kiln_picture_create(params->width, params->height, bits, NULL, NULL, 0, error);
    if (!picture)
        return NULL;
    const size_t room = (size_t)params->width * params->height * bits / 2;
    picture->frame = frame;
    picture->has_alpha = has_alpha != 0;
    if (!read_packed(in, size, picture->display, room, error))
        kiln_picture_destroy(&picture);
    return picture;
}

static bool join_pictures(const struct kiln_output_params *params, struct kiln_error *error)
{
    struct kiln_output_params straight = *params;
    straight.parts = NULL;
    straight.ranges = params->clip;
    straight.range_count = params->clip_count;
    struct kiln_output *output = kiln_output_open(&straight, error);
    bool ok = output != NULL;
    for (uint32_t part = 0; ok && part < kiln_parts_count(params); part++) {
        char path[KILN_PATH_SIZE];
        struct kiln_part_in in;
        ok = kiln_part_path(params, part, path, error) && open_part(params, part, path, &in, error);
        if (!ok)
            break;
        for (uint32_t i = 0; ok && i < count_in(params, part); i++) {
            const uint32_t frame = frame_at(params, part * part_length(params) + i);
            struct kiln_picture *picture = kiln_may_go_on(&params->caller, error)
                                               ? read_picture(params, &in, frame, error)
                                               : NULL;
            ok = picture && kiln_output_write(output, picture, error);
        }
        kiln_part_close(&in);
    }
    ok = ok && kiln_output_finish(output, error);
    kiln_output_close(&output);
    return ok;
}

/* Tells the job that the clip is whole. */
static bool tell(const struct kiln_output_params *params, const char *path,
                 struct kiln_error *error)
{
    struct kiln_finished_file finished = {
        .path = path,
        .frames = {params->clip[0].first, params->clip[params->clip_count - 1].last},
        .is_clip = true};
    return !params->on_finished.tell ||
           (kiln_finished_file_measure(&finished, error) &&
            params->on_finished.tell(params->on_finished.user, &finished, error));
}

static bool join_packets(const struct kiln_output_params *params, struct kiln_error *error)
{
    struct kiln_temporary file = {0};
    char target[KILN_PATH_SIZE];
    if (!kiln_output_clip_file(params, 0, target, error) ||
        !kiln_target_check(target, params->overwrite, error) ||
        !kiln_temporary_open(&file, target, error))
        return false;
    file.durable = params->durable;
    file.budget = params->budget;
    void *clip = kiln_video_open(params, &file, error);
    bool ok = clip != NULL;
    for (uint32_t part = 0; ok && part < kiln_parts_count(params); part++) {
        char path[KILN_PATH_SIZE];
        struct kiln_part_in in;
        ok = kiln_part_path(params, part, path, error) && open_part(params, part, path, &in, error);
        if (!ok)
            break;
        ok = kiln_part_packets_pass(&in, clip, &params->caller, error);
        kiln_part_close(&in);
    }
    ok = ok && kiln_video_finish(clip, &params->caller, error);
    if (clip)
        kiln_video_close(clip);
    if (ok)
        return kiln_temporary_commit(&file, params->overwrite, error) &&
               tell(params, target, error);
    kiln_temporary_discard(&file);
    return false;
}

bool kiln_parts_join(const struct kiln_output_params *params, struct kiln_error *error)
{
    return keeps_packets(params) ? join_packets(params, error) : join_pictures(params, error);
}
