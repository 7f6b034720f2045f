/* Makes a clip of images that were drawn before. What kiln's own images say of themselves (scene,
 * seed, number, rate) goes into the clip, so that it has the same bytes as a clip that was drawn at
 * once. Images of light become colours by the rows of the composite stage (post/display.c). */
#include <dirent.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/order.h"
#include "base/sized.h"
#include "base/text.h"
#include "compare/footage.h"
#include "job/resume.h"
#include "job/stop.h"
#include "option/unit.h"
#include "output/carried.h"
#include "output/formats.h"
#include "output/video.h"
#include "post/display.h"

struct encode {
    const struct kiln_encode_params *params;
    struct kiln_stop stop;
    struct kiln_caller caller;
    struct kiln_threads *threads;
    struct kiln_footage *footage;
    uint32_t count;     /* the number of frames found */
    const char *before; /* name of the frame that was counted last */
    uint32_t read;      /* the number of frames read */
    uint32_t warned;    /* the number of frames whose files were warned of before a second start */
    struct kiln_output *output;
    enum kiln_tonemap tonemap;

    /* Properties of the first frame; all others must have the same. */
    char first[KILN_PATH_SIZE];
    struct kiln_carried carried;
    struct kiln_asset_image *image; /* its pixels are freed when the frame is written */
    uint32_t number, bits;

    bool takes_alpha; /* the clip's format has alpha */
    bool alpha;       /* so has the clip */
    bool begin_again; /* a frame is transparent, so that the clip needs alpha from its start */
};

static bool has_channel(const struct kiln_asset_image *image)
{
    return image->channels == 2 || image->channels == 4;
}

/* Returns whether some pixel of an image is not opaque. */
static bool is_transparent(const struct kiln_asset_image *image)
{
    const uint8_t *bytes = image->pixels;
    const uint16_t *words = image->pixels;
    const float *floats = image->pixels;
    const size_t count = (size_t)image->width * image->height;
    for (size_t i = 3; has_channel(image) && i < 4 * count; i += 4) {
        if (image->type == KILN_IMAGE_U8    ? bytes[i] < 255
            : image->type == KILN_IMAGE_U16 ? words[i] < 65535
                                            : floats[i] < 1.0f)
            return true;
    }
    return false;
}

/* Returns whether a clip should have alpha because of an image. kiln's EXR images always have the
 * channel and say whether it counts, since smoke may cover all of a frame. In other EXR images it
 * counts where a pixel is not covered. */
static bool wants_alpha(const struct kiln_asset_image *image, const struct kiln_carried *carried)
{
    if (image->type != KILN_IMAGE_F32 || !has_channel(image))
        return has_channel(image);
    return *carried->alpha ? *carried->alpha == '1' : is_transparent(image);
}

/* ---- finding the frames ---------------------------------------------------------------------- */

/* Counts a frame, and warns where the names of a folder leave out numbers. */
static bool count_frame(void *user, const struct kiln_footage_frame *frame)
{
    struct encode *encode = user;
    const uint32_t gap = encode->before ? kiln_order_gap(encode->before, frame->name) : 0;
    if (gap > 0 && !encode->begin_again &&
        kiln_footage_kind(encode->footage) == KILN_FOOTAGE_FOLDER)
        kiln_log_write(&encode->params->log, KILN_LOG_WARNING,
                       "%s: %u number%s missing between %s and %s", encode->params->frames, gap,
                       gap > 1 ? "s are" : " is", encode->before, frame->name);
    encode->before = frame->name;
    encode->count++;
    return true;
}

/* Multiplies light by alpha where the file has it straight, as TIFF files may. */
static void multiply_light(struct kiln_asset_image *image)
{
    float *pixels = image->pixels;
    const size_t count = (size_t)image->width * image->height;
    if (image->type != KILN_IMAGE_F32 || image->premultiplied)
        return;
    for (size_t i = 0; i < 4 * count; i += 4) {
        for (size_t c = 0; c < 3; c++)
            pixels[i + c] *= pixels[i + 3];
    }
    image->premultiplied = true;
}

/* Reads the next image, what it says of itself, and the number of its frame. */
static struct kiln_asset_image *read_frame(struct encode *encode, char path[KILN_PATH_SIZE],
                                           struct kiln_carried *carried, uint32_t *number,
                                           struct kiln_error *error)
{
    struct kiln_footage_frame frame = {NULL, 0};
    uint64_t said;
    if (!kiln_footage_peek(encode->footage, &frame) ||
        !kiln_footage_file(encode->footage, path, error))
        return NULL;
    if (encode->read++ == encode->warned)
        kiln_footage_set_log(encode->footage, &encode->params->log);
    struct kiln_asset_image *image = kiln_footage_take(encode->footage, error);
    struct kiln_error reason = {0};
    if (!image)
        return NULL;
    multiply_light(image);
    if (!kiln_carried_read(path, carried, &reason) && reason.code == KILN_DEVICE_FAILED) {
        *error = reason;
        kiln_asset_image_destroy(&image);
        return NULL;
    }
    const bool says = kiln_text_to_uint64(carried->frame, &said) && said <= UINT32_MAX;
    *number = says ? (uint32_t)said : frame.number;
    return image;
}

/* Checks --tonemap: float images need a tone mapping, and images of colours must have none. */
static bool check_tonemap(struct encode *encode, struct kiln_error *error)
{
    const char *name = encode->params->tonemap;
    const bool is_light = encode->image->type == KILN_IMAGE_F32;
    if (is_light && !name)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the image is linear light; choose by --tonemap (none, agx or "
                              "aces) how it becomes colours",
                              encode->first);
    if (!is_light && (name || encode->params->exposure != 0.0f))
        return kiln_error_set(error, KILN_USAGE,
                              "--%s: not allowed; %s has colours already, not linear light",
                              name ? "tonemap" : "exposure", encode->first);
    return !name || kiln_tonemap_find(name, &encode->tonemap) ||
           kiln_error_set(error, KILN_USAGE, "--tonemap %s: expected none, agx or aces", name);
}

static bool open_frames(struct encode *encode, struct kiln_error *error)
{
    encode->footage = kiln_footage_open(encode->params->frames, "beauty", error);
    if (!encode->footage)
        return false;
    if (kiln_footage_kind(encode->footage) == KILN_FOOTAGE_VIDEO)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: is a video; expected images: a folder, or a pattern such as "
                              "frame_%%04d.png",
                              encode->params->frames);
    kiln_footage_visit(encode->footage, count_frame, encode);
    encode->image = read_frame(encode, encode->first, &encode->carried, &encode->number, error);
    if (!encode->image)
        return false;
    encode->bits = encode->image->type == KILN_IMAGE_U16 ? 16 : 8;
    encode->alpha = encode->begin_again || wants_alpha(encode->image, &encode->carried);
    return check_tonemap(encode, error);
}

/* ---- opening the clip ------------------------------------------------------------------------ */

static bool find_rate(const struct encode *encode, uint64_t *num, uint64_t *den,
                      struct kiln_error *error)
{
    const char *text = encode->params->fps ? encode->params->fps : encode->carried.fps;
    if (kiln_unit_parse_rational(text, num, den) && *num >= *den && *num <= *den * KILN_MAX_RATE)
        return true;
    if (encode->params->fps)
        return kiln_error_set(error, KILN_USAGE,
                              "--fps %s: expected a rate from 1 to %d, such as 30, 29.97 or "
                              "30000/1001",
                              text, KILN_MAX_RATE);
    return kiln_error_set(error, KILN_USAGE, "%s: the image %s; give the rate with --fps",
                          encode->first,
                          *text ? "has a rate that no clip can have" : "does not say its rate");
}

/* Returns the hash of the scene that an image names, or "" where it is no hash: any program may
 * have written the file. */
static const char *scene_of(const struct kiln_carried *carried)
{
    const bool is_hash = strspn(carried->scene, "0123456789abcdef") == 64;
    return is_hash ? carried->scene : "";
}

static bool check_format(const struct kiln_output_params *files, struct kiln_error *error)
{
    if (!files->format)
        return false;
    return files->format->video || kiln_error_set(error, KILN_USAGE,
                                                  "%s: %s are not a clip; expected .mp4, "
                                                  ".webm, .mkv, .mov, .gif, .apng or .webp",
                                                  files->path, files->format->name);
}

/* Claims all files, so that the clip replaces no image that is read. */
static bool claim(const struct encode *encode, const struct kiln_output_params *files,
                  struct kiln_error *error)
{
    struct kiln_claims *claims = kiln_claims_create();
    if (!claims)
        return kiln_error_no_memory(error, "%s", files->path);
    const bool ok = kiln_footage_claim(encode->footage, encode->params->frames, claims, error) &&
                    kiln_output_claim(files, claims, error);
    kiln_claims_destroy(&claims);
    return ok;
}

/* Finds the journal of the job that drew the images, beside them or in their folder. */
static bool find_job(const struct encode *encode, struct kiln_journal_head *head,
                     struct kiln_arena *arena)
{
    static const char suffix[] = ".journal";
    struct kiln_error ignored = {0};
    struct dirent **entries = NULL;
    bool found = false;
    if (kiln_footage_kind(encode->footage) == KILN_FOOTAGE_NUMBERED)
        return kiln_journal_find(encode->params->frames, head, arena, &ignored);
    const int count = scandir(encode->params->frames, &entries, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        const size_t length = strlen(entries[i]->d_name);
        char path[KILN_PATH_SIZE];
        if (!found && length > strlen(suffix) &&
            strcmp(entries[i]->d_name + length - strlen(suffix), suffix) == 0 &&
            kiln_path_join(path, encode->params->frames, entries[i]->d_name, &ignored)) {
            path[strlen(path) - strlen(suffix)] = '\0';
            found = kiln_journal_find(path, head, arena, &ignored);
        }
        free(entries[i]);
    }
    free(entries);
    return found;
}

/* Warns when the job that drew the images has not ended: then frames are missing. */
static void warn_of_missing(const struct encode *encode)
{
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_journal_head head;
    const uint32_t last = encode->number + encode->count - 1;
    if (arena && find_job(encode, &head, arena)) {
        const struct kiln_output_params *job = &head.output;
        const uint32_t job_first = job->clip[0].first,
                       job_last = job->clip[job->clip_count - 1].last;
        if (job_first < encode->number || job_last > last)
            kiln_log_write(&encode->params->log, KILN_LOG_WARNING,
                           "%s: the job has frames %u-%u, but only %u-%u are here",
                           encode->params->frames, job_first, job_last, encode->number, last);
    }
    kiln_arena_destroy(&arena);
}

static void warn_of_depth(const struct encode *encode)
{
    const uint32_t wanted = kiln_output_needs(encode->output).bits;
    if (encode->image->type != KILN_IMAGE_F32 && encode->bits != wanted)
        kiln_log_write(&encode->params->log, KILN_LOG_WARNING,
                       "%s: the images have %u bits a channel, but %s takes %u: the clip differs a "
                       "little from one that is rendered at once",
                       encode->first, encode->bits, encode->params->output, wanted);
}

/* Checks that the clip can have what is transparent in an image. If only its beginning lacks alpha,
 * begin_again is set with the error. */
static bool check_alpha(struct encode *encode, const struct kiln_asset_image *image,
                        const char *path, struct kiln_error *error)
{
    if (encode->alpha || !is_transparent(image))
        return true;
    encode->begin_again = encode->takes_alpha;
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: the image is transparent in places, and %s has no alpha; expected "
                          ".webm, .mkv, .mov, .apng or .webp",
                          path, encode->params->output);
}

static bool open_clip(struct encode *encode, struct kiln_error *error)
{
    const struct kiln_encode_params *params = encode->params;
    const struct kiln_asset_image *image = encode->image;
    uint64_t num = 0, den = 1, seed = 0;
    if (!find_rate(encode, &num, &den, error))
        return false;
    if (encode->number > UINT32_MAX - encode->count)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: %u frames from number %u on",
                              encode->first, encode->count, encode->number);
    const bool has_seed = kiln_text_to_uint64(encode->carried.seed, &seed) && seed <= UINT32_MAX;
    const struct kiln_frame_range range = {encode->number, encode->number + encode->count - 1};
    const struct kiln_output_params clip = {
        .path = params->output,
        .width = image->width,
        .height = image->height,
        .fps_num = (uint32_t)num,
        .fps_den = (uint32_t)den,
        .ranges = &range,
        .range_count = 1,
        .clip = &range,
        .clip_count = 1,
        .threads = 1,
        .overwrite = params->overwrite,
        .png_bits = encode->bits,
        .quality = params->quality,
        .scene_hash = has_seed ? scene_of(&encode->carried) : "",
        .seed = (uint32_t)seed,
        .log = params->log,
        .budget = params->budget,
        .caller = kiln_stop_caller(&encode->stop),
    };
    struct kiln_output_params files = kiln_output_complete(&clip, error);
    if (!check_format(&files, error))
        return false;
    encode->takes_alpha = kiln_video_has_alpha(&files);
    encode->alpha = encode->alpha && encode->takes_alpha;
    files.alpha = encode->alpha;
    if (!check_alpha(encode, image, encode->first, error) || !claim(encode, &files, error) ||
        !kiln_resume_clear(&files, error))
        return false;
    encode->output = kiln_output_open(&files, error);
    if (!encode->output)
        return false;
    warn_of_depth(encode);
    warn_of_missing(encode);
    return true;
}

/* ---- frame by frame -------------------------------------------------------------------------- */

static const char *name_type(const struct kiln_asset_image *image)
{
    static const char *const names[] = {
        [KILN_IMAGE_U8] = "8 bits", [KILN_IMAGE_U16] = "16 bits", [KILN_IMAGE_F32] = "floats"};
    return names[image->type];
}

/* Checks that a frame has the size and type, and is of the scene and seed, of the first frame, and
 * that its alpha fits into the clip. */
static bool check_frame(struct encode *encode, const struct kiln_asset_image *image,
                        const struct kiln_carried *carried, const char *path,
                        struct kiln_error *error)
{
    const struct kiln_asset_image *first = encode->image;
    if (image->width != first->width || image->height != first->height)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: %u x %u pixels; %s has %u x %u", path,
                              image->width, image->height, encode->first, first->width,
                              first->height);
    if (image->type != first->type)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the image has %s a channel; %s has %s", path, name_type(image),
                              encode->first, name_type(first));
    if (!check_alpha(encode, image, path, error))
        return false;
    if (strcmp(carried->scene, encode->carried.scene) == 0 &&
        strcmp(carried->seed, encode->carried.seed) == 0)
        return true;
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          *carried->scene ? "%s: the image belongs to another scene or seed than %s"
                                          : "%s: the image does not name its scene, but %s does",
                          path, encode->first);
}

/* Copies all channels, converted to as many bits as the picture has. */
static void copy_channels(const struct kiln_asset_image *image, struct kiln_picture *picture)
{
    const size_t count = (size_t)image->width * image->height * 4;
    const uint8_t *bytes = image->pixels;
    const uint16_t *words = image->pixels;
    if ((image->type == KILN_IMAGE_U16) == (picture->bits == 16)) {
        memcpy(picture->display, image->pixels, count * (picture->bits / 8));
    } else if (picture->bits == 16) {
        for (size_t i = 0; i < count; i++)
            ((uint16_t *)picture->display)[i] = (uint16_t)(bytes[i] * 257);
    } else {
        for (size_t i = 0; i < count; i++)
            ((uint8_t *)picture->display)[i] = (uint8_t)((words[i] + 128) / 257);
    }
}

/* Divides colours by their alpha, where a file has them multiplied. Colour brighter than its alpha
 * has its brightness as alpha, so that the picture over black stays as it is. */
static void make_straight(struct kiln_picture *picture)
{
    const size_t count = (size_t)picture->width * picture->height;
    const uint32_t full = picture->bits == 16 ? 65535 : 255;
    uint8_t *bytes = picture->display;
    uint16_t *words = picture->display;
    for (size_t i = 0; i < 4 * count; i += 4) {
        uint32_t values[4], alpha = 0;
        for (size_t c = 0; c < 4; c++) {
            values[c] = picture->bits == 16 ? words[i + c] : bytes[i + c];
            alpha = values[c] > alpha ? values[c] : alpha;
        }
        for (size_t c = 0; c < 4; c++) {
            const uint64_t product = (uint64_t)values[c] * full + alpha / 2;
            const uint32_t straight = c == 3 || alpha == 0 ? alpha : (uint32_t)(product / alpha);
            if (picture->bits == 16)
                words[i + c] = (uint16_t)straight;
            else
                bytes[i + c] = (uint8_t)straight;
        }
    }
}

static bool fill(const struct encode *encode, const struct kiln_asset_image *image,
                 struct kiln_picture *picture, struct kiln_error *error)
{
    if (image->type == KILN_IMAGE_F32) {
        const struct kiln_display_params display = {
            .width = image->width,
            .height = image->height,
            .bits = picture->bits,
            .exposure = encode->params->exposure,
            .tonemap = encode->tonemap,
            .texture = kiln_output_needs(encode->output).texture,
            .frame = picture->frame,
        };
        return kiln_display_make(encode->threads, &display, image->pixels, picture->display, error);
    }
    copy_channels(image, picture);
    if (image->premultiplied)
        make_straight(picture);
    return true;
}

static bool write_frame(struct encode *encode, const struct kiln_asset_image *image,
                        uint32_t number, struct kiln_error *error)
{
    const uint32_t bits = kiln_output_needs(encode->output).bits;
    struct kiln_picture *picture =
        kiln_picture_create(image->width, image->height, bits, NULL, NULL, 0, error);
    if (!picture)
        return false;
    picture->frame = number;
    picture->has_alpha = encode->alpha;
    if (fill(encode, image, picture, error))
        return kiln_output_write(encode->output, picture, error);
    kiln_picture_destroy(&picture);
    return false;
}

/* Reads, checks and writes the frame that is due. */
static bool add_frame(struct encode *encode, uint32_t due, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct kiln_carried carried;
    uint32_t number = 0;
    struct kiln_asset_image *image = read_frame(encode, path, &carried, &number, error);
    bool ok = image != NULL;
    if (ok && number != due)
        ok = kiln_error_set(error, KILN_INVALID_INPUT,
                            "%s: found frame %u where frame %u must follow; a clip leaves out no "
                            "frame, and takes the files of a folder in the order of their names",
                            path, number, due);
    ok = ok && check_frame(encode, image, &carried, path, error) &&
         write_frame(encode, image, number, error);
    kiln_asset_image_destroy(&image);
    return ok;
}

static void tell(const struct encode *encode, uint32_t done, double started_s)
{
    struct kiln_progress progress = {
        .size = sizeof progress,
        .frame = encode->number + done - 1,
        .done = done,
        .total = encode->count,
        .elapsed_s = kiln_clock_seconds() - started_s,
    };
    progress.eta_s = progress.elapsed_s / done * (encode->count - done);
    if (encode->params->progress)
        encode->params->progress(encode->params->user, &progress);
}

static bool run(struct encode *encode, double started_s, struct kiln_error *error)
{
    encode->threads = kiln_threads_create(encode->params->threads);
    if (!encode->threads)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "no threads can be started");
    kiln_threads_set_caller(encode->threads, &encode->caller);
    if (!open_frames(encode, error) || !open_clip(encode, error) ||
        !write_frame(encode, encode->image, encode->number, error))
        return false;
    free(encode->image->pixels);
    encode->image->pixels = NULL;
    tell(encode, 1, started_s);
    for (uint32_t done = 1; done < encode->count; done++) {
        if (!kiln_stop_ask(&encode->stop, error) ||
            !add_frame(encode, encode->number + done, error))
            return false;
        tell(encode, done + 1, started_s);
    }
    return kiln_output_finish(encode->output, error);
}

static void finish(struct encode *encode)
{
    kiln_output_close(&encode->output);
    kiln_asset_image_destroy(&encode->image);
    kiln_footage_close(&encode->footage);
    kiln_threads_destroy(&encode->threads);
}

bool kiln_encode(const struct kiln_encode_params *given, struct kiln_frame_range *frames,
                 struct kiln_error *error)
{
    struct kiln_encode_params params = kiln_encode_defaults();
    if (!kiln_sized_take(&params, given, "kiln_encode_params", error))
        return false;
    struct encode encode = {.params = &params,
                            .stop = {params.stop, params.user, NULL, params.budget, params.cancel}};
    encode.caller = kiln_stop_caller(&encode.stop);
    bool ok = run(&encode, kiln_clock_seconds(), error);
    if (!ok && encode.begin_again) {
        finish(&encode);
        encode.count = 0;
        encode.before = NULL;
        encode.warned = encode.read;
        encode.read = 0;
        *error = (struct kiln_error){0};
        ok = run(&encode, kiln_clock_seconds(), error);
    }
    *frames = (struct kiln_frame_range){encode.number, encode.number + encode.count - 1};
    finish(&encode);
    return ok;
}
