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
    {"file", STRING, "Path of the file in which the message names a place.", true},                \
        {"line", INTEGER, "Number of the line, from 1.", true},                                    \
    {                                                                                              \
        "column", INTEGER, "Number of the column, from 1.", true                                   \
    }

struct member {
    const char *name, *type, *help;
    bool optional;
};

struct event {
    const char *name, *commands, *help; /* commands: those that print it */
    struct member members[20]; /* besides `event` and `time`; a row without a name ends them */
};

static const struct event events[] = {
    {"started",
     "every command",
     "The command line was read.",
     {{"kiln", STRING, "Version and commit of kiln.", false},
      {"command", STRING, "Name of the command.", false},
      {"arguments", STRINGS, "Options and operands of the command line.", false},
      {"host", STRING, "Name of the machine.", false},
      {"process", INTEGER, "Process ID.", false}}},
    {"loaded",
     "render, bake, export, check, plan",
     "A scene was read, and its files were looked at.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"hash", STRING, "SHA-256 of the scene and its files.", false},
      {"size", PAIR, "Width and height in pixels.", false},
      {"fps", STRING, "Frames a second, as a fraction.", false},
      {"frames", INTEGER, "Frames of the whole clip.", false},
      {"steps", INTEGER, "Simulation steps of the whole clip.", false},
      {"particles", INTEGER, "Particles that may live at once.", false},
      {"memory_bytes", INTEGER,
       "Memory that a job on the device cpu is expected to take, in bytes.", false}}},
    {"device",
     "render",
     "A device was opened.",
     {{"index", INTEGER, "Number of the device in 'kiln devices'.", false},
      {"name", STRING, "Name of the device.", false},
      {"software", BOOLEAN, "Whether the device draws on the processor.", false}}},
    {"shard",
     "render",
     "This task draws one share of the clip.",
     {{"shard", INTEGER, "Number of the share, from 1.", false},
      {"shards", INTEGER, "Number of shares.", false},
      {"variable", MAYBE("string"), "Variable of the environment that named the share.", false}}},
    {"frame",
     "render",
     "A frame is done: its file is whole. Where frames have no files, the frame was drawn.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"frame", INTEGER, "Number of the frame.", false},
      {"done", INTEGER, "Frames of this job that are done.", false},
      {"total", INTEGER, "Frames of this job in all.", false},
      {"elapsed_s", NUMBER, "Seconds since the job began.", false},
      {"eta_s", MAYBE("number"), "Seconds that the job is expected to take from now on.", false},
      {"alive", INTEGER, "Particles that are alive.", false},
      {"state", STRING, "Hash of the simulation's state.", false},
      {"pass_ms", OBJECT, "Milliseconds of each pass.", false},
      {"file", STRING, "Path of the frame's file.", true},
      {"bytes", INTEGER, "Size of the file in bytes.", true},
      {"sha256", STRING, "SHA-256 of the file.", true}}},
    {"part",
     "render",
     "A part of a clip is whole. It waits in its file for the other parts.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"file", STRING, "Path of the part's file.", false},
      {"frames", PAIR, "Numbers of the first and the last frame.", false},
      {"bytes", INTEGER, "Size of the file in bytes.", false},
      {"sha256", STRING, "SHA-256 of the file.", false}}},
    {"file",
     "render",
     "A clip, or a file beside it, is whole.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"file", STRING, "Path of the file.", false},
      {"frames", PAIR, "Numbers of the first and the last frame.", false},
      {"bytes", INTEGER, "Size of the file in bytes.", false},
      {"sha256", STRING, "SHA-256 of the file.", false}}},
    {"state",
     "bake",
     "A state was saved.",
     {{"file", STRING, "Path of the state's file.", false},
      {"frame", INTEGER, "Number of the frame before which the state was saved.", false},
      {"step", INTEGER, "Number of the simulation step.", false},
      {"alive", MAYBE("integer"), "Particles that are alive; null for a state that was kept.",
       false},
      {"bytes", INTEGER, "Size of the file in bytes.", false},
      {"kept", BOOLEAN, "Whether the state was there already.", false},
      {"done", INTEGER, "States that are there.", false},
      {"total", INTEGER, "States that the folder will have in the end.", false}}},
    {"exported",
     "export",
     "A file of gas was written.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"gas", STRING, "Name of the domain.", false},
      {"file", STRING, "Path of the file.", false},
      {"frame", INTEGER, "Number of the frame.", false},
      {"bytes", INTEGER, "Size of the file in bytes.", false},
      {"voxels", INTEGER, "Active voxels of the density.", false},
      {"done", INTEGER, "Files of this job that are written.", false},
      {"total", INTEGER, "Files of this job in all.", false},
      {"elapsed_s", NUMBER, "Seconds since the job began.", false}}},
    {"frame",
     "compare",
     "A pair of pictures was compared.",
     {{"name", STRING, "Name of the pair.", false},
      {"verdict", STRING, "The verdict, or why there is none.", false},
      {"message", STRING, "Why there are no numbers.", true},
      {"width", INTEGER, "Width in pixels.", true},
      {"height", INTEGER, "Height in pixels.", true},
      {"equal", BOOLEAN, "Whether every value is the same.", true},
      {"score", MAYBE("number"), "Score of the pair; 1 is just within the limits.", true},
      {"metrics", OBJECT, "Values of the metrics by their names.", true},
      {"beyond", STRINGS, "Names of the metrics that are beyond their limits.", true},
      {"worst_pixel", PAIR, "Position of the pixel that differs most.", true},
      {"window", OBJECT, "The window in which pixels that differ are densest.", true},
      {"layers", OBJECTS, "The layers of EXR files, each with its verdict.", true}}},
    {"result",
     "render",
     "A scene is rendered.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"output", MAYBE("string"), "Path of the output, as it was given.", false},
      {"first_file", MAYBE("string"), "Path of the first file.", false},
      {"frames", INTEGER, "Frames that were drawn.", false},
      {"kept", INTEGER, "Frames that were there already.", false},
      {"total_s", NUMBER, "Seconds that the scene took.", false},
      {"setup_s", NUMBER, "Seconds of the set-up. This member and all below it come with --stats.",
       true},
      {"steps", INTEGER, "Simulation steps.", true},
      {"pass_ms", OBJECT, "Milliseconds of each pass.", true},
      {"alive", INTEGER, "Particles that are alive at the end.", true},
      {"particle_capacity", INTEGER, "Slots for particles.", true},
      {"particle_bytes", INTEGER, "Memory of the slots in bytes.", true},
      {"peak_memory_bytes", INTEGER, "Peak memory of the process in bytes.", true},
      {"techniques", STRING, "Technique of each stage.", true},
      {"chosen", OBJECTS, "Why each technique was chosen.", true},
      {"scene_hash", STRING, "SHA-256 of the scene and its files.", true},
      {"state", STRING, "Hash of the simulation's state at the end.", true}}},
    {"result",
     "bake",
     "All states are saved.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"output", STRING, "Path of the folder of states.", false},
      {"motion", STRING, "Hash of the scene's motion.", false},
      {"states", INTEGER, "States that are in the folder.", false},
      {"kept", INTEGER, "States that were there already.", false},
      {"steps", INTEGER, "Simulation steps that were done.", false},
      {"bytes", INTEGER, "Bytes that were written.", false},
      {"total_s", NUMBER, "Seconds of the whole run.", false}}},
    {"result",
     "export",
     "All files are written.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"output", STRING, "Path of the files, as it was given.", false},
      {"first_file", STRING, "Path of the first file.", false},
      {"frames", INTEGER, "Frames that were exported.", false},
      {"files", INTEGER, "Files that were written.", false},
      {"steps", INTEGER, "Simulation steps that were done.", false},
      {"bytes", INTEGER, "Bytes that were written.", false},
      {"total_s", NUMBER, "Seconds of the whole run.", false}}},
    {"result",
     "compare",
     "All pairs are compared.",
     {{"reference", STRING, "Path of the reference, as it was given.", false},
      {"test", STRING, "Path of the test, as it was given.", false},
      {"same", BOOLEAN, "Whether all pairs are the same within the limits.", false},
      {"range", STRING, "Range of light by which FLIP judged, ldr or hdr.", false},
      {"frames", INTEGER, "Number of pairs.", false},
      {"counts", OBJECT, "Number of pairs of each verdict.", false},
      {"worst_frame", MAYBE("string"), "Name of the worst pair.", false},
      {"metrics", OBJECT, "Worst and mean value, and limit, of each metric.", false},
      {"flip_s", NUMBER, "Seconds of FLIP, with --stats.", true},
      {"total_s", NUMBER, "Seconds of the whole run, with --stats.", true}}},
    {"result",
     "plan",
     "The costs of the clip are estimated.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"motion", STRING, "Hash of the scene's motion.", false},
      {"techniques", STRING, "Technique of each stage.", false},
      {"parts", INTEGER, "Parts of the clip.", false},
      {"part_frames", INTEGER, "Frames of a part.", false},
      {"measured", OBJECT, "Seconds of processor time, and memory, of the frame that was measured.",
       false},
      {"tasks", OBJECTS, "What each task draws and what it costs.", false},
      {"cpu_s", NUMBER, "Seconds of processor time of all tasks.", false}}},
    {"result",
     "join",
     "The clip is whole.",
     {{"output", STRING, "Path of the clip, as it was given.", false},
      {"frames", INTEGER, "Frames of the clip.", false},
      {"parts", INTEGER, "Parts of the clip.", false},
      {"was_whole", BOOLEAN, "Whether the clip was there already.", false}}},
    {"result",
     "encode",
     "The clip is whole.",
     {{"output", STRING, "Path of the clip, as it was given.", false},
      {"frames", INTEGER, "Frames of the clip.", false},
      {"range", PAIR, "Numbers of the first and the last frame.", false}}},
    {"test",
     "test, test report",
     "A test has ended. The event comes when all tests have ended.",
     {{"name", STRING, "Name of the test.", false},
      {"report", OBJECT, "The test's object in the output of --json.", false}}},
    {"result",
     "test, test report",
     "All tests are judged.",
     {{"kiln_report", INTEGER, "Version of the report's format.", false},
      {"version", STRING, "Version of kiln.", false},
      {"started", STRING, "Time at which the first test began.", false},
      {"total_s", NUMBER, "Seconds of the whole run.", false},
      {"code", INTEGER, "Exit code of the worst test.", false},
      {"counts", OBJECT, "Number of tests, and of tests with each verdict.", false}}},
    {"result",
     "devices",
     "The devices of this machine are listed.",
     {{"devices", OBJECTS, "The devices, each with its limits.", false},
      {"sandbox", OBJECT, "What the kernel offers for --sandbox.", false},
      {"advice", STRING, "What is missing, and the package that brings it.", false}}},
    {"result",
     "params",
     "The parameters of the scene are listed.",
     {{"scene", STRING, "Path of the scene, as it was given.", false},
      {"params", OBJECTS, "The parameters, each with its kind, value and range.", false},
      {"schema", OBJECT, "The JSON schema of files for --params.", false}}},
    {"result",
     "every other command",
     "The command has done its work, or pictures differ.",
     {{"code", INTEGER, "The exit code.", false}}},
    {"job_began",
     "render --batch",
     "A job has begun.",
     {{"name", STRING, "Name of the job in the file of jobs.", false},
      {"scene", STRING, "Path of the scene.", false},
      {"output", STRING, "Path of the job's output.", false},
      {"process", INTEGER, "Process ID of the job.", false}}},
    {"job",
     "render --batch",
     "A job has ended, or was stopped with the batch.",
     {{"name", STRING, "Name of the job in the file of jobs.", false},
      {"scene", STRING, "Path of the scene.", false},
      {"output", STRING, "Path of the job's output.", false},
      {"code", INTEGER,
       "Exit code of the job. For a job that a signal ended, it is 128 plus the signal's number.",
       false},
      {"again", AGAIN, "Whether to run the job again.", false},
      {"message", MAYBE("string"), "Why the job failed.", false},
      {"total_s", NUMBER, "Seconds of the job.", false},
      PLACE}},
    {"warning",
     "every command",
     "A person is warned of something.",
     {{"message", STRING, "The warning in one line.", false}}},
    {"error",
     "every command",
     "Something failed. There may be several errors.",
     {{"code", INTEGER, "Exit code for this error.", false},
      {"again", AGAIN, "Whether to try again ('kiln help exit-codes').", false},
      {"message", STRING, "The error in one line for a person.", false},
      PLACE}},
    {"ended",
     "every command",
     "The command ends. This is its last event, also after a signal.",
     {{"code", INTEGER, "The exit code.", false},
      {"again", AGAIN, "Whether to run the command again.", false}}},
};
enum { EVENT_COUNT = sizeof events / sizeof *events };

bool help_write_events(FILE *out)
{
    fputs("--events ndjson          writes events to standard output, and the text for people to "
          "standard\n"
          "                         error; with '--output -', events go to standard error\n"
          "--events ndjson:FILE     writes events at the end of a file\n"
          "--events ndjson:fd=N     writes events to a descriptor that is open\n"
          "\n"
          "Where events of `ndjson` go to standard error, nothing else is printed there: errors "
          "and warnings\n"
          "are events, too.\n"
          "\n"
          "`openjd` instead of `ndjson` writes lines for engines of Open Job Description. The text "
          "for people\n"
          "is printed as well, and the engine passes it on:\n"
          "\n"
          "openjd_progress: PERCENT   whole percents from 0 to 100; 100 means that all is done\n"
          "openjd_status: MESSAGE     what the command does, and warnings; after a failure, the "
          "last one\n"
          "                           has the exit code and says whether to try again\n"
          "openjd_fail: MESSAGE       why something failed\n"
          "\n"
          "A line of `ndjson` is a JSON object. `event` is its name, `time` is UTC. Later versions "
          "may add\n"
          "events and members. 'kiln help events-schema' prints the JSON schema.\n",
          out);
    for (size_t i = 0; i < EVENT_COUNT; i++) {
        const struct event *event = &events[i];
        fprintf(out, "\n%s (%s): %s\n", event->name, event->commands, event->help);
        for (const struct member *member = event->members; member->name; member++) {
            const int length = fprintf(out, "    %-18s ", member->name);
            help_print_wrapped(out, member->help, (size_t)length, 23);
        }
    }
    return !ferror(out);
}

static void write_schema(FILE *out, const struct event *event)
{
    fprintf(out, "{\"description\": \"%s: %s\", \"type\": \"object\",\n", event->commands,
            event->help);
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
