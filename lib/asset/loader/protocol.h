/* Declares the messages of kiln and kiln-decode, which go through a socket between two processes of
 * one machine: a request with a file's descriptor, answers, and the arrays that follow answers.
 * kiln checks every count and text of an answer before using it. */
#ifndef KILN_ASSET_LOADER_PROTOCOL_H
#define KILN_ASSET_LOADER_PROTOCOL_H

#include "kiln.h"

/* Lists the kinds of files that a process of kiln-decode can read. It opens the libraries of one
 * kind only. The second word is the process's argument. */
#define KILN_DECODE_KINDS(X)                                                                       \
    X(PNG, "png")                                                                                  \
    X(PICTURE, "picture") /* JPEG, WebP, TIFF, BMP and EXR, by FFmpeg */                           \
    X(EXR, "exr")         /* a layer of an EXR file, by OpenEXR */                                 \
    X(VIDEO, "video")                                                                              \
    X(MESH, "mesh")

enum kiln_decode_kind {
#define KILN_DECODE_ID(id, word) KILN_DECODE_##id,
    KILN_DECODE_KINDS(KILN_DECODE_ID)
#undef KILN_DECODE_ID
        KILN_DECODE_KIND_COUNT
};

enum {
    KILN_DECODE_SOCKET = 3,  /* number of the socket's descriptor in kiln-decode */
    KILN_DECODE_SECONDS = 30 /* of processor time, for a picture, a frame of a video or a mesh */
};

enum kiln_picture_format {
    KILN_PICTURE_PNG,
    KILN_PICTURE_JPEG,
    KILN_PICTURE_WEBP,
    KILN_PICTURE_TIFF,
    KILN_PICTURE_BMP,
    KILN_PICTURE_EXR,
};

enum kiln_mesh_format { KILN_MESH_OBJ, KILN_MESH_GLTF, KILN_MESH_GLB };

/* Asks for a file to be decoded. The file's descriptor is sent with it. */
struct kiln_decode_request {
    uint32_t format;     /* enum kiln_picture_format or kiln_mesh_format */
    uint32_t uvs;        /* of a mesh: texture coordinates are wanted */
    uint32_t moving;     /* of a mesh: nodes, bones and clips are wanted */
    uint64_t most_bytes; /* size limit of the file in bytes */
    uint64_t most_pixels;
    char layer[64]; /* name of a layer of an EXR file */
};

enum kiln_decode_what {
    KILN_DECODE_READY, /* is sent once, before the first request; the text is KILN_VERSION */
    /* has the error's code, and its message as text. When a picture has more than most_pixels, the
     * code is KILN_OVER_LIMIT and width and height are set */
    KILN_DECODE_FAILED,
    KILN_DECODE_PIXELS, /* describes a picture; its pixels follow */
    KILN_DECODE_END,    /* says that a video has no more frames */
    /* asks for another file, whose name is the text; kiln sends a struct kiln_decode_file */
    KILN_DECODE_WANTS,
    KILN_DECODE_MADE, /* describes a mesh; its arrays follow */
};

struct kiln_decode_answer {
    uint32_t what;
    int32_t code; /* one of enum kiln_code */
    char text[KILN_MESSAGE_SIZE];
    /* members of struct kiln_asset_image */
    uint32_t width, height, channels, type, srgb, premultiplied;
    uint32_t vertices, triangles; /* counts of a mesh */
    uint32_t has_normals, nodes, bones, clips, channels_of_clips, keys;
};

/* Answers KILN_DECODE_WANTS. The file's descriptor is sent with it if is_open. */
struct kiln_decode_file {
    uint32_t is_open;
};

#endif
