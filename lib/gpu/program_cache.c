/* This file keeps built programs of GL on the disk: the binaries that a driver gives of them. A
 * driver needs seconds to build a large program, and milliseconds to take its binary.
 *
 * A driver's reader of binaries is made for what the driver itself wrote. A forged binary might run
 * code in this process. So the files lie in a folder where only this user can write, and where a
 * job in a sandbox cannot (kiln_cache_private_folder). All else is found by checks: each file
 * begins with a checksum (base/cache.c), the name of the program that it is of, and the format of
 * its binary, which must be one that the driver lists. The driver then checks that it wrote the
 * binary. */
#include "gpu/program_cache.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/cache.h"
#include "base/hash.h"
#include "base/text.h"

/* Limits of what is taken from a driver or a file. The largest program of kiln on llvmpipe has
 * about one MiB. */
enum { MOST_BINARY_BYTES = 64 << 20, MOST_FORMATS = 64 };

/* Begins a file; the binary follows. */
struct head {
    char name[KILN_PROGRAM_NAME_SIZE];
    char zero[3];
    uint32_t format;
};
_Static_assert(sizeof(struct head) == KILN_PROGRAM_NAME_SIZE + 3 + 4, "a file has no padding");

/* ---- names ----------------------------------------------------------------------------------- */

static const char *gl_string(GLenum name)
{
    const char *string = (const char *)glGetString(name);
    return string ? string : "unknown";
}

bool kiln_program_cache_ask_driver(struct kiln_program_key *key, const struct kiln_device *device)
{
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    key->vendor = gl_string(GL_VENDOR);
    key->renderer = gl_string(GL_RENDERER);
    key->version = gl_string(GL_VERSION);
    key->language = gl_string(GL_SHADING_LANGUAGE_VERSION);
    key->debug = device->debug;
    return formats > 0;
}

bool kiln_program_cache_name(char name[KILN_PROGRAM_NAME_SIZE], const struct kiln_program_key *key)
{
    struct kiln_text text = {0};
    char hash[65];
    kiln_text_add(&text, "%s\n%s\n%s\n%s\n%s\n%s context\n", kiln_version(), key->vendor,
                  key->renderer, key->version, key->language, key->debug ? "debug" : "usual");
    for (size_t i = 0; i < key->captured_count; i++)
        kiln_text_add(&text, "captured %s\n", key->captured[i]);
    for (size_t i = 0; i < key->stage_count; i++)
        kiln_text_add(&text, "stage %x of %zu bytes\n%s", (unsigned)key->stages[i].kind,
                      strlen(key->stages[i].text), key->stages[i].text);
    const bool named = !text.failed;
    if (named) {
        kiln_hash_sha256(text.data, text.length, hash);
        snprintf(name, KILN_PROGRAM_NAME_SIZE, "%s.program", hash);
    }
    kiln_text_free(&text);
    return named;
}

/* ---- files ----------------------------------------------------------------------------------- */

/* Returns whether the driver lists a format. glProgramBinary fails with a GL error for others. */
static bool is_format(uint32_t format)
{
    GLint count = 0, formats[MOST_FORMATS];
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
    if (count < 1 || count > MOST_FORMATS)
        return false;
    glGetIntegerv(GL_PROGRAM_BINARY_FORMATS, formats);
    for (GLint i = 0; i < count; i++) {
        if ((uint32_t)formats[i] == format)
            return true;
    }
    return false;
}

bool kiln_program_cache_load(struct kiln_device *device, const char *name, GLuint program)
{
    char folder[KILN_PATH_SIZE];
    struct head head;
    size_t size = 0;
    unsigned char *bytes =
        kiln_cache_private_folder(folder)
            ? kiln_cache_read_any(folder, name, sizeof head + MOST_BINARY_BYTES, &size)
            : NULL;
    GLint linked = GL_FALSE;
    if (bytes && size > sizeof head) {
        memcpy(&head, bytes, sizeof head);
        if (strncmp(head.name, name, sizeof head.name) == 0 && is_format(head.format)) {
            glProgramBinary(program, head.format, bytes + sizeof head,
                            (GLsizei)(size - sizeof head));
            glGetProgramiv(program, GL_LINK_STATUS, &linked);
        }
    }
    free(bytes);
    if (linked != GL_TRUE) { /* a driver may report a binary that it refuses as an error of GL */
        struct kiln_error ignored = {0};
        kiln_device_check(device, name, &ignored);
    }
    return linked == GL_TRUE;
}

void kiln_program_cache_save(struct kiln_device *device, const char *name, GLuint program)
{
    char folder[KILN_PATH_SIZE];
    struct kiln_error ignored = {0};
    struct head head = {.zero = {0}};
    GLint length = 0;
    GLenum format = 0;
    glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &length);
    if (length < 1 || length > MOST_BINARY_BYTES || !kiln_cache_private_folder(folder))
        return;
    unsigned char *bytes = malloc(sizeof head + (size_t)length);
    if (!bytes)
        return;
    GLsizei written = 0;
    glGetProgramBinary(program, length, &written, &format, bytes + sizeof head);
    if (kiln_device_check(device, name, &ignored) && written > 0) {
        strncpy(head.name, name, sizeof head.name - 1);
        head.format = format;
        memcpy(bytes, &head, sizeof head);
        kiln_cache_write(folder, name, bytes, sizeof head + (size_t)written);
    }
    free(bytes);
}
