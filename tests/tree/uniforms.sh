#!/usr/bin/env bash
# Checks that the locations of uniforms are named constants in C and in shaders: uniforms.sh SOURCE.
# If this fails, a location is a bare number in C or in a shader. If it were then changed on one
# side only, C would set another uniform without an error. The names stand beside the binding
# points, in the headers that C and GLSL share: SIM_AT_USED in shaders/shared/limits.h is one.
set -euo pipefail
cd "$1"

mapfile -t files < <(find lib cmd decode tests -name '*.[ch]' -not -path '*/node_modules/*'
    find shaders -type f)

# Reads each file as one record, since a call may span several lines.
awk '
BEGIN { RS = "\001" }

# Reports each place of the text that matches the pattern.
function refuse(pattern, message,    rest, line, before) {
    line = 1
    for (rest = $0; match(rest, pattern); rest = substr(rest, RSTART + RLENGTH)) {
        before = substr(rest, 1, RSTART - 1)
        line += gsub(/\n/, "", before)
        printf "%s:%d: %s\n", FILENAME, line, message
        failed = 1
        before = substr(rest, RSTART, RLENGTH)
        line += gsub(/\n/, "", before)
    }
}

{
    message = "a uniform is set at a bare number; its location needs a name that the shader has, too"
    refuse("glUniform[A-Za-z0-9]+[(][ \t\n]*[0-9]", message)
    refuse("glProgramUniform[A-Za-z0-9]+[(][^,;]*,[ \t\n]*[0-9]", message)
    refuse("location[ \t\n]*=[ \t\n]*[0-9][^;{}]*[^A-Za-z0-9_]uniform[ \t\n]",
           "the location of a uniform is a bare number; it needs a name that the host has, too")
}
END { exit failed }
' "${files[@]}"
echo "the locations of uniforms have names"
