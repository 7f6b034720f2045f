/* Reads test files by an option table, as scenes are read, so that error messages and the reference
 * have the same form. */
#include "suite/test_file.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "option/reader.h"
#include "option/reference.h"
#include "option/rows.h"
#include "suite/golden.h"
#include "suite/type.h"

enum { MAX_FILE_SIZE = 1 << 20, MAX_OVERRIDES = 64, MAX_TEXT = 4000 };

/* The struct that the option table of this file fills. */
struct document {
    uint32_t version;
    const char *scene, *about, *reason;
    const char *set[MAX_OVERRIDES];
    uint32_t set_count;
    uint32_t size[2];
    uint32_t frames[KILN_TEST_MAX_FRAMES];
    uint32_t frame_count;
    enum kiln_test_format format;
    enum kiln_test_golden golden;
    const char *devices[KILN_TEST_MAX_DEVICES];
    uint32_t device_count;
    const char *techniques[KILN_TEST_MAX_TECHNIQUES];
    uint32_t technique_count;
    struct kiln_expect_value limits[KILN_MAX_COLUMNS];
    uint32_t limit_count;
    double warn, threshold, time_limit_s;
    uint32_t window;
    struct kiln_test_mask masks[KILN_TEST_MAX_MASKS];
    uint32_t mask_count;
};

static const char *const formats[] = {
    [KILN_TEST_PNG] = "png",
    [KILN_TEST_PNG16] = "png16",
    [KILN_TEST_EXR] = "exr",
    NULL,
};

static const char *const goldens[] = {
    [KILN_GOLDEN_PICTURE] = "picture",
    [KILN_GOLDEN_HASH] = "hash",
    NULL,
};

ITEM(override_item, override, LIMITS(KILN_PLAIN, 1, MAX_TEXT));
ITEM(device_item, device, LIMITS(KILN_PLAIN, 1, 127));
ITEM(technique_item, technique, LIMITS(KILN_PLAIN, 1, 60));

#define FILLS struct document

/* name, field, smallest and largest length, default, help */
#define TEXT(n, f, least, def, h)                                                                  \
    {                                                                                              \
        ROW(NO_PART, n, text, f, def, h), LIMITS(KILN_PLAIN, least, MAX_TEXT)                      \
    }

TABLE(rows) = {
    INTEGER(NO_PART, "kiln_test", version, 1, 1, NULL, "Version of the format of test files."),
    TEXT("scene", scene, 1, NULL, "The scene's path, from the test file's folder."),
    TEXT("about", about, 0, "\"\"", "Purpose of the test, which reports show."),
    LIST(NO_PART, "set", set, override_item, set_count, "[]", "Changes of keys of the scene."),
    {ROW(NO_PART, "size", size, size, "scene", "Width and height of the pictures."),
     LIMITS(KILN_PIXELS, 16, 16384)},
    {ROW(NO_PART, "frames", frames, frames, "auto",
         "The frames to judge. auto takes the middle frame and the last frame of the scene."),
     COUNTED(frames, frame_count)},
    CHOICE(NO_PART, "format", format, formats, "png", "Format of the pictures, goldens included."),
    CHOICE(NO_PART, "golden", golden, goldens, "picture",
           "What is kept of an accepted frame: pictures, or only the hashes of state and pixels. "
           "With hashes alone, any change fails."),
    LIST(NO_PART, "devices", devices, device_item, device_count, "[]",
         "Devices to test. Several devices make a test for each. A test is skipped where its "
         "device is missing. With none, the device of the run is used."),
    LIST(NO_PART, "techniques", techniques, technique_item, technique_count, "[]",
         "Techniques of stages. Other stages use cpu or, where a stage has no such technique, its "
         "first one."),
    {ROW(NO_PART, "limits", limits, limits, "{}",
         "The worst values that pass, in place of the default limits, which "
         "are " KILN_COMPARE_DEFAULT_LIMITS "."),
     COUNTED(limits, limit_count)},
    TEXT("reason", reason, 0, "\"\"", "Reason for these limits."),
    {ROW(NO_PART, "warn", number, warn, "0.5",
         "A frame that passes with a score above this is a warning. A score of 1 is just within "
         "the limits."),
     LIMITS(KILN_PLAIN, 0, 1)},
    {ROW(NO_PART, "threshold", number, threshold, "2",
         "Threshold in 1/255 of sRGB's range. Pixels that differ by more are counted."),
     LIMITS(KILN_PLAIN, 0, 255)},
    INTEGER(
        NO_PART, "window", window, 1, 16384, "32",
        "Edge in pixels of the window that is searched for where differing pixels are densest."),
    LIST(NO_PART, "masks", masks, kiln_mask_item, mask_count, "[]",
         "Parts of the pictures that are not judged."),
    {ROW(NO_PART, "time_limit", number, time_limit_s, "120 s",
         "Time limit. A test that takes longer is stopped."),
     LIMITS(KILN_SECONDS, 0.1, 86400)},
    END,
};

bool kiln_test_write_reference(FILE *out)
{
    static const char introduction[] =
        "A golden-image test is a YAML file whose name ends in .test.yaml, beside the scene that "
        "it\n"
        "names or anywhere else:\n"
        "\n"
        "    kiln_test: 1\n"
        "    scene: ../scenes/fire.yaml\n"
        "    frames: [24, 96]\n"
        "    size: [320, 180]\n"
        "\n"
        "A scene that no such file names is a test with the default of every key.\n"
        "\n";
    return kiln_reference_write(out, introduction, rows);
}

/* ---- from the document to the test ---------------------------------------------------------- */

static bool out_of_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "reading tests");
}

/* Returns a path in the file `base`, which is relative to that file's folder, as one that can be
 * opened. */
static const char *resolve(struct kiln_arena *arena, const char *base, const char *path)
{
    const char *slash = strrchr(base, '/');
    int folder = slash && *path != '/' ? (int)(slash + 1 - base) : 0;
    return kiln_arena_format(arena, "%.*s%s", folder, base, path);
}

static bool add_text(struct kiln_arena *arena, const char **texts, size_t *count, const char *text)
{
    texts[*count] = kiln_arena_text(arena, text, strlen(text));
    return texts[(*count)++] != NULL;
}

static bool take_limits(struct kiln_arena *arena, const struct document *document,
                        struct kiln_test *test)
{
    test->limits = kiln_arena_alloc(arena, document->limit_count + 1u, sizeof *test->limits);
    bool ok = test->limits != NULL;
    for (uint32_t i = 0; ok && i < document->limit_count; i++) {
        char number[32], limit[64];
        kiln_text_from_double(number, document->limits[i].value);
        snprintf(limit, sizeof limit, "%s=%s", document->limits[i].metric, number);
        ok = add_text(arena, test->limits, &test->limit_count, limit);
    }
    return ok;
}

static bool take_overrides(struct kiln_arena *arena, const struct document *document,
                           struct kiln_test *test)
{
    test->overrides = kiln_arena_alloc(arena, document->set_count + 1u, sizeof *test->overrides);
    bool ok = test->overrides != NULL;
    for (uint32_t i = 0; ok && i < document->set_count; i++)
        test->overrides[test->override_count++] = document->set[i];
    char size[64];
    snprintf(size, sizeof size, "output.size=[%u, %u]", document->size[0], document->size[1]);
    if (ok && document->size[0] > 0)
        ok = add_text(arena, test->overrides, &test->override_count, size);
    return ok;
}

/* Fills the test from a document. The test points to the document's arrays, since both lie in the
 * arena. */
static bool take_document(struct kiln_arena *arena, struct document *document, const char *path,
                          struct kiln_test_file *file)
{
    struct kiln_test *test = &file->test;
    test->about = document->about;
    test->limits_reason = document->reason;
    test->frames = document->frames;
    test->frame_count = document->frame_count;
    test->format = document->format;
    test->golden_form = document->golden;
    test->warn = document->warn;
    test->threshold = document->threshold;
    test->window = document->window;
    test->masks = document->masks;
    test->mask_count = document->mask_count;
    test->time_limit_s = document->time_limit_s;
    test->techniques = document->techniques;
    test->technique_count = document->technique_count;
    test->limit_count = test->override_count = 0;
    file->devices = document->devices;
    file->device_count = document->device_count;
    bool ok = true;
    for (size_t i = 0; ok && i < test->mask_count; i++) {
        struct kiln_test_mask *mask = &test->masks[i];
        if (mask->picture)
            ok = (mask->picture = resolve(arena, path, mask->picture)) != NULL;
    }
    return ok && take_limits(arena, document, test) && take_overrides(arena, document, test);
}

/* ---- reading -------------------------------------------------------------------------------- */

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

bool kiln_test_file_is(const char *path)
{
    return ends_with(path, ".test.yaml") || ends_with(path, ".test.yml");
}

bool kiln_test_file_is_yaml(const char *path)
{
    return ends_with(path, ".yaml") || ends_with(path, ".yml");
}

/* Checks that the devices have different names: two devices of one name would overwrite each
 * other's results. */
static bool check_devices(struct kiln_reader *reader, const struct kiln_node *root,
                          const struct document *document)
{
    for (uint32_t i = 0; i < document->device_count; i++) {
        for (uint32_t j = 0; j < i; j++) {
            char a[KILN_DEVICE_NAME_SIZE], b[KILN_DEVICE_NAME_SIZE];
            kiln_device_name(document->devices[i], a);
            kiln_device_name(document->devices[j], b);
            if (strcmp(a, b) == 0)
                return kiln_reader_error_at(reader, root, "devices", "'%s' is given twice", a);
        }
    }
    return true;
}

/* Checks that a test that keeps hashes alone has no limits and masks, which need golden pictures.
 */
static bool check_golden(struct kiln_reader *reader, const struct kiln_node *root,
                         const struct document *document)
{
    const bool compares = document->limit_count > 0 || document->mask_count > 0;
    return document->golden != KILN_GOLDEN_HASH || !compares ||
           kiln_reader_error_at(reader, root, "golden",
                                "hash keeps no picture, so limits and masks are not allowed");
}

/* Fills the test with the defaults of all options. */
static bool take_defaults(struct kiln_arena *arena, struct kiln_arena *scratch, const char *path,
                          struct kiln_test_file *file, struct kiln_error *error)
{
    struct document *document = kiln_arena_alloc(arena, 1, sizeof *document);
    if (!document)
        return out_of_memory(error);
    static const struct kiln_origin origin = {.name = "", .kind = "a test"};
    static const char least[] = "{kiln_test: 1, scene: scene}";
    struct kiln_reader reader = {
        .origin = &origin, .arena = arena, .scratch = scratch, .error = error, .target = document};
    return kiln_read_document(&reader, rows, least, sizeof least - 1) &&
           (take_document(arena, document, path, file) || out_of_memory(error));
}

/* Fills the test from the text of its file. Returns false with `problem` for a fault in the text.
 */
static bool take_text(struct kiln_arena *arena, struct kiln_arena *scratch, const char *text,
                      size_t size, struct kiln_test_file *file, struct kiln_error *problem)
{
    const char *path = file->test.path;
    struct document *document = kiln_arena_alloc(arena, 1, sizeof *document);
    if (!document)
        return out_of_memory(problem);
    struct kiln_origin origin = {
        .name = path, .has_lines = true, .kind = "a test", .version = "kiln_test: 1"};
    struct kiln_reader reader = {.origin = &origin,
                                 .arena = arena,
                                 .scratch = scratch,
                                 .error = problem,
                                 .target = document};
    const struct kiln_node *root = kiln_node_parse(scratch, text, size, &origin, problem);
    if (!root)
        return false;
    const struct kiln_node *scene = kiln_node_entry(root, "scene");
    if (scene && scene->kind == KILN_NODE_SCALAR && *scene->text &&
        !(file->test.scene = resolve(arena, path, scene->text)))
        return out_of_memory(problem);
    return kiln_read_members(&reader, rows, root, document) &&
           check_devices(&reader, root, document) && check_golden(&reader, root, document) &&
           (take_document(arena, document, path, file) || out_of_memory(problem));
}

/* Fills the test with the defaults and then from `text`, which is NULL if the file is a scene or
 * could not be read. */
static bool take_file(struct kiln_arena *arena, const char *text, size_t size, const char *path,
                      struct kiln_test_file *file, struct kiln_error *error)
{
    struct kiln_arena *scratch = kiln_arena_create();
    const char *own_path = kiln_arena_text(arena, path, strlen(path));
    *file = (struct kiln_test_file){.test = {.path = own_path, .scene = own_path}};
    struct kiln_error problem = {0};
    bool ok = scratch && own_path ? take_defaults(arena, scratch, path, file, error)
                                  : out_of_memory(error);
    if (ok && text && !take_text(arena, scratch, text, size, file, &problem)) {
        ok = problem.code != KILN_DEVICE_FAILED;
        *(ok ? &file->test.problem : error) = problem;
    }
    kiln_arena_destroy(&scratch);
    return ok;
}

bool kiln_test_file_parse(struct kiln_arena *arena, const char *text, size_t size, const char *path,
                          struct kiln_test_file *file, struct kiln_error *error)
{
    return take_file(arena, text, size, path, file, error);
}

bool kiln_test_file_read(struct kiln_arena *arena, const char *path, struct kiln_test_file *file,
                         struct kiln_error *error)
{
    struct kiln_error problem = {0};
    char *text = NULL;
    size_t size = 0;
    if (kiln_test_file_is(path))
        text = kiln_text_file_read(path, "a test file", MAX_FILE_SIZE, &size, &problem);
    bool ok = take_file(arena, text, size, path, file, error);
    free(text);
    if (ok && problem.code != KILN_OK)
        file->test.problem = problem;
    return ok;
}
