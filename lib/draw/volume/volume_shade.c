/* This file dims the light of sun and sky in a block of gas by what is in its way: objects, and
 * smoke that is not the domain's own. The domain's own smoke has dimmed it before (volume_light.c).
 */
#include "draw/volume/volume_shade.h"

#include "draw/moment/appearance_blocks.h"

/* Finds the part of the sun that places of a block see past objects. A place counts as a ball of
 * two cells. */
static void find_sun_parts(const struct kiln_volume_shade *s, const struct kiln_volume_frame *frame,
                           struct kiln_gas_place brick, float parts[VOLUME_PLACES])
{
    enum { COUNT = VOLUME_SPARSE * VOLUME_SPARSE * VOLUME_SPARSE };
    struct kiln_appearance_block balls;
    for (int32_t first = 0; first < VOLUME_PLACES; first += KILN_LANES) {
        for (int32_t i = 0; i < KILN_LANES; i++) {
            float at[3];
            kiln_volume_find_place(frame, brick, first + i, at);
            balls.position.x[i] = at[0];
            balls.position.y[i] = at[1];
            balls.position.z[i] = at[2];
            balls.radius[i] = frame->cell_m;
            balls.alive[i] = first + i < COUNT;
        }
        kiln_sun_shade_balls(s->objects, s->simd, &balls, parts + first);
    }
}

/* Dims the sun in the cells of a block that objects hide it from. */
static void shade_by_objects(const struct kiln_volume_shade *s,
                             const struct kiln_volume_frame *frame, struct kiln_gas_place brick,
                             float *block)
{
    alignas(64) float parts[VOLUME_PLACES];
    float row[GAS_BRICK];
    find_sun_parts(s, frame, brick, parts);
    for (int32_t z = 0; z < GAS_BRICK; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++) {
            kiln_volume_spread(parts, y, z, row);
            for (int32_t x = 0; x < GAS_BRICK; x++) {
                float *cell = kiln_volume_cell(block, x, y, z);
                cell[VOLUME_SUN] *= row[x];
                cell[VOLUME_SCATTERED] *= row[x];
            }
        }
}

/* Dims sun and sky in the cells of a block by smoke. */
static void shade_by_smoke(const struct kiln_volume_shade *s, const struct kiln_volume_frame *frame,
                           struct kiln_gas_place brick, float *block)
{
    struct kiln_volume_smoke_parts parts;
    float once[GAS_BRICK], more[GAS_BRICK], sky[GAS_BRICK];
    KILN_SIMD_PICK(kiln_volume_smoke_reach, s->simd)(s, frame, brick, &parts);
    for (int32_t z = 0; z < GAS_BRICK; z++)
        for (int32_t y = 0; y < GAS_BRICK; y++) {
            kiln_volume_spread(parts.once, y, z, once);
            kiln_volume_spread(parts.more, y, z, more);
            kiln_volume_spread(parts.sky, y, z, sky);
            for (int32_t x = 0; x < GAS_BRICK; x++) {
                float *cell = kiln_volume_cell(block, x, y, z);
                cell[VOLUME_SUN] *= once[x];
                cell[VOLUME_SCATTERED] *= more[x];
                cell[VOLUME_RED] *= sky[x];
            }
        }
}

void kiln_volume_shade_block(const struct kiln_volume_shade *shade,
                             const struct kiln_volume_frame *frame, struct kiln_gas_place brick,
                             float *block)
{
    if (shade->objects)
        shade_by_objects(shade, frame, brick, block);
    if (shade->sun.depth || shade->sky.depth)
        shade_by_smoke(shade, frame, brick, block);
}
