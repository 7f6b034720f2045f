The program without a command, its version, its help.

$ kiln
2|kiln 0.2.0: renders particle effects without a display
2|
2|usage: kiln COMMAND [OPTION...] [OPERAND...]
2|       kiln --version | --help
2|
2|commands:
2|  render           render scenes into images or videos
2|  bake             save states of a run, from which other runs start
2|  export           write gas as OpenVDB files, for other programs
2|  plan             estimate what a clip costs, and divide it into tasks
2|  join             make a clip of the parts that several tasks drew
2|  encode           make a clip of images
2|  compare          tell whether two pictures, folders or videos look the same
2|  test             render tests and compare them with golden pictures
2|  test approve     accept pictures of the last run as goldens
2|  test calibrate   measure how much tests vary, and propose limits
2|  test report      write reports of runs, such as the shards of one
2|  test list        list the tests that 'kiln test' would run
2|  figure           draw figures for documents, and check that they are up to date
2|  figure sheet     draw a sheet of pictures over sweeps of parameters
2|  figure triptych  draw a reference, a result and their error map
2|  figure strip     draw frames of a scene or a clip in a row
2|  bench            measure techniques, scenes and suites
2|  new              write a scene to begin with
2|  check            validate scenes and print them with every default
2|  params           list the parameters of a scene
2|  devices          list what can render on this machine, and what is missing
2|  help             explain a command or a topic
2|
2|topics of 'kiln help TOPIC', beside the commands:
2|  scene            every key of a scene file
2|  schema           the JSON schema of scene files, for editors
2|  techniques       the techniques of each stage
2|  metrics          the metrics that compare pictures
2|  limits           the limits of a job, and the preset for services
2|  templates        scenes to begin with, for 'kiln new'
2|  outputs          the output formats by suffix
2|  tests            every key of a test file, and the reports
2|  jobs             every key of a file of jobs, for 'kiln render --batch'
2|  jobs-schema      the JSON schema of files of jobs, for editors
2|  events           the events that --events writes for other programs
2|  events-schema    the JSON schema of events
2|  exit-codes       what each exit code means
2|  environment      the variables of the environment that kiln reads
2|  completion       completion of command lines in bash, zsh and fish
2|  man              the manual page, for `man -l`
2|  man-scene        the manual page of scene files
2|
2|A first picture:
2|  kiln new fire.yaml
2|  kiln render fire.yaml -o fire.png --frames 60
= 2
$ kiln --version
1|kiln 0.2.0
$ kiln --help
1|kiln 0.2.0: renders particle effects without a display
1|
1|usage: kiln COMMAND [OPTION...] [OPERAND...]
1|       kiln --version | --help
1|
1|commands:
1|  render           render scenes into images or videos
1|  bake             save states of a run, from which other runs start
1|  export           write gas as OpenVDB files, for other programs
1|  plan             estimate what a clip costs, and divide it into tasks
1|  join             make a clip of the parts that several tasks drew
1|  encode           make a clip of images
1|  compare          tell whether two pictures, folders or videos look the same
1|  test             render tests and compare them with golden pictures
1|  test approve     accept pictures of the last run as goldens
1|  test calibrate   measure how much tests vary, and propose limits
1|  test report      write reports of runs, such as the shards of one
1|  test list        list the tests that 'kiln test' would run
1|  figure           draw figures for documents, and check that they are up to date
1|  figure sheet     draw a sheet of pictures over sweeps of parameters
1|  figure triptych  draw a reference, a result and their error map
1|  figure strip     draw frames of a scene or a clip in a row
1|  bench            measure techniques, scenes and suites
1|  new              write a scene to begin with
1|  check            validate scenes and print them with every default
1|  params           list the parameters of a scene
1|  devices          list what can render on this machine, and what is missing
1|  help             explain a command or a topic
1|
1|topics of 'kiln help TOPIC', beside the commands:
1|  scene            every key of a scene file
1|  schema           the JSON schema of scene files, for editors
1|  techniques       the techniques of each stage
1|  metrics          the metrics that compare pictures
1|  limits           the limits of a job, and the preset for services
1|  templates        scenes to begin with, for 'kiln new'
1|  outputs          the output formats by suffix
1|  tests            every key of a test file, and the reports
1|  jobs             every key of a file of jobs, for 'kiln render --batch'
1|  jobs-schema      the JSON schema of files of jobs, for editors
1|  events           the events that --events writes for other programs
1|  events-schema    the JSON schema of events
1|  exit-codes       what each exit code means
1|  environment      the variables of the environment that kiln reads
1|  completion       completion of command lines in bash, zsh and fish
1|  man              the manual page, for `man -l`
1|  man-scene        the manual page of scene files
1|
1|A first picture:
1|  kiln new fire.yaml
1|  kiln render fire.yaml -o fire.png --frames 60
$ kiln -h | cmp - <(kiln help)
$ kiln help | cmp - <(kiln --help)

Unknown commands, options and topics name the nearest.

$ kiln rendr
2|kiln: unknown command 'rendr' (did you mean 'render'?); 'kiln help' lists the commands
= 2
$ kiln frobnicate
2|kiln: unknown command 'frobnicate'; 'kiln help' lists the commands
= 2
$ kiln --versoin
2|kiln: unknown option '--versoin' (did you mean '--version'?); 'kiln help' lists the commands
= 2
$ kiln help tecniques
2|kiln: help: unknown topic 'tecniques' (did you mean 'techniques'?); 'kiln help' lists the topics
= 2
$ kiln help frobnicate
2|kiln: help: unknown topic 'frobnicate'; 'kiln help' lists the topics
= 2
$ kiln help scene systems.fire.look.spin
1|systems.NAME.look.spin
1|    Angular speed of a particle. Speed and direction are chosen at random for each particle.
1|    [min, max] or one number, from 0 deg/s to 36000 deg/s; unit deg/s or rad/s
1|    may vary over time, over life or at random
1|    default: 0 deg/s
1|
$ kiln help scene nodes.NAME.file
1|nodes.NAME.file
1|    A glTF or GLB file, whose space is that of position, rotation and scale. The node then is where
1|    a node of the file is.
1|    the path of a glTF or GLB file, from the scene's folder and inside it, or none
1|    default: none
1|
$ kiln help scene nodes.NAME.node | sed -n 4p
1|    the name of a node in the file, or its number there from 0, or none
$ kiln help scene nodes.NAME.mesh | sed -n 4p
1|    the name of an object of the backdrop, or its number from 0, or none
$ kiln help scene camera.shutter --search phase | grep -c '^camera'
1|1
$ kiln help meteor
2|kiln: help: unknown topic 'meteor'; 'kiln help' lists the topics
= 2
$ kiln help aperture | head -n 1
1|camera.aperture
$ kiln help scene systems.x.y
2|kiln: help: a scene has no key 'systems.x.y'; 'kiln help scene' lists the keys
= 2
$ kiln help scene --search zzz; kiln help limits --search x
2|kiln: help: no key of a scene mentions 'zzz'; 'kiln help' lists the topics
2|kiln: help: --search searches the keys of 'kiln help scene'
= 2
$ kiln help render check
2|kiln: help: one operand too many, 'check'
= 2
$ kiln help --nope
2|kiln: help: unknown option '--nope'
= 2
$ kiln devices gpu
2|kiln: devices: one operand too many, 'gpu'
= 2
$ kiln check
2|kiln: check: needs SCENE...
= 2
$ kiln render
2|kiln: render: needs SCENE...
= 2

Help of a command is the same by both ways.

$ kiln help render
1|usage: kiln render [OPTION...] SCENE...
1|
1|Renders each scene into images or a video. '-' reads a scene from standard
1|input, whose files lie below the working directory. Files appear under their
1|names only when they are whole. The first line of output names the device: a
1|GPU, a software device of OpenGL, or 'cpu'. Several scenes share the device. The
1|first scene that fails ends the call, unless --keep-going is given.
1|
1|Programs follow a job by --events ('kiln help events').
1|
1|  -o, --output FILE           Where to write. The suffix chooses the format (see
1|                              'kiln help outputs'). '%04d' or '####' stands for
1|                              the frame's number, '{scene}' for the scene file's
1|                              name without its suffix. A folder gets a video
1|                              named after the scene. '-' is standard output (see
1|                              --pipe). 'none' renders without writing.
1|      --pipe y4m|rgb24|rgba|rgbaf32
1|                              What '--output -' writes to standard output: Y4M
1|                              as in an MP4; bytes in sRGB, with straight alpha
1|                              or none; or floats, little-endian, linear,
1|                              premultiplied. Default: y4m.
1|      --frames RANGES         Frames to draw, such as 0-149,200. 170- goes to
1|                              the end, -30 is 0-30, 'last' is the last frame,
1|                              0-100/10 is every tenth frame. The frames are the
1|                              same as in the full run. Videos need a range
1|                              without gaps. Default: all.
1|      --size WxH              Size of the picture in pixels: --set
1|                              output.size=[W, H].
1|      --fps RATE              Frames a second, such as 30 or 30000/1001: --set
1|                              output.fps=RATE.
1|      --seed N                Seed of all random numbers: --set seed=N.
1|      --params FILE           A file with values of the scene's parameters, YAML
1|                              or JSON, such as {length: 3 s}. Values of --set
1|                              params.NAME=VALUE replace them.
1|      --set KEY=VALUE         Change a value of the scene, such as
1|                              systems.fire.emit.rate=500. In a key, '*' stands
1|                              for every entry of a map or list.
1|      --asset-root FOLDER     The folder that the scene's files must lie in.
1|                              Default: the folder of the scene.
1|      --device DEVICE         A number from 'kiln devices', a part of a device's
1|                              name, 'cpu' to render without OpenGL, or
1|                              'software' for OpenGL on the CPU. Default: the
1|                              first GPU, or else 'cpu' if the techniques need no
1|                              OpenGL.
1|      --technique STAGE=NAME  How to run a stage; separate several by commas
1|                              (see 'kiln help techniques'). Default: the
1|                              technique that suits the device.
1|      --threads N             Number of threads that work beside the device; 0
1|                              takes one for each core. Default: 0.
1|      --png-bits 8|16         Bits a channel of PNG, APNG and MKV files.
1|                              Default: 8.
1|      --png-effort fast|small
1|                              How PNG files are compressed. 'small' files are
1|                              about a tenth smaller; each takes some hundred
1|                              times as long to compress. The pixels are the
1|                              same. Default: fast.
1|      --exr-bits 16|32        Bits a channel of EXR files: half or float.
1|                              Default: 16.
1|      --quality N             Quality of JPEG, MP4, WebM, MOV and WebP files,
1|                              from 0 (smallest) to 100 (visually lossless).
1|                              Default: 80.
1|      --flipbook COLUMNSxROWS
1|                              Write one PNG of this many cells, for game
1|                              engines, and a .json of its layout. Each cell is a
1|                              frame of --size. The cells are spread evenly over
1|                              --frames, and no other frames are drawn.
1|      --flipbook-alpha straight|premultiplied
1|                              Whether the colours of a flipbook are straight,
1|                              for renderers that blend light, such as kiln, or
1|                              premultiplied by alpha, as a display shows them
1|                              over black. Default: straight.
1|      --flipbook-fade N       How far from its border a cell of a flipbook with
1|                              alpha fades out, in percent of its shorter side,
1|                              so that no glow and no smoke shows a cut there. 0
1|                              leaves the cell as it was drawn. Default: 10.
1|      --flipbook-motion       Also write the motion of pixels from cell to cell,
1|                              as FILE_motion.png.
1|      --flipbook-green up|down
1|                              Where green of FILE_motion.png points: up as in
1|                              Houdini, Unity and kiln, or down as in Unreal.
1|                              Default: up.
1|      --flipbook-padding N    Number of pixels to add on each side of a cell, so
1|                              that texture filters do not read the neighbouring
1|                              cells. Default: 0.
1|      --manifest FILE         Also write a JSON file that describes the run,
1|                              even one that fails: scene, device, techniques,
1|                              state of each frame, times. A folder or '{scene}'
1|                              works as for --output.
1|      --states STATES         Start at the nearest state before the frames, out
1|                              of a folder that 'kiln bake' made. The pictures
1|                              are the same as without it.
1|      --resume                Go on with a job that was stopped or killed, or
1|                              start it. Whole files stay, and the rest is drawn
1|                              (see docs/jobs.md). With --force the job starts
1|                              anew.
1|      --shard I/N|auto|auto/N
1|                              Draw only the I-th of N shares of a clip's parts,
1|                              and go on with files of it that are there. A part
1|                              has two seconds. 'kiln join' makes the clip of all
1|                              parts. auto takes I and N from the variables of a
1|                              scheduler, such as SLURM_ARRAY_TASK_ID or
1|                              SGE_TASK_ID. auto/N takes I alone from them, also
1|                              from JOB_COMPLETION_INDEX or
1|                              AWS_BATCH_JOB_ARRAY_INDEX.
1|      --force                 Replace files that exist.
1|      --keep-going            After a scene that failed, render the other scenes
1|                              all the same. The exit code is then the greatest
1|                              of all.
1|      --batch JOBS            Render the jobs of a file, each in a process of
1|                              its own, instead of scenes; '-' is standard input
1|                              (see 'kiln help jobs'). Other options hold for
1|                              every job that does not set them itself.
1|      --jobs N                Number of jobs of --batch that run at a time.
1|                              Default: the number of cores divided by the
1|                              threads of a job.
1|      --limits KEY=VALUE,...  End with exit code 8 before the job takes more
1|                              than these limits. 'service' stands for a preset
1|                              (see 'kiln help limits'). Default: the
1|                              environment's KILN_LIMITS.
1|      --timeout TIME          End the command with exit code 8 after that time,
1|                              loading and encoding included. The time is in
1|                              seconds, or has a unit: ms, s, min or h. Default:
1|                              none.
1|      --sandbox[=on|require|off]
1|                              Give up all rights that the job does not need, on
1|                              the device 'cpu': other files, sockets, other
1|                              programs. With 'require', the command ends with
1|                              exit code 5 where the kernel cannot do that (see
1|                              'kiln devices'). Default: the environment's
1|                              KILN_SANDBOX, or else off.
1|      --frame-timeout TIME    Give up with exit code 5 when drawing a frame
1|                              takes longer than this. Each frame that is
1|                              simulated but not drawn adds this time to the
1|                              limit of the next drawn frame. The first drawn
1|                              frame includes set-up and warm-up. Loading the
1|                              scenes has the same limit. Time that is spent
1|                              waiting for the output does not count. Default:
1|                              none.
1|      --progress tty|lines|ndjson|none
1|                              How to show progress on standard error: a moving
1|                              line, or a line now and then. 'ndjson' is an older
1|                              spelling of --json for frames alone. Default: tty
1|                              on a terminal, else lines.
1|      --stats[=text|json]     Print times of each pass, particles, memory,
1|                              techniques and the hash of the final state. 'json'
1|                              is an older spelling of --json without frames.
1|      --json[=FILE]           Print JSON instead of text, or also write it into
1|                              FILE: an object a line, whose "event" is "device",
1|                              "frame" for each, and "result", with what --stats
1|                              has.
1|  -q, --quiet                 Print nothing but errors and what --stats and
1|                              --json ask for.
1|      --events STREAM         Tell other programs how the command goes, in lines
1|                              of JSON: 'ndjson' on standard output,
1|                              'ndjson:FILE' at the end of a file, 'ndjson:fd=N'
1|                              to an open descriptor. 'openjd' instead of
1|                              'ndjson' writes lines of Open Job Description (see
1|                              'kiln help events').
1|  -h, --help                  Print this help.
1|
1|Options and operands may come in any order; '--' ends the options. If an option is
1|given twice, the last one counts, but these options add up: --params --set --technique.
$ kiln render --help | cmp - <(kiln help render)
$ kiln render scenes/tiny.yaml -h | cmp - <(kiln help render)
$ kiln help compare
1|usage: kiln compare [OPTION...] REFERENCE TEST
1|
1|Compares the test with the reference by FLIP (how different they look when one
1|flips between them), SSIM, PSNR and differences of levels, and judges them by
1|limits. Each operand is a picture, a video, a folder of pictures, or a pattern
1|such as frame_%04d.png or frame_####.png. Pictures of folders are paired by
1|name, pictures of patterns by number. Frames of a video are numbered from 0. A
1|missing or extra frame is a difference, and so is another size. Alpha is judged
1|on black and on white. Of EXR files, every layer is judged: colours by the
1|limits, data such as depths by their numbers; a missing or extra layer is a
1|difference.
1|
1|Exit code 0: the same within the limits; 1: different; 2: usage; 3: something
1|cannot be read or has values that are not finite outside of masks; 6: --diff or
1|--error-map cannot be written. --tolerance replaces all default limits.
1|
1|      --tolerance METRIC=VALUE
1|                              The worst value of a metric that passes, its
1|                              limit; separate several by commas (see 'kiln help
1|                              metrics'). Default:
1|                              flip.mean=0.01,flip.p99=0.1,window.share=0.1.
1|  -d, --diff FILE             Write a PNG of reference, test and FLIP's error
1|                              map side by side. For several frames, '%04d' or
1|                              '####' stands for the frame's number. A folder
1|                              gets one file for each frame.
1|      --error-map FILE        Write a PNG of FLIP's error map alone, in the
1|                              pictures' size. Names work as for --diff.
1|      --force                 Replace files of --diff, --error-map and --json
1|                              that exist.
1|  -i, --ignore X,Y,WxH        Do not judge this rectangle. Its pixels of the
1|                              test are taken from the reference.
1|      --mask FILE             Do not judge the places where this picture is
1|                              black. It must have the same size.
1|      --layer LAYER           Layer of EXR files to compare, such as beauty,
1|                              depth or fire. Default: all layers.
1|      --data-limit NUMBER     The largest difference that passes of two numbers
1|                              in layers of data, such as depths. Default: 0.
1|      --range auto|ldr|hdr    How FLIP judges light: ldr clamps it at white, hdr
1|                              judges several exposures of the reference.
1|                              Default: auto: hdr if one of the pictures is EXR
1|                              or HDR.
1|      --ppd N                 Number of pixels in a degree of the viewer's field
1|                              of view. Default: 67.0206, a 0.7 m wide screen of
1|                              3840 pixels from 0.7 m.
1|      --threshold LEVELS      Threshold in 1/255 of sRGB's range. Pixels that
1|                              differ by more count as differing. Default: 2.
1|      --window N              Edge in pixels of the window that is searched for
1|                              where differing pixels are densest. Default: 32.
1|      --threads N             Number of threads; 0 takes one for each core.
1|                              Default: 0.
1|      --json[=FILE]           Print JSON instead of text, or also write it into
1|                              FILE: an object a line, whose "event" is "frame"
1|                              or "result".
1|      --stats                 Also print the time that it took.
1|  -q, --quiet                 Print nothing but errors and what --json asks for.
1|      --events STREAM         Tell other programs how the command goes, in lines
1|                              of JSON: 'ndjson' on standard output,
1|                              'ndjson:FILE' at the end of a file, 'ndjson:fd=N'
1|                              to an open descriptor. 'openjd' instead of
1|                              'ndjson' writes lines of Open Job Description (see
1|                              'kiln help events').
1|  -h, --help                  Print this help.
1|
1|Options and operands may come in any order; '--' ends the options. If an option is
1|given twice, the last one counts, but these options add up: --tolerance --ignore --mask.
$ kiln help check
1|usage: kiln check [OPTION...] SCENE...
1|
1|Reads each scene and prints it with every default spelled out. '-' reads a scene
1|from standard input, whose files lie below the working directory. The output is
1|a scene file that renders to the same pictures. Comments at its end tell what
1|its meshes are (their size, whether they are closed, their joints, clips and
1|materials, and what is left out of them), how large its domains of gas are, and
1|the work of the whole clip: steps, particles at once, and memory. The memory is
1|the most that rendering without OpenGL may take, encoders left out. After a
1|wrong scene is reported, the other scenes are checked all the same. A scene that
1|asks for more than --limits allow ends with exit code 8.
1|
1|      --size WxH              Size of the picture in pixels: --set
1|                              output.size=[W, H].
1|      --fps RATE              Frames a second, such as 30 or 30000/1001: --set
1|                              output.fps=RATE.
1|      --seed N                Seed of all random numbers: --set seed=N.
1|      --params FILE           A file with values of the scene's parameters, YAML
1|                              or JSON, such as {length: 3 s}. Values of --set
1|                              params.NAME=VALUE replace them.
1|      --set KEY=VALUE         Change a value of the scene, such as
1|                              systems.fire.emit.rate=500. In a key, '*' stands
1|                              for every entry of a map or list.
1|      --asset-root FOLDER     The folder that the scene's files must lie in.
1|                              Default: the folder of the scene.
1|      --limits KEY=VALUE,...  End with exit code 8 before the job takes more
1|                              than these limits. 'service' stands for a preset
1|                              (see 'kiln help limits'). Default: the
1|                              environment's KILN_LIMITS.
1|      --timeout TIME          End the command with exit code 8 after that time,
1|                              loading and encoding included. The time is in
1|                              seconds, or has a unit: ms, s, min or h. Default:
1|                              none.
1|      --sandbox[=on|require|off]
1|                              Give up all rights that the job does not need, on
1|                              the device 'cpu': other files, sockets, other
1|                              programs. With 'require', the command ends with
1|                              exit code 5 where the kernel cannot do that (see
1|                              'kiln devices'). Default: the environment's
1|                              KILN_SANDBOX, or else off.
1|      --origin                Print behind each line the file and line that it
1|                              comes from, or 'default'.
1|      --hash                  Print only the scene's hash.
1|  -q, --quiet                 Print nothing but errors.
1|      --events STREAM         Tell other programs how the command goes, in lines
1|                              of JSON: 'ndjson' on standard output,
1|                              'ndjson:FILE' at the end of a file, 'ndjson:fd=N'
1|                              to an open descriptor. 'openjd' instead of
1|                              'ndjson' writes lines of Open Job Description (see
1|                              'kiln help events').
1|  -h, --help                  Print this help.
1|
1|Options and operands may come in any order; '--' ends the options. If an option is
1|given twice, the last one counts, but these options add up: --params --set.
$ kiln help devices
1|usage: kiln devices [OPTION...]
1|
1|Lists this machine without OpenGL, called 'cpu', and every device that OpenGL
1|offers without a display. Without OpenGL, every stage runs in threads and
1|vectors, with the same pixels on every machine. Each OpenGL device is listed
1|with its limits. It is usable with OpenGL 4.3 or later. It is exact when it
1|passed the probe of the arithmetic that the simulation needs; with a device that
1|is not exact, particles move on the CPU. A software device is a rasteriser on
1|the CPU. The last entry is what the kernel has for --sandbox. Advice names what
1|is missing and the package that brings it.
1|
1|      --json[=FILE]           Print JSON instead of text, or also write it into
1|                              FILE: one object.
1|      --force                 Replace a file of --json that exists.
1|      --events STREAM         Tell other programs how the command goes, in lines
1|                              of JSON: 'ndjson' on standard output,
1|                              'ndjson:FILE' at the end of a file, 'ndjson:fd=N'
1|                              to an open descriptor. 'openjd' instead of
1|                              'ndjson' writes lines of Open Job Description (see
1|                              'kiln help events').
1|  -h, --help                  Print this help.
$ kiln help help
1|usage: kiln help [OPTION...] [TOPIC [KEY]]
1|
1|Explains a command or a topic. Without an operand, it lists both. 'kiln help
1|scene systems.NAME.look' prints that part of a scene's keys, and 'kiln help
1|scene --search WORD' those that mention a word.
1|
1|      --search TEXT           Of 'kiln help scene', print the keys that mention
1|                              a text.
1|  -h, --help                  Print this help.
$ kiln help exit-codes
1| CODE  AGAIN?     MEANING
1|    0  never      all went well
1|    1  never      a frame failed, or a picture differs
1|    2  never      the command line is wrong, or it names an output that exists
1|                  or a journal of another job
1|    3  never      a scene or another input file is wrong
1|    4  again      no device is usable; or, for want of a device, every test was
1|                  skipped or nothing was measured
1|    5  with more  the device was lost, memory ran out, a frame or test took
1|                  longer than its limit, a test crashed, or a library aborted
1|    6  again      reading or writing failed
1|    7  never      a golden picture is missing, or its accepted hashes and limits
1|                  are
1|    8  with more  the job took more than its limits or --timeout allow
1|    9  again      the reader of standard output went away before the job was
1|                  done
1|  129  again      stopped by SIGHUP; only whole files are left
1|  130  again      stopped by SIGINT; only whole files are left
1|  143  again      stopped by SIGTERM; only whole files are left
1|
1|AGAIN? is for schedulers. never: the same call ends the same way. again: the same call
1|may succeed, on another machine where a device or a disk is the reason; with --resume
1|it goes on. with more: it may succeed with more memory, more time, or larger limits.

The other topics.

$ kiln help techniques
1|  STAGE=auto         the default of each stage, by the tables below
1|  simulate=cpu       host threads
1|  simulate=inplace   compute, one buffer updated in place
1|  simulate=pingpong  compute, from one buffer to another; it takes twice the memory
1|  simulate=feedback  geometry shaders and transform feedback; they take twice the memory
1|  simulate=texels    fragment shaders, from textures to textures; they take three times the memory
1|  gas=cpu            host threads, rows and bricks of cells in vectors
1|  gas=gl             compute; the gas stays in GL
1|  sort=cpu           stable radix sort, host threads
1|  sort=radix         stable radix sort, compute
1|  sort=bitonic       bitonic merge sort, compute, padded to a power of two
1|  sort=oddeven       odd-even merge sort, compute; oddeven:N spreads it over N frames
1|  backdrop=cpu       host threads, rays in vectors
1|  backdrop=gl        fragment shaders
1|  march=cpu          host threads, rays through gas in vectors
1|  march=gl           compute, a ray through gas for each pixel
1|  raster=cpu         host threads, tiles and vectors
1|  raster=geometry    points turned into billboards by a geometry shader
1|  raster=instanced   a quad for each particle, without a geometry shader
1|  raster=tiled       compute; sprites are sorted into bins, and tiles are drawn from front to back
1|  bloom=cpu          host threads, rows
1|  bloom=gl           fragment shaders
1|  composite=cpu      host threads, rows
1|  composite=gl       one fragment shader
1|
1|'auto' on a software device:
1|  simulate=cpu       threads run the step faster than GL on the same cores
1|  gas=cpu            vectors on the host are some 20 times as fast as GL on the same cores
1|  sort=cpu           threads sort several times as fast as GL on the same cores
1|  backdrop=cpu       vectors on the host are several times as fast as GL on the same cores
1|  march=cpu          vectors on the host are several times as fast as GL on the same cores
1|  raster=cpu         vectors on the host draw several times as fast as GL on the same cores
1|  bloom=cpu          vectors on the host are several times as fast as GL on the same cores
1|  composite=cpu      the host is faster than GL on the same cores
1|
1|'auto' on a GPU:
1|  simulate=inplace   particles stay in one buffer; it takes the least memory in GL
1|  gas=gl             all cells of a pass are computed at once, where they lie
1|  sort=bitonic       up to 250,000 particles it is the fastest sort on a GPU
1|  backdrop=gl        the hardware casts the rays
1|  march=gl           the rays of all pixels march at once
1|  raster=tiled       compute draws faster than the blending units of a server's GPU
1|  bloom=gl           the picture is in GL already
1|  composite=gl       the picture is in GL already
1|
1|'auto' on a GPU that computes inexactly:
1|  simulate=cpu       only exact arithmetic may move particles
1|  gas=cpu            only exact arithmetic may move gas
1|  sort=cpu           only exact arithmetic may order particles
1|  backdrop=gl        the hardware casts the rays
1|  march=gl           the rays of all pixels march at once
1|  raster=tiled       compute draws faster than the blending units of a server's GPU
1|  bloom=gl           the picture is in GL already
1|  composite=gl       the picture is in GL already
$ kiln help outputs
1|Output formats, by the suffix of the output:
1|
1|  .png   PNG images: 8 or 16 bits, sRGB; alpha with a transparent backdrop
1|  .jpg   JPEG images: 8 bits, full chroma, no alpha; quality 0 to 100, from 91 on the best; .jpeg is the same
1|  .exr   OpenEXR images: half or float, linear, premultiplied; layers of depth, fire, smoke, bloom and gas
1|  .mp4   H.264 video: even sizes, no alpha; quality 0 to 100; 100 is visually lossless
1|  .webm  VP9 video: for the web, with alpha; quality 0 to 100; frame times in whole ms
1|  .mkv   FFV1 video: lossless, 8 or 16 bits (--png-bits), with alpha; frame times in whole ms
1|  .mov   ProRes 4444 video: for editing, 10 bits, with alpha; quality 0 to 100
1|  .gif   GIF animation: 255 colours a clip, no alpha, at most 50 frames a second; plays forever
1|  .apng  animated PNG: lossless, 8 or 16 bits (--png-bits), with alpha; plays forever
1|  .webp  animated WebP: with alpha; quality 0 to 100; 100 is lossless; frame times in whole ms; plays forever
1|
1|The names of images are numbered: frame_####.png and frame_%04d.png both give frame_0000.png.
1|Where a name of several frames has no number, _0000 is added before the suffix. A percent
1|sign or hash of the name itself is written as %% or %#. Missing folders are made. A file
1|appears under its name only when it is whole.
1|
1|A clip is one file of consecutive frames that starts at time 0. It holds neither date nor
1|machine, and the same frames give the same bytes with any --threads. The clips of
1|--frames 0-74 and 75-149 cannot be put together to the bytes of the whole clip. To split
1|work, use --shard and 'kiln join', or render images and encode them.
1|
1|MP4, MOV and APNG hold exact frame rates. APNG has fractions up to 65535; another rate
1|becomes the nearest fraction, with a warning. GIF counts times in 1/100 s. A GIF of up to
1|50 frames a second holds all frames; some last 1/100 s longer than others, so that the
1|clip keeps its length. A GIF of a higher rate holds only every second, third or later
1|frame, and a warning says which. One palette serves the whole GIF. Until it is known, the
1|frames wait in a file beside the GIF, of 3 bytes a pixel.
1|
1|An alpha channel comes from backdrop.transparent. MP4, GIF and JPEG have no alpha, and
1|writing one is an error. Alpha is straight: colours are not multiplied by it. Colours are
1|sRGB. Videos are BT.709 with sRGB's transfer function, and are tagged so.
1|
1|--flipbook 8x8 writes 64 frames as cells of one PNG for game engines, in rows from the
1|top. Cell k of n shows the frame at k/n of --frames. --size is the size of a cell;
1|padding is added inside the cell. FILE.json beside FILE.png has the grid, the frames, the
1|cells a second and the kind of alpha. With straight alpha, pixels of alpha 0 have the
1|colours of their neighbours. With premultiplied alpha, colours are those over black, for
1|additive or premultiplied blending. A cell with alpha fades out towards its border
1|(--flipbook-fade), where it is transparent, so a billboard shows no square where a glow
1|or smoke leaves the frame.
1|
1|--flipbook-motion adds FILE_motion.png, which is linear, not sRGB. Red and green say how
1|far right and up a pixel moves until the next cell: (channel - 128) / 127 * scale cells,
1|with scale from the JSON. Houdini, Unity and look.motion of a scene have green up, too;
1|--flipbook-green down is for engines whose v points downwards, such as Unreal. The JSON
1|says which it is. At t between cells a and b, an engine mixes a at uv - t * motion and b
1|at uv + (1 - t) * motion. The motion of the last cell is 0. One command must draw all
1|cells; chunks of frames make no flipbook. The files appear together, the .json last.
1|Where the .json is, all of them are whole.
1|
1|A scene plays such a flipbook by look.atlas and look.motion. It takes scale and green
1|from the JSON if FILE.json is beside FILE_motion.png.
1|
1|-o - writes frames to standard output, in rows from the top, without a header. The
1|default is Y4M (4:2:0, BT.709 in limited range, as in an MP4). --pipe rgb24 and rgba
1|write bytes in sRGB, with straight alpha; rgbaf32 writes floats (little-endian, linear,
1|premultiplied).
$ kiln help scene | head -n 4
1|A scene is a YAML file. Every key below may also be given with --set KEY=VALUE; '*' in a KEY
1|stands for every entry of a mapping or list, and entries of a list are counted from 0.
1|
1|Numbers may carry a unit (2 s, 45 deg); without one they are in the SI unit, except that an
$ kiln help schema | jq -r '.title, .type'
1|kiln scene
1|object

Variables of the environment, those of one scheduler among them.

$ kiln help environment | grep -A 2 -E '^  (KILN_LIMITS|SGE_TASK_ID)$'
1|  KILN_LIMITS
1|      Limits of jobs where --limits does not set them (see 'kiln help limits').
1|  KILN_SANDBOX
1|--
1|  SGE_TASK_ID
1|      Number of this task under Grid Engine, for 'kiln render --shard auto';
1|      'undefined' outside of arrays.
$ kiln help enviroment
2|kiln: help: unknown topic 'enviroment' (did you mean 'environment'?); 'kiln help' lists the topics
= 2

With KILN_LOG=debug, the place in kiln's source stands before an error.

$ KILN_LOG=debug kiln check nothing.yaml 2>&1 | sed 's/c:[0-9]*$/c:<line>/'
1|kiln: debug: the next error is of lib/scene/place.c:<line>
1|nothing.yaml: No such file or directory
$ KILN_LOG=info kiln check nothing.yaml
2|nothing.yaml: No such file or directory
= 3
