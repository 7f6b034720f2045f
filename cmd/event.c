/* Writes events, one a line, as JSON or in the format of Open Job Description. The stream belongs
 * to the process, as standard output does: signal handlers and the functions of report.c write to
 * it, too, so it is a variable of this file. */
#include "event.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <poll.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "build.h"
#include "json_output.h"
#include "report.h"

enum form { FORM_NDJSON, FORM_OPENJD, FORM_PLAIN };

/* The forms of --events, and the character that a file of each begins with. */
static const struct {
    const char *name;
    char first;
} forms[] = {[FORM_NDJSON] = {"ndjson", '{'}, [FORM_OPENJD] = {"openjd", 'o'}};

static struct {
    FILE *out; /* NULL: there is no stream */
    enum form form;
    bool on_stdout, on_stderr; /* which standard stream was taken for events */
    bool stdout_failed;
    bool has_result;       /* the event `result` was written */
    const char *name;      /* name of the stream, for messages */
    uint64_t last_percent; /* the progress that was written last */
    pid_t owner_pid;       /* the process that opened the stream; a forked child has another id */
} stream;

enum { LINE_SIZE = 1 << 16, TIME_SIZE = 32 };

/* ---- Times ---------------------------------------------------------------------------------- */

static char *add_digits(char *out, unsigned value, unsigned divisor)
{
    for (; divisor > 0; divisor /= 10)
        *out++ = (char)('0' + value / divisor % 10);
    return out;
}

/* Formats the present time as "2026-11-24T12:00:00.123Z" by arithmetic alone, since a signal
 * handler may not call gmtime. The date is computed in years that begin in March, so that the leap
 * day is the last day of a year. */
static void format_time(char out[TIME_SIZE])
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    const unsigned seconds = (unsigned)(now.tv_sec % 86400);
    const unsigned days = (unsigned)(now.tv_sec / 86400) + 719468; /* since 1 March of the year 0 */
    const unsigned era = days / 146097, day_of_era = days % 146097;
    const unsigned year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36524 - day_of_era / 146096) / 365;
    const unsigned day_of_year =
        day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    const unsigned months = (5 * day_of_year + 2) / 153; /* months since March */
    const unsigned month = months < 10 ? months + 3 : months - 9;
    out = add_digits(out, year_of_era + era * 400 + (month <= 2), 1000);
    *out++ = '-';
    out = add_digits(out, month, 10);
    *out++ = '-';
    out = add_digits(out, day_of_year - (153 * months + 2) / 5 + 1, 10);
    *out++ = 'T';
    out = add_digits(out, seconds / 3600, 10);
    *out++ = ':';
    out = add_digits(out, seconds / 60 % 60, 10);
    *out++ = ':';
    out = add_digits(out, seconds % 60, 10);
    *out++ = '.';
    out = add_digits(out, (unsigned)(now.tv_nsec / 1000000), 100);
    *out++ = 'Z';
    *out = '\0';
}

/* ---- Lines ---------------------------------------------------------------------------------- */

bool events_are_wanted(void)
{
    return stream.out && stream.form != FORM_PLAIN;
}

bool events_are_open(void)
{
    return stream.out && stream.form != FORM_OPENJD;
}

bool events_use_stdout(void)
{
    return events_are_open() && stream.on_stdout;
}

static bool write_nowhere(void *sink, const char *bytes, size_t length)
{
    (void)sink;
    (void)bytes;
    (void)length;
    return true;
}

struct kiln_json event_begin(const char *name)
{
    struct kiln_json json = kiln_json_to_file(stream.out);
    json.one_line = true;
    stream.has_result = stream.has_result || strcmp(name, "result") == 0;
    if (events_are_open())
        flockfile(stream.out);
    else
        json.write = write_nowhere;
    kiln_json_begin_object(&json, NULL);
    kiln_json_string(&json, "event", name);
    if (stream.form != FORM_PLAIN) {
        char time[TIME_SIZE];
        format_time(time);
        kiln_json_string(&json, "time", time);
    }
    return json;
}

void event_end(struct kiln_json *json)
{
    kiln_json_end(json);
    kiln_json_finish(json);
    if (!events_are_open())
        return;
    fflush(stream.out);
    funlockfile(stream.out);
}

bool events_failed(void)
{
    return stream.out && ferror(stream.out);
}

bool events_failed_on_stdout(void)
{
    return stream.stdout_failed;
}

/* ---- Lines of Open Job Description ---------------------------------------------------------- */

static bool is_openjd(void)
{
    return stream.out && stream.form == FORM_OPENJD;
}

void event_openjd(const char *keyword, const char *format, ...)
{
    char text[KILN_MESSAGE_SIZE], shown[KILN_MESSAGE_SIZE];
    if (!is_openjd())
        return;
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    kiln_shown(shown, sizeof shown, text);
    fprintf(stream.out, "openjd_%s: %s\n", keyword, shown);
    fflush(stream.out);
}

void event_progress(uint64_t done, uint64_t total, const char *status)
{
    const uint64_t percent = total > 0 ? done * 100 / total : 0;
    if (!is_openjd() || percent <= stream.last_percent || percent >= 100)
        return;
    stream.last_percent = percent;
    event_openjd("progress", "%" PRIu64, percent);
    event_openjd("status", "%s", status);
}

/* ---- Events of every command ---------------------------------------------------------------- */

static void write_started(const struct command *command, const struct arguments *arguments)
{
    char host[256] = "";
    event_openjd("progress", "0");
    event_openjd("status", "kiln %s: %s", build_name(), command->name);
    gethostname(host, sizeof host - 1);
    struct kiln_json json = event_begin("started");
    kiln_json_string(&json, "kiln", build_name());
    kiln_json_string(&json, "command", command->name);
    kiln_json_strings(&json, "arguments", arguments->argv, arguments->argc);
    kiln_json_string(&json, "host", host);
    kiln_json_int(&json, "process", getpid());
    event_end(&json);
}

/* Returns the length of the file's name in a message "FILE:LINE:COLUMN: ..."; 0 for one without a
 * place. */
static size_t find_place(const char *message, unsigned long *line, unsigned long *column)
{
    for (const char *at = message; (at = strchr(at, ':')); at++) {
        char *end;
        if (at == message || at[1] < '1' || at[1] > '9')
            continue;
        *line = strtoul(at + 1, &end, 10);
        if (end[0] != ':' || end[1] < '1' || end[1] > '9')
            continue;
        *column = strtoul(end + 1, &end, 10);
        if (end[0] == ':' && end[1] == ' ')
            return (size_t)(at - message);
    }
    return 0;
}

void event_add_place(struct kiln_json *json, const char *message)
{
    unsigned long line, column;
    const size_t length = find_place(message, &line, &column);
    if (length == 0)
        return;
    kiln_json_format(json, "file", "%.*s", (int)length, message);
    kiln_json_uint(json, "line", line);
    kiln_json_uint(json, "column", column);
}

void event_error(int code, const char *message)
{
    event_openjd("fail", "%s", message);
    if (!events_are_wanted())
        return;
    struct kiln_json json = event_begin("error");
    kiln_json_int(&json, "code", code);
    kiln_json_string(&json, "again", exit_code_again(code));
    kiln_json_string(&json, "message", message);
    event_add_place(&json, message);
    event_end(&json);
}

void event_warning(const char *message)
{
    event_openjd("status", "warning: %s", message);
    if (!events_are_wanted())
        return;
    struct kiln_json json = event_begin("warning");
    kiln_json_string(&json, "message", message);
    event_end(&json);
}

void event_loaded(const char *scene, const struct kiln_scene_info *info)
{
    event_openjd("status", "%s: %" PRIu32 " frames of %" PRIu32 "x%" PRIu32, scene, info->frames,
                 info->width, info->height);
    if (!events_are_wanted())
        return;
    struct kiln_json json = event_begin("loaded");
    kiln_json_string(&json, "scene", scene);
    kiln_json_string(&json, "hash", info->hash);
    kiln_json_pair(&json, "size", info->width, info->height);
    kiln_json_format(&json, "fps", "%u/%u", info->fps_num, info->fps_den);
    kiln_json_uint(&json, "frames", info->frames);
    kiln_json_uint(&json, "steps", info->steps);
    kiln_json_uint(&json, "particles", info->particle_capacity);
    kiln_json_uint(&json, "memory_bytes", info->memory_bytes);
    event_end(&json);
}

/* ---- The end without stdio ------------------------------------------------------------------ */

struct line {
    char text[4096];
    size_t length;
};

static void add(struct line *line, const char *text)
{
    for (; *text && line->length < sizeof line->text - 8; text++)
        line->text[line->length++] = *text;
}

/* Adds a message up to the end of its line. Its control characters were escaped before. */
static void add_message(struct line *line, const char *text, bool is_quoted)
{
    for (; *text && *text != '\n' && line->length < sizeof line->text - 256; text++) {
        if (is_quoted && (*text == '"' || *text == '\\'))
            line->text[line->length++] = '\\';
        line->text[line->length++] = *text;
    }
}

static void add_quoted(struct line *line, const char *text)
{
    add(line, "\"");
    add_message(line, text, true);
    add(line, "\"");
}

static void add_code(struct line *line, int code)
{
    char digits[4];
    *add_digits(digits, (unsigned)code, code >= 100 ? 100 : code >= 10 ? 10 : 1) = '\0';
    add(line, digits);
}

static void add_event(struct line *line, const char *name, int code)
{
    char time[TIME_SIZE];
    format_time(time);
    add(line, "{\"event\": \"");
    add(line, name);
    add(line, "\", \"time\": \"");
    add(line, time);
    add(line, "\", \"code\": ");
    add_code(line, code);
    add(line, ", \"again\": ");
    add_quoted(line, exit_code_again(code));
}

static void add_last_events(struct line *line, const char *message, int code)
{
    add_event(line, "error", code);
    add(line, ", \"message\": ");
    add_quoted(line, message);
    add(line, "}\n");
    add_event(line, "ended", code);
    add(line, "}\n");
}

static void add_last_lines(struct line *line, const char *message, int code)
{
    add(line, "openjd_fail: ");
    add_message(line, message, false);
    add(line, "\nopenjd_status: exit code ");
    add_code(line, code);
    add(line, ", again: ");
    add(line, exit_code_again(code));
    add(line, "\n");
}

void events_write_final(const char *message, int code)
{
    if (!events_are_wanted() || getpid() != stream.owner_pid)
        return;
    struct line line = {.length = 0};
    if (is_openjd())
        add_last_lines(&line, message, code);
    else
        add_last_events(&line, message, code);
    const int file = fileno(stream.out);
    if (poll(&(struct pollfd){.fd = file, .events = POLLOUT}, 1, 0) == 1) {
        const ssize_t written = write(file, line.text, line.length);
        (void)written;
    }
}

/* ---- The stream ----------------------------------------------------------------------------- */

static int report_bad_value(const struct command *command, const char *value)
{
    char shown[256];
    kiln_shown(shown, sizeof shown, value);
    return report(KILN_USAGE,
                  "%s: --events: found '%s'; expected ndjson or openjd, or one of them with :FILE "
                  "or :fd=N, where N is a descriptor that is open for writing",
                  command->name, shown);
}

static int report_io(const struct command *command, const char *name, const char *why)
{
    char shown[KILN_PATH_SIZE];
    kiln_shown(shown, sizeof shown, name);
    return report(KILN_IO, "%s: --events: %s: %s", command->name, shown, why);
}

/* Returns whether events may be appended to a file: it is empty, or begins with events of this
 * form. */
static bool holds_events(int file)
{
    char first = forms[stream.form].first;
    struct stat status;
    return fstat(file, &status) == 0 && !S_ISDIR(status.st_mode) &&
           (!S_ISREG(status.st_mode) || pread(file, &first, 1, 0) >= 0) &&
           first == forms[stream.form].first;
}

static int open_file(const struct command *command, const char *path)
{
    /* A regular file is opened for reading, too, so that holds_events can read it. A FIFO is opened
     * for writing alone, so that open waits for its reader. */
    struct stat status;
    const bool is_there = stat(path, &status) == 0;
    const int way = is_there && !S_ISREG(status.st_mode) ? O_WRONLY : O_RDWR;
    const int file = open(path, way | O_APPEND | O_CREAT | O_CLOEXEC | O_NOCTTY, 0666);
    if (file < 0)
        return report_io(command, path, strerror(errno)); /* NOLINT(concurrency-mt-unsafe) */
    if (!holds_events(file)) {
        close(file);
        return report(KILN_USAGE,
                      "%s: --events: %s: the file exists and holds no events, so nothing is added "
                      "to it; name another file",
                      command->name, path);
    }
    stream.out = fdopen(file, "a");
    return stream.out ? 0 : report_no_memory();
}

static int open_descriptor(const struct command *command, const char *value, const char *number)
{
    uint64_t file;
    int mode = -1;
    if (kiln_text_to_uint64(number, &file) && file <= INT32_MAX)
        mode = fcntl((int)file, F_GETFL);
    if (mode < 0 || (mode & O_ACCMODE) == O_RDONLY)
        return report_bad_value(command, value);
    if (file > STDERR_FILENO)
        fcntl((int)file, F_SETFD, FD_CLOEXEC); /* child processes do not inherit it */
    stream.out = file == STDOUT_FILENO   ? stdout
                 : file == STDERR_FILENO ? stderr
                                         : fdopen((int)file, "w");
    return stream.out ? 0 : report_no_memory();
}

/* Sets the form that a value of --events begins with. Returns the rest of the value; NULL if it
 * begins with no form. */
static const char *read_form(const char *value)
{
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        const char *rest = value + strlen(forms[i].name);
        stream.form = (enum form)i;
        if (strncmp(value, forms[i].name, strlen(forms[i].name)) == 0 &&
            (!*rest || (*rest == ':' && rest[1])))
            return rest;
    }
    return NULL;
}

/* Takes a standard stream for lines of JSON. Text for people that is printed to its descriptor goes
 * to the descriptor `target`. */
static int redirect(int descriptor, int target)
{
    const int events = fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    fflush(stdout);
    FILE *out = events >= 0 && dup2(target, descriptor) >= 0 ? fdopen(events, "w") : NULL;
    stream.out = NULL; /* report must not write to a stream that failed */
    if (!out)
        return report(KILN_IO, "--events: %s: %s", stream.name,
                      strerror(errno)); /* NOLINT(concurrency-mt-unsafe) */
    stream.out = out;
    stream.on_stdout = descriptor == STDOUT_FILENO;
    stream.on_stderr = descriptor == STDERR_FILENO;
    return 0;
}

static int redirect_standard_stream(void)
{
    if (stream.form != FORM_NDJSON || (stream.out != stdout && stream.out != stderr))
        return 0;
    if (stream.out == stdout)
        return redirect(STDOUT_FILENO, STDERR_FILENO);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    const int code = redirect(STDERR_FILENO, nowhere);
    close(nowhere);
    return code;
}

/* Restores the standard stream that was taken for events. */
static void restore_standard_stream(FILE *out)
{
    fflush(stdout);
    if (stream.on_stdout)
        dup2(fileno(out), STDOUT_FILENO);
    if (stream.on_stderr)
        dup2(fileno(out), STDERR_FILENO);
}

/* Returns whether '--output -' sends a clip to standard output. */
static bool is_clip_on_stdout(const struct arguments *arguments)
{
    const struct option_use *output = arguments_last(arguments, "output");
    return output && output->text && strcmp(output->text, "-") == 0;
}

int events_open(const struct command *command, const struct arguments *arguments)
{
    const struct option_use *use = arguments_last(arguments, "events");
    if (!use)
        return 0;
    const char *value = use->text, *rest = read_form(value);
    int code = 0;
    if (!rest) {
        code = report_bad_value(command, value);
    } else if (!*rest) {
        stream.out = is_clip_on_stdout(arguments) ? stderr : stdout;
        stream.name = stream.out == stderr ? "standard error" : "standard output";
    } else if (strncmp(rest, ":fd=", 4) == 0) {
        stream.name = value;
        code = open_descriptor(command, value, rest + 4);
    } else {
        stream.name = rest + 1;
        code = open_file(command, rest + 1);
    }
    if (code == 0 && stream.out == stdout && is_clip_on_stdout(arguments)) {
        stream.out = NULL;
        code = report(KILN_USAGE,
                      "%s: --events: '%s' and '--output -' would both write to standard output; "
                      "without ':fd=1' events go to standard error",
                      command->name, value);
    }
    if (code == 0)
        code = redirect_standard_stream();
    if (code)
        return code;
    /* A buffer makes each event a single write. Standard error has none, so messages appear at
     * once. */
    if (stream.out != stderr)
        setvbuf(stream.out, NULL, _IOFBF, LINE_SIZE);
    stream.owner_pid = getpid();
    write_started(command, arguments);
    return 0;
}

static void open_plain(FILE *out)
{
    stream.out = out;
    stream.form = FORM_PLAIN;
    stream.on_stdout = out == stdout;
    stream.name = "standard output";
}

void events_open_plain(void)
{
    if (!stream.out)
        open_plain(stdout);
}

int events_open_json(const char *command, const struct arguments *arguments)
{
    FILE *out;
    const int code = json_output_open(command, arguments, &out);
    if (out)
        open_plain(out);
    return code;
}

/* Writes the exit code. A command that finished without an event `result` gets one. */
static void write_ended(int code)
{
    if (code == 0)
        event_openjd("progress", "100");
    else
        event_openjd("status", "exit code %d, again: %s", code, exit_code_again(code));
    if (!stream.has_result && exit_code_has_result(code)) {
        struct kiln_json json = event_begin("result");
        kiln_json_int(&json, "code", code);
        event_end(&json);
    }
    struct kiln_json json = event_begin("ended");
    kiln_json_int(&json, "code", code);
    kiln_json_string(&json, "again", exit_code_again(code));
    event_end(&json);
}

int events_close(int code)
{
    if (!events_are_wanted()) {
        stream.out = NULL;
        return code;
    }
    write_ended(code);
    const bool failed = ferror(stream.out) != 0;
    FILE *out = stream.out;
    stream.out = NULL;
    if (out == stdout || out == stderr) /* report_finish checks standard output */
        return code;
    restore_standard_stream(out); /* report_finish finds out why standard output failed */
    const bool is_whole = fclose(out) == 0 && !failed;
    stream.stdout_failed = stream.on_stdout && !is_whole;
    if (stream.on_stdout || is_whole)
        return code;
    const int reported = report(KILN_IO, "--events: %s cannot be written", stream.name);
    return code && code != KILN_READER_GONE ? code : reported;
}
