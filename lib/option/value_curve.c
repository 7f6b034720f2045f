/* This file writes the keys of values into the table of keys while a file is read. It computes the
 * slopes and areas of curves once, in IEEE float, so that every technique interpolates with the
 * same bits. */
#include "option/value_curve.h"

#include <math.h>
#include <string.h>

/* Makes room for a number of keys. */
static bool reserve_keys(struct kiln_reader *reader, uint32_t count)
{
    if (count <= reader->key_room)
        return true;
    uint32_t room = reader->key_room ? reader->key_room : KILN_BLOCK_KEYS;
    while (room < count)
        room *= 2;
    float4 *keys = kiln_arena_alloc(reader->scratch, room, sizeof *keys);
    if (!keys)
        return false;
    if (reader->keys)
        memcpy(keys, reader->keys, reader->key_count * sizeof *keys);
    reader->keys = keys;
    reader->key_room = room;
    return true;
}

_Static_assert((int)KILN_NODE_MAX_ENTRIES <= VALUE_MAX_KEYS, "the search finds every key");
_Static_assert(VALUE_MAX_KEYS < 2048, "an entry has room for the count");

bool kiln_curve_begin(struct kiln_reader *reader, const struct kiln_node *node,
                      struct kiln_curve *curve, uint32_t count, uint32_t how)
{
    if (count == 0)
        return kiln_reader_error(reader, node, "found no keys; at least one is needed");
    const uint32_t each = curve->entries + count;
    const uint32_t needed = curve->count * each;
    if (needed > KILN_MAX_VALUE_KEYS - reader->key_count)
        return kiln_reader_error(
            reader, node,
            "%u keys are too many; %s has at most %d, and %u of them are used already", needed,
            reader->origin->kind, KILN_MAX_VALUE_KEYS, reader->key_count);
    if (!reserve_keys(reader, reader->key_count + needed))
        return kiln_reader_out_of_memory(reader);
    for (unsigned i = 0; i < curve->count; i++) {
        curve->values[i] = (struct kiln_value){
            .first = reader->key_count + i * each + curve->entries, .count = count, .how = how};
        for (uint32_t k = 1; k <= curve->entries; k++)
            reader->keys[curve->values[i].first - k] = FLOAT4(0, 0, 0, 0);
    }
    reader->key_count += needed;
    return true;
}

/* Replaces numbers below 2^-100 by 0, since some stages flush denormals and some do not
 * (shared/exact.h). */
static float flush_denormals(float x)
{
    return fabsf(x) < 0x1p-100f ? 0 : x;
}

/* Fills what the key before last has of the way to the last key. */
static void join_keys(float4 *last, uint32_t ease)
{
    const float width = last->x - last[-1].x, rise = last->y - last[-1].y;
    const float mean = ease == VALUE_STEP ? last[-1].y : 0.5f * (last[-1].y + last->y);
    if (ease >= VALUE_SMOOTH) {
        last[-1].z = flush_denormals(rise);
        last[-1].w = 1.0f / width;
        return;
    }
    last[-1].z = ease == VALUE_STEP ? 0.0f : flush_denormals(rise / width);
    last->w = flush_denormals(last[-1].w + width * mean);
}

bool kiln_curve_add(struct kiln_reader *reader, const struct kiln_node *node,
                    struct kiln_curve *curve, float x, const float *y)
{
    const char *axis = curve->clock->clock == KILN_CLOCK_LIFE ? "time" : curve->clock->axis.name;
    for (unsigned i = 0; i < curve->count; i++) {
        float4 *key = &reader->keys[curve->values[i].first + curve->points];
        *key = FLOAT4(x, y[i], 0, curve->ease < VALUE_SMOOTH ? flush_denormals(x * y[i]) : 0);
        if (curve->points == 0)
            continue;
        if (x <= key[-1].x)
            return kiln_reader_error(reader, node,
                                     "the %s of a key must be %s that of the key before it", axis,
                                     strcmp(axis, "time") == 0 ? "later than" : "above");
        if (!isfinite((y[i] - key[-1].y) / (x - key[-1].x)) || !isfinite(1.0f / (x - key[-1].x)))
            return kiln_reader_error(
                reader, node, "the %s of a key is too close to that of the key before it", axis);
        join_keys(key, curve->ease);
    }
    curve->points++;
    return true;
}

float4 kiln_curve_pack(const struct kiln_value *value)
{
    const uint32_t how = value->how & ((1u << VALUE_DRAW_SHIFT) - 1u);
    return FLOAT4(value->constant, (float)value->first, (float)(value->count + 2048u * how),
                  (float)VALUE_DRAW(value->how));
}
