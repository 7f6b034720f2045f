/* This header declares functions that fill in the uniform block of shapes (shared/shape_layout.h):
 * the backdrop's objects except axis-aligned boxes, the floor's gloss and waves, and the sun's
 * frame. */
#ifndef KILN_DRAW_MOMENT_SHAPES_H
#define KILN_DRAW_MOMENT_SHAPES_H

#include "asset/geometry/mesh.h"
#include "scene/scene.h"
#include "shared/shape_layout.h"

/* Holds the features of the shaders that a scene needs; each set of features is a shader variant.
 * solids: there are opaque particles, which throw shadows; instances: some particles are meshes
 * with silhouette tiles (lib/draw/light/instance_tiles.h). */
struct kiln_shape_features {
    bool round, oriented, meshes, paint, solids, instances, floor_image, floor_gloss, sky_image,
        soft_sun;
};
struct kiln_shape_features kiln_shape_features(const struct kiln_scene *scene);

#define KILN_SHAPE_DEFINES 240 /* bytes of the text of kiln_shape_defines */

/* Writes the "#define" lines of the variant, as kiln_program_params takes them. samples: rays a
 * pixel. */
void kiln_shape_defines(const struct kiln_shape_features *features, int samples,
                        char out[KILN_SHAPE_DEFINES]);

/* Returns the unit vector along v, or up where v has no length. */
float3 kiln_direction(float3 v);

/* Holds unit vectors towards the sun and across that direction, and in `spread` the tangent of the
 * sun's angular radius. */
struct kiln_sun_frame {
    float3 right, up, towards;
    float spread;
};
struct kiln_sun_frame kiln_sun_frame_at(const struct kiln_scene *scene, float time_s);

/* Fills in the objects at a clip time, and the sun's frame at the same time. meshes are in the
 * scene's order. The members for the images of floor and sky and for the bins of solid particles
 * become 0. */
void kiln_shapes_fill(const struct kiln_scene *scene, const struct kiln_mesh *const *meshes,
                      const struct kiln_sun_frame *sun, float time_s,
                      struct kiln_draw_shapes *shapes);

/* Fills in the boxes that lie along the axes, which struct kiln_draw_backdrop holds, in the scene's
 * order: their centres, m, halves of their sizes, m, and colours (NULL: not wanted), each of
 * KILN_MAX_OBJECTS. Returns how many there are. */
uint32_t kiln_boxes_fill(const struct kiln_scene *scene, float time_s, float4 *centers,
                         float4 *halves, float4 *colors);

#endif
