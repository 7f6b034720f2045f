/* Writes containers of clips by FFmpeg. Neither the time nor the place of
 * writing goes into them. */
#include "output/muxer.h"

#include <string.h>

enum { IO_BUFFER_SIZE = 1 << 17 };

static int write_bytes(void *opaque, uint8_t *bytes, int size)
{
    struct kiln_muxer *muxer = opaque;
    return kiln_temporary_write(muxer->file, bytes, (size_t)size) ? size
                                                                  : AVERROR(muxer->file->failure);
}

static int64_t seek_bytes(void *opaque, int64_t offset, int whence)
{
    struct kiln_muxer *muxer = opaque;
    if (whence != SEEK_SET)
        return AVERROR(ENOSYS);
    return kiln_temporary_seek(muxer->file, offset) ? offset : AVERROR(muxer->file->failure);
}

static void describe(const struct kiln_output_params *params, char *out, size_t size)
{
    char scene[128] = "";
    if (*params->scene_hash)
        snprintf(scene, sizeof scene, " kiln:scene=%s kiln:seed=%u", params->scene_hash,
                 params->seed);
    snprintf(out, size, "kiln:version=%s%s kiln:frames=%u-%u", KILN_VERSION, scene,
             params->clip[0].first, params->clip[params->clip_count - 1].last);
}

static int set_metadata(struct kiln_muxer *muxer)
{
    char comment[256];
    describe(muxer->params, comment, sizeof comment);
    int status = kiln_ff.av_dict_set(&muxer->container->metadata, "comment", comment, 0);
    /* WebM has to be told that alpha is a second stream in the packets' side data. */
    if (status >= 0 && muxer->stream->codecpar->format == AV_PIX_FMT_YUVA420P)
        status = kiln_ff.av_dict_set(&muxer->stream->metadata, "alpha_mode", "1", 0);
    return status;
}

static int write_header(struct kiln_muxer *muxer)
{
    const struct kiln_video_settings *settings = muxer->params->format->video;
    AVDictionary *options = NULL;
    int status = set_metadata(muxer);
    if (status >= 0 && settings->muxer_options)
        status = kiln_ff.av_dict_parse_string(&options, settings->muxer_options, "=", ":", 0);
    if (status >= 0 && settings->prepare)
        status = settings->prepare(muxer->params, &options);
    if (status >= 0)
        status = kiln_ff.avformat_write_header(muxer->container, &options);
    kiln_ff.av_dict_free(&options);
    muxer->begun = status >= 0;
    return status;
}

/* The index of MP4 and MOV goes to the front, so that a player can start before it has the whole
 * file; for that FFmpeg opens the temporary file once more, by its url. */
static int open_container(struct kiln_muxer *muxer)
{
    const char *name = muxer->params->format->video->muxer;
    int status = kiln_ff.avformat_alloc_output_context2(&muxer->container, NULL, name, NULL);
    if (status < 0)
        return status;
    AVFormatContext *container = muxer->container;
    uint8_t *buffer = kiln_ff.av_malloc(IO_BUFFER_SIZE);
    muxer->io = buffer ? kiln_ff.avio_alloc_context(buffer, IO_BUFFER_SIZE, 1, muxer, NULL,
                                                    write_bytes, seek_bytes)
                       : NULL;
    muxer->stream = kiln_ff.avformat_new_stream(container, NULL);
    container->url = kiln_ff.av_asprintf("file:%s", kiln_temporary_path(muxer->file));
    if (!muxer->io || !muxer->stream || !container->url) {
        if (!muxer->io)
            kiln_ff.av_free(buffer);
        return AVERROR(ENOMEM);
    }
    container->pb = muxer->io;
    container->flags |= AVFMT_FLAG_BITEXACT;
    return 0;
}

int kiln_muxer_open(struct kiln_muxer *muxer, const struct kiln_output_params *params,
                    const AVCodecParameters *codec, AVRational time_base,
                    struct kiln_temporary *file)
{
    *muxer = (struct kiln_muxer){.params = params, .file = file, .time_base = time_base};
    int status = open_container(muxer);
    if (status >= 0)
        status = kiln_ff.avcodec_parameters_copy(muxer->stream->codecpar, codec);
    if (status < 0)
        return status;
    muxer->stream->time_base = time_base;
    muxer->stream->avg_frame_rate = av_inv_q(time_base);
    return write_header(muxer);
}

/* Frees a container that is not finished. FFmpeg's GIF writer keeps a packet that only the end of
 * the file frees, so the end is written to memory. */
static void abandon(struct kiln_muxer *muxer)
{
    AVIOContext *nowhere = NULL;
    if (strcmp(muxer->container->oformat->name, "gif") != 0 ||
        kiln_ff.avio_open_dyn_buf(&nowhere) < 0)
        return;
    muxer->container->pb = nowhere;
    kiln_ff.av_write_trailer(muxer->container);
    uint8_t *bytes = NULL;
    kiln_ff.avio_close_dyn_buf(nowhere, &bytes);
    kiln_ff.av_free(bytes);
    muxer->container->pb = muxer->io;
}

void kiln_muxer_close(struct kiln_muxer *muxer)
{
    if (muxer->begun)
        abandon(muxer);
    kiln_ff.avformat_free_context(muxer->container);
    if (muxer->io)
        kiln_ff.av_freep(&muxer->io->buffer);
    kiln_ff.avio_context_free(&muxer->io);
    *muxer = (struct kiln_muxer){.params = NULL};
}

int kiln_muxer_add(struct kiln_muxer *muxer, AVPacket *packet)
{
    packet->duration = 1;
    packet->stream_index = 0;
    kiln_ff.av_packet_rescale_ts(packet, muxer->time_base, muxer->stream->time_base);
    return kiln_ff.av_interleaved_write_frame(muxer->container, packet);
}

int kiln_muxer_finish(struct kiln_muxer *muxer)
{
    int status = kiln_ff.av_write_trailer(muxer->container);
    muxer->begun = false;
    kiln_ff.avio_flush(muxer->io);
    return status;
}
