/* Makes chosen allocations of kiln fail, to test what kiln does when memory is short. The linker
 * replaces the calls of the functions below (--wrap), but only in kiln's own objects; libraries
 * allocate as usual. Environment variables choose the calls that fail:
 *
 *     KILN_STARVE=40         the fortieth call
 *     KILN_STARVE=40+        the fortieth and all later calls
 *     KILN_STARVE_COUNT=FILE none; when the program ends, it writes the number of calls to FILE
 *
 * A call that fails returns what the real function returns when memory is short: NULL, -1 or
 * AVERROR(ENOMEM). */
#include <errno.h>
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"

static atomic_ulong calls;
static unsigned long first_refused; /* number of the first call that fails, from 1; 0: none */
static char onward;                 /* '+': all later calls fail, too */

__attribute__((constructor)) static void read_wishes(void)
{
    const char *wish = getenv("KILN_STARVE");
    char *end = NULL;
    if (wish) {
        first_refused = strtoul(wish, &end, 10);
        onward = *end;
    }
}

__attribute__((destructor)) static void write_count(void)
{
    const char *path = getenv("KILN_STARVE_COUNT");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (!file)
        return;
    fprintf(file, "%lu\n", atomic_load(&calls));
    fclose(file);
}

/* Sets errno as a failed allocation does. It is a function so that a debugger can stop here; the
 * caller of the caller of is_refused is the code whose allocation fails. */
__attribute__((noinline)) static void refuse(void)
{
    errno = ENOMEM;
}

static bool is_refused(void)
{
    const unsigned long call = atomic_fetch_add(&calls, 1) + 1;
    const bool refused =
        first_refused > 0 && (call == first_refused || (onward == '+' && call > first_refused));
    if (refused)
        refuse();
    return refused;
}

/* DECLARE declares the real function and its replacement by the names that --wrap gives them.
 * ALLOCATION defines the replacement, ALLOCATION_BY_HAND only begins its definition. CMakeLists.txt
 * reads the functions to wrap from the lines that begin with ALLOCATION. */
#define DECLARE(type, name, parameters)                                                            \
    type real_##name parameters __asm__("__real_" #name);                                          \
    type starved_##name parameters __asm__("__wrap_" #name);
#define ALLOCATION(name, type, refusal, parameters, arguments)                                     \
    DECLARE(type, name, parameters)                                                                \
    type starved_##name parameters                                                                 \
    {                                                                                              \
        return is_refused() ? (refusal) : real_##name arguments;                                   \
    }
#define ALLOCATION_BY_HAND(name, type, parameters)                                                 \
    DECLARE(type, name, parameters)                                                                \
    type starved_##name parameters

/* clang-format off */
/* Functions of FFmpeg, which kiln finds by dlsym, so that --wrap does not see their calls. */
#define LOOKED_UP(A) \
    A(av_malloc, void *, NULL, (size_t size), (size)) \
    A(av_mallocz, void *, NULL, (size_t size), (size)) \
    A(av_dict_set, int, AVERROR(ENOMEM), (AVDictionary **dictionary, const char *key, \
      const char *value, int flags), (dictionary, key, value, flags)) \
    A(av_dict_set_int, int, AVERROR(ENOMEM), (AVDictionary **dictionary, const char *key, \
      int64_t value, int flags), (dictionary, key, value, flags)) \
    A(av_dict_parse_string, int, AVERROR(ENOMEM), (AVDictionary **dictionary, const char \
      *text, const char *is, const char *next, int flags), (dictionary, text, is, next, \
      flags)) \
    A(av_frame_alloc, AVFrame *, NULL, (void), ()) \
    A(av_frame_get_buffer, int, AVERROR(ENOMEM), (AVFrame *frame, int align), (frame, align)) \
    A(av_opt_set, int, AVERROR(ENOMEM), (void *object, const char *key, const char *value, \
      int flags), (object, key, value, flags)) \
    A(av_packet_alloc, AVPacket *, NULL, (void), ()) \
    A(av_new_packet, int, AVERROR(ENOMEM), (AVPacket *packet, int size), (packet, size)) \
    A(av_packet_from_data, int, AVERROR(ENOMEM), (AVPacket *packet, uint8_t *data, int \
      size), (packet, data, size)) \
    A(av_packet_add_side_data, int, AVERROR(ENOMEM), (AVPacket *packet, enum \
      AVPacketSideDataType type, uint8_t *data, size_t size), (packet, type, data, size)) \
    A(avcodec_alloc_context3, AVCodecContext *, NULL, (const AVCodec *codec), (codec)) \
    A(avcodec_open2, int, AVERROR(ENOMEM), (AVCodecContext *context, const AVCodec *codec, \
      AVDictionary **options), (context, codec, options)) \
    A(avcodec_parameters_alloc, AVCodecParameters *, NULL, (void), ()) \
    A(avcodec_parameters_copy, int, AVERROR(ENOMEM), (AVCodecParameters *to, const \
      AVCodecParameters *from), (to, from)) \
    A(avcodec_parameters_from_context, int, AVERROR(ENOMEM), (AVCodecParameters *to, const \
      AVCodecContext *from), (to, from)) \
    A(avformat_alloc_context, AVFormatContext *, NULL, (void), ()) \
    A(avformat_new_stream, AVStream *, NULL, (AVFormatContext *context, const AVCodec \
      *codec), (context, codec)) \
    A(avio_open_dyn_buf, int, AVERROR(ENOMEM), (AVIOContext **context), (context)) \
    A(sws_getContext, struct SwsContext *, NULL, (int width, int height, enum \
      AVPixelFormat format, int to_width, int to_height, enum AVPixelFormat to_format, int \
      flags, SwsFilter *filter, SwsFilter *to_filter, const double *options), (width, \
      height, format, to_width, to_height, to_format, flags, filter, to_filter, options)) \
    A(sws_alloc_context, struct SwsContext *, NULL, (void), ())

#define LOOKED_UP_FUNCTION(name, type, refusal, parameters, arguments)                             \
    static type(*real_##name) parameters;                                                          \
    static type starved_##name parameters                                                          \
    {                                                                                              \
        return is_refused() ? (refusal) : real_##name arguments;                                   \
    }                                                                                              \
    static type(*const pointer_##name) parameters = starved_##name;
LOOKED_UP(LOOKED_UP_FUNCTION)

#define LOOKED_UP_ROW(name, ...) {#name, &real_##name, &pointer_##name},
static const struct {
    const char *name;
    void *real;
    const void *starved;
} looked_up[] = {LOOKED_UP(LOOKED_UP_ROW)};

ALLOCATION(malloc, void *, NULL, (size_t size), (size))
ALLOCATION(calloc, void *, NULL, (size_t count, size_t size), (count, size))
ALLOCATION(realloc, void *, NULL, (void *memory, size_t size), (memory, size))
ALLOCATION(aligned_alloc, void *, NULL, (size_t alignment, size_t size), (alignment, size))
ALLOCATION(strdup, char *, NULL, (const char *text), (text))
ALLOCATION(strndup, char *, NULL, (const char *text, size_t size), (text, size))
ALLOCATION(open_memstream, FILE *, NULL, (char **text, size_t *size), (text, size))
ALLOCATION(vasprintf, int, -1, (char **text, const char *format, va_list args), (text, format, args))
ALLOCATION(kiln_arena_alloc, void *, NULL, (struct kiln_arena *arena, size_t count, size_t size),
           (arena, count, size))
ALLOCATION_BY_HAND(dlsym, void *, (void *restrict library, const char *restrict name))
{
    void *found = real_dlsym(library, name);
    for (size_t i = 0; found && i < sizeof looked_up / sizeof *looked_up; i++) {
        if (strcmp(looked_up[i].name, name) == 0) {
            memcpy(looked_up[i].real, &found, sizeof found);
            memcpy(&found, looked_up[i].starved, sizeof found);
            break;
        }
    }
    return found;
}
/* clang-format on */

ALLOCATION_BY_HAND(asprintf, int, (char **text, const char *format, ...))
{
    va_list args;
    va_start(args, format);
    const int length = starved_vasprintf(text, format, args);
    va_end(args);
    return length;
}
