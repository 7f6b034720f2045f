/* A process of kiln-decode, which decodes what strangers have made: started, spoken to, ended. */
#ifndef KILN_ASSET_LOADER_HELPER_H
#define KILN_ASSET_LOADER_HELPER_H

#include "asset/loader/protocol.h"
#include "base/caller.h"

struct kiln_helper;

/* Starts one and waits until it is locked in and ready. NULL with KILN_DEVICE_FAILED when
 * the program is missing (with its path), is of another version or lacks a library, or the system
 * refuses a process.
 * most_memory: bytes that it may take, if that is less than what it gives itself.
 * The caller is asked while kiln waits here and below; then KILN_INTERRUPTED or its own error. */
struct kiln_helper *kiln_helper_start(enum kiln_decode_kind kind, uint64_t most_memory,
                                      const struct kiln_caller *caller, struct kiln_error *error);

/* Ends the process, whatever it does, and waits for that. */
void kiln_helper_end(struct kiln_helper **helper);

enum kiln_decode_kind kiln_helper_kind(const struct kiln_helper *helper);

/* Sends bytes, and a descriptor unless that is -1, which stays the caller's. */
bool kiln_helper_send(struct kiln_helper *helper, const void *bytes, size_t size, int file,
                      struct kiln_error *error);

/* Waits for that many bytes. False when the process ended or took longer than allowed
 * (KILN_INVALID_INPUT: the file is beyond it; KILN_DEVICE_FAILED when it lacked memory), or the
 * caller wants no more. The helper can only be ended then. */
bool kiln_helper_receive(struct kiln_helper *helper, const struct kiln_caller *caller, void *bytes,
                         size_t size, struct kiln_error *error);

/* Receives an answer with a text that ends. One that failed is an error, with its message; of any
 * other kind than `expected` (a bit each, 1 << what), the helper is broken. */
bool kiln_helper_answer(struct kiln_helper *helper, const struct kiln_caller *caller,
                        unsigned expected, struct kiln_decode_answer *answer,
                        struct kiln_error *error);

/* Says why a file of that name is not decoded: "NAME: reason", or what the caller said, which is
 * not of the file. Returns false. */
bool kiln_helper_fail(const char *name, const struct kiln_error *reason, struct kiln_error *error);

/* Whether there was a failure after which nothing can be asked of it any more; whoever finds one in
 * what the helper sent says so by the second. */
bool kiln_helper_is_broken(const struct kiln_helper *helper);
void kiln_helper_break(struct kiln_helper *helper);

/* Whether it can be asked for another file: it is there, and has sent nothing that nobody wanted.
 */
bool kiln_helper_is_waiting(const struct kiln_helper *helper);

/* The time that a decoder may take begins anew, as it does with each file. */
void kiln_helper_begin_frame(struct kiln_helper *helper);

/* The path of kiln-decode: below the folder of environment variable KILN_LIBEXEC_DIR, if that is
 * set, else beside the program or library that this code is in (as built, as installed), else where
 * it was to be installed to. KILN_DEVICE_FAILED with the first of these when it is nowhere. */
bool kiln_helper_find(char path[KILN_PATH_SIZE], struct kiln_error *error);

#endif
