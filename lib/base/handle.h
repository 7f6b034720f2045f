/* Marks scenes and devices. In debug builds, jobs look at the marks, so that a job on a scene or
 * device that was destroyed, or on a pointer to something else, is an error and no crash. */
#ifndef KILN_BASE_HANDLE_H
#define KILN_BASE_HANDLE_H

#include <stdatomic.h>
#include <stdint.h>

#include "kiln.h"

/* KILN_HANDLES_ARE_CHECKED is 1 in debug builds, which are those without NDEBUG. It is 0 beside the
 * address sanitizer, which finds these mistakes itself, and which would report the memory that the
 * functions below keep as a leak. */
#if defined(NDEBUG) || defined(__SANITIZE_ADDRESS__)
#define KILN_HANDLES_ARE_CHECKED 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define KILN_HANDLES_ARE_CHECKED 0
#endif
#endif
#ifndef KILN_HANDLES_ARE_CHECKED
#define KILN_HANDLES_ARE_CHECKED 1
#endif

/* The values are marks that other memory is unlikely to begin with. */
enum kiln_handle_kind { KILN_HANDLE_SCENE = 0x5ce2e0a7, KILN_HANDLE_DEVICE = 0x6de71ce9 };

/* The first member of a struct that is marked. */
struct kiln_handle {
    uint32_t mark;
    atomic_uint jobs; /* number of jobs that run on it, which debug builds count */
};

/* Marks a new scene or device. Nobody else may use it yet. */
void kiln_handle_mark(struct kiln_handle *handle, enum kiln_handle_kind kind);

/* Returns false with KILN_USAGE if the handle is not of this kind or was retired. Always returns
 * true where handles are not checked. */
bool kiln_handle_check(const struct kiln_handle *handle, enum kiln_handle_kind kind,
                       struct kiln_error *error);

/* Count a job that begins on a handle, and one that ends. Any threads may call them at the same
 * time, for one scene. */
void kiln_handle_begin_job(const struct kiln_handle *handle);
void kiln_handle_end_job(const struct kiln_handle *handle);

/* Marks a scene or device as destroyed. Returns whether its owner may free what belongs to it.
 * Where handles are checked, returns false for a handle of another kind, for one that was retired
 * before, and for one that a job runs on. What belongs to it then stays, so that the job can report
 * the mistake and end. */
bool kiln_handle_retire(struct kiln_handle *handle, enum kiln_handle_kind kind);

/* Frees a struct of `size` bytes from malloc that begins with a retired handle. Where handles are
 * checked, the struct's first page stays allocated for ever, since a caller may still have a
 * pointer to it. */
void kiln_handle_free(struct kiln_handle *handle, size_t size);

#endif
