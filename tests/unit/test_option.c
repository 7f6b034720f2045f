/* lib/option: a table of its own, which is no scene's, is read, printed, changed and explained. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "option/override.h"
#include "option/printer.h"
#include "option/reference.h"
#include "option/rows.h"
#include "option/schema.h"
#include "support/cmocka.h"
#include "support/errors.h"

enum medium { MEDIUM_PAPER, MEDIUM_GLASS };
enum mark { MARK_DOT, MARK_BAR };

struct mark_of {
    enum mark kind;
    double radius, length;
};

struct tray {
    const char *name;
    uint32_t sheets;
};

/* A plotter: something that has every type. */
struct plotter {
    uint32_t version, pens, paths, width[2];
    bool quiet, limited;
    struct kiln_rational rate;
    double pause_s, limit_s;
    enum medium medium;
    const char *title;
    struct kiln_bounds room;
    struct kiln_value speed;
    struct kiln_value3 place, ink;
    struct kiln_range pressure, tilt;
    struct tray trays[2];
    uint32_t tray_count;
    struct mark_of marks[3];
    uint32_t mark_count;
};

#define FILLS struct tray

TABLE(tray) = {
    INTEGER(NO_PART, "sheets", sheets, 0, 500, "100", "What is in it."),
    END,
};

#undef FILLS
#define FILLS struct mark_of

TABLE(dot) = {
    {ROW(NO_PART, "radius", number, radius, "1 mm", "Of the dot."), LIMITS(KILN_METRES, 0, 1)},
    END,
};

TABLE(bar) = {
    {ROW(NO_PART, "length", number, length, NULL, "Of the bar."), LIMITS(KILN_METRES, 0, 1)},
    END,
};

KINDS(mark_kinds) = {
    {.name = "dot", .value = MARK_DOT, MEMBERS(dot), .shortcut = "radius", .help = "A dot."},
    {.name = "bar", .value = MARK_BAR, MEMBERS(bar), .help = "A bar."},
    {.name = NULL},
};

ITEM_OF_KINDS(mark, mark_kinds, kind, .name = NULL);

#undef FILLS
#define FILLS struct plotter

static const char *const media[] = {
    [MEDIUM_PAPER] = "paper",
    [MEDIUM_GLASS] = "glass",
    NULL,
};

TABLE(pens) = {
    INTEGER(NO_PART, "count", pens, 1, 8, "4", "How many."),
    END,
};

TABLE(limit) = {
    {ROW(NO_PART, "time", number, limit_s, "60 s", "After so long it stops."),
     LIMITS(KILN_SECONDS, 1, 3600)},
    END,
};

TABLE(rows) = {
    INTEGER(NO_PART, "plotter", version, 1, 1, NULL, "Version of the format."),
    GROUP(NO_PART, "pens", pens, "What it draws with."),
    SWITCH(NO_PART, "limit", limit, limited, "none", "When it gives up."),
    {ROW(NO_PART, "width", pair, width, "[1, 2]", "Of thin and thick lines."),
     LIMITS(KILN_PIXELS, 1, 9)},
    {ROW(NO_PART, "paths", integer, paths, "auto", "At a time."), LIMITS(KILN_PLAIN, 0, 9),
     .special_word = "auto"},
    BOOLEAN(NO_PART, "quiet", quiet, "false", "It makes no noise."),
    {ROW(NO_PART, "rate", rational, rate, "auto", "Lines a second."), LIMITS(KILN_PLAIN, 1, 100),
     .special_word = "auto"},
    {ROW(NO_PART, "pause", number, pause_s, "0 s", "Between two lines."),
     LIMITS(KILN_SECONDS, 0, 10)},
    CHOICE(NO_PART, "medium", medium, media, "paper", "What it draws on."),
    {ROW(NO_PART, "title", text, title, "\"\"", "What it draws."), LIMITS(KILN_PLAIN, 0, 20)},
    {ROW(NO_PART, "room", bounds, room, "none", "Where the pen may be."),
     LIMITS(KILN_METRES, -9, 9), .special_word = "none"},
    VALUE(NO_PART, "speed", speed, KILN_SPEED, 0, 10, LIFE(1), "1 m/s", "Of the pen."),
    VECTOR(NO_PART, "place", place, KILN_METRES, -9, 9, TIME(2), "[0, 0, 0]", "Of the plotter."),
    COLOR(NO_PART, "ink", ink, 1, TIME(3), "0", "What it draws with."),
    RANGE(NO_PART, "pressure", pressure, KILN_PLAIN, 0, 1, TIME(4), "0.5", "Of the pen."),
    {ROW(NO_PART, "tilt", range, tilt, "auto", "Of the pen."), LIMITS(KILN_PLAIN, -2, 2),
     .special_word = "auto"},
    MAP(NO_PART, "trays", trays, tray, tray_count, "{}", "The trays by their names."),
    LIST(NO_PART, "marks", marks, mark, mark_count, "[]", "What it draws."),
    END,
};

static const char everything[] = "plotter: 1\n"
                                 "pens: {count: 8}\n"
                                 "limit: {time: 90 s}\n"
                                 "width: [3, 9]\n"
                                 "paths: 0\n"
                                 "quiet: true\n"
                                 "rate: 29.97\n"
                                 "pause: 20 ms\n"
                                 "medium: glass\n"
                                 "title: a \"line\"\n"
                                 "room: {min: [0, 0, 0], max: [1, 2, 3]}\n"
                                 "speed: {keys: {0 s: 1, 2 s: 3 m/s}}\n"
                                 "place: {keys: {0 s: [0, 1, 2], 1 s: [3, 4, 5]}}\n"
                                 "ink: 0.25\n"
                                 "pressure: [0.25, 0.5]\n"
                                 "tilt: -1.5\n"
                                 "trays: {upper: {}, lower: {sheets: 7}}\n"
                                 "marks: [dot: 5 mm, bar: {length: 10 cm}]\n";

/* One reading, and all that it leaves. */
struct reading {
    struct kiln_arena *arena, *scratch;
    struct kiln_origin origin;
    struct kiln_error error;
    struct plotter plotter;
    struct kiln_reader reader;
};

static void begin(struct reading *r)
{
    *r = (struct reading){.arena = kiln_arena_create(), .scratch = kiln_arena_create()};
    assert_true(r->arena && r->scratch);
    r->origin = (struct kiln_origin){
        .name = "p.yaml", .has_lines = true, .kind = "a plotter", .version = "plotter: 1"};
    r->reader = (struct kiln_reader){.origin = &r->origin,
                                     .arena = r->arena,
                                     .scratch = r->scratch,
                                     .error = &r->error,
                                     .target = &r->plotter};
}

static void end(struct reading *r)
{
    kiln_arena_destroy(&r->scratch);
    kiln_arena_destroy(&r->arena);
}

static void read_plotter(struct reading *r, const char *text)
{
    begin(r);
    if (!kiln_read_document(&r->reader, rows, text, strlen(text)))
        fail_msg("%s", r->error.message);
}

static char *print_plotter(const struct reading *r)
{
    struct kiln_printer printer = {.source = &r->plotter, .keys = r->reader.keys};
    kiln_print_members(&printer, rows, &r->plotter);
    assert_false(printer.text.failed);
    return printer.text.data;
}

static void a_document_fills_its_target(void **state)
{
    (void)state;
    struct reading r;
    read_plotter(&r, everything);
    const struct plotter *p = &r.plotter;
    assert_true(p->quiet && p->limited && p->limit_s == 90 && p->pause_s == 0.02);
    assert_true(p->pens == 8 && p->width[0] == 3 && p->width[1] == 9 && p->paths == 0);
    assert_true(p->rate.num == 30000 && p->rate.den == 1001);
    assert_int_equal(p->medium, MEDIUM_GLASS);
    assert_string_equal(p->title, "a \"line\"");
    assert_true(p->room.enabled && p->room.max[2] == 3.0f);
    assert_true(value_at(r.reader.keys, p->speed, value_clocks_at(1.0f, 0, 0)) == 2.0f);
    assert_true(value3_at(r.reader.keys, p->place, value_clocks_at(0.5f, 0, 0)).z == 3.5f);
    assert_true(p->ink.y.constant == 0.25f && p->pressure.max.constant == 0.5f);
    assert_true(p->tilt.min.constant == -1.5f && p->tilt.max.constant == -1.5f);
    assert_int_equal(p->tray_count, 2);
    assert_string_equal(p->trays[1].name, "lower");
    assert_true(p->trays[0].sheets == 100 && p->trays[1].sheets == 7);
    assert_int_equal(p->mark_count, 2);
    assert_true(p->marks[0].kind == MARK_DOT && p->marks[0].radius == 0.005);
    assert_true(p->marks[1].kind == MARK_BAR && p->marks[1].length == 0.1);
    end(&r);
}

static void what_is_not_said_has_its_default(void **state)
{
    (void)state;
    struct reading r;
    read_plotter(&r, "plotter: 1");
    const struct plotter *p = &r.plotter;
    assert_true(!p->quiet && !p->limited && p->pens == 4 && p->rate.num == 0);
    assert_int_equal(p->paths, KILN_INTEGER_BY_WORD);
    assert_true(kiln_range_is_by_word(&p->tilt) && !kiln_range_is_by_word(&p->pressure));
    assert_true(p->medium == MEDIUM_PAPER && !p->room.enabled && p->speed.constant == 1.0f);
    assert_string_equal(p->title, "");
    assert_null(r.reader.keys);
    end(&r);
}

static void what_is_printed_reads_as_the_same(void **state)
{
    (void)state;
    static const char *const texts[] = {"plotter: 1", everything};
    for (size_t i = 0; i < 2; i++) {
        struct reading r, again;
        read_plotter(&r, texts[i]);
        char *printed = print_plotter(&r);
        read_plotter(&again, printed);
        char *printed_again = print_plotter(&again);
        assert_string_equal(printed, printed_again);
        free(printed);
        free(printed_again);
        end(&r);
        end(&again);
    }
}

static void errors_say_where_and_in_what(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "p.yaml: the file is empty; a plotter starts with 'plotter: 1'"},
        {"[]", "p.yaml:1:1: expected a mapping of keys, found a list"},
        {"plotter: 1\n---\nplotter: 1\n",
         "p.yaml:2:1: a plotter has one document; a second one starts here"},
        {"pens: {}", "p.yaml:1:1: plotter: the key is missing and must be given"},
        {"plotter: 1\npens: {cuont: 3}",
         "p.yaml:2:8: pens.cuont: unknown key (did you mean 'count'?)"},
        {"plotter: 1\nlimit: {time: 2 d}",
         "p.yaml:2:15: limit.time: unit 'd' is wrong; allowed is s, ms, min or h"},
        {"plotter: 1\npaths: ten",
         "p.yaml:2:8: paths: expected a whole number from 0 to 9, or auto, found 'ten'"},
        {"plotter: 1\ntilt: [auto, 1]",
         "p.yaml:2:8: tilt: expected a number from -2 to 2, found 'auto'"},
        {"plotter: 1\ntitle: 123456789012345678901",
         "p.yaml:2:8: title: the text has 21 bytes; at most 20 are allowed"},
        {"plotter: 1\nmarks: [dot: 1 mm, circle: {}]",
         "p.yaml:2:20: marks.1.circle: unknown kind (there are: dot, bar)"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct reading r;
        begin(&r);
        assert_false(kiln_read_document(&r.reader, rows, cases[i].text, strlen(cases[i].text)));
        expect_error(&r.error, KILN_INVALID_INPUT, "%s", cases[i].message);
        end(&r);
    }
}

static void an_error_finds_its_place_by_a_path(void **state)
{
    (void)state;
    struct reading r;
    begin(&r);
    const struct kiln_node *root =
        kiln_node_parse(r.scratch, everything, sizeof everything - 1, &r.origin, &r.error);
    assert_non_null(root);
    assert_false(kiln_reader_error_at(&r.reader, root, "marks.1.bar.length", "too %s", "long"));
    expect_error(&r.error, KILN_INVALID_INPUT, "p.yaml:18:34: marks.1.bar.length: too long");
    kiln_reader_error_at(&r.reader, root, "marks.0.dot.color", "dull");
    expect_error(&r.error, KILN_INVALID_INPUT, "p.yaml:18:14: marks.0.dot.color: dull");
    end(&r);
}

static void keys_are_overridden_by_the_table(void **state)
{
    (void)state;
    static const char *const overrides[] = {"trays.*.sheets=9", "limit.time=5 s",
                                            "marks.1.bar.length=1", "pens.count=2"};
    struct reading r;
    begin(&r);
    struct kiln_node *root =
        kiln_node_parse(r.scratch, everything, sizeof everything - 1, &r.origin, &r.error);
    for (size_t i = 0; i < sizeof overrides / sizeof *overrides; i++)
        assert_true(kiln_override(&r.reader, rows, root, overrides[i]));
    assert_true(kiln_read_members(&r.reader, rows, root, &r.plotter));
    assert_true(r.plotter.trays[0].sheets == 9 && r.plotter.trays[1].sheets == 9);
    assert_true(r.plotter.limit_s == 5 && r.plotter.marks[1].length == 1 && r.plotter.pens == 2);
    assert_false(kiln_override(&r.reader, rows, root, "trays.uper.sheets=1"));
    expect_error(&r.error, KILN_INVALID_INPUT,
                 "--set trays.uper.sheets: there is no key 'uper' (did you mean 'upper'?)");
    end(&r);
}

/* ---- what is said of the keys --------------------------------------------------------------- */

static void count_key(void *user, const struct kiln_option_key *key)
{
    static const char *const words[][2] = {
        {"quiet", "true|false"}, {"medium", "paper|glass"}, {"rate", "auto"}, {"room", "none"},
        {"limit", "none"},       {"paths", "auto"},         {"tilt", "auto"},
    };
    unsigned *found = user;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcmp(key->path, words[i][0]) != 0)
            continue;
        assert_string_equal(key->choices, words[i][1]);
        ++*found;
    }
}

static void words_are_offered_as_a_file_has_them(void **state)
{
    (void)state;
    unsigned found = 0;
    assert_true(kiln_reference_visit(rows, count_key, &found));
    assert_int_equal(found, 7);
}

static void a_reference_and_a_schema_follow(void **state)
{
    (void)state;
    static const char *const said[] = {
        "Plots.\n",
        "\ntrays.NAME.sheets\n    What is in it.\n    a whole number from 0 to 500\n"
        "    default: 100\n",
        "\nmarks.N.dot\n    A dot.\n    dot: VALUE is short for dot: {radius: VALUE}\n",
        "\nspeed\n    Of the pen.\n    a number from 0 m/s to 10 m/s; unit m/s or cm/s\n"
        "    may vary over every clock but distance\n",
        "\"title\": \"a plotter\"",
        "\"title\": {\"description\": \"What it draws.\", "
        "\"type\": [\"string\", \"number\", \"boolean\"], \"minLength\": 0, "
        "\"maxLength\": 20}",
        "\"paths\": {\"description\": \"At a time.\", \"anyOf\": [{\"type\": \"integer\", "
        "\"minimum\": 0, \"maximum\": 9}, {\"const\": \"auto\"}]}",
        "\"required\": [\"plotter\"]",
    };
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_true(kiln_reference_write(out, "Plots.\n\n", rows));
    assert_true(kiln_schema_write(out, "a plotter", rows));
    fclose(out);
    for (size_t i = 0; i < sizeof said / sizeof *said; i++) {
        if (!strstr(text, said[i]))
            fail_msg("not said: %s", said[i]);
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_document_fills_its_target),
        cmocka_unit_test(what_is_not_said_has_its_default),
        cmocka_unit_test(what_is_printed_reads_as_the_same),
        cmocka_unit_test(errors_say_where_and_in_what),
        cmocka_unit_test(an_error_finds_its_place_by_a_path),
        cmocka_unit_test(keys_are_overridden_by_the_table),
        cmocka_unit_test(words_are_offered_as_a_file_has_them),
        cmocka_unit_test(a_reference_and_a_schema_follow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
