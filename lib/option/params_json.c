/* Writes the values of parameters as JSON, for forms that people fill in. */
#include "option/params.h"

/* Writes a number in the unit of its dimension. An angle is a text, since its unit must be given.
 */
static bool write_number(struct kiln_reader *reader, const struct kiln_param *param,
                         const struct kiln_node *node, struct kiln_text *out)
{
    struct kiln_option row = param->row;
    char text[48];
    double value = 0;
    row.type = &kiln_type_number;
    if (!kiln_read_number(reader, &row, node, &value))
        return false;
    if (!kiln_unit_is_required(row.dimension)) {
        kiln_text_from_double(text, value);
        kiln_text_add(out, "%s", text);
        return true;
    }
    kiln_unit_print_double(text, row.dimension, value);
    kiln_text_add_json(out, text);
    return true;
}

/* Writes a list of numbers. */
static bool write_list(struct kiln_reader *reader, const struct kiln_param *param,
                       const struct kiln_node *list, struct kiln_text *out)
{
    kiln_text_add(out, "[");
    for (const struct kiln_node *item = list->first; item; item = item->next) {
        kiln_text_add(out, "%s", item == list->first ? "" : ", ");
        if (!write_number(reader, param, item, out))
            return false;
    }
    kiln_text_add(out, "]");
    return true;
}

bool kiln_params_write_json(struct kiln_reader *reader, const struct kiln_param *param,
                            const struct kiln_node *value, struct kiln_text *out)
{
    double number;
    if (value->kind == KILN_NODE_LIST)
        return write_list(reader, param, value, out);
    if (param->kind == KILN_PARAM_NUMBER || param->kind == KILN_PARAM_INTEGER ||
        (param->kind == KILN_PARAM_COLOR &&
         (kiln_expression_is(value) || kiln_text_to_double(value->text, &number))))
        return write_number(reader, param, value, out);
    if (param->kind == KILN_PARAM_SWITCH)
        kiln_text_add(out, "%s", value->text);
    else
        kiln_text_add_json(out, value->text);
    return true;
}
