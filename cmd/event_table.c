/* Lists the events of --events, with a row for each member. 'kiln help events' and the JSON schema
 * are printed from the rows, and a test checks what commands print against that schema. */
#include <string.h>

#include "event.h"

/* The types of members in JSON schema. */
#define STRING  "\"type\": \"string\""
#define INTEGER "\"type\": \"integer\""
#define NUMBER  "\"type\": \"number\""
#define BOOLEAN "\"type\": \"boolean\""
#define OBJECT  "\"type\": \"object\""
#define STRINGS "\"type\": \"array\", \"items\": {\"type\": \"string\"}"
#define PAIR                                                                                       \
    "\"type\": \"array\", \"items\": {\"type\": \"integer\"}, \"minItems\": 2, \"maxItems\": 2"
#define OBJECTS     "\"type\": \"array\", \"items\": {\"type\": \"object\"}"
#define MAYBE(type) "\"type\": [\"" type "\", \"null\"]"
#define AGAIN       "\"enum\": [\"never\", \"again\", \"with more\"]"

/* The members that event_add_place adds. */
#define PLACE                                                                                      \
    {"file", STRING, "Where the message names a place in one.", true},                             \
        {"line", INTEGER, "From 1.", true},                                                        \
    {                                                                                              \
        "column", INTEGER, "From 1.", true                                                         \
    }

struct member {
    const char *name, *type, *help;
    bool optional;
};

struct event {
    const char *name, *of, *help; /* of: the commands that print it */
    struct member members[20];    /* besides `event` and `time`; a row without a name ends them */
};

static const struct event events[] = {
    {"started",
     "every command",
     "The command line was read.",
     {{"kiln", STRING, "Version and commit.", false},
      {"command", STRING, "Its name.", false},
      {"arguments", STRINGS, "Its options and operands.", false},
      {"host", STRING, "The machine's name.", false},
      {"process", INTEGER, "The number of the process.", false}}},
    {"loaded",
     "render, bake, check, plan",
     "A scene was read, and its files were looked at.",
     {{"scene", STRING, "As it was given.", false},
      {"hash", STRING, "SHA-256 of the scene and its files.", false},
      {"size", PAIR, "Width and height in pixels.", false},
      {"fps", STRING, "Frames a second, as a fraction.", false},
      {"frames", INTEGER, "Of the whole clip.", false},
      {"steps", INTEGER, "Of the whole clip.", false},
      {"particles", INTEGER, "That may live at once.", false},
      {"memory_bytes", INTEGER, "That a job on the device cpu is expected to take.", false}}},
    {"device",
     "render",
     "A device was opened.",
     {{"index", INTEGER, "Its number in 'kiln devices'.", false},
      {"name", STRING, "Its name.", false},
      {"software", BOOLEAN, "Whether it draws on the processor.", false}}},
    {"shard",
     "render",
     "Which share of the clip this task draws.",
     {{"shard", INTEGER, "From 1.", false},
      {"shards", INTEGER, "Of so many.", false},
      {"variable", MAYBE("string"), "Of the environment, that said so.", false}}},
    {"frame",
     "render",
     "A frame is done: its file is whole; or, where frames have no files, it was drawn.",
     {{"scene", STRING, "As it was given.", false},
      {"frame", INTEGER, "Its number.", false},
      {"done", INTEGER, "Frames of this job that are done.", false},
      {"total", INTEGER, "Frames that it does.", false},
      {"elapsed_s", NUMBER, "Since the job began.", false},
      {"eta_s", MAYBE("number"), "What is left of it.", false},
      {"alive", INTEGER, "Particles.", false},
      {"state", STRING, "The state hash.", false},
      {"pass_ms", OBJECT, "Times of the passes.", false},
      {"file", STRING, "Its file.", true},
      {"bytes", INTEGER, "Of the file.", true},
      {"sha256", STRING, "Of the file.", true}}},
    {"part",
     "render",
     "A part of a clip is whole, and waits in its file for the others.",
     {{"scene", STRING, "As it was given.", false},
      {"file", STRING, "Its file.", false},
      {"frames", PAIR, "The first and the last frame.", false},
      {"bytes", INTEGER, "Of the file.", false},
      {"sha256", STRING, "Of the file.", false}}},
    {"file",
     "render",
     "A clip, or a file beside it, is whole.",
     {{"scene", STRING, "As it was given.", false},
      {"file", STRING, "Its file.", false},
      {"frames", PAIR, "The first and the last frame.", false},
      {"bytes", INTEGER, "Of the file.", false},
      {"sha256", STRING, "Of the file.", false}}},
    {"state",
     "bake",
     "A state was saved.",
     {{"file", STRING, "Its file.", false},
      {"frame", INTEGER, "The frame that it comes before.", false},
      {"step", INTEGER, "Of the simulation.", false},
      {"alive", MAYBE("integer"), "Particles; null where the state was kept.", false},
      {"bytes", INTEGER, "Of the file.", false},
      {"kept", BOOLEAN, "It was there already.", false},
      {"done", INTEGER, "States that are there.", false},
      {"total", INTEGER, "States that there will be.", false}}},
    {"frame",
     "compare",
     "A pair of pictures was compared.",
     {{"name", STRING, "Of the pair.", false},
      {"verdict", STRING, "Same, different, or why there is none.", false},
      {"message", STRING, "Why there are no numbers.", true},
      {"width", INTEGER, "Pixels.", true},
      {"height", INTEGER, "Pixels.", true},
      {"equal", BOOLEAN, "Every value is the same.", true},
      {"score", MAYBE("number"), "1 is just within the limits.", true},
      {"metrics", OBJECT, "Each by its name.", true},
      {"beyond", STRINGS, "Metrics beyond their limits.", true},
      {"worst_pixel", PAIR, "Its place.", true},
      {"window", OBJECT, "Where pixels that differ are densest.", true}}},
    {"result",
     "render",
     "A scene is done.",
     {{"scene", STRING, "As it was given.", false},
      {"output", MAYBE("string"), "As it was given.", false},
      {"first_file", MAYBE("string"), "Of the files.", false},
      {"frames", INTEGER, "That were drawn.", false},
      {"kept", INTEGER, "That were there already.", false},
      {"total_s", NUMBER, "Seconds.", false},
      {"setup_s", NUMBER, "Seconds; as the rest, with --stats.", true},
      {"steps", INTEGER, "Of the simulation.", true},
      {"pass_ms", OBJECT, "Times of the passes.", true},
      {"alive", INTEGER, "Particles at the end.", true},
      {"particle_capacity", INTEGER, "Slots.", true},
      {"particle_bytes", INTEGER, "Of the slots.", true},
      {"peak_memory_bytes", INTEGER, "Of the process.", true},
      {"techniques", STRING, "Of the stages.", true},
      {"chosen", OBJECTS, "Why these.", true},
      {"scene_hash", STRING, "SHA-256 of the scene and its files.", true},
      {"state", STRING, "The state hash at the end.", true}}},
    {"result",
     "bake",
     "All states are saved.",
     {{"scene", STRING, "As it was given.", false},
      {"output", STRING, "The folder.", false},
      {"motion", STRING, "The motion hash.", false},
      {"states", INTEGER, "That are there.", false},
      {"kept", INTEGER, "That were there already.", false},
      {"steps", INTEGER, "That were done.", false},
      {"bytes", INTEGER, "That were written.", false},
      {"total_s", NUMBER, "Seconds.", false}}},
    {"result",
     "compare",
     "All pairs are compared.",
     {{"reference", STRING, "As it was given.", false},
      {"test", STRING, "As it was given.", false},
      {"same", BOOLEAN, "Within the limits.", false},
      {"range", STRING, "ldr or hdr.", false},
      {"frames", INTEGER, "Pairs.", false},
      {"counts", OBJECT, "Of each verdict.", false},
      {"worst_frame", MAYBE("string"), "Its name.", false},
      {"metrics", OBJECT, "Worst and mean values, and limits.", false},
      {"flip_s", NUMBER, "Seconds, with --stats.", true},
      {"total_s", NUMBER, "Seconds, with --stats.", true}}},
    {"result",
     "plan",
     "What the clip costs.",
     {{"scene", STRING, "As it was given.", false},
      {"motion", STRING, "The motion hash.", false},
      {"techniques", STRING, "Of the stages.", false},
      {"parts", INTEGER, "Of the clip.", false},
      {"part_frames", INTEGER, "Frames of a part.", false},
      {"measured", OBJECT, "Seconds of processor time, and memory, at a frame.", false},
      {"tasks", OBJECTS, "What each draws, and what that costs.", false},
      {"cpu_s", NUMBER, "Seconds of processor time of all tasks.", false}}},
    {"result",
     "join",
     "The clip is whole.",
     {{"output", STRING, "As it was given.", false},
      {"frames", INTEGER, "Of the clip.", false},
      {"parts", INTEGER, "Of the clip.", false},
      {"was_whole", BOOLEAN, "It was there already.", false}}},
    {"result",
     "encode",
     "The clip is whole.",
     {{"output", STRING, "As it was given.", false},
      {"frames", INTEGER, "Of the clip.", false},
      {"range", PAIR, "The numbers of the first and the last frame.", false}}},
    {"test",
     "test, test report",
     "How a test ended. It is told when all tests have ended.",
     {{"name", STRING, "Of the test.", false},
      {"report", OBJECT, "What --json has of it.", false}}},
    {"result",
     "test, test report",
     "All tests are judged.",
     {{"kiln_report", INTEGER, "Version of the form of reports.", false},
      {"version", STRING, "Of kiln.", false},
      {"started", STRING, "When the first test began.", false},
      {"total_s", NUMBER, "Seconds.", false},
      {"code", INTEGER, "The exit code of the worst test.", false},
      {"counts", OBJECT, "Tests, and those of each verdict.", false}}},
    {"result",
     "devices",
     "What can render on this machine.",
     {{"devices", OBJECTS, "Each with its limits.", false},
      {"sandbox", OBJECT, "What the kernel has for --sandbox.", false},
      {"advice", STRING, "What is missing, and the package that brings it.", false}}},
    {"result",
     "every other command",
     "All is done, or pictures differ.",
     {{"code", INTEGER, "The exit code.", false}}},
    {"job_began",
     "render --batch",
     "A job has begun.",
     {{"name", STRING, "As the file of jobs calls it.", false},
      {"scene", STRING, "Its path.", false},
      {"output", STRING, "Where it writes.", false},
      {"process", INTEGER, "The number of its process.", false}}},
    {"job",
     "render --batch",
     "A job has ended, or was stopped with the batch.",
     {{"name", STRING, "As the file of jobs calls it.", false},
      {"scene", STRING, "Its path.", false},
      {"output", STRING, "Where it writes.", false},
      {"code", INTEGER, "Its exit code; 128 and the signal's number, where one ended it.", false},
      {"again", AGAIN, "Whether to run it again.", false},
      {"message", MAYBE("string"), "Why it failed.", false},
      {"total_s", NUMBER, "Seconds.", false},
      PLACE}},
    {"warning",
     "every command",
     "What a person is warned of.",
     {{"message", STRING, "A line.", false}}},
    {"error",
     "every command",
     "Why something failed; there may be several.",
     {{"code", INTEGER, "The exit code for it.", false},
      {"again", AGAIN, "Whether to try again ('kiln help exit-codes').", false},
      {"message", STRING, "A line for people.", false},
      PLACE}},
    {"ended",
     "every command",
     "The last event, also after a signal.",
     {{"code", INTEGER, "The exit code.", false},
      {"again", AGAIN, "Whether to run the command again.", false}}},
};
enum { EVENT_COUNT = sizeof events / sizeof *events };

bool help_write_events(FILE *out)
{
    fputs(
        "--events ndjson          on standard output, and what is printed for people on standard "
        "error;\n"
        "                         with '--output -' on standard error\n"
        "--events ndjson:FILE     at the end of a file\n"
        "--events ndjson:fd=N     to a descriptor that is open\n"
        "\n"
        "Where events of `ndjson` go to standard error, nothing else is printed there: errors and "
        "warnings\n"
        "are events, too.\n"
        "\n"
        "`openjd` instead of `ndjson` writes lines for engines of Open Job Description; what a "
        "person\n"
        "reads is printed as well, and the engine passes it on:\n"
        "\n"
        "openjd_progress: PERCENT   0, whole percents, and 100 when all is done\n"
        "openjd_status: MESSAGE     what the command does; warnings; last, where it failed, the "
        "exit\n"
        "                           code and whether to try again\n"
        "openjd_fail: MESSAGE       why something failed\n"
        "\n"
        "A line of `ndjson` is a JSON object. `event` is its name, `time` is UTC. Events and "
        "members may "
        "be\n"
        "added by later versions. 'kiln help events-schema' is the JSON schema.\n",
        out);
    for (size_t i = 0; i < EVENT_COUNT; i++) {
        const struct event *event = &events[i];
        fprintf(out, "\n%s (%s): %s\n", event->name, event->of, event->help);
        for (const struct member *member = event->members; member->name; member++) {
            const int length = fprintf(out, "    %-18s ", member->name);
            help_print_wrapped(out, member->help, (size_t)length, 23);
        }
    }
    return !ferror(out);
}

static void write_schema(FILE *out, const struct event *event)
{
    fprintf(out, "{\"description\": \"%s: %s\", \"type\": \"object\",\n", event->of, event->help);
    fprintf(out,
            " \"properties\": {\"event\": {\"const\": \"%s\"}, \"time\": {\"type\": \"string\"}",
            event->name);
    for (const struct member *member = event->members; member->name; member++)
        fprintf(out, ",\n  \"%s\": {\"description\": \"%s\", %s}", member->name, member->help,
                member->type);
    fputs("},\n \"required\": [\"event\", \"time\"", out);
    for (const struct member *member = event->members; member->name; member++) {
        if (!member->optional)
            fprintf(out, ", \"%s\"", member->name);
    }
    fputs("], \"additionalProperties\": false}", out);
}

bool help_write_events_schema(FILE *out)
{
    fputs("{\"$schema\": \"http://json-schema.org/draft-07/schema#\",\n"
          "\"title\": \"kiln event\",\n\"anyOf\": [\n",
          out);
    for (size_t i = 0; i < EVENT_COUNT; i++) {
        write_schema(out, &events[i]);
        fputs(i + 1 < EVENT_COUNT ? ",\n" : "\n", out);
    }
    fputs("]}\n", out);
    return !ferror(out);
}
