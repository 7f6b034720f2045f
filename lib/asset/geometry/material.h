/* Declares the materials of a mesh: how its surface reflects light, by the metallic-roughness model
 * of glTF 2. They are those of the file, whatever its format. Only a mesh that is loaded with
 * materials has them (mesh.h).
 *
 * Colours are linear light of Rec. 709's primaries. The structs cross the socket from kiln-decode
 * as they lie in memory (mesh_in.h), so they hold no pointers; mesh_in.c has checked what the
 * comments say of their numbers. */
#ifndef KILN_ASSET_GEOMETRY_MATERIAL_H
#define KILN_ASSET_GEOMETRY_MATERIAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    KILN_MAX_MATERIALS = 1024,
    KILN_MAX_TEXTURES = 1024,
    KILN_MAX_TEXTURE_BYTES = 64 << 20, /* of all textures that lie in the file of the mesh */
    KILN_MATERIAL_NAME_SIZE = 64,      /* bytes, with the zero at the end */
    KILN_TEXTURE_PATH_SIZE = 256,      /* bytes, with the zero at the end */
    KILN_UV_SETS = 2,                  /* sets of texture coordinates that a vertex has */
    KILN_NO_MATERIAL = UINT16_MAX,     /* the material of a triangle that has none */
};

#define KILN_NO_TEXTURE UINT32_MAX

/* The limits of numbers of materials: light that is emitted, and anything else, such as offsets of
 * texture coordinates. */
#define KILN_MAX_EMISSION        1e6f
#define KILN_MAX_MATERIAL_NUMBER 1e6f

/* A picture. Those in the file are bytes in kiln_mesh_looks.bytes; others are files. */
struct kiln_texture {
    char file[KILN_TEXTURE_PATH_SIZE]; /* from the mesh's folder, in it or below; "": see bytes */
    uint32_t first_byte, byte_count;   /* the picture's part of the bytes; count 0: of a file */
    uint32_t is_missing;               /* there is no such file, or it may not be read */
};

enum kiln_alpha_mode {
    KILN_ALPHA_OPAQUE, /* alpha counts for nothing */
    KILN_ALPHA_MASK,   /* the surface is there where alpha is at least the cutoff */
    KILN_ALPHA_BLEND,
};

/* The enum lists the uses of a material's textures. The colours of the first and of emission are
 * sRGB, the numbers of others are data. */
enum kiln_material_use {
    KILN_USE_COLOR, /* multiplies the base colour; its alpha, too, unless there is KILN_USE_ALPHA */
    KILN_USE_ALPHA, /* multiplies alpha */
    KILN_USE_NORMAL,    /* normals in tangent space, of which y points up in the picture */
    KILN_USE_HEIGHT,    /* heights, which bend normals */
    KILN_USE_ROUGHNESS, /* multiplies roughness */
    KILN_USE_METALNESS, /* multiplies metalness */
    KILN_USE_EMISSION,  /* multiplies emission */
    KILN_MATERIAL_USES,
};

/* Which channel of a texture has the number. */
enum kiln_texture_channel {
    KILN_TEXEL_RED,
    KILN_TEXEL_GREEN,
    KILN_TEXEL_BLUE,
    KILN_TEXEL_ALPHA,
    KILN_TEXEL_LUMINANCE,
    KILN_TEXTURE_CHANNELS,
};

enum kiln_texture_wrap {
    KILN_WRAP_REPEAT,
    KILN_WRAP_MIRROR, /* every second repetition is mirrored */
    KILN_WRAP_CLAMP,
    KILN_TEXTURE_WRAPS,
};

/* How a material uses a texture. */
struct kiln_material_map {
    uint32_t texture;    /* KILN_NO_TEXTURE: it has none */
    uint32_t uv_set;     /* below KILN_UV_SETS */
    uint32_t channel;    /* enum kiln_texture_channel; of a use that is one number */
    uint32_t wrap[2];    /* enum kiln_texture_wrap, along u and v */
    uint32_t is_nearest; /* texels keep their edges when they are enlarged */
    uint32_t is_inverse; /* one minus the number of the texture counts */
    float strength;      /* of normals and heights: what slopes or heights are multiplied by */
    /* The matrix that takes texture coordinates, with 1 as their third, to where the texture is
     * looked up. Both count from the bottom left of the picture. */
    float rows[2][3];
};

struct kiln_material {
    char name[KILN_MATERIAL_NAME_SIZE]; /* may be empty */
    float color[3], alpha;              /* base colour, 0 to 1 */
    float roughness, metalness;         /* 0 to 1 */
    float emission[3];                  /* from 0 */
    uint32_t alpha_mode;                /* enum kiln_alpha_mode */
    float cutoff;                       /* of KILN_ALPHA_MASK, from 0 */
    uint32_t is_two_sided;              /* the back shows, too */
    uint32_t is_unlit; /* the base colour is the light that it sends, whatever falls on it */
    struct kiln_material_map maps[KILN_MATERIAL_USES];
};

/* The looks of a mesh. */
struct kiln_mesh_looks {
    uint32_t material_count, texture_count;
    struct kiln_material *materials;
    struct kiln_texture *textures;
    unsigned char *bytes; /* of textures that lie in the file: PNG, JPEG or another format */
    uint32_t byte_count;
    uint16_t *of_triangles; /* the material of each triangle, or KILN_NO_MATERIAL */
    float (*colors)[4];     /* of the vertices, 0 to 1, to multiply the base colour; or NULL */
    float (*second_uvs)[2]; /* the second set of texture coordinates of the vertices; or NULL */
};

/* Returns a material that reflects as one without any does: white, rough, and no metal. */
struct kiln_material kiln_material_default(void);

/* Returns the light of a number that sRGB's transfer function encodes. Above 1, that function goes
 * on. */
float kiln_light_of_srgb(float encoded);

void kiln_mesh_looks_destroy(struct kiln_mesh_looks **looks);

/* Returns whether a path leads only downwards, by its text. */
bool kiln_path_stays_below(const char *path);

#endif
