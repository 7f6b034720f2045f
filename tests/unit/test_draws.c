/* Rows whose values may be random or a noise have numbers of their own, by which they draw, and so
 * have the entries of a list. If this fails, two rows or two nodes of a scene would draw the same
 * numbers. */
#include <stdlib.h>
#include <string.h>

#include "scene/options.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/scenes.h"

enum { MOST = 128 }; /* the next bit of a draw is one of a list's entry (option/animated.c) */

/* The rows that have each number, in systems or outside of them. */
struct numbers {
    const struct kiln_option *rows[MOST];
    uint32_t count;
};

/* Rows that are numbered together: those of systems, of domains of gas, and all others. */
struct sets {
    struct numbers systems, gas, others;
};

static void take_rows(struct numbers *outside, struct sets *sets, const struct kiln_option *rows);

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

static void take_kinds(struct numbers *outside, struct sets *sets,
                       const struct kiln_option_kind *kinds)
{
    for (; kinds->name; kinds++)
        take_rows(outside, sets, kinds->members);
}

static void take_rows(struct numbers *outside, struct sets *sets, const struct kiln_option *rows)
{
    for (const struct kiln_option *row = rows; row->name; row++) {
        const bool is_map = row->type == &kiln_type_map;
        struct numbers *here = is_map && strcmp(row->name, "systems") == 0 ? &sets->systems
                               : is_map && strcmp(row->name, "gas") == 0   ? &sets->gas
                                                                           : outside;
        take_row(here, row);
        if (row->members)
            take_rows(here, sets, row->members);
        if (row->kinds)
            take_kinds(here, sets, row->kinds);
        if (row->item && row->item->members)
            take_rows(here, sets, row->item->members);
        if (row->item && row->item->kinds)
            take_kinds(here, sets, row->item->kinds);
        if (row->type == &kiln_type_forces)
            take_kinds(here, sets, kiln_baked_force->kinds);
    }
}

static void no_number_is_used_twice(void **state)
{
    (void)state;
    static struct sets sets;
    take_rows(&sets.others, &sets, kiln_options_root);
    print_message("%u rows of systems, %u of gas, %u others\n", sets.systems.count, sets.gas.count,
                  sets.others.count);
    assert_true(sets.systems.count > 80 && sets.gas.count > 60 && sets.others.count > 60);
}

/* Returns a scene with as many nodes as there may be, or as many spheres, each with a noise. */
static struct kiln_scene *scene_of_noises(const char *head, const char *entry, const char *tail,
                                          uint32_t count)
{
    static const char noise[] = "{noise: [[-1, -1, -1], [1, 1, 1]]}";
    const size_t size = 64 + count * (strlen(entry) + sizeof noise + 16);
    char *text = malloc(size);
    assert_non_null(text);
    size_t length = (size_t)snprintf(text, size, "kiln: 1\n%s", head);
    for (uint32_t i = 0; i < count; i++) {
        length += (size_t)snprintf(text + length, size - length, entry, i);
        length += (size_t)snprintf(text + length, size - length, "%s%s", noise, tail);
    }
    struct kiln_scene *scene = load_scene(text, NULL);
    free(text);
    return scene;
}

static void noises_of_all_nodes_and_objects_differ(void **state)
{
    (void)state;
    struct kiln_scene *nodes =
        scene_of_noises("nodes:\n", "  n%u: {position: ", "}\n", KILN_MAX_NODES);
    struct kiln_scene *objects = scene_of_noises(
        "backdrop:\n  objects:\n", "    n%u: {sphere: {center: ", "}}\n", KILN_MAX_OBJECTS);
    uint32_t same = 0;
    for (uint32_t i = 0; i < KILN_MAX_NODES; i++) {
        for (uint32_t k = 0; k < i; k++)
            same += kiln_node_frame_at(nodes, i, 0.3f, 0.3f).at[0] ==
                    kiln_node_frame_at(nodes, k, 0.3f, 0.3f).at[0];
    }
    for (uint32_t i = 0; i < KILN_MAX_OBJECTS; i++) {
        for (uint32_t k = 0; k < i; k++)
            same += kiln_object_center(objects, &objects->backdrop.objects[i], 0.3f).x ==
                    kiln_object_center(objects, &objects->backdrop.objects[k], 0.3f).x;
    }
    /* of 65,280 pairs of numbers with 24 bits, some may be the same by chance, but no 256 */
    if (same > 2)
        fail_msg("%u pairs of nodes or objects have the same noise", same);
    kiln_scene_destroy(&nodes);
    kiln_scene_destroy(&objects);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_number_is_used_twice),
        cmocka_unit_test(noises_of_all_nodes_and_objects_differ),
    };
    return cmocka_run_group_tests_name("draws", tests, NULL, NULL);
}
