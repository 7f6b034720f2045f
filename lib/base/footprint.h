/* Adds up the memory that a job is expected to take, before it takes it. Each room that allocates
 * much has a function of the name *_footprint beside the code that allocates. Both take their sizes
 * from the same functions and structs. */
#ifndef KILN_BASE_FOOTPRINT_H
#define KILN_BASE_FOOTPRINT_H

#include <stdint.h>

/* Names what of a scene the memory grows with. */
enum kiln_footprint_part {
    KILN_FOOTPRINT_PICTURE,   /* pixels of a frame */
    KILN_FOOTPRINT_PARTICLES, /* slots of particles */
    KILN_FOOTPRINT_TEXTURES,  /* cells of textures of particles, and the pictures they come from */
    KILN_FOOTPRINT_OBJECTS,   /* meshes, their paint, terrain, and grids that move particles */
    KILN_FOOTPRINT_LIGHTS,    /* lights that cast shadows */
    KILN_FOOTPRINT_BACKDROP,  /* pictures of floor and sky */
    KILN_FOOTPRINT_GAS,       /* cells of gas */
    KILN_FOOTPRINT_PARTS,     /* number of parts */
};

struct kiln_footprint {
    uint32_t threads;                     /* of the job */
    uint64_t bytes[KILN_FOOTPRINT_PARTS]; /* what stays until the job ends */
    /* the most that is taken while one thing is made, and freed before the next is made */
    uint64_t passing;
    enum kiln_footprint_part passing_part;
};

/* Adds `count` items of `size` bytes. A sum beyond UINT64_MAX stays UINT64_MAX. */
void kiln_footprint_add(struct kiln_footprint *footprint, enum kiln_footprint_part part,
                        uint64_t count, uint64_t size);

/* Takes note of bytes that are freed before the next thing is made. */
void kiln_footprint_pass(struct kiln_footprint *footprint, enum kiln_footprint_part part,
                         uint64_t bytes);

/* Returns the bytes of all parts. */
uint64_t kiln_footprint_total(const struct kiln_footprint *footprint);

/* Returns the part that takes most. */
enum kiln_footprint_part kiln_footprint_largest(const struct kiln_footprint *footprint);

#endif
