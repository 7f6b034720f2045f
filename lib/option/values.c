/* This file finds out what is known of a value before any particle lives: which clocks it reads,
 * and between which limits its results are. */
#include "option/values.h"

#include <string.h>

/* Returns whether a value has a part: its own curve, what multiplies it, what is added to it. */
static bool has_part(const struct kiln_value *value, uint32_t part)
{
    return part == 0 || (value->how & (part == 1 ? VALUE_TIMES : VALUE_PLUS)) != 0;
}

/* Returns what one part of a value uses, without what multiplies it and what is added to it. */
static uint32_t uses_of_part(struct kiln_value part)
{
    if (part.count == 0)
        return 0;
    const uint32_t clock = VALUE_CLOCK(part.how);
    uint32_t uses = 1u << clock;
    if (VALUE_EASE(part.how) >= VALUE_SMOOTH)
        uses |= 1u << VALUE_USES_EASE;
    if (VALUE_REPEAT(part.how) != VALUE_HOLDS)
        uses |= 1u << VALUE_USES_REPEAT;
    if (VALUE_NOT_PLAIN(part.how))
        uses |= 1u << VALUE_USES_PARTS;
    if (clock == KILN_CLOCK_NOISE && (part.how & VALUE_OF_PARTICLE))
        uses |= KILN_VALUE_USES_OWN_NOISE;
    return uses;
}

uint32_t kiln_value_uses(const float4 *keys, const struct kiln_value *value)
{
    uint32_t uses = 0;
    for (uint32_t part = 0; value->count > 0 && part < VALUE_ENTRIES; part++) {
        if (has_part(value, part))
            uses |= uses_of_part(value_part(keys, *value, part));
    }
    return uses;
}

uint32_t kiln_value3_uses(const float4 *keys, const struct kiln_value3 *value)
{
    return kiln_value_uses(keys, &value->x) | kiln_value_uses(keys, &value->y) |
           kiln_value_uses(keys, &value->z);
}

uint32_t kiln_range_uses(const float4 *keys, const struct kiln_range *range)
{
    return kiln_value_uses(keys, &range->min) | kiln_value_uses(keys, &range->max);
}

uint32_t kiln_value_entries(uint32_t how)
{
    if (how & VALUE_PLUS)
        return 3;
    if (how & VALUE_TIMES)
        return 2;
    return VALUE_NOT_PLAIN(how) ? 1 : 0;
}

uint32_t kiln_value_room(const float4 *keys, const struct kiln_value *value)
{
    uint32_t room = 0;
    for (uint32_t part = 0; value->count > 0 && part < VALUE_ENTRIES; part++) {
        if (!has_part(value, part))
            continue;
        const struct kiln_value one = value_part(keys, *value, part);
        room += one.count > 0 ? one.count + kiln_value_entries(one.how) : 0;
    }
    return room;
}

/* Returns whether a component of a vector goes with the first one. */
static bool goes_with(const float4 *keys, const struct kiln_value *first,
                      const struct kiln_value *other)
{
    bool whole = other->count == first->count && other->how == first->how;
    for (uint32_t k = 0; whole && k < first->count; k++)
        whole = keys[other->first + k].x == keys[first->first + k].x;
    /* what multiplies them is one value, of which each of them has a copy */
    return whole && (!(first->how & VALUE_TIMES) ||
                     memcmp(&keys[other->first - 2], &keys[first->first - 2], sizeof *keys) == 0);
}

bool kiln_value3_is_whole(const float4 *keys, const struct kiln_value3 *value)
{
    return value->x.count > 0 && goes_with(keys, &value->x, &value->y) &&
           goes_with(keys, &value->x, &value->z);
}

struct limits {
    float least, most;
};

static struct limits limits_of_part(const float4 *keys, struct kiln_value part)
{
    if (part.count == 0)
        return (struct limits){part.constant, part.constant};
    struct limits limits = {keys[part.first].y, keys[part.first].y};
    for (uint32_t i = 1; i < part.count; i++) {
        const float y = keys[part.first + i].y;
        limits.least = y < limits.least ? y : limits.least;
        limits.most = y > limits.most ? y : limits.most;
    }
    return limits;
}

static struct limits product_of(struct limits a, struct limits b)
{
    const float products[4] = {a.least * b.least, a.least * b.most, a.most * b.least,
                               a.most * b.most};
    struct limits limits = {products[0], products[0]};
    for (int i = 1; i < 4; i++) {
        limits.least = products[i] < limits.least ? products[i] : limits.least;
        limits.most = products[i] > limits.most ? products[i] : limits.most;
    }
    return limits;
}

static struct limits limits_of(const float4 *keys, const struct kiln_value *value)
{
    struct limits limits = limits_of_part(keys, *value);
    if (value->count == 0 || !VALUE_NOT_PLAIN(value->how))
        return limits;
    if (has_part(value, 1))
        limits = product_of(limits, limits_of_part(keys, value_part(keys, *value, 1)));
    if (has_part(value, 2)) {
        const struct limits added = limits_of_part(keys, value_part(keys, *value, 2));
        limits = (struct limits){limits.least + added.least, limits.most + added.most};
    }
    return (struct limits){value_limited(keys, *value, limits.least),
                           value_limited(keys, *value, limits.most)};
}

float kiln_value_most(const float4 *keys, const struct kiln_value *value)
{
    return limits_of(keys, value).most;
}

float kiln_value_least(const float4 *keys, const struct kiln_value *value)
{
    return limits_of(keys, value).least;
}
