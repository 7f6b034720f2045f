/* Marks scenes and devices, and counts the jobs on them. A debug build may read the mark of one
 * that was destroyed, because it never frees the memory of a mark. A list of the living ones would
 * need no such memory, but it would be state that all renderers of a process share. */
#include "base/handle.h"

#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/error.h"

void kiln_handle_mark(struct kiln_handle *handle, enum kiln_handle_kind kind)
{
    handle->mark = kind;
    atomic_init(&handle->jobs, 0);
}

#if KILN_HANDLES_ARE_CHECKED

static uint32_t retired(enum kiln_handle_kind kind)
{
    return ~(uint32_t)kind;
}

bool kiln_handle_check(const struct kiln_handle *handle, enum kiln_handle_kind kind,
                       struct kiln_error *error)
{
    const char *expected = kind == KILN_HANDLE_SCENE ? "scene" : "device",
               *found = "something else";
    if (handle->mark == kind)
        return true;
    if (handle->mark == retired(kind))
        return kiln_error_set(error, KILN_USAGE,
                              kind == KILN_HANDLE_SCENE
                                  ? "the scene was destroyed; it must outlive its jobs"
                                  : "the device was closed; it must outlive its jobs");
    if (handle->mark == KILN_HANDLE_SCENE || handle->mark == retired(KILN_HANDLE_SCENE))
        found = "a scene";
    else if (handle->mark == KILN_HANDLE_DEVICE || handle->mark == retired(KILN_HANDLE_DEVICE))
        found = "a device";
    return kiln_error_set(error, KILN_USAGE, "found a pointer to %s, expected a %s", found,
                          expected);
}

void kiln_handle_begin_job(const struct kiln_handle *handle)
{
    atomic_fetch_add(&((struct kiln_handle *)handle)->jobs, 1);
}

void kiln_handle_end_job(const struct kiln_handle *handle)
{
    atomic_fetch_sub(&((struct kiln_handle *)handle)->jobs, 1);
}

bool kiln_handle_retire(struct kiln_handle *handle, enum kiln_handle_kind kind)
{
    if (handle->mark != kind)
        return false;
    handle->mark = retired(kind);
    return atomic_load(&handle->jobs) == 0;
}

void kiln_handle_free(struct kiln_handle *handle, size_t size)
{
    char *memory = (char *)handle;
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), at = (uintptr_t)memory % page;
    const size_t begin = (at + sizeof *handle + page - 1) / page * page;
    const size_t end = (at + size) / page * page;
    if (begin < end) /* nobody uses the pages in between again */
        madvise(memory + (begin - at), end - begin, MADV_DONTNEED);
}

#else

bool kiln_handle_check(const struct kiln_handle *handle, enum kiln_handle_kind kind,
                       struct kiln_error *error)
{
    (void)handle, (void)kind, (void)error;
    return true;
}

void kiln_handle_begin_job(const struct kiln_handle *handle)
{
    (void)handle;
}

void kiln_handle_end_job(const struct kiln_handle *handle)
{
    (void)handle;
}

bool kiln_handle_retire(struct kiln_handle *handle, enum kiln_handle_kind kind)
{
    (void)handle, (void)kind;
    return true;
}

void kiln_handle_free(struct kiln_handle *handle, size_t size)
{
    (void)size;
    free(handle);
}

#endif
