/* Computes the colour of a black body. */
#ifndef KILN_ASSET_ATLAS_BLACKBODY_H
#define KILN_ASSET_ATLAS_BLACKBODY_H

enum { KILN_OBSERVER_SAMPLES = 81 }; /* samples every 5 nm from 380 to 780 nm */

/* Samples of the colour matching functions, which all colours share. */
struct kiln_observer {
    float xyz[KILN_OBSERVER_SAMPLES][3];
};
void kiln_observer_fill(struct kiln_observer *observer);

/* Computes the linear Rec. 709 colour of a black body. Its hue is that of Planck's law. Its
 * brightness is (kelvin / 1900)^4, relative to Rec. 709 luminance 1 at 1900 K; that is a choice,
 * since true visible brightness falls faster. Colours outside of the gamut lose their negative
 * part. 0 below 400 K. */
void kiln_blackbody_color(const struct kiln_observer *observer, float kelvin, float rgb[3]);

/* Returns the luminance of a black body by Planck's law, in a unit of its own. 0 below 400 K. */
float kiln_blackbody_luminance(const struct kiln_observer *observer, float kelvin);

/* Computes the linear Rec. 709 light of a black body by Planck's law, in parts of a luminance of
 * kiln_blackbody_luminance; black if that is 0. */
void kiln_blackbody_light(const struct kiln_observer *observer, float kelvin, float luminance,
                          float rgb[3]);

#endif
