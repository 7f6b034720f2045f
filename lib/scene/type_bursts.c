/* Reads, prints and describes the option type of bursts. A burst is the birth of many particles at
 * one time. The option maps times to numbers of particles: {1 s: 100, 2.5 s: 40}. The times
 * increase. Or it is a list, whose bursts may be repeated, late, and of a number that is drawn:
 * [{at: 1 s, count: [20, 30], every: 0.5 s}]. A list that says no more than a mapping can is the
 * same option, and is printed as a mapping. */
#include "option/animated.h"
#include "option/printer.h"
#include "option/schema.h"
#include "scene/options.h"

/* The shortest time from one repetition of a burst to the next. */
#define SHORTEST_S 0.001

static bool read_map(struct kiln_reader *reader, const struct kiln_option *option,
                     const struct kiln_node *node, struct kiln_burst *bursts)
{
    uint32_t *count = kiln_option_count_field(option, bursts);
    if (node->count > option->max_count)
        return kiln_reader_error(reader, node, "found %u bursts; at most %zu are allowed",
                                 node->count, option->max_count);
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        struct kiln_burst *burst = &bursts[*count];
        size_t before = kiln_reader_enter(reader, entry->key->text);
        *burst = (struct kiln_burst){.most = KILN_INTEGER_BY_WORD};
        if (!kiln_read_number(reader, &kiln_option_time, entry->key, &burst->time_s) ||
            !kiln_read_whole(reader, option, entry, &burst->count[0]))
            return false;
        burst->count[1] = burst->count[0];
        if (*count > 0 && burst->time_s <= burst[-1].time_s)
            return kiln_reader_error(
                reader, entry->key,
                "the time of a burst must be later than that of the burst before it");
        kiln_reader_leave(reader, before);
        ++*count;
    }
    return true;
}

/* Checks that a burst of a list is repeated neither too often nor out of order. */
static bool check_repetitions(struct kiln_reader *reader, const struct kiln_node *node,
                              const struct kiln_burst *burst)
{
    char every[48], jitter[48];
    kiln_unit_print_double(every, KILN_SECONDS, burst->every_s);
    kiln_unit_print_double(jitter, KILN_SECONDS, burst->jitter_s);
    if (burst->every_s == 0.0 && burst->most != KILN_INTEGER_BY_WORD) {
        kiln_reader_enter(reader, "most");
        return kiln_reader_error(reader, kiln_node_entry(node, "most"),
                                 "needs `every`; without it, the burst is not repeated");
    }
    if (burst->every_s == 0.0)
        return true;
    const bool rare = burst->every_s >= SHORTEST_S;
    if (rare && burst->jitter_s <= burst->every_s)
        return true;
    const char *key = rare ? "jitter" : "every";
    const struct kiln_node *at = kiln_node_entry(node, key);
    kiln_reader_enter(reader, key);
    if (!rare)
        return kiln_reader_error(reader, at ? at : node,
                                 "must be 0 s, for a burst that is not repeated, or at least 0.001 "
                                 "s; found %s",
                                 every);
    return kiln_reader_error(reader, at ? at : node, "must be at most `every`, %s; found %s", every,
                             jitter);
}

static bool read_bursts(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_burst *bursts = field;
    *kiln_option_count_field(option, field) = 0;
    if (node->kind == KILN_NODE_MAP)
        return read_map(reader, option, node, bursts);
    if (node->kind != KILN_NODE_LIST)
        return kiln_reader_mismatch(reader, option, node);
    if (!kiln_type_list.read(reader, option, node, field))
        return false;
    uint32_t index = 0;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next, index++) {
        size_t before = kiln_reader_enter_index(reader, index);
        if (!check_repetitions(reader, entry, &bursts[index]))
            return false;
        kiln_reader_leave(reader, before);
    }
    return true;
}

/* Returns whether a mapping can say the same. */
static bool is_map(const struct kiln_burst *bursts, uint32_t count)
{
    bool is = true;
    for (uint32_t i = 0; i < count; i++)
        is = is && bursts[i].count[0] == bursts[i].count[1] && bursts[i].every_s == 0.0 &&
             bursts[i].jitter_s == 0.0 && (i == 0 || bursts[i].time_s > bursts[i - 1].time_s);
    return is;
}

static void print_map(struct kiln_text *out, const struct kiln_burst *bursts, uint32_t count)
{
    kiln_text_add(out, " {");
    for (uint32_t i = 0; i < count; i++) {
        char time[48];
        kiln_unit_print_double(time, KILN_SECONDS, bursts[i].time_s);
        kiln_text_add(out, "%s%s: %u", i ? ", " : "", time, bursts[i].count[0]);
    }
    kiln_text_add(out, "}\n");
}

static void print_burst(struct kiln_text *out, const struct kiln_burst *burst)
{
    char at[48], every[48], jitter[48];
    kiln_unit_print_double(at, KILN_SECONDS, burst->time_s);
    kiln_unit_print_double(every, KILN_SECONDS, burst->every_s);
    kiln_unit_print_double(jitter, KILN_SECONDS, burst->jitter_s);
    kiln_text_add(out, "{at: %s, count: ", at);
    if (burst->count[0] == burst->count[1])
        kiln_text_add(out, "%u", burst->count[0]);
    else
        kiln_text_add(out, "[%u, %u]", burst->count[0], burst->count[1]);
    if (burst->every_s > 0.0)
        kiln_text_add(out, ", every: %s", every);
    if (burst->every_s > 0.0 && burst->most != KILN_INTEGER_BY_WORD)
        kiln_text_add(out, ", most: %u", burst->most);
    if (burst->jitter_s > 0.0)
        kiln_text_add(out, ", jitter: %s", jitter);
    kiln_text_add(out, "}");
}

static void print_bursts(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_burst *bursts = field;
    const uint32_t count = kiln_option_count(option, field);
    if (is_map(bursts, count)) {
        print_map(&printer->text, bursts, count);
        return;
    }
    kiln_text_add(&printer->text, " [");
    for (uint32_t i = 0; i < count; i++) {
        kiln_text_add(&printer->text, i ? ", " : "");
        print_burst(&printer->text, &bursts[i]);
    }
    kiln_text_add(&printer->text, "]\n");
}

static void describe_bursts(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{time: particles, ...}, each number of particles a whole number");
    kiln_option_describe_limits(option, out);
    kiln_text_add(out, ", or a list of bursts");
}

static void schema_bursts(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out,
                  "{\"anyOf\": [{\"type\": \"object\", \"maxProperties\": %zu, "
                  "\"propertyNames\": {\"pattern\": ",
                  option->max_count);
    kiln_schema_number_pattern(KILN_SECONDS, out);
    kiln_text_add(out, "}, \"additionalProperties\": ");
    kiln_type_integer.schema(option, out);
    kiln_text_add(out, "}, ");
    kiln_type_list.schema(option, out);
    kiln_text_add(out, "]}");
}

const struct kiln_option_type kiln_type_bursts = {
    .read = read_bursts,
    .print = print_bursts,
    .describe = describe_bursts,
    .schema = schema_bursts,
};
