/* This file reads kiln-grid files, which hold vectors on a regular grid, such as wind: five lines
 * of text, then three floats for each sample (grid_in.h describes the format). Checking a scene and
 * preparing its simulation call kiln_grid_load. */
#include "asset/geometry/grid_in.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/text.h"

enum { LINE_SIZE = 128, SAMPLE_BYTES = 12, HEADER_BYTES = 5 * LINE_SIZE };

static const float MAX_COMPONENT = 1e4f; /* of a sample, in either direction */

struct cursor {
    const char *name;
    const unsigned char *at, *end;
    unsigned line;
    struct kiln_error *error;
};

/* Reads a line and leaves out its newline. */
static bool take_line(struct cursor *c, char line[LINE_SIZE])
{
    const size_t left = (size_t)(c->end - c->at);
    const unsigned char *newline = memchr(c->at, '\n', left < LINE_SIZE ? left : LINE_SIZE);
    c->line++;
    if (!newline || memchr(c->at, '\0', (size_t)(newline - c->at))) {
        kiln_error_set(c->error, KILN_INVALID_INPUT,
                       "%s:%u: expected a line of text of less than %d bytes", c->name, c->line,
                       LINE_SIZE);
        return false;
    }
    const size_t length = (size_t)(newline - c->at);
    memcpy(line, c->at, length);
    line[length] = '\0';
    c->at = newline + 1;
    return true;
}

/* Reads a line that must be exactly this text. */
static bool take_exact_line(struct cursor *c, const char *expected)
{
    char line[LINE_SIZE];
    if (!take_line(c, line))
        return false;
    return strcmp(line, expected) == 0 ||
           kiln_error_set(c->error, KILN_INVALID_INPUT, "%s:%u: expected '%s', found '%s'", c->name,
                          c->line, expected, line);
}

/* Reads a line "word x y z", with each number from least to most, and nothing after z. */
static bool take_numbers(struct cursor *c, const char *word, double least, double most, bool whole,
                         double numbers[3])
{
    char line[LINE_SIZE], copy[LINE_SIZE];
    if (!take_line(c, line))
        return false;
    memcpy(copy, line, sizeof copy);
    char *rest = copy;
    const char *first = strsep(&rest, " ");
    bool good = strcmp(first, word) == 0;
    for (int i = 0; good && i < 3; i++) {
        const char *text = strsep(&rest, " ");
        good = text && kiln_text_to_double(text, &numbers[i]) && numbers[i] >= least &&
               numbers[i] <= most && (!whole || numbers[i] == floor(numbers[i]));
    }
    return (good && !rest) ||
           kiln_error_set(c->error, KILN_INVALID_INPUT,
                          "%s:%u: expected '%s' and three %snumbers from %g to %g, found '%s'",
                          c->name, c->line, word, whole ? "whole " : "", least, most, line);
}

static bool take_header(struct cursor *c, struct kiln_grid_file *grid)
{
    double size[3], origin[3], spacing[3];
    if (!take_exact_line(c, "kiln-grid 1") ||
        !take_numbers(c, "size", 2, KILN_MAX_GRID_EDGE, true, size) ||
        !take_numbers(c, "origin", -1e5, 1e5, false, origin) ||
        !take_numbers(c, "spacing", 1e-3, 1e5, false, spacing) || !take_exact_line(c, "data"))
        return false;
    if (size[0] * size[1] * size[2] > KILN_MAX_GRID_SAMPLES)
        return kiln_error_set(c->error, KILN_INVALID_INPUT,
                              "%s:2: %g x %g x %g samples; allowed are at most %d", c->name,
                              size[0], size[1], size[2], KILN_MAX_GRID_SAMPLES);
    for (int i = 0; i < 3; i++) {
        grid->size[i] = (uint32_t)size[i];
        grid->origin[i] = (float)origin[i];
        grid->spacing[i] = (float)spacing[i];
    }
    return true;
}

static float read_float_le(const unsigned char *bytes)
{
    uint32_t bits = 0;
    for (uint32_t i = 0; i < 4; i++)
        bits |= (uint32_t)bytes[i] << (8 * i);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Sets the error for float i of the samples. */
static bool refuse_sample(struct cursor *c, const struct kiln_grid_file *grid, size_t i,
                          float value)
{
    const size_t sample = i / 3, columns = grid->size[0], rows = grid->size[1];
    return kiln_error_set(
        c->error, KILN_INVALID_INPUT,
        "%s: sample %zu, %zu, %zu: found %c = %g; allowed are numbers from %g to %g", c->name,
        sample % columns, sample / columns % rows, sample / (columns * rows), "xyz"[i % 3],
        (double)value, -(double)MAX_COMPONENT, (double)MAX_COMPONENT);
}

static bool take_samples(struct cursor *c, struct kiln_grid_file *grid)
{
    const size_t count = (size_t)grid->size[0] * grid->size[1] * grid->size[2];
    const size_t left = (size_t)(c->end - c->at);
    if (left != count * SAMPLE_BYTES)
        return kiln_error_set(c->error, KILN_INVALID_INPUT,
                              "%s: %zu bytes of data; %u x %u x %u samples have %zu", c->name, left,
                              grid->size[0], grid->size[1], grid->size[2], count * SAMPLE_BYTES);
    grid->samples = malloc(count * sizeof *grid->samples);
    if (!grid->samples)
        return kiln_error_no_memory(c->error, "%s", c->name);
    for (size_t i = 0; i < 3 * count; i++) {
        const float value = read_float_le(c->at + 4 * i);
        if (!(fabsf(value) <= MAX_COMPONENT))
            return refuse_sample(c, grid, i, value);
        grid->samples[i / 3][i % 3] = value;
    }
    return true;
}

struct kiln_grid_file *kiln_grid_parse(const void *bytes, size_t size, const char *name,
                                       struct kiln_error *error)
{
    struct kiln_grid_file *grid = calloc(1, sizeof *grid);
    if (!grid) {
        kiln_error_no_memory(error, "%s", name);
        return NULL;
    }
    const unsigned char *start = bytes;
    struct cursor c = {.name = name, .at = start, .end = start + size, .error = error};
    if (!take_header(&c, grid) || !take_samples(&c, grid))
        kiln_grid_destroy(&grid);
    return grid;
}

struct kiln_grid_file *kiln_grid_load(struct kiln_loader *loader, const char *path,
                                      struct kiln_error *error)
{
    size_t size = 0;
    const struct kiln_loader_file file = {
        .path = path,
        .what = "grid",
        .allowed = "kiln-grid",
        .most_bytes = HEADER_BYTES + (size_t)KILN_MAX_GRID_SAMPLES * SAMPLE_BYTES,
    };
    unsigned char *bytes = kiln_loader_read(loader, &file, &size, error);
    if (!bytes)
        return NULL;
    struct kiln_grid_file *grid = kiln_grid_parse(bytes, size, path, error);
    free(bytes);
    return grid;
}

void kiln_grid_destroy(struct kiln_grid_file **grid)
{
    if (*grid)
        free((*grid)->samples);
    free(*grid);
    *grid = NULL;
}
