/* What kiln and kiln-decode say to each other, on a socket between two processes of one machine: a
 * request with a file's descriptor, answers, and arrays behind these. kiln believes no count and no
 * text of it unchecked. */
#ifndef KILN_ASSET_LOADER_PROTOCOL_H
#define KILN_ASSET_LOADER_PROTOCOL_H

#include "kiln.h"

/* What a process of kiln-decode can read: it opens the libraries for one kind and no others. The
 * second word is its argument. */
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
    KILN_DECODE_SOCKET = 3,  /* the descriptor by which kiln-decode finds its end */
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

/* The file's descriptor goes with it. */
struct kiln_decode_request {
    uint32_t format;     /* enum kiln_picture_format or kiln_mesh_format */
    uint32_t uvs;        /* wanted of a mesh */
    uint32_t moving;     /* wanted of a mesh: nodes, bones, clips */
    uint64_t most_bytes; /* of the file */
    uint64_t most_pixels;
    char layer[64]; /* of an EXR */
};

enum kiln_decode_what {
    KILN_DECODE_READY,  /* once, before the first request: the text is KILN_VERSION */
    KILN_DECODE_FAILED, /* the code, and the message as text; when a picture has more than
                           most_pixels, KILN_OVER_LIMIT and the size */
    KILN_DECODE_PIXELS, /* a picture; its pixels follow */
    KILN_DECODE_END,    /* no more frames of a video */
    KILN_DECODE_WANTS,  /* another file, whose name is the text; a struct kiln_decode_file follows
                           from kiln */
    KILN_DECODE_MADE,   /* a mesh; its arrays follow */
};

struct kiln_decode_answer {
    uint32_t what;
    int32_t code; /* enum kiln_code */
    char text[KILN_MESSAGE_SIZE];
    uint32_t width, height, channels, type, srgb, premultiplied; /* of struct kiln_asset_image */
    uint32_t vertices, triangles;                                /* counts */
    uint32_t has_normals, nodes, bones, clips, channels_of_clips, keys;
};

/* Its descriptor goes with it, if there is one. */
struct kiln_decode_file {
    uint32_t is_open;
};

#endif
