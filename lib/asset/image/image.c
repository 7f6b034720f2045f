/* Loads pictures. The first bytes of a file tell its format, which chooses the kind of kiln-decode
 * process that decodes it. The process's answer is checked before memory is taken for it. */
#include "asset/image/image.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "asset/image/animated.h"
#include "asset/image/received.h"
#include "base/error.h"
#include "base/file_in.h"

enum { HEAD_SIZE = 12 }; /* bytes of the longest signature */

/* Signatures of the formats; '.' stands for any byte. */
static const struct signature {
    const char *bytes;
    size_t length;
    enum kiln_picture_format format;
    enum kiln_decode_kind kind; /* of the process that decodes it */
    const char *name;
} signatures[] = {
    {"\x89PNG\r\n\x1a\n", 8, KILN_PICTURE_PNG, KILN_DECODE_PNG, "PNG"},
    {"\xff\xd8\xff", 3, KILN_PICTURE_JPEG, KILN_DECODE_JPEG, "JPEG"},
    {"RIFF....WEBP", 12, KILN_PICTURE_WEBP, KILN_DECODE_WEBP, "WebP"},
    {"II*\0", 4, KILN_PICTURE_TIFF, KILN_DECODE_TIFF, "TIFF"},
    {"MM\0*", 4, KILN_PICTURE_TIFF, KILN_DECODE_TIFF, "TIFF"},
    {"II+\0", 4, KILN_PICTURE_TIFF, KILN_DECODE_TIFF, "TIFF"}, /* BigTIFF */
    {"MM\0+", 4, KILN_PICTURE_TIFF, KILN_DECODE_TIFF, "TIFF"},
    {"BM", 2, KILN_PICTURE_BMP, KILN_DECODE_PICTURE, "BMP"},
    {"GIF8", 4, KILN_PICTURE_GIF, KILN_DECODE_PICTURE, "GIF"},
    {"v/1\x01", 4, KILN_PICTURE_EXR, KILN_DECODE_EXR, "EXR"},
    {"#?", 2, KILN_PICTURE_HDR, KILN_DECODE_EXR, "HDR"},
};

/* ---- format ---------------------------------------------------------------------------------- */

struct head {
    unsigned char bytes[HEAD_SIZE];
    size_t size; /* number of bytes, fewer than HEAD_SIZE in a short file */
};

static const struct signature *find_signature(const struct head *head)
{
    for (size_t i = 0; i < sizeof signatures / sizeof *signatures; i++) {
        const struct signature *s = &signatures[i];
        bool same = head->size >= s->length;
        for (size_t j = 0; same && j < s->length; j++)
            same = s->bytes[j] == '.' || (unsigned char)s->bytes[j] == head->bytes[j];
        if (same)
            return s;
    }
    return NULL;
}

static bool refuse_unknown(const struct head *head, const char *name, struct kiln_error *error)
{
    if (head->size == 0)
        return kiln_error_set(error, KILN_INVALID_INPUT, "%s: the image file is empty", name);
    char found[16] = "";
    for (size_t i = 0; i < 4 && i < head->size; i++)
        snprintf(found + 3 * i, sizeof found - 3 * i, " %02x", head->bytes[i]);
    return kiln_error_set(
        error, KILN_INVALID_INPUT,
        "%s: the file is not an image: it starts with the bytes%s; allowed are " KILN_IMAGE_FORMATS
        " files",
        name, found);
}

/* Chooses the kind of process that decodes a layer of a file, or the picture if `layer` is NULL.
 * name: the file's name, for messages. */
static bool choose_kind(const struct head *head, const char *name, const char *layer,
                        enum kiln_decode_kind *kind, struct kiln_decode_request *request,
                        struct kiln_error *error)
{
    const struct signature *signature = find_signature(head);
    const char *wanted = layer ? layer : "beauty";
    if (!signature)
        return refuse_unknown(head, name, error);
    request->format = signature->format;
    *kind = signature->kind;
    if (signature->format == KILN_PICTURE_EXR)
        return snprintf(request->layer, sizeof request->layer, "%s", wanted) <
                   (int)sizeof request->layer ||
               kiln_error_set(error, KILN_INVALID_INPUT, "%s: no layer '%s'", name, layer);
    return strcmp(wanted, "beauty") == 0 ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: no layer '%s': %s images have no layers but 'beauty'", name, layer,
                          signature->name);
}

/* ---- decoding -------------------------------------------------------------------------------- */

/* The struct selects the part of a file that a caller decodes, and how. */
struct wanted {
    const char *layer; /* NULL: the picture, whose values are finite */
    bool raw;          /* the numbers are data, not colours */
    bool is_page;      /* page `page` is wanted; else the first, with a warning if there are more */
    uint32_t page;
    bool sky; /* the picture shows all directions */
    /* the picture is a sheet of cells: a PNG file is one also where it is an animation */
    bool sheet;
};

/* Returns the kind of process that decodes what one of a kind cannot. */
static enum kiln_decode_kind other_kind(enum kiln_decode_kind kind)
{
    return kind == KILN_DECODE_EXR || kind == KILN_DECODE_OPENEXR ? KILN_DECODE_OPENEXR
                                                                  : KILN_DECODE_PROFILE;
}

/* Lets a process of a kind decode an open file. *needs_other is set if only one of the other kind
 * can. */
static struct kiln_asset_image *ask(struct kiln_received *received, enum kiln_decode_kind kind,
                                    const struct kiln_decode_request *request, int file,
                                    bool *needs_other, struct kiln_error *error)
{
    received->helper = kiln_loader_take(received->loader, kind, error);
    if (!received->helper)
        return NULL;
    /* A process of the other kind needs no further one, unless a file has taken it over. */
    const unsigned other = kind == other_kind(kind) ? 0 : 1u << KILN_DECODE_NEEDS_OTHER;
    const unsigned expected = 1u << KILN_DECODE_PIXELS | other;
    struct kiln_error reason = {0};
    struct kiln_asset_image *image = NULL;
    received->needs_other = false;
    if (kiln_helper_send(received->helper, request, sizeof *request, file, &reason))
        image = kiln_received_image(received, expected, &reason);
    *needs_other = received->needs_other;
    if (!image && !*needs_other)
        kiln_received_fail(received, &reason, error);
    kiln_loader_give_back(received->loader, &received->helper);
    return image;
}

/* Warns of what is wrong with a file that was read, and of frames and pages that are not taken. A
 * process that a file has taken over may have made up the text and the number of pages. */
static void warn(const struct kiln_received *received, const struct kiln_asset_image *image,
                 enum kiln_picture_format format, int file, const struct wanted *wanted)
{
    const bool is_sheet = format == KILN_PICTURE_PNG && (wanted->sheet || wanted->raw);
    if (*received->warning)
        kiln_loader_warn(received->loader, received->name, "%s", received->warning);
    if (image->pages > 1 && !wanted->is_page)
        kiln_loader_warn(received->loader, received->name, "it has %u pages; the first is taken",
                         image->pages);
    else if (!is_sheet && kiln_file_is_animated(file))
        kiln_loader_warn(received->loader, received->name,
                         "it is an animation; the first frame is taken");
}

/* Decodes the picture in an open file. name: the file's name, for messages. */
static struct kiln_asset_image *decode(struct kiln_loader *loader, int file, const char *name,
                                       const struct wanted *wanted, struct kiln_error *error)
{
    struct kiln_decode_request request = {
        .most_bytes = KILN_MAX_IMAGE_BYTES,
        .raw = wanted->raw,
        .sky = wanted->sky,
        .page = wanted->page,
    };
    struct kiln_received received = {.loader = loader, .name = name, .finite = !wanted->layer};
    struct head head;
    const ssize_t got = pread(file, head.bytes, sizeof head.bytes, 0);
    enum kiln_decode_kind kind = KILN_DECODE_PICTURE;
    if (got < 0) {
        kiln_error_set_errno(error, KILN_IO, errno, "%s: the image file cannot be read", name);
        return NULL;
    }
    head.size = (size_t)got;
    if (!choose_kind(&head, name, wanted->layer, &kind, &request, error))
        return NULL;
    if (wanted->page > 0 && request.format != KILN_PICTURE_TIFF) {
        kiln_error_set(error, KILN_INVALID_INPUT, "%s: no page %u: only TIFF images have pages",
                       name, wanted->page);
        return NULL;
    }
    request.most_pixels = kiln_received_most_pixels(loader);
    bool needs_other = false;
    struct kiln_asset_image *image = ask(&received, kind, &request, file, &needs_other, error);
    if (needs_other)
        image = ask(&received, other_kind(kind), &request, file, &needs_other, error);
    if (image)
        warn(&received, image, request.format, file, wanted);
    return image;
}

static struct kiln_asset_image *load(struct kiln_loader *loader, const char *path,
                                     const struct wanted *what, struct kiln_error *error)
{
    const struct kiln_loader_file wanted = {path, "image", KILN_IMAGE_FORMATS,
                                            KILN_MAX_IMAGE_BYTES};
    size_t size = 0;
    const int file = kiln_loader_open(loader, &wanted, &size, error);
    if (file < 0)
        return NULL;
    struct kiln_asset_image *image = decode(loader, file, path, what, error);
    close(file);
    if (image)
        kiln_loader_add_picture(loader, kiln_asset_image_bytes(image));
    uint32_t known[2];
    /* Data are not turned, so their width may be the height that is known of the picture. */
    if (image && !what->raw && what->page == 0 && kiln_loader_knows_size(loader, path, known) &&
        (image->width != known[0] || image->height != known[1])) {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: the image changed while it was read: it has %u x %u pixels, and had %u "
                       "x %u before",
                       path, image->width, image->height, known[0], known[1]);
        kiln_asset_image_destroy(&image);
    }
    return image;
}

struct kiln_asset_image *kiln_asset_image_load(struct kiln_loader *loader, const char *path,
                                               struct kiln_error *error)
{
    return load(loader, path, &(struct wanted){.layer = NULL}, error);
}

struct kiln_asset_image *kiln_asset_image_load_data(struct kiln_loader *loader, const char *path,
                                                    struct kiln_error *error)
{
    return load(loader, path, &(struct wanted){.raw = true}, error);
}

struct kiln_asset_image *kiln_asset_image_load_sky(struct kiln_loader *loader, const char *path,
                                                   struct kiln_error *error)
{
    return load(loader, path, &(struct wanted){.sky = true}, error);
}

struct kiln_asset_image *kiln_asset_image_load_sheet(struct kiln_loader *loader, const char *path,
                                                     struct kiln_error *error)
{
    return load(loader, path, &(struct wanted){.sheet = true}, error);
}

struct kiln_asset_image *kiln_asset_image_load_layer(struct kiln_loader *loader, const char *path,
                                                     const char *layer, struct kiln_error *error)
{
    return load(loader, path, &(struct wanted){.layer = layer}, error);
}

struct kiln_asset_image *kiln_asset_image_load_page(struct kiln_loader *loader, const char *path,
                                                    uint32_t page, struct kiln_error *error)
{
    return load(loader, path, &(struct wanted){.is_page = true, .page = page}, error);
}

struct kiln_asset_image *kiln_asset_image_parse(const void *bytes, size_t size, const char *name,
                                                struct kiln_error *error)
{
    struct kiln_asset_image *image = NULL;
    const int file = kiln_loader_file_of(bytes, size, name, error);
    if (file >= 0 && kiln_file_check_size(name, "image", size, KILN_MAX_IMAGE_BYTES, error))
        image = decode(NULL, file, name, &(struct wanted){.layer = NULL}, error);
    if (file >= 0)
        close(file);
    return image;
}

void kiln_asset_image_destroy(struct kiln_asset_image **image)
{
    if (!*image)
        return;
    free((*image)->pixels);
    free(*image);
    *image = NULL;
}

/* Gives the size of a picture, which is decoded if the loader does not know it. */
static bool find_size(struct kiln_loader *loader, const char *path, const struct wanted *wanted,
                      uint32_t size[2], struct kiln_error *error)
{
    if (kiln_loader_knows_size(loader, path, size))
        return true;
    struct kiln_asset_image *image = load(loader, path, wanted, error);
    if (!image)
        return false;
    size[0] = image->width;
    size[1] = image->height;
    kiln_loader_remember_size(loader, path, size);
    kiln_asset_image_destroy(&image);
    return true;
}

bool kiln_asset_image_check(struct kiln_loader *loader, const char *path, struct kiln_error *error)
{
    uint32_t size[2];
    return find_size(loader, path, &(struct wanted){.layer = NULL}, size, error);
}

bool kiln_asset_sheet_check(struct kiln_loader *loader, const char *path, struct kiln_error *error)
{
    uint32_t size[2];
    return kiln_asset_sheet_size(loader, path, size, error);
}

bool kiln_asset_sheet_size(struct kiln_loader *loader, const char *path, uint32_t size[2],
                           struct kiln_error *error)
{
    return find_size(loader, path, &(struct wanted){.sheet = true}, size, error);
}
