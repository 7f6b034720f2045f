/* Declares kiln-decode, a process that decodes files from untrusted sources for kiln. It confines
 * itself, so that a malicious file that takes it over can do no more than send wrong pictures. Its
 * messages do not have the file's name, which only kiln knows. */
#ifndef KILN_DECODE_H
#define KILN_DECODE_H

#include "asset/geometry/mesh_in.h"
#include "asset/image/image.h"
#include "asset/loader/protocol.h"

/* ---- confinement (confine.c) ----------------------------------------------------------------- */

/* Gives up every right except to compute, to take memory and to use the descriptors that are open.
 * What the kernel is too old for is left out. False when the kernel refuses what its version
 * supports. */
bool decode_confine(enum kiln_decode_kind kind, uint64_t most_memory, struct kiln_error *error);

/* Reports a failed allocation: KILN_INVALID_INPUT when the process's own limit caused it, which
 * only a file that asks for too much reaches, else KILN_DEVICE_FAILED. Returns false. */
bool decode_out_of_memory(struct kiln_error *error);

/* ---- pictures -------------------------------------------------------------------------------- */

struct decode_picture {
    const unsigned char *bytes; /* content of the file */
    size_t size;
    enum kiln_picture_format format;
    /* of an EXR: "beauty" is R, G, B (and A), or Y, without a prefix; "depth" is Z; any other layer
     * is "NAME.R" and so on, or "NAME.Y" alone */
    const char *layer;
    uint64_t most_pixels;
    uint32_t width, height; /* set when the size is known */
    struct kiln_error *error;
};

/* Checks a picture's size against the limits of image.h and most_pixels (KILN_OVER_LIMIT), and
 * stores it. It is called before memory is taken for pixels. name: "PNG". */
bool decode_allows_size(struct decode_picture *picture, const char *name, int64_t width,
                        int64_t height);

/* Decode a whole file, or return NULL with the fault. The caller destroys the image. */
struct kiln_asset_image *decode_png(struct decode_picture *picture);
struct kiln_asset_image *decode_by_ffmpeg(struct decode_picture *picture);
struct kiln_asset_image *decode_exr(struct decode_picture *picture);

/* ---- videos ---------------------------------------------------------------------------------- */

struct decode_video;

/* Opens the one video stream of a file, whose descriptor stays the caller's. */
struct decode_video *decode_video_open(int file, struct kiln_error *error);
void decode_video_close(struct decode_video **video);

/* The next frame, in the order of display: true with the image, which the caller destroys, or with
 * NULL after the last one. */
bool decode_video_read(struct decode_video *video, struct kiln_asset_image **image,
                       struct kiln_error *error);

/* ---- meshes ---------------------------------------------------------------------------------- */

struct decode_mesh {
    enum kiln_mesh_format format;
    bool uvs;    /* wanted */
    bool moving; /* nodes, bones and clips are wanted, and vertices before these */
    const void *bytes;
    size_t size;
    /* Another file that this one names, whose bytes the importer frees; NULL: it may not be had. */
    unsigned char *(*open)(void *user, const char *name, size_t *size);
    void *user;
};

/* Opens the importer. */
bool decode_mesh_begin(struct kiln_error *error);

/* Imports on this process, whatever that takes. */
bool decode_mesh(const struct decode_mesh *mesh, struct kiln_mesh_result *result,
                 struct kiln_error *error);

struct aiScene;

/* Says that a mesh is too large; returns false. */
bool decode_refuse_size(struct kiln_error *error);

/* All of a scene that stands still, in one piece. */
bool decode_surface(const struct decode_mesh *wanted, const struct aiScene *scene,
                    struct kiln_mesh_result *result, struct kiln_error *error);

/* Appends all meshes of a scene that moves, and what moves them. */
bool decode_skin(const struct decode_mesh *wanted, const struct aiScene *scene,
                 struct kiln_mesh_result *result, struct kiln_error *error);

/* The text of a glTF file, or that of the first chunk of a GLB. */
const char *decode_mesh_json(const struct decode_mesh *mesh, size_t *size);

#endif
