/* Reads, prints and describes the option type of bursts. A burst is the birth of many particles at
 * one time. The option maps times to numbers of particles: {1 s: 100, 2.5 s: 40}. The times
 * increase. */
#include "option/animated.h"
#include "option/schema.h"
#include "scene/options.h"

static bool read_bursts(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_burst *bursts = field;
    uint32_t *count = kiln_option_count_field(option, field);
    if (node->kind != KILN_NODE_MAP)
        return kiln_reader_mismatch(reader, option, node);
    if (node->count > option->max_count)
        return kiln_reader_error(reader, node, "found %u bursts; at most %zu are allowed",
                                 node->count, option->max_count);
    *count = 0;
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        struct kiln_burst *burst = &bursts[*count];
        size_t before = kiln_reader_enter(reader, entry->key->text);
        if (!kiln_read_number(reader, &kiln_option_time, entry->key, &burst->time_s) ||
            !kiln_read_whole(reader, option, entry, &burst->count))
            return false;
        if (*count > 0 && burst->time_s <= burst[-1].time_s)
            return kiln_reader_error(
                reader, entry->key,
                "the time of a burst must be later than that of the burst before it");
        kiln_reader_leave(reader, before);
        ++*count;
    }
    return true;
}

static void print_bursts(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    const struct kiln_burst *bursts = field;
    uint32_t count = kiln_option_count(option, field);
    kiln_text_add(&printer->text, " {");
    for (uint32_t i = 0; i < count; i++) {
        char time[48];
        kiln_unit_print_double(time, KILN_SECONDS, bursts[i].time_s);
        kiln_text_add(&printer->text, "%s%s: %u", i ? ", " : "", time, bursts[i].count);
    }
    kiln_text_add(&printer->text, "}\n");
}

static void describe_bursts(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{time: particles, ...}, each number of particles a whole number");
    kiln_option_describe_limits(option, out);
}

static void schema_bursts(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out,
                  "{\"type\": \"object\", \"maxProperties\": %zu, \"propertyNames\": "
                  "{\"pattern\": ",
                  option->max_count);
    kiln_schema_number_pattern(KILN_SECONDS, out);
    kiln_text_add(out, "}, \"additionalProperties\": ");
    kiln_type_integer.schema(option, out);
    kiln_text_add(out, "}");
}

const struct kiln_option_type kiln_type_bursts = {
    .read = read_bursts,
    .print = print_bursts,
    .describe = describe_bursts,
    .schema = schema_bursts,
};
