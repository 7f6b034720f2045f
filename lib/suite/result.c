/* Has the functions that all code for the result of a test shares. They name the rule that judged a
 * frame, compute the score of a test, find its worst frame, and make empty results. This file also
 * has the tables of the members of result.json.
 *
 * summary.c and run.c make an empty result and its frames when a test starts. result_write.c and
 * result_read.c go through the tables, and the reports (lib/report) use the tables and the score.
 *
 * A row of a table is a member of the struct and of result.json under the same name, and the order
 * of rows is the order in the file. result_read.c refuses a result that lacks a member or has an
 * unknown one. So whoever adds, removes or renames a row must increase KILN_RESULT_VERSION, and
 * must change every use of the member in the scripts of the report page (lib/report/page). */
#include "suite/result.h"

#include <math.h>

#include "base/error.h"
#include "base/field.h"
#include "suite/result_member.h"

static const char *const judged_by_names[KILN_JUDGED_BY_COUNT] = {
    [KILN_JUDGED_BY_NOTHING] = "nothing",
    [KILN_JUDGED_BY_STATE] = "state",
    [KILN_JUDGED_BY_PIXELS] = "pixels",
    [KILN_JUDGED_BY_METRICS] = "metrics",
};

const char *kiln_judged_by_name(enum kiln_judged_by judged_by)
{
    return judged_by_names[judged_by];
}

double kiln_result_score(const struct kiln_result *result)
{
    double score = 0;
    for (size_t i = 0; i < result->frame_count; i++) {
        const struct kiln_result_frame *frame = &result->frames[i];
        if (frame->measured && frame->score > score)
            score = frame->score;
    }
    return score;
}

/* Ranks frames of the same status: a person should first see the frame with the largest result. A
 * higher score is worse; a frame that was not measured ranks highest, unless it passed. */
static double urgency(const struct kiln_result_frame *frame)
{
    if (frame->measured)
        return frame->score;
    return frame->status > KILN_TEST_PASS ? INFINITY : 0;
}

size_t kiln_result_worst_frame(const struct kiln_result *result)
{
    size_t worst = 0;
    for (size_t i = 1; i < result->frame_count; i++) {
        const struct kiln_result_frame *a = &result->frames[worst], *b = &result->frames[i];
        if (b->status > a->status || (b->status == a->status && urgency(b) > urgency(a)))
            worst = i;
    }
    return worst;
}

/* ---- Members ------------------------------------------------------------------------------ */

/* A row of a table: the name, the kind, and where the member is in the struct. */
#define MEMBER(type, kind, name)                                                                   \
    {                                                                                              \
#name, KILN_MEMBER_##kind,                                                                 \
            KILN_FIELD_OFFSET(struct type, name, kiln_member_of_##kind,                            \
                              #name " is not of the C type of KILN_MEMBER_" #kind)                 \
    }
#define MEMBERS_END                                                                                \
    {                                                                                              \
        NULL, KILN_MEMBER_END, 0                                                                   \
    }

const struct kiln_member kiln_result_members[] = {
    MEMBER(kiln_result, TEXT, name),
    MEMBER(kiln_result, TEXT, test),
    MEMBER(kiln_result, TEXT, scene),
    MEMBER(kiln_result, TEXT, about),
    MEMBER(kiln_result, TEXT, golden),
    MEMBER(kiln_result, STATUS, status),
    MEMBER(kiln_result, CODE, code),
    MEMBER(kiln_result, TEXT, message),
    MEMBER(kiln_result, FILE, log),
    MEMBER(kiln_result, TEXT, device),
    MEMBER(kiln_result, TEXT, device_name),
    MEMBER(kiln_result, TEXT, driver),
    MEMBER(kiln_result, TEXT, platform),
    MEMBER(kiln_result, TEXT, techniques),
    MEMBER(kiln_result, TEXT, techniques_expected),
    MEMBER(kiln_result, TEXT, version),
    MEMBER(kiln_result, BOOL, pins_gl),
    MEMBER(kiln_result, UINT32, seed),
    MEMBER(kiln_result, UINT32, width),
    MEMBER(kiln_result, UINT32, height),
    MEMBER(kiln_result, UINT32, threads),
    MEMBER(kiln_result, UINT32, repeat),
    MEMBER(kiln_result, HASH, scene_hash),
    MEMBER(kiln_result, HASH, scene_hash_expected),
    MEMBER(kiln_result, TEXT, started),
    MEMBER(kiln_result, DOUBLE, total_s),
    MEMBER(kiln_result, DOUBLE, warn),
    MEMBER(kiln_result, BOOL, hdr),
    MEMBER(kiln_result, TEXT, rerun),
    MEMBER(kiln_result, TEXT, approve),
    MEMBERS_END,
};

const struct kiln_member kiln_result_column_members[] = {
    MEMBER(kiln_compare_column, NAME, name),
    MEMBER(kiln_compare_column, TEXT, unit),
    MEMBER(kiln_compare_column, BOOL, higher_is_better),
    MEMBER(kiln_compare_column, BOOL, limited),
    MEMBER(kiln_compare_column, DOUBLE, limit),
    MEMBERS_END,
};

const struct kiln_member kiln_result_frame_members[] = {
    MEMBER(kiln_result_frame, UINT32, number),
    MEMBER(kiln_result_frame, STATUS, status),
    MEMBER(kiln_result_frame, JUDGED_BY, judged_by),
    MEMBER(kiln_result_frame, TEXT, message),
    MEMBER(kiln_result_frame, FILE, picture),
    MEMBER(kiln_result_frame, FILE, reference),
    MEMBER(kiln_result_frame, FILE, error_map),
    MEMBER(kiln_result_frame, TEXT, golden),
    MEMBER(kiln_result_frame, HASH, state),
    MEMBER(kiln_result_frame, HASH, state_expected),
    MEMBER(kiln_result_frame, HASH, pixels),
    MEMBER(kiln_result_frame, HASH, pixels_expected),
    MEMBER(kiln_result_frame, TEXT, kiln_expected),
    MEMBER(kiln_result_frame, BOOL, measured),
    MEMBERS_END,
};

/* result.json has these members only of frames that are `measured`. */
const struct kiln_member kiln_result_measured_members[] = {
    MEMBER(kiln_result_frame, DOUBLE, score),
    MEMBER(kiln_result_frame, UINT32, worst_x),
    MEMBER(kiln_result_frame, UINT32, worst_y),
    MEMBER(kiln_result_frame, UINT32, window_x),
    MEMBER(kiln_result_frame, UINT32, window_y),
    MEMBER(kiln_result_frame, UINT32, window_width),
    MEMBER(kiln_result_frame, UINT32, window_height),
    MEMBER(kiln_result_frame, UINT32, window_differing),
    MEMBERS_END,
};

const struct kiln_member kiln_result_change_members[] = {
    MEMBER(kiln_result_change, TEXT, key),
    MEMBER(kiln_result_change, TEXT, before),
    MEMBER(kiln_result_change, TEXT, after),
    MEMBERS_END,
};

/* ---- Empty results ------------------------------------------------------------------------ */

/* Sets all texts of an object to "", since no text of a result is ever NULL. */
static void clear_texts(const struct kiln_member *members, void *object)
{
    for (const struct kiln_member *m = members; m->name; m++) {
        if (m->kind == KILN_MEMBER_TEXT || m->kind == KILN_MEMBER_FILE ||
            m->kind == KILN_MEMBER_HASH)
            *(const char **)((char *)object + m->offset) = "";
    }
}

void kiln_result_init(struct kiln_result *result, const char *name)
{
    *result = (struct kiln_result){0};
    clear_texts(kiln_result_members, result);
    result->name = name;
}

void kiln_result_frame_init(struct kiln_result_frame *frame, uint32_t number)
{
    *frame = (struct kiln_result_frame){.number = number};
    clear_texts(kiln_result_frame_members, frame);
}
