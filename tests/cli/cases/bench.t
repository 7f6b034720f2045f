kiln bench: what is measured and in which form. No number of it is looked at.

$ kiln bench --list | sed -E 's/ [0-9]+\.[0-9] min/ <time>/'
1|  seed        <time>  the first techniques and auto compared: whole frames with PNG, and stages
1|  sizes       <time>  frames of the four sizes of Heinz 2019, table 4.1, pass by pass
1|  figure4.4   <time>  Heinz 2019, figure 4.4: techniques of simulation by particles
1|  figure4.5   <time>  Heinz 2019, figure 4.5: rendering fire and smoke, and the whole frame
1|  figure4.6   <time>  Heinz 2019, figure 4.6: techniques of sorting by particles
1|  table1      <time>  UberFlow, table 1: sorting 128^2 to 1024^2 particles
1|  table2      <time>  UberFlow, table 2: experiments E1 to E5
1|  curves      <time>  cost over 1,000 to 4,000,000 particles and 4 to 256 pixels
1|  groups      <time>  kernels by the size of their work groups (Heinz 2019, 2.2.5)
1|  forces      <time>  simulation by its force and integrator; baked winds
1|  colliders   <time>  simulation by the objects that particles bounce off, and the building of volumes
1|  balls       <time>  simulation of 100,000 balls that collide, without and with spin
1|  flock       <time>  flocks of 4,096 and 16,384, by the particles that each looks at (Drone 2007, 7.4.4)
1|  gravity     <time>  gravity of all pairs, frames with it, and conservation of energy (Drone 2007, 7.4.3)
1|  paint       <time>  painting with particles by its gather (Drone 2007, 7.6.1)
1|  bytes       <time>  memory and communication of techniques (Heinz 2019, 4.2)
1|  states      <time>  size of saved states, and time to save and to load one
1|  gas         <time>  steps of gas by pass, level and threads; its memory, drawing, states and export
1|  jobs        <time>  64 parts of a clip with states compared with one run, and many workers
1|  threads     <time>  CPU time of a frame with 1, 2 and 8 threads, and how much of it is serial
1|  output      <time>  whole jobs to PNG, EXR and mp4, compared with the time of their stages
1|All suites together take <time> on two cores without a GPU.

Of a scene: whole frames, then the techniques of each stage, that of `auto` first.

$ kiln bench scenes/tiny.yaml --device software --quick --stage bloom,composite --format csv | cut -d, -f1-3,5-8
1|suite,part,sweep,measure,technique,unit,turns
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,simulate,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,sort,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,lighting,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,backdrop,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,gas,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,particles,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,bloom,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,composite,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,readback,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,output,auto,ms,3
1|scenes/tiny.yaml,scenes/tiny.yaml,particles,frame,auto,ms,3
1|scenes/tiny.yaml,"scenes/tiny.yaml, bloom",57,bloom,bloom=cpu,ms
1|scenes/tiny.yaml,"scenes/tiny.yaml, bloom",57,bloom,bloom=gl,ms
1|scenes/tiny.yaml,"scenes/tiny.yaml, bloom",57,frame,bloom=cpu,ms
1|scenes/tiny.yaml,"scenes/tiny.yaml, bloom",57,frame,bloom=gl,ms
1|scenes/tiny.yaml,"scenes/tiny.yaml, composite",57,composite,composite=cpu,ms
1|scenes/tiny.yaml,"scenes/tiny.yaml, composite",57,composite,composite=gl,ms
1|scenes/tiny.yaml,"scenes/tiny.yaml, composite",57,frame,composite=cpu,ms
1|scenes/tiny.yaml,"scenes/tiny.yaml, composite",57,frame,composite=gl,ms
2|scenes/tiny.yaml: whole frames from frame 12 on
2|scenes/tiny.yaml: techniques of bloom
2|scenes/tiny.yaml: techniques of composite
$ kiln bench scenes/tiny.yaml --device software --quick --stage simulate --technique simulate=cpu --format json --quiet | jq -c '.device.software, .quick, .turns, [.parts[].name], .parts[0].notes, ([.parts[0].rows[] | .value.median >= .value.first_quartile and .value.first_quartile >= .value.least and .value.turns == 3] | all)'
1|true
1|true
1|3
1|["scenes/tiny.yaml"]
1|["64 x 36 pixels, 2 steps a frame, from frame 12 on."]
1|true
$ kiln bench scenes/tiny.yaml --device software --quick --set output.size=[32,32] --frame 2 --stage bloom --quiet | sed -E 's/[0-9]+\.[0-9]+|[0-9]+ s$/N/g; s/ +/ /g' | grep -v '^kiln'
1|
1|scenes/tiny.yaml: a frame, pass by pass
1| particles measure technique ms quartiles turns
1| 46 simulate auto N N - N 3
1| 46 sort auto N N - N 3
1| 46 lighting auto N N - N 3
1| 46 backdrop auto N N - N 3
1| 46 gas auto N N - N 3
1| 46 particles auto N N - N 3
1| 46 bloom auto N N - N 3
1| 46 composite auto N N - N 3
1| 46 readback auto N N - N 3
1| 46 output auto N N - N 3
1| 46 frame auto N N - N 3
1| 32 x 32 pixels, 2 steps a frame, from frame 2 on.
1|
1|scenes/tiny.yaml, bloom: techniques of bloom
1| particles measure technique ms quartiles turns times as fast as bloom=cpu
1| 46 bloom bloom=cpu N N - N 3
1| 46 bloom bloom=gl N N - N 3 N (N - N)
1| 46 frame bloom=cpu N N - N 3
1| 46 frame bloom=gl N N - N 3 N (N - N)

What cannot be.

$ kiln bench tabel1
2|kiln: bench: 'tabel1' is neither a scene file (*.yaml) nor a suite (did you mean 'table1'?)
= 2
$ kiln bench no.yaml
2|no.yaml: No such file or directory
= 3
$ kiln bench --stage sortt scenes/tiny.yaml
2|kiln: bench: there is no stage 'sortt' (did you mean 'sort'?)
= 2
$ kiln bench --size 32x32 seed
2|kiln: bench: --size is for scenes, and no scene is given
= 2
$ kiln bench --repeat 2 seed
2|kiln: bench: --repeat: found '2', expected a whole number from 3 to 101
= 2
$ kiln bench --technique sort=quick scenes/tiny.yaml --quick 2>&1 | sed 's/; there is.*//'
1|kiln: bench: technique: sort 'quick' is not known; allowed are cpu, radix, bitonic, oddeven, auto

$ kiln bench bytes --parts 4
2|kiln: bench: --parts is for the suite jobs, and the suite is not named
= 2
$ kiln bench states --cells 64
2|kiln: bench: --cells is for the suite gas, and the suite is not named
= 2
$ kiln bench threads scenes/tiny.yaml --size 32x32
2|kiln: bench: --size is for scenes, and no scene is measured by itself
= 2
$ kiln bench jobs scenes/tiny.yaml scenes/empty.yaml
2|kiln: bench: the suite jobs takes one scene; found 2
= 2
$ kiln bench jobs scenes/tiny.yaml --stage sort
2|kiln: bench: --stage is for scenes, and no scene is measured by itself
= 2
$ mkdir kept; TMPDIR=kept kiln bench jobs --set systems.fire.emit.raet=1 --device cpu --quiet; code=$?; ls -A kept; exit $code
2|--set systems.fire.emit.raet: unknown key (did you mean 'rate'?)
= 3
$ TMPDIR=kept kiln bench jobs --size 33x33 --device cpu --quiet 2>&1 | sed 's/kiln-bench-[^/]*/<folder>/'; code=${PIPESTATUS[0]}; ls -A kept; exit $code
1|kiln: bench: kiln render has exit code 2: kiln: kept/<folder>/turn/single.mp4: the video would have 33 x 33 pixels; H.264 needs even sizes, the nearest is 34x34
= 2

A folder that takes no files is found before anything is measured.

$ kiln bench bytes --quick --device software -o scenes/tiny.yaml
2|kiln: bench: scenes/tiny.yaml: the path is not a folder, but scenes/tiny.yaml/bench.txt needs a folder here
= 2
$ kiln bench bytes --quick --device software -o /proc/kiln 2>&1 | sed 's/: [A-Z].*/: <why>/'
1|kiln: /proc/kiln: the folder cannot be made: <why>

A signal leaves nothing behind but the folder.

$ mkdir scratch && (TMPDIR=$PWD/scratch exec env --default-signal timeout --foreground --preserve-status -s INT 2 kiln bench output --device software --quiet -o stopped)
2|kiln: bench: stopped by SIGINT; nothing is written
= 130
$ ls -A scratch stopped
1|scratch:
1|
1|stopped:
$ (TMPDIR=$PWD/scratch exec env --default-signal timeout --foreground --preserve-status -s INT 2 kiln bench jobs --device cpu --quiet)
2|kiln: bench: stopped by SIGINT; nothing is written
= 130
$ ls -A scratch
