/* Declares FFmpeg's functions as pointers, and a collector of its log messages. No program is
 * linked with FFmpeg: kiln opens its libraries when it writes a clip, a JPEG or a Y4M stream, and
 * kiln-decode opens them when it starts. After kiln_ffmpeg_open, a function is called as
 * kiln_ff.av_frame_alloc(). */
#ifndef KILN_BASE_FFMPEG_H
#define KILN_BASE_FFMPEG_H

#include <libavcodec/avcodec.h>
#include <libavcodec/bsf.h>
#include <libavformat/avformat.h>
#include <libavutil/avstring.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
#include <locale.h>

#include "base/library.h"

/* Every function of FFmpeg that kiln calls, by library. */
#define KILN_AVUTIL_FUNCTIONS(F)                                                                   \
    F(av_asprintf)                                                                                 \
    F(av_dict_free)                                                                                \
    F(av_dict_get)                                                                                 \
    F(av_dict_parse_string)                                                                        \
    F(av_dict_set)                                                                                 \
    F(av_dict_set_int)                                                                             \
    F(av_frame_alloc)                                                                              \
    F(av_frame_free)                                                                               \
    F(av_frame_get_buffer)                                                                         \
    F(av_frame_make_writable)                                                                      \
    F(av_free)                                                                                     \
    F(av_freep)                                                                                    \
    F(av_image_fill_arrays)                                                                        \
    F(av_image_get_buffer_size)                                                                    \
    F(av_log_default_callback)                                                                     \
    F(av_log_format_line2)                                                                         \
    F(av_log_set_callback)                                                                         \
    F(av_malloc)                                                                                   \
    F(av_mallocz)                                                                                  \
    F(av_opt_set)                                                                                  \
    F(av_opt_set_double)                                                                           \
    F(av_opt_set_int)                                                                              \
    F(av_pix_fmt_desc_get)                                                                         \
    F(av_reduce)                                                                                   \
    F(av_rescale)                                                                                  \
    F(av_strerror)                                                                                 \
    F(av_version_info)

#define KILN_AVCODEC_FUNCTIONS(F)                                                                  \
    F(av_bsf_free)                                                                                 \
    F(av_bsf_init)                                                                                 \
    F(av_bsf_list_parse_str)                                                                       \
    F(av_bsf_receive_packet)                                                                       \
    F(av_bsf_send_packet)                                                                          \
    F(av_new_packet)                                                                               \
    F(av_packet_add_side_data)                                                                     \
    F(av_packet_alloc)                                                                             \
    F(av_packet_free)                                                                              \
    F(av_packet_from_data)                                                                         \
    F(av_packet_get_side_data)                                                                     \
    F(av_packet_rescale_ts)                                                                        \
    F(av_packet_unref)                                                                             \
    F(avcodec_alloc_context3)                                                                      \
    F(avcodec_default_get_buffer2)                                                                 \
    F(avcodec_find_decoder)                                                                        \
    F(avcodec_find_decoder_by_name)                                                                \
    F(avcodec_find_encoder)                                                                        \
    F(avcodec_find_encoder_by_name)                                                                \
    F(avcodec_free_context)                                                                        \
    F(avcodec_open2)                                                                               \
    F(avcodec_parameters_alloc)                                                                    \
    F(avcodec_parameters_copy)                                                                     \
    F(avcodec_parameters_free)                                                                     \
    F(avcodec_parameters_from_context)                                                             \
    F(avcodec_parameters_to_context)                                                               \
    F(avcodec_receive_frame)                                                                       \
    F(avcodec_receive_packet)                                                                      \
    F(avcodec_send_frame)                                                                          \
    F(avcodec_send_packet)

#define KILN_SWSCALE_FUNCTIONS(F)                                                                  \
    F(sws_alloc_context)                                                                           \
    F(sws_freeContext)                                                                             \
    F(sws_getCoefficients)                                                                         \
    F(sws_getContext)                                                                              \
    F(sws_init_context)                                                                            \
    F(sws_isSupportedInput)                                                                        \
    F(sws_scale)                                                                                   \
    F(sws_setColorspaceDetails)

#define KILN_AVFORMAT_FUNCTIONS(F)                                                                 \
    F(av_find_best_stream)                                                                         \
    F(av_guess_format)                                                                             \
    F(av_interleaved_write_frame)                                                                  \
    F(av_read_frame)                                                                               \
    F(av_write_trailer)                                                                            \
    F(avformat_alloc_context)                                                                      \
    F(avformat_alloc_output_context2)                                                              \
    F(avformat_close_input)                                                                        \
    F(avformat_find_stream_info)                                                                   \
    F(avformat_free_context)                                                                       \
    F(avformat_index_get_entries_count)                                                            \
    F(avformat_new_stream)                                                                         \
    F(avformat_open_input)                                                                         \
    F(avformat_write_header)                                                                       \
    F(avio_alloc_context)                                                                          \
    F(avio_close_dyn_buf)                                                                          \
    F(avio_context_free)                                                                           \
    F(avio_flush)                                                                                  \
    F(avio_open_dyn_buf)

struct kiln_ffmpeg {
    KILN_AVUTIL_FUNCTIONS(KILN_LIBRARY_POINTER)
    KILN_AVCODEC_FUNCTIONS(KILN_LIBRARY_POINTER)
    KILN_SWSCALE_FUNCTIONS(KILN_LIBRARY_POINTER)
    KILN_AVFORMAT_FUNCTIONS(KILN_LIBRARY_POINTER)
};

/* kiln_ffmpeg_open sets each pointer once, and it never changes afterwards. */
extern struct kiln_ffmpeg kiln_ff;

/* Which libraries to open. */
enum kiln_ffmpeg_part {
    KILN_FFMPEG_PICTURES, /* libavutil, libavcodec and libswscale, which code pictures */
    KILN_FFMPEG_CLIPS,    /* these three, and libavformat for containers */
};

/* Opens those libraries that are not open yet. Returns false with KILN_IO where one is missing; the
 * message names its Debian package. Any thread may call it at any time. */
bool kiln_ffmpeg_open(enum kiln_ffmpeg_part part, struct kiln_error *error);

/* Collects the messages of the FFmpeg calls that one thread makes between begin and end, where the
 * thread has the locale C, so that files have the same bytes in every locale. */
struct kiln_avlog {
    const struct kiln_log *log; /* gets warnings and errors as debug lines; NULL: nothing does */
    char first_error[192];      /* the first message of level error or worse, "" if none came */
    struct kiln_avlog *outer;   /* of the pair around this one; kiln_avlog_begin sets it */
    locale_t locale;            /* of the thread outside of the pair */
};

/* Between begin and end, FFmpeg's messages from this thread go to avlog. All other messages go to
 * FFmpeg's default callback, which prints them to stderr. Pairs may nest. kiln_avlog_begin installs
 * the log callback of the process; since a process has only one, nobody else may set it. */
void kiln_avlog_begin(struct kiln_avlog *avlog);
void kiln_avlog_end(struct kiln_avlog *avlog);

#endif
