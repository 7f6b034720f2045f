Devices differ from machine to machine; their reports do not differ in form.

$ kiln devices | sed -E 's/^[0-9]+: .*/<number>: <name>/; s/^(    [A-Za-z]+ +).*/\1<...>/; s/^ {14}.*/              <...>/; s/^(sandbox: ).*/\1<...>/; /^advice/d; /problem/d' | sort -u
1|              <...>
1|    OpenGL    <...>
1|    exact     <...>
1|    kind      <...>
1|    limits    <...>
1|    platform  <...>
1|    threads   <...>
1|    usable    <...>
1|    vectors   <...>
1|    vendor    <...>
1|<number>: <name>
1|sandbox: <...>
$ kiln devices --json | jq -r '.devices[0, 1] | to_entries[] | "\(.key) \(.value | type)"'
1|index number
1|name string
1|vendor string
1|gl_version string
1|platform string
1|gl boolean
1|software boolean
1|usable boolean
1|problem string
1|exact boolean
1|vectors string
1|threads number
1|index number
1|name string
1|vendor string
1|gl_version string
1|platform string
1|gl boolean
1|software boolean
1|usable boolean
1|problem string
1|exact boolean
1|max_work_group_invocations number
1|max_shared_memory_bytes number
1|max_storage_block_bytes number
1|max_texture_size number
1|max_array_layers number
$ kiln devices --json | jq -r 'keys[], (.advice | type)'
1|advice
1|devices
1|sandbox
1|string

A device that does not exist, and no device at all.

$ kiln render scenes/tiny.yaml -o x.png --device 'Voodoo2 3000'
2|kiln: there is no device 'Voodoo2 3000'; there are: <devices>
= 4
$ kiln render scenes/tiny.yaml -o x.png --device 99
2|kiln: there is no device '99'; there are: <devices>
= 4
$ export __EGL_VENDOR_LIBRARY_FILENAMES=/dev/null EGL_PLATFORM=none LIBGL_DRIVERS_PATH=/nowhere
> kiln devices | grep -v "vectors\|threads\|sandbox"; echo "exit $?"
> kiln devices --json | jq -c 'del(.sandbox) | .devices |= map(.name), .advice'; echo "exit $?"
> kiln render scenes/tiny.yaml -q --frames 0 -o here.png; echo "exit $?"
> kiln render scenes/tiny.yaml -o x.png --technique raster=geometry; echo "exit $?"
> kiln render scenes/tiny.yaml -o x.png --device software
1|0: cpu
1|    kind      no OpenGL
1|    usable    yes
1|    exact     yes
1|advice: EGL has no driver that works without a display; install the package libegl-mesa0, or the GPU vendor's EGL
1|exit 0
1|{"devices":["cpu"],"advice":"EGL has no driver that works without a display; install the package libegl-mesa0, or the GPU vendor's EGL"}
1|"EGL has no driver that works without a display; install the package libegl-mesa0, or the GPU vendor's EGL"
1|exit 0
1|exit 0
1|exit 4
2|kiln: no device with OpenGL: EGL has no driver that works without a display; install the package libegl-mesa0, or the GPU vendor's EGL
2|kiln: there is no device 'software'; there are: <devices>
= 4
$ ls
1|here.png
1|scenes

Without OpenGL, techniques that need it are refused.

$ kiln render scenes/tiny.yaml -o x.png --device cpu --technique raster=geometry
1|device: <device>
2|kiln: technique raster=geometry needs OpenGL, which the device 'cpu' does not have: use raster=cpu, or another device ('kiln devices' lists them)
= 2

A software device is named in the first line of output.

$ kiln render scenes/tiny.yaml -o none --frames 0 >output
> name=$(sed -n '1s/^device: //p' output)
> kiln devices --json | jq -e --arg name "${name% (software)}" --arg line "$name" \
>     '[.devices[] | select(.name == $name)][0] | (.gl and .software) == ($line | endswith(" (software)"))'
1|true

Vectors that the machine lacks are a wrong command line, whatever is asked; help is given all the same.

$ export KILN_SIMD=mmx
> for words in devices 'check scenes/tiny.yaml' 'render scenes/tiny.yaml -o x.png' 'test scenes' 'compare a b' \
>     'figure list' 'bench bytes'; do kiln $words 2>&1 | sed 's/this machine has.*/<levels>/'; echo "${PIPESTATUS[0]}"; done
> kiln devices --help | head -n 1; kiln help exit-codes | head -n 1
1|kiln: KILN_SIMD is 'mmx'; <levels>
1|2
1|kiln: KILN_SIMD is 'mmx'; <levels>
1|2
1|kiln: KILN_SIMD is 'mmx'; <levels>
1|2
1|kiln: KILN_SIMD is 'mmx'; <levels>
1|2
1|kiln: KILN_SIMD is 'mmx'; <levels>
1|2
1|kiln: KILN_SIMD is 'mmx'; <levels>
1|2
1|kiln: KILN_SIMD is 'mmx'; <levels>
1|2
1|usage: kiln devices [OPTION...]
1| CODE  AGAIN?     MEANING
