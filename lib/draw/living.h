/* The living particles as the host sees them, for what is computed of all of them: the light that
 * fire sheds, the shadow that smoke throws. */
#ifndef KILN_DRAW_LIVING_H
#define KILN_DRAW_LIVING_H

#include "particles/pool.h"
#include "scene/scene.h"
#include "shared/draw_layout.h"

struct kiln_living {
    float3 position; /* m */
    float radius;    /* m: half of the billboard's edge */
    float progress;  /* through its life, 0 to 1 */
    float opacity;   /* at this age, fades included */
    float3 glow;     /* emitted light, the mean of its hot and cool parts */
};

/* Calls visit for each living particle of a system in the order of its slots. table: of
 * kiln_looks_sample at the view's time; records: of the pool. */
void kiln_living_visit(const struct kiln_scene *scene, const struct kiln_pool *pool,
                       const struct kiln_particle *records, const struct kiln_view *view,
                       const float4 *table, uint32_t system,
                       void (*visit)(void *context, const struct kiln_living *particle),
                       void *context);

#endif
