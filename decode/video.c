/* This file demuxes and decodes videos by FFmpeg. A file that ends too early or has a damaged
 * frame, which FFmpeg accepts silently, is an error here, since a comparison must not pass on
 * missing frames. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "avframe.h"
#include "base/error.h"
#include "base/ffmpeg.h"
#include "decode.h"

#define ALLOWED "MP4, MOV, Matroska, WebM, AVI, GIF, APNG or animated WebP"

enum { IO_BUFFER_SIZE = 1 << 16, MAX_STREAMS = 32, PROBE_BYTES = 5000000 };

struct decode_video {
    struct kiln_error *error; /* the error of the present call */
    bool reported;
    struct kiln_avlog avlog;
    int file;
    int64_t size;
    AVIOContext *io;
    AVFormatContext *container;
    AVCodecContext *decoder;
    AVPacket *packet;
    AVFrame *frame;
    int stream;
    int64_t packets;
    bool has_frames;
    bool drained; /* the decoder was told that no more packets come */
};

static bool fail(struct decode_video *video, enum kiln_code code, const char *what)
{
    if (video->reported)
        return false;
    video->reported = true;
    const char *detail = video->avlog.first_error;
    return kiln_error_set(video->error, code, "%s%s%s%s", what, *detail ? " (" : "", detail,
                          *detail ? ")" : "");
}

static bool fail_memory(struct decode_video *video)
{
    video->reported = true;
    return decode_out_of_memory(video->error);
}

static bool fail_status(struct decode_video *video, int status, const char *what)
{
    if (status == AVERROR(ENOMEM))
        return fail_memory(video);
    return fail(video, KILN_INVALID_INPUT, what);
}

/* ---- Opening ------------------------------------------------------------------------------ */

static int read_bytes(void *opaque, uint8_t *buffer, int size)
{
    const struct decode_video *video = opaque;
    ssize_t got;
    do {
        got = read(video->file, buffer, (size_t)size);
    } while (got < 0 && errno == EINTR);
    return got > 0 ? (int)got : got == 0 ? AVERROR_EOF : AVERROR(errno);
}

static int64_t seek_bytes(void *opaque, int64_t offset, int whence)
{
    const struct decode_video *video = opaque;
    if (whence == AVSEEK_SIZE)
        return video->size;
    off_t at = lseek(video->file, offset, whence & ~AVSEEK_FORCE);
    return at >= 0 ? at : AVERROR(errno);
}

static int refuse_file(AVFormatContext *container, AVIOContext **io, const char *url, int flags,
                       AVDictionary **options)
{
    (void)container;
    (void)io;
    (void)url;
    (void)flags;
    (void)options;
    return AVERROR(EPERM);
}

static bool open_container(struct decode_video *video)
{
    unsigned char *buffer = kiln_ff.av_malloc(IO_BUFFER_SIZE);
    video->io = buffer ? kiln_ff.avio_alloc_context(buffer, IO_BUFFER_SIZE, 0, video, read_bytes,
                                                    NULL, seek_bytes)
                       : NULL;
    video->container = kiln_ff.avformat_alloc_context();
    if (!video->io || !video->container) {
        if (!video->io)
            kiln_ff.av_free(buffer);
        return fail_memory(video);
    }
    video->container->pb = video->io;
    video->container->flags |= AVFMT_FLAG_CUSTOM_IO; /* this file closes the io in any case */
    video->container->io_open = refuse_file;
    video->container->max_streams = MAX_STREAMS;
    video->container->probesize = PROBE_BYTES;
    AVDictionary *options = NULL;
    /* If memory is too short for the lists of what is allowed, the file must not be opened. */
    int status = kiln_ff.av_dict_set(&options, "format_whitelist",
                                     "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,gif,apng", 0);
    if (status >= 0)
        status = kiln_ff.av_dict_set(&options, "protocol_whitelist", "file", 0);
    if (status >= 0)
        status = kiln_ff.avformat_open_input(&video->container, NULL, NULL, &options);
    kiln_ff.av_dict_free(&options);
    if (status < 0)
        return fail_status(video, status, "the file is not a video; allowed are " ALLOWED " files");
    status = kiln_ff.avformat_find_stream_info(video->container, NULL);
    return status >= 0 || fail_status(video, status, "the video is broken or cut short");
}

static uint64_t big_endian(const unsigned char *bytes, int count)
{
    uint64_t value = 0;
    for (int i = 0; i < count; i++)
        value = value << 8 | bytes[i];
    return value;
}

/* Returns whether the file ends with these bytes. */
static bool ends_with(const struct decode_video *video, const char *end, size_t size)
{
    char found[16];
    return pread(video->file, found, size, video->size - (int64_t)size) == (ssize_t)size &&
           memcmp(found, end, size) == 0;
}

/* Checks that a file is whole, since FFmpeg accepts a file that is cut short. MP4 and MOV are a row
 * of boxes, each with its size; AVI is one chunk with its size; GIF and APNG have a last block.
 * Matroska's demuxer reports a missing end itself. */
static bool is_whole(const struct decode_video *video)
{
    unsigned char b[16];
    if (strcmp(video->container->iformat->name, "gif") == 0)
        return ends_with(video, ";", 1);
    if (strcmp(video->container->iformat->name, "apng") == 0)
        return ends_with(video, "IEND\xae\x42\x60\x82", 8);
    if (pread(video->file, b, sizeof b, 0) == sizeof b && memcmp(b, "RIFF", 4) == 0) {
        const unsigned char size[4] = {b[7], b[6], b[5], b[4]};
        return (int64_t)big_endian(size, 4) + 8 <= video->size;
    }
    if (!strstr(video->container->iformat->name, "mp4"))
        return true;
    for (int64_t at = 0; at < video->size;) {
        ssize_t got = pread(video->file, b, sizeof b, at);
        uint64_t size = got >= 8 ? big_endian(b, 4) : 2;
        if (size == 0) /* up to the end of the file */
            return true;
        if (size == 1 && got == sizeof b)
            size = big_endian(b + 8, 8);
        if (size < 8 || size > (uint64_t)(video->size - at))
            return false;
        at += (int64_t)size;
    }
    return true;
}

/* Checks the size and takes the memory of the pixels. The decoder calls it once it knows the size.
 */
static int get_buffer(AVCodecContext *decoder, AVFrame *frame, int flags)
{
    struct decode_video *video = decoder->opaque;
    if (frame->width < 1 || frame->height < 1 || frame->width > KILN_MAX_IMAGE_EDGE ||
        frame->height > KILN_MAX_IMAGE_EDGE ||
        (int64_t)frame->width * frame->height > KILN_MAX_IMAGE_PIXELS) {
        char what[160];
        snprintf(what, sizeof what,
                 "the video has %d x %d pixels; allowed are 1 to %d a side and at most %d in all",
                 frame->width, frame->height, KILN_MAX_IMAGE_EDGE, KILN_MAX_IMAGE_PIXELS);
        fail(video, KILN_INVALID_INPUT, what);
        return AVERROR(EINVAL);
    }
    return kiln_ff.avcodec_default_get_buffer2(decoder, frame, flags);
}

/* Chooses libvpx for VP9 with alpha, if it is there. The alpha of a WebM video is a second stream,
 * which FFmpeg's own decoder of VP9 leaves out. */
static const AVCodec *choose_decoder(const struct decode_video *video, const AVCodec *codec)
{
    const AVStream *stream = video->container->streams[video->stream];
    const AVDictionaryEntry *alpha = kiln_ff.av_dict_get(stream->metadata, "alpha_mode", NULL, 0);
    const AVCodec *other = alpha && strcmp(alpha->value, "1") == 0 && codec->id == AV_CODEC_ID_VP9
                               ? kiln_ff.avcodec_find_decoder_by_name("libvpx-vp9")
                               : NULL;
    return other ? other : codec;
}

static bool open_decoder(struct decode_video *video)
{
    const AVCodec *codec = NULL;
    video->stream =
        kiln_ff.av_find_best_stream(video->container, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (video->stream < 0 || !codec)
        return fail(video, KILN_INVALID_INPUT,
                    "the file has no video stream that this FFmpeg can decode");
    for (unsigned i = 0; i < video->container->nb_streams; i++) {
        if ((int)i != video->stream)
            video->container->streams[i]->discard = AVDISCARD_ALL;
    }
    video->decoder = kiln_ff.avcodec_alloc_context3(choose_decoder(video, codec));
    video->packet = kiln_ff.av_packet_alloc();
    video->frame = kiln_ff.av_frame_alloc();
    if (!video->decoder || !video->packet || !video->frame)
        return fail_memory(video);
    int status = kiln_ff.avcodec_parameters_to_context(
        video->decoder, video->container->streams[video->stream]->codecpar);
    video->decoder->opaque = video;
    video->decoder->get_buffer2 = get_buffer;
    decode_same_everywhere(video->decoder);
    video->decoder->thread_count = 1; /* the messages and the limits stay on this thread */
    video->decoder->max_pixels = KILN_MAX_IMAGE_PIXELS;
    video->decoder->err_recognition =
        AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
    if (status >= 0)
        status = kiln_ff.avcodec_open2(video->decoder, NULL, NULL);
    return status >= 0 || fail_status(video, status, "the video decoder does not start");
}

struct decode_video *decode_video_open(int file, struct kiln_error *error)
{
    struct decode_video *video = calloc(1, sizeof *video);
    if (!video) {
        decode_out_of_memory(error);
        return NULL;
    }
    *video = (struct decode_video){.error = error, .file = file, .size = lseek(file, 0, SEEK_END)};
    lseek(file, 0, SEEK_SET);
    kiln_avlog_begin(&video->avlog);
    bool ok = video->size > 0 || fail(video, KILN_INVALID_INPUT, "the video file is empty");
    ok = ok && open_container(video) &&
         (is_whole(video) || fail(video, KILN_INVALID_INPUT, "the video is cut short")) &&
         open_decoder(video);
    kiln_avlog_end(&video->avlog);
    if (!ok)
        decode_video_close(&video);
    return video;
}

void decode_video_close(struct decode_video **video)
{
    struct decode_video *closing = *video;
    if (!closing)
        return;
    *video = NULL;
    kiln_avlog_begin(&closing->avlog);
    kiln_ff.av_frame_free(&closing->frame);
    kiln_ff.av_packet_free(&closing->packet);
    kiln_ff.avcodec_free_context(&closing->decoder);
    kiln_ff.avformat_close_input(&closing->container);
    if (closing->io)
        kiln_ff.av_freep(&closing->io->buffer);
    kiln_ff.avio_context_free(&closing->io);
    kiln_avlog_end(&closing->avlog);
    free(closing);
}

/* ---- Reading ------------------------------------------------------------------------------ */

/* Checks that all packets were read. MP4 and MOV state their number. */
static bool check_end(struct decode_video *video)
{
    const AVStream *stream = video->container->streams[video->stream];
    bool counted = strstr(video->container->iformat->name, "mp4") != NULL;
    int64_t expected = counted ? kiln_ff.avformat_index_get_entries_count(stream) : 0;
    return video->packets >= expected || fail(video, KILN_INVALID_INPUT, "the video is cut short");
}

/* Gives the decoder the next packet of the stream, or tells it that none is left. */
static bool feed(struct decode_video *video)
{
    int status;
    do {
        kiln_ff.av_packet_unref(video->packet);
        status = kiln_ff.av_read_frame(video->container, video->packet);
    } while (status >= 0 && video->packet->stream_index != video->stream);
    if (status < 0 && status != AVERROR_EOF)
        return fail_status(video, status, "the video is broken or cut short");
    if (status == AVERROR_EOF) {
        video->drained = true;
        if (!check_end(video))
            return false;
        status = kiln_ff.avcodec_send_packet(video->decoder, NULL);
    } else {
        video->packets++;
        if (video->packet->flags & AV_PKT_FLAG_CORRUPT)
            return fail(video, KILN_INVALID_INPUT, "the video is broken or cut short");
        status = kiln_ff.avcodec_send_packet(video->decoder, video->packet);
    }
    return status >= 0 || fail_status(video, status, "the video has a broken frame");
}

static bool receive(struct decode_video *video, struct kiln_asset_image **image)
{
    int status = kiln_ff.avcodec_receive_frame(video->decoder, video->frame);
    while (status == AVERROR(EAGAIN) && !video->drained) {
        if (!feed(video))
            return false;
        status = kiln_ff.avcodec_receive_frame(video->decoder, video->frame);
    }
    if (video->avlog.first_error[0] || (status < 0 && status != AVERROR_EOF))
        return fail_status(video, status, "the video is broken or cut short");
    if (status == AVERROR_EOF)
        return video->has_frames || fail(video, KILN_INVALID_INPUT, "the video has no frames");
    if (video->frame->decode_error_flags || (video->frame->flags & AV_FRAME_FLAG_CORRUPT))
        return fail(video, KILN_INVALID_INPUT, "the video has a broken frame");
    video->has_frames = true;
    const char *problem = NULL;
    enum kiln_code code = decode_avframe(video->frame, image, &problem);
    if (code == KILN_OK && video->decoder->codec_id == AV_CODEC_ID_GIF)
        decode_find_alpha(*image); /* FFmpeg gives every GIF an alpha */
    if (code == KILN_DEVICE_FAILED)
        return fail_memory(video);
    return code == KILN_OK || fail(video, code, problem);
}

bool decode_video_read(struct decode_video *video, struct kiln_asset_image **image,
                       struct kiln_error *error)
{
    *image = NULL;
    video->error = error;
    video->reported = false;
    kiln_avlog_begin(&video->avlog);
    bool ok = receive(video, image);
    kiln_avlog_end(&video->avlog);
    return ok;
}
