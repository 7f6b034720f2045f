/* Adds up expected memory. Sums stay at their greatest value instead of beginning at 0 again, since
 * a budget is compared with them. */
#include "base/footprint.h"

static uint64_t sum_of(uint64_t a, uint64_t b)
{
    return a > UINT64_MAX - b ? UINT64_MAX : a + b;
}

void kiln_footprint_add(struct kiln_footprint *footprint, enum kiln_footprint_part part,
                        uint64_t count, uint64_t size)
{
    const uint64_t bytes = size > 0 && count > UINT64_MAX / size ? UINT64_MAX : count * size;
    footprint->bytes[part] = sum_of(footprint->bytes[part], bytes);
}

void kiln_footprint_pass(struct kiln_footprint *footprint, enum kiln_footprint_part part,
                         uint64_t bytes)
{
    if (bytes <= footprint->passing)
        return;
    footprint->passing = bytes;
    footprint->passing_part = part;
}

uint64_t kiln_footprint_total(const struct kiln_footprint *footprint)
{
    uint64_t total = footprint->passing;
    for (int i = 0; i < KILN_FOOTPRINT_PARTS; i++)
        total = sum_of(total, footprint->bytes[i]);
    return total;
}

enum kiln_footprint_part kiln_footprint_largest(const struct kiln_footprint *footprint)
{
    enum kiln_footprint_part largest = KILN_FOOTPRINT_PICTURE;
    uint64_t most = 0;
    for (int i = 0; i < KILN_FOOTPRINT_PARTS; i++) {
        const enum kiln_footprint_part part = (enum kiln_footprint_part)i;
        const uint64_t passing = part == footprint->passing_part ? footprint->passing : 0;
        const uint64_t bytes = sum_of(footprint->bytes[i], passing);
        if (bytes > most) {
            most = bytes;
            largest = part;
        }
    }
    return largest;
}
