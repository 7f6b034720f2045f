/* This header declares the objects that rays of technique backdrop=cpu may hit in a frame, and
 * their light. Vectors of rays are followed by ray_trace_simd.c and lit by ray_light_simd.c, for
 * strips of the picture (backdrop_simd.c). Each ray_*.h has the functions of one subject, which are
 * inlined into these files and into solid_simd.c. The arithmetic that GL shares is in
 * shaders/shared. */
#ifndef KILN_DRAW_BACKDROP_RAY_H
#define KILN_DRAW_BACKDROP_RAY_H

#include "asset/image/pyramid.h"
#include "draw/backdrop/casters.h"
#include "draw/backdrop/mesh_view.h"
#include "draw/light/lamps.h"
#include "draw/light/lighting.h"
#include "draw/light/smoke_shadow.h"
#include "draw/moment/shapes.h"

struct kiln_ray_frame {
    const struct kiln_view *view;
    const struct kiln_draw_backdrop *backdrop;
    const struct kiln_draw_shapes *shapes;
    const struct kiln_shape_set *all_shapes;
    const struct kiln_shape_seen *from_sun;             /* of each shape */
    const struct kiln_pyramid *floor_image, *sky_image; /* NULL: none */
    const float *smoke_to_sun, *smoke_to_sky;           /* NULL: none */
    struct kiln_solid_bins solids;
    const struct kiln_mesh_view *meshes; /* NULL: none */
    struct kiln_lamp_objects lamp_objects;
    const struct kiln_object_bounds *object_bounds;
    const struct kiln_casters *all_casters; /* what may hide lights from anything */
    const struct kiln_casters *casters;     /* what may hide them from the surfaces that are lit */
    const float *lamp_smoke;                /* of struct kiln_lighting */
    bool floor_gloss;
};

#endif
