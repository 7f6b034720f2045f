/* kiln-decode: a process that reads files of strangers for kiln, locked in so that one that takes
 * it over can do no more than send wrong pictures. Messages here do without the file's name, which
 * only kiln knows. */
#ifndef KILN_DECODE_H
#define KILN_DECODE_H

#include "asset/geometry/mesh_in.h"
#include "asset/image/image.h"
#include "asset/loader/protocol.h"

/* ---- locked in (confine.c) ------------------------------------------------------------------- */

/* Gives up every right but those to compute, to take memory and to read and write what is open.
 * What the kernel is too old for is left out. False when it refuses what it should know. */
bool decode_confine(enum kiln_decode_kind kind, uint64_t most_memory, struct kiln_error *error);

/* An allocation failed: KILN_INVALID_INPUT when that was because of the process's own limit, which
 * only a file that asks for too much reaches, else KILN_DEVICE_FAILED. Returns false. */
bool decode_out_of_memory(struct kiln_error *error);

/* ---- pictures -------------------------------------------------------------------------------- */

struct decode_picture {
    const unsigned char *bytes; /* of the file */
    size_t size;
    enum kiln_picture_format format;
    const char *layer; /* of an EXR: "beauty" is R, G, B (and A), or Y, without a name before them,
                        * "depth" is Z, any other one "NAME.R" and so on, or its one channel */
    uint64_t most_pixels;
    uint32_t width, height; /* set when they are known */
    struct kiln_error *error;
};

/* Whether a picture is within the limits of image.h, and has no more than most_pixels, then
 * KILN_OVER_LIMIT; sets the size. Called before memory is taken for pixels. name: "PNG". */
bool decode_allows_size(struct decode_picture *picture, const char *name, int64_t width,
                        int64_t height);

/* Each decodes a whole file, or returns NULL with what is wrong. The caller destroys the image. */
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
