/* What a JSON schema says in several places stands in it once. If this fails, the schema of scenes
 * says something else than the option tables, or is so large that editors are slow with it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kiln_program.h"
#include "option/schema_share.h"
#include "support/cmocka.h"

#define PAD                                                                                        \
    "\"pattern\": \"^[-+]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]+)?( *(m|cm|mm|km))?$|^=\""
#define LENGTH "{\"type\": [\"number\", \"string\"], \"minimum\": 0, " PAD "}"
#define WIND                                                                                       \
    "{\"description\": \"A \\\"wind\\\" {\", \"properties\": {\"a\": " LENGTH ", \"b\": " LENGTH   \
    "}}"

static void expect_shared(const char *schema, const char *expected, const char *definitions)
{
    struct kiln_text out = {0}, list = {0};
    kiln_schema_share(schema, &out, &list);
    assert_false(out.failed || list.failed);
    assert_string_equal(out.data, expected);
    assert_string_equal(list.data ? list.data : "", definitions);
    kiln_text_free(&out);
    kiln_text_free(&list);
}

/* A schema that stands in two places becomes a definition, which has the name of its first key. */
static void what_is_the_same_stands_once(void **state)
{
    (void)state;
    expect_shared("{\"properties\": {\"far\": " LENGTH ", \"near\": " LENGTH "}}",
                  "{\"properties\": {\"far\": {\"$ref\": \"#/definitions/far_1\"}, \"near\": "
                  "{\"$ref\": \"#/definitions/far_1\"}}}",
                  ",\n\"far_1\": " LENGTH);
    /* within a list, it has the name of the property around it */
    expect_shared("{\"properties\": {\"at\": {\"items\": [" LENGTH ", " LENGTH "]}}}",
                  "{\"properties\": {\"at\": {\"items\": [{\"$ref\": \"#/definitions/at_1\"}, "
                  "{\"$ref\": \"#/definitions/at_1\"}]}}}",
                  ",\n\"at_1\": " LENGTH);
    /* what stands once, or is short, stays */
    expect_shared(
        "{\"a\": " LENGTH ", \"b\": {\"type\": \"number\"}, \"c\": {\"type\": \"number\"}}",
        "{\"a\": " LENGTH ", \"b\": {\"type\": \"number\"}, \"c\": {\"type\": \"number\"}}", "");
}

/* A definition may refer to others, which stand before it. What is only in it has none of its own,
 * however many places refer to it. */
static void definitions_have_definitions(void **state)
{
    (void)state;
    expect_shared("{\"properties\": {\"wind\": " WIND ", \"gust\": {\"items\": " WIND "}}}",
                  "{\"properties\": {\"wind\": {\"$ref\": \"#/definitions/wind_1\"}, \"gust\": "
                  "{\"items\": {\"$ref\": \"#/definitions/wind_1\"}}}}",
                  ",\n\"a_2\": " LENGTH
                  ",\n\"wind_1\": {\"description\": \"A \\\"wind\\\" {\", \"properties\": {\"a\": "
                  "{\"$ref\": \"#/definitions/a_2\"}, \"b\": {\"$ref\": \"#/definitions/a_2\"}}}");
    expect_shared("{\"x\": {\"items\": " LENGTH "}, \"y\": {\"items\": " LENGTH "}}",
                  "{\"x\": {\"$ref\": \"#/definitions/1\"}, \"y\": {\"$ref\": "
                  "\"#/definitions/1\"}}",
                  ",\n\"1\": {\"items\": " LENGTH "}");
}

/* A map of properties is no schema, so it is never replaced, also where its twin is one. A property
 * may have the name `properties`. */
static void maps_are_no_schemas(void **state)
{
    (void)state;
#define MAP "{\"one\": {\"type\": \"number\"}, \"description\": {\"type\": \"string\", " PAD "}}"
    expect_shared("{\"a\": {\"properties\": " MAP "}, \"b\": {\"x\": 1, \"properties\": " MAP "}}",
                  "{\"a\": {\"properties\": " MAP "}, \"b\": {\"x\": 1, \"properties\": " MAP "}}",
                  "");
    expect_shared("{\"properties\": {\"properties\": " LENGTH ", \"b\": " LENGTH "}}",
                  "{\"properties\": {\"properties\": {\"$ref\": \"#/definitions/properties_1\"}, "
                  "\"b\": {\"$ref\": \"#/definitions/properties_1\"}}}",
                  ",\n\"properties_1\": " LENGTH);
}

/* A text that is no object is refused. */
static void other_texts_are_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {"", "{", "}", "{\"a\": {}", "{}}"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct kiln_text out = {0}, list = {0};
        kiln_schema_share(texts[i], &out, &list);
        assert_true(out.failed);
        kiln_text_free(&out);
        kiln_text_free(&list);
    }
}

/* The schema of scenes would have 1.6 MB if all stood in its places. */
static void the_schema_of_scenes_is_small(void **state)
{
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_true(kiln_scene_write_schema(out));
    assert_int_equal(fclose(out), 0);
    assert_true(size > 50000);
    if (size > 256 * 1024)
        fail_msg("the schema has %zu bytes", size);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_the_same_stands_once),
        cmocka_unit_test(definitions_have_definitions),
        cmocka_unit_test(maps_are_no_schemas),
        cmocka_unit_test(other_texts_are_refused),
        cmocka_unit_test(the_schema_of_scenes_is_small),
    };
    return cmocka_run_group_tests_name("schema_share", tests, NULL, NULL);
}
