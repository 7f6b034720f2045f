/* This header declares the functions that keep built programs of GL in the cache, from one run to
 * the next. */
#ifndef KILN_GPU_PROGRAM_CACHE_H
#define KILN_GPU_PROGRAM_CACHE_H

#include "gpu/device.h"

enum { KILN_PROGRAM_NAME_SIZE = 73 }; /* 64 digits, ".program" and a zero byte */

/* One stage of a program: GL_VERTEX_SHADER..., and its text with every include resolved. */
struct kiln_program_stage {
    GLenum kind;
    const char *text;
};

/* Everything that decides what a driver builds. */
struct kiln_program_key {
    const char *vendor, *renderer, *version, *language; /* strings of the driver */
    bool debug;                                         /* a debug context builds it */
    const struct kiln_program_stage *stages;
    size_t stage_count;
    const char *const *captured; /* outputs that transform feedback captures */
    size_t captured_count;
};

/* Fills the driver's part of a key. False: the driver gives no binaries of programs. */
bool kiln_program_cache_ask_driver(struct kiln_program_key *key, const struct kiln_device *device);

/* Makes the name of a program's file from its key and kiln's version. False: memory is short. */
bool kiln_program_cache_name(char name[KILN_PROGRAM_NAME_SIZE], const struct kiln_program_key *key);

/* Fills a new program object from the file of a name. False: there is no such file, it is damaged
 * or of another program, or the driver refuses it; the object must then be deleted. */
bool kiln_program_cache_load(struct kiln_device *device, const char *name, GLuint program);

/* Writes the file of a linked program, for which GL_PROGRAM_BINARY_RETRIEVABLE_HINT was set before
 * it was linked. A file that cannot be written is no failure. */
void kiln_program_cache_save(struct kiln_device *device, const char *name, GLuint program);

#endif
