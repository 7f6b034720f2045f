/* This file reads kiln-grid files: a few lines of text, then floats. */
#include "asset/geometry/grid_in.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/text.h"

enum { LINE_SIZE = 128, SAMPLE_BYTES = 12, HEADER_BYTES = 5 * LINE_SIZE };

static const float MOST = 1e4f;

struct cursor {
    const char *name;
    const unsigned char *at, *end;
    unsigned line;
    struct kiln_error *error;
};

/* Reads a line without its end. */
static bool take_line(struct cursor *c, char line[LINE_SIZE])
{
    const size_t left = (size_t)(c->end - c->at);
    const unsigned char *newline = memchr(c->at, '\n', left < LINE_SIZE ? left : LINE_SIZE);
    c->line++;
    if (!newline || memchr(c->at, '\0', (size_t)(newline - c->at))) {
        kiln_error_set(c->error, KILN_INVALID_INPUT,
                       "%s:%u: expected a line of text of a kiln-grid file", c->name, c->line);
        return false;
    }
    const size_t length = (size_t)(newline - c->at);
    memcpy(line, c->at, length);
    line[length] = '\0';
    c->at = newline + 1;
    return true;
}

/* Reads a line that must be exactly this text. */
static bool take_word(struct cursor *c, const char *word)
{
    char line[LINE_SIZE];
    if (!take_line(c, line))
        return false;
    return strcmp(line, word) == 0 ||
           kiln_error_set(c->error, KILN_INVALID_INPUT, "%s:%u: expected '%s', found '%s'", c->name,
                          c->line, word, line);
}

/* Reads a line "word x y z", with each number from least to most. */
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
    if (!take_word(c, "kiln-grid 1") ||
        !take_numbers(c, "size", 2, KILN_MAX_GRID_EDGE, true, size) ||
        !take_numbers(c, "origin", -1e5, 1e5, false, origin) ||
        !take_numbers(c, "spacing", 1e-3, 1e5, false, spacing) || !take_word(c, "data"))
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

static float little_end_first(const unsigned char *bytes)
{
    uint32_t bits = 0;
    for (uint32_t i = 0; i < 4; i++)
        bits |= (uint32_t)bytes[i] << (8 * i);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
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
        return kiln_error_set(c->error, KILN_DEVICE_FAILED, "%s: out of memory", c->name);
    for (size_t i = 0; i < 3 * count; i++) {
        const float value = little_end_first(c->at + 4 * i);
        if (!(fabsf(value) <= MOST))
            return kiln_error_set(c->error, KILN_INVALID_INPUT,
                                  "%s: sample %zu: found %g; allowed are numbers from %g to %g",
                                  c->name, i / 3, (double)value, -(double)MOST, (double)MOST);
        grid->samples[i / 3][i % 3] = value;
    }
    return true;
}

struct kiln_grid_file *kiln_grid_parse(const void *bytes, size_t size, const char *name,
                                       struct kiln_error *error)
{
    struct kiln_grid_file *grid = calloc(1, sizeof *grid);
    if (!grid) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", name);
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
    const size_t most = HEADER_BYTES + (size_t)KILN_MAX_GRID_SAMPLES * SAMPLE_BYTES;
    const struct kiln_loader_file file = {path, "grid", "kiln-grid", most};
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
