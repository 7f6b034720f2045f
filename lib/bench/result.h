/* Holds the results of a benchmark. A benchmark has parts, and a part has rows, which make a table
 * and often curves. Texts lie in the arena. */
#ifndef KILN_BENCH_RESULT_H
#define KILN_BENCH_RESULT_H

#include "base/arena.h"
#include "bench/statistics.h"
#include "kiln_program.h"

struct kiln_bench_row {
    double x;              /* the value that the part sweeps */
    const char *measure;   /* "sort", "frame" */
    const char *technique; /* "sort=bitonic", or another name of what was measured */
    struct kiln_spread spread;
    struct kiln_spread faster; /* how many times as fast as the reference; count 0: not compared */
    const char *source;        /* where the value was published; NULL: it was measured */
};

struct kiln_bench_part {
    const char *name;  /* "figure4.4", which names the table and its files */
    const char *suite; /* name of the suite, or path of the scene */
    const char *title;
    const char *sweep;     /* what x is: "particles" */
    const char *unit;      /* "ms" */
    const char *reference; /* what `faster` compares with, or NULL */
    bool plotted;
    struct kiln_bench_row *rows;
    size_t row_count, row_room;
    const char **notes; /* lines below the table */
    size_t note_count;
};

struct kiln_bench {
    struct kiln_arena *arena;
    struct kiln_device_info device;
    char processor[128];
    uint32_t cores;
    uint32_t repetitions;
    bool quick;
    double seconds; /* duration of the whole run */
    struct kiln_bench_part *parts;
    size_t part_count;
};

struct kiln_bench *kiln_bench_create(struct kiln_error *error);

/* Adds a part, which is a copy of `part` without its rows and notes. Returns NULL when memory is
 * short. */
struct kiln_bench_part *kiln_bench_add_part(struct kiln_bench *bench,
                                            const struct kiln_bench_part *part,
                                            struct kiln_error *error);

/* Add a row, or a note, to the last part. */
bool kiln_bench_add_row(struct kiln_bench *bench, const struct kiln_bench_row *row,
                        struct kiln_error *error);
bool kiln_bench_add_note(struct kiln_bench *bench, struct kiln_error *error, const char *format,
                         ...) __attribute__((format(printf, 3, 4)));

/* Writes a number as tables print it: four significant digits, more for whole numbers of 10,000 and
 * above, at most four decimals, and no exponent. */
void kiln_bench_number(char text[32], double value);

/* Write a benchmark in each format of kiln_bench_write, and the data and the gnuplot script of a
 * part's curves. */
void kiln_bench_write_text(const struct kiln_bench *bench, FILE *out);
void kiln_bench_write_json(const struct kiln_bench *bench, FILE *out);
void kiln_bench_write_csv(const struct kiln_bench *bench, FILE *out);
void kiln_bench_write_markdown(const struct kiln_bench *bench, FILE *out);
void kiln_bench_write_curves(const struct kiln_bench_part *part, FILE *out);
void kiln_bench_write_script(const struct kiln_bench_part *part, FILE *out);

/* A curve is the rows of one measure and technique. Returns the number of the first row of the
 * curve that `row` belongs to. */
size_t kiln_bench_curve_of(const struct kiln_bench_part *part, size_t row);

/* Returns whether any curve of the part has a point that can be drawn. */
bool kiln_bench_has_points(const struct kiln_bench_part *part);

/* Names the curve of a row, such as "sort, sort=cpu". A measure or technique that all rows of the
 * part share is left out. */
void kiln_bench_curve_name(const struct kiln_bench_part *part, size_t row, char name[160]);

/* Draws the curves of a script in a folder by gnuplot. Returns the picture, which the caller frees,
 * or NULL with the problem. */
char *kiln_bench_plot(const char *folder, const char *script, size_t *size,
                      char problem[KILN_MESSAGE_SIZE]);

#endif
