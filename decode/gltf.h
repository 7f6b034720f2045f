/* Declares the parts of the reader of glTF 2 files: the document (gltf.c), its buffers
 * (gltf_buffer.c), its numbers (gltf_accessor.c), nodes (gltf_node.c), primitives
 * (gltf_primitive.c), a model that does not move (gltf_still.c), nodes, bones and clips of one that
 * moves (gltf_moving.c, gltf_clip.c), and nodes, cameras and clips alone (gltf_rig.c).
 *
 * Functions that return bool set the document's error when they return false. */
#ifndef KILN_DECODE_GLTF_H
#define KILN_DECODE_GLTF_H

#include "asset/geometry/mesh_in.h"
#include "decode.h"
#include "gltf_json.h"
#include "model.h"

/* The arrays of the document that other parts refer to by number. */
enum gltf_list_name {
    GLTF_ACCESSORS,
    GLTF_ANIMATIONS,
    GLTF_BUFFERS,
    GLTF_CAMERAS,
    GLTF_IMAGES,
    GLTF_MATERIALS,
    GLTF_MESHES,
    GLTF_NODES,
    GLTF_SAMPLERS,
    GLTF_SCENES,
    GLTF_SKINS,
    GLTF_TEXTURES,
    GLTF_VIEWS,
    GLTF_LISTS
};

struct gltf_list {
    const json_t *array;
    uint32_t count;
};

/* Stands for the number of an element that is missing. */
#define GLTF_NONE UINT32_MAX

struct gltf_bytes {
    const unsigned char *bytes; /* NULL: there are none, or not yet */
    size_t size;
    unsigned char *owned; /* what gltf_finish frees */
};

/* Translation, rotation (a quaternion) and scale of a node. */
struct gltf_pose {
    double move[3], turn[4], scale[3];
};

struct gltf_node {
    uint32_t parent;       /* GLTF_NONE: it has no parent */
    uint32_t mesh, skin;   /* GLTF_NONE: none */
    bool placed;           /* it is in the order */
    bool shown;            /* it is in the scene */
    bool needed;           /* it shows a mesh, is a joint of one, or is above such a node */
    double local[3][4];    /* to the parent's space */
    double world[3][4];    /* to the file's space; for nodes of the order */
    struct gltf_pose pose; /* what `local` is composed of */
};

struct gltf {
    const struct decode_mesh *wanted;
    struct kiln_error *error;
    char *notes;  /* what is to be told to the user, a line each; KILN_MESSAGE_SIZE bytes */
    json_t *root; /* of the JSON */
    struct gltf_list lists[GLTF_LISTS];
    struct gltf_bytes chunk;    /* the binary chunk of a GLB */
    struct gltf_bytes *buffers; /* of all buffers */
    struct gltf_bytes *views;   /* of the views that meshopt compresses, as they are needed */
    struct gltf_node *nodes;
    /* Nodes of the scene, and joints that are elsewhere: parents before their children. */
    uint32_t *order, order_count;
    bool needs_meshopt; /* the file requires it, so other data are not looked for */
    bool needs_draco;
};

#define GLTF_SET(g, ...) kiln_error_set((g)->error, KILN_INVALID_INPUT, __VA_ARGS__)

/* ---- gltf.c ---------------------------------------------------------------------------------- */

/* Returns an element of a list, or NULL. */
const json_t *gltf_element(const struct gltf *g, enum gltf_list_name list, uint32_t number);

/* Gets a member that is the number of an element of a list. *number is GLTF_NONE if there is no
 * such member. It is an error if there is no such element. */
bool gltf_reference(struct gltf *g, const json_t *object, const char *key, enum gltf_list_name list,
                    uint32_t *number);

/* Returns an extension of an object of the document, or NULL. */
const json_t *gltf_extension(const json_t *object, const char *name);

/* Returns whether the file says that it cannot be read without an extension. */
bool gltf_requires(const struct gltf *g, const char *extension);

/* Adds a note, unless the same was noted before. */
void gltf_note(struct gltf *g, const char *text);

/* ---- gltf_buffer.c --------------------------------------------------------------------------- */

/* Gets the bytes of all buffers, in their order, which is that of the mesh's hash. */
bool gltf_open_buffers(struct gltf *g);

/* Gets the text of a URI in memory that the caller frees; NULL: memory is short. */
char *gltf_copy_uri(struct gltf *g, const json_t *value, size_t *length);

/* Replaces each %20 and its like by the byte that it stands for. Returns the length. */
size_t gltf_decode_percents(char *text, size_t length);

/* Decodes the data of a URI that begins with "data:" in its place. */
bool gltf_decode_data(struct gltf *g, char *uri, size_t length, struct gltf_bytes *out);

/* A view of a buffer. */
struct gltf_view {
    const unsigned char *bytes;
    size_t size, stride; /* stride: 0 if the elements follow one another */
};

bool gltf_find_view(struct gltf *g, uint32_t number, struct gltf_view *view);

/* Returns the extension by which meshopt compresses a view, or NULL. */
const json_t *gltf_meshopt_of(const struct gltf *g, uint32_t view);

/* ---- gltf_accessor.c ------------------------------------------------------------------------- */

/* The part of an accessor that is read. */
struct gltf_range {
    uint32_t first, count;
};

/* Gets the number of elements of an accessor, which may be at most `most`. what: what they are, for
 * messages, such as "vertices". */
bool gltf_count(struct gltf *g, uint32_t accessor, uint32_t most, const char *what,
                uint32_t *count);

/* Reads elements of a type such as "VEC3". The caller frees the floats; NULL: failure. Integers
 * that are normalised are divided by their largest value in double. */
float *gltf_read(struct gltf *g, uint32_t accessor, const char *type, struct gltf_range range);

/* Reads integers of a type, with 1 or 4 components. The caller frees them. */
uint32_t *gltf_read_integers(struct gltf *g, uint32_t accessor, const char *type,
                             struct gltf_range range);

/* ---- gltf_node.c ----------------------------------------------------------------------------- */

/* Reads the nodes, finds those of the scene and where they are. */
bool gltf_find_nodes(struct gltf *g);

/* Returns the nodes of the order, children before their parents. The caller frees them; NULL:
 * memory is short. */
uint32_t *gltf_children_first(struct gltf *g);

/* Multiplies matrices whose last row is 0 0 0 1. */
void gltf_multiply(const double a[3][4], const double b[3][4], double out[3][4]);

/* Composes a matrix that scales, then turns, then moves. */
void gltf_compose(const struct gltf_pose *pose, double rows[3][4]);

/* Refuses a matrix whose last row is not 0 0 0 1, up to rounding. */
bool gltf_check_last_row(struct gltf *g, const double row[4]);

/* The instances of a node (EXT_mesh_gpu_instancing): matrices to the node's space. A node without
 * that extension has one, the identity. The caller frees `rows`. */
struct gltf_instances {
    double (*rows)[3][4];
    uint32_t count;
};

bool gltf_find_instances(struct gltf *g, uint32_t node, struct gltf_instances *instances);

/* ---- gltf_primitive.c ------------------------------------------------------------------------ */

struct gltf_target {
    float (*positions)[3], (*normals)[3]; /* differences; NULL: none */
};

/* The struct holds a primitive as it is read. Normals and uvs are NULL where there are none. */
struct gltf_primitive {
    uint32_t vertex_count, triangle_count, target_count;
    float (*positions)[3], (*normals)[3], (*uvs)[2];
    float (*colors)[4], (*second_uvs)[2]; /* of a mesh that is read with its materials */
    uint32_t (*triangles)[3];
    struct gltf_target *targets;
    struct kiln_skin_weights *weights; /* of joints of the skin; NULL: none */
    uint32_t material;                 /* the number of materials: none */
};

/* Reads a primitive of triangles. Others, and those without positions, get no triangles. A failed
 * primitive is to be finished, too. uvs, weights: whether they are wanted. */
bool gltf_read_primitive(struct gltf *g, const json_t *json, bool uvs, bool weights,
                         struct gltf_primitive *primitive);
void gltf_finish_primitive(struct gltf_primitive *primitive);

/* Moves texture coordinates as the base colour texture of the material says, and makes them count
 * from the bottom of a picture (gltf_texture.c). */
void gltf_place_uvs(const struct gltf *g, struct gltf_primitive *primitive);

/* Gets the transform of texture coordinates of a texture that a material names (KHR_texture_
 * transform), for coordinates that count from the bottom. False: it has none, and rows are not
 * changed. */
bool gltf_get_transform(const json_t *texture, double rows[2][3]);

/* Gets the weights of morph targets by default of a node's mesh; NULL: all are 0, or failure, which
 * *ok tells. The caller frees them. count: number of targets. */
float *gltf_default_weights(struct gltf *g, uint32_t node, uint32_t count, bool *ok);

/* Adds targets to positions and normals. */
void gltf_morph(struct gltf_primitive *primitive, const float *weights);

/* ---- gltf_material.c ------------------------------------------------------------------------- */

/* Gives the model's looks the materials that its meshes have, unless they are not wanted. */
bool gltf_put_materials(struct gltf *g, struct decode_model *model);

/* Replaces texture coordinates that are not finite by 0. uvs may be NULL. */
void gltf_bound_uvs(float (*uvs)[2], size_t count);

/* Reads colours and second texture coordinates of vertices, if materials are wanted. */
bool gltf_read_colors(struct gltf *g, const json_t *attributes, struct gltf_range range,
                      struct gltf_primitive *primitive);

/* Returns how many numbers the colour of a vertex has: 3 without alpha, else 4. */
uint32_t gltf_color_width(const struct gltf *g, const json_t *attributes);

/* Gives a primitive colours of its vertices, each of `width` numbers. */
bool gltf_put_colors(struct gltf *g, const float *colors, uint32_t width,
                     struct gltf_primitive *primitive);

/* ---- gltf_skin.c ----------------------------------------------------------------------------- */

/* A bone takes vertices to the space of a node. */
struct gltf_bone {
    uint32_t node;
    double offset[3][4];
};

/* Reads the joints of a skin. The caller frees `bones`. */
struct gltf_skin {
    struct gltf_bone *bones;
    uint32_t count;
};

bool gltf_read_skin(struct gltf *g, uint32_t skin, struct gltf_skin *out);

/* Finds the matrix that weights blend from the bones' matrices to the file's space. */
void gltf_blend(const struct kiln_skin_weights *weights, const double (*bones)[3][4],
                double rows[3][4]);

/* Returns the determinant of a matrix. */
double gltf_determinant(const double m[3][4]);

/* ---- gltf_still.c, gltf_moving.c, gltf_rig.c, gltf_clip.c ------------------------------------ */

/* Makes a model of what the scene shows. The caller finishes it, also after a failure. */
bool gltf_still(struct gltf *g, struct decode_model *model);

/* Fills in vertices, triangles, nodes, bones and clips of a mesh that moves. */
bool gltf_moving(struct gltf *g, struct kiln_mesh_result *result);

/* Fills in all nodes of the scene, and the clips that move them; no vertices. */
bool gltf_rig(struct gltf *g, struct kiln_mesh_result *result);

/* The vertices and triangles of a primitive in the result of a mesh that moves. */
struct gltf_piece {
    uint32_t first, count, first_triangle, triangle_count;
    bool has_normals;
};

/* Gives normals to pieces that have none: those of the pose at rest, with creases, at which
 * vertices are divided. Updates the pieces. *sources, which the caller frees, has the number that
 * each vertex had before; NULL: they are the same (gltf_crease.c). */
bool gltf_put_creases(struct gltf *g, struct gltf_piece *pieces, uint32_t count,
                      struct kiln_mesh_result *result, uint32_t **sources);

/* Which numbers the nodes of the file have in the result, and which morph targets each has. */
struct gltf_moved {
    uint32_t node;       /* GLTF_NONE: it is not in the result */
    uint32_t first_bone; /* from 1; of its first instance; 0: it moves no part by itself */
    uint32_t first_morph, target_count; /* of its first part; the others' follow */
    uint32_t part_count;
};

/* Fills in the clips. Of a mesh that moves, a node that a clip moves has keys for all that it has
 * at rest, and there must be a clip. */
bool gltf_put_clips(struct gltf *g, const struct gltf_moved *moved,
                    struct kiln_mesh_result *result);

/* Returns whether some clip moves the weights of a node's morph targets. */
bool gltf_morphs_move(const struct gltf *g, uint32_t node);

/* Returns the extension by which Draco compresses a primitive; NULL: it has its own data. */
const json_t *gltf_draco_of(const struct gltf *g, const json_t *primitive);

/* ---- draco.c --------------------------------------------------------------------------------- */

/* Reads the geometry of a primitive that Draco compresses, but for its morph targets. */
bool gltf_read_draco(struct gltf *g, const json_t *json, const json_t *extension, bool uvs,
                     bool weights, struct gltf_primitive *primitive);

/* Gives a primitive the strongest influences out of `sets` sets of four joints and weights. */
bool gltf_put_weights(struct gltf *g, struct gltf_primitive *primitive, uint32_t *const joints[],
                      float *const weights[], uint32_t sets);

#endif
