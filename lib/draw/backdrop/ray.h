/* This header declares the objects that rays of technique backdrop=cpu may hit in a frame, and
 * their light. The code that follows vectors of rays is in ray_*.h, which backdrop_simd.c and
 * solid_simd.c include. The arithmetic that GL shares is in shaders/shared. */
#ifndef KILN_DRAW_BACKDROP_RAY_H
#define KILN_DRAW_BACKDROP_RAY_H

#include "asset/image/pyramid.h"
#include "draw/backdrop/mesh_view.h"
#include "draw/light/lamps.h"
#include "draw/light/lighting.h"
#include "draw/light/smoke_shadow.h"
#include "draw/moment/shapes.h"

struct kiln_ray_frame {
    const struct kiln_view *view;
    const struct kiln_draw_backdrop *backdrop;
    const struct kiln_draw_shapes *shapes;
    const struct kiln_pyramid *floor_image, *sky_image; /* NULL: none */
    const float *smoke_to_sun, *smoke_to_sky;           /* NULL: none */
    struct kiln_solid_bins solids;
    const struct kiln_mesh_view *meshes; /* NULL: none */
    struct kiln_lamp_objects lamp_objects;
    const float *lamp_smoke; /* of struct kiln_lighting */
    bool floor_gloss, soft_sun;
};

/* Holds the objects that rays may hit, a bit for each. */
struct kiln_ray_objects {
    uint32_t boxes, spheres, cylinders, capsules, oriented_boxes, planes;
};

#endif
