/* This header declares the objects that rays of technique backdrop=cpu may hit in a frame, and
 * their light. The code that follows vectors of rays is in ray_*.h, for backdrop_simd.c and
 * solid_simd.c. It computes what shaders/draw computes in GL, in arithmetic that does not depend on
 * the machine. */
#ifndef KILN_DRAW_BACKDROP_RAY_H
#define KILN_DRAW_BACKDROP_RAY_H

#include "asset/image/pyramid.h"
#include "draw/backdrop/mesh_view.h"
#include "draw/light/lighting.h"
#include "draw/light/smoke_shadow.h"
#include "draw/moment/shapes.h"

enum { KILN_WAVES = 8 };

/* Describes a wave of the floor's water. */
struct kiln_wave {
    float way_x, way_z; /* unit */
    float number;       /* 2 pi / length, 1/m */
    float phase;        /* at the origin, rad */
    float bend;         /* how far it shifts those after it, m */
};

/* Holds the sun in the frame of a rotated box, as sun_inverse and edges_alike hold it in the
 * world's. */
struct kiln_turned_sun {
    float3 inverse, edges_alike;
};

struct kiln_ray_frame {
    const struct kiln_view *view;
    const struct kiln_draw_backdrop *backdrop;
    const struct kiln_draw_shapes *shapes;
    const struct kiln_pyramid *floor_image, *sky_image; /* NULL: none */
    const float *smoke_to_sun, *smoke_to_sky;           /* NULL: none */
    struct kiln_solid_bins solids;
    const struct kiln_mesh_view *meshes; /* NULL: none */
    bool floor_gloss, soft_sun;
    float3 sun_inverse; /* of the direction, by axis; large for 0 */
    float3 edges_alike; /* of boxes, towards the sun: x is of y and z, and so on */
    struct kiln_wave waves[KILN_WAVES];
    struct kiln_turned_sun turned[KILN_MAX_OBJECTS];
};

/* Holds the objects that rays may hit, a bit for each. */
struct kiln_ray_objects {
    uint32_t boxes, spheres, cylinders, capsules, turned, planes;
};

#endif
