/* This header writes pixels past the processor's caches. A picture is larger than the caches that
 * are close to a core, and the next pass reads it only when it is whole: an ordinary store would
 * first read each line of it from memory. */
#ifndef KILN_DRAW_SPRITES_STREAM_H
#define KILN_DRAW_SPRITES_STREAM_H

#ifdef __SSE2__
#include <emmintrin.h>
#endif

typedef float four __attribute__((vector_size(16)));
typedef float four_unaligned __attribute__((vector_size(16), aligned(4), may_alias));

/* Writes four floats to an address that is a multiple of 16. Whole lines should be written in one
 * go. */
static inline void stream_four(float *to, four x)
{
#ifdef __SSE2__
    _mm_stream_ps(to, (__m128)x);
#else
    *(four_unaligned *)to = x;
#endif
}

/* Makes what was written visible to other threads before anything that this thread writes later. */
static inline void stream_end(void)
{
#ifdef __SSE2__
    _mm_sfence();
#endif
}

#endif
