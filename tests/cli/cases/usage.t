The program without a command, its version, its help.

$ kiln
2|kiln 0.2.0: renders particle effects without a display
2|
2|usage: kiln COMMAND [OPTION...] [OPERAND...]
2|       kiln --version | --help
2|
2|commands:
2|  render           render scenes into images or videos
2|  bake             save states of a run, from which others start
2|  plan             say what a clip costs, and how it divides into tasks
2|  join             make a clip of the parts that several tasks drew
2|  encode           make a clip of images
2|  compare          tell whether two pictures, folders or videos look the same
2|  test             render tests and compare them with golden pictures
2|  test approve     accept pictures of the last run as goldens
2|  test calibrate   measure how much tests vary, and propose limits
2|  test report      write reports of runs, such as the shards of one
2|  test list        list the tests that 'kiln test' would run
2|  figure           figures for documents, and whether they are up to date
2|  figure sheet     a sheet of pictures over sweeps of parameters
2|  figure triptych  a reference, a result and their error map
2|  figure strip     frames of a scene or a clip in a row
2|  bench            measure techniques, scenes and suites
2|  new              write a scene to begin with
2|  check            validate scenes and print them with every default
2|  devices          list what can render on this machine, and what is missing
2|  help             explain a command or a topic
2|
2|topics of 'kiln help TOPIC', beside the commands:
2|  scene            every key of a scene file
2|  schema           the JSON schema of scene files, for editors
2|  techniques       the techniques of each stage
2|  metrics          what pictures are compared by
2|  limits           what a job may take, and the preset for services
2|  templates        scenes to begin with, for 'kiln new'
2|  outputs          what can be written, by suffix
2|  tests            every key of a test file, and the reports
2|  jobs             every key of a file of jobs, for 'kiln render --batch'
2|  jobs-schema      the JSON schema of such files, for editors
2|  events           what --events tells other programs
2|  events-schema    the JSON schema of events
2|  exit-codes       what each exit code means
2|  environment      the variables of the environment that kiln reads
2|  completion       command lines completed by bash and zsh
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
1|  bake             save states of a run, from which others start
1|  plan             say what a clip costs, and how it divides into tasks
1|  join             make a clip of the parts that several tasks drew
1|  encode           make a clip of images
1|  compare          tell whether two pictures, folders or videos look the same
1|  test             render tests and compare them with golden pictures
1|  test approve     accept pictures of the last run as goldens
1|  test calibrate   measure how much tests vary, and propose limits
1|  test report      write reports of runs, such as the shards of one
1|  test list        list the tests that 'kiln test' would run
1|  figure           figures for documents, and whether they are up to date
1|  figure sheet     a sheet of pictures over sweeps of parameters
1|  figure triptych  a reference, a result and their error map
1|  figure strip     frames of a scene or a clip in a row
1|  bench            measure techniques, scenes and suites
1|  new              write a scene to begin with
1|  check            validate scenes and print them with every default
1|  devices          list what can render on this machine, and what is missing
1|  help             explain a command or a topic
1|
1|topics of 'kiln help TOPIC', beside the commands:
1|  scene            every key of a scene file
1|  schema           the JSON schema of scene files, for editors
1|  techniques       the techniques of each stage
1|  metrics          what pictures are compared by
1|  limits           what a job may take, and the preset for services
1|  templates        scenes to begin with, for 'kiln new'
1|  outputs          what can be written, by suffix
1|  tests            every key of a test file, and the reports
1|  jobs             every key of a file of jobs, for 'kiln render --batch'
1|  jobs-schema      the JSON schema of such files, for editors
1|  events           what --events tells other programs
1|  events-schema    the JSON schema of events
1|  exit-codes       what each exit code means
1|  environment      the variables of the environment that kiln reads
1|  completion       command lines completed by bash and zsh
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
1|Renders each scene ('-' is standard input, whose files lie below the working
1|directory) into images or a video. Files appear under their names only when they
1|are whole. The first line of output names the device: a GPU, a software device
1|of OpenGL, or 'cpu'. Several scenes share the device; the first that fails ends
1|the call, unless --keep-going is given.
1|
1|Programs follow a job by --events ('kiln help events').
1|
1|  -o, --output FILE           Where to write; the suffix chooses the format (see
1|                              'kiln help outputs'). '%04d' or '####' stands for
1|                              the frame's number, '{scene}' for the scene file's
1|                              name without its suffix. A folder gets a video
1|                              named after the scene. '-' is standard output (see
1|                              --pipe), 'none' renders without writing.
1|      --pipe y4m|rgb24|rgba|rgbaf32
1|                              What '--output -' writes to standard output: Y4M
1|                              as in an MP4; bytes in sRGB, with straight alpha
1|                              or none; or floats, little-endian, linear,
1|                              premultiplied. Default: y4m.
1|      --frames RANGES         Frames to draw, such as 0-149,200; 170- goes to
1|                              the end, -30 is 0-30, 'last' is the last one,
1|                              0-100/10 each tenth. They come out as they do in
1|                              the full run. Videos hold neighbouring frames
1|                              only. Default: all.
1|      --size WxH              Size of the picture in pixels: --set
1|                              output.size=[W, H].
1|      --fps RATE              Frames a second, such as 30 or 30000/1001: --set
1|                              output.fps=RATE.
1|      --seed N                Seed of everything random: --set seed=N.
1|      --set KEY=VALUE         Change a value of the scene, such as
1|                              systems.fire.emit.rate=500. In a key, '*' stands
1|                              for every entry of a map or list.
1|      --asset-root FOLDER     The folder that the scene's files must lie in.
1|                              Default: the folder of the scene.
1|      --device DEVICE         A number from 'kiln devices', a part of a device's
1|                              name, 'cpu' for none of OpenGL, or 'software' for
1|                              OpenGL on the CPU. Default: the first GPU, or else
1|                              'cpu' if the techniques need no OpenGL.
1|      --technique STAGE=NAME  How to run a stage; more of them after commas (see
1|                              'kiln help techniques'). Default: what suits the
1|                              device.
1|      --threads N             Threads that work beside the device; 0 takes one a
1|                              core. Default: 0.
1|      --png-bits 8|16         Bits a channel of PNG, APNG and MKV files.
1|                              Default: 8.
1|      --exr-bits 16|32        Bits a channel of EXR files: half or float.
1|                              Default: 16.
1|      --quality N             Quality of JPEG, MP4, WebM, MOV and WebP files,
1|                              from 0 (smallest) to 100 (no loss that an eye can
1|                              see). Default: 80.
1|      --flipbook COLUMNSxROWS
1|                              Write one PNG of so many cells, for game engines,
1|                              each a frame of --size; beside it a .json of its
1|                              layout. The cells are spread evenly over --frames,
1|                              and only they are drawn.
1|      --flipbook-alpha straight|premultiplied
1|                              Whether the colours of a flipbook are those of the
1|                              cover alone, or times alpha. Default: straight.
1|      --flipbook-motion       Also write how pixels move from cell to cell, as
1|                              FILE_motion.png.
1|      --flipbook-padding N    Pixels to add on each side of a cell, so that
1|                              filters see nothing of its neighbours. Default: 0.
1|      --manifest FILE         Also write a JSON file that describes the run,
1|                              also one that fails: scene, device, techniques,
1|                              state of each frame, times. A folder or '{scene}'
1|                              as for --output.
1|      --states STATES         Start at the nearest state before the frames, out
1|                              of a folder that 'kiln bake' made, and step on
1|                              from there. The pictures are the same as without.
1|      --resume                Go on with a job that was stopped or killed, or
1|                              start it: what is whole stays, the rest is drawn
1|                              (see docs/jobs.md). With --force it starts anew.
1|      --shard I/N|auto|auto/N
1|                              Draw only the I-th of N shares of the parts of a
1|                              clip, two seconds each, and go on with what is
1|                              there of it; 'kiln join' makes the clip of all.
1|                              auto: what SLURM_ARRAY_TASK_ID or SGE_TASK_ID and
1|                              their like say; auto/N: of N, also by
1|                              JOB_COMPLETION_INDEX or AWS_BATCH_JOB_ARRAY_INDEX.
1|      --force                 Replace files that exist.
1|      --keep-going            Render the other scenes, too, after one that
1|                              failed. The exit code is then the greatest of all.
1|      --batch JOBS            Render the jobs of a file, each in a process of
1|                              its own, instead of scenes; '-' is standard input
1|                              (see 'kiln help jobs'). Other options hold for
1|                              every job, unless it says something else.
1|      --jobs N                Jobs of --batch at a time. Default: as many as
1|                              there are cores for the threads of each.
1|      --limits KEY=VALUE,...  End with exit code 8 before more is taken;
1|                              'service' stands for a set of them (see 'kiln help
1|                              limits'). Default: the environment's KILN_LIMITS.
1|      --timeout TIME          End with exit code 8 after that time, loading and
1|                              encoding included: seconds, or with a unit, ms, s,
1|                              min or h. Default: none.
1|      --sandbox[=on|require|off]
1|                              Give up all rights that the job does not need, on
1|                              the device 'cpu': files elsewhere, sockets, other
1|                              programs. With 'require' it is exit code 5 where
1|                              the kernel cannot do that (see 'kiln devices').
1|                              Default: the environment's KILN_SANDBOX, or else
1|                              off.
1|      --frame-timeout TIME    Give up with exit code 5 when a frame takes longer
1|                              than that. Frames that are stepped over lengthen
1|                              the limit of the next drawn one; set-up and
1|                              warm-up belong to the first. Loading the scenes
1|                              has as long. Waiting for the output does not
1|                              count. Default: none.
1|      --progress tty|lines|ndjson|none
1|                              A moving line on standard error, or a line now and
1|                              then. 'ndjson' is an older --json, with the frames
1|                              alone. Default: tty on a terminal, else lines.
1|      --stats[=text|json]     Print times of each pass, particles, memory,
1|                              techniques and the hash of the final state. 'json'
1|                              is an older --json, without frames.
1|      --json[=FILE]           Print JSON instead of text, or also write it into
1|                              FILE: an object a line, whose "event" is "device",
1|                              "frame" for each, and "result", with what --stats
1|                              has.
1|  -q, --quiet                 Print nothing but errors and what --stats and
1|                              --json ask for.
1|      --events STREAM         Tell other programs how the command goes, by lines
1|                              of JSON: 'ndjson' on standard output,
1|                              'ndjson:FILE' at the end of a file, 'ndjson:fd=N'
1|                              to an open descriptor. 'openjd' instead of
1|                              'ndjson': by lines of Open Job Description (see
1|                              'kiln help events').
1|  -h, --help                  Print this help.
1|
1|Options and operands may come in any order; '--' ends the options. Of an
1|option that is given twice the last one counts, but these add up: --set --technique.
$ kiln render --help | cmp - <(kiln help render)
$ kiln render scenes/tiny.yaml -h | cmp - <(kiln help render)
$ kiln help compare
1|usage: kiln compare [OPTION...] REFERENCE TEST
1|
1|Compares the test with the reference by FLIP (how different they look when one
1|flips between them), SSIM, PSNR and differences of levels, and judges by limits.
1|Each is a picture, a video, a folder of pictures, which are paired by name, or a
1|pattern such as frame_%04d.png or frame_####.png, paired by number; those of a
1|video count from 0. Frames that are missing or too many are differences, and so
1|are other sizes or channels. Alpha is judged on black and on white.
1|
1|Exit code 0: the same within the limits; 1: different; 2: usage; 3: something
1|cannot be read or has values that are not finite, except where it is masked; 6:
1|--diff or --error-map cannot be written. --limit replaces all default limits.
1|
1|  -l, --limit METRIC=VALUE    The worst value that passes; more of them after
1|                              commas (see 'kiln help metrics'). Default:
1|                              flip.mean=0.01,flip.p99=0.1,window.share=0.1.
1|  -d, --diff FILE             Write a PNG of reference, test and FLIP's error
1|                              map side by side. For several frames, '%04d' or
1|                              '####' stands for the number, and a folder gets a
1|                              file named after each.
1|      --error-map FILE        Write a PNG of FLIP's error map alone, in the
1|                              pictures' size; names as --diff.
1|      --force                 Let --diff, --error-map and --json replace files
1|                              that exist.
1|  -i, --ignore X,Y,WxH        Do not judge this rectangle: there, the test is
1|                              taken from the reference.
1|      --mask FILE             Do not judge where this picture, of the same size,
1|                              is black.
1|      --layer LAYER           Layer of EXR files, such as depth or fire.
1|                              Default: beauty.
1|      --range auto|ldr|hdr    How FLIP judges light: clamped at white (ldr), or
1|                              at several exposures of the reference (hdr).
1|                              Default: auto: hdr for EXR.
1|      --ppd N                 Pixels that the viewer sees in a degree. Default:
1|                              67.0206, a 0.7 m wide screen of 3840 pixels from
1|                              0.7 m.
1|      --threshold LEVELS      Pixels that differ by more count as differing, in
1|                              1/255 of sRGB's range. Default: 2.
1|      --window N              Edge in pixels of the window in which differing
1|                              pixels are densest. Default: 32.
1|      --threads N             Threads that work; 0 takes one a core. Default: 0.
1|      --json[=FILE]           Print JSON instead of text, or also write it into
1|                              FILE: an object a line, whose "event" is "frame"
1|                              or "result".
1|      --stats                 Also print the time that it took.
1|  -q, --quiet                 Print nothing but errors and what --json asks for.
1|      --events STREAM         Tell other programs how the command goes, by lines
1|                              of JSON: 'ndjson' on standard output,
1|                              'ndjson:FILE' at the end of a file, 'ndjson:fd=N'
1|                              to an open descriptor. 'openjd' instead of
1|                              'ndjson': by lines of Open Job Description (see
1|                              'kiln help events').
1|  -h, --help                  Print this help.
1|
1|Options and operands may come in any order; '--' ends the options. Of an
1|option that is given twice the last one counts, but these add up: --limit --ignore --mask.
$ kiln help check
1|usage: kiln check [OPTION...] SCENE...
1|
1|Reads each scene ('-' is standard input, whose files lie below the working
1|directory) and prints it with every default spelled out. What it prints is a
1|scene file that renders to the same pictures. A comment at its end tells the
1|work of the whole clip: steps, particles at once, and the memory that rendering
1|without OpenGL takes, within a factor of 1.5, encoders left out. A wrong scene
1|wrong scene is reported, the other scenes are checked all the same. A scene that
1|--limits allow is exit code 8.
1|
1|      --set KEY=VALUE         Change a value of the scene, such as
1|                              systems.fire.emit.rate=500. In a key, '*' stands
1|                              for every entry of a map or list.
1|      --asset-root FOLDER     The folder that the scene's files must lie in.
1|                              Default: the folder of the scene.
1|      --limits KEY=VALUE,...  End with exit code 8 before more is taken;
1|                              'service' stands for a set of them (see 'kiln help
1|                              limits'). Default: the environment's KILN_LIMITS.
1|      --timeout TIME          End with exit code 8 after that time, loading and
1|                              encoding included: seconds, or with a unit, ms, s,
1|                              min or h. Default: none.
1|      --sandbox[=on|require|off]
1|                              Give up all rights that the job does not need, on
1|                              the device 'cpu': other files, sockets, other
1|                              programs. With 'require' it is exit code 5 where
1|                              the kernel cannot do that (see 'kiln devices').
1|                              Default: the environment's KILN_SANDBOX, or else
1|                              off.
1|      --hash                  Print only the scene's hash.
1|  -q, --quiet                 Print nothing but errors.
1|      --events STREAM         Tell other programs how the command goes, by lines
1|                              of JSON: 'ndjson' on standard output,
1|                              'ndjson:FILE' at the end of a file, 'ndjson:fd=N'
1|                              to an open descriptor. 'openjd' instead of
1|                              'ndjson': by lines of Open Job Description (see
1|                              'kiln help events').
1|  -h, --help                  Print this help.
1|
1|Options and operands may come in any order; '--' ends the options. Of an
1|option that is given twice the last one counts, but these add up: --set.
$ kiln help devices
1|usage: kiln devices [OPTION...]
1|
1|Lists this machine without OpenGL, called 'cpu', on which every stage runs in
1|threads and vectors, with the same pixels on every machine; then every device
1|that OpenGL offers without a display, with its limits. Such a device is usable
1|with OpenGL 4.3 or later; it is exact when it passed the probe of the arithmetic
1|that the simulation needs, and otherwise particles move on the CPU. A software
1|device is a rasteriser on the CPU. Last comes what the kernel has for --sandbox.
1|Advice names what is missing and the package that brings it.
1|
1|      --json[=FILE]           Print JSON instead of text, or also write it into
1|                              FILE: one object.
1|      --force                 Let --json replace a file that exists.
1|      --events STREAM         Tell other programs how the command goes, by lines
1|                              of JSON: 'ndjson' on standard output,
1|                              'ndjson:FILE' at the end of a file, 'ndjson:fd=N'
1|                              to an open descriptor. 'openjd' instead of
1|                              'ndjson': by lines of Open Job Description (see
1|                              'kiln help events').
1|  -h, --help                  Print this help.
$ kiln help help
1|usage: kiln help [OPTION...] [TOPIC]
1|
1|Explains a command or a topic; without one, lists both.
1|
1|  -h, --help                  Print this help.
$ kiln help exit-codes
1| CODE  AGAIN?     MEANING
1|    0  never      all went well
1|    1  never      a frame failed, or a picture differs
1|    2  never      the command line makes no sense, or names an output that
1|                  exists or a journal of another job
1|    3  never      a scene or another input file is wrong
1|    4  again      no usable device, or for want of one every test was skipped,
1|                  or nothing measured
1|    5  with more  the device was lost, memory ran out, a frame or test took
1|                  longer than its limit, or a test crashed
1|    6  again      reading or writing failed
1|    7  never      a golden picture is missing, or what was accepted with it
1|    8  with more  more than the limits of the job allow, or than --timeout
1|    9  again      the reader of standard output went away before the job was
1|                  done
1|  129  again      stopped by SIGHUP; only whole files are left
1|  130  again      stopped by SIGINT; only whole files are left
1|  143  again      stopped by SIGTERM; only whole files are left
1|
1|AGAIN? is for schedulers. never: the same call ends the same way. again: it may
1|succeed, on another machine where a device or a disk is the reason; with --resume
1|it goes on. with more: it may with more memory, more time, or larger limits.

The other topics.

$ kiln help techniques
1|  STAGE=auto         the default of each stage, by the tables below
1|  simulate=cpu       host threads
1|  simulate=inplace   compute, one buffer updated in place
1|  simulate=pingpong  compute, from one buffer to another; it takes twice the memory
1|  simulate=feedback  geometry shaders and transform feedback; they take twice the memory
1|  simulate=texels    fragment shaders, from textures to textures; they take three times the memory
1|  sort=cpu           stable radix sort, host threads
1|  sort=radix         stable radix sort, compute
1|  sort=bitonic       bitonic merge sort, compute, padded to a power of two
1|  sort=oddeven       odd-even merge sort, compute; oddeven:N spreads it over N frames
1|  backdrop=cpu       host threads, rays in vectors
1|  backdrop=gl        fragment shaders
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
1|  sort=cpu           threads sort several times as fast as GL on the same cores
1|  backdrop=cpu       vectors on the host are several times as fast as GL on the same cores
1|  raster=cpu         vectors on the host draw several times as fast as GL on the same cores
1|  bloom=cpu          vectors on the host are several times as fast as GL on the same cores
1|  composite=cpu      the host is faster than GL on the same cores
1|
1|'auto' on a GPU:
1|  simulate=inplace   particles stay in one buffer; it takes the least memory in GL
1|  sort=cpu           the sorts in compute have not been measured on a GPU yet
1|  backdrop=gl        the hardware casts the rays
1|  raster=geometry    the hardware blends
1|  bloom=gl           the picture is in GL already
1|  composite=gl       the picture is in GL already
1|
1|'auto' on a GPU that computes inexactly:
1|  simulate=cpu       only exact arithmetic may move particles
1|  sort=cpu           only exact arithmetic may order particles
1|  backdrop=gl        the hardware casts the rays
1|  raster=geometry    the hardware blends
1|  bloom=gl           the picture is in GL already
1|  composite=gl       the picture is in GL already
$ kiln help outputs
1|Output formats, by the suffix of the output:
1|
1|  .png   PNG images: 8 or 16 bits, sRGB; alpha with a transparent backdrop
1|  .jpg   JPEG images: 8 bits, full chroma, no alpha; quality 0 to 100, from 91 on the best; .jpeg is the same
1|  .exr   OpenEXR images: half or float, linear, premultiplied; named layers
1|  .mp4   H.264 video: even sizes, no alpha; quality 0 to 100 (visually lossless)
1|  .webm  VP9 video: for the web, with alpha; quality 0 to 100; times in whole ms
1|  .mkv   FFV1 video: lossless, 8 or 16 bits (--png-bits), with alpha; times in whole ms
1|  .mov   ProRes 4444 video: for editing, 10 bits, with alpha; quality 0 to 100
1|  .gif   GIF animation: 255 colours a clip, no alpha, at most 50 frames a second; plays forever
1|  .apng  animated PNG: lossless, 8 or 16 bits (--png-bits), with alpha; plays forever
1|  .webp  animated WebP: with alpha; quality 0 to 100 (lossless); times in whole ms; plays forever
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
1|additive or premultiplied blending.
1|
1|--flipbook-motion adds FILE_motion.png, which is linear, not sRGB. Red and green say how
1|far right and down a pixel moves until the next cell: (value * 2 - 1) * scale cells, with
1|scale from the JSON. An engine whose v points upwards negates green. At t between cells a
1|and b, an engine mixes a at uv - t * motion and b at uv + (1 - t) * motion. The motion of
1|the last cell is 0. One command must draw all cells; chunks of frames make no flipbook.
1|The files appear together, the .json last. Where the .json is, all of them are whole.
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
1|      Limits of jobs where --limits says nothing else (see 'kiln help limits').
1|  KILN_SANDBOX
1|--
1|  SGE_TASK_ID
1|      Which task this is under Grid Engine; 'undefined' outside of arrays.
1|  SGE_TASK_FIRST
$ kiln help enviroment
2|kiln: help: unknown topic 'enviroment' (did you mean 'environment'?); 'kiln help' lists the topics
= 2
