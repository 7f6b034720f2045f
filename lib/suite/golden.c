/* Finds, hashes, locks and accepts the golden pictures of tests (golden.h has the form of their
 * names). Goldens are found in the list of their folder's files. Opening a file to see whether it
 * exists would not do, since a golden that cannot be read would then look as if it were missing. */
#include "suite/golden.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "base/error.h"
#include "base/file.h"
#include "base/file_in.h"
#include "base/hash.h"
#include "base/temporary.h"

void kiln_device_name(const char *renderer, char name[KILN_DEVICE_NAME_SIZE])
{
    size_t length = 0;
    bool gap = false;
    for (const char *c = renderer; *c; c++) {
        bool capital = *c >= 'A' && *c <= 'Z';
        bool is_name_character =
            capital || (*c >= 'a' && *c <= 'z') || (*c >= '0' && *c <= '9') || *c == '.';
        if (is_name_character && length + 2 + gap > KILN_DEVICE_NAME_SIZE)
            break;
        if (is_name_character && gap && length > 0)
            name[length++] = '-';
        if (is_name_character)
            name[length] = *c;
        if (capital)
            name[length] = (char)(*c - 'A' + 'a');
        length += is_name_character;
        gap = !is_name_character;
    }
    name[length] = '\0';
}

/* ---- names ---------------------------------------------------------------------------------- */

/* Holds the parts of a golden's name. */
struct golden_name {
    char device[KILN_DEVICE_NAME_SIZE]; /* "": the golden is for all devices */
    unsigned number;                    /* the number after '~'; 1 if there is none */
};

const char *kiln_test_suffix(const struct kiln_test *test)
{
    return test->format == KILN_TEST_EXR ? ".exr" : ".png";
}

static bool write_path(const struct kiln_test *test, uint32_t frame, const char *device,
                       unsigned number, char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    char alternative[16] = "";
    if (number > 1)
        snprintf(alternative, sizeof alternative, "~%u", number);
    int length = snprintf(path, KILN_PATH_SIZE, "%s/frame_%04u%s%s%s%s", test->golden, frame,
                          *device ? "@" : "", device, alternative, kiln_test_suffix(test));
    return length < KILN_PATH_SIZE ||
           kiln_error_set(error, KILN_IO, "%.200s...: the path is too long", test->golden);
}

enum match { OTHER_FILE, GOLDEN, MALFORMED };

/* Parses "@llvmpipe~2", the part of a name between the frame's number and the suffix. */
static enum match parse_middle(const char *middle, size_t length, struct golden_name *name)
{
    const char *tilde = memchr(middle, '~', length);
    size_t device_length = tilde ? (size_t)(tilde - middle) : length; /* '@' included */
    *name = (struct golden_name){.number = 1};
    if (device_length > 0) {
        char clean[KILN_DEVICE_NAME_SIZE];
        if (device_length > sizeof name->device)
            return MALFORMED;
        memcpy(name->device, middle + 1, device_length - 1);
        kiln_device_name(name->device, clean);
        if (!*clean || strcmp(clean, name->device) != 0)
            return MALFORMED;
    }
    if (!tilde)
        return GOLDEN;
    size_t digits = length - device_length - 1;
    if (digits < 1 || digits > 3 || tilde[1] == '0' || strspn(tilde + 1, "0123456789") != digits)
        return MALFORMED;
    name->number = 0;
    for (size_t i = 1; i <= digits; i++)
        name->number = name->number * 10 + (unsigned)(tilde[i] - '0');
    return name->number >= 2 ? GOLDEN : MALFORMED;
}

static enum match parse_name(const char *text, const struct kiln_test *test, uint32_t frame,
                             struct golden_name *name)
{
    char start[32];
    const char *suffix = kiln_test_suffix(test);
    size_t length = strlen(text), suffix_length = strlen(suffix);
    size_t start_length = (size_t)snprintf(start, sizeof start, "frame_%04u", frame);
    if (strncmp(text, start, start_length) != 0 || length < start_length + suffix_length ||
        strcmp(text + length - suffix_length, suffix) != 0)
        return OTHER_FILE;
    const char *middle = text + start_length;
    size_t middle_length = length - start_length - suffix_length;
    if (middle_length > 0 && *middle != '@' && *middle != '~')
        return OTHER_FILE;
    return parse_middle(middle, middle_length, name);
}

/* Returns whether goldens with `device` in their names are for the device: its name begins with
 * `device` and goes on with '-' or ends there. Goldens without a device are for all. */
static bool is_for(const char *device, const char *device_name)
{
    size_t length = strlen(device);
    return length == 0 || (strncmp(device, device_name, length) == 0 &&
                           (device_name[length] == '\0' || device_name[length] == '-'));
}

/* ---- finding -------------------------------------------------------------------------------- */

struct numbers {
    unsigned values[KILN_MAX_GOLDENS]; /* ascending */
    size_t count;
};

static bool add_number(struct numbers *numbers, unsigned number)
{
    if (numbers->count == KILN_MAX_GOLDENS)
        return false;
    size_t at = numbers->count++;
    for (; at > 0 && numbers->values[at - 1] > number; at--)
        numbers->values[at] = numbers->values[at - 1];
    numbers->values[at] = number;
    return true;
}

/* Adds an entry of the folder if it is a golden of the frame for the device. A golden with a longer
 * device in its name than those found before replaces them, and one with a shorter is passed over.
 */
static bool take_entry(const char *entry, const struct kiln_test *test, uint32_t frame,
                       const char *device_name, char device[KILN_DEVICE_NAME_SIZE],
                       struct numbers *numbers, struct kiln_error *error)
{
    struct golden_name name;
    enum match match = parse_name(entry, test, frame, &name);
    if (match == MALFORMED)
        return kiln_error_set(
            error, KILN_INVALID_INPUT,
            "%s/%.200s: not the name of a golden; names are frame_%04u[@DEVICE][~NUMBER]%s with a "
            "device in lower case and a number from 2 to 999, each of which may be left out",
            test->golden, entry, frame, kiln_test_suffix(test));
    if (match == OTHER_FILE || !is_for(name.device, device_name))
        return true;
    size_t length = strlen(name.device), before = strlen(device);
    if (numbers->count > 0 && length < before)
        return true;
    if (length > before)
        *numbers = (struct numbers){0};
    memcpy(device, name.device, length + 1);
    return add_number(numbers, name.number) ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: more than %d accepted pictures of frame %u; no more are allowed",
                          test->golden, KILN_MAX_GOLDENS, frame);
}

static bool read_folder(const struct kiln_test *test, uint32_t frame, const char *device_name,
                        char device[KILN_DEVICE_NAME_SIZE], struct numbers *numbers,
                        struct kiln_error *error)
{
    struct stat status;
    struct dirent **entries = NULL;
    int count = scandir(test->golden, &entries, NULL, NULL);
    if (count < 0) {
        int reason = errno;
        /* A missing folder is no error: there are no goldens yet. A broken link is one. */
        if (reason == ENOENT && lstat(test->golden, &status) != 0 && errno == ENOENT)
            return true;
        return kiln_error_set_errno(error, KILN_IO, reason, "%s: the folder cannot be read",
                                    test->golden);
    }
    bool ok = true;
    for (int i = 0; i < count; i++) {
        ok = ok && take_entry(entries[i]->d_name, test, frame, device_name, device, numbers, error);
        free(entries[i]);
    }
    free(entries);
    return ok;
}

static bool find(const struct kiln_test *test, uint32_t frame, const char *device_name,
                 char device[KILN_DEVICE_NAME_SIZE], struct numbers *numbers,
                 struct kiln_error *error)
{
    *device = '\0';
    *numbers = (struct numbers){0};
    return read_folder(test, frame, device_name, device, numbers, error);
}

bool kiln_goldens_find(const struct kiln_test *test, uint32_t frame, const char *device_name,
                       struct kiln_goldens *goldens, struct kiln_error *error)
{
    struct numbers numbers;
    if (!find(test, frame, device_name, goldens->device, &numbers, error))
        return false;
    goldens->count = numbers.count;
    if (numbers.count == 0)
        return write_path(test, frame, "", 1, goldens->paths[0], error);
    for (size_t i = 0; i < numbers.count; i++) {
        if (!write_path(test, frame, goldens->device, numbers.values[i], goldens->paths[i], error))
            return false;
    }
    return true;
}

/* Returns the first number from 1 that is not taken. */
static unsigned free_number(const struct numbers *numbers)
{
    unsigned number = 1;
    for (size_t i = 0; i < numbers->count && numbers->values[i] == number; i++)
        number++;
    return number;
}

bool kiln_goldens_place(const struct kiln_test *test, uint32_t frame, const char *device_name,
                        enum kiln_approve_as as, char path[KILN_PATH_SIZE],
                        struct kiln_error *error)
{
    char device[KILN_DEVICE_NAME_SIZE];
    struct numbers numbers;
    if (as == KILN_APPROVE_DEVICE)
        return write_path(test, frame, device_name, 1, path, error);
    if (!find(test, frame, device_name, device, &numbers, error))
        return false;
    if (as == KILN_APPROVE_REPLACE)
        return write_path(test, frame, device, numbers.count ? numbers.values[0] : 1, path, error);
    if (numbers.count == KILN_MAX_GOLDENS)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: frame %u has %d accepted pictures; no more are allowed",
                              test->golden, frame, KILN_MAX_GOLDENS);
    return write_path(test, frame, device, free_number(&numbers), path, error);
}

/* ---- files ---------------------------------------------------------------------------------- */

int kiln_goldens_lock(const struct kiln_test *test, struct kiln_error *error)
{
    char inside[KILN_PATH_SIZE];
    if (!kiln_path_join(inside, test->golden, "", error) ||
        !kiln_make_parent_folders(inside, error))
        return -1;
    /* The folder itself is locked, so that no lock file is left in it. */
    int lock = open(test->golden, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    int result = lock < 0 ? -1 : flock(lock, LOCK_EX);
    while (lock >= 0 && result != 0 && errno == EINTR)
        result = flock(lock, LOCK_EX);
    if (result == 0)
        return lock;
    kiln_error_set_errno(error, KILN_IO, errno, "%s: the folder cannot be locked", test->golden);
    if (lock >= 0)
        close(lock);
    return -1;
}

void kiln_goldens_unlock(int lock)
{
    if (lock < 0)
        return;
    flock(lock, LOCK_UN); /* close does not unlock if a child has the descriptor, too */
    close(lock);
}

static bool copy_bytes(int from, const char *name, struct kiln_temporary *to,
                       struct kiln_error *error)
{
    char buffer[1 << 16];
    for (;;) {
        ssize_t count = read(from, buffer, sizeof buffer);
        if (count == 0)
            return true;
        if (count < 0 && errno != EINTR)
            return kiln_error_set_errno(error, KILN_IO, errno, "%s", name);
        if (count > 0 && !kiln_temporary_write(to, buffer, (size_t)count))
            return true; /* kiln_temporary_commit returns false and reports the failure */
    }
}

/* Opens a temporary file for a picture that replaces what is at a path. */
static bool open_target(struct kiln_temporary *target, const char *path, struct kiln_error *error)
{
    if (kiln_path_is_lfs_pointer(path))
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the file is a Git LFS pointer: run git lfs pull", path);
    return kiln_make_parent_folders(path, error) && kiln_target_check(path, true, error) &&
           kiln_temporary_open(target, path, error);
}

bool kiln_file_copy(const char *from, const char *to, struct kiln_error *error)
{
    struct kiln_temporary target = {0};
    struct stat status;
    int file = open(from, KILN_FILE_FLAGS);
    bool ok = true;
    if (file < 0 || fstat(file, &status) != 0)
        ok = kiln_error_set_errno(error, KILN_IO, errno, "%s", from);
    else if (!S_ISREG(status.st_mode))
        ok = kiln_error_set(error, KILN_INVALID_INPUT, "%s: the path is not a regular file", from);
    if (ok && open_target(&target, to, error)) {
        ok = copy_bytes(file, from, &target, error) && kiln_temporary_commit(&target, true, error);
        kiln_temporary_discard(&target);
    } else {
        ok = false;
    }
    if (file >= 0)
        close(file);
    return ok;
}

static bool write_picture(const struct kiln_acceptance *acceptance, const char *path,
                          struct kiln_error *error)
{
    struct kiln_temporary target = {0};
    if (!open_target(&target, path, error))
        return false;
    kiln_temporary_write(&target, acceptance->bytes, acceptance->size); /* commit reports */
    const bool ok = kiln_temporary_commit(&target, true, error);
    kiln_temporary_discard(&target);
    return ok;
}

static void hash_image(const struct kiln_asset_image *image, char hex[65])
{
    static const size_t bytes[] = {[KILN_IMAGE_U8] = 1, [KILN_IMAGE_U16] = 2, [KILN_IMAGE_F32] = 4};
    size_t size = (size_t)image->width * image->height * 4 * bytes[image->type];
    char pixels[65], text[160];
    kiln_hash_sha256(image->pixels, size, pixels);
    int length =
        snprintf(text, sizeof text, "%ux%u %u %d %d %d %s", image->width, image->height,
                 image->channels, (int)image->type, image->srgb, image->premultiplied, pixels);
    kiln_hash_sha256(text, (size_t)length, hex);
}

bool kiln_pixel_hash_of(const void *bytes, size_t size, const char *name, char hex[65],
                        struct kiln_error *error)
{
    struct kiln_asset_image *image = kiln_asset_image_parse(bytes, size, name, error);
    if (!image)
        return false;
    hash_image(image, hex);
    kiln_asset_image_destroy(&image);
    return true;
}

bool kiln_pixel_hash_warned(const char *path, const struct kiln_log *log, char hex[65],
                            struct kiln_error *error)
{
    const struct kiln_loader_params anywhere = {.root = NULL};
    struct kiln_loader *loader = kiln_loader_create(&anywhere);
    if (!loader)
        return kiln_error_no_memory(error, "%s", path);
    kiln_loader_set_warn(loader, (struct kiln_loader_warn){kiln_loader_log, (void *)log});
    struct kiln_asset_image *image = kiln_asset_image_load(loader, path, error);
    kiln_loader_destroy(&loader);
    if (!image)
        return false;
    hash_image(image, hex);
    kiln_asset_image_destroy(&image);
    return true;
}

bool kiln_pixel_hash(const char *path, char hex[65], struct kiln_error *error)
{
    return kiln_pixel_hash_warned(path, &(struct kiln_log){.write = NULL}, hex, error);
}

/* ---- accepting ------------------------------------------------------------------------------ */

static bool put_picture(const struct kiln_acceptance *acceptance, const char *path,
                        struct kiln_error *error)
{
    char existing_hash[65];
    struct kiln_error ignored = {0}; /* a file that is missing or broken is replaced */
    if (kiln_pixel_hash(path, existing_hash, &ignored) &&
        strcmp(existing_hash, acceptance->pixels) == 0)
        return true;
    return write_picture(acceptance, path, error);
}

bool kiln_goldens_write_scene(const struct kiln_test *test, const char *text,
                              struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    return kiln_path_join(path, test->golden, "scene.yaml", error) &&
           kiln_temporary_write_file(path, text, strlen(text), error);
}

/* Chooses the path of the accepted picture as kiln_goldens_place does, with two exceptions. A
 * picture that replaces a given golden takes that golden's path. A picture that is accepted as an
 * alternative takes the path of a golden of the frame that has the same pixels, if there is one, so
 * that no golden is there twice. */
static bool choose_path(const struct kiln_test *test, const struct kiln_acceptance *acceptance,
                        char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    const char *device = acceptance->device_name, *place = NULL;
    struct kiln_goldens goldens = {0};
    if (acceptance->as == KILN_APPROVE_REPLACE)
        place = acceptance->golden;
    if (acceptance->as == KILN_APPROVE_ALTERNATIVE &&
        !kiln_goldens_find(test, acceptance->frame, device, &goldens, error))
        return false;
    for (size_t i = 0; !place && i < goldens.count; i++) {
        char existing_hash[65];
        struct kiln_error ignored = {0};
        if (kiln_pixel_hash(goldens.paths[i], existing_hash, &ignored) &&
            strcmp(existing_hash, acceptance->pixels) == 0)
            place = goldens.paths[i];
    }
    if (!place)
        return kiln_goldens_place(test, acceptance->frame, device, acceptance->as, path, error);
    return snprintf(path, KILN_PATH_SIZE, "%s", place) < KILN_PATH_SIZE ||
           kiln_error_set(error, KILN_IO, "%.200s...: the path is too long", place);
}

bool kiln_goldens_accept(struct kiln_arena *arena, const struct kiln_test *test,
                         struct kiln_expect *expect, const struct kiln_acceptance *acceptance,
                         char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    const bool hashes_only = test->golden_form == KILN_GOLDEN_HASH;
    if (hashes_only
            ? !kiln_path_join(path, test->golden, "expect.yaml", error)
            : !choose_path(test, acceptance, path, error) || !put_picture(acceptance, path, error))
        return false;
    const struct kiln_expect_pixels accepted = {.device = acceptance->device_name,
                                                .hash = acceptance->pixels,
                                                .golden = hashes_only ? NULL : acceptance->pixels,
                                                .kiln = acceptance->build};
    return kiln_expect_accept(arena, expect, acceptance->frame, acceptance->state, &accepted) ||
           kiln_error_no_memory(error, "accepting pictures");
}
