/* This header declares functions that fill in the uniform block of shapes (shared/shape_layout.h):
 * the backdrop's objects, the floor's gloss and waves, and the sun's frame. */
#ifndef KILN_DRAW_MOMENT_SHAPES_H
#define KILN_DRAW_MOMENT_SHAPES_H

#include "asset/geometry/mesh.h"
#include "base/text.h"
#include "draw/moment/shape_set.h"
#include "scene/scene.h"
#include "shared/shape_layout.h"

/* Holds the features of the shaders that a scene needs; each set of features is a shader variant.
 * kinds: a bit for each kind of shape, SHAPE_*; solids: there are opaque particles, which throw
 * shadows; stored: the shapes are too many for a uniform block; many_meshes: the numbers of meshes
 * do not fit four bits; instances: some particles are meshes with silhouette tiles
 * (lib/draw/light/instance_tiles.h); smoke: it throws shadows; lamps: there are lamps or light of
 * fire; lamp_shadows: objects may hide some of them; rectangles: some are rectangles. */
struct kiln_shape_features {
    uint32_t kinds;
    bool stored, meshes, many_meshes, paint, solids, instances, floor_image, floor_gloss, sky_image;
    bool sun, smoke, lamps, lamp_shadows, rectangles;
};
struct kiln_shape_features kiln_shape_features(const struct kiln_scene *scene);

/* The most meshes whose numbers fit four bits in hits on meshes (mesh_hit.glsl). */
#define KILN_FEW_MESHES 15

/* Adds the "#define" lines of the variant, as kiln_program_params takes them. */
void kiln_shape_defines(const struct kiln_shape_features *features, struct kiln_text *defines);

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

/* Returns how far a shape extends from its centre along a unit vector, m. */
float kiln_shape_reach(const struct kiln_draw_shape *shape, float3 way);

/* Returns the trimmed set of the shapes that hide lights by their place, which all do but planes.
 */
static inline struct kiln_shape_set kiln_shapes_that_hide(const struct kiln_draw_shapes *shapes)
{
    struct kiln_shape_set hide = kiln_shape_set_empty(shapes->counts.x);
    for (uint32_t i = 0; i < shapes->counts.x; i++) {
        if (shapes->shapes[i].kind.x != SHAPE_PLANE)
            kiln_shape_set_add(&hide, i);
    }
    kiln_shape_set_trim(&hide);
    return hide;
}

#endif
