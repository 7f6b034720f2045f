/* Writes the data of curves and a script for gnuplot, and draws the curves by gnuplot, which may
 * not be installed. */
#include <errno.h>
#include <math.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"
#include "bench/result.h"

static void put_point(const struct kiln_bench_row *row, FILE *out)
{
    const double values[] = {row->x, row->spread.median, row->spread.first_quartile,
                             row->spread.third_quartile};
    for (size_t i = 0; i < 4; i++) {
        char number[32];
        kiln_text_from_double(number, values[i]);
        fprintf(out, "%s%s", i ? " " : "", number);
    }
    fputc('\n', out);
}

/* Returns whether a row can be drawn: the axes are logarithmic and take positive values only. */
static bool is_point(const struct kiln_bench_row *row)
{
    return row->x > 0.0 && row->spread.first_quartile > 0.0;
}

/* Returns whether a curve begins at this row and has a point. A curve without points gives no block
 * in the data, so gnuplot does not count it. */
static bool starts_curve(const struct kiln_bench_part *part, size_t row)
{
    if (kiln_bench_curve_of(part, row) != row)
        return false;
    for (size_t i = row; i < part->row_count; i++) {
        if (is_point(&part->rows[i]) && kiln_bench_curve_of(part, i) == row)
            return true;
    }
    return false;
}

bool kiln_bench_has_points(const struct kiln_bench_part *part)
{
    for (size_t i = 0; i < part->row_count; i++) {
        if (is_point(&part->rows[i]))
            return true;
    }
    return false;
}

/* Writes a block of lines for each curve. Gnuplot's `index` counts these blocks from 0. */
void kiln_bench_write_curves(const struct kiln_bench_part *part, FILE *out)
{
    fprintf(out, "# %s: %s, median, first and third quartile (%s)\n", part->name, part->sweep,
            part->unit);
    const char *gap = "";
    for (size_t curve = 0; curve < part->row_count; curve++) {
        if (!starts_curve(part, curve))
            continue;
        char name[160];
        kiln_bench_curve_name(part, curve, name);
        fprintf(out, "%s# %s\n", gap, name);
        gap = "\n\n";
        for (size_t i = curve; i < part->row_count; i++) {
            if (kiln_bench_curve_of(part, i) == curve && is_point(&part->rows[i]))
                put_point(&part->rows[i], out);
        }
    }
}

/* Writes a text in gnuplot's quotes. */
static void put_quoted(const char *text, FILE *out)
{
    fputc('\'', out);
    for (; *text; text++) {
        if (*text == '\'')
            fputc('\'', out);
        fputc(*text, out);
    }
    fputc('\'', out);
}

/* Writes the range of x with room at both ends, which a logarithmic axis needs where there is a
 * single point. */
static void put_range(const struct kiln_bench_part *part, FILE *out)
{
    double least = INFINITY, most = 0.0;
    for (size_t i = 0; i < part->row_count; i++) {
        if (!is_point(&part->rows[i]))
            continue;
        least = part->rows[i].x < least ? part->rows[i].x : least;
        most = part->rows[i].x > most ? part->rows[i].x : most;
    }
    char from[32], to[32];
    kiln_text_from_double(from, least / 1.3);
    kiln_text_from_double(to, most * 1.3);
    fprintf(out, "set xrange [%s:%s]\n", from, to);
}

/* Writes labels of the x axis where there are points, since the values of x are not powers of ten.
 */
static void put_ticks(const struct kiln_bench_part *part, FILE *out)
{
    const char *between = "set xtics (";
    for (size_t i = 0; i < part->row_count; i++) {
        bool is_new = is_point(&part->rows[i]);
        for (size_t k = 0; k < i && is_new; k++)
            is_new = !is_point(&part->rows[k]) || part->rows[k].x < part->rows[i].x ||
                     part->rows[k].x > part->rows[i].x;
        if (!is_new)
            continue;
        char x[32];
        kiln_text_from_double(x, part->rows[i].x);
        fprintf(out, "%s%s", between, x);
        between = ", ";
    }
    fputs(")\n", out);
}

void kiln_bench_write_script(const struct kiln_bench_part *part, FILE *out)
{
    fprintf(out, "# gnuplot %s.gp >%s.svg\n", part->name, part->name);
    int curves = 0;
    for (size_t i = 0; i < part->row_count; i++)
        curves += starts_curve(part, i);
    fprintf(out,
            "set terminal svg size 900,%d noenhanced font 'sans,13' background '#ffffff'\n"
            "set title ",
            460 + 20 * curves); /* the curves' names have a line each */
    put_quoted(part->title, out);
    fputs("\nset logscale xy\nset grid\nset key below Left reverse height 1\nset xlabel ", out);
    put_quoted(part->sweep, out);
    fputs("\nset ylabel ", out);
    put_quoted(part->unit, out);
    fputc('\n', out);
    put_range(part, out);
    put_ticks(part, out);
    fputs("plot", out);
    size_t index = 0;
    for (size_t i = 0; i < part->row_count; i++) {
        if (!starts_curve(part, i))
            continue;
        char name[160];
        kiln_bench_curve_name(part, i, name);
        fprintf(out, "%s \\\n    '%s.dat' index %zu using 1:2:3:4 with yerrorlines title ",
                index ? "," : "", part->name, index);
        put_quoted(name, out);
        index++;
    }
    fputc('\n', out);
}

/* ---- gnuplot --------------------------------------------------------------------------------- */

/* Starts gnuplot in the folder; its standard output goes into the pipe. Returns 0 or an errno
 * value. */
static int start(const char *folder, const char *script, const int pipe_ends[2], pid_t *process)
{
    char name[] = "gnuplot", copy[KILN_PATH_SIZE];
    snprintf(copy, sizeof copy, "%s", script);
    char *arguments[] = {name, copy, NULL};
    posix_spawn_file_actions_t actions;
    int failure = posix_spawn_file_actions_init(&actions);
    if (failure)
        return failure;
    posix_spawn_file_actions_addchdir_np(&actions, folder);
    posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, pipe_ends[0]);
    posix_spawn_file_actions_addclose(&actions, pipe_ends[1]);
    failure = posix_spawnp(process, name, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return failure;
}

/* Reads a file to its end. Returns NULL when that fails. */
static char *read_all(int file, size_t *size)
{
    size_t room = 1 << 16;
    char *bytes = malloc(room);
    *size = 0;
    while (bytes) {
        ssize_t received = read(file, bytes + *size, room - *size);
        if (received == 0)
            return bytes;
        if (received < 0 && errno != EINTR)
            break;
        *size += received > 0 ? (size_t)received : 0;
        if (*size < room)
            continue;
        char *grown = realloc(bytes, room *= 2);
        if (!grown)
            break;
        bytes = grown;
    }
    free(bytes);
    return NULL;
}

char *kiln_bench_plot(const char *folder, const char *script, size_t *size,
                      char problem[KILN_MESSAGE_SIZE])
{
    int ends[2];
    if (pipe(ends) != 0) {
        snprintf(problem, KILN_MESSAGE_SIZE, "no pipe for gnuplot");
        return NULL;
    }
    pid_t process = 0;
    int failure = start(folder, script, ends, &process);
    close(ends[1]);
    char *picture = failure ? NULL : read_all(ends[0], size);
    close(ends[0]);
    int status = 0;
    while (!failure && waitpid(process, &status, 0) < 0 && errno == EINTR)
        ;
    if (failure)
        snprintf(problem, KILN_MESSAGE_SIZE,
                 "gnuplot is missing, so no *.svg is drawn: install gnuplot-nox, or draw *.dat "
                 "with *.gp elsewhere");
    else if (!picture || status != 0 || *size == 0)
        snprintf(problem, KILN_MESSAGE_SIZE, "gnuplot failed on %s/%s", folder, script);
    else
        return picture;
    free(picture);
    return NULL;
}
