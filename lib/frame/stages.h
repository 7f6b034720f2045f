/* A kiln_stages holds the stages that draw a state, and the images between them (Heinz 2019, figure
 * 3.1). */
#ifndef KILN_FRAME_STAGES_H
#define KILN_FRAME_STAGES_H

#include "asset/atlas/atlas.h"
#include "draw/backdrop/backdrop.h"
#include "draw/solids/solids.h"
#include "draw/sprites/coarse.h"
#include "draw/sprites/particles.h"
#include "frame/run.h"
#include "frame/technique.h"
#include "gpu/timer.h"
#include "output/output.h"
#include "post/bloom.h"
#include "post/composite.h"
#include "post/shutter.h"
#include "sort/sort.h"

struct kiln_stages {
    struct kiln_device *device; /* NULL: all on the host */
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    bool layers;              /* the layers of an EXR file are wanted */
    bool glow;                /* particles draw their glow */
    struct kiln_timer *timer; /* borrowed, as is the caller */
    const struct kiln_caller *caller;
    struct kiln_atlas atlas;

    struct kiln_sort *sort;
    struct kiln_moment moment; /* the moment that is being drawn */
    struct kiln_lighting_stage *lighting;
    struct kiln_lighting light; /* of the moment */
    bool on_host;               /* a drawing stage reads particles there */
    struct kiln_backdrop_stage *backdrop;
    struct kiln_particles_stage *particles;
    struct kiln_coarse_stage *coarse;   /* NULL: particles have the frame's resolution */
    struct kiln_solids_stage *solids;   /* NULL without any */
    struct kiln_shutter_stage *shutter; /* NULL: a frame is a single moment */
    struct kiln_bloom_stage *bloom;
    struct kiln_composite_stage *composite;

    struct kiln_buffer entries;                       /* draw entries of the pass at hand */
    struct kiln_image backdrop_color, backdrop_depth; /* of a scene with solids */
    struct kiln_image scene_color, scene_depth;       /* the backdrop, and solids if any */
    struct kiln_image particle_color; /* all particles (merged), or smoke alone (separate) */
    struct kiln_image fire_color;     /* separate composition, and for layers */
    struct kiln_image smoke_color;    /* for layers of merged composition */
    struct kiln_image bloom_color;    /* what will be blurred */
    struct kiln_framebuffer particle_framebuffer, fire_framebuffer, smoke_framebuffer;
};

/* Describes what stages are set up for. Threads, timer and caller are borrowed; the caller is asked
 * before each pass. */
struct kiln_stages_params {
    struct kiln_techniques techniques;
    struct kiln_output_needs needs; /* what the output will ask for */
    struct kiln_threads *threads;
    struct kiln_timer *timer;
    const struct kiln_caller *caller;
    uint32_t slot_count; /* of the pool that will be drawn */
};

/* Sets everything up for a scene. device NULL: without GL, all techniques `cpu`. On failure nothing
 * is left. */
bool kiln_stages_init(struct kiln_stages *stages, struct kiln_device *device,
                      const struct kiln_scene *scene, const struct kiln_stages_params *params,
                      struct kiln_error *error);
void kiln_stages_finish(struct kiln_stages *stages);

/* Draws the pool as it is after `step` steps, as one of the samples of a frame (from 0; there are
 * scene->camera.shutter_samples): every stage from sort to particles. *drawn counts the particles.
 */
bool kiln_stages_draw(struct kiln_stages *stages, struct kiln_pool *pool, uint32_t step,
                      uint32_t sample, uint32_t *drawn, struct kiln_error *error);

/* Updates the kept order for a moment that is not drawn, as drawing it would do. It is needed if
 * kiln_stages_keep_history returns true. */
bool kiln_stages_pass_over(struct kiln_stages *stages, struct kiln_pool *pool, uint32_t step,
                           struct kiln_error *error);
bool kiln_stages_keep_history(const struct kiln_stages *stages);

/* Makes the picture of a frame from the moments that were drawn: runs bloom and composite. */
bool kiln_stages_compose(struct kiln_stages *stages, uint32_t frame, struct kiln_error *error);

/* Copies what was drawn into a picture made for the same needs. */
bool kiln_stages_read(struct kiln_stages *stages, struct kiln_picture *picture,
                      struct kiln_error *error);

/* Writes the names and channels of a frame's layers, for kiln_picture_create; returns how many
 * there are. */
uint32_t kiln_stages_layers(const char *names[KILN_MAX_LAYERS], uint32_t channels[KILN_MAX_LAYERS]);

#endif
