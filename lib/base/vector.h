/* Defines a macro for functions with loops that compilers vectorise. */
#ifndef KILN_BASE_VECTOR_H
#define KILN_BASE_VECTOR_H

/* Stands before a function. It makes a second copy of the function, with all that it calls, for
 * processors with AVX2; the copy is chosen when the program starts. Both give the same bits, since
 * nothing is contracted or reordered. clang cannot copy what it inlines, and with sanitizers the
 * choice would come too early; there the macro is empty. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define KILN_WIDE_VECTORS __attribute__((flatten, target_clones("avx2", "default")))
#else
#define KILN_WIDE_VECTORS
#endif

#endif
