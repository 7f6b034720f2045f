/* Declares how a scene becomes a picture once its parts are drawn: the resolution of particles,
 * composition, bloom, exposure and tone mapping. */
#ifndef KILN_SCENE_POST_H
#define KILN_SCENE_POST_H

#include <stdbool.h>

#include "shared/value.h"

enum kiln_compose {
    KILN_COMPOSE_MERGED,   /* fire and smoke are sorted together, premultiplied */
    KILN_COMPOSE_SEPARATE, /* smoke is drawn onto the scene, then fire over it (figure 3.1) */
    KILN_COMPOSE_ALPHA,    /* sorted together, fire covers like smoke (Heinz 2019, 2.3.1) */
    KILN_COMPOSE_OIT,      /* as merged, but sorted in each pixel by the depth there */
};

/* Resolution of the pictures that particles are drawn into. */
enum kiln_resolution { KILN_RESOLUTION_FULL, KILN_RESOLUTION_HALF, KILN_RESOLUTION_QUARTER };

enum kiln_bloom_kind {
    KILN_BLOOM_NONE,
    KILN_BLOOM_GAUSSIAN, /* a part of the picture's height wide */
    KILN_BLOOM_PYRAMID,  /* halved pictures, joined: a bright core with a wide skirt */
    KILN_BLOOM_THESIS,   /* the Gaussian of Heinz 2019, 3.2.5, which is counted in pixels */
};

/* Names the light that blooms. */
enum kiln_bloom_source {
    KILN_BLOOM_WEIGHTS, /* particles, by the bloom weights of their looks */
    KILN_BLOOM_BRIGHT,  /* all light above a threshold */
};

enum kiln_tonemap { KILN_TONEMAP_NONE, KILN_TONEMAP_AGX, KILN_TONEMAP_ACES };

/* Finds a tone mapping by its name in post.tonemap; false: there is none of that name. */
bool kiln_tonemap_find(const char *name, enum kiln_tonemap *tonemap);

struct kiln_post {
    enum kiln_compose compose;
    enum kiln_resolution resolution; /* resolution of the particles */
    bool mixed_resolution;           /* full resolution where the depth of the scene has edges */
    enum kiln_bloom_kind bloom;
    enum kiln_bloom_source bloom_source;
    struct kiln_value bloom_strength;
    struct kiln_value bloom_threshold; /* threshold on light after exposure */
    struct kiln_value bloom_radius;    /* of the pyramid: 0 to 1, how far it spreads */
    struct kiln_value bloom_sigma;     /* of the Gaussian: its standard deviation as a part of the
                                        * picture's height; constant */
    struct kiln_value exposure;        /* exposure in stops */
    enum kiln_tonemap tonemap;
    bool dither;
};

#endif
