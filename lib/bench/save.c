/* Writes the files of a benchmark into a folder. Each file is made in memory, and written when it
 * is complete. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary.h"
#include "bench/result.h"

bool kiln_bench_write(const struct kiln_bench *bench, enum kiln_bench_format format, FILE *out,
                      struct kiln_error *error)
{
    static void (*const writers[])(const struct kiln_bench *bench, FILE *out) = {
        [KILN_BENCH_TEXT] = kiln_bench_write_text,
        [KILN_BENCH_JSON] = kiln_bench_write_json,
        [KILN_BENCH_CSV] = kiln_bench_write_csv,
        [KILN_BENCH_MARKDOWN] = kiln_bench_write_markdown,
    };
    writers[format](bench, out);
    return (fflush(out) == 0 && !ferror(out)) ||
           kiln_error_set(error, KILN_IO, "the measurements cannot be written");
}

struct output_folder {
    const struct kiln_bench *bench;
    const char *folder;
    struct kiln_error *error;
};

static bool put_file(const struct output_folder *output_folder, const char *name, const void *bytes,
                     size_t size)
{
    char path[KILN_PATH_SIZE];
    return kiln_path_join(path, output_folder->folder, name, output_folder->error) &&
           kiln_temporary_write_file(path, bytes, size, output_folder->error);
}

/* Closes a stream into memory, and writes its bytes into a file. */
static bool put_stream(const struct output_folder *output_folder, const char *name, FILE *stream,
                       char **bytes, const size_t *size)
{
    bool whole = stream && !ferror(stream);
    whole = (!stream || fclose(stream) == 0) && whole;
    if (!whole)
        kiln_error_no_memory(output_folder->error, "%s", name);
    bool ok = whole && put_file(output_folder, name, *bytes, *size);
    free(*bytes);
    return ok;
}

static bool put_format(const struct output_folder *output_folder, enum kiln_bench_format format,
                       const char *name)
{
    char *bytes = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&bytes, &size);
    bool written =
        stream && kiln_bench_write(output_folder->bench, format, stream, output_folder->error);
    return put_stream(output_folder, name, stream, &bytes, &size) && written;
}

static bool put_part(const struct output_folder *output_folder, const struct kiln_bench_part *part,
                     const char *suffix, void (*write)(const struct kiln_bench_part *, FILE *))
{
    char *bytes = NULL, name[128];
    size_t size = 0;
    FILE *stream = open_memstream(&bytes, &size);
    if (stream)
        write(part, stream);
    snprintf(name, sizeof name, "%s%s", part->name, suffix);
    return put_stream(output_folder, name, stream, &bytes, &size);
}

/* Draws the curves of a part. Where that fails, it removes an older picture, which would show other
 * data. */
static bool put_picture(const struct output_folder *output_folder,
                        const struct kiln_bench_part *part, char problem[KILN_MESSAGE_SIZE])
{
    char script[128], name[128], path[KILN_PATH_SIZE];
    snprintf(script, sizeof script, "%s.gp", part->name);
    snprintf(name, sizeof name, "%s.svg", part->name);
    size_t size = 0;
    char *picture =
        *problem ? NULL : kiln_bench_plot(output_folder->folder, script, &size, problem);
    if (!picture) {
        if (!kiln_path_join(path, output_folder->folder, name, output_folder->error))
            return false;
        unlink(path);
        return true;
    }
    bool ok = put_file(output_folder, name, picture, size);
    free(picture);
    return ok;
}

bool kiln_bench_prepare(const char *folder, struct kiln_error *error)
{
    struct kiln_temporary probe = {0};
    char path[KILN_PATH_SIZE];
    if (!kiln_path_join(path, folder, "bench.txt", error) ||
        !kiln_make_parent_folders(path, error) || !kiln_target_check(path, true, error) ||
        !kiln_temporary_open(&probe, path, error))
        return false;
    kiln_temporary_discard(&probe);
    return true;
}

bool kiln_bench_save(const struct kiln_bench *bench, const char *folder,
                     char unplotted[KILN_MESSAGE_SIZE], struct kiln_error *error)
{
    const struct output_folder output_folder = {bench, folder, error};
    *unplotted = '\0';
    if (!put_format(&output_folder, KILN_BENCH_TEXT, "bench.txt") ||
        !put_format(&output_folder, KILN_BENCH_JSON, "bench.json") ||
        !put_format(&output_folder, KILN_BENCH_CSV, "bench.csv") ||
        !put_format(&output_folder, KILN_BENCH_MARKDOWN, "bench.md"))
        return false;
    for (size_t i = 0; i < bench->part_count; i++) {
        const struct kiln_bench_part *part = &bench->parts[i];
        if (part->plotted && kiln_bench_has_points(part) &&
            !(put_part(&output_folder, part, ".dat", kiln_bench_write_curves) &&
              put_part(&output_folder, part, ".gp", kiln_bench_write_script) &&
              put_picture(&output_folder, part, unplotted)))
            return false;
    }
    return true;
}
