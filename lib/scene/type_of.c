/* This file reads, prints and describes the forces of a baked wind, and those of a domain of gas.
 * They are forces as those of a system, but what they do does not depend on particles: values may
 * vary over time alone. */
#include <string.h>

#include "option/printer.h"
#include "option/reader.h"
#include "option/schema.h"
#include "scene/options.h"

/* The item number of the first of them that draws: those of the forces of systems are below it. */
enum { FIRST_ITEM = KILN_MAX_FORCES };

/* ---- tables without the clocks of particles -------------------------------------------------- */

/* Copies a table of rows, whose values then vary over time alone. */
static const struct kiln_option *rows_over_time(struct kiln_reader *reader,
                                                const struct kiln_option *rows)
{
    size_t count = 0;
    while (rows[count].name)
        count++;
    struct kiln_option *copy = kiln_arena_alloc(reader->scratch, count + 1, sizeof *copy);
    if (!copy)
        return NULL;
    for (size_t i = 0; i < count; i++) {
        copy[i] = rows[i];
        copy[i].clocks &= KILN_OVER_TIME;
    }
    return copy;
}

static const struct kiln_option_kind *kinds_over_time(struct kiln_reader *reader,
                                                      const struct kiln_option_kind *kinds)
{
    size_t count = 0;
    while (kinds[count].name)
        count++;
    struct kiln_option_kind *copy = kiln_arena_alloc(reader->scratch, count + 1, sizeof *copy);
    bool ok = copy != NULL;
    for (size_t i = 0; ok && i < count; i++) {
        copy[i] = kinds[i];
        copy[i].members = rows_over_time(reader, kinds[i].members);
        ok = copy[i].members != NULL;
    }
    if (!ok)
        kiln_reader_out_of_memory(reader);
    return ok ? copy : NULL;
}

/* ---- reading --------------------------------------------------------------------------------- */

/* Returns the forces among which a baked wind stands, whose forces `field` is: those of a system or
 * of a domain of gas. */
static const struct kiln_force *list_around(const struct kiln_scene *scene, const void *field)
{
    const char *at = field, *gas = (const char *)scene->gas;
    for (uint32_t i = 0; i < KILN_MAX_GAS; i++, gas += sizeof *scene->gas)
        if (at >= gas && at < gas + sizeof *scene->gas)
            return scene->gas[i].forces;
    const size_t offset = (size_t)(at - (const char *)scene->systems);
    return scene->systems[offset / sizeof *scene->systems].forces;
}

/* Returns how many forces the baked winds of the same list have before these. */
static uint32_t count_before(const struct kiln_reader *reader, const void *field)
{
    uint32_t count = 0;
    for (const struct kiln_force *force = list_around(kiln_reader_scene(reader), field);
         (const void *)&force->of != field; force++)
        count += force->kind == KILN_FORCE_BAKED ? force->of.count : 0;
    return count;
}

static bool read_of(struct kiln_reader *reader, const struct kiln_option *option,
                    const struct kiln_node *node, void *field)
{
    struct kiln_baked_forces *of = field;
    const uint32_t outer = reader->item;
    *of = (struct kiln_baked_forces){.count = 0};
    if (node->kind != KILN_NODE_LIST)
        return kiln_reader_mismatch(reader, option, node);
    if (node->count < 1 || node->count > KILN_MAX_BAKED_OF)
        return kiln_reader_error(reader, node, "found %u forces; allowed is from 1 to %d",
                                 node->count, KILN_MAX_BAKED_OF);
    struct kiln_option item = *kiln_baked_force;
    item.kinds = kinds_over_time(reader, item.kinds);
    if (!item.kinds)
        return false;
    of->at = kiln_arena_alloc(reader->arena, node->count, sizeof *of->at);
    if (!of->at)
        return kiln_reader_out_of_memory(reader);
    const uint32_t before = count_before(reader, field);
    for (const struct kiln_node *entry = node->first; entry; entry = entry->next) {
        const size_t length = kiln_reader_enter_index(reader, of->count);
        reader->item = FIRST_ITEM + before + of->count;
        if (!item.type->read(reader, &item, entry, &of->at[of->count]))
            return false;
        kiln_reader_leave(reader, length);
        of->count++;
    }
    reader->item = outer;
    return true;
}

/* ---- printing and describing ----------------------------------------------------------------- */

static void print_of(struct kiln_printer *printer, const struct kiln_option *option,
                     const void *field)
{
    (void)option;
    const struct kiln_baked_forces *of = field;
    kiln_text_add(&printer->text, "\n");
    printer->indent += 2;
    for (uint32_t i = 0; i < of->count; i++) {
        kiln_text_add(&printer->text, "%*s-", (int)printer->indent, "");
        printer->after_dash = true;
        kiln_baked_force->type->print(printer, kiln_baked_force, &of->at[i]);
    }
    printer->after_dash = false;
    printer->indent -= 2;
}

static void describe_of(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "a list of 1 to %d: ", KILN_MAX_BAKED_OF);
    kiln_baked_force->type->describe(kiln_baked_force, out);
}

static void schema_of(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": \"array\", \"minItems\": 1, \"maxItems\": %d, \"items\": ",
                  KILN_MAX_BAKED_OF);
    kiln_baked_force->type->schema(kiln_baked_force, out);
    kiln_text_add(out, "}");
}

const struct kiln_option_type kiln_type_of = {
    .read = read_of,
    .print = print_of,
    .describe = describe_of,
    .schema = schema_of,
};

/* ---- forces of gas: a list of these items and of baked winds --------------------------------- */

static bool read_forces(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct kiln_option item = *kiln_force_of_gas, list = *option;
    item.kinds = kinds_over_time(reader, item.kinds);
    list.item = &item;
    return item.kinds && kiln_type_list.read(reader, &list, node, field);
}

static void print_forces(struct kiln_printer *printer, const struct kiln_option *option,
                         const void *field)
{
    struct kiln_option list = *option;
    list.item = kiln_force_of_gas;
    kiln_type_list.print(printer, &list, field);
}

static void describe_forces(const struct kiln_option *option, struct kiln_text *out)
{
    struct kiln_option list = *option;
    list.item = kiln_force_of_gas;
    kiln_type_list.describe(&list, out);
}

static void schema_forces(const struct kiln_option *option, struct kiln_text *out)
{
    struct kiln_option list = *option;
    list.item = kiln_force_of_gas;
    kiln_type_list.schema(&list, out);
}

const struct kiln_option_type kiln_type_forces = {
    .read = read_forces,
    .print = print_forces,
    .describe = describe_forces,
    .schema = schema_forces,
};
