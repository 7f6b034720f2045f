/* This header declares a canvas on which solid particles are drawn as a lamp sees them, one face of
 * the cube around it at a time. It adds up the part of each texel that they cover, from the nearest
 * particle to the farthest, so that a particle much smaller than a texel hides only its share. */
#ifndef KILN_DRAW_LIGHT_SOLID_FACE_H
#define KILN_DRAW_LIGHT_SOLID_FACE_H

#include <stdbool.h>

#include "draw/light/bit_mask.h"
#include "draw/moment/instances.h"
#include "shared/draw_layout.h"

struct kiln_solid_canvas;

/* A solid particle, seen from the lamp. In the frame of a face, z is along the face's axis. */
struct kiln_seen_solid {
    float3 center; /* m, in the frame of the face */
    float radius;  /* of the sphere that stands for it, m */
    float opacity; /* 0 to 1 */
};

/* A solid particle that is a mesh. */
struct kiln_seen_mesh {
    const float4 (*corners)[2]; /* as of struct kiln_instances, three a triangle */
    uint32_t triangles;
    float3 axes[3]; /* in the frame of the face, for each unit of a corner, m */
    float reach;    /* radius of its bounding sphere, m */
};

/* Returns a place or a direction of the world, relative to the lamp, in the frame of a face: right,
 * up, along its axis (lamp_place_of). face: 0 to 5. */
float3 kiln_face_frame(uint32_t face, float3 from);

/* Returns whether a ball lies beside the face's picture for certain. */
bool kiln_face_misses(float3 center, float radius);

/* Returns the bytes of a canvas. */
size_t kiln_solid_canvas_bytes(void);

/* Returns an empty canvas, or NULL when memory is short. */
struct kiln_solid_canvas *kiln_solid_canvas_create(void);
void kiln_solid_canvas_destroy(struct kiln_solid_canvas **canvas);

/* Removes all that was drawn. far: distance that the map reaches, m. */
void kiln_solid_canvas_clear(struct kiln_solid_canvas *canvas, float far);

/* Draw a solid behind all that have been drawn: as a ball, or as a mesh where it is large enough
 * for its shape to show. The lamp must be outside of the ball. */
void kiln_solid_canvas_ball(struct kiln_solid_canvas *canvas, const struct kiln_seen_solid *solid);
void kiln_solid_canvas_mesh(struct kiln_solid_canvas *canvas, const struct kiln_seen_solid *solid,
                            const struct kiln_seen_mesh *mesh);

/* Writes the entries of a face at all levels, KILN_LAMP_SOLID_WORDS words. */
void kiln_solid_canvas_write(const struct kiln_solid_canvas *canvas, uint32_t *texels);

#endif
