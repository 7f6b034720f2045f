/* A kiln_moment is the state of a scene at one time as every stage of drawing sees it. It is filled
 * once, before the first of these stages; lights, backdrop, solids and sprites only read it. */
#ifndef KILN_DRAW_MOMENT_MOMENT_H
#define KILN_DRAW_MOMENT_MOMENT_H

#include "base/simd.h"
#include "draw/moment/instances.h"
#include "draw/moment/looks.h"
#include "draw/moment/meshes.h"
#include "draw/moment/shapes.h"
#include "draw/moment/view.h"
#include "particles/pool.h"

struct kiln_moment_gl;

struct kiln_moment {
    /* These are the same in all moments of a scene: */
    const struct kiln_scene *scene;
    enum kiln_simd simd;             /* the width of vectors on this machine */
    struct kiln_instances instances; /* the meshes that particles look like */
    struct kiln_draw_look looks[KILN_MAX_SYSTEMS];
    struct kiln_moment_gl *gl; /* its buffers and textures (moment_gl.h); NULL: the host alone */

    /* These are of the moment that was filled last: */
    struct kiln_pool *pool; /* NULL: there are no particles */
    struct kiln_view view;
    struct kiln_sun_frame sun;
    float4 *look_table;                  /* KILN_LOOK_TEXELS, as of kiln_looks_sample */
    uint64_t look_changes;               /* grows when the table changes */
    struct kiln_meshes meshes;           /* of the backdrop: posed, painted, with their bounds */
    struct kiln_draw_shapes shapes;      /* as of kiln_shapes_fill */
    const struct kiln_particle *records; /* of the pool, on the host; NULL: not asked for */
    const struct kiln_spin *spins; /* the same; NULL: no particle is turned by collisions, either */
};

/* Scene, device and atlas must outlive the moment; device may be NULL. atlas is that of all
 * systems; NULL: no textures will be drawn. False with KILN_DEVICE_FAILED, or as
 * kiln_meshes_init; nothing is left then. */
bool kiln_moment_init(struct kiln_moment *moment, struct kiln_device *device,
                      const struct kiln_scene *scene, const struct kiln_atlas *atlas,
                      struct kiln_error *error);

/* Does nothing for a moment of zeros. */
void kiln_moment_finish(struct kiln_moment *moment);

/* Fills it with the pool's state after `step` steps. The pool, borrowed until the next call, is
 * not stepped meanwhile. on_host: records and spins are asked for there, which reads them back
 * from a device that holds them. */
bool kiln_moment_fill(struct kiln_moment *moment, struct kiln_pool *pool, uint32_t step,
                      bool on_host, struct kiln_error *error);

#endif
