/* Writes pictures to their files. A bounded queue feeds encoder threads, which write one file for
 * each image, one file for all, or a descriptor. Images are encoded in parallel; a video has one
 * encoder, so its frames stay in order. The first failure stops everything, and the next call
 * returns it. */
#include "output/output.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/error.h"
#include "base/pattern.h"
#include "output/flipbook.h"
#include "output/formats.h"
#include "output/part.h"

enum { MAX_ENCODERS = 64, QUEUE_SIZE = MAX_ENCODERS + 1 };

struct kiln_output {
    struct kiln_arena *arena;
    /* parameters whose texts and ranges are copied into the arena */
    struct kiln_output_params params;
    const struct kiln_format *format;
    struct kiln_path_pattern pattern;

    struct kiln_temporary video_file; /* the file of formats with one_file */
    void *video_encoder;
    /* is written instead of video_file and encoder where the clip waits in parts */
    struct kiln_part_writer *part;

    size_t due_range; /* the range of the frame that is expected next */
    uint32_t due_frame;

    pthread_t encoders[MAX_ENCODERS];
    uint32_t encoder_count;
    pthread_mutex_t mutex;
    pthread_mutex_t telling; /* is held while `on_finished` is called */
    pthread_cond_t work, room;
    struct kiln_picture *queue[QUEUE_SIZE]; /* a ring buffer */
    uint32_t first, waiting;
    uint32_t in_flight; /* pictures in the queue or being encoded */
    bool ending;        /* true: no more pictures come */
    bool failed;
    /* the earliest frame of the clip that failed, for any number of threads */
    uint32_t failed_frame;
    struct kiln_error error; /* the error of that frame */
};

/* ---- Checks before the first frame -------------------------------------------------------- */

static bool refuse_gap(const char *path, uint32_t first, uint32_t last, struct kiln_error *error)
{
    char range[32] = "";
    if (first < last)
        snprintf(range, sizeof range, "s %u-%u", first, last);
    else
        snprintf(range, sizeof range, " %u", first);
    return kiln_error_set(error, KILN_USAGE,
                          "%s: a clip cannot leave out frames, but frame%s would be missing; write "
                          "images, or one range",
                          path, range);
}

static bool check_ranges(const struct kiln_output_params *params, const struct kiln_format *format,
                         struct kiln_error *error)
{
    if (params->range_count == 0)
        return kiln_error_set(error, KILN_USAGE, "%s: there are no frames to write", params->path);
    for (size_t i = 0; i < params->range_count; i++) {
        const struct kiln_frame_range *range = &params->ranges[i];
        if (range->last < range->first || (i > 0 && range->first <= range[-1].last))
            return kiln_error_set(error, KILN_USAGE, "%s: frames %u-%u are not in ascending order",
                                  params->path, range->first, range->last);
        if (format->one_file && !format->gaps && !params->parts && i > 0 &&
            range->first != range[-1].last + 1)
            return refuse_gap(params->path, range[-1].last + 1, range->first - 1, error);
    }
    return true;
}

/* Writes the path of the file for a frame (the one file, for a video); false if it does not fit. */
static bool file_of(const struct kiln_output *output, uint32_t frame, char *path, size_t size)
{
    return kiln_path_pattern_format(&output->pattern, frame, path, size);
}

static bool check_files(const struct kiln_output *output, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    for (size_t i = 0; i < output->params.range_count; i++) {
        const struct kiln_frame_range *range = &output->params.ranges[i];
        for (uint64_t frame = range->first; frame <= range->last; frame++) {
            if (!file_of(output, (uint32_t)frame, path, sizeof path))
                return kiln_error_set(error, KILN_USAGE, "%s: the path is too long",
                                      output->params.path);
            if (!kiln_target_check(path, output->params.overwrite, error))
                return false;
            if (!output->pattern.numbered)
                return true;
        }
    }
    return true;
}

/* Checks that files can be made in the folder, by making one. */
static bool check_folder(const struct kiln_output *output, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct kiln_temporary probe = {0};
    if (!file_of(output, output->params.ranges[0].first, path, sizeof path) ||
        !kiln_temporary_open(&probe, path, error))
        return false;
    kiln_temporary_discard(&probe);
    return true;
}

static bool make_parts_folder(const struct kiln_output *output, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!output->params.parts)
        return true;
    if (!kiln_part_path(&output->params, 0, path, error) || !kiln_make_parent_folders(path, error))
        return false;
    kiln_temporary_sweep(path);
    return true;
}

/* Removes the temporary files that killed runs left in the folders of the output. */
static bool sweep(const struct kiln_output *output)
{
    char path[KILN_PATH_SIZE];
    if (file_of(output, output->params.ranges[0].first, path, sizeof path))
        kiln_temporary_sweep(path);
    return true;
}

/* ---- Whole files -------------------------------------------------------------------------- */

/* Tells the job of a file that is whole and has its name. */
static bool tell(struct kiln_output *output, struct kiln_finished_file finished,
                 struct kiln_error *error)
{
    const struct kiln_file_listener *listener = &output->params.on_finished;
    if (!listener->tell)
        return true;
    if (!kiln_finished_file_measure(&finished, error))
        return false;
    pthread_mutex_lock(&output->telling);
    const bool good = listener->tell(listener->user, &finished, error);
    pthread_mutex_unlock(&output->telling);
    return good;
}

/* Tells the job of the one file of a clip, and of the files beside it. */
static bool tell_of_clip(struct kiln_output *output, struct kiln_error *error)
{
    const struct kiln_output_params *params = &output->params;
    char path[KILN_PATH_SIZE];
    const struct kiln_finished_file clip = {
        .path = path,
        .frames = {params->clip[0].first, params->clip[params->clip_count - 1].last},
        .is_clip = true};
    bool ok = true;
    for (uint32_t i = 0; ok && params->on_finished.tell; i++) {
        ok = kiln_output_clip_file(params, i, path, error);
        if (!ok || !*path)
            break;
        ok = tell(output, clip, error);
    }
    return ok;
}

/* ---- Encoding ----------------------------------------------------------------------------- */

static bool encode_image(struct kiln_output *output, const struct kiln_picture *picture,
                         struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct kiln_temporary file = {0};
    if (!file_of(output, picture->frame, path, sizeof path) ||
        !kiln_temporary_open(&file, path, error))
        return false;
    const struct kiln_format *format = output->format;
    file.budget = output->params.budget;
    void *encoder = format->open(&output->params, &file, error);
    bool good = encoder && format->encode(encoder, picture, error) &&
                (!format->finish || format->finish(encoder, NULL, error));
    if (encoder)
        format->close(encoder);
    file.durable = output->params.durable;
    if (good)
        return kiln_temporary_commit(&file, output->params.overwrite, error) &&
               tell(output,
                    (struct kiln_finished_file){.path = path,
                                                .frames = {picture->frame, picture->frame}},
                    error);
    kiln_temporary_discard(&file);
    return false;
}

/* Encodes a picture into the part that it belongs to. The part's file gets its name after its last
 * frame. */
static bool encode_into_part(struct kiln_output *output, const struct kiln_picture *picture,
                             struct kiln_error *error)
{
    const struct kiln_output_params *params = &output->params;
    const uint32_t part = kiln_part_of(params, picture->frame);
    const struct kiln_frame_range range = kiln_part_range(params, part);
    char path[KILN_PATH_SIZE];
    if (picture->frame == range.first)
        output->part = kiln_part_writer_open(params, part, error);
    if (!output->part || !kiln_part_write(output->part, picture, error))
        return false;
    if (picture->frame != range.last)
        return true;
    const bool good =
        kiln_part_finish(output->part, error) && kiln_part_path(params, part, path, error) &&
        tell(output, (struct kiln_finished_file){.path = path, .frames = range, .is_part = true},
             error);
    kiln_part_writer_close(&output->part);
    return good;
}

static bool encode(struct kiln_output *output, const struct kiln_picture *picture,
                   struct kiln_error *error)
{
    if (output->params.parts)
        return encode_into_part(output, picture, error);
    if (output->format->one_file)
        return output->format->encode(output->video_encoder, picture, error);
    return encode_image(output, picture, error);
}

/* Takes the next picture, or NULL when no more come; the mutex is held. */
static struct kiln_picture *take(struct kiln_output *output)
{
    while (output->waiting == 0 && !output->ending)
        pthread_cond_wait(&output->work, &output->mutex);
    if (output->waiting == 0)
        return NULL;
    struct kiln_picture *picture = output->queue[output->first];
    output->first = (output->first + 1) % QUEUE_SIZE;
    output->waiting--;
    return picture;
}

static void *run_encoder(void *opaque)
{
    struct kiln_output *output = opaque;
    pthread_mutex_lock(&output->mutex);
    for (struct kiln_picture *picture = take(output); picture; picture = take(output)) {
        const uint32_t frame = picture->frame;
        bool skip = output->failed && frame > output->failed_frame;
        struct kiln_error error = {0};
        pthread_mutex_unlock(&output->mutex);
        bool good = skip || encode(output, picture, &error);
        kiln_picture_destroy(&picture);
        pthread_mutex_lock(&output->mutex);
        if (!good && (!output->failed || frame < output->failed_frame)) {
            output->failed = true;
            output->failed_frame = frame;
            output->error = error;
        }
        output->in_flight--;
        pthread_cond_signal(&output->room);
    }
    pthread_mutex_unlock(&output->mutex);
    return NULL;
}

/* Starts the encoder threads with signals blocked, so that the caller's threads get them. */
static bool start_encoders(struct kiln_output *output, struct kiln_error *error)
{
    uint32_t count = output->format->one_file ? 1 : output->params.threads;
    count = count < 1 ? 1 : count > MAX_ENCODERS ? MAX_ENCODERS : count;
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int status = 0;
    while (output->encoder_count < count && status == 0) {
        status =
            pthread_create(&output->encoders[output->encoder_count], NULL, run_encoder, output);
        output->encoder_count += status == 0;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return output->encoder_count > 0 ||
           kiln_error_set_errno(error, KILN_DEVICE_FAILED, status, "no thread for the encoder");
}

static void stop_encoders(struct kiln_output *output)
{
    pthread_mutex_lock(&output->mutex);
    output->ending = true;
    pthread_cond_broadcast(&output->work);
    pthread_mutex_unlock(&output->mutex);
    for (uint32_t i = 0; i < output->encoder_count; i++)
        pthread_join(output->encoders[i], NULL);
    output->encoder_count = 0;
}

/* ---- The interface ------------------------------------------------------------------------ */

static struct kiln_output *create(const struct kiln_output_params *params, struct kiln_error *error)
{
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_output *output = arena ? kiln_arena_alloc(arena, 1, sizeof *output) : NULL;
    struct kiln_frame_range *ranges =
        output ? kiln_arena_alloc(arena, params->range_count, sizeof *ranges) : NULL;
    struct kiln_frame_range *clip =
        ranges ? kiln_arena_alloc(arena, params->clip_count, sizeof *clip) : NULL;
    char *path = clip ? kiln_arena_text(arena, params->path, strlen(params->path)) : NULL;
    char *hash =
        path ? kiln_arena_text(arena, params->scene_hash, strlen(params->scene_hash)) : NULL;
    const char *parts = params->parts;
    if (hash && parts && !(parts = kiln_arena_text(arena, parts, strlen(parts))))
        hash = NULL;
    if (!hash) {
        kiln_error_no_memory(error, "the output of %s", params->path);
        kiln_arena_destroy(&arena);
        return NULL;
    }
    memcpy(ranges, params->ranges, params->range_count * sizeof *ranges);
    output->arena = arena;
    output->params = *params;
    output->params.path = path;
    output->params.scene_hash = hash;
    output->params.parts = parts;
    output->params.ranges = ranges;
    memcpy(clip, params->clip, params->clip_count * sizeof *clip);
    output->params.clip = clip;
    output->due_frame = ranges[0].first;
    pthread_mutex_init(&output->mutex, NULL);
    pthread_mutex_init(&output->telling, NULL);
    pthread_cond_init(&output->work, NULL);
    pthread_cond_init(&output->room, NULL);
    return output;
}

static bool open_video(struct kiln_output *output, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!output->format->is_stream && (!file_of(output, 0, path, sizeof path) ||
                                       !kiln_temporary_open(&output->video_file, path, error)))
        return false;
    output->video_file.budget = output->params.budget;
    output->video_encoder = output->format->open(&output->params, &output->video_file, error);
    return output->video_encoder != NULL;
}

static const struct kiln_format *find_format(const struct kiln_output_params *params,
                                             struct kiln_error *error)
{
    if (params->stream.format)
        return &kiln_format_stream;
    const struct kiln_format *format = kiln_format_find(params->path, error);
    if (!format || params->flipbook.columns == 0)
        return format;
    if (format == &kiln_format_png)
        return &kiln_format_flipbook;
    kiln_error_set(error, KILN_USAGE, "%s: a flipbook is one .png file, not %s", params->path,
                   format->suffix);
    return NULL;
}

struct kiln_output_params kiln_output_complete(const struct kiln_output_params *params,
                                               struct kiln_error *error)
{
    struct kiln_output_params result = *params;
    result.format = find_format(params, error);
    const uint32_t uses = result.format ? result.format->uses : 0;
    if (!(uses & KILN_USES_PNG_BITS))
        result.png_bits = kiln_render_defaults().png_bits;
    if (!(uses & KILN_USES_PNG_EFFORT))
        result.png_effort = kiln_render_defaults().png_effort;
    if (!(uses & KILN_USES_EXR_BITS))
        result.exr_bits = kiln_render_defaults().exr_bits;
    if (!(uses & KILN_USES_QUALITY))
        result.quality = kiln_render_defaults().quality;
    if (result.clip_count == 0) {
        result.clip = result.ranges;
        result.clip_count = result.range_count;
    }
    return result;
}

static bool claim_frames(const struct kiln_output_params *params,
                         const struct kiln_path_pattern *pattern, struct kiln_claims *claims,
                         struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    for (size_t i = 0; i < params->range_count; i++) {
        const struct kiln_frame_range *range = &params->ranges[i];
        for (uint64_t frame = range->first; frame <= range->last; frame++) {
            if (!kiln_path_pattern_format(pattern, (uint32_t)frame, path, sizeof path))
                return kiln_error_set(error, KILN_USAGE, "%s: the path is too long", params->path);
            if (!kiln_claims_write(claims, path, "--output", error))
                return false;
            if (!pattern->numbered)
                return true;
        }
    }
    return true;
}

bool kiln_output_claim(const struct kiln_output_params *params, struct kiln_claims *claims,
                       struct kiln_error *error)
{
    const struct kiln_output_params complete = kiln_output_complete(params, error);
    const struct kiln_format *format = complete.format;
    params = &complete;
    struct kiln_path_pattern pattern;
    if (!format || !check_ranges(params, format, error) ||
        !kiln_path_pattern_parse(&pattern, params->path, kiln_output_numbering(params), error) ||
        !claim_frames(params, &pattern, claims, error))
        return false;
    const char *ending;
    for (uint32_t i = 0; format->beside && (ending = format->beside(params, i)); i++) {
        char path[KILN_PATH_SIZE], beside[KILN_PATH_SIZE];
        if (!kiln_path_pattern_format(&pattern, 0, path, sizeof path) ||
            !kiln_format_beside(path, ending, beside))
            return kiln_error_set(error, KILN_USAGE, "%s: the path is too long", params->path);
        if (!kiln_claims_write(claims, beside, "--output", error))
            return false;
    }
    return true;
}

static bool prepare_files(struct kiln_output *output, struct kiln_error *error)
{
    const struct kiln_output_params *params = &output->params;
    return kiln_path_pattern_parse(&output->pattern, params->path, kiln_output_numbering(params),
                                   error) &&
           check_files(output, error) && kiln_make_parent_folders(params->path, error) &&
           make_parts_folder(output, error) && sweep(output);
}

struct kiln_output *kiln_output_open(const struct kiln_output_params *params,
                                     struct kiln_error *error)
{
    const struct kiln_output_params complete = kiln_output_complete(params, error);
    const struct kiln_format *format = complete.format;
    params = &complete;
    if (!format || !check_ranges(params, format, error) || !format->check(params, error))
        return NULL;
    struct kiln_output *output = create(params, error);
    if (!output)
        return NULL;
    output->format = format;
    bool good = (format->is_stream || prepare_files(output, error)) &&
                (format->one_file && !params->parts ? open_video(output, error)
                                                    : check_folder(output, error)) &&
                start_encoders(output, error);
    if (!good)
        kiln_output_close(&output);
    return output;
}

struct kiln_output_needs kiln_output_needs(const struct kiln_output *output)
{
    return output->format->needs(&output->params);
}

/* Checks that the picture is of the expected frame, size and kind; encoders rely on it. */
static bool check_picture(const struct kiln_output *output, const struct kiln_picture *picture,
                          struct kiln_error *error)
{
    struct kiln_output_needs needs = kiln_output_needs(output);
    const struct kiln_output_params *params = &output->params;
    if (output->due_range >= params->range_count || picture->frame != output->due_frame)
        return kiln_error_set(error, KILN_USAGE, "%s: frame %u came where frame %u was expected",
                              params->path, picture->frame, output->due_frame);
    if (picture->width != params->width || picture->height != params->height ||
        (needs.bits > 0 && (picture->bits != needs.bits || !picture->display)) ||
        (needs.layers && picture->layer_count == 0))
        return kiln_error_set(error, KILN_USAGE,
                              "%s: frame %u is not of the announced kind or size", params->path,
                              picture->frame);
    return true;
}

static void advance(struct kiln_output *output)
{
    const struct kiln_frame_range *ranges = output->params.ranges;
    if (output->due_frame < ranges[output->due_range].last) {
        output->due_frame++;
    } else {
        output->due_range++;
        if (output->due_range < output->params.range_count)
            output->due_frame = ranges[output->due_range].first;
    }
}

bool kiln_output_write(struct kiln_output *output, struct kiln_picture *picture,
                       struct kiln_error *error)
{
    if (!check_picture(output, picture, error)) {
        kiln_picture_destroy(&picture);
        return false;
    }
    pthread_mutex_lock(&output->mutex);
    while (output->in_flight > output->encoder_count && !output->failed)
        pthread_cond_wait(&output->room, &output->mutex);
    bool good = !output->failed;
    if (good) {
        output->queue[(output->first + output->waiting) % QUEUE_SIZE] = picture;
        output->waiting++;
        output->in_flight++;
        pthread_cond_signal(&output->work);
        advance(output);
    } else {
        while (output->in_flight > 0) /* an earlier frame may still fail */
            pthread_cond_wait(&output->room, &output->mutex);
        *error = output->error;
    }
    pthread_mutex_unlock(&output->mutex);
    if (!good)
        kiln_picture_destroy(&picture);
    return good;
}

static void end_video(struct kiln_output *output)
{
    if (output->video_encoder)
        output->format->close(output->video_encoder);
    output->video_encoder = NULL;
    kiln_part_writer_close(&output->part);
    kiln_temporary_discard(&output->video_file);
}

static bool finish_video(struct kiln_output *output, struct kiln_error *error)
{
    const struct kiln_format *format = output->format;
    void *encoder = output->video_encoder;
    if (format->is_stream)
        return true;
    if (format->finish && !format->finish(encoder, &output->params.caller, error))
        return false;
    if (format->commit)
        return format->commit(encoder, error);
    return kiln_temporary_commit(&output->video_file, output->params.overwrite, error);
}

bool kiln_output_finish(struct kiln_output *output, struct kiln_error *error)
{
    stop_encoders(output);
    if (!output->failed && output->due_range < output->params.range_count) {
        output->failed = true;
        kiln_error_set(&output->error, KILN_USAGE, "%s: frame %u was never given",
                       output->params.path, output->due_frame);
    }
    bool good = !output->failed;
    if (!good)
        *error = output->error;
    if (output->format->one_file && output->video_encoder) {
        output->video_file.durable = output->params.durable;
        good = good && finish_video(output, error);
        end_video(output);
        good = good && tell_of_clip(output, error);
    }
    return good;
}

void kiln_output_close(struct kiln_output **output)
{
    struct kiln_output *closing = *output;
    if (!closing)
        return;
    *output = NULL;
    /* Images in the queue are still written. The frames of a video in the queue are dropped, since
     * its file is removed. */
    pthread_mutex_lock(&closing->mutex);
    closing->failed = closing->failed || closing->format->one_file;
    pthread_mutex_unlock(&closing->mutex);
    stop_encoders(closing);
    end_video(closing);
    pthread_cond_destroy(&closing->room);
    pthread_cond_destroy(&closing->work);
    pthread_mutex_destroy(&closing->mutex);
    pthread_mutex_destroy(&closing->telling);
    struct kiln_arena *arena = closing->arena;
    kiln_arena_destroy(&arena);
}
