/* This file finds partners exactly: bodies are sorted into cells, and each looks at all others in
 * the cells around it. */
#include "sim/crowd/contact_row.h"
#include "sim/crowd/interact_crowd.h"

static bool sort(struct kiln_interact_crowd *crowd, struct kiln_interact *interact,
                 struct kiln_error *error)
{
    (void)interact;
    (void)error;
    kiln_interact_into_cells(crowd);
    return true;
}

static void find_partners(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_interact_crowd *crowd = context;
    uint32_t met = 0;
    for (size_t i = begin; i < end; i++) {
        if (crowd_sits_out(crowd, i))
            continue;
        const uint32_t partner = contact_find(&crowd->view, (uint32_t)i);
        crowd_note(crowd, i, partner);
        met += partner != INTERACT_NOBODY;
    }
    atomic_fetch_add(&crowd->met, met);
}

enum { COUNT, FIND };

static bool sort_gl(struct kiln_interact *interact, const struct kiln_interact_params *params,
                    GLuint *find, struct kiln_error *error)
{
    (void)error;
    const GLuint *programs = interact->contact_programs[KILN_CONTACT_EXACT];
    kiln_interact_gl_into_cells(interact, params, programs[COUNT]);
    *find = programs[FIND];
    return true;
}

const struct kiln_contact_row kiln_contact_exact_row = {
    .looks_ahead = true,
    .sort = sort,
    .find = find_partners,
    .files = {[COUNT] = {"sim/crowd/interact_count.comp", "", false},
              [FIND] = {"sim/crowd/interact_find.comp", "", .counts_around = true}},
    .sort_gl = sort_gl,
};
