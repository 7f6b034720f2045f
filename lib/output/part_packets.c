/* Writes the packets of a coded part into its file, and reads them into the clip. The file has the
 * encoder's header, then each packet: the number of its frame, whether it is a key frame, the side
 * data in which WebM has the alpha, and its bytes. */
#include "output/part_packets.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/ffmpeg.h"
#include "output/coder.h"

enum { END = UINT32_MAX };

struct kiln_part_packets {
    const struct kiln_output_params *params;
    struct kiln_part_out *out;
    struct kiln_coder coder;
    struct kiln_avlog avlog;
    AVPacket *packet;
    int64_t frames; /* number of frames that were written */
};

static bool fail(const struct kiln_part_packets *packets, int status, struct kiln_error *error)
{
    const struct kiln_avlog *avlog = &packets->avlog;
    return kiln_video_fail(packets->params, packets->out->file, avlog->first_error, status,
                           "a part of the video cannot be encoded", error);
}

static void write_packet(struct kiln_part_out *out, const AVPacket *packet)
{
    kiln_part_add_word(out, (uint32_t)packet->size);
    kiln_part_add_word(out, (uint32_t)packet->pts);
    kiln_part_add_word(out, (uint32_t)packet->flags & AV_PKT_FLAG_KEY);
    size_t size = 0;
    const uint8_t *alpha =
        kiln_ff.av_packet_get_side_data(packet, AV_PKT_DATA_MATROSKA_BLOCKADDITIONAL, &size);
    kiln_part_add_word(out, alpha ? (uint32_t)size : 0);
    kiln_part_add(out, alpha, alpha ? size : 0);
    kiln_part_add(out, packet->data, (size_t)packet->size);
}

/* Writes all packets that are ready. */
static int write_packets(struct kiln_part_packets *packets)
{
    for (;;) {
        const int status = kiln_coder_receive(&packets->coder, packets->packet);
        if (status < 0)
            return status == AVERROR(EAGAIN) || status == AVERROR_EOF ? 0 : status;
        write_packet(packets->out, packets->packet);
        kiln_ff.av_packet_unref(packets->packet);
    }
}

struct kiln_part_packets *kiln_part_packets_open(const struct kiln_output_params *params,
                                                 bool first, struct kiln_part_out *out,
                                                 struct kiln_error *error)
{
    struct kiln_part_packets *packets = calloc(1, sizeof *packets);
    if (!packets) {
        kiln_error_no_memory(error, "the video of %s", params->path);
        return NULL;
    }
    packets->params = params;
    packets->out = out;
    packets->avlog.log = &params->log;
    kiln_avlog_begin(&packets->avlog);
    packets->packet = kiln_ff.av_packet_alloc();
    const int status =
        packets->packet ? kiln_coder_open(&packets->coder, params, first) : AVERROR(ENOMEM);
    kiln_avlog_end(&packets->avlog);
    if (status < 0) {
        fail(packets, status, error);
        kiln_part_packets_close(&packets);
        return NULL;
    }
    const AVCodecContext *codec = packets->coder.codec;
    kiln_part_add_word(out, (uint32_t)codec->extradata_size);
    kiln_part_add(out, codec->extradata, (size_t)codec->extradata_size);
    return packets;
}

void kiln_part_packets_close(struct kiln_part_packets **packets)
{
    struct kiln_part_packets *p = *packets;
    if (!p)
        return;
    kiln_avlog_begin(&p->avlog);
    kiln_coder_close(&p->coder);
    kiln_ff.av_packet_free(&p->packet);
    kiln_avlog_end(&p->avlog);
    free(p);
    *packets = NULL;
}

bool kiln_part_packets_write(struct kiln_part_packets *packets, const struct kiln_picture *picture,
                             struct kiln_error *error)
{
    kiln_avlog_begin(&packets->avlog);
    int status = kiln_coder_convert(&packets->coder, picture);
    if (status >= 0)
        status = kiln_coder_send(&packets->coder, packets->frames++);
    if (status >= 0)
        status = write_packets(packets);
    kiln_avlog_end(&packets->avlog);
    return status >= 0 || fail(packets, status, error);
}

bool kiln_part_packets_finish(struct kiln_part_packets *packets, struct kiln_error *error)
{
    kiln_avlog_begin(&packets->avlog);
    int status = kiln_coder_end(&packets->coder);
    if (status >= 0)
        status = write_packets(packets);
    kiln_avlog_end(&packets->avlog);
    return status >= 0 || fail(packets, status, error);
}

/* ---- reading --------------------------------------------------------------------------------- */

/* Reads `size` bytes into new memory, which FFmpeg pads. */
static uint8_t *read_bytes(struct kiln_part_in *in, uint32_t size, struct kiln_error *error)
{
    if (size > in->left) {
        kiln_part_refuse(in, "the part of a clip is damaged", error);
        return NULL;
    }
    uint8_t *bytes = kiln_ff.av_mallocz((size_t)size + AV_INPUT_BUFFER_PADDING_SIZE);
    if (!bytes) {
        kiln_error_no_memory(error, "%s", in->path);
        return NULL;
    }
    if (!kiln_part_read(in, bytes, size, error))
        kiln_ff.av_freep(&bytes);
    return bytes;
}

static bool read_alpha(struct kiln_part_in *in, AVPacket *packet, struct kiln_error *error)
{
    uint32_t size;
    if (!kiln_part_read_word(in, &size, error))
        return false;
    if (size == 0)
        return true;
    uint8_t *bytes = read_bytes(in, size, error);
    if (!bytes)
        return false;
    if (kiln_ff.av_packet_add_side_data(packet, AV_PKT_DATA_MATROSKA_BLOCKADDITIONAL, bytes,
                                        size) >= 0)
        return true;
    kiln_ff.av_free(bytes);
    return kiln_error_no_memory(error, "%s", in->path);
}

/* Reads a packet whose size has been read. */
static bool read_packet(struct kiln_part_in *in, uint32_t size, AVPacket *packet,
                        struct kiln_error *error)
{
    uint32_t pts, flags;
    if (!kiln_part_read_word(in, &pts, error) || !kiln_part_read_word(in, &flags, error))
        return false;
    /* Only the key flag is accepted: some flags of FFmpeg make it take the bytes for pointers. */
    if ((flags & ~(uint32_t)AV_PKT_FLAG_KEY) != 0 || pts >= in->head.frames || size > INT32_MAX)
        return kiln_part_refuse(in, "the part of a clip is damaged", error);
    if (!read_alpha(in, packet, error))
        return false;
    uint8_t *bytes = read_bytes(in, size, error);
    if (!bytes)
        return false;
    if (kiln_ff.av_packet_from_data(packet, bytes, (int)size) < 0) {
        kiln_ff.av_free(bytes);
        return kiln_error_no_memory(error, "%s", in->path);
    }
    packet->pts = (int64_t)pts;
    packet->flags = (int)flags;
    return true;
}

static bool pass_packets(struct kiln_part_in *in, void *clip, AVPacket *packet,
                         const struct kiln_caller *caller, struct kiln_error *error)
{
    for (;;) {
        uint32_t size;
        if (!kiln_may_go_on(caller, error) || !kiln_part_read_word(in, &size, error))
            return false;
        if (size == END)
            return true;
        if (!read_packet(in, size, packet, error) || !kiln_video_add_packet(clip, packet, error))
            return false;
    }
}

bool kiln_part_packets_pass(struct kiln_part_in *in, void *clip, const struct kiln_caller *caller,
                            struct kiln_error *error)
{
    uint32_t size;
    uint8_t *header = NULL;
    AVPacket *packet = kiln_ff.av_packet_alloc();
    bool ok =
        packet && kiln_part_read_word(in, &size, error) && (header = read_bytes(in, size, error));
    if (!packet)
        kiln_error_no_memory(error, "%s", in->path);
    if (ok && !kiln_video_begin_part(clip, in->head.first, header, size))
        ok = kiln_error_set(error, KILN_INVALID_INPUT,
                            "%s: another encoder made the part than makes the clip's header (%s)",
                            in->path, in->head.made_by);
    ok = ok && pass_packets(in, clip, packet, caller, error);
    kiln_ff.av_packet_free(&packet);
    kiln_ff.av_free(header);
    return ok;
}
