/* Begins and ends the lines of JSON that a command prints while it runs. Whether standard output
 * took them is asked once, by report_finish. */
#include "event.h"

struct kiln_json event_begin(const char *name)
{
    struct kiln_json json = kiln_json_to_file(stdout);
    kiln_json_begin_object(&json, NULL);
    kiln_json_string(&json, "event", name);
    return json;
}

void event_end(struct kiln_json *json)
{
    kiln_json_end(json);
    kiln_json_finish(json);
}
