/* Computes the colour of a black body. */
#ifndef KILN_ASSET_ATLAS_BLACKBODY_H
#define KILN_ASSET_ATLAS_BLACKBODY_H

enum { KILN_OBSERVER_SAMPLES = 81 }; /* every 5 nm from 380 to 780 nm */

/* The colour matching functions, which all colours take. */
struct kiln_observer {
    float xyz[KILN_OBSERVER_SAMPLES][3];
};
void kiln_observer_fill(struct kiln_observer *observer);

/* Linear Rec. 709 of a black body at kelvin: hue from Planck's law, brightness (kelvin / 1900)^4
 * relative to Rec. 709 luminance 1 at 1900 K (scaled to taste: true visible brightness falls
 * faster). Colours outside of the gamut lose their negative part. 0 below 400 K. */
void kiln_blackbody_color(const struct kiln_observer *observer, float kelvin, float rgb[3]);

#endif
