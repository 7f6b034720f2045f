/* Declares the structs that some option types fill, and what can be asked about values. Values are
 * declared in shared/value.h. */
#ifndef KILN_OPTION_VALUES_H
#define KILN_OPTION_VALUES_H

#include <stdbool.h>
#include <stdint.h>

#include "shared/value.h"

/* The constant of a value if the file has the option's word instead. A vector whose components may
 * be negative has a NaN, which no file can have. */
#define KILN_VALUE_BY_WORD (-1.0f)

/* An integer if the file has the option's word instead. */
#define KILN_INTEGER_BY_WORD UINT32_MAX

/* A range if the file has the option's word instead: no file has one whose ends are so. */
#define KILN_RANGE_BY_WORD                                                                         \
    (struct kiln_range)                                                                            \
    {                                                                                              \
        .min = {.constant = 1.0f}, .max = {.constant = -1.0f }                                     \
    }

static inline bool kiln_range_is_by_word(const struct kiln_range *range)
{
    return range->min.count == 0 && range->max.count == 0 &&
           range->min.constant > range->max.constant;
}

/* Holds a positive fraction in its lowest terms, or 0/1 where the option has a word for it. */
struct kiln_rational {
    uint32_t num, den;
};

/* Holds an axis-aligned box, or none. */
struct kiln_bounds {
    bool enabled;
    float min[3], max[3]; /* m */
};

/* Bits of kiln_value_uses, beside those of VALUE_USES_*: the bit of a clock has its number. Each
 * particle has a noise of its own. */
#define KILN_VALUE_USES_OWN_NOISE (1u << 19)

/* What makes a value differ between the particles of a system. */
#define KILN_VALUE_OF_PARTICLES                                                                    \
    (1u << KILN_CLOCK_LIFE | 1u << KILN_CLOCK_AGE | 1u << KILN_CLOCK_SPEED |                       \
     1u << KILN_CLOCK_HEIGHT | 1u << KILN_CLOCK_DISTANCE | 1u << KILN_CLOCK_RANDOM |               \
     KILN_VALUE_USES_OWN_NOISE)

/* What makes a value differ between the frames of a clip, for a particle whose clocks stand. */
#define KILN_VALUE_OF_TIME (1u << KILN_CLOCK_TIME | 1u << KILN_CLOCK_NOISE)

/* Return a bit mask of what a value uses, in all of its parts; 0 for a constant. */
uint32_t kiln_value_uses(const float4 *keys, const struct kiln_value *value);
uint32_t kiln_value3_uses(const float4 *keys, const struct kiln_value3 *value);
uint32_t kiln_range_uses(const float4 *keys, const struct kiln_range *range);

/* Returns how many entries of the table a value takes: its keys, the entries before them, and those
 * of what multiplies it and is added to it. */
uint32_t kiln_value_room(const float4 *keys, const struct kiln_value *value);

/* Returns how many entries before its first key a value has. */
uint32_t kiln_value_entries(uint32_t how);

/* Returns whether the components of a vector vary as a whole: by the same clock, with keys at the
 * same places, and multiplied by the same value. */
bool kiln_value3_is_whole(const float4 *keys, const struct kiln_value3 *value);

/* Return a limit that a value never goes over, or below: its greatest or least key, and for values
 * of several parts the limit that follows from those of the parts. */
float kiln_value_most(const float4 *keys, const struct kiln_value *value);
float kiln_value_least(const float4 *keys, const struct kiln_value *value);

#endif
