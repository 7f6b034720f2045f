/* Plans which pictures are embedded in a report page and which are linked, and writes those that
 * are embedded. Such a picture is read only when it is written, so that one is in memory at a time.
 * A folder of results may come from a stranger, so its pictures are plain files below it, of the
 * sizes that they had when they were planned (suite/result_file.h). */
#include "report/gallery.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file_in.h"
#include "base/text.h"
#include "report/markup.h"
#include "report/preview.h"

/* A picture of a result. */
struct source {
    struct kiln_result_place place;
    const char *name; /* of its file */
    size_t size;      /* when it was planned; 0: it could not be opened */
};

struct kiln_gallery {
    const struct kiln_results *results;
    struct kiln_arena *arena;
    const char *page_folder;           /* absolute; "" if it is not known */
    bool link;                         /* link all pictures */
    struct kiln_gallery_place **tests; /* for each test, the places of all frames by role */
    struct source *embedded;           /* the embedded pictures, by number */
    uint32_t embedded_count, linked_for_size;
    uint64_t bytes; /* of the embedded pictures */
};

/* ---- Links -------------------------------------------------------------------------------- */

/* Adds the path of a folder relative to the page's folder `from`; both are absolute. */
static void add_relative(struct kiln_text *out, const char *from, const char *folder)
{
    size_t common = 0; /* length of the common start, in whole names */
    size_t i = 0;
    for (; from[i] && from[i] == folder[i]; i++)
        if (from[i] == '/')
            common = i;
    if ((!from[i] || from[i] == '/') && (!folder[i] || folder[i] == '/'))
        common = i;
    for (const char *rest = from + common; *rest; rest++)
        if (rest[0] == '/' && rest[1] != '\0')
            kiln_text_add(out, "../");
    const char *rest = folder + common;
    rest += *rest == '/';
    kiln_text_add(out, "%s%s", rest, *rest ? "/" : "");
}

static char *absolute_folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    char folder[KILN_PATH_SIZE] = ".";
    if (slash == path)
        return strdup("/");
    if (slash)
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
    return realpath(folder, NULL);
}

/* Returns the path of a picture relative to the page's folder; NULL when memory is short. */
static const char *relative_path(struct kiln_gallery *gallery, const char *path)
{
    char *folder = absolute_folder_of(path);
    const char *slash = strrchr(path, '/');
    struct kiln_text text = {0};
    if (folder && *gallery->page_folder) {
        add_relative(&text, gallery->page_folder, folder);
        kiln_text_add(&text, "%s", slash ? slash + 1 : path);
    } else {
        kiln_text_add(&text, "%s", path);
    }
    const char *copy = text.failed ? NULL : kiln_arena_text(gallery->arena, text.data, text.length);
    kiln_text_free(&text);
    free(folder);
    return copy;
}

/* Makes the path of a picture's preview: for frame_0024.exr, it is frame_0024.preview.png. */
static void preview_path(const char *path, char out[KILN_PATH_SIZE])
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t stem = dot && (!slash || dot > slash) ? (size_t)(dot - path) : strlen(path);
    snprintf(out, KILN_PATH_SIZE, "%.*s.preview.png", (int)stem, path);
}

static bool make_preview(const unsigned char *bytes, size_t size, const char *path,
                         const char *target, struct kiln_error *error)
{
    struct kiln_temporary file = {0};
    bool ok = kiln_temporary_open(&file, target, error) &&
              kiln_preview_write(bytes, size, path, &file, error) &&
              kiln_temporary_commit(&file, true, error);
    kiln_temporary_discard(&file);
    return ok;
}

static void source_path(const struct source *source, char path[KILN_PATH_SIZE])
{
    snprintf(path, KILN_PATH_SIZE, "%s/%s/%s", source->place.results, source->place.name,
             source->name);
}

/* Reads a picture that a page links to, and makes a preview of one that no browser can show. A page
 * does not link to what is no plain file. */
static bool prepare_link(const struct source *source, char target[KILN_PATH_SIZE],
                         struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    size_t size = 0;
    unsigned char *bytes = kiln_result_picture_read(&source->place, source->name, &size, error);
    source_path(source, path);
    source_path(source, target);
    bool ok = bytes != NULL;
    if (ok && !kiln_preview_is_plain(bytes, size)) {
        preview_path(path, target);
        ok = make_preview(bytes, size, path, target, error);
    }
    free(bytes);
    return ok;
}

static bool link_to(struct kiln_gallery *gallery, const struct source *source,
                    struct kiln_gallery_place *place)
{
    struct kiln_error error = {0};
    char target[KILN_PATH_SIZE];
    if (prepare_link(source, target, &error)) {
        place->kind = KILN_GALLERY_LINKED;
        place->text = relative_path(gallery, target);
    } else {
        place->kind = KILN_GALLERY_BROKEN;
        place->text = kiln_arena_text(gallery->arena, error.message, strlen(error.message));
    }
    return place->text != NULL;
}

/* ---- The plan ----------------------------------------------------------------------------- */

/* Opens a picture, and finds its size. Returns its descriptor, or -1. */
static int open_source(struct source *source, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    const struct kiln_result_file picture = kiln_result_picture(source->name);
    return kiln_result_file_open(&source->place, &picture, path, &source->size, error);
}

static bool read_block(int file, char *block, size_t size)
{
    for (size_t done = 0; done < size;) {
        const ssize_t got = read(file, block + done, size - done);
        if (got == 0 || (got < 0 && errno != EINTR))
            return false;
        done += got > 0 ? (size_t)got : 0;
    }
    return true;
}

static bool have_equal_bytes(struct source *a, struct source *b)
{
    struct kiln_error ignored = {0};
    struct source *const sources[2] = {a, b};
    int files[2];
    for (int i = 0; i < 2; i++)
        files[i] = open_source(sources[i], &ignored);
    bool equal = files[0] >= 0 && files[1] >= 0 && a->size == b->size;
    for (size_t left = a->size; equal && left > 0;) {
        char blocks[2][4096];
        const size_t size = left < sizeof blocks[0] ? left : sizeof blocks[0];
        equal = read_block(files[0], blocks[0], size) && read_block(files[1], blocks[1], size) &&
                memcmp(blocks[0], blocks[1], size) == 0;
        left -= size;
    }
    for (int i = 0; i < 2; i++)
        if (files[i] >= 0)
            close(files[i]);
    return equal;
}

static bool place_picture(struct kiln_gallery *gallery, const struct source *given,
                          struct kiln_gallery_place *place)
{
    struct source source = *given;
    struct kiln_error ignored = {0}; /* a picture that cannot be opened says why in its place */
    const int file = open_source(&source, &ignored);
    if (file < 0)
        source.size = 0;
    else
        close(file);
    bool fits = gallery->bytes + source.size <= KILN_GALLERY_BYTES;
    if (gallery->link || !fits) {
        gallery->linked_for_size += !gallery->link;
        return link_to(gallery, &source, place);
    }
    place->kind = KILN_GALLERY_EMBEDDED;
    place->number = gallery->embedded_count;
    gallery->bytes += source.size;
    gallery->embedded[gallery->embedded_count++] = source;
    return true;
}

static bool place_frame(struct kiln_gallery *gallery, size_t test, size_t index)
{
    const struct kiln_result_frame *frame = &gallery->results->tests[test]->frames[index];
    struct kiln_gallery_place *places = gallery->tests[test] + index * KILN_GALLERY_ROLE_COUNT;
    const char *const names[KILN_GALLERY_ROLE_COUNT] = {
        [KILN_GALLERY_REFERENCE] = frame->reference,
        [KILN_GALLERY_RESULT] = frame->picture,
        [KILN_GALLERY_ERROR_MAP] = frame->error_map,
    };
    const struct kiln_result_place place = kiln_results_place(gallery->results, test);
    struct source sources[KILN_GALLERY_ROLE_COUNT];
    for (int i = 0; i < KILN_GALLERY_ROLE_COUNT; i++) {
        sources[i] = (struct source){place, names[i], 0};
        if (!*names[i])
            continue;
        if (i == KILN_GALLERY_RESULT && *names[KILN_GALLERY_REFERENCE] &&
            have_equal_bytes(&sources[i], &sources[KILN_GALLERY_REFERENCE]))
            places[i] = places[KILN_GALLERY_REFERENCE];
        else if (!place_picture(gallery, &sources[i], &places[i]))
            return false;
    }
    return place.results != NULL;
}

static bool place_test(struct kiln_gallery *gallery, size_t test)
{
    const struct kiln_result *result = gallery->results->tests[test];
    gallery->tests[test] = kiln_arena_alloc(
        gallery->arena, KILN_GALLERY_ROLE_COUNT * result->frame_count + 1, sizeof **gallery->tests);
    if (!gallery->tests[test])
        return false;
    size_t worst = kiln_result_worst_frame(result);
    if (result->frame_count > 0 && !place_frame(gallery, test, worst))
        return false;
    for (size_t i = 0; i < result->frame_count; i++)
        if (i != worst && !place_frame(gallery, test, i))
            return false;
    return true;
}

static bool allocate(struct kiln_gallery *gallery)
{
    size_t frames = 0;
    for (size_t i = 0; i < gallery->results->count; i++)
        frames += gallery->results->tests[i]->frame_count;
    gallery->embedded = kiln_arena_alloc(gallery->arena, KILN_GALLERY_ROLE_COUNT * frames + 1,
                                         sizeof *gallery->embedded);
    gallery->tests =
        kiln_arena_alloc(gallery->arena, gallery->results->count + 1, sizeof *gallery->tests);
    return gallery->embedded && gallery->tests;
}

static const char *find_page_folder(struct kiln_arena *arena, const char *path)
{
    char *folder = strcmp(path, "-") == 0 ? realpath(".", NULL) : absolute_folder_of(path);
    const char *copy = kiln_arena_text(arena, folder ? folder : "", folder ? strlen(folder) : 0);
    free(folder);
    return copy;
}

struct kiln_gallery *kiln_gallery_plan(const struct kiln_results *results, const size_t *order,
                                       const struct kiln_results_output *output,
                                       struct kiln_error *error)
{
    struct kiln_gallery *gallery = kiln_arena_alloc(results->arena, 1, sizeof *gallery);
    bool ok = gallery != NULL;
    if (ok) {
        gallery->results = results;
        gallery->arena = results->arena;
        gallery->link = output->link;
        gallery->page_folder = find_page_folder(results->arena, output->path);
        ok = gallery->page_folder && allocate(gallery);
    }
    for (size_t i = 0; ok && i < results->count; i++)
        ok = place_test(gallery, order[i]);
    if (!ok)
        kiln_error_no_memory(error, "the report's list of pictures");
    return ok ? gallery : NULL;
}

const struct kiln_gallery_place *kiln_gallery_places(const struct kiln_gallery *gallery,
                                                     size_t test, size_t frame)
{
    return gallery->tests[test] + frame * KILN_GALLERY_ROLE_COUNT;
}

uint32_t kiln_gallery_embedded_count(const struct kiln_gallery *gallery)
{
    return gallery->embedded_count;
}

uint32_t kiln_gallery_linked_for_size(const struct kiln_gallery *gallery)
{
    return gallery->linked_for_size;
}

/* ---- The pictures ------------------------------------------------------------------------- */

/* Returns the bytes of a preview. It is written to a file in memory, since the folder of results is
 * not the page's. */
static unsigned char *read_preview(const unsigned char *picture, size_t picture_size,
                                   const char *path, size_t *size, struct kiln_error *error)
{
    struct kiln_temporary memory = {.target = (char *)path,
                                    .file = memfd_create("kiln", MFD_CLOEXEC)};
    unsigned char *bytes = NULL;
    if (memory.file < 0) {
        kiln_error_no_memory(error, "%s", path);
        return NULL;
    }
    const bool is_written = kiln_preview_write(picture, picture_size, path, &memory, error);
    const off_t end = is_written ? lseek(memory.file, 0, SEEK_END) : -1;
    if (is_written && memory.failure == 0 && end >= 0 && lseek(memory.file, 0, SEEK_SET) == 0) {
        *size = (size_t)end;
        bytes = kiln_file_read_bytes(memory.file, path, "picture", *size, error);
    } else if (is_written) {
        kiln_error_no_memory(error, "%s", path);
    }
    close(memory.file);
    return bytes;
}

/* Returns the bytes of a picture as a PNG that a browser can show. The caller frees them. */
static unsigned char *read_shown(const struct source *source, size_t *size,
                                 struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    size_t found = 0;
    source_path(source, path);
    unsigned char *bytes = kiln_result_picture_read(&source->place, source->name, &found, error);
    *size = found;
    if (bytes && found != source->size) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the image had %zu bytes, and now has %zu: results must not change "
                       "while a report is written",
                       path, source->size, found);
        free(bytes);
        return NULL;
    }
    if (!bytes || kiln_preview_is_plain(bytes, found))
        return bytes;
    unsigned char *shown = read_preview(bytes, found, path, size, error);
    free(bytes);
    return shown;
}

void kiln_gallery_write(const struct kiln_gallery *gallery, FILE *out)
{
    for (uint32_t i = 0; i < gallery->embedded_count; i++) {
        struct kiln_error error = {0};
        size_t size = 0;
        unsigned char *bytes = read_shown(&gallery->embedded[i], &size, &error);
        fprintf(out, "<script type=\"text/plain\" id=\"p%u\"", i);
        if (!bytes) {
            fputs(" data-problem=\"", out);
            kiln_markup_write_text(out, error.message);
            fputc('"', out);
        }
        fputc('>', out);
        if (bytes)
            kiln_markup_write_base64(out, bytes, size);
        fputs("</script>\n", out);
        free(bytes);
    }
}
