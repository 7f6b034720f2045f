/* Declares the size of the table of the light of flames by their temperature, for the host
 * (lib/draw/light/flame_colors.h) and for GL (shaders/draw/volume/volume_sample.glsl). */
#ifndef KILN_SHARED_FLAME_TABLE_H
#define KILN_SHARED_FLAME_TABLE_H

/* The table has one entry more than these, at temperatures from 0 to FLAME_HOTTEST. */
#define FLAME_COLORS 512

/* The hottest temperature of the table; hotter flames look alike. */
#define FLAME_HOTTEST 1.25f

#endif
