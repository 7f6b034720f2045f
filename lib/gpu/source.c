/* This file joins shader files by their includes and maps lines of the driver's messages back to
 * the files. A header with an include guard is not inserted again in the branch of #if where it was
 * inserted, nor in branches inside that one: a kernel would otherwise have millions of lines. In
 * other branches it is, since only the GLSL preprocessor knows which branches it reads. Files
 * without an include guard are inserted each time they are included. Lines with "#include <...>"
 * are for the C side of shared headers and are left out. */
#include "gpu/source.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/embedded.h"
#include "base/error.h"
#include "kiln_program.h"

enum { MAX_DEPTH = 32, MAX_FILE_SIZE = 1 << 20 };

/* Describes a file that is being joined and links to the file that includes it. */
struct open_file {
    const struct open_file *includer;
    const char *path;
    size_t line;     /* number of the line that is being read; for messages */
    bool in_comment; /* a block comment is open */
    bool is_guarded; /* the whole file lies in an include guard */
    size_t depth;    /* of #if at the line, with the include guard */
};

static bool is_safe_path(const char *path)
{
    return path[0] != '\0' && path[0] != '/' && !strstr(path, "..") &&
           strlen(path) < KILN_MAX_SOURCE_PATH;
}

/* Reads dir/path. *text stays NULL when there is no such file. */
static bool read_override(const char *dir, const char *path, char **text, struct kiln_error *error)
{
    *text = NULL;
    struct stat status;
    if (stat(dir, &status) != 0)
        return kiln_error_set_errno(error, KILN_IO, errno, "KILN_SHADER_DIR '%s'", dir);
    struct kiln_text name = {0};
    kiln_text_add(&name, "%s/%s", dir, path);
    if (name.failed) {
        kiln_text_free(&name);
        return kiln_error_no_memory(error, "shader %s", path);
    }
    bool ok = true;
    FILE *file = fopen(name.data, "rb");
    if (!file && errno != ENOENT && errno != ENOTDIR)
        ok = kiln_error_set_errno(error, KILN_IO, errno, "shader %s", name.data);
    if (file) {
        char *bytes = malloc(MAX_FILE_SIZE + 1);
        size_t size = bytes ? fread(bytes, 1, MAX_FILE_SIZE + 1, file) : 0;
        if (!bytes)
            ok = kiln_error_no_memory(error, "shader %s", name.data);
        else if (ferror(file))
            ok = kiln_error_set_errno(error, KILN_IO, errno, "shader %s", name.data);
        else if (size > MAX_FILE_SIZE || memchr(bytes, '\0', size))
            ok = kiln_error_set(error, KILN_IO,
                                "shader %s: a text file of at most %d bytes is allowed", name.data,
                                MAX_FILE_SIZE);
        else
            bytes[size] = '\0';
        if (ok)
            *text = bytes;
        else
            free(bytes);
        fclose(file);
    }
    kiln_text_free(&name);
    return ok;
}

/* Returns the text of a file, or NULL with an error. The caller frees *owned, which is NULL if the
 * text is embedded. */
static const char *find_text(const struct open_file *open_file, char **owned,
                             struct kiln_error *error)
{
    *owned = NULL;
    if (is_safe_path(open_file->path)) {
        const char *dir = kiln_environment("KILN_SHADER_DIR");
        if (dir && !read_override(dir, open_file->path, owned, error))
            return NULL;
        const char *text =
            *owned ? *owned : kiln_embedded_find(kiln_embedded_shaders, open_file->path);
        if (text)
            return text;
    }
    if (open_file->includer)
        kiln_error_set(error, KILN_DEVICE_FAILED,
                       "shaders/%s:%zu: includes \"%s\", which is not a file under shaders/",
                       open_file->includer->path, open_file->includer->line, open_file->path);
    else
        kiln_error_set(error, KILN_DEVICE_FAILED, "shaders/%s: there is no such file",
                       open_file->path);
    return NULL;
}

static bool check_chain(const struct open_file *open_file, struct kiln_error *error)
{
    size_t depth = 0;
    for (const struct open_file *p = open_file->includer; p; p = p->includer, depth++)
        if (strcmp(p->path, open_file->path) == 0)
            return kiln_error_set(
                error, KILN_DEVICE_FAILED, "shaders/%s:%zu: includes \"%s\", which includes itself",
                open_file->includer->path, open_file->includer->line, open_file->path);
    if (depth >= MAX_DEPTH)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "shaders/%s:%zu: includes are nested deeper than %d",
                              open_file->includer->path, open_file->includer->line, MAX_DEPTH);
    return true;
}

/* Returns the number of a file, or KILN_MAX_SOURCE_FILES when there are too many files. */
static size_t file_number(struct kiln_source *source, const char *path)
{
    for (size_t i = 0; i < source->file_count; i++)
        if (strcmp(source->files[i], path) == 0)
            return i;
    if (source->file_count == KILN_MAX_SOURCE_FILES)
        return KILN_MAX_SOURCE_FILES;
    snprintf(source->files[source->file_count], KILN_MAX_SOURCE_PATH, "%s", path);
    return source->file_count++;
}

/* Returns whether a file has been inserted where the preprocessor has read it if it reads the
 * present line: in the present branch of #if or in one around it. */
static bool was_inserted(const struct kiln_source *source, const char *path)
{
    size_t in = 0;
    for (size_t i = 0; i < source->file_count; i++)
        if (strcmp(source->files[i], path) == 0)
            in = source->inserted_in[i];
    bool found = in == KILN_SOURCE_WHOLE;
    for (size_t i = 0; i < source->branch_count && i < KILN_MAX_SOURCE_BRANCHES; i++)
        found = found || in == source->branches[i];
    return found;
}

/* Notes that a file with an include guard is in the text, in the present branch of #if. */
static void note_inserted(struct kiln_source *source, size_t file)
{
    const size_t count = source->branch_count;
    if (count <= KILN_MAX_SOURCE_BRANCHES)
        source->inserted_in[file] = count > 0 ? source->branches[count - 1] : KILN_SOURCE_WHOLE;
}

/* Records the file and line that the next lines of the joined text come from. */
static void begin_piece(struct kiln_source *source, size_t file, size_t file_line)
{
    if (source->piece_count == source->piece_capacity) {
        size_t capacity = source->piece_capacity ? 2 * source->piece_capacity : 32;
        void *pieces = realloc(source->pieces, capacity * sizeof *source->pieces);
        if (!pieces) {
            source->text.failed = true;
            return;
        }
        source->pieces = pieces;
        source->piece_capacity = capacity;
    }
    source->pieces[source->piece_count++] = (struct kiln_source_piece){
        .line = source->line_count + 1, .file_line = file_line, .file = file};
}

static void put_line(struct kiln_source *source, const char *line, size_t length)
{
    kiln_text_add(&source->text, "%.*s\n", (int)length, line);
    source->line_count++;
}

/* Tracks block comments through one line, so that an #include inside a comment is ignored. */
static void follow_comments(struct open_file *open_file, const char *line, size_t length)
{
    for (size_t i = 0; i + 1 < length; i++) {
        if (open_file->in_comment) {
            if (line[i] == '*' && line[i + 1] == '/') {
                open_file->in_comment = false;
                i++;
            }
        } else if (line[i] == '/' && line[i + 1] == '/') {
            return;
        } else if (line[i] == '/' && line[i + 1] == '*') {
            open_file->in_comment = true;
            i++;
        }
    }
}

static const char *skip_blanks(const char *at, const char *end)
{
    while (at < end && isblank((unsigned char)*at))
        at++;
    return at;
}

/* Returns the end of a directive's word, such as "include" or the "if" of "ifdef", or NULL if a
 * line has no such directive. */
static const char *after_directive(const char *line, size_t length, const char *word)
{
    const char *const end = line + length;
    const char *at = skip_blanks(line, end);
    const size_t word_length = strlen(word);
    if (at == end || *at != '#')
        return NULL;
    at = skip_blanks(at + 1, end);
    if ((size_t)(end - at) < word_length || strncmp(at, word, word_length) != 0)
        return NULL;
    return at + word_length;
}

/* Returns whether a file's first and second directive are an include guard without #else, whose
 * #endif is its last directive. The file's comments must not look like directives. */
static bool is_guarded(const char *text)
{
    size_t depth = 0, count = 0;
    bool guarded = true;
    for (const char *line = text; guarded && *line;) {
        const size_t length = strcspn(line, "\n");
        if (after_directive(line, length, "")) {
            count++;
            guarded = (count != 1 || after_directive(line, length, "ifndef")) &&
                      (count != 2 || after_directive(line, length, "define")) &&
                      (count == 1 || depth > 0) &&
                      (depth > 1 || !after_directive(line, length, "el"));
            depth += after_directive(line, length, "if") != NULL;
            depth -= after_directive(line, length, "endif") != NULL;
        }
        line += length + (line[length] == '\n');
    }
    return guarded && count > 2 && depth == 0;
}

/* Sets the innermost branch of #if to one that was not seen before. */
static void begin_branch(struct kiln_source *source)
{
    const size_t count = source->branch_count;
    source->last_branch++;
    if (count > 0 && count <= KILN_MAX_SOURCE_BRANCHES)
        source->branches[count - 1] = source->last_branch;
}

/* Follows the branches of #if through one line. An include guard is no branch. */
static void follow_branches(struct kiln_source *source, struct open_file *open_file,
                            const char *line, size_t length)
{
    const size_t outermost = open_file->is_guarded ? 1 : 0;
    if (after_directive(line, length, "if")) {
        open_file->depth++;
        if (open_file->depth > outermost) {
            source->branch_count++;
            begin_branch(source);
        }
    } else if (open_file->depth > outermost && after_directive(line, length, "el")) {
        begin_branch(source);
    } else if (open_file->depth > 0 && after_directive(line, length, "endif")) {
        source->branch_count -= open_file->depth > outermost;
        open_file->depth--;
    }
}

enum directive { NOT_INCLUDE, INCLUDE_OURS, INCLUDE_SYSTEM, INCLUDE_MALFORMED };

/* Recognises an include and copies its path. */
static enum directive read_include(const char *line, size_t length, char path[KILN_MAX_SOURCE_PATH])
{
    const char *const end = line + length;
    const char *at = after_directive(line, length, "include");
    if (!at)
        return NOT_INCLUDE;
    at = skip_blanks(at, end);
    if (at < end && *at == '<')
        return INCLUDE_SYSTEM;
    if (at == end || *at++ != '"')
        return INCLUDE_MALFORMED;
    const char *close = memchr(at, '"', (size_t)(end - at));
    if (!close || close - at >= KILN_MAX_SOURCE_PATH)
        return INCLUDE_MALFORMED;
    memcpy(path, at, (size_t)(close - at));
    path[close - at] = '\0';
    return INCLUDE_OURS;
}

static bool add_file(struct kiln_source *source, struct open_file *open_file,
                     struct kiln_error *error);

static bool add_line(struct kiln_source *source, struct open_file *open_file, size_t file,
                     const char *line, size_t length, struct kiln_error *error)
{
    char path[KILN_MAX_SOURCE_PATH];
    enum directive kind = open_file->in_comment ? NOT_INCLUDE : read_include(line, length, path);
    switch (kind) {
    case INCLUDE_MALFORMED:
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "shaders/%s:%zu: #include must be followed by \"path\"",
                              open_file->path, open_file->line);
    case INCLUDE_SYSTEM:
        put_line(source, "", 0);
        return true;
    case INCLUDE_OURS: {
        if (was_inserted(source, path)) {
            put_line(source, "", 0);
            return true;
        }
        struct open_file included = {.includer = open_file, .path = path};
        if (!add_file(source, &included, error))
            return false;
        begin_piece(source, file, open_file->line + 1);
        return true;
    }
    case NOT_INCLUDE:
        break;
    }
    if (!open_file->in_comment)
        follow_branches(source, open_file, line, length);
    follow_comments(open_file, line, length);
    put_line(source, line, length);
    return true;
}

static bool add_file(struct kiln_source *source, struct open_file *open_file,
                     struct kiln_error *error)
{
    if (!check_chain(open_file, error))
        return false;
    char *owned;
    const char *text = find_text(open_file, &owned, error);
    if (!text)
        return false;
    bool ok = true;
    const size_t file = file_number(source, open_file->path);
    if (file == KILN_MAX_SOURCE_FILES)
        ok = kiln_error_set(error, KILN_DEVICE_FAILED,
                            "shaders/%s: a program may have at most %d files", open_file->path,
                            KILN_MAX_SOURCE_FILES);
    else
        begin_piece(source, file, 1);
    open_file->is_guarded = is_guarded(text);
    if (ok && open_file->is_guarded)
        note_inserted(source, file);
    for (const char *line = text; ok && *line;) {
        const char *end = strchr(line, '\n');
        size_t length = end ? (size_t)(end - line) : strlen(line);
        open_file->line++;
        ok = add_line(source, open_file, file, line, length, error);
        line += length + (end != NULL);
    }
    free(owned);
    if (ok && open_file->in_comment)
        ok = kiln_error_set(error, KILN_DEVICE_FAILED, "shaders/%s: a comment is not closed",
                            open_file->path);
    return ok;
}

static void add_lines(struct kiln_source *source, const char *text)
{
    while (*text) {
        size_t length = strcspn(text, "\n");
        put_line(source, text, length);
        text += length + (text[length] == '\n');
    }
}

bool kiln_source_load(struct kiln_source *source, const char *file, const char *defines,
                      struct kiln_error *error)
{
    begin_piece(source, KILN_MAX_SOURCE_FILES, 1);
    add_lines(source, "#version 430 core");
    add_lines(source, defines ? defines : "");
    struct open_file open_file = {.includer = NULL, .path = file};
    if (!add_file(source, &open_file, error))
        return false;
    if (source->text.failed)
        return kiln_error_no_memory(error, "shader %s", file);
    return true;
}

void kiln_source_finish(struct kiln_source *source)
{
    kiln_text_free(&source->text);
    free(source->pieces);
    *source = (struct kiln_source){.line_count = 0};
}

/* Adds "shaders/file:line: " for a line of the joined text. Returns false when the text has no such
 * line. */
static bool add_place(const struct kiln_source *source, size_t line, struct kiln_text *out)
{
    size_t i = source->piece_count;
    while (i > 0 && source->pieces[i - 1].line > line)
        i--;
    if (i == 0 || line > source->line_count)
        return false;
    const struct kiln_source_piece *piece = &source->pieces[i - 1];
    const size_t file_line = piece->file_line + (line - piece->line);
    if (piece->file == KILN_MAX_SOURCE_FILES)
        kiln_text_add(out, "(version and defines):%zu: ", file_line);
    else
        kiln_text_add(out, "shaders/%s:%zu: ", source->files[piece->file], file_line);
    return true;
}

/* Reads a number of at most nine digits and returns its end, or NULL if there are no digits. */
static const char *read_number(const char *at, const char *end, size_t *number)
{
    const char *start = at;
    *number = 0;
    while (at < end && isdigit((unsigned char)*at) && at - start < 9)
        *number = *number * 10 + (size_t)(*at++ - '0');
    return at == start ? NULL : at;
}

void kiln_source_map_line(const struct kiln_source *source, const char *line, size_t length,
                          struct kiln_text *out)
{
    static const char prefix[] = "ERROR: ";
    const char *const end = line + length;
    const char *at = line;
    if (length > sizeof prefix && strncmp(line, prefix, sizeof prefix - 1) == 0)
        at += sizeof prefix - 1;
    size_t string, number;
    const char *colon = read_number(at, end, &string);
    const char *after = NULL;
    if (colon && colon < end && (*colon == ':' || *colon == '('))
        after = read_number(colon + 1, end, &number);
    if (!after || string != 0 || !add_place(source, number, out)) {
        kiln_text_add(out, "%.*s", (int)length, line);
        return;
    }
    if (*colon == '(' && after < end && *after == ')')
        after++;
    else if (after < end && *after == '(' && memchr(after, ')', (size_t)(end - after)))
        after = (const char *)memchr(after, ')', (size_t)(end - after)) + 1; /* Mesa's column */
    while (after < end && (isblank((unsigned char)*after) || *after == ':'))
        after++;
    kiln_text_add(out, "%.*s", (int)(end - after), after);
}
