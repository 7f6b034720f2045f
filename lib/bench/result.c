/* Keeps the parts of a benchmark, with their rows and notes, in arrays that grow. */
#include "bench/result.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/cpu.h"
#include "base/error.h"

enum { FIRST_ROOM = 64, MAX_NOTE = 1024 };

static bool no_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "measurements");
}

struct kiln_bench *kiln_bench_create(struct kiln_error *error)
{
    struct kiln_bench *bench = calloc(1, sizeof *bench);
    if (bench)
        bench->arena = kiln_arena_create();
    if (!bench || !bench->arena) {
        free(bench);
        no_memory(error);
        return NULL;
    }
    kiln_cpu_name(bench->processor);
    return bench;
}

void kiln_bench_destroy(struct kiln_bench **bench)
{
    struct kiln_bench *b = bench ? *bench : NULL;
    if (!b)
        return;
    for (size_t i = 0; i < b->part_count; i++) {
        free(b->parts[i].rows);
        free(b->parts[i].notes);
    }
    free(b->parts);
    kiln_arena_destroy(&b->arena);
    free(b);
    *bench = NULL;
}

struct kiln_bench_part *kiln_bench_add_part(struct kiln_bench *bench,
                                            const struct kiln_bench_part *part,
                                            struct kiln_error *error)
{
    struct kiln_bench_part *parts =
        realloc(bench->parts, (bench->part_count + 1) * sizeof *bench->parts);
    if (!parts) {
        no_memory(error);
        return NULL;
    }
    bench->parts = parts;
    struct kiln_bench_part *added = &parts[bench->part_count++];
    *added = *part;
    added->rows = NULL;
    added->row_count = added->row_room = 0;
    added->notes = NULL;
    added->note_count = 0;
    return added;
}

size_t kiln_bench_measured(const struct kiln_bench *bench)
{
    size_t count = 0;
    for (size_t p = 0; p < bench->part_count; p++) {
        for (size_t i = 0; i < bench->parts[p].row_count; i++)
            count += bench->parts[p].rows[i].source == NULL;
    }
    return count;
}

static struct kiln_bench_part *last_part(struct kiln_bench *bench)
{
    return &bench->parts[bench->part_count - 1];
}

bool kiln_bench_add_row(struct kiln_bench *bench, const struct kiln_bench_row *row,
                        struct kiln_error *error)
{
    struct kiln_bench_part *part = last_part(bench);
    if (part->row_count == part->row_room) {
        size_t room = part->row_room ? 2 * part->row_room : FIRST_ROOM;
        struct kiln_bench_row *rows = realloc(part->rows, room * sizeof *rows);
        if (!rows)
            return no_memory(error);
        part->rows = rows;
        part->row_room = room;
    }
    part->rows[part->row_count++] = *row;
    return true;
}

bool kiln_bench_add_note(struct kiln_bench *bench, struct kiln_error *error, const char *format,
                         ...)
{
    struct kiln_bench_part *part = last_part(bench);
    char text[MAX_NOTE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    for (size_t i = 0; i < part->note_count; i++) {
        if (strcmp(part->notes[i], text) == 0) /* a refused lane adds its note at each point */
            return true;
    }
    const char **notes = realloc(part->notes, (part->note_count + 1) * sizeof *notes);
    if (!notes)
        return no_memory(error);
    part->notes = notes;
    part->notes[part->note_count] = kiln_arena_text(bench->arena, text, strlen(text));
    return part->notes[part->note_count++] || no_memory(error);
}

void kiln_bench_number(char text[32], double value)
{
    double size = fabs(value);
    int digits = size >= 1000 ? 0 : size >= 100 ? 1 : size >= 10 ? 2 : size >= 1 ? 3 : 4;
    snprintf(text, 32, "%.*f", digits, value);
}
