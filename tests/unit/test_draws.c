/* Rows whose values may be random or a noise have numbers of their own, by which they draw. If this
 * fails, two rows of a scene would draw the same numbers. */
#include <string.h>

#include "scene/options.h"
#include "support/cmocka.h"

enum { MOST = 256 };

/* The rows that have each number, in systems or outside of them. */
struct numbers {
    const struct kiln_option *rows[MOST];
    uint32_t count;
};

static void take_rows(struct numbers *outside, struct numbers *inside,
                      const struct kiln_option *rows);

static void take_row(struct numbers *numbers, const struct kiln_option *row)
{
    if (!row->clocks)
        return;
    if (row->draws == 0 || row->draws >= MOST)
        fail_msg("'%s' has the number %u; allowed is 1 to %d", row->name, row->draws, MOST - 1);
    const struct kiln_option *before = numbers->rows[row->draws];
    /* rows that several shapes share, of which a scene has one */
    if (before && (strcmp(before->name, row->name) != 0 || strcmp(before->help, row->help) != 0))
        fail_msg("'%s' and '%s' both have the number %u (\"%s\", \"%s\")", before->name, row->name,
                 row->draws, before->help, row->help);
    numbers->count += before == NULL;
    numbers->rows[row->draws] = row;
}

static void take_kinds(struct numbers *outside, struct numbers *inside,
                       const struct kiln_option_kind *kinds)
{
    for (; kinds->name; kinds++)
        take_rows(outside, inside, kinds->members);
}

static void take_rows(struct numbers *outside, struct numbers *inside,
                      const struct kiln_option *rows)
{
    for (const struct kiln_option *row = rows; row->name; row++) {
        struct numbers *here = strcmp(row->name, "systems") == 0 ? inside : outside;
        take_row(here, row);
        if (row->members)
            take_rows(here, inside, row->members);
        if (row->kinds)
            take_kinds(here, inside, row->kinds);
        if (row->item && row->item->members)
            take_rows(here, inside, row->item->members);
        if (row->item && row->item->kinds)
            take_kinds(here, inside, row->item->kinds);
    }
}

static void no_number_is_used_twice(void **state)
{
    (void)state;
    static struct numbers outside, inside;
    take_rows(&outside, &inside, kiln_options_root);
    print_message("%u rows of systems, %u others\n", inside.count, outside.count);
    assert_true(inside.count > 80 && outside.count > 60);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_number_is_used_twice),
    };
    return cmocka_run_group_tests_name("draws", tests, NULL, NULL);
}
