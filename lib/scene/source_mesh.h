/* Makes the cells of a source out of a mesh. */
#ifndef KILN_SCENE_SOURCE_MESH_H
#define KILN_SCENE_SOURCE_MESH_H

#include "asset/image/image.h"
#include "scene/source.h"

/* Fills the cells of a source with triangles, or with vertices, in the order of the mesh.
 * rotation: columns; scale: metres in one unit of the mesh; posed: the triangles of a mesh that is
 * posed anew in each step. Returns false when memory is short, or with *has_area false where no
 * triangle has an area. */
bool kiln_source_fill_mesh(struct kiln_arena *arena, const struct kiln_mesh *mesh,
                           enum kiln_source_on on, const float rotation[3][3], float scale,
                           bool posed, struct kiln_source *source, bool *has_area);

/* Gives the corners of a triangle, counterclockwise where it is seen from the side that the normals
 * of its vertices point to. Returns its area, in units of the mesh. */
double kiln_source_triangle(const struct kiln_mesh *mesh, uint32_t triangle, uint32_t corners[3]);

/* Fills a source with columns of the inside of a closed mesh: none if it has no volume. *edge: m,
 * of their squares. Returns false when memory is short, or with *fits false where too many
 * triangles lie above one another. */
bool kiln_source_fill_volume(struct kiln_arena *arena, const struct kiln_mesh *mesh,
                             const float rotation[3][3], float scale, struct kiln_source *source,
                             float *edge, bool *fits);

/* Takes a point of a mesh to the frame of its emitter. rotation: columns. */
void kiln_source_place(const float from[3], const float rotation[3][3], float scale, float to[3]);

/* Fills the colours of a source of triangles or vertices: base colours of materials, times their
 * textures and the colours of vertices. looks: the same mesh with its materials. path: its file,
 * beside which textures lie. plain: the linear colour of triangles that have neither a material nor
 * colours of vertices. False with an error. */
bool kiln_source_color_mesh(struct kiln_scene *scene, const struct kiln_mesh *looks,
                            const char *path, enum kiln_source_on on, const float plain[3],
                            struct kiln_source *source, struct kiln_error *error);

/* Returns whether a mesh with its materials has triangles with neither a material nor colours of
 * vertices. */
bool kiln_source_is_plain(const struct kiln_mesh *looks);

/* Returns a colour as 10 bits of the root of each component. */
uint32_t kiln_source_pack(const float rgb[3]);

/* Gives the linear colour of a pixel, not multiplied by alpha. */
void kiln_source_pixel(const struct kiln_asset_image *image, uint32_t x, uint32_t y, float rgb[3]);

/* Makes room for the colours of a source. False when memory is short. */
bool kiln_source_make_texels(struct kiln_arena *arena, struct kiln_source *source, uint64_t colors);

/* Sets one of the colours. */
void kiln_source_set_color(struct kiln_source *source, uint32_t number, uint32_t color);

#endif
