/* This file reads the length of a clip. It is read after the frames and the rate, in whose place it
 * stands, and says how long the clip is: times of keys may be parts of that. */
#include <math.h>

#include "option/schema.h"
#include "scene/options.h"

static bool read_duration(struct kiln_reader *reader, const struct kiln_option *option,
                          const struct kiln_node *node, void *field)
{
    struct kiln_scene *scene = field;
    double seconds = 0;
    if (!kiln_node_is(node, option->special_word)) {
        if (!kiln_read_number(reader, option, node, &seconds))
            return false;
        const double frames = floor(seconds * scene->fps.num / scene->fps.den + 0.5);
        if (frames < 1 || frames > KILN_MAX_FRAMES)
            return kiln_reader_error(reader, node,
                                     "%.0f frames are out of range; allowed is from 1 "
                                     "to %d",
                                     frames, KILN_MAX_FRAMES);
        scene->frames = (uint32_t)frames;
    }
    reader->clip_s = (double)scene->frames * scene->fps.den / scene->fps.num;
    return true;
}

static void print_duration(struct kiln_printer *printer, const struct kiln_option *option,
                           const void *field)
{
    (void)printer;
    (void)option;
    (void)field;
}

static void describe_duration(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_type_number.describe(option, out);
}

static void schema_duration(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "{\"anyOf\": [{\"const\": \"none\"}, ");
    kiln_schema_number(option, out);
    kiln_text_add(out, "]}");
}

const struct kiln_option_type kiln_type_duration = {
    .read = read_duration,
    .print = print_duration,
    .describe = describe_duration,
    .schema = schema_duration,
};
