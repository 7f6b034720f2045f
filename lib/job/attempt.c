/* Writes the description of a run (its command, machine, device, techniques and times) as JSON, and
 * copies such a description out of a journal. */
#include "job/attempt.h"

#include <string.h>
#include <unistd.h>

static void add_device(struct kiln_json *json, const struct kiln_device_info *device)
{
    if (!device) {
        kiln_json_null(json, "device");
        return;
    }
    kiln_json_begin_object(json, "device");
    kiln_json_string(json, "name", device->name);
    kiln_json_string(json, "vendor", device->vendor);
    kiln_json_string(json, "gl_version", device->gl_version);
    kiln_json_string(json, "platform", device->platform);
    kiln_json_bool(json, "software", device->software);
    kiln_json_bool(json, "exact", device->exact);
    kiln_json_end(json);
}

/* Adds a text such as "simulate=cpu sort=cpu" as an object. */
static void add_techniques(struct kiln_json *json, const char *techniques)
{
    kiln_json_begin_object(json, "techniques");
    while (*techniques) {
        size_t length = strcspn(techniques, " ");
        const char *equals = memchr(techniques, '=', length);
        if (equals) {
            char stage[32];
            size_t stage_length = (size_t)(equals - techniques);
            snprintf(stage, sizeof stage, "%.*s", (int)stage_length, techniques);
            kiln_json_format(json, stage, "%.*s", (int)(length - stage_length - 1), equals + 1);
        }
        techniques += length + strspn(techniques + length, " ");
    }
    kiln_json_end(json);
}

void kiln_attempt_add_passes(struct kiln_json *json, const double pass_ms[KILN_PASS_COUNT])
{
    kiln_json_begin_object(json, "ms");
    for (int i = 0; i < KILN_PASS_COUNT; i++)
        kiln_json_time(json, kiln_pass_name((enum kiln_pass)i), pass_ms[i]);
    kiln_json_end(json);
}

static void add_totals(struct kiln_json *json, const struct kiln_attempt *run,
                       const struct kiln_render_stats *stats)
{
    kiln_json_begin_object(json, "totals");
    kiln_json_uint(json, "asked", run->asked);
    kiln_json_uint(json, "frames", stats->frames);
    kiln_json_uint(json, "steps", stats->steps);
    kiln_json_time(json, "setup_s", stats->setup_s);
    kiln_json_time(json, "total_s", stats->total_s);
    kiln_json_uint(json, "particle_bytes", stats->particle_bytes);
    kiln_attempt_add_passes(json, stats->pass_ms);
    kiln_json_end(json);
}

static void add_failure(struct kiln_json *json, const struct kiln_error *failure)
{
    if (!failure) {
        kiln_json_null(json, "error");
        return;
    }
    kiln_json_begin_object(json, "error");
    kiln_json_int(json, "code", failure->code);
    kiln_json_string(json, "message", failure->message);
    kiln_json_end(json);
}

void kiln_attempt_describe(struct kiln_json *json, const struct kiln_attempt *run,
                           const struct kiln_render_stats *stats, const struct kiln_error *failure)
{
    char host[256] = "", started[32] = "";
    struct tm day;
    gethostname(host, sizeof host - 1);
    if (gmtime_r(&run->started, &day))
        strftime(started, sizeof started, "%Y-%m-%dT%H:%M:%SZ", &day);
    kiln_json_string(json, "host", host);
    kiln_json_string(json, "started", started);
    kiln_json_string(json, "build", run->build ? run->build : KILN_VERSION);
    kiln_json_strings(json, "command", run->command, run->command_count);
    if (run->shard.count > 0)
        kiln_json_format(json, "shard", "%u/%u", run->shard.index + 1, run->shard.count);
    add_device(json, run->device);
    add_techniques(json, run->techniques);
    add_failure(json, failure);
    kiln_json_uint(json, "kept", stats->kept);
    add_totals(json, run, stats);
}

/* Moves past the digits at the start of a text; false: there is none. */
static bool take_digits(const char **text)
{
    const size_t count = strspn(*text, "0123456789");
    *text += count;
    return count > 0;
}

/* Returns whether a text is a number by the grammar of JSON, which has no "+1", ".5" or "01". */
static bool is_number(const char *text)
{
    text += *text == '-';
    const bool is_zero = *text == '0';
    const char *start = text;
    if (!take_digits(&text) || (is_zero && text > start + 1))
        return false;
    if (*text == '.' && (text++, !take_digits(&text)))
        return false;
    if (*text == 'e' || *text == 'E') {
        text++;
        text += *text == '+' || *text == '-';
        if (!take_digits(&text))
            return false;
    }
    return *text == '\0';
}

/* Returns whether a scalar can be written to JSON without quotes. */
static bool is_literal(const struct kiln_node *value)
{
    double number;
    const char *text = value->text;
    if (value->quoted)
        return false;
    return strcmp(text, "true") == 0 || strcmp(text, "false") == 0 || strcmp(text, "null") == 0 ||
           (is_number(text) && kiln_text_to_double(text, &number));
}

void kiln_attempt_copy(struct kiln_json *json, const char *key, const struct kiln_node *value)
{
    if (value->kind == KILN_NODE_MAP)
        kiln_json_begin_object(json, key);
    else if (value->kind == KILN_NODE_LIST)
        kiln_json_begin_array(json, key);
    else if (is_literal(value))
        kiln_json_raw(json, key, value->text);
    else
        kiln_json_string(json, key, value->text);
    if (value->kind == KILN_NODE_SCALAR)
        return;
    for (const struct kiln_node *item = value->first; item; item = item->next)
        kiln_attempt_copy(json, item->key ? item->key->text : NULL, item);
    kiln_json_end(json);
}
