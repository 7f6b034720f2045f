/* Declares the tables of the members of result.json, by which result_write.c writes it and
 * result_read.c reads it. */
#ifndef KILN_SUITE_RESULT_MEMBER_H
#define KILN_SUITE_RESULT_MEMBER_H

#include "kiln_program.h"
#include "suite/result.h"

enum { KILN_RESULT_VERSION = 2 }; /* an error message in result_read.c names it, too */

enum kiln_member_kind {
    KILN_MEMBER_TEXT,
    KILN_MEMBER_FILE, /* a text: a name in the result's folder, or "" */
    KILN_MEMBER_HASH, /* a text: up to 64 lower-case hex digits */
    KILN_MEMBER_NAME, /* a text in an array of KILN_METRIC_NAME_SIZE */
    KILN_MEMBER_UINT32,
    KILN_MEMBER_DOUBLE,
    KILN_MEMBER_BOOL,
    KILN_MEMBER_CODE,
    KILN_MEMBER_STATUS,
    KILN_MEMBER_JUDGED_BY,
    KILN_MEMBER_END
};

/* The C type of a member of a kind. A row of a member that has another type does not compile. */
typedef const char *kiln_member_of_TEXT;
typedef const char *kiln_member_of_FILE;
typedef const char *kiln_member_of_HASH;
typedef char kiln_member_of_NAME[KILN_METRIC_NAME_SIZE];
typedef uint32_t kiln_member_of_UINT32;
typedef double kiln_member_of_DOUBLE;
typedef bool kiln_member_of_BOOL;
typedef enum kiln_code kiln_member_of_CODE;
typedef enum kiln_test_status kiln_member_of_STATUS;
typedef enum kiln_judged_by kiln_member_of_JUDGED_BY;

struct kiln_member {
    const char *name;
    enum kiln_member_kind kind;
    size_t offset;
};

/* Reads a command of a result, as kiln_test_case_rerun_command or, with `approves`,
 * kiln_test_case_approve_command writes it, and builds it anew of its parts, each of which is
 * checked and quoted. Its folder of results becomes `results`, or the usual one for NULL. NULL when
 * a part is not as they would write it, or when memory is short. */
const char *kiln_result_command(struct kiln_arena *arena, const struct kiln_result *result,
                                const char *command, const char *results, bool approves);

/* Tables of members, each of which ends with a NULL name. */
extern const struct kiln_member kiln_result_members[], kiln_result_column_members[],
    kiln_result_frame_members[], kiln_result_change_members[];

/* Writes a member of an object under a key. */
void kiln_member_write(struct kiln_json *json, const char *key, const struct kiln_member *member,
                       const void *object);

/* The table of the further members of a measured frame, except "metrics" and "beyond". */
extern const struct kiln_member kiln_result_measured_members[];

#endif
