/* The colour of hot things. */
#ifndef KILN_ASSET_ATLAS_BLACKBODY_H
#define KILN_ASSET_ATLAS_BLACKBODY_H

/* Linear Rec. 709 of a black body at kelvin: hue from Planck's law, brightness (kelvin / 1900)^4
 * relative to Rec. 709 luminance 1 at 1900 K (scaled to taste: true visible brightness falls
 * faster). Colours outside of the gamut lose their negative part. 0 below 400 K. */
void kiln_blackbody_color(float kelvin, float rgb[3]);

#endif
