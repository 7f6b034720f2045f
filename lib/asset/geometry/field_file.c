/* A line with the hash of all that follows; sizes, origin and spacing, which a reader knows; the
 * samples, as they lie in memory. */
#include "asset/geometry/field_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"

#define MAGIC "kiln-field 1 "

enum { HEADER = sizeof MAGIC - 1 + 64 + 1 };

struct place {
    uint32_t size[3];
    float origin[3];
    float spacing;
};

static struct place place_of(const struct kiln_field *field)
{
    struct place place = {.spacing = field->spacing};
    memcpy(place.size, field->size, sizeof place.size);
    memcpy(place.origin, field->origin, sizeof place.origin);
    return place;
}

static size_t sample_bytes(const struct kiln_field *field)
{
    return (size_t)field->size[0] * field->size[1] * field->size[2] * sizeof *field->samples;
}

/* The file as it must be, in memory; the caller frees it. */
static unsigned char *compose(const struct kiln_field *field, size_t *size)
{
    const struct place place = place_of(field);
    const size_t bytes = sample_bytes(field);
    *size = HEADER + sizeof place + bytes;
    unsigned char *file = malloc(*size);
    if (!file)
        return NULL;
    memcpy(file + HEADER, &place, sizeof place);
    memcpy(file + HEADER + sizeof place, field->samples, bytes);
    char hash[65];
    kiln_hash_sha256(file + HEADER, *size - HEADER, hash);
    memcpy(file, MAGIC, sizeof MAGIC - 1);
    memcpy(file + sizeof MAGIC - 1, hash, 64);
    file[HEADER - 1] = '\n';
    return file;
}

bool kiln_field_read(const char *path, struct kiln_field *field)
{
    const struct place place = place_of(field);
    const size_t size = HEADER + sizeof place + sample_bytes(field);
    FILE *in = fopen(path, "rb");
    if (!in)
        return false;
    unsigned char *file = malloc(size);
    char hash[65];
    bool good = file && fread(file, 1, size, in) == size && fgetc(in) == EOF &&
                memcmp(file, MAGIC, sizeof MAGIC - 1) == 0 &&
                memcmp(file + HEADER, &place, sizeof place) == 0;
    if (good) {
        kiln_hash_sha256(file + HEADER, size - HEADER, hash);
        good = memcmp(file + sizeof MAGIC - 1, hash, 64) == 0;
    }
    if (good)
        memcpy(field->samples, file + HEADER + sizeof place, sample_bytes(field));
    free(file);
    fclose(in);
    return good;
}

static void make_folders(const char *path)
{
    char folder[KILN_PATH_SIZE];
    snprintf(folder, sizeof folder, "%s", path);
    for (char *slash = strchr(folder + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(folder, 0700);
        *slash = '/';
    }
}

void kiln_field_write(const char *path, const struct kiln_field *field)
{
    char beside[KILN_PATH_SIZE + 16];
    size_t size;
    unsigned char *file = compose(field, &size);
    if (!file)
        return;
    make_folders(path);
    snprintf(beside, sizeof beside, "%s.XXXXXX", path);
    const int out = mkstemp(beside);
    if (out >= 0) {
        bool ok = true;
        for (size_t done = 0; ok && done < size;) {
            const ssize_t written = write(out, file + done, size - done);
            ok = written > 0;
            done += ok ? (size_t)written : 0;
        }
        ok = close(out) == 0 && ok;
        if (!ok || rename(beside, path) != 0)
            unlink(beside);
    }
    free(file);
}
