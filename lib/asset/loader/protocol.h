/* Declares the messages between kiln and kiln-decode, the program that decodes untrusted files.
 * They go through a socket between two processes of one machine: a request with a file's
 * descriptor, answers, and the arrays that follow answers. kiln checks every count and text of an
 * answer before using it. */
#ifndef KILN_ASSET_LOADER_PROTOCOL_H
#define KILN_ASSET_LOADER_PROTOCOL_H

#include "kiln.h"

/* Lists the kinds of kiln-decode processes, each with the word that is the process's argument. A
 * process opens only the libraries that its kind needs. */
#define KILN_DECODE_KINDS(X)                                                                       \
    X(PNG, "png")                                                                                  \
    X(JPEG, "jpeg")       /* by libjpeg-turbo */                                                   \
    X(TIFF, "tiff")       /* by libtiff */                                                         \
    X(WEBP, "webp")       /* by libwebp, also the frames of animations */                          \
    X(PROFILE, "profile") /* any of these whose colour profile has tables, with lcms2 */           \
    X(PICTURE, "picture") /* BMP and GIF, by FFmpeg */                                             \
    X(EXR, "exr")         /* a layer of an EXR file, by OpenEXR; HDR */                            \
    X(OPENEXR, "openexr") /* the EXR files that need OpenEXR's C++ */                              \
    X(VIDEO, "video")                                                                              \
    X(MESH, "mesh")                                                                                \
    X(DRACO, "draco") /* the glTF files that need Draco */

enum kiln_decode_kind {
#define KILN_DECODE_ID(id, word) KILN_DECODE_##id,
    KILN_DECODE_KINDS(KILN_DECODE_ID)
#undef KILN_DECODE_ID
        KILN_DECODE_KIND_COUNT
};

enum {
    KILN_LAYER_NAME_SIZE = 512, /* bytes of the name of a layer of a picture, with the NUL */
    KILN_DECODE_SOCKET = 3,     /* kiln-decode has the socket as this descriptor */
    /* the limits of processor time and of real time for a picture, a frame of a video or a mesh,
     * from the request to the last byte of the answer */
    KILN_DECODE_SECONDS = 30,
    KILN_DECODE_REAL_SECONDS = 60
};

enum kiln_picture_format {
    KILN_PICTURE_PNG,
    KILN_PICTURE_JPEG,
    KILN_PICTURE_WEBP,
    KILN_PICTURE_TIFF,
    KILN_PICTURE_BMP,
    KILN_PICTURE_GIF,
    KILN_PICTURE_EXR,
    KILN_PICTURE_HDR,
};

enum kiln_mesh_format {
    KILN_MESH_OBJ,
    KILN_MESH_GLTF,
    KILN_MESH_GLB,
    KILN_MESH_PLY,
    KILN_MESH_STL,
};

/* What a file that a mesh names has. */
enum kiln_companion {
    KILN_COMPANION_BUFFER,    /* numbers of a glTF file, without which it is not read */
    KILN_COMPANION_MATERIALS, /* materials of an OBJ file, which is read without them, too */
};

/* Asks for a file to be decoded. The file's descriptor is sent with it. A video needs one request
 * for all of its frames. */
struct kiln_decode_request {
    uint32_t format; /* enum kiln_picture_format or kiln_mesh_format; unused for a video */
    uint32_t uvs;    /* of a mesh: texture coordinates are wanted */
    uint32_t moving; /* of a mesh: nodes, bones and clips are wanted */
    uint32_t rig;    /* of a mesh: nodes, cameras and clips are wanted, and no vertices */
    /* of a mesh: materials are wanted; texture coordinates then come with them */
    uint32_t materials;
    uint32_t raw; /* of a picture: numbers are neither converted nor turned */
    /* of a WebP (KILN_DECODE_WEBP) or GIF (KILN_DECODE_PICTURE): all frames are wanted, and
     * answered like those of a video */
    uint32_t frames;
    uint32_t page; /* of a picture: which page of the file; 0: the first */
    uint32_t sky;  /* of a picture: it is wrapped around the scene; cube maps are refused */
    /* of an EXR: every layer is wanted, or the one named below, each as a picture with its name in
     * the order of kiln_order_layers, and KILN_DECODE_END after the last */
    uint32_t layers;
    uint64_t most_bytes;              /* size limit of the file in bytes */
    uint64_t most_pixels;             /* limit of a picture's width * height */
    char layer[KILN_LAYER_NAME_SIZE]; /* name of a layer of an EXR file; "": see layers */
};

/* Kinds of answers. */
enum kiln_decode_what {
    /* The process waits for its first request, or has opened a video. The text is KILN_VERSION. */
    KILN_DECODE_READY,

    /* The request failed, with an error's code and its message as text. If a picture has more than
     * most_pixels, the code is KILN_OVER_LIMIT, and width and height are set. */
    KILN_DECODE_FAILED,

    /* Describes a picture, the next frame of a video, or the next layer of a picture. Its pixels
     * follow. The text is the name of a layer. Of a picture, it says what is wrong with its file
     * that was read all the same, or is empty. */
    KILN_DECODE_PIXELS,

    /* A video has no more frames, or a picture no more layers. */
    KILN_DECODE_END,

    /* A mesh names another file; the text is that name. kiln sends a struct kiln_decode_file. */
    KILN_DECODE_NEEDS_FILE,

    /* Describes a mesh; the text has notes for the user. Its arrays follow, as
     * kiln_mesh_visit_arrays lists them. */
    KILN_DECODE_MESH_MADE,

    /* Only a process of another kind can decode the file: one of kind KILN_DECODE_OPENEXR an EXR,
     * of kind KILN_DECODE_PROFILE another picture, of kind KILN_DECODE_DRACO a mesh. */
    KILN_DECODE_NEEDS_OTHER,
};

struct kiln_decode_answer {
    uint32_t what; /* enum kiln_decode_what */
    int32_t code;  /* one of enum kiln_code */
    char text[KILN_MESSAGE_SIZE];
    /* of a picture: the members of struct kiln_asset_image with these names */
    uint32_t width, height, channels, type, srgb, premultiplied, pages;
    uint32_t data;                                         /* of a layer: it holds no light */
    uint32_t vertices, triangles;                          /* of a mesh: counts */
    uint32_t nodes, bones, clips, channels_of_clips, keys; /* of a mesh that moves, or a rig */
    uint32_t morphs, morph_channels, deltas;               /* of the same */
    uint32_t materials, textures, texture_bytes;           /* of a mesh with materials: counts */
    uint32_t has_uvs, has_second_uvs, has_colors; /* of the same: which its vertices have */
    uint32_t morph_targets;                       /* of a mesh: a count */
    uint32_t companion; /* enum kiln_companion, of KILN_DECODE_NEEDS_FILE */
};

/* Answers KILN_DECODE_NEEDS_FILE. The file's descriptor is sent with it if is_open. */
struct kiln_decode_file {
    uint32_t is_open;
};

#endif
