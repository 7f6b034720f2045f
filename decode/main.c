/* This file is the program kiln-decode: it opens the libraries of one kind of files, confines
 * itself, and then decodes the files that kiln sends, one by one, until kiln's end of the socket
 * closes. Pictures and meshes are read as a whole; a video is read and sent frame by frame. */
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/ffmpeg.h"
#include "decode.h"

/* ---- the socket ------------------------------------------------------------------------------ */

/* Ignores the signals of kiln's terminal, since kiln decides when this process ends: it kills it,
 * and if kiln itself is killed, the kernel does, also while libraries are opened. Returns false if
 * kiln has not started this process, or has ended already. */
static bool begin_process(void)
{
    struct stat status;
    struct pollfd socket = {.fd = KILN_DECODE_SOCKET};
    static const int ignored[] = {SIGINT, SIGQUIT, SIGHUP, SIGPIPE};
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++)
        signal(ignored[i], SIG_IGN);
    return fstat(KILN_DECODE_SOCKET, &status) == 0 && S_ISSOCK(status.st_mode) &&
           prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0) == 0 && poll(&socket, 1, 0) == 0;
}

static void send_bytes(const void *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        const ssize_t sent = write(KILN_DECODE_SOCKET, (const char *)bytes + done, size - done);
        if (sent < 0 && errno == EINTR)
            continue;
        if (sent <= 0)
            _exit(0);
        done += (size_t)sent;
    }
}

static void send_answer(const struct kiln_decode_answer *answer)
{
    send_bytes(answer, sizeof *answer);
}

static void send_text(enum kiln_decode_what what, const char *text)
{
    struct kiln_decode_answer answer = {.what = (uint32_t)what};
    snprintf(answer.text, sizeof answer.text, "%s", text);
    send_answer(&answer);
}

static void send_failure(const struct kiln_error *error, const struct decode_picture *picture)
{
    struct kiln_decode_answer answer = {.what = KILN_DECODE_FAILED, .code = (int32_t)error->code};
    memcpy(answer.text, error->message, sizeof answer.text);
    if (picture) {
        answer.width = picture->width;
        answer.height = picture->height;
    }
    send_answer(&answer);
}

/* Receives bytes from kiln. Returns the descriptor that came with them, or -1. Ends the process
 * when kiln has ended. */
static int receive(void *bytes, size_t size)
{
    union {
        struct cmsghdr header;
        char room[CMSG_SPACE(sizeof(int))];
    } control;
    int file = -1;
    for (size_t done = 0; done < size;) {
        struct iovec part = {(char *)bytes + done, size - done};
        struct msghdr message = {.msg_iov = &part,
                                 .msg_iovlen = 1,
                                 .msg_control = control.room,
                                 .msg_controllen = sizeof control.room};
        const ssize_t got = recvmsg(KILN_DECODE_SOCKET, &message, MSG_CMSG_CLOEXEC);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            _exit(0);
        done += (size_t)got;
        const struct cmsghdr *with = CMSG_FIRSTHDR(&message);
        if (with && with->cmsg_type == SCM_RIGHTS && with->cmsg_len == CMSG_LEN(sizeof file))
            memcpy(&file, CMSG_DATA(with), sizeof file);
    }
    return file;
}

/* ---- what is asked for ----------------------------------------------------------------------- */

static unsigned char *read_file(int file, uint64_t most, size_t *size, struct kiln_error *error)
{
    const off_t end = lseek(file, 0, SEEK_END); /* fstat would need a call that also takes paths */
    if (end < 0 || (uint64_t)end > most) {
        kiln_error_set(error, KILN_IO,
                       "the file cannot be read, or became longer while it was read");
        return NULL;
    }
    *size = (size_t)end;
    unsigned char *bytes = malloc(*size + 1);
    size_t done = 0;
    if (!bytes)
        decode_out_of_memory(error);
    while (bytes && done < *size) {
        const ssize_t got = pread(file, bytes + done, *size - done, (off_t)done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0) {
            kiln_error_set(error, KILN_IO,
                           "the file cannot be read, or became shorter while it was read");
            free(bytes);
            return NULL;
        }
        done += (size_t)got;
    }
    return bytes;
}

/* Sends an image. answer: what is said of it besides. */
static void send_pixels(struct kiln_decode_answer *answer, const struct kiln_asset_image *image)
{
    answer->what = KILN_DECODE_PIXELS;
    answer->width = image->width;
    answer->height = image->height;
    answer->channels = image->channels;
    answer->type = image->type;
    answer->srgb = image->srgb;
    answer->premultiplied = image->premultiplied;
    send_answer(answer);
    send_bytes(image->pixels, kiln_asset_image_bytes(image));
}

static void send_image(const struct kiln_asset_image *image, uint32_t pages, const char *warning)
{
    struct kiln_decode_answer answer = {.pages = pages};
    snprintf(answer.text, sizeof answer.text, "%s", warning);
    send_pixels(&answer, image);
}

static void send_layer(void *user, const char *name, bool data, struct kiln_asset_image *image)
{
    (void)user;
    struct kiln_decode_answer answer = {.pages = 1, .data = data};
    snprintf(answer.text, sizeof answer.text, "%s", name);
    send_pixels(&answer, image);
    kiln_asset_image_destroy(&image);
}

static void send_picture_failure(const struct decode_picture *picture)
{
    if (picture->needs_other)
        send_text(KILN_DECODE_NEEDS_OTHER, "");
    else
        send_failure(picture->error, picture);
}

/* Sends a frame of an animation, and waits for no answer: the socket holds this process back. */
static bool send_frame(void *user, struct kiln_asset_image *image)
{
    (void)user;
    send_image(image, 1, "");
    kiln_asset_image_destroy(&image);
    return true;
}

/* Sends the frames of an animation as those of a video are sent. */
static void serve_frames(decode_frames *frames, struct decode_picture *picture)
{
    send_text(KILN_DECODE_READY, KILN_VERSION);
    if (frames(picture, send_frame, NULL))
        send_text(KILN_DECODE_END, "");
    else
        send_failure(picture->error, picture);
}

/* Sends the layers of a picture; KILN_DECODE_END follows. */
static void serve_layers(struct decode_picture *picture)
{
    if (decode_exr_layers(picture, send_layer, NULL))
        send_text(KILN_DECODE_END, "");
    else
        send_picture_failure(picture);
}

static void serve_one(struct decode_picture *picture)
{
    struct kiln_asset_image *image = decode_file(picture);
    if (image)
        send_image(image, picture->pages, picture->warning);
    else
        send_picture_failure(picture);
    kiln_asset_image_destroy(&image);
}

static void serve_picture(const struct kiln_decode_request *request, int file)
{
    struct kiln_error error = {0};
    struct decode_picture picture = {.format = (enum kiln_picture_format)request->format,
                                     .layer = request->layer,
                                     .most_pixels = request->most_pixels,
                                     .sky = request->sky,
                                     .raw = request->raw,
                                     .layers = request->layers,
                                     .page = request->page,
                                     .pages = 1,
                                     .error = &error};
    unsigned char *bytes = read_file(file, request->most_bytes, &picture.size, &error);
    decode_frames *frames = request->frames ? decode_frames_of(picture.format) : NULL;
    picture.bytes = bytes;
    if (!bytes)
        send_failure(&error, &picture);
    else if (frames)
        serve_frames(frames, &picture);
    else if (request->layers && picture.format == KILN_PICTURE_EXR)
        serve_layers(&picture);
    else
        serve_one(&picture);
    free(bytes);
}

static void serve_video(int file)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *image = NULL;
    struct decode_video *video = decode_video_open(file, &error);
    bool ok = video != NULL;
    if (ok)
        send_text(KILN_DECODE_READY, KILN_VERSION);
    do {
        ok = ok && decode_video_read(video, &image, &error);
        if (image)
            send_image(image, 1, "");
        else if (ok)
            send_text(KILN_DECODE_END, "");
        const bool more = image != NULL;
        kiln_asset_image_destroy(&image);
        if (!more)
            break;
    } while (ok);
    if (!ok)
        send_failure(&error, NULL);
    if (video)
        decode_video_close(&video);
}

/* Asks kiln for a file that a mesh names. */
static unsigned char *ask_for_file(void *user, enum kiln_companion kind, const char *name,
                                   size_t *size)
{
    (void)user;
    struct kiln_decode_file answer;
    struct kiln_error error = {0};
    struct kiln_decode_answer wish = {.what = KILN_DECODE_NEEDS_FILE, .companion = kind};
    snprintf(wish.text, sizeof wish.text, "%s", name);
    send_answer(&wish);
    const int file = receive(&answer, sizeof answer);
    unsigned char *bytes =
        answer.is_open && file >= 0 ? read_file(file, KILN_MAX_MESH_BYTES, size, &error) : NULL;
    if (file >= 0)
        close(file);
    return bytes;
}

static bool send_array(void *user, void *array, size_t bytes)
{
    (void)user;
    send_bytes(array, bytes);
    return true;
}

static void send_mesh(const struct kiln_decode_request *request, struct kiln_mesh_result *result)
{
    const struct kiln_skin_result *skin = &result->skin;
    const struct kiln_looks_result *looks = &result->looks;
    struct kiln_decode_answer answer = {.what = KILN_DECODE_MESH_MADE,
                                        .vertices = result->vertex_count,
                                        .triangles = result->triangle_count,
                                        .morph_targets = result->morph_target_count,
                                        .nodes = request->rig ? result->rig.node_count
                                                              : skin->node_count,
                                        .bones = skin->bone_count,
                                        .clips = skin->clip_count,
                                        .channels_of_clips = skin->channel_count,
                                        .keys = skin->key_count,
                                        .morphs = skin->morph_count,
                                        .morph_channels = skin->morph_channel_count,
                                        .deltas = skin->delta_count,
                                        .materials = looks->material_count,
                                        .textures = looks->texture_count,
                                        .texture_bytes = looks->byte_count,
                                        .has_uvs = looks->has_uvs,
                                        .has_second_uvs = looks->has_second_uvs,
                                        .has_colors = looks->has_colors};
    snprintf(answer.text, sizeof answer.text, "%s", result->notes);
    send_answer(&answer);
    kiln_mesh_visit_arrays(result, request, send_array, NULL);
}

static void serve_mesh(const struct kiln_decode_request *request, int file)
{
    struct kiln_error error = {0};
    struct decode_mesh mesh = {.format = (enum kiln_mesh_format)request->format,
                               .uvs = request->uvs,
                               .materials = request->materials,
                               .moving = request->moving,
                               .rig = request->rig,
                               .open = ask_for_file};
    unsigned char *bytes = read_file(file, request->most_bytes, &mesh.size, &error);
    /* This process has large pages (choose_environment of lib/asset/loader/helper.c). */
    struct kiln_mesh_result *result = bytes ? kiln_mesh_result_create(true) : NULL;
    bool needs_other = false;
    mesh.bytes = bytes;
    if (bytes && !result)
        decode_out_of_memory(&error);
    if (result && decode_mesh(&mesh, result, &needs_other, &error))
        send_mesh(request, result);
    else if (needs_other)
        send_text(KILN_DECODE_NEEDS_OTHER, "");
    else
        send_failure(&error, NULL);
    kiln_mesh_result_destroy(&result);
    free(bytes);
}

/* ---- the process ----------------------------------------------------------------------------- */

static bool open_libraries(enum kiln_decode_kind kind, struct kiln_error *error)
{
    struct kiln_error ignored = {0};
    switch (kind) {
    case KILN_DECODE_JPEG:
        return decode_jpeg_begin(error);
    case KILN_DECODE_TIFF:
        return decode_tiff_begin(error);
    case KILN_DECODE_PROFILE:
        /* Without libtiff no TIFF file gets here, and the others need not have it. */
        (void)decode_tiff_begin(&ignored);
        return decode_jpeg_begin(error) && decode_webp_begin(error) && decode_profile_begin(error);
    case KILN_DECODE_WEBP:
        return decode_webp_begin(error);
    case KILN_DECODE_PICTURE:
        return kiln_ffmpeg_open(KILN_FFMPEG_PICTURES, error);
    case KILN_DECODE_VIDEO:
        return kiln_ffmpeg_open(KILN_FFMPEG_CLIPS, error);
    case KILN_DECODE_DRACO:
        decode_mesh_begin();
        return decode_draco_begin(error);
    case KILN_DECODE_MESH:
        decode_mesh_begin();
        break;
    case KILN_DECODE_OPENEXR:
        return decode_exr_more_begin(error);
    case KILN_DECODE_PNG:
    case KILN_DECODE_EXR:
    case KILN_DECODE_KIND_COUNT:
        break;
    }
    return true; /* their libraries are small and linked */
}

static bool find_kind(const char *word, enum kiln_decode_kind *kind)
{
#define WORD(id, word) word,
    static const char *const words[] = {KILN_DECODE_KINDS(WORD)};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcmp(words[i], word) == 0) {
            *kind = (enum kiln_decode_kind)i;
            return true;
        }
    }
    return false;
}

/* Runs `kiln-decode KIND BYTES`, where BYTES is the most memory that it may take. */
int main(int argc, char **argv)
{
    enum kiln_decode_kind kind;
    struct kiln_error error = {0};
    if (argc != 3 || !find_kind(argv[1], &kind) || !begin_process()) {
        fprintf(stderr, "kiln-decode " KILN_VERSION " is a part of kiln, which starts it.\n");
        return KILN_USAGE;
    }
    if (!open_libraries(kind, &error) ||
        !decode_confine(kind, strtoull(argv[2], NULL, 10), &error)) {
        send_failure(&error, NULL);
        return (int)error.code;
    }
    send_text(KILN_DECODE_READY, KILN_VERSION);
    for (;;) {
        struct kiln_decode_request request;
        const int file = receive(&request, sizeof request);
        if (kind == KILN_DECODE_VIDEO)
            serve_video(file);
        else if (kind == KILN_DECODE_MESH || kind == KILN_DECODE_DRACO)
            serve_mesh(&request, file);
        else
            serve_picture(&request, file);
        close(file);
    }
}
