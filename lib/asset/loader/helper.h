/* Declares a process of kiln-decode, which decodes files from untrusted sources, and the functions
 * to start, ask and end it. */
#ifndef KILN_ASSET_LOADER_HELPER_H
#define KILN_ASSET_LOADER_HELPER_H

#include "asset/loader/protocol.h"
#include "base/caller.h"

struct kiln_helper;

/* Starts a process and waits until it is confined and ready. NULL with KILN_DEVICE_FAILED when the
 * program is missing (with its path), is of another version or lacks a library, or the system
 * refuses a process. most_memory: bytes that it may take, if that is less than its own limit. The
 * caller is asked whether to go on while this function and those below wait; if not, they fail with
 * KILN_INTERRUPTED or the caller's error. */
struct kiln_helper *kiln_helper_start(enum kiln_decode_kind kind, uint64_t most_memory,
                                      const struct kiln_caller *caller, struct kiln_error *error);

/* Lets a budget, which must outlive the process, count its processor time while it runs. */
void kiln_helper_count(struct kiln_helper *helper, struct kiln_budget *budget);

/* Kills the process and waits until it has ended. */
void kiln_helper_end(struct kiln_helper **helper);

enum kiln_decode_kind kiln_helper_kind(const struct kiln_helper *helper);

/* Sends bytes, and a descriptor unless it is -1. The descriptor stays owned by the caller. The
 * limits of time do not begin anew. */
bool kiln_helper_send(struct kiln_helper *helper, const void *bytes, size_t size, int file,
                      struct kiln_error *error);

/* Waits for `size` bytes. False when the process ended or the request took longer than allowed
 * (KILN_INVALID_INPUT: the file is too hard to decode; KILN_DEVICE_FAILED when the process lacked
 * memory), or the caller wants no more. After that, the helper can only be ended. */
bool kiln_helper_receive(struct kiln_helper *helper, const struct kiln_caller *caller, void *bytes,
                         size_t size, struct kiln_error *error);

/* Receives an answer and ends its text. An answer of failure becomes an error with its message.
 * After an answer that is not in `expected` (a bit mask, 1 << what) the helper counts as broken. */
bool kiln_helper_answer(struct kiln_helper *helper, const struct kiln_caller *caller,
                        unsigned expected, struct kiln_decode_answer *answer,
                        struct kiln_error *error);

/* Reports why the named file was not decoded: "NAME: reason". An error of the caller is passed on
 * without the name. Returns false. */
bool kiln_helper_fail(const char *name, const struct kiln_error *reason, struct kiln_error *error);

/* kiln_helper_is_broken returns whether a failure makes further requests impossible.
 * kiln_helper_break marks a helper so, after an invalid answer. */
bool kiln_helper_is_broken(const struct kiln_helper *helper);
void kiln_helper_break(struct kiln_helper *helper);

/* Returns whether the process can be asked for another file: it is running, and has sent nothing
 * that was not asked for. */
bool kiln_helper_is_waiting(const struct kiln_helper *helper);

/* Begins the limits of time (KILN_DECODE_SECONDS, KILN_DECODE_REAL_SECONDS) anew. Call it before a
 * request, and before the next frame or layer is awaited: they hold for all that is received until
 * the next call. kiln_helper_limit_time replaces the limit of real time of this process. */
void kiln_helper_begin(struct kiln_helper *helper);
void kiln_helper_limit_time(struct kiln_helper *helper, double most_s);

/* Finds kiln-decode: below the folder in environment variable KILN_LIBEXEC_DIR, if that is set;
 * else beside the program or library that contains this code (as built, as installed); else in its
 * installation folder. KILN_DEVICE_FAILED with the first of these paths when it is in none. */
bool kiln_helper_find(char path[KILN_PATH_SIZE], struct kiln_error *error);

#endif
