/* Reads and writes expect.yaml, which records what was accepted of a test. An option table reads
 * it, as with scenes. Separate code writes it, since it writes only the members that are known, and
 * a frame's entry for a device in one line. */
#include "suite/expect.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary.h"
#include "option/reader.h"
#include "option/rows.h"
#include "suite/golden.h"
#include "suite/type.h"

enum { MAX_FILE_SIZE = 16 << 20, MAX_DEVICES = 64, MAX_TEXT = 4000 };

/* The struct that the option table of this file fills. */
struct document {
    uint32_t version;
    const char *scene_hash, *reason;
    const char *techniques[KILN_TEST_MAX_TECHNIQUES];
    uint32_t technique_count;
    struct kiln_expect_value limits[KILN_MAX_COLUMNS], measured[KILN_MAX_COLUMNS];
    uint32_t limit_count, measured_count;
    double warn;
    struct kiln_test_mask masks[KILN_TEST_MAX_MASKS];
    uint32_t mask_count;
    struct kiln_expect_frame *frames;
    uint32_t frame_count;
    struct kiln_expect expect;
};

static bool out_of_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "reading what is expected");
}

/* ---- types ---------------------------------------------------------------------------------- */

/* Reads a hash of `max` digits; "" is read as NULL where `min` is 0. */
static bool read_hex(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, void *field)
{
    const char *text = node->kind == KILN_NODE_SCALAR ? node->text : "-", *copy = NULL;
    size_t length = strlen(text);
    bool none = length == 0 && node->quoted && option->min == 0;
    if (!none && ((double)length != option->max || strspn(text, "0123456789abcdef") != length))
        return kiln_reader_mismatch(reader, option, node);
    if (!none && !(copy = kiln_arena_text(reader->arena, text, length)))
        return kiln_reader_out_of_memory(reader);
    memcpy(field, &copy, sizeof copy);
    return true;
}

static void describe_hex(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "a hash of %.0f hex digits", option->max);
}

typedef const char *kiln_fills_hex;
static const struct kiln_option_type kiln_type_hex = {.read = read_hex, .describe = describe_hex};

#define FILLS struct kiln_expect_pixels

TABLE(pixels_rows) = {
    {ROW(NO_PART, "hash", hex, hash, NULL, NULL), LIMITS(KILN_PLAIN, 64, 64)},
    {ROW(NO_PART, "golden", hex, golden, "\"\"", NULL), LIMITS(KILN_PLAIN, 0, 64)},
    {ROW(NO_PART, "kiln", text, kiln, "\"\"", "State and pixels that were accepted."),
     LIMITS(KILN_PLAIN, 0, 60)},
    END,
};

/* Reads a map of devices to their hashes; `field` is the struct kiln_expect_frame. */
static bool read_pixels(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_expect_frame *frame = field;
    if (node->kind != KILN_NODE_MAP)
        return kiln_reader_mismatch(reader, option, node);
    if (node->count > MAX_DEVICES)
        return kiln_reader_error(reader, node, "%u devices are too many; at most %d", node->count,
                                 MAX_DEVICES);
    frame->pixels = kiln_arena_alloc(reader->arena, node->count + 1u, sizeof *frame->pixels);
    if (!frame->pixels)
        return kiln_reader_out_of_memory(reader);
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        struct kiln_expect_pixels *pixels = &frame->pixels[frame->pixel_count];
        const char *device = entry->key->text;
        char name[KILN_DEVICE_NAME_SIZE];
        size_t before = kiln_reader_enter(reader, device);
        kiln_device_name(device, name);
        if (strcmp(name, device) != 0)
            return kiln_reader_error(reader, entry->key,
                                     "no device's name; a name has lower-case letters, digits, '.' "
                                     "and '-', as in llvmpipe-llvm-15.0.6-256-bits");
        if (!kiln_reader_copy_text(reader, device, &pixels->device) ||
            !kiln_read_members(reader, pixels_rows, entry, pixels))
            return false;
        kiln_reader_leave(reader, before);
        frame->pixel_count++;
    }
    return true;
}

static void describe_pixels(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{device: {hash: ..., golden: ...}, ...}");
}

typedef struct kiln_expect_frame kiln_fills_pixels;
static const struct kiln_option_type kiln_type_pixels = {.read = read_pixels,
                                                         .describe = describe_pixels};

#undef FILLS
#define FILLS struct kiln_expect_frame

TABLE(frame_rows) = {
    {ROW(NO_PART, "state", hex, state, "\"\"", NULL), LIMITS(KILN_PLAIN, 0, 16)},
    {ROW_OF_ALL(NO_PART, "pixels", pixels, "{}", NULL)},
    END,
};

static const struct kiln_option frame_number = {.type = &kiln_type_integer,
                                                LIMITS(KILN_PLAIN, 0, KILN_TEST_MAX_FRAME)};

static int by_number(const void *a, const void *b)
{
    uint32_t x = ((const struct kiln_expect_frame *)a)->number;
    uint32_t y = ((const struct kiln_expect_frame *)b)->number;
    return (x > y) - (x < y);
}

/* Reads a map of frames; `field` is the struct document. */
static bool read_frames(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct document *document = field;
    if (node->kind != KILN_NODE_MAP)
        return kiln_reader_mismatch(reader, option, node);
    document->frames = kiln_arena_alloc(reader->arena, node->count + 1u, sizeof *document->frames);
    if (!document->frames)
        return kiln_reader_out_of_memory(reader);
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        struct kiln_expect_frame *frame = &document->frames[document->frame_count];
        size_t before = kiln_reader_enter(reader, entry->key->text);
        if (!kiln_read_whole(reader, &frame_number, entry->key, &frame->number))
            return false;
        for (uint32_t i = 0; i < document->frame_count; i++) {
            if (document->frames[i].number == frame->number)
                return kiln_reader_error(reader, entry->key, "frame %u is given twice",
                                         frame->number);
        }
        if (!kiln_read_members(reader, frame_rows, entry, frame))
            return false;
        kiln_reader_leave(reader, before);
        document->frame_count++;
    }
    qsort(document->frames, document->frame_count, sizeof *document->frames, by_number);
    return true;
}

static void describe_frames(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{number: {state: ..., pixels: ...}, ...}");
}

typedef struct document kiln_fills_document_frames;
static const struct kiln_option_type kiln_type_document_frames = {.read = read_frames,
                                                                  .describe = describe_frames};

/* ---- the file ------------------------------------------------------------------------------- */

#undef FILLS
#define FILLS struct document

ITEM(technique_item, text, LIMITS(KILN_PLAIN, 1, 60));

TABLE(rows) = {
    INTEGER(NO_PART, "kiln_expect", version, 1, 1, NULL, "Version of the format."),
    {ROW(NO_PART, "scene_hash", hex, scene_hash, "\"\"", NULL), LIMITS(KILN_PLAIN, 0, 64)},
    LIST(NO_PART, "techniques", techniques, technique_item, technique_count, "[]",
         "Scene, kiln and device that were accepted."),
    {ROW(NO_PART, "limits", limits, limits, "{}", "Over those of the test."),
     COUNTED(limits, limit_count)},
    {ROW(NO_PART, "reason", text, reason, "\"\"", "Why these limits."),
     LIMITS(KILN_PLAIN, 0, MAX_TEXT)},
    {ROW(NO_PART, "warn", number, warn, "-1", "A score; below 0 is the test's."),
     LIMITS(KILN_PLAIN, -1, 1)},
    LIST(NO_PART, "masks", masks, kiln_mask_item, mask_count, "[]", "More than those of the test."),
    {ROW(NO_PART, "measured", limits, measured, "{}", "The worst values of calibration."),
     COUNTED(measured, measured_count)},
    {ROW_OF_ALL(NO_PART, "frames", document_frames, "{}", NULL)},
    END,
};

/* Makes the paths of mask pictures, which are relative to the folder of goldens, such that they can
 * be opened. */
static bool resolve_masks(struct kiln_arena *arena, struct document *document, const char *golden)
{
    for (uint32_t i = 0; i < document->mask_count; i++) {
        struct kiln_test_mask *mask = &document->masks[i];
        if (!mask->picture || *mask->picture == '/')
            continue;
        mask->picture = kiln_arena_format(arena, "%s/%s", golden, mask->picture);
        if (!mask->picture)
            return false;
    }
    return true;
}

/* Returns the kiln_expect of a document. It points to the document's arrays, since both lie in the
 * arena. */
static struct kiln_expect *take_document(struct document *document)
{
    document->expect = (struct kiln_expect){
        .scene_hash = document->scene_hash,
        .techniques = document->techniques,
        .technique_count = document->technique_count,
        .limits = document->limits,
        .measured = document->measured,
        .limit_count = document->limit_count,
        .measured_count = document->measured_count,
        .reason = document->reason,
        .warn = document->warn,
        .masks = document->masks,
        .mask_count = document->mask_count,
        .frames = document->frames,
        .frame_count = document->frame_count,
    };
    return &document->expect;
}

static struct kiln_expect *read_document(struct kiln_arena *arena, struct kiln_arena *scratch,
                                         const char *text, size_t size, const char *golden,
                                         struct kiln_error *error)
{
    const char *path = kiln_arena_format(scratch, "%s/expect.yaml", golden);
    struct document *document = kiln_arena_alloc(arena, 1, sizeof *document);
    if (!path || !document) {
        out_of_memory(error);
        return NULL;
    }
    const struct kiln_origin origin = {
        .name = path, .has_lines = true, .kind = "an expect.yaml", .version = "kiln_expect: 1"};
    struct kiln_reader reader = {
        .origin = &origin, .arena = arena, .scratch = scratch, .error = error, .target = document};
    if (!kiln_read_document(&reader, rows, text, size))
        return NULL;
    if (resolve_masks(arena, document, golden))
        return take_document(document);
    out_of_memory(error);
    return NULL;
}

struct kiln_expect *kiln_expect_parse(struct kiln_arena *arena, const char *text, size_t size,
                                      const char *golden, struct kiln_error *error)
{
    struct kiln_arena *scratch = kiln_arena_create();
    struct kiln_expect *expect =
        scratch ? read_document(arena, scratch, text, size, golden, error) : NULL;
    if (!scratch)
        out_of_memory(error);
    kiln_arena_destroy(&scratch);
    return expect;
}

struct kiln_expect *kiln_expect_read(struct kiln_arena *arena, const char *golden,
                                     struct kiln_error *error)
{
    static const char nothing[] = "kiln_expect: 1";
    struct stat status;
    char path[KILN_PATH_SIZE];
    size_t size = 0;
    if (!kiln_path_join(path, golden, "expect.yaml", error))
        return NULL;
    if (lstat(path, &status) != 0) {
        if (errno == ENOENT) {
            struct kiln_expect *expect =
                kiln_expect_parse(arena, nothing, sizeof nothing - 1, golden, error);
            if (expect)
                expect->missing = true;
            return expect;
        }
        kiln_error_set_errno(error, KILN_IO, errno, "%s", path);
        return NULL;
    }
    char *text = kiln_text_file_read(path, "an expect.yaml", MAX_FILE_SIZE, &size, error);
    struct kiln_expect *expect = text ? kiln_expect_parse(arena, text, size, golden, error) : NULL;
    free(text);
    return expect;
}

/* ---- writing -------------------------------------------------------------------------------- */

static void print_text(struct kiln_text *text, const char *name, const char *value)
{
    if (!value || !*value)
        return;
    kiln_text_add(text, "%s: ", name);
    kiln_text_add_json(text, value);
    kiln_text_add(text, "\n");
}

static void print_values(struct kiln_text *text, const char *name,
                         const struct kiln_expect_value *values, size_t count)
{
    bool any = false;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(values[i].value)) /* the psnr of equal pictures is infinite */
            continue;
        char number[32];
        kiln_text_from_double(number, values[i].value);
        kiln_text_add(text, any ? ", %s: %s" : "%s: {%s: %s", any ? values[i].metric : name,
                      any ? number : values[i].metric, number);
        any = true;
    }
    if (any)
        kiln_text_add(text, "}\n");
}

static void print_techniques(struct kiln_text *text, const struct kiln_expect *expect)
{
    for (size_t i = 0; i < expect->technique_count; i++) {
        kiln_text_add(text, "%s", i ? ", " : "techniques: [");
        kiln_text_add_json(text, expect->techniques[i]);
    }
    if (expect->technique_count)
        kiln_text_add(text, "]\n");
}

static void print_masks(struct kiln_text *text, const struct kiln_expect *expect,
                        const char *golden)
{
    size_t folder = strlen(golden);
    for (size_t i = 0; i < expect->mask_count; i++) {
        const struct kiln_test_mask *mask = &expect->masks[i];
        kiln_text_add(text, "%s", i ? "  - {" : "masks:\n  - {");
        if (mask->picture) {
            bool inside = strncmp(mask->picture, golden, folder) == 0 &&
                          mask->picture[folder] == '/' && mask->picture[folder + 1] != '/';
            kiln_text_add(text, "picture: ");
            kiln_text_add_json(text, mask->picture + (inside ? folder + 1 : 0));
        } else {
            kiln_text_add(text, "rect: [%u, %u, %u, %u]", mask->rect[0], mask->rect[1],
                          mask->rect[2], mask->rect[3]);
        }
        if (mask->reason && *mask->reason) {
            kiln_text_add(text, ", reason: ");
            kiln_text_add_json(text, mask->reason);
        }
        kiln_text_add(text, "}\n");
    }
}

static void print_frames(struct kiln_text *text, const struct kiln_expect *expect)
{
    for (size_t i = 0; i < expect->frame_count; i++) {
        const struct kiln_expect_frame *frame = &expect->frames[i];
        bool empty = !frame->state && frame->pixel_count == 0;
        kiln_text_add(text, "%s  %u:%s\n", i ? "" : "frames:\n", frame->number, empty ? " {}" : "");
        if (frame->state)
            kiln_text_add(text, "    state: \"%s\"\n", frame->state);
        for (size_t p = 0; p < frame->pixel_count; p++) {
            const struct kiln_expect_pixels *pixels = &frame->pixels[p];
            kiln_text_add(text, "%s      %s: {hash: \"%s\"", p ? "" : "    pixels:\n",
                          pixels->device, pixels->hash);
            if (pixels->golden)
                kiln_text_add(text, ", golden: \"%s\"", pixels->golden);
            if (pixels->kiln && *pixels->kiln) {
                kiln_text_add(text, ", kiln: ");
                kiln_text_add_json(text, pixels->kiln);
            }
            kiln_text_add(text, "}\n");
        }
    }
}

bool kiln_expect_print(const struct kiln_expect *expect, const char *golden, struct kiln_text *text)
{
    if (!expect->hashes_only)
        kiln_text_add(text,
                      "# Written by kiln test, and rewritten by it: comments are not kept.\n");
    kiln_text_add(text, "kiln_expect: 1\n");
    print_text(text, "scene_hash", expect->scene_hash);
    if (!expect->hashes_only)
        print_techniques(text, expect);
    print_values(text, "limits", expect->limits, expect->limit_count);
    print_text(text, "reason", expect->reason);
    if (expect->warn >= 0) {
        char number[32];
        kiln_text_from_double(number, expect->warn);
        kiln_text_add(text, "warn: %s\n", number);
    }
    print_masks(text, expect, golden);
    print_values(text, "measured", expect->measured, expect->measured_count);
    print_frames(text, expect);
    return !text->failed;
}

/* Checks that the text can be read again: a file that cannot be read must not take the place of one
 * that can. */
static bool check_text(const struct kiln_text *text, const char *golden, struct kiln_error *error)
{
    struct kiln_arena *arena = kiln_arena_create();
    bool ok = arena ? kiln_expect_parse(arena, text->data, text->length, golden, error) != NULL
                    : out_of_memory(error);
    kiln_arena_destroy(&arena);
    return ok && (text->length <= MAX_FILE_SIZE ||
                  kiln_error_set(error, KILN_INVALID_INPUT,
                                 "%s/expect.yaml: it would have more than %d bytes", golden,
                                 MAX_FILE_SIZE));
}

bool kiln_expect_write(const struct kiln_expect *expect, const char *golden,
                       struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    struct kiln_text text = {0};
    bool ok = kiln_path_join(path, golden, "expect.yaml", error) &&
              (kiln_expect_print(expect, golden, &text) || out_of_memory(error)) &&
              check_text(&text, golden, error) &&
              kiln_temporary_write_file(path, text.data, text.length, error);
    kiln_text_free(&text);
    return ok;
}

/* ---- entries -------------------------------------------------------------------------------- */

struct kiln_expect_frame *kiln_expect_find(const struct kiln_expect *expect, uint32_t number)
{
    const struct kiln_expect_frame key = {.number = number};
    if (expect->frame_count == 0)
        return NULL;
    return bsearch(&key, expect->frames, expect->frame_count, sizeof key, by_number);
}

static struct kiln_expect_frame *insert_frame(struct kiln_arena *arena, struct kiln_expect *expect,
                                              uint32_t number)
{
    size_t at = 0, count = expect->frame_count;
    while (at < count && expect->frames[at].number < number)
        at++;
    struct kiln_expect_frame *frames = kiln_arena_alloc(arena, count + 1, sizeof *frames);
    if (!frames)
        return NULL;
    if (count) {
        memcpy(frames, expect->frames, at * sizeof *frames);
        memcpy(frames + at + 1, expect->frames + at, (count - at) * sizeof *frames);
    }
    frames[at].number = number;
    expect->frames = frames;
    expect->frame_count++;
    return &frames[at];
}

static struct kiln_expect_pixels *insert_pixels(struct kiln_arena *arena,
                                                struct kiln_expect_frame *frame, const char *device)
{
    size_t at = 0, count = frame->pixel_count;
    for (size_t i = 0; i < count; i++) { /* a file edited by hand may have any order */
        int order = strcmp(frame->pixels[i].device, device);
        if (order == 0)
            return &frame->pixels[i];
        if (order < 0)
            at = i + 1;
    }
    struct kiln_expect_pixels *pixels = kiln_arena_alloc(arena, count + 1, sizeof *pixels);
    if (!pixels)
        return NULL;
    if (count) {
        memcpy(pixels, frame->pixels, at * sizeof *pixels);
        memcpy(pixels + at + 1, frame->pixels + at, (count - at) * sizeof *pixels);
    }
    frame->pixels = pixels;
    frame->pixel_count++;
    return &pixels[at];
}

/* Copies a text into the arena; NULL stays NULL. Returns false when memory is short. */
static bool copy_text(struct kiln_arena *arena, const char **to, const char *text)
{
    *to = text ? kiln_arena_text(arena, text, strlen(text)) : NULL;
    return !text || *to;
}

bool kiln_expect_accept(struct kiln_arena *arena, struct kiln_expect *expect, uint32_t number,
                        const char *state, const struct kiln_expect_pixels *pixels)
{
    struct kiln_expect_frame *frame = kiln_expect_find(expect, number);
    if (!frame)
        frame = insert_frame(arena, expect, number);
    if (!frame)
        return false;
    if (state && !(frame->state = kiln_arena_text(arena, state, strlen(state))))
        return false;
    if (!pixels)
        return true;
    struct kiln_expect_pixels copy = {0};
    bool copied = copy_text(arena, &copy.device, pixels->device) &&
                  copy_text(arena, &copy.hash, pixels->hash) &&
                  copy_text(arena, &copy.golden, pixels->golden) &&
                  copy_text(arena, &copy.kiln, pixels->kiln);
    struct kiln_expect_pixels *entry = copied ? insert_pixels(arena, frame, copy.device) : NULL;
    if (entry)
        *entry = copy;
    return entry != NULL;
}

bool kiln_expect_set_techniques(struct kiln_arena *arena, struct kiln_expect *expect,
                                const char *techniques)
{
    const char **list = kiln_arena_alloc(arena, strlen(techniques) / 2 + 1, sizeof *list);
    size_t count = 0;
    for (const char *rest = techniques + strspn(techniques, " "); list && *rest;) {
        size_t length = strcspn(rest, " ");
        list[count] = kiln_arena_text(arena, rest, length);
        if (!list[count++])
            return false;
        rest += length;
        rest += strspn(rest, " ");
    }
    expect->techniques = list;
    expect->technique_count = count;
    return list != NULL;
}
