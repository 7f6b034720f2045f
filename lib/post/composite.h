/* Stage 5b composes scene, particles and bloom into the picture (Heinz 2019, 3.2.1, last step). */
#ifndef KILN_POST_COMPOSITE_H
#define KILN_POST_COMPOSITE_H

#include "base/thread.h"
#include "gpu/image.h"
#include "scene/scene.h"

/* Both techniques make the same picture, to a level of rounding. */
enum kiln_composite_technique { KILN_COMPOSITE_GL, KILN_COMPOSITE_CPU };

struct kiln_composite_stage;

struct kiln_composite_params {
    enum kiln_composite_technique technique;
    struct kiln_threads *threads; /* of `cpu` */
    uint32_t bits;                /* 8 or 16 of the display picture */
    bool beauty;                  /* whether kiln_composite_read_beauty will be called */
};

/* The scene and the threads must outlive the stage; device may be NULL for `cpu`. NULL with an
 * error. */
struct kiln_composite_stage *kiln_composite_create(struct kiln_device *device,
                                                   const struct kiln_scene *scene,
                                                   const struct kiln_composite_params *params,
                                                   struct kiln_error *error);
void kiln_composite_destroy(struct kiln_composite_stage **stage);

struct kiln_composite_inputs {
    struct kiln_image *scene, *particles; /* particles: premultiplied; NULL: the scene has them */
    struct kiln_image *fire;              /* NULL unless composed separately */
    struct kiln_image *bloom;             /* smaller; NULL for none */
    float bloom_scale;                    /* its size in parts of the picture's */
    uint32_t frame;
    float time_s;
};

bool kiln_composite_run(struct kiln_composite_stage *stage,
                        const struct kiln_composite_inputs *inputs, struct kiln_error *error);

/* Copies the display picture (sRGB, RGBA, not premultiplied, 8 or 16 bits a channel, rows from the
 * top), and the scene-linear premultiplied picture (float RGBA), to the host. */
bool kiln_composite_read_display(struct kiln_composite_stage *stage, void *pixels,
                                 struct kiln_error *error);
bool kiln_composite_read_beauty(struct kiln_composite_stage *stage, float *pixels,
                                struct kiln_error *error);

#endif
