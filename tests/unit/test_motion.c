/* The motion hash: every row of a scene's options is changed, in fixtures where what moves is seen
 * to move. Either the state after 120 steps stays the same, or the motion hash changes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "option/animated.h"
#include "option/node.h"
#include "scene/motion.h"
#include "scene/options.h"
#include "support/cmocka.h"
#include "support/simulation.h"

#define TESTS KILN_SOURCE_DIR "/tests"

enum { MAX_ROWS = 768, MAX_LINE = 1024, STEPS = 120, GAS_STEPS = 24 };

/* A row of the tables, and what changing it was seen to do. */
struct seen {
    const struct kiln_option *row;
    char path[160];
    bool changed;       /* there is an override of it */
    bool changed_state; /* one that changes the state */
};

struct rows {
    struct seen seen[MAX_ROWS];
    size_t count;
};

/* ---- all rows -------------------------------------------------------------------------------- */

static struct seen *find(struct rows *rows, const struct kiln_option *row)
{
    for (size_t i = 0; i < rows->count; i++) {
        if (rows->seen[i].row == row)
            return &rows->seen[i];
    }
    return NULL;
}

static void list_rows(struct rows *rows, const char *prefix, const struct kiln_option *table)
{
    for (const struct kiln_option *row = table; row->name; row++) {
        if (row->is_unprinted)
            continue; /* other rows say what it means */
        if (find(rows, row))
            continue; /* a table that two kinds share */
        char path[160];
        snprintf(path, sizeof path, "%s%s%s", prefix, *prefix ? "." : "", row->name);
        if (!row->parts)
            fail_msg("%s: the row says to which parts of a scene it belongs", path);
        assert_true(rows->count < MAX_ROWS);
        struct seen *seen = &rows->seen[rows->count++];
        seen->row = row;
        memcpy(seen->path, path, sizeof path);
        const struct kiln_option *item = row->item ? row->item : row;
        if (item->members)
            list_rows(rows, path, item->members);
        for (const struct kiln_option_kind *kind = item->kinds; kind && kind->name; kind++) {
            char inside[160];
            snprintf(inside, sizeof inside, "%.100s.%.40s", path, kind->name);
            list_rows(rows, inside, kind->members);
        }
    }
}

/* ---- the rows that an override changes ------------------------------------------------------- */

/* Rows that are named in an override, in their order. */
struct named {
    const struct kiln_option *rows[64];
    size_t count;
};

static void name_in_table(struct named *named, const struct kiln_option *table,
                          const struct kiln_node *map);

static const struct kiln_option_kind *find_kind(const struct kiln_option_kind *kinds,
                                                const char *name, const struct kiln_node *value)
{
    const struct kiln_node *field =
        value && value->kind == KILN_NODE_MAP ? kiln_node_entry(value, "field") : NULL;
    for (; kinds->name; kinds++) {
        if (value && kiln_option_variant_by_member(kinds, name, value))
            return kiln_option_variant_by_member(kinds, name, value);
        if (strcmp(kinds->name, name) == 0 &&
            (!field || !kinds->variant || kiln_node_is(field, kinds->variant)))
            return kinds;
    }
    return NULL;
}

static void name_in_kind(struct named *named, const struct kiln_option_kind *kind,
                         const struct kiln_node *value)
{
    if (value->kind == KILN_NODE_MAP && !kiln_node_is_animated(value))
        name_in_table(named, kind->members, value);
    else if (kind->shortcut)
        named->rows[named->count++] = kiln_option_find(kind->members, kind->shortcut);
}

/* The rows inside of a value that stands for a row. */
static void name_inside(struct named *named, const struct kiln_option *row,
                        const struct kiln_node *value)
{
    const struct kiln_option *item = row->item ? row->item : row;
    if (value->kind == KILN_NODE_LIST && row->item) {
        for (const struct kiln_node *entry = value->first; entry; entry = entry->next)
            name_inside(named, item, entry);
        return;
    }
    if (value->kind != KILN_NODE_MAP)
        return;
    if (item->kinds) {
        const struct kiln_node *body = value->first;
        const struct kiln_option_kind *kind =
            body ? find_kind(item->kinds, body->key->text, body) : NULL;
        if (kind)
            name_in_kind(named, kind, body);
    } else if (row->type == &kiln_type_map) {
        for (const struct kiln_node *entry = value->first; entry; entry = entry->next)
            name_in_table(named, item->members, entry);
    } else if (item->members) {
        name_in_table(named, item->members, value);
    }
}

static void name_in_table(struct named *named, const struct kiln_option *table,
                          const struct kiln_node *map)
{
    for (const struct kiln_node *entry = map->first; entry; entry = entry->next) {
        const struct kiln_option *row = kiln_option_find(table, entry->key->text);
        if (!row)
            continue;
        named->rows[named->count++] = row;
        name_inside(named, row, entry);
    }
}

/* "systems.smoke.emit.from={box: {size: 1}}": the rows from, and size of a box. */
static void name_rows(struct named *named, const char *override)
{
    static const struct kiln_origin origin = {.name = "override"};
    char path[256];
    const char *equals = strchr(override, '=');
    snprintf(path, sizeof path, "%.*s", (int)(equals - override), override);
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_error error = {0};
    char value_text[MAX_LINE];
    snprintf(value_text, sizeof value_text, "%s", equals + 1);
    const struct kiln_node *value =
        kiln_node_parse(arena, value_text, strlen(value_text), &origin, &error);
    if (!value)
        fail_msg("%s: %s", override, error.message);
    const struct kiln_option *table = kiln_options_root, *row = NULL;
    const struct kiln_option_kind *kind = NULL;
    char *rest = path;
    for (char *word; (word = strsep(&rest, "."));) {
        if (row && row->type == &kiln_type_map) { /* the name of an entry */
            table = row->members;
            row = NULL;
            continue;
        }
        if (row && row->item) { /* the number of an entry */
            row = row->item;
            continue;
        }
        if (row && row->kinds) {
            kind = find_kind(row->kinds, word, value);
            if (!kind)
                fail_msg("%s: no kind '%s'", override, word);
            table = kind->members;
            row = NULL;
            continue;
        }
        row = kiln_option_find(row && row->members ? row->members : table, word);
        kind = NULL;
        if (!row)
            fail_msg("%s: no row '%s'", override, word);
    }
    if (kind && !row) {
        name_in_kind(named, kind, value);
    } else if (row) {
        if (row->name)
            named->rows[named->count++] = row;
        name_inside(named, row, value);
    } else if (table && value->kind == KILN_NODE_MAP) {
        name_in_table(named, table, value); /* an entry of a map of names */
    }
    kiln_arena_destroy(&arena);
}

/* ---- runs ------------------------------------------------------------------------------------ */

/* What a fixture comes to with some overrides. */
struct outcome {
    char motion[65];
    struct kiln_state_hash state;
};

static struct outcome run(const char *file, const char *const *overrides, size_t count)
{
    const struct kiln_scene_params params = {.size = sizeof params,
                                             .overrides = overrides,
                                             .override_count = count,
                                             .asset_root =
                                                 strstr(file, "/motion/") ? KILN_SOURCE_DIR : NULL};
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_load(file, &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    struct outcome outcome;
    if (!kiln_scene_part_hash(scene, KILN_PART_MOTION, outcome.motion, &error))
        fail_msg("%s", error.message);
    struct simulation simulation;
    simulation_start_with(&simulation, scene, NULL, KILN_SIMULATE_CPU, 1);
    simulation_run(&simulation, scene->gas_count > 0 ? GAS_STEPS : STEPS);
    uint64_t alive;
    outcome.state = simulation_hash(&simulation, &alive);
    simulation_end(&simulation);
    kiln_scene_destroy(&scene);
    return outcome;
}

/* Marks the rows that `override` changes and `given` does not name. */
static void mark(struct rows *rows, const char *override, const char *given, bool state)
{
    struct named named = {.count = 0}, before = {.count = 0};
    name_rows(&named, override);
    if (given)
        name_rows(&before, given);
    for (size_t i = 0; i < named.count; i++) {
        struct seen *seen = find(rows, named.rows[i]);
        bool is_last = i + 1 == named.count;
        for (size_t k = 0; k < before.count && !is_last; k++) {
            if (before.rows[k] == named.rows[i])
                seen = NULL;
        }
        if (!seen)
            continue;
        seen->changed = true;
        seen->changed_state |= state;
    }
}

/* What comes before a change; several follow each other that have the same before them. */
struct before {
    char given[MAX_LINE]; /* "": the fixture as it is */
    struct outcome outcome;
};

/* Returns whether an override changes the state. */
static bool try_override(struct rows *rows, const char *file, const char *override,
                         const char *given, struct before *last, const struct outcome *base)
{
    const char *const both[] = {given, override};
    if (given && strcmp(given, last->given) != 0) {
        snprintf(last->given, sizeof last->given, "%s", given);
        last->outcome = run(file, both, 1);
    }
    const struct outcome before = given ? last->outcome : *base;
    const struct outcome after = given ? run(file, both, 2) : run(file, both + 1, 1);
    const bool state = memcmp(&before.state, &after.state, sizeof before.state) != 0;
    const bool motion = strcmp(before.motion, after.motion) != 0;
    if (state && !motion)
        fail_msg("%s: '%s' changes the state, but not the motion hash", file, override);
    mark(rows, override, given, state);
    return state;
}

/* A scene, and a list of overrides of it. */
struct fixture {
    const char *scene, *list;
    enum {
        ANY,
        MOVES, /* each of them changes the state: no option is without effect */
    } effect;
};

static void try_fixture(struct rows *rows, const struct fixture *fixture)
{
    char file[256], list[256], line[MAX_LINE];
    snprintf(file, sizeof file, TESTS "/%s.yaml", fixture->scene);
    snprintf(list, sizeof list, TESTS "/%s.txt", fixture->list);
    FILE *lines = fopen(list, "r");
    assert_non_null(lines);
    const struct outcome base = run(file, NULL, 0);
    struct before before = {.given = ""};
    while (fgets(line, sizeof line, lines)) {
        line[strcspn(line, "\n")] = '\0';
        char *given = strstr(line, " given ");
        if (*line == '\0' || *line == '#')
            continue;
        if (given)
            *given = '\0';
        const bool moved = try_override(rows, file, line, given ? given + strlen(" given ") : NULL,
                                        &before, &base);
        if (fixture->effect == MOVES && !moved)
            fail_msg("%s: '%s' changes no state", list, line);
    }
    fclose(lines);
}

static void every_row_tells_the_truth(void **state)
{
    (void)state;
    struct rows *rows = calloc(1, sizeof *rows);
    assert_non_null(rows);
    list_rows(rows, "", kiln_options_root);
    static const struct fixture fixtures[] = {
        {"mutation/effects", "mutation/effects", ANY},
        {"mutation/effects", "motion/effects", MOVES},
        {"mutation/shapes", "mutation/shapes", ANY},
        {"mutation/shapes", "motion/shapes", MOVES},
        {"mutation/turned", "mutation/turned", ANY},
        {"mutation/turned", "motion/turned", MOVES},
        {"mutation/nodes", "mutation/nodes", ANY},
        {"mutation/nodes", "motion/nodes", MOVES},
        {"mutation/gas", "mutation/gas", ANY},
        {"mutation/gas", "motion/gas", MOVES},
        {"motion/surfaces", "motion/surfaces", ANY},
        {"motion/rest", "motion/rest", ANY},
    };
    for (size_t i = 0; i < sizeof fixtures / sizeof *fixtures; i++)
        try_fixture(rows, &fixtures[i]);
    unsigned missing = 0;
    for (size_t i = 0; i < rows->count; i++) {
        const struct seen *seen = &rows->seen[i];
        const bool is_group = seen->row->type == &kiln_type_group;
        const bool one_value = seen->row->min == 1 && seen->row->max == 1 && !seen->row->fallback;
        if (is_group || one_value) /* nothing about it can be changed */
            continue;
        /* A row of the view may change the state by way of another row: rate: auto. */
        const bool looks = seen->row->parts == kiln_row_look ||
                           seen->row->parts == kiln_row_if_formed ||
                           seen->row->parts == kiln_row_if_ribbon ||
                           seen->row->parts == kiln_row_if_light_is_attached;
        const bool moves = !looks && seen->row->parts != kiln_row_view &&
                           seen->row->parts != kiln_row_if_camera_is_attached;
        if (!seen->changed)
            fprintf(stderr, "%s: no fixture changes it\n", seen->path);
        else if (looks && seen->changed_state)
            fprintf(stderr, "%s: is said to be a look, but changes the state\n", seen->path);
        else if (moves && !seen->changed_state)
            fprintf(stderr, "%s: no fixture shows that it changes the state\n", seen->path);
        missing +=
            !seen->changed || (looks && seen->changed_state) || (moves && !seen->changed_state);
    }
    printf("%zu rows\n", rows->count);
    free(rows);
    assert_int_equal(missing, 0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_tells_the_truth),
    };
    return cmocka_run_group_tests_name("motion", tests, NULL, NULL);
}
