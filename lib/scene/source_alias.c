/* This file fills an alias table as Vose (1991) does: cells that have less than their turn is worth
 * are filled up by cells that have more. Sums are doubles, so each share is exact to the rounding
 * of its float. */
#include "scene/source_alias.h"

#include <assert.h>
#include <stdlib.h>

static_assert(KILN_ALIAS_BYTES == 2 * sizeof(double) + sizeof(uint32_t) + sizeof(struct kiln_alias),
              "weights, what is left of them, the list and the table");

bool kiln_alias_fill(const double *weights, uint32_t count, struct kiln_alias *table)
{
    double *left = malloc(count * sizeof *left), sum = 0;
    /* The list has cells with less than the mean from its front, and the others from its back. */
    uint32_t *list = malloc(count * sizeof *list), poor = 0, rich = count, heaviest = 0;
    if (!left || !list) {
        free(left);
        free(list);
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        sum += weights[i];
        heaviest = weights[i] > weights[heaviest] ? i : heaviest;
    }
    for (uint32_t i = 0; i < count; i++) {
        left[i] = weights[i] / sum * count;
        table[i] = (struct kiln_alias){.share = 1.0f, .other = i};
        list[left[i] < 1 ? poor++ : --rich] = i;
    }
    while (poor > 0 && rich < count) {
        const uint32_t from = list[rich], to = list[--poor];
        table[to] = (struct kiln_alias){.share = (float)left[to], .other = from};
        left[from] -= 1 - left[to];
        if (left[from] < 1) {
            rich++;
            list[poor++] = from;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t other = table[i].other;
        if (!(weights[i] > 0)) /* whatever the rounding of the sums */
            table[i] = (struct kiln_alias){.share = 0.0f, .other = other == i ? heaviest : other};
    }
    free(left);
    free(list);
    return true;
}
