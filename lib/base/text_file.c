/* A text file that a program prints into, and that appears under its name when it is whole. */
#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/error.h"
#include "base/temporary.h"
#include "kiln_program.h"

struct kiln_text_file {
    struct kiln_temporary file;
    FILE *out;
    bool overwrite;
};

struct kiln_text_file *kiln_text_file_open(const char *path, bool overwrite,
                                           struct kiln_error *error)
{
    struct kiln_text_file *text = calloc(1, sizeof *text);
    if (!text) {
        kiln_error_no_memory(error, "%s", path);
        return NULL;
    }
    text->overwrite = overwrite;
    if (!kiln_target_check(path, overwrite, error) || !kiln_make_parent_folders(path, error) ||
        (kiln_temporary_sweep(path), !kiln_temporary_open(&text->file, path, error))) {
        free(text);
        return NULL;
    }
    const int copy = dup(text->file.file); /* fclose closes it; the temporary file keeps its own */
    text->out = copy >= 0 ? fdopen(copy, "w") : NULL;
    if (text->out)
        return text;
    kiln_error_set_errno(error, KILN_IO, errno, "%s", path);
    if (copy >= 0)
        close(copy);
    kiln_temporary_discard(&text->file);
    free(text);
    return NULL;
}

FILE *kiln_text_file_stream(const struct kiln_text_file *text)
{
    return text->out;
}

bool kiln_text_file_close(struct kiln_text_file **text, bool keep, struct kiln_error *error)
{
    struct kiln_text_file *t = text ? *text : NULL;
    if (!t)
        return true;
    const bool failed = ferror(t->out) != 0;
    errno = 0;
    if (fclose(t->out) != 0 || failed)
        t->file.failure = errno ? errno : EIO;
    bool ok = true;
    if (keep)
        ok = kiln_temporary_commit(&t->file, t->overwrite, error);
    kiln_temporary_discard(&t->file);
    free(t);
    *text = NULL;
    return ok;
}
