/* A kiln_moment is the state of a scene at one time as every stage of drawing sees it. It is filled
 * before the first of these stages: with its time, then with its particles. Lights, backdrop,
 * solids and sprites only read it. */
#ifndef KILN_DRAW_MOMENT_MOMENT_H
#define KILN_DRAW_MOMENT_MOMENT_H

#include "base/footprint.h"
#include "base/simd.h"
#include "draw/moment/instances.h"
#include "draw/moment/look_values.h"
#include "draw/moment/looks.h"
#include "draw/moment/meshes.h"
#include "draw/moment/shapes.h"
#include "draw/moment/shapes_seen.h"
#include "draw/moment/view.h"
#include "particles/pool.h"

struct kiln_moment_gl;

struct kiln_moment {
    /* These members are the same in all moments of a scene. */
    const struct kiln_scene *scene;
    enum kiln_simd simd;             /* the width of vectors on this machine */
    struct kiln_instances instances; /* the meshes that particles are drawn as */
    struct kiln_draw_look looks[KILN_MAX_SYSTEMS];
    struct kiln_look_program *look_programs; /* of each system, by kiln_look_programs_fill */
    uint32_t look_rows;                      /* of the table */
    struct kiln_moment_gl *gl; /* buffers and textures in GL (moment_gl.h); NULL: no device */

    /* kiln_moment_set_time sets these members. */
    struct kiln_view view;
    struct kiln_sun_frame sun;
    float4 *look_table;             /* look_rows rows, by kiln_looks_sample and look_values.h */
    uint64_t look_changes;          /* a number that grows when the table changes */
    struct kiln_meshes meshes;      /* the backdrop's meshes: posed, with bounds */
    struct kiln_draw_shapes shapes; /* the backdrop's objects, by kiln_shapes_fill */
    struct kiln_shape_seen from_sun[KILN_MAX_OBJECTS];

    /* kiln_moment_set_particles sets these members, and the paint of meshes. */
    struct kiln_pool *pool;              /* the particles; NULL: there are none */
    const struct kiln_particle *records; /* the pool's records on the host; NULL unless on_host */
    const struct kiln_spin *spins; /* the pool's spins on the host; NULL unless on_host and any */
};

/* Initialises a moment. Scene, device and atlas must outlive it. device may be NULL. atlas holds
 * the textures of all systems; NULL: no textures will be drawn. Returns false with
 * KILN_DEVICE_FAILED or an error of kiln_meshes_init; the moment then owns nothing. */
bool kiln_moment_init(struct kiln_moment *moment, struct kiln_device *device,
                      const struct kiln_scene *scene, const struct kiln_atlas *atlas,
                      struct kiln_error *error);

/* Adds the memory of a drawn moment. */
void kiln_moment_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);

/* Frees what the moment owns; does nothing for a moment of zeros. */
void kiln_moment_finish(struct kiln_moment *moment);

/* Sets what follows from the scene and an instant alone: view, sun, looks, poses and shapes. */
void kiln_moment_set_time(struct kiln_moment *moment, struct kiln_instant instant);

/* Sets the view alone: for another instant at the same time, or where nothing is drawn. */
void kiln_moment_set_view(struct kiln_moment *moment, struct kiln_instant instant);

/* Sets the particles of the moment's instant (kiln_between_run). The pool is borrowed until the
 * next call; it must not be stepped meanwhile, and may be NULL. on_host: records and spins are made
 * available on the host, which reads them back from a device that holds them. */
bool kiln_moment_set_particles(struct kiln_moment *moment, struct kiln_pool *pool, bool on_host,
                               struct kiln_error *error);

/* Sets the time and the particles. */
bool kiln_moment_fill(struct kiln_moment *moment, struct kiln_pool *pool,
                      struct kiln_instant instant, bool on_host, struct kiln_error *error);

#endif
