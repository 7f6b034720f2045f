/* This file settles the keys of a look that are `auto`: what stands for the word follows from the
 * shape and the atlas, which the option tables cannot say. A printed scene has the values. */
#include "scene/look_defaults.h"

#include "option/values.h"
#include "shared/exact.h"

static struct kiln_value constant(float x)
{
    return (struct kiln_value){.constant = x};
}

bool kiln_look_is_picture(const struct kiln_look *look)
{
    bool all_files = look->columns * look->rows == 1 && look->atlas_count > 0;
    for (uint32_t i = 0; i < look->atlas_count; i++)
        all_files = all_files && look->atlas[i][0] == '/';
    return all_files && look->shape == KILN_SHAPE_BILLBOARD;
}

void kiln_look_settle(struct kiln_look *look)
{
    if (kiln_range_is_by_word(&look->rotation)) {
        look->rotation.min = constant(0.0f);
        look->rotation.max = constant(kiln_look_is_picture(look) ? 0.0f : EXACT_TWO_PI);
    }
    if (look->lit.count == 0 && look->lit.constant == KILN_VALUE_BY_WORD)
        look->lit = constant(kiln_look_is_opaque(look) ? 1.0f : 0.0f);
}
