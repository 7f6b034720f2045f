/* Lists the frames of a picture, a folder, a numbered pattern or a video, and decodes them in
 * order. Folders and patterns are listed when they are opened, so that missing and additional
 * frames of either side are found. Only decoding tells whether a video has a next frame. */
#include "compare/footage.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/image/animated.h"
#include "asset/image/video_in.h"
#include "base/arena.h"
#include "base/error.h"
#include "base/order.h"
#include "base/pattern.h"
#include "kiln_program.h"

struct entry {
    const char *name;
    uint32_t number;
};

struct kiln_footage {
    struct kiln_arena *arena;
    enum kiln_footage_kind kind;
    const char *path;
    const char *folder; /* of the entries; "" for the working directory */
    const char *layer;
    struct entry *entries;
    size_t count, capacity, next;

    struct kiln_loader *loader;     /* keeps the decoding process for the next picture */
    struct kiln_layers_in *layers;  /* of the frame that is open; NULL for one of a video */
    struct kiln_asset_image *taken; /* the one layer of a frame of a video */
    struct kiln_video_in *video;    /* of a video; NULL for the pages of a picture */
    uint32_t pages, pages_read;     /* of a picture with several pages */
    struct kiln_asset_image *image; /* decoded ahead */
    struct kiln_error video_error;
    bool decoded_ahead; /* the next frame, or the error in its place */
    bool at_end;
    char number_text[16];
};

static bool no_memory(const char *path, struct kiln_error *error)
{
    return kiln_error_no_memory(error, "%s", path);
}

/* ---- Lists -------------------------------------------------------------------------------- */

static bool add_entry(struct kiln_footage *footage, const char *name, uint32_t number)
{
    if (footage->count == footage->capacity) {
        size_t capacity = footage->capacity ? 2 * footage->capacity : 64;
        struct entry *entries = realloc(footage->entries, capacity * sizeof *entries);
        if (!entries)
            return false;
        footage->entries = entries;
        footage->capacity = capacity;
    }
    const char *copy = kiln_arena_text(footage->arena, name, strlen(name));
    footage->entries[footage->count++] = (struct entry){copy, number};
    return copy != NULL;
}

static bool is_picture(const char *name)
{
    static const char *const suffixes[] = {".png",  ".jpg", ".jpeg", ".webp", ".tif",
                                           ".tiff", ".bmp", ".gif",  ".exr",  ".hdr"};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && dot > name && i < sizeof suffixes / sizeof *suffixes; i++) {
        if (name[0] != '.' && strcasecmp(dot, suffixes[i]) == 0)
            return true;
    }
    return false;
}

/* Returns whether the pattern makes this name of a number, which *number receives. */
static bool has_number(const struct kiln_path_pattern *pattern, const char *folder,
                       const char *name, uint32_t *number)
{
    const char *slash = strrchr(pattern->before, '/');
    const char *before = slash ? slash + 1 : pattern->before;
    size_t length = strlen(before);
    char digits[16] = "", path[KILN_PATH_SIZE + 256], expected[KILN_PATH_SIZE + 256];
    uint64_t value = 0;
    size_t count = strncmp(name, before, length) == 0 ? strspn(name + length, "0123456789") : 0;
    if (count == 0 || count >= sizeof digits)
        return false;
    memcpy(digits, name + length, count);
    if (!kiln_text_to_uint64(digits, &value) || value > UINT32_MAX)
        return false;
    *number = (uint32_t)value;
    snprintf(path, sizeof path, "%s%s", folder, name);
    return kiln_path_pattern_format(pattern, *number, expected, sizeof expected) &&
           strcmp(path, expected) == 0;
}

static int compare_entries(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    return p->number != q->number ? (p->number > q->number) - (p->number < q->number)
                                  : kiln_order_names(p->name, q->name);
}

/* Lists the folder's names that fit the pattern or, without a pattern, its pictures. */
static bool list_entries(struct kiln_footage *footage, const struct kiln_path_pattern *pattern,
                         struct kiln_error *error)
{
    struct dirent **items = NULL;
    int count = scandir(*footage->folder ? footage->folder : ".", &items, NULL, NULL);
    if (count < 0)
        return kiln_error_set_errno(error, KILN_INVALID_INPUT, errno,
                                    "%s: the folder cannot be read", footage->path);
    bool ok = true;
    for (int i = 0; i < count; i++) {
        const char *name = items[i]->d_name;
        uint32_t number = 0;
        if (ok &&
            (pattern ? has_number(pattern, footage->folder, name, &number) : is_picture(name)))
            ok = add_entry(footage, name, number);
        free(items[i]);
    }
    free(items);
    if (!ok)
        return no_memory(footage->path, error);
    if (footage->count == 0)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: %s", footage->path,
                              pattern ? "no file fits the pattern"
                                      : "the folder has no pictures (PNG, JPEG, WebP, TIFF, BMP, "
                                        "GIF, EXR or HDR, by their suffix)");
    qsort(footage->entries, footage->count, sizeof *footage->entries, compare_entries);
    for (size_t i = 0; i < footage->count && !pattern; i++)
        footage->entries[i].number = (uint32_t)i;
    return true;
}

/* ---- Opening ------------------------------------------------------------------------------ */

/* Splits the path of a picture into its folder, with the slash, and the name after it. */
static bool open_still(struct kiln_footage *footage, struct kiln_error *error)
{
    const char *slash = strrchr(footage->path, '/');
    const char *name = slash ? slash + 1 : footage->path;
    footage->kind = KILN_FOOTAGE_STILL;
    footage->folder =
        kiln_arena_text(footage->arena, footage->path, (size_t)(name - footage->path));
    return (footage->folder && add_entry(footage, name, 0)) || no_memory(footage->path, error);
}

static bool open_folder(struct kiln_footage *footage, struct kiln_error *error)
{
    size_t length = strlen(footage->path);
    char *folder = kiln_arena_alloc(footage->arena, length + 2, 1);
    if (!folder)
        return no_memory(footage->path, error);
    memcpy(folder, footage->path, length);
    folder[length] = footage->path[length - 1] == '/' ? '\0' : '/';
    footage->folder = folder;
    footage->kind = KILN_FOOTAGE_FOLDER;
    return list_entries(footage, NULL, error);
}

static bool open_numbered(struct kiln_footage *footage, const struct kiln_path_pattern *pattern,
                          struct kiln_error *error)
{
    const char *slash = strrchr(pattern->before, '/');
    size_t length = slash ? (size_t)(slash + 1 - pattern->before) : 0;
    footage->folder = kiln_arena_text(footage->arena, pattern->before, length);
    footage->kind = KILN_FOOTAGE_NUMBERED;
    return footage->folder ? list_entries(footage, pattern, error)
                           : no_memory(footage->path, error);
}

/* The struct holds what the first bytes and the name of a file tell of its frames. */
struct content {
    bool is_video; /* WebP, PNG and GIF by their content, others by their names */
    bool is_tiff;
};

static struct content look_into(const char *path)
{
    const char *dot = strrchr(path, '.');
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct content content = {.is_video = kiln_video_in_has_suffix(path) &&
                                          (!dot || strcasecmp(dot, ".gif") != 0)};
    if (file >= 0) {
        content.is_video = content.is_video || kiln_file_is_animated(file);
        content.is_tiff = kiln_file_is_tiff(file);
        close(file);
    }
    return content;
}

/* Opens a TIFF: its pages are frames if there are several. */
static bool open_pages(struct kiln_footage *footage, struct kiln_error *error)
{
    struct kiln_error ignored = {0};
    footage->image = kiln_asset_image_load_page(footage->loader, footage->path, 0, &ignored);
    if (!footage->image || footage->image->pages < 2) {
        kiln_asset_image_destroy(&footage->image);
        return open_still(footage, error);
    }
    footage->kind = KILN_FOOTAGE_VIDEO;
    footage->pages = footage->image->pages;
    footage->pages_read = 1;
    footage->decoded_ahead = true;
    return true;
}

static bool open_path(struct kiln_footage *footage, struct kiln_error *error)
{
    struct stat status;
    bool exists = stat(footage->path, &status) == 0;
    int failure = errno;
    if (exists && S_ISDIR(status.st_mode))
        return open_folder(footage, error);
    const struct content content = exists ? look_into(footage->path) : (struct content){0};
    if (content.is_tiff)
        return open_pages(footage, error);
    if (content.is_video) {
        footage->kind = KILN_FOOTAGE_VIDEO;
        footage->video = kiln_video_in_open(footage->loader, footage->path, error);
        return footage->video != NULL;
    }
    if (exists)
        return open_still(footage, error);
    struct kiln_path_pattern pattern;
    if (!kiln_path_pattern_parse(&pattern, footage->path, KILN_NUMBER_IF_ASKED, error))
        return false;
    if (pattern.numbered)
        return open_numbered(footage, &pattern, error);
    return kiln_error_set_errno(error, KILN_INVALID_INPUT, failure, "%s", footage->path);
}

struct kiln_footage *kiln_footage_open(const char *path, const char *layer,
                                       struct kiln_error *error)
{
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_footage *footage = arena ? kiln_arena_alloc(arena, 1, sizeof *footage) : NULL;
    const char *copy = footage ? kiln_arena_text(arena, path, strlen(path)) : NULL;
    if (!copy) {
        no_memory(path, error);
        kiln_arena_destroy(&arena);
        return NULL;
    }
    const struct kiln_loader_params anywhere = {.root = NULL};
    *footage = (struct kiln_footage){
        .arena = arena, .path = copy, .layer = layer, .loader = kiln_loader_create(&anywhere)};
    if (!footage->loader) {
        no_memory(path, error);
        kiln_footage_close(&footage);
    } else if (!open_path(footage, error)) {
        if (error->code == KILN_IO)
            error->code = KILN_INVALID_INPUT;
        kiln_footage_close(&footage);
    }
    return footage;
}

static void close_layers(struct kiln_footage *footage)
{
    kiln_layers_in_close(&footage->layers);
    kiln_asset_image_destroy(&footage->taken);
}

void kiln_footage_close(struct kiln_footage **footage)
{
    if (!*footage)
        return;
    kiln_video_in_close(&(*footage)->video);
    kiln_asset_image_destroy(&(*footage)->image);
    close_layers(*footage);
    kiln_loader_destroy(&(*footage)->loader);
    free((*footage)->entries);
    struct kiln_arena *arena = (*footage)->arena;
    *footage = NULL;
    kiln_arena_destroy(&arena);
}

void kiln_footage_set_log(struct kiln_footage *footage, const struct kiln_log *log)
{
    kiln_loader_set_warn(footage->loader, (struct kiln_loader_warn){kiln_loader_log, (void *)log});
}

enum kiln_footage_kind kiln_footage_kind(const struct kiln_footage *footage)
{
    return footage->kind;
}

const char *kiln_footage_path(const struct kiln_footage *footage)
{
    return footage->path;
}

/* ---- Reading ------------------------------------------------------------------------------ */

/* Decodes the next frame or page. Returns false with the error, or true with a NULL image behind
 * the last one. */
static bool read_ahead(struct kiln_footage *footage)
{
    if (footage->video)
        return kiln_video_in_read(footage->video, &footage->image, &footage->video_error);
    if (footage->pages_read == footage->pages)
        return true;
    footage->image = kiln_asset_image_load_page(footage->loader, footage->path,
                                                footage->pages_read++, &footage->video_error);
    return footage->image != NULL;
}

static bool peek_video(struct kiln_footage *footage, struct kiln_footage_frame *frame)
{
    if (!footage->decoded_ahead && !footage->at_end) {
        footage->decoded_ahead = !read_ahead(footage) || footage->image;
        footage->at_end = !footage->decoded_ahead;
    }
    snprintf(footage->number_text, sizeof footage->number_text, "%zu", footage->next);
    *frame = (struct kiln_footage_frame){footage->number_text, (uint32_t)footage->next};
    return footage->decoded_ahead;
}

bool kiln_footage_peek(struct kiln_footage *footage, struct kiln_footage_frame *frame)
{
    if (footage->kind == KILN_FOOTAGE_VIDEO)
        return peek_video(footage, frame);
    if (footage->next == footage->count)
        return false;
    const struct entry *entry = &footage->entries[footage->next];
    *frame = (struct kiln_footage_frame){entry->name, entry->number};
    return true;
}

static struct kiln_asset_image *take_video(struct kiln_footage *footage, struct kiln_error *error)
{
    struct kiln_asset_image *image = footage->image;
    footage->image = NULL;
    footage->decoded_ahead = false;
    if (!image) {
        *error = footage->video_error;
        footage->at_end = true;
    }
    return image;
}

static bool entry_path(const struct kiln_footage *footage, const struct entry *entry,
                       char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    int length = snprintf(path, KILN_PATH_SIZE, "%s%s", footage->folder, entry->name);
    return (length >= 0 && length < KILN_PATH_SIZE) ||
           kiln_error_set(error, KILN_INVALID_INPUT, "%s: the path is too long", footage->path);
}

bool kiln_footage_file(const struct kiln_footage *footage, char path[KILN_PATH_SIZE],
                       struct kiln_error *error)
{
    if (footage->kind != KILN_FOOTAGE_VIDEO)
        return entry_path(footage, &footage->entries[footage->next], path, error);
    snprintf(path, KILN_PATH_SIZE, "%s", footage->path);
    return true;
}

static struct kiln_asset_image *take_file(const struct kiln_footage *footage,
                                          struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_footage_file(footage, path, error))
        return NULL;
    const char *layer = footage->layer ? footage->layer : "beauty";
    return kiln_asset_image_load_layer(footage->loader, path, layer, error);
}

/* Goes on to the next frame. The fault of the one before is one of its file. */
static void go_on(struct kiln_footage *footage, bool ok, struct kiln_error *error)
{
    footage->next++;
    if (!ok && error->code == KILN_IO)
        error->code = KILN_INVALID_INPUT;
}

struct kiln_asset_image *kiln_footage_take(struct kiln_footage *footage, struct kiln_error *error)
{
    struct kiln_asset_image *image = footage->kind == KILN_FOOTAGE_VIDEO
                                         ? take_video(footage, error)
                                         : take_file(footage, error);
    go_on(footage, image != NULL, error);
    return image;
}

bool kiln_footage_has_failed(const struct kiln_footage *footage)
{
    return footage->video_error.code != KILN_OK;
}

bool kiln_footage_open_layers(struct kiln_footage *footage, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    close_layers(footage);
    if (footage->kind == KILN_FOOTAGE_VIDEO)
        footage->taken = take_video(footage, error);
    else if (kiln_footage_file(footage, path, error))
        footage->layers = kiln_layers_in_open(footage->loader, path, footage->layer, error);
    const bool ok = footage->taken || footage->layers;
    go_on(footage, ok, error);
    return ok;
}

bool kiln_footage_next_layer(struct kiln_footage *footage, struct kiln_image_layer *layer,
                             struct kiln_error *error)
{
    if (footage->layers)
        return kiln_layers_in_read(footage->layers, layer, error);
    *layer = (struct kiln_image_layer){.name = "beauty", .image = footage->taken};
    footage->taken = NULL;
    return true;
}

void kiln_footage_skip(struct kiln_footage *footage)
{
    if (footage->kind == KILN_FOOTAGE_VIDEO && !footage->image)
        footage->at_end = true;
    kiln_asset_image_destroy(&footage->image);
    footage->decoded_ahead = false;
    footage->next++;
}

/* ---- All frames ------------------------------------------------------------------------------ */

bool kiln_footage_visit(const struct kiln_footage *footage,
                        bool (*visit)(void *user, const struct kiln_footage_frame *frame),
                        void *user)
{
    if (footage->kind == KILN_FOOTAGE_VIDEO)
        return visit(user, &(struct kiln_footage_frame){"0", 0});
    for (size_t i = 0; i < footage->count; i++) {
        const struct entry *entry = &footage->entries[i];
        if (!visit(user, &(struct kiln_footage_frame){entry->name, entry->number}))
            return false;
    }
    return true;
}

bool kiln_footage_claim(const struct kiln_footage *footage, const char *what,
                        struct kiln_claims *claims, struct kiln_error *error)
{
    if (footage->kind == KILN_FOOTAGE_VIDEO)
        return kiln_claims_read(claims, footage->path, what, error);
    for (size_t i = 0; i < footage->count; i++) {
        char path[KILN_PATH_SIZE];
        if (!entry_path(footage, &footage->entries[i], path, error) ||
            !kiln_claims_read(claims, path, what, error))
            return false;
    }
    return true;
}
