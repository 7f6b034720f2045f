/* Loops for wide vectors. */
#ifndef KILN_BASE_VECTOR_H
#define KILN_BASE_VECTOR_H

/* Before a function: makes a second copy of it, with all that it calls, for processors with AVX2,
 * chosen when the program starts. Both give the same bits: nothing is contracted or reordered.
 * (clang cannot copy what it inlines; with sanitizers, the choice would come too early.) */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define KILN_WIDE_VECTORS __attribute__((flatten, target_clones("avx2", "default")))
#else
#define KILN_WIDE_VECTORS
#endif

#endif
