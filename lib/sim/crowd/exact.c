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

static uint32_t find_partner(const struct kiln_interact_crowd *crowd, uint32_t self)
{
    return contact_find(&crowd->view, self);
}

static void find_partners(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    crowd_find_partners(context, begin, end, find_partner);
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
    .uses_cells = true,
    .sort = sort,
    .find = find_partners,
    .files = {[COUNT] = {"sim/crowd/interact_count.comp", "", false},
              [FIND] = {"sim/crowd/interact_find.comp", "", .counts_around = true}},
    .sort_gl = sort_gl,
};
