/* Reads parameters and replaces their names by their values. A parameter is a row of options that a
 * file makes: its values are checked by the same types of options as the keys of the file, and have
 * the same errors. A default may name other parameters, so each parameter is made ready when it is
 * needed first; one that is needed while it is made ready depends on itself.
 *
 * Values from outside of the file, of --set or a service, may be a stranger's. They are copied as
 * literal texts, so `$name` and arithmetic mean nothing in them. */
#include "option/params.h"

#include <float.h>
#include <string.h>

#include "option/node_copy.h"

enum { MOST_TEXT = 4000, MOST_DEPTH = 16 };
static const double MOST_NUMBER = 1e30;

static const char *const kind_names[KILN_PARAM_KINDS] = {
    [KILN_PARAM_NUMBER] = "number", [KILN_PARAM_INTEGER] = "integer",
    [KILN_PARAM_COLOR] = "color",   [KILN_PARAM_VECTOR] = "vector",
    [KILN_PARAM_CHOICE] = "choice", [KILN_PARAM_SWITCH] = "switch",
    [KILN_PARAM_TEXT] = "text",     [KILN_PARAM_FILE] = "file"};

static const char *const other_keys[] = {"min", "max", "of", "help"};
enum { OTHER_KEYS = sizeof other_keys / sizeof *other_keys };

const char *kiln_params_kind_name(enum kiln_param_kind kind)
{
    return kind_names[kind];
}

/* Returns the entry of a declaration that says its kind, which *kind becomes; NULL if none does. */
static struct kiln_node *find_kind(const struct kiln_node *entry, enum kiln_param_kind *kind)
{
    for (unsigned i = 0; i < KILN_PARAM_KINDS; i++) {
        struct kiln_node *value = kiln_node_entry(entry, kind_names[i]);
        *kind = (enum kiln_param_kind)i;
        if (value)
            return value;
    }
    return NULL;
}

const char *kiln_params_kind_of(const struct kiln_node *entry)
{
    enum kiln_param_kind kind;
    return find_kind(entry, &kind) ? kind_names[kind] : NULL;
}

/* ---- declarations ---------------------------------------------------------------------------- */

static bool is_name_character(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

static bool is_name(const char *text)
{
    const char *c = text;
    while (is_name_character(*c))
        c++;
    return *c == '\0' && kiln_option_is_name(text);
}

/* Checks that all keys of a declaration are known, and that one of them says the kind. */
static bool check_keys(struct kiln_reader *reader, const struct kiln_node *entry)
{
    const char *names[KILN_PARAM_KINDS + OTHER_KEYS], *kind = NULL;
    char suggestion[512];
    memcpy(names, kind_names, sizeof kind_names);
    memcpy(names + KILN_PARAM_KINDS, other_keys, sizeof other_keys);
    for (const struct kiln_node *key = entry->first; key; key = key->next) {
        size_t i = 0;
        while (i < KILN_PARAM_KINDS + OTHER_KEYS && strcmp(names[i], key->key->text) != 0)
            i++;
        if (i == KILN_PARAM_KINDS + OTHER_KEYS) {
            kiln_option_suggest(suggestion, sizeof suggestion, key->key->text, names, i);
            kiln_reader_enter(reader, key->key->text);
            return kiln_reader_error(reader, key->key, "unknown key%s", suggestion);
        }
        if (i < KILN_PARAM_KINDS && kind)
            return kiln_reader_error(reader, key->key, "expected one kind, found '%s' and '%s'",
                                     kind, names[i]);
        kind = i < KILN_PARAM_KINDS ? names[i] : kind;
    }
    return kind || kiln_reader_error(reader, entry,
                                     "expected a kind with the default: number, integer, color, "
                                     "vector, choice, switch, text or file");
}

static bool read_help(struct kiln_reader *reader, const struct kiln_node *entry,
                      struct kiln_param *param)
{
    const struct kiln_node *help = kiln_node_entry(entry, "help");
    param->help = "";
    if (!help)
        return true;
    kiln_reader_enter(reader, "help");
    if (help->kind != KILN_NODE_SCALAR)
        return kiln_reader_expected(reader, help, "a text");
    if (strlen(help->text) > MOST_TEXT)
        return kiln_reader_error(reader, help, "the text has %zu bytes; at most %d are allowed",
                                 strlen(help->text), MOST_TEXT);
    param->help = help->text;
    return true;
}

static bool declare(struct kiln_reader *reader, struct kiln_node *entry, struct kiln_param *param)
{
    enum kiln_param_kind kind;
    const size_t before = kiln_reader_enter(reader, entry->key->text);
    if (!is_name(entry->key->text))
        return kiln_reader_error(reader, entry->key,
                                 "the name of a parameter starts with a letter and has at most 32 "
                                 "letters, digits and '_'");
    if (entry->kind != KILN_NODE_MAP)
        return kiln_reader_expected(reader, entry, "a mapping such as {number: 1, min: 0, max: 2}");
    if (!check_keys(reader, entry) || !read_help(reader, entry, param))
        return false;
    kiln_reader_leave(reader, before);
    param->fallback = param->value = find_kind(entry, &kind);
    param->kind = kind;
    param->name = entry->key->text;
    param->entry = entry;
    return true;
}

bool kiln_params_declare(struct kiln_reader *reader, const struct kiln_node *declared)
{
    struct kiln_params *params = kiln_arena_alloc(reader->scratch, 1, sizeof *params);
    if (!params)
        return kiln_reader_out_of_memory(reader);
    reader->params = params;
    if (!declared)
        return true;
    kiln_reader_leave(reader, 0);
    kiln_reader_enter(reader, "params");
    if (declared->kind != KILN_NODE_MAP)
        return kiln_reader_expected(reader, declared, "a mapping of names");
    if (declared->count > KILN_MAX_PARAMS)
        return kiln_reader_error(reader, declared, "found %u parameters; at most %d are allowed",
                                 declared->count, KILN_MAX_PARAMS);
    for (struct kiln_node *entry = declared->first; entry; entry = entry->next) {
        if (!declare(reader, entry, &params->list[params->count]))
            return false;
        params->count++;
    }
    kiln_reader_leave(reader, 0);
    return true;
}

/* ---- values from outside --------------------------------------------------------------------- */

static struct kiln_param *find(const struct kiln_reader *reader, const char *name)
{
    struct kiln_params *params = reader->params;
    for (uint32_t i = 0; params && i < params->count; i++) {
        if (strcmp(params->list[i].name, name) == 0)
            return &params->list[i];
    }
    return NULL;
}

/* Writes a suggestion for a name that no parameter has. */
static void suggest(const struct kiln_reader *reader, const char *name, char out[512])
{
    const char *names[KILN_MAX_PARAMS];
    const uint32_t count = reader->params ? reader->params->count : 0;
    for (uint32_t i = 0; i < count; i++)
        names[i] = reader->params->list[i].name;
    kiln_option_suggest(out, 512, name, names, count);
}

static void make_literal(struct kiln_node *node)
{
    node->literal = true;
    for (struct kiln_node *child = node->first; child; child = child->next)
        make_literal(child); /* as deep as KILN_NODE_MAX_DEPTH */
}

bool kiln_params_set(struct kiln_reader *reader, const char *name, const struct kiln_node *place,
                     struct kiln_node *value)
{
    struct kiln_param *param = find(reader, name);
    char suggestion[512], quoted[64];
    if (!param) {
        kiln_node_quote(quoted, name);
        suggest(reader, name, suggestion);
        return kiln_node_error(place, reader->error, "there is no parameter '%s'%s", quoted,
                               suggestion);
    }
    make_literal(value);
    param->value = value;
    return true;
}

bool kiln_params_set_all(struct kiln_reader *reader, struct kiln_node *values)
{
    kiln_reader_leave(reader, 0);
    if (values->kind != KILN_NODE_MAP)
        return kiln_reader_expected(reader, values, "a mapping of the names of parameters");
    for (struct kiln_node *entry = values->first; entry; entry = entry->next) {
        if (!kiln_params_set(reader, entry->key->text, entry->key, entry))
            return false;
    }
    return true;
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* Finds the dimension of a number: that of its unit or of its arithmetic. A scalar that is no
 * number is plain, and an error when it is read. */
static bool find_dimension(struct kiln_reader *reader, const struct kiln_node *node,
                           enum kiln_dimension *dimension)
{
    struct kiln_quantity quantity;
    double number;
    const char *unit = "";
    *dimension = KILN_PLAIN;
    if (node->kind != KILN_NODE_SCALAR)
        return true;
    if (kiln_expression_is(node)) {
        return kiln_expression_compute(reader, node, &quantity) &&
               (kiln_quantity_dimension(&quantity, dimension) ||
                kiln_reader_error(reader, node, "a parameter has no such unit"));
    }
    if (kiln_unit_split(node->text, &number, &unit))
        kiln_unit_find(unit, dimension);
    return true;
}

/* Reads min or max, if it is given. */
static bool read_limit(struct kiln_reader *reader, struct kiln_param *param, const char *key,
                       double *limit, bool *given)
{
    struct kiln_node *node = kiln_node_entry(param->entry, key);
    *given = node != NULL;
    if (!node)
        return true;
    const size_t before = kiln_reader_enter(reader, key);
    const bool ranged = param->kind == KILN_PARAM_NUMBER || param->kind == KILN_PARAM_INTEGER ||
                        param->kind == KILN_PARAM_VECTOR;
    struct kiln_option row = param->row;
    row.type = param->kind == KILN_PARAM_INTEGER ? &kiln_type_integer : &kiln_type_number;
    uint32_t whole = 0;
    if (!ranged)
        return kiln_reader_error(reader, node->key, "a %s has no range", kind_names[param->kind]);
    const bool ok = param->kind == KILN_PARAM_INTEGER ? kiln_read_whole(reader, &row, node, &whole)
                                                      : kiln_read_number(reader, &row, node, limit);
    if (ok && param->kind == KILN_PARAM_INTEGER)
        *limit = whole;
    kiln_reader_leave(reader, before);
    return ok;
}

static bool read_range(struct kiln_reader *reader, struct kiln_param *param)
{
    double min = param->row.min, max = param->row.max;
    if (!read_limit(reader, param, "min", &min, &param->has_min) ||
        !read_limit(reader, param, "max", &max, &param->has_max))
        return false;
    if (min > max)
        return kiln_reader_error(reader, param->entry, "min is above max");
    param->row.min = min;
    param->row.max = max;
    return true;
}

static bool read_words(struct kiln_reader *reader, struct kiln_param *param)
{
    const struct kiln_node *of = kiln_node_entry(param->entry, "of");
    if (of && param->kind != KILN_PARAM_CHOICE)
        return kiln_reader_error(reader, of->key, "only a choice has `of`");
    if (param->kind != KILN_PARAM_CHOICE)
        return true;
    if (!of || of->kind != KILN_NODE_LIST || of->count == 0)
        return kiln_reader_error(reader, of ? of : param->entry,
                                 "a choice needs a list of its words, `of: [one, two]`");
    const char **words = kiln_arena_alloc(reader->scratch, of->count + 1, sizeof *words);
    if (!words)
        return kiln_reader_out_of_memory(reader);
    const char **word = words;
    for (const struct kiln_node *item = of->first; item; item = item->next, word++) {
        if (item->kind != KILN_NODE_SCALAR || *item->text == '\0')
            return kiln_reader_expected(reader, item, "a word");
        *word = item->text;
    }
    param->row.choices = words;
    return true;
}

/* Makes the row that describes the values of a parameter. */
static bool make_row(struct kiln_reader *reader, struct kiln_param *param)
{
    static const struct kiln_option rows[KILN_PARAM_KINDS] = {
        [KILN_PARAM_NUMBER] = {.type = &kiln_type_number},
        [KILN_PARAM_INTEGER] = {.type = &kiln_type_integer, .max = UINT32_MAX},
        [KILN_PARAM_COLOR] = {.type = &kiln_type_color, .max = 1000000},
        [KILN_PARAM_VECTOR] = {.type = &kiln_type_vector},
        [KILN_PARAM_CHOICE] = {.type = &kiln_type_choice},
        [KILN_PARAM_SWITCH] = {.type = &kiln_type_boolean},
        [KILN_PARAM_TEXT] = {.type = &kiln_type_text, .max = MOST_TEXT},
        [KILN_PARAM_FILE] = {.type = &kiln_type_text, .min = 1, .max = MOST_TEXT},
    };
    param->row = rows[param->kind];
    param->row.name = param->name;
    if (param->kind == KILN_PARAM_NUMBER || param->kind == KILN_PARAM_VECTOR) {
        param->row.min = -MOST_NUMBER;
        param->row.max = MOST_NUMBER;
        if (!find_dimension(reader, param->fallback, &param->row.dimension))
            return false;
        /* A vector is in the unit that one of its components has. */
        for (const struct kiln_node *item = param->fallback->first;
             item && param->row.dimension == KILN_PLAIN; item = item->next) {
            if (!find_dimension(reader, item, &param->row.dimension))
                return false;
        }
    }
    param->unit = kiln_unit_name(param->row.dimension);
    return read_range(reader, param) && read_words(reader, param);
}

/* ---- making a parameter ready ---------------------------------------------------------------- */

/* Writes the unit behind a number that has none, so that the number means the same in every row. */
static bool add_unit(struct kiln_reader *reader, struct kiln_param *param, struct kiln_node *node)
{
    double number;
    const char *unit = "";
    if (*param->unit == '\0' || node->kind != KILN_NODE_SCALAR || kiln_expression_is(node) ||
        !kiln_unit_split(node->text, &number, &unit) || *unit)
        return true;
    node->text = kiln_arena_format(reader->scratch, "%s %s", node->text, param->unit);
    return node->text || kiln_reader_out_of_memory(reader);
}

static bool add_units(struct kiln_reader *reader, struct kiln_param *param)
{
    if (param->kind == KILN_PARAM_NUMBER)
        return add_unit(reader, param, param->value);
    for (struct kiln_node *item = param->kind == KILN_PARAM_VECTOR ? param->value->first : NULL;
         item; item = item->next) {
        if (!add_unit(reader, param, item))
            return false;
    }
    return true;
}

/* Replaces a link of a node and of all below it. */
static void replace_link(struct kiln_node *node, const struct kiln_node_link *from,
                         const struct kiln_node_link *to)
{
    if (node->via == from)
        node->via = to;
    for (struct kiln_node *child = node->first; child; child = child->next)
        replace_link(child, from, to);
}

/* Checks a value by the parameter's row. An error of a value from outside says where the parameter
 * is declared. */
static bool check_value(struct kiln_reader *reader, struct kiln_param *param,
                        struct kiln_node *node)
{
    union {
        struct kiln_value3 vector;
        double number;
        const char *text;
        unsigned choice;
        uint32_t whole;
        bool yes;
    } field;
    const struct kiln_node_link link = {"declared at", param->entry->key, NULL};
    if (node != param->fallback)
        replace_link(node, NULL, &link);
    const bool is_file = param->kind == KILN_PARAM_FILE;
    const bool ok =
        param->row.type->read(reader, &param->row, node, &field) &&
        (!is_file || !reader->params->check_file || reader->params->check_file(reader, node));
    replace_link(node, &link, NULL);
    return ok;
}

static bool replace_node(struct kiln_reader *reader, struct kiln_node *node);

/* Replaces the names of other parameters in a declaration. */
static bool replace_declaration(struct kiln_reader *reader, struct kiln_param *param)
{
    for (struct kiln_node *item = param->entry->first; item; item = item->next) {
        if (strcmp(item->key->text, "help") != 0 && !replace_node(reader, item))
            return false;
    }
    return true;
}

/* Makes a parameter's row and value, which may name other parameters. */
static bool make_ready(struct kiln_reader *reader, struct kiln_param *param)
{
    if (param->state == PARAM_READY)
        return true;
    const size_t before = reader->path_length;
    char path[sizeof reader->path];
    memcpy(path, reader->path, sizeof path);
    kiln_reader_leave(reader, 0);
    kiln_reader_enter(reader, "params");
    kiln_reader_enter(reader, param->name);
    if (param->state == PARAM_BUSY)
        return kiln_reader_error(reader, param->entry->key, "the parameter depends on itself");
    if (reader->params->depth == MOST_DEPTH)
        return kiln_reader_error(reader, param->entry->key,
                                 "more than %d parameters depend on each other", MOST_DEPTH);
    reader->params->depth++;
    param->state = PARAM_BUSY;
    if (!replace_declaration(reader, param) || !make_row(reader, param) ||
        !check_value(reader, param, param->fallback) ||
        (param->value != param->fallback && !check_value(reader, param, param->value)) ||
        !add_units(reader, param))
        return false;
    if (param->kind >= KILN_PARAM_CHOICE) /* texts */
        make_literal(param->value);
    param->state = PARAM_READY;
    reader->params->depth--;
    memcpy(reader->path, path, sizeof path);
    reader->path_length = before;
    return true;
}

bool kiln_params_check(struct kiln_reader *reader)
{
    struct kiln_params *params = reader->params;
    for (uint32_t i = 0; i < params->count; i++) {
        if (!make_ready(reader, &params->list[i]))
            return false;
    }
    return true;
}

bool kiln_params_quantity(struct kiln_reader *reader, const struct kiln_node *node,
                          const char *name, struct kiln_quantity *quantity)
{
    struct kiln_param *param = find(reader, name);
    char suggestion[512];
    double value = 0;
    if (!param) {
        suggest(reader, name, suggestion);
        return kiln_reader_error(reader, node, "there is no parameter '%s'%s", name, suggestion);
    }
    if (param->kind != KILN_PARAM_NUMBER && param->kind != KILN_PARAM_INTEGER)
        return kiln_reader_error(reader, node, "$%s is a %s, and arithmetic takes numbers", name,
                                 kind_names[param->kind]);
    if (!make_ready(reader, param) || !kiln_read_number(reader, &param->row, param->value, &value))
        return false;
    *quantity = kiln_quantity_of(param->row.dimension, value);
    return true;
}

/* ---- replacing ------------------------------------------------------------------------------- */

/* Replaces the contents of a scalar `$name` by a copy of the parameter's value. */
static bool replace_name(struct kiln_reader *reader, struct kiln_node *node)
{
    const char *name = node->text + 1;
    struct kiln_param *param = find(reader, name);
    char suggestion[512];
    if (!param) {
        suggest(reader, name, suggestion);
        return kiln_node_error(node, reader->error,
                               "there is no parameter '%s'%s; $$%s is the text $%s", name,
                               suggestion, name, name);
    }
    struct kiln_node *at = kiln_arena_alloc(reader->scratch, 1, sizeof *at);
    const char *words = kiln_arena_format(reader->scratch, "as $%s at", name);
    if (!at || !words)
        return kiln_reader_out_of_memory(reader);
    *at = *node;
    const struct kiln_copying copying = {reader->scratch, reader->error, reader->counts, words, at};
    struct kiln_node *copy =
        make_ready(reader, param) ? kiln_node_copy(&copying, param->value, 0) : NULL;
    if (!copy)
        return false;
    copy->key = node->key;
    copy->next = node->next;
    *node = *copy;
    return true;
}

/* Replaces what a scalar that begins with '$' stands for. */
static bool replace_scalar(struct kiln_reader *reader, struct kiln_node *node)
{
    if (node->literal || node->text[0] != '$')
        return true;
    if (node->text[1] == '$') {
        node->text++;
        node->literal = true;
        return true;
    }
    return !is_name(node->text + 1) || replace_name(reader, node);
}

static bool replace_node(struct kiln_reader *reader, struct kiln_node *node)
{
    if (node->kind == KILN_NODE_SCALAR)
        return replace_scalar(reader, node);
    for (struct kiln_node *child = node->first; child; child = child->next) {
        if ((child->key && !replace_scalar(reader, child->key)) || !replace_node(reader, child))
            return false;
        if (child->key && child->key->kind != KILN_NODE_SCALAR)
            return kiln_node_error(child->key, reader->error,
                                   "a key must be a word, not a list or mapping");
    }
    return true;
}

bool kiln_params_replace(struct kiln_reader *reader, struct kiln_node *root)
{
    kiln_reader_leave(reader, 0);
    return replace_node(reader, root);
}
