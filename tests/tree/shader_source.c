/* Prints a shader as kiln gives it to a driver, with its includes resolved: shader_source FILE
 * [NAME=VALUE]... FILE is a path under shaders/, and each NAME=VALUE becomes a #define. shader.sh
 * passes the text to glslangValidator, to check that drivers accept kiln's shaders. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "gpu/program.h"

int main(int argc, char **argv)
{
    if (argc < 2) {
        fputs("usage: shader_source FILE [NAME=VALUE]...\n", stderr);
        return KILN_USAGE;
    }
    struct kiln_error error = {0};
    struct kiln_text defines = {0};
    for (int i = 2; i < argc; i++) {
        const int name = (int)strcspn(argv[i], "=");
        const char *value = argv[i][name] ? argv[i] + name + 1 : "";
        kiln_text_add(&defines, "#define %.*s %s\n", name, argv[i], value);
    }
    char *source = kiln_program_source(argv[1], defines.data, &error);
    if (source)
        fputs(source, stdout);
    else
        fprintf(stderr, "%s\n", error.message);
    free(source);
    kiln_text_free(&defines);
    return (int)error.code;
}
