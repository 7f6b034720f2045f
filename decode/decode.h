/* Declares kiln-decode, a process that decodes files from untrusted sources for kiln. It confines
 * itself, so that a malicious file that takes it over can do no more than send wrong pictures. Its
 * messages do not name the file, since only kiln knows the name. */
#ifndef KILN_DECODE_H
#define KILN_DECODE_H

#include "asset/geometry/mesh_in.h"
#include "asset/image/color.h"
#include "asset/loader/protocol.h"

/* ---- confinement (confine.c) ----------------------------------------------------------------- */

/* Gives up every right except to compute, to take memory and to use the descriptors that are open.
 * Mechanisms that the kernel is too old for are skipped. Returns false when the kernel refuses a
 * mechanism that its version supports. */
bool decode_confine(enum kiln_decode_kind kind, uint64_t most_memory, struct kiln_error *error);

/* Reports a failed allocation: KILN_OVER_LIMIT when the job's limit caused it, KILN_INVALID_INPUT
 * when the limit for the kind of file did, which only a file that asks for too much reaches, else
 * KILN_DEVICE_FAILED. Returns false. */
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
    bool sky;               /* the picture shows all directions, by longitude and latitude */
    bool raw;               /* the numbers are data: they are neither turned nor converted */
    bool layers;            /* of an EXR: layers are wanted as they are compared */
    uint32_t width, height; /* set when the size is known */
    /* set: only a process of another kind can show it: one of kind KILN_DECODE_OPENEXR an EXR, one
     * of kind KILN_DECODE_PROFILE any other file */
    bool needs_other;
    uint32_t page;  /* which page is wanted; 0: the first */
    uint32_t pages; /* of the file; 1, unless the reader sets it */
    /* what is wrong with the file although it was read (decode_warn); "": nothing is */
    char warning[256];
    struct kiln_error *error;
};

/* The struct tells how the stored numbers become colours, as the file says it. */
struct decode_meaning {
    const uint8_t *profile; /* an ICC profile, or NULL */
    size_t profile_size;
    const struct kiln_color *color; /* of a file without a profile; NULL: sRGB */
    bool ink;                       /* pixels are white less cyan, magenta, yellow and black */
    const void *ink_alpha;          /* of ink: a number for each pixel; NULL: opaque */
    uint32_t orientation; /* 1 to 8, as in Exif: what turns the picture upright; 0: as stored */
};

/* Makes the picture that is meant of integers. False with the error. */
bool decode_show(struct decode_picture *picture, struct kiln_asset_image *image,
                 const struct decode_meaning *meaning);

/* Sets the channels of a picture of 8 bits by its pixels: 4 if one is not opaque, else 3. */
void decode_find_alpha(struct kiln_asset_image *image);

#define DECODE_BROKEN_EXIF "its Exif data are broken and are ignored"

/* Returns the orientation in Exif data, which begin like a TIFF file; 1 if they have none. Broken
 * data are ignored, with a warning. */
uint32_t decode_exif_orientation(struct decode_picture *picture, const uint8_t *bytes, size_t size);

/* Turns a picture upright. False: memory is short. */
bool decode_turn(struct kiln_asset_image *image, uint32_t orientation);

enum decode_profile {
    DECODE_PROFILE_NONE,   /* it is broken, or not for pictures with these channels: ignore it */
    DECODE_PROFILE_COLOR,  /* the colour is filled; its tables lie in the profile */
    DECODE_PROFILE_TABLES, /* only a colour management system can read it */
};

/* Reads a profile of grey or RGB by its curves and its matrix. channels: 1 or 3 colours. */
enum decode_profile decode_icc(const uint8_t *profile, size_t size, uint32_t channels,
                               struct kiln_color *color);

/* Opens lcms2, which converts by profiles with tables, before the process is confined. */
bool decode_profile_begin(struct kiln_error *error);
bool decode_profile_is_ready(void);

/* Converts by such a profile. False: it is broken or for other pictures; nothing is changed. */
bool decode_profile_convert(struct kiln_asset_image *image, const struct decode_meaning *meaning);

/* Checks a picture's size against the limits of image.h and most_pixels (KILN_OVER_LIMIT), and
 * stores it. It is called before memory is taken for pixels. name is that of the format, such as
 * "PNG". */
bool decode_allows_size(struct decode_picture *picture, const char *name, int64_t width,
                        int64_t height);

/* Decode a whole file, or return NULL with the fault. The caller destroys the image. */
struct kiln_asset_image *decode_png(struct decode_picture *picture);
struct kiln_asset_image *decode_jpeg(struct decode_picture *picture);
struct kiln_asset_image *decode_tiff(struct decode_picture *picture);
struct kiln_asset_image *decode_by_ffmpeg(struct decode_picture *picture);
struct kiln_asset_image *decode_exr(struct decode_picture *picture);
struct kiln_asset_image *decode_hdr(struct decode_picture *picture);

/* Takes a layer, whose image it owns from then on. data: the layer holds no light. */
typedef void decode_take_layer(void *user, const char *name, bool data,
                               struct kiln_asset_image *image);

/* Decodes all layers of an EXR or, if picture->layer is not empty, that one, in the order of
 * kiln_order_layers. */
bool decode_exr_layers(struct decode_picture *picture, decode_take_layer *take, void *user);

/* Takes an image, which it owns from then on. Returns false if no more are wanted. */
typedef bool decode_take(void *user, struct kiln_asset_image *image);

/* Decodes the frames of an animation, or the one frame of a still picture, one by one. */
typedef bool decode_frames(struct decode_picture *picture, decode_take *take, void *user);
decode_frames decode_webp_frames, decode_gif_frames;

/* Notes what is wrong with a file that is read all the same, behind what was noted before. */
void decode_warn(struct decode_picture *picture, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Decodes a file by the reader of its format; of several frames, the first. */
struct kiln_asset_image *decode_file(struct decode_picture *picture);

/* Returns the function that decodes all frames of a format, or NULL where a file has one. */
decode_frames *decode_frames_of(enum kiln_picture_format format);

/* Open the libraries of pictures, before the process is confined. */
bool decode_jpeg_begin(struct kiln_error *error);
bool decode_webp_begin(struct kiln_error *error);
bool decode_tiff_begin(struct kiln_error *error);
bool decode_exr_more_begin(struct kiln_error *error);

/* ---- videos ---------------------------------------------------------------------------------- */

struct decode_video;

/* Opens the video stream of a file. The caller keeps the descriptor. */
struct decode_video *decode_video_open(int file, struct kiln_error *error);
void decode_video_close(struct decode_video **video);

/* Decodes the next frame, in the order of display. Returns true with the image, which the caller
 * destroys, or with NULL after the last frame. */
bool decode_video_read(struct decode_video *video, struct kiln_asset_image **image,
                       struct kiln_error *error);

/* ---- meshes ---------------------------------------------------------------------------------- */

struct decode_mesh {
    enum kiln_mesh_format format;
    bool uvs; /* texture coordinates are wanted */
    /* materials are wanted, and with them colours and texture coordinates of vertices that have
     * some; only of a mesh that does not move */
    bool materials;
    bool moving; /* nodes, bones and clips are wanted, and vertices that these have not moved */
    bool rig;    /* nodes, cameras and clips are wanted, and no vertices */
    const void *bytes;
    size_t size;
    /* Returns the bytes of another file that this one names, which the importer frees, or NULL if
     * it may not be read. */
    unsigned char *(*open)(void *user, enum kiln_companion kind, const char *name, size_t *size);
    void *user;
};

/* Opens the library that reads the JSON of glTF files, before the process is confined. Without it,
 * only meshes of other formats are imported. */
void decode_mesh_begin(void);

/* Imports a mesh in this process; kiln limits its time (lib/asset/loader/helper.c). *needs_other is
 * set, and false returned, if only a process of kind KILN_DECODE_DRACO can. The caller frees
 * result->skin.deltas and result->looks.bytes, also after a failure. */
bool decode_mesh(const struct decode_mesh *mesh, struct kiln_mesh_result *result, bool *needs_other,
                 struct kiln_error *error);

/* Reads a glTF file, as decode_mesh does. */
bool decode_gltf(const struct decode_mesh *mesh, struct kiln_mesh_result *result, bool *needs_other,
                 struct kiln_error *error);

/* Opens the module of Draco, before the process is confined. */
bool decode_draco_begin(struct kiln_error *error);
bool decode_draco_is_ready(void);

/* Sets the error that a mesh is too large; returns false. */
bool decode_refuse_size(struct kiln_error *error);

struct decode_model;

/* Read a file in which nothing moves. The caller finishes the model, also after a failure. */
bool decode_obj(const struct decode_mesh *wanted, struct decode_model *model,
                struct kiln_error *error);
bool decode_ply(const struct decode_mesh *wanted, struct decode_model *model,
                struct kiln_error *error);
bool decode_stl(const struct decode_mesh *wanted, struct decode_model *model,
                struct kiln_error *error);

/* Makes one surface of all parts of a model, and finishes the model as soon as it has its corners,
 * since both are large. */
bool decode_surface(const struct decode_mesh *wanted, struct decode_model *model,
                    struct kiln_mesh_result *result, struct kiln_error *error);

#endif
