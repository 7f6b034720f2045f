/* Lists the units of given spans by the vectors of lib/draw/sprites/tile_rows.h. */
#include "unit/units_simd.h"

#include "draw/sprites/tile_rows.h"

void KILN_SIMD_NAME(units_list)(const struct kiln_tile *tile, const struct units_spans *spans,
                                struct units_listed *listed)
{
    struct rows rows = {.top = spans->top, .vectors = (spans->rows + LANES - 1) / LANES};
    for (int i = 0; i < rows.vectors; i++) {
        rows.u[i] = vf_load(spans->u + i * LANES);
        rows.v[i] = vf_load(spans->v + i * LANES);
        rows.q[i] = vf_load(spans->q + i * LANES);
        memcpy(&rows.from[i], spans->from + i * LANES, sizeof rows.from[i]);
        memcpy(&rows.units[i], spans->units + i * LANES, sizeof rows.units[i]);
    }
    const struct box box = {spans->x_from, spans->x_to, spans->top, spans->top + spans->rows};
    struct units units;
    memset(&units, 0, sizeof units);
    listed->count = list_units(tile, &rows, &box, spans->steps, spans->deep,
                               tile->has_opaque ? UNITS_SEEN : UNITS_ALL, &units);
    const size_t count = (size_t)listed->count;
    memcpy(listed->at, units.at, count * sizeof *units.at);
    memcpy(listed->u, units.u, count * sizeof *units.u);
    memcpy(listed->v, units.v, count * sizeof *units.v);
    memcpy(listed->q, units.q, count * sizeof *units.q);
}
