/* This file has the option tables of the way from light to the picture: the resolution of
 * particles, composition, bloom, exposure, tone mapping and dither. */
#include <string.h>

#include "scene/rows.h"

#define AT(field) offsetof(struct kiln_post, field)

static const char *const composes[] = {
    [KILN_COMPOSE_MERGED] = "merged",
    [KILN_COMPOSE_SEPARATE] = "separate",
    [KILN_COMPOSE_ALPHA] = "alpha",
    [KILN_COMPOSE_OIT] = "oit",
    NULL,
};

static const char *const resolutions[] = {
    [KILN_RESOLUTION_FULL] = "full",
    [KILN_RESOLUTION_HALF] = "half",
    [KILN_RESOLUTION_QUARTER] = "quarter",
    NULL,
};

static const char *const bloom_kinds[] = {
    [KILN_BLOOM_NONE] = "none",
    [KILN_BLOOM_GAUSSIAN] = "gaussian",
    [KILN_BLOOM_PYRAMID] = "pyramid",
    NULL,
};

static const char *const bloom_sources[] = {
    [KILN_BLOOM_WEIGHTS] = "weights",
    [KILN_BLOOM_BRIGHT] = "bright",
    NULL,
};

static const char *const tonemaps[] = {
    [KILN_TONEMAP_NONE] = "none",
    [KILN_TONEMAP_AGX] = "agx",
    [KILN_TONEMAP_ACES] = "aces",
    NULL,
};

bool kiln_tonemap_find(const char *name, enum kiln_tonemap *tonemap)
{
    for (size_t i = 0; tonemaps[i]; i++) {
        if (strcmp(tonemaps[i], name) == 0) {
            *tonemap = (enum kiln_tonemap)i;
            return true;
        }
    }
    return false;
}

static const struct kiln_option particles[] = {
    CHOICE(LOOK, "resolution", resolution, resolutions, "full",
           "Size of the picture that particles are drawn into, in parts of the frame's width: the "
           "smaller, the "
           "faster and the softer. For large, soft sprites."),
    BOOLEAN(LOOK, "mixed", mixed_resolution, "false",
            "Full resolution where the depth of the scene has edges, half or quarter elsewhere."),
    END,
};

static const struct kiln_option bloom[] = {
    CHOICE(LOOK, "kind", bloom, bloom_kinds, "gaussian",
           "How the glow is spread: gaussian by some 40 pixels, pyramid by parts of the picture."),
    CHOICE(LOOK, "source", bloom_source, bloom_sources, "weights",
           "What glows: particles by look.bloom, or all that is brighter than the threshold."),
    VALUE(LOOK, "strength", bloom_strength, KILN_PLAIN, 0, 100, TIME, "1", "Factor on the glow."),
    VALUE(LOOK, "threshold", bloom_threshold, KILN_PLAIN, 0, 1000000, TIME, "1",
          "Exposed light beyond which the source bright glows."),
    VALUE(LOOK, "radius", bloom_radius, KILN_FRACTION, 0, 1, TIME, "0.7",
          "How far the pyramid spreads the glow."),
    END,
};

const struct kiln_option kiln_options_post[] = {
    CHOICE(LOOK, "compose", compose, composes, "merged",
           "merged sorts fire and smoke together; separate draws fire over smoke; alpha is merged "
           "with fire that covers what is behind it; oit is merged with each pixel sorted on its "
           "own, by the depths of what is seen there (look.thickness)."),
    GROUP(LOOK, "particles", 0, particles, "How finely particles are drawn."),
    GROUP(LOOK, "bloom", 0, bloom, "The glow around bright things."),
    VALUE(LOOK, "exposure", exposure, KILN_STOPS, -20, 20, TIME, "0",
          "Doubles the light per stop."),
    CHOICE(LOOK, "tonemap", tonemap, tonemaps, "agx", "How light becomes a picture."),
    BOOLEAN(LOOK, "dither", dither, "true", "Hides the steps of 8-bit pictures."),
    END,
};
