/* Declares emitters: where, when and how particles of a system are born (Heinz 2019, 2.1.2). Births
 * are spread inside the step. */
#ifndef KILN_SCENE_EMITTER_H
#define KILN_SCENE_EMITTER_H

#include <stdbool.h>
#include <stdint.h>

#include "option/values.h"
#include "particles/births.h"
#include "scene/node.h"

struct kiln_source;

enum kiln_emitter_shape {
    KILN_EMITTER_POINT,
    KILN_EMITTER_SPHERE,
    KILN_EMITTER_BOX,
    KILN_EMITTER_DISC,
    KILN_EMITTER_CONE,
    KILN_EMITTER_LINE,
    KILN_EMITTER_RING, /* the rim of a disc */
    KILN_EMITTER_MESH,
    KILN_EMITTER_IMAGE,
    KILN_EMITTER_PATH,
    KILN_EMITTER_SYSTEM, /* of a source of gas: the particles of a system */
};

/* Names the part of a mesh that particles are born on. */
enum kiln_source_on {
    KILN_ON_SURFACE,
    KILN_ON_VERTICES,
    KILN_ON_VOLUME, /* in it */
};

/* A mesh, an image or a path that particles are born on (scene/source.h). */
struct kiln_emit_source {
    const char *file;   /* an absolute path; NULL: none */
    const char *object; /* mesh: name or number of an object, as written; NULL: none */
    enum kiln_source_on on;
    struct kiln_value3 rotation;    /* rad, mesh: about x, then y, then z; constant */
    double scale;                   /* mesh: metres in one unit of the file */
    double width;                   /* m: image */
    double threshold;               /* image: pixels count from here on */
    struct kiln_path path;          /* points and closed */
    bool of_object;                 /* follows */
    uint32_t number;                /* follows: that of the object */
    float edge;                     /* follows: m, of a pixel or a column */
    const struct kiln_source *made; /* follows; NULL: there is none */
};

enum kiln_event {
    KILN_EVENT_DEATH,  /* the end of the parent's life */
    KILN_EVENT_BOUNCE, /* the parent's first impact, or each one */
    KILN_EVENT_TRAIL,  /* the parent's whole life, evenly in time or along its way */
};

enum kiln_align {
    KILN_ALIGN_WORLD,    /* the shape keeps the axes of the world */
    KILN_ALIGN_VELOCITY, /* its y axis turns to the parent's direction of flight */
    KILN_ALIGN_NORMAL,   /* its y axis turns to the normal of the surface that the parent hit */
};

/* Says which values of its parent's look a child has, as they were at its birth, instead of its
 * own. */
struct kiln_inherited {
    bool color, size, temperature;
};

/* The defaults of keys that are refused with another value where they would do nothing. */
#define KILN_BOUNCE_MOST 3u
#define KILN_TRAIL_MOST  256u
#define KILN_TRAIL_RATE  20.0f

/* Says how particles are born of particles of another system: shared/family.h. */
struct kiln_parent {
    bool enabled;
    const char *name;
    uint32_t system; /* index of that system */
    enum kiln_event event;
    enum kiln_align align;
    uint32_t count[2];      /* death, bounce: the fewest and the most children of one event */
    bool impact;            /* death: a death at an impact counts as well */
    bool every;             /* bounce: each of the first `hits` impacts has children */
    uint32_t hits;          /* KILN_BOUNCE_MOST by default */
    struct kiln_value rate; /* trail: children a second; KILN_TRAIL_RATE by default; clock constant,
                               or life of the parent */
    double per_metre;       /* trail: children a metre of the parent's way; 0: by the rate */
    uint32_t most; /* trail by the metre: the most children of one parent; KILN_TRAIL_MOST by
                      default */
    struct kiln_inherited look;
    uint32_t slots; /* slots for the children of one parent: above 0 when enabled */
};

struct kiln_emitter {
    struct kiln_parent parent; /* if enabled, there are no births by rate or in bursts */
    struct kiln_value rate;    /* particles a second; clock constant or time */
    double per_metre;          /* particles a metre of the emitter's way */
    const uint64_t *by_way;    /* follows from it: see struct kiln_births_source; or NULL */
    uint32_t way_count;
    struct kiln_burst bursts[KILN_MAX_BURSTS];
    uint32_t burst_count;
    struct kiln_range life;  /* s, at birth */
    struct kiln_range speed; /* m/s, at birth */
    enum kiln_emitter_shape shape;
    struct kiln_attach attach;      /* the shape lies in this node */
    struct kiln_value3 origin;      /* m: centre of the shape, apex disc's centre of a cone */
    struct kiln_value3 direction;   /* need not be normalised; not zero unless outward */
    struct kiln_value angle;        /* rad: half angle of the directions about `direction`, 0..pi */
    bool outward;                   /* sphere: directions point away from the origin instead */
    bool surface;                   /* sphere, box, disc: births on the surface or rim alone */
    struct kiln_value radius;       /* m: sphere, disc, base of the cone */
    struct kiln_value3 size;        /* m: box, full edges; line, from its first end to its last */
    uint32_t nozzles;               /* line: places that births take in turn; 0: anywhere on it */
    bool ordered;                   /* line, ring, path: the births of a burst follow one another */
    struct kiln_emit_source source; /* mesh, image, path */
    struct kiln_value turn;         /* rad/s: of the shape about its direction */
    struct kiln_value inherit;      /* part of the velocity of emitter or parent */
};

#endif
