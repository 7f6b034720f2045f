/* Declares the division of a polygon into triangles. */
#ifndef KILN_DECODE_POLYGON_H
#define KILN_DECODE_POLYGON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Holds one polygon. It is used for all polygons of a file, one after the other, and begins as
 * zeros. */
struct decode_polygon {
    size_t count;             /* of corners */
    float (*points)[3];       /* of corners; filled by the caller */
    uint32_t (*triangles)[3]; /* the result: count - 2 triangles, by numbers of corners */
    size_t capacity;
    double (*flat)[2];
    uint32_t *next, *previous, *bends;
};

/* Makes room for a polygon of `count` corners. False: memory is short. */
bool decode_polygon_resize(struct decode_polygon *polygon, size_t count);

/* Divides a polygon of at least three corners. */
void decode_polygon_divide(struct decode_polygon *polygon);

void decode_polygon_finish(struct decode_polygon *polygon);

#endif
