/* lib/bench: statistics on given numbers, and what is written of given measurements. Nothing here
 * asks how fast anything is. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "bench/result.h"
#include "bench/schedule.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"
#include "support/pictures.h"

static void expect_spread(struct kiln_spread spread, uint32_t count, const double expected[5])
{
    assert_int_equal(spread.count, count);
    const double found[] = {spread.least, spread.first_quartile, spread.median,
                            spread.third_quartile, spread.most};
    for (int i = 0; i < 5; i++)
        assert_true(fabs(found[i] - expected[i]) < 1e-12);
}

static void quartiles_of_numbers(void **state)
{
    (void)state;
    static const double odd[] = {5, 1, 4, 2, 3}, even[] = {4, 1, 2, 3}, one[] = {7};
    expect_spread(kiln_spread_of(odd, 5), 5, (double[]){1, 2, 3, 4, 5});
    expect_spread(kiln_spread_of(even, 4), 4, (double[]){1, 1.75, 2.5, 3.25, 4});
    expect_spread(kiln_spread_of(one, 1), 1, (double[]){7, 7, 7, 7, 7});
    expect_spread(kiln_spread_of(one, 0), 0, (double[]){0, 0, 0, 0, 0});
    /* A disturbed turn moves neither the median nor the quartiles. */
    static const double disturbed[] = {5, 5, 5, 5, 1000};
    expect_spread(kiln_spread_of(disturbed, 5), 5, (double[]){5, 5, 5, 5, 1000});
    double many[KILN_BENCH_MAX_REPETITIONS + 8];
    for (size_t i = 0; i < KILN_BENCH_MAX_REPETITIONS + 8; i++)
        many[i] = (double)i;
    assert_int_equal(kiln_spread_of(many, KILN_BENCH_MAX_REPETITIONS + 8).count,
                     KILN_BENCH_MAX_REPETITIONS);
}

/* Both slow down together: their ratio stays, where that of the medians would not. */
static void ratios_are_of_neighbours(void **state)
{
    (void)state;
    static const double slow[] = {10, 20, 40, 80, 60}, fast[] = {5, 10, 20, 40, 20};
    expect_spread(kiln_spread_of_ratios(slow, fast, 5), 5, (double[]){2, 2, 2, 2, 3});
    static const double some[] = {1, 0, 4};
    expect_spread(kiln_spread_of_ratios(slow, some, 3), 2, (double[]){10, 10, 10, 10, 10});
    assert_int_equal(kiln_spread_of_ratios(slow, (double[]){0, 0}, 2).count, 0);
}

static void growth_is_a_power(void **state)
{
    (void)state;
    static const double x[] = {1, 2, 4, 8}, linear[] = {3, 6, 12, 24}, square[] = {1, 4, 16, 64};
    static const double flat[] = {5, 5, 5, 5}, holes[] = {1, 0, 16, 64};
    assert_true(fabs(kiln_growth(x, linear, 4) - 1) < 1e-12);
    assert_true(fabs(kiln_growth(x, square, 4) - 2) < 1e-12);
    assert_true(fabs(kiln_growth(x, flat, 4)) < 1e-12);
    assert_true(fabs(kiln_growth(x, holes, 4) - 2) < 1e-12);
    assert_true(isnan(kiln_growth(x, linear, 1)));
    assert_true(isnan(kiln_growth((double[]){2, 2}, linear, 2)));
}

static void numbers_have_four_digits(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0, "0.0000"},      {0.01234, "0.0123"}, {1.23456, "1.235"},
                 {12.3456, "12.35"}, {123.456, "123.5"},  {123456.7, "123457"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[32];
        kiln_bench_number(text, cases[i].value);
        assert_string_equal(text, cases[i].text);
    }
}

static void expect_schedule(const double *tasks_s, size_t count, uint32_t workers,
                            double expected_s)
{
    assert_true(fabs(kiln_schedule_s(tasks_s, count, workers) - expected_s) < 1e-12);
}

/* One worker takes the sum, as many as there are tasks take as long as the longest. In between, the
 * order counts: a long task that comes last is waited for. */
static void tasks_go_to_the_worker_that_is_free_first(void **state)
{
    (void)state;
    static const double rising[] = {1, 2, 3, 4}, falling[] = {4, 3, 2, 1}, one[] = {7};
    expect_schedule(rising, 4, 1, 10);
    expect_schedule(rising, 4, 2, 6);  /* 1 + 3, 2 + 4 */
    expect_schedule(falling, 4, 2, 5); /* 4 + 1, 3 + 2 */
    expect_schedule(rising, 4, 3, 5);  /* 1 + 4, 2, 3 */
    expect_schedule(rising, 4, 4, 4);
    expect_schedule(rising, 4, KILN_MAX_WORKERS, 4);
    expect_schedule(one, 1, 2, 7);
    expect_schedule(one, 0, 2, 0);
    double many[64], sum = 0;
    for (size_t i = 0; i < 64; i++)
        sum += many[i] = 1.0 + (double)(i * 37 % 64) / 64;
    expect_schedule(many, 64, 1, sum);
    expect_schedule(many, 64, 64, 1 + 63.0 / 64);
    /* Never shorter than the work for each, nor longer than that and the longest task. */
    for (uint32_t workers = 2; workers < 64; workers++) {
        const double found = kiln_schedule_s(many, 64, workers);
        assert_true(found >= sum / workers && found < sum / workers + 1 + 63.0 / 64);
    }
}

/* ---- Results --------------------------------------------------------------------------------- */

static void add_row(struct kiln_bench *bench, double x, const char *technique, const double *values,
                    size_t count, const double *reference, const char *source)
{
    struct kiln_error error = {0};
    struct kiln_bench_row row = {.x = x,
                                 .measure = "sort",
                                 .technique = technique,
                                 .spread = kiln_spread_of(values, count),
                                 .source = source};
    if (reference)
        row.faster = kiln_spread_of_ratios(reference, values, count);
    assert_true(kiln_bench_add_row(bench, &row, &error));
}

/* Two techniques at two sizes, and a published value with a name that every format must quote. */
static struct kiln_bench *make_bench(void)
{
    static const double slow[] = {2, 4, 6}, fast[] = {1, 2, 3};
    struct kiln_error error = {0};
    struct kiln_bench *bench = kiln_bench_create(&error);
    assert_non_null(bench);
    snprintf(bench->device.name, sizeof bench->device.name, "Device \"X\"");
    snprintf(bench->processor, sizeof bench->processor, "Processor");
    bench->cores = 2;
    bench->repetitions = 3;
    bench->seconds = 1.5;
    const struct kiln_bench_part part = {.name = "sorts",
                                         .suite = "suite",
                                         .title = "Sorts, it's said",
                                         .sweep = "particles",
                                         .unit = "ms",
                                         .reference = "sort=slow",
                                         .plotted = true};
    assert_non_null(kiln_bench_add_part(bench, &part, &error));
    for (double x = 1000; x < 3000; x += 1000) {
        add_row(bench, x, "sort=slow", slow, 3, NULL, NULL);
        add_row(bench, x, "sort=fast", fast, 3, slow, NULL);
    }
    add_row(bench, 1000, "old, \"packed\"", (double[]){148}, 1, NULL, "A paper");
    assert_true(kiln_bench_add_note(bench, &error, "A note of %d.", 1));
    assert_true(kiln_bench_add_note(bench, &error, "A note of %d.", 1));
    return bench;
}

static void expect_written(const struct kiln_bench *bench, enum kiln_bench_format format,
                           const char *expected)
{
    char *text = NULL;
    size_t size = 0;
    struct kiln_error error = {0};
    FILE *out = open_memstream(&text, &size);
    assert_true(kiln_bench_write(bench, format, out, &error));
    assert_int_equal(fclose(out), 0);
    assert_string_equal(text, expected);
    free(text);
}

static void text_has_a_row_a_measurement(void **state)
{
    (void)state;
    struct kiln_bench *bench = make_bench();
    expect_written(
        bench, KILN_BENCH_TEXT,
        "kiln " KILN_VERSION " on Device \"X\", Processor, 2 cores; at most 3 turns; 2 s\n"
        "\nsorts: Sorts, it's said\n"
        "      particles  measure  technique              ms  quartiles              turns  "
        "times as fast as sort=slow\n"
        "           1000  sort     sort=slow           4.000      3.000 - 5.000          3\n"
        "           1000  sort     sort=fast           2.000      1.500 - 2.500          3  "
        "2.00 (2.00 - 2.00)\n"
        "           2000  sort     sort=slow           4.000      3.000 - 5.000          3\n"
        "           2000  sort     sort=fast           2.000      1.500 - 2.500          3  "
        "2.00 (2.00 - 2.00)\n"
        "           1000  sort     old, \"packed\"       148.0  published: A paper\n"
        "  A note of 1.\n");
    kiln_bench_destroy(&bench);
}

static void markdown_puts_medians_side_by_side(void **state)
{
    (void)state;
    struct kiln_bench *bench = make_bench();
    expect_written(
        bench, KILN_BENCH_MARKDOWN,
        "kiln " KILN_VERSION " on Device \"X\", Processor, 2 cores; at most 3 turns; 2 s\n"
        "\n### sorts\n\nSorts, it's said (ms).\n\n"
        "| particles | sort=slow | sort=fast | old, \"packed\" |\n"
        "|---|---|---|---|\n"
        "| 1000 | 4.000 | 2.000 | 148.0 |\n"
        "| 2000 | 4.000 | 2.000 |  |\n"
        "\n| particles | measure | technique | times as fast as sort=slow | quartiles |\n"
        "|---|---|---|---|---|\n"
        "| 1000 | sort | sort=fast | 2.00 | 2.00 to 2.00 |\n"
        "| 2000 | sort | sort=fast | 2.00 | 2.00 to 2.00 |\n"
        "\nA note of 1.\n");
    kiln_bench_destroy(&bench);
}

static void csv_quotes_what_must_be(void **state)
{
    (void)state;
    struct kiln_bench *bench = make_bench();
    expect_written(
        bench, KILN_BENCH_CSV,
        "suite,part,sweep,x,measure,technique,unit,turns,median,first_quartile,third_quartile,"
        "least,most,reference,times_as_fast,times_as_fast_first_quartile,"
        "times_as_fast_third_quartile,published\n"
        "suite,sorts,particles,1000,sort,sort=slow,ms,3,4,3,5,2,6,sort=slow,,,,\n"
        "suite,sorts,particles,1000,sort,sort=fast,ms,3,2,1.5,2.5,1,3,sort=slow,2,2,2,\n"
        "suite,sorts,particles,2000,sort,sort=slow,ms,3,4,3,5,2,6,sort=slow,,,,\n"
        "suite,sorts,particles,2000,sort,sort=fast,ms,3,2,1.5,2.5,1,3,sort=slow,2,2,2,\n"
        "suite,sorts,particles,1000,sort,\"old, \"\"packed\"\"\",ms,0,148,148,148,148,148,"
        "sort=slow,,,,A paper\n");
    kiln_bench_destroy(&bench);
}

static void json_has_every_number(void **state)
{
    (void)state;
    struct kiln_bench *bench = make_bench();
    bench->parts[0].row_count = 2;
    expect_written(
        bench, KILN_BENCH_JSON,
        "{\"version\": \"" KILN_VERSION "\",\n"
        " \"device\": {\"name\": \"Device \\\"X\\\"\", \"software\": false, \"gl_version\": "
        "\"\"},\n"
        " \"processor\": \"Processor\", \"cores\": 2,\n"
        " \"turns\": 3, \"quick\": false, \"total_s\": 1.5,\n"
        " \"parts\": [\n"
        "  {\"name\": \"sorts\", \"suite\": \"suite\",\n"
        "   \"title\": \"Sorts, it's said\",\n"
        "   \"sweep\": \"particles\", \"unit\": \"ms\", \"reference\": \"sort=slow\",\n"
        "   \"notes\": [\"A note of 1.\"],\n"
        "   \"rows\": [\n"
        "    {\"x\": 1000, \"measure\": \"sort\", \"technique\": \"sort=slow\", \"value\": "
        "{\"turns\": 3, \"median\": 4, \"first_quartile\": 3, \"third_quartile\": 5, \"least\": 2, "
        "\"most\": 6}, \"times_as_fast\": null, \"published\": null},\n"
        "    {\"x\": 1000, \"measure\": \"sort\", \"technique\": \"sort=fast\", \"value\": "
        "{\"turns\": 3, \"median\": 2, \"first_quartile\": 1.5, \"third_quartile\": 2.5, "
        "\"least\": 1, \"most\": 3}, \"times_as_fast\": {\"turns\": 3, \"median\": 2, "
        "\"first_quartile\": 2, \"third_quartile\": 2, \"least\": 2, \"most\": 2}, \"published\": "
        "null}]}]}\n");
    kiln_bench_destroy(&bench);
}

static void curves_are_blocks_of_points(void **state)
{
    (void)state;
    struct kiln_bench *bench = make_bench();
    add_row(bench, 4000, "sort=none", (double[]){0}, 1, NULL, NULL); /* has no logarithm, */
    add_row(bench, 0, "sort=none", (double[]){1}, 1, NULL, NULL);    /* neither has this */
    add_row(bench, 4000, "sort=slow", (double[]){0}, 1, NULL, NULL);
    add_row(bench, 2000, "sort=last", (double[]){3}, 1, NULL, NULL);
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    kiln_bench_write_curves(&bench->parts[0], out);
    kiln_bench_write_script(&bench->parts[0], out);
    assert_int_equal(fclose(out), 0);
    assert_string_equal(
        text, "# sorts: particles, median, first and third quartile (ms)\n"
              "# sort=slow\n1000 4 3 5\n2000 4 3 5\n\n\n"
              "# sort=fast\n1000 2 1.5 2.5\n2000 2 1.5 2.5\n\n\n"
              "# old, \"packed\"\n1000 148 148 148\n\n\n"
              "# sort=last\n2000 3 3 3\n"
              "# gnuplot sorts.gp >sorts.svg\n"
              "set terminal svg size 900,540 noenhanced font 'sans,13' background '#ffffff'\n"
              "set title 'Sorts, it''s said'\n"
              "set logscale xy\nset grid\nset key below Left reverse height 1\n"
              "set xlabel 'particles'\nset ylabel 'ms'\n"
              "set xrange [769.2307692307692:2600]\nset xtics (1000, 2000)\n"
              "plot \\\n"
              "    'sorts.dat' index 0 using 1:2:3:4 with yerrorlines title 'sort=slow', \\\n"
              "    'sorts.dat' index 1 using 1:2:3:4 with yerrorlines title 'sort=fast', \\\n"
              "    'sorts.dat' index 2 using 1:2:3:4 with yerrorlines title 'old, \"packed\"', \\\n"
              "    'sorts.dat' index 3 using 1:2:3:4 with yerrorlines title 'sort=last'\n");
    free(text);
    kiln_bench_destroy(&bench);
}

/* Published values alone are no measurement, and a part without points has no curves. */
static void nothing_measured_is_known(void **state)
{
    (void)state;
    struct kiln_bench *bench = make_bench();
    assert_int_equal(kiln_bench_measured(bench), 4);
    assert_true(kiln_bench_has_points(&bench->parts[0]));
    struct kiln_bench_part *part = &bench->parts[0];
    part->rows[0] = part->rows[part->row_count - 1];
    part->row_count = 1;
    assert_int_equal(kiln_bench_measured(bench), 0);
    part->rows[0].x = 0.0;
    assert_false(kiln_bench_has_points(part));
    kiln_bench_destroy(&bench);
}

/* Without gnuplot everything else is written, and a picture of older data goes. */
static void saving_does_without_gnuplot(void **state)
{
    (void)state;
    struct kiln_bench *bench = make_bench();
    struct kiln_error error = {0};
    char unplotted[KILN_MESSAGE_SIZE];
    const char *was = getenv("PATH");
    char *path = strdup(was ? was : "");
    test_write_file("out/sorts.svg", "old");
    setenv("PATH", "/nowhere", 1);
    assert_true(kiln_bench_save(bench, "out", unplotted, &error));
    setenv("PATH", path, 1);
    free(path);
    expect_message(unplotted, "gnuplot is missing, so no *.svg is drawn: install gnuplot-nox, or "
                              "draw *.dat with *.gp elsewhere");
    assert_int_equal(test_count_files("out"), 6);
    char *csv = test_read_file("out/bench.csv");
    expect_written(bench, KILN_BENCH_CSV, csv);
    free(csv);
    free(test_read_file("out/sorts.gp"));
    kiln_bench_destroy(&bench);
}

static void saving_says_where_it_cannot(void **state)
{
    (void)state;
    struct kiln_bench *bench = make_bench();
    struct kiln_error error = {0};
    char unplotted[KILN_MESSAGE_SIZE];
    test_write_file("file", "in the way");
    assert_false(kiln_bench_prepare("file", &error));
    expect_error(&error, KILN_USAGE,
                 "file: the path is not a folder, but file/bench.txt needs a folder here");
    assert_true(kiln_bench_prepare("new/folder", &error));
    assert_int_equal(test_count_files("new/folder"), 0);
    assert_false(kiln_bench_save(bench, "file", unplotted, &error));
    expect_error(&error, KILN_USAGE,
                 "file: the path is not a folder, but file/bench.txt needs a folder here");
    kiln_bench_destroy(&bench);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(quartiles_of_numbers),
        cmocka_unit_test(ratios_are_of_neighbours),
        cmocka_unit_test(growth_is_a_power),
        cmocka_unit_test(numbers_have_four_digits),
        cmocka_unit_test(tasks_go_to_the_worker_that_is_free_first),
        cmocka_unit_test(text_has_a_row_a_measurement),
        cmocka_unit_test(markdown_puts_medians_side_by_side),
        cmocka_unit_test(csv_quotes_what_must_be),
        cmocka_unit_test(json_has_every_number),
        cmocka_unit_test(curves_are_blocks_of_points),
        cmocka_unit_test(nothing_measured_is_known),
        cmocka_unit_test_setup_teardown(saving_does_without_gnuplot, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(saving_says_where_it_cannot, test_enter_folder,
                                        test_leave_folder),
    };
    return cmocka_run_group_tests_name("bench", tests, NULL, NULL);
}
