/* This file has the option tables of the way from light to the picture: the resolution of
 * particles, composition, bloom, exposure, tone mapping and dither. */
#include <string.h>

#include "scene/rows.h"

#define FILLS struct kiln_post

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
    [KILN_BLOOM_THESIS] = "thesis",
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

TABLE(particles) = {
    CHOICE(LOOK, "resolution", resolution, resolutions, "full",
           "Width of the picture that particles are drawn into, as a part of the frame's width. A "
           "smaller picture is faster and softer. It suits large, soft sprites."),
    BOOLEAN(LOOK, "mixed", mixed_resolution, "false",
            "Particles are drawn in full resolution where the depth of the scene has edges, and in "
            "half or quarter resolution elsewhere. This is for GL: on the device `cpu` it takes "
            "about as long as full resolution."),
    END,
};

TABLE(bloom) = {
    CHOICE(LOOK, "kind", bloom, bloom_kinds, "pyramid",
           "How the glow is spread: gaussian evenly around, by `sigma`; pyramid into a bright core "
           "and a wide skirt, by `radius`. Both look the same in pictures of all sizes. thesis is "
           "the Gaussian of Heinz 2019, some 40 pixels wide in a picture of any size."),
    CHOICE(LOOK, "source", bloom_source, bloom_sources, "weights",
           "What glows: weights takes particles by look.bloom, bright takes all that is brighter "
           "than `threshold`."),
    VALUE(LOOK, "strength", bloom_strength, KILN_PLAIN, 0, 100, TIME(66), "1",
          "Factor on the glow."),
    VALUE(LOOK, "threshold", bloom_threshold, KILN_PLAIN, 0, 1000000, TIME(67), "1",
          "Exposed light above which the source bright glows."),
    VALUE(LOOK, "radius", bloom_radius, KILN_FRACTION, 0, 1, TIME(68), "0.7",
          "How far the pyramid spreads the glow."),
    VALUE(LOOK, "sigma", bloom_sigma, KILN_FRACTION, 0, 0.25, 0, "0.019",
          "Standard deviation of the gaussian as a part of the picture's height. The glow is seen "
          "about three times as far."),
    END,
};

PUBLIC_TABLE(kiln_options_post) = {
    CHOICE(LOOK, "compose", compose, composes, "merged",
           "`merged` sorts fire and smoke together. `separate` draws fire over smoke. `alpha` "
           "works like "
           "`merged`, and fire covers what is behind it. `oit` works like `merged`, and sorts the "
           "particles "
           "of each pixel on its own, by the depths that the pixel sees (look.thickness)."),
    GROUP(LOOK, "particles", particles, "How finely particles are drawn."),
    GROUP(LOOK, "bloom", bloom, "The glow around bright things."),
    VALUE(LOOK, "exposure", exposure, KILN_STOPS, -20, 20, TIME(69), "0",
          "Exposure in stops; each stop doubles the light."),
    CHOICE(LOOK, "tonemap", tonemap, tonemaps, "agx",
           "Tone mapping of light into the colours of the picture."),
    BOOLEAN(LOOK, "dither", dither, "true", "Dithering hides the banding of 8-bit pictures."),
    END,
};
