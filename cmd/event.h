/* Events for other programs: each is a line of JSON on standard output. */
#ifndef KILN_CMD_EVENT_H
#define KILN_CMD_EVENT_H

#include "kiln_program.h"

/* Begins an object whose "event" is the name. More members may be added until its end, which ends
 * the line and flushes nothing. */
struct kiln_json event_begin(const char *name);
void event_end(struct kiln_json *json);

#endif
