/* Writes the scenes of `kiln new`, from which users start; the program embeds the files of
 * scenes/templates. The first line of each scene tells editors where the JSON schema of scenes is,
 * by which they complete and check keys. The schema is searched for from the folder of the program,
 * since an installation may be moved. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/embedded.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "kiln_program.h"

#define SCHEMA "scene.schema.json"

enum { MAX_TEMPLATES = 32, MAX_NAME = 32, MAX_SUMMARY = 96 };

static const char yaml[] = ".yaml";

static void take_name(const struct kiln_embedded_file *file, char name[MAX_NAME])
{
    snprintf(name, MAX_NAME, "%.*s", (int)strcspn(file->path, "."), file->path);
}

void kiln_visit_templates(void (*visit)(void *user, const char *name, const char *summary),
                          void *user)
{
    for (const struct kiln_embedded_file *file = kiln_embedded_templates; file->path; file++) {
        char name[MAX_NAME], summary[MAX_SUMMARY];
        const char *line = file->text + strspn(file->text, "# ");
        take_name(file, name);
        snprintf(summary, sizeof summary, "%.*s", (int)strcspn(line, ".\n"), line);
        visit(user, name, summary);
    }
}

static void write_row(void *user, const char *name, const char *summary)
{
    fprintf(user, "  %-10s %s\n", name, summary);
}

bool kiln_write_templates(FILE *out)
{
    fputs("Scenes to begin with, for 'kiln new --template NAME':\n"
          "\n",
          out);
    kiln_visit_templates(write_row, out);
    return !ferror(out);
}

static const char *find(const char *name, struct kiln_error *error)
{
    char path[MAX_NAME + sizeof yaml];
    const char *names[MAX_TEMPLATES];
    char name_buffers[MAX_TEMPLATES][MAX_NAME], list[MAX_TEMPLATES * MAX_NAME] = "";
    size_t count = 0, length = 0;
    snprintf(path, sizeof path, "%s%s", name, yaml);
    const char *text = kiln_embedded_find(kiln_embedded_templates, path);
    if (text && strlen(name) < MAX_NAME)
        return text;
    const struct kiln_embedded_file *file = kiln_embedded_templates;
    for (; file->path && count < MAX_TEMPLATES; file++, count++) {
        take_name(file, name_buffers[count]);
        names[count] = name_buffers[count];
        length += (size_t)snprintf(list + length, sizeof list - length, "%s%s",
                                   count > 0 ? ", " : "", name_buffers[count]);
    }
    const char *nearest = kiln_text_nearest(name, names, count);
    kiln_error_set(error, KILN_USAGE, "there is no template '%s'%s%s%s; there are %s", name,
                   nearest ? " (did you mean '" : "", nearest ? nearest : "", nearest ? "'?)" : "",
                   list);
    return NULL;
}

/* Finds the schema: below the prefix of an installed program, beside a program that was just built,
 * or where the build was going to install it. False when it is in none of these places. */
static bool find_schema(char path[KILN_PATH_SIZE])
{
    static const char *const relative_paths[] = {"../share/kiln/" SCHEMA, "docs/" SCHEMA};
    char *program = realpath("/proc/self/exe", NULL);
    const char *slash = program ? strrchr(program, '/') : NULL;
    bool found = false;
    for (size_t i = 0; slash && !found && i < sizeof relative_paths / sizeof *relative_paths; i++) {
        char candidate[PATH_MAX];
        snprintf(candidate, sizeof candidate, "%.*s/%s", (int)(slash - program), program,
                 relative_paths[i]);
        char *real = realpath(candidate, NULL);
        found = real && strlen(real) < KILN_PATH_SIZE;
        if (found)
            memcpy(path, real, strlen(real) + 1);
        free(real);
    }
    free(program);
    if (!found)
        snprintf(path, KILN_PATH_SIZE, "%s/%s", KILN_DATA_DIR, SCHEMA);
    return found || access(path, R_OK) == 0;
}

/* Adds the line that names the schema to editors. Editors end the path at a blank, so a path with a
 * blank is written as a URL. */
static void add_modeline(struct kiln_text *text)
{
    char path[KILN_PATH_SIZE];
    const bool found = find_schema(path);
    const bool plain = !strpbrk(path, " \t%#");
    kiln_text_add(text, "# yaml-language-server: $schema=%s",
                  !found  ? SCHEMA
                  : plain ? ""
                          : "file://");
    for (const char *c = found ? path : ""; *c; c++)
        kiln_text_add(text, !plain && strchr(" \t%#", *c) ? "%%%02X" : "%c", *c);
    kiln_text_add(text, "\n");
}

char *kiln_template_scene(const char *name, struct kiln_error *error)
{
    const char *scene = find(name, error);
    struct kiln_text text = {0};
    if (!scene)
        return NULL;
    add_modeline(&text);
    kiln_text_add(&text, "%s", scene);
    if (!text.failed)
        return text.data;
    kiln_text_free(&text);
    kiln_error_no_memory(error, "a scene");
    return NULL;
}

bool kiln_template_write(const char *name, const char *path, bool overwrite,
                         struct kiln_error *error)
{
    char *scene = kiln_template_scene(name, error);
    if (!scene)
        return false;
    struct kiln_text_file *file = kiln_text_file_open(path, overwrite, error);
    if (file)
        fputs(scene, kiln_text_file_stream(file));
    const bool good = file && kiln_text_file_close(&file, true, error);
    free(scene);
    return good;
}
