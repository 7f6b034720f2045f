Limits of a job: what is over one ends with exit code 8, with its place where the scene says it.

$ kiln check scenes/tiny.yaml | tail -n 1
1|# work: 24 frames of 64 x 36 pixels, 58 steps, up to 82 particles, about <n> MiB
$ cat >large.yaml <<END
> kiln: 1
> output: {size: [16384, 16384], fps: 1000, frames: 1000000}
> simulation: {rate: 2000}
> systems:
>   smoke: {emit: {rate: 4000000, life: 1.1 s}}
> END
$ kiln check large.yaml | tail -n 1
1|# work: 1000000 frames of 16384 x 16384 pixels, 1999998 steps, up to 4404000 particles, about <n> MiB
$ for lifted in '' ,pixels=none ,pixels=none,frames=none ,pixels=none,frames=none,steps=none ,pixels=none,frames=none,steps=none,particles=none; do
>     kiln check -q large.yaml --limits service$lifted
> done
2|large.yaml:2:16: output.size: 268435456 pixels of a frame, and the limit `pixels` is 16777216
2|large.yaml:2:51: output.frames: 1000000 frames of the clip, and the limit `frames` is 100000
2|large.yaml:2:51: output.frames: 1999998 steps of the clip, and the limit `steps` is 1000000
2|large.yaml:5:17: systems.smoke.emit: 4404000 particles at once, and the limit `particles` is 4000000
2|large.yaml:2:16: output.size: <n> of memory, and the limit `memory` is 4 GiB
= 8
$ kiln check -q large.yaml
$ kiln check -q scenes/tiny.yaml --limits service
$ kiln check -q scenes/tiny.yaml --set output.frames=60 --limits frames=50
2|--set output.frames: 60 frames of the clip, and the limit `frames` is 50
= 8
$ KILN_LIMITS=frames=10 kiln render scenes/tiny.yaml -o a.mp4
2|scenes/tiny.yaml:4:43: output.frames: 24 frames of the clip, and the limit `frames` is 10
= 8
$ KILN_LIMITS=frames=10 kiln render scenes/tiny.yaml -o a.mp4 --frames 0-5 -q --limits frames=none && ls a.mp4
1|a.mp4
$ KILN_LIMITS=frmes=10 kiln check scenes/tiny.yaml
2|kiln: KILN_LIMITS: 'frmes' is not a limit; did you mean 'frames'?
= 2
$ kiln check scenes/tiny.yaml --limits memory=1d
2|kiln: check: --limits: memory: found '1d'; expected a number of bytes, kB, MB, GB, TB, KiB, MiB, GiB or TiB, or none
= 2
$ kiln help limits | head -n 8
1|--limits KEY=VALUE,... sets limits, and so does the environment's KILN_LIMITS; --limits is read
1|last. `service` stands for all values of its column, `none` lifts a limit. A job that goes over a
1|limit ends with exit code 8 and leaves no half-written file; --resume may go on. render, bake,
1|export, plan and check have all limits. encode and join have memory, time, cpu and output. Tests
1|have a time limit of their own.
1|
1|KEY           service
1|pixels        16777216    Width times height of the pictures.

Files that a scene names are counted before memory is taken for them.

$ cat >files.yaml <<END
> kiln: 1
> systems:
>   a: {emit: {rate: 10}, look: {atlas: scenes/puff.png}}
> END
$ kiln check -q files.yaml --limits asset_pixels=100
2|files.yaml:3:39: systems.a.look.atlas: 'scenes/puff.png': 1024 decoded pixels of pictures, and the limit `asset_pixels` is 100
= 8
$ kiln check -q files.yaml --limits asset_bytes=10
2|files.yaml:3:39: systems.a.look.atlas: 'scenes/puff.png': 315 bytes of files that the scene names, and the limit `asset_bytes` is 10 bytes
= 8
$ printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n' >four.obj
$ printf 'kiln: 1\nbackdrop: {objects: [{mesh: {file: four.obj}}]}\nsystems: {a: {emit: {rate: 1}}}\n' >mesh.yaml
$ kiln check -q mesh.yaml --limits triangles=3
2|mesh.yaml:2:36: backdrop.objects.0.mesh.file: 'four.obj': 4 triangles of meshes, and the limit `triangles` is 3
= 8

A job ends soon after its time, wherever it is, and may be gone on with.

$ kiln render scenes/tiny.yaml -q -o late.mp4 --fps 10 --set output.frames=61 --set systems.smoke.emit.rate=3000000 --timeout 1 --resume 2>&1 | sed 's/taken .* since/taken <s> since/; s/; unfinished files are.*//'; ls -d late.mp4*
1|kiln: the job has taken <s> since it began, and the limit `time` is 1 s
1|late.mp4.journal
1|late.mp4.parts
$ kiln render scenes/tiny.yaml -q -o huge.png --frames 0 --device cpu --threads 1 --size 4096x4096 --set camera.shutter.samples=64 --set simulation.rate=3840 --timeout 0.5 2>&1 | sed 's/taken .* since/taken <s> since/; s/; unfinished files are.*//'
1|kiln: the job has taken <s> since it began, and the limit `time` is 0.5 s
$ kiln check scenes/tiny.yaml -q --timeout 0.001 2>&1 | sed 's/taken .* since/taken <s> since/'
1|loading scenes/tiny.yaml: the job has taken <s> since it began, and the limit `time` is 0.001 s
$ { cat scenes/tiny.yaml; seq 50000 | sed 's/^/# /'; } >scenes/slow.yaml; kiln render scenes/slow.yaml scenes/empty.yaml -q -o '{scene}.png' --limits cpu=1ms 2>&1 | sed 's/taken .* of/taken <s> of/'
1|loading scenes/slow.yaml: the job has taken <s> of processor time, and the limit `cpu` is 0.001 s
1|loading scenes/empty.yaml: the job has taken <s> of processor time, and the limit `cpu` is 0.001 s
$ kiln check - -q --timeout 0.1 < <(sleep 2) 2>&1 | sed 's/taken .* since/taken <s> since/'
1|kiln: loading standard input: the job has taken <s> since it began, and the limit `time` is 0.1 s; unfinished files are discarded
$ kiln render scenes/tiny.yaml -q -o late.webm --limits cpu=20ms 2>&1 | sed 's/taken .* of/taken <s> of/; s/; unfinished files are.*//'
1|kiln: the job has taken <s> of processor time, and the limit `cpu` is 0.02 s
$ kiln render scenes/tiny.yaml -q -o late.webm --size 1280x720 --limits memory=80MiB
2|--set output.size: <n> of memory, and the limit `memory` is 80 MiB
= 8
$ ls -A | grep -e huge -e webm
= 1

Nor is more written than it may.

$ kiln render scenes/tiny.yaml -q -o out/%02d.png --limits output=19kB --threads 1; find out -size 0; ls -A out | grep tmp
2|kiln: out/09.png: 19.25 KiB of output, and the limit `output` is 18.55 KiB
= 1
$ kiln render scenes/tiny.yaml -q -o out.mp4 --limits output=3kB; kiln render scenes/tiny.yaml -q -o - --limits output=10kB | wc -c
1|7002
2|kiln: out.mp4: 3.965 KiB of output, and the limit `output` is 2.93 KiB
2|kiln: standard output: 10.22 KiB of output, and the limit `output` is 9.766 KiB
$ kiln render scenes/tiny.yaml -q -o out.gif --resume --limits output=3kB; kiln encode out -o out.mkv --limits output=1kB
2|kiln: out.gif.parts/00000.part: 270.9 KiB of output, and the limit `output` is 2.93 KiB
2|kiln: out.mkv: 5.744 KiB of output, and the limit `output` is 1000 bytes
= 8
$ ls -d out*
1|out
1|out.gif.journal
1|out.gif.parts

Every scene has limits, and far from the origin steps may be too small for positions of 32 bits.

$ kiln help limits | sed -n '21,$p'
1|
1|A scene has at most these, whatever the limits:
1|
1|systems       64          Particle systems.
1|particles     33554432    Particles that may live at once; in OpenGL, 16777216.
1|forces        32          Forces of a system.
1|bursts        64          Bursts of a system.
1|demitters     8           Boxes of a system in which particles die.
1|generations   4           Generations of systems, parents to last descendants.
1|textures      8           Textures of a system.
1|cells         2048        Cells of a texture; in OpenGL, of all textures together.
1|entries       1024        Entries of a list or mapping, such as the keys of a value.
1|keys          65536       Keys of all values; in OpenGL, 1024 of them of lives.
1|objects       256         Objects of the backdrop, meshes and terrain included.
1|meshes        64          Meshes and terrains of the backdrop.
1|lights        64          Lights of the backdrop.
1|nodes         256         Nodes.
1|points        1024        Points of a node's path.
1|parameters    256         Parameters.
1|includes      64          Included files, through at most 8 files.
1|copies        100000      Nodes that aliases, uses and parameters copy.
1|ways          16777216    Steps of the ways of emitters by the metre, in all.
1|winds         8           Files of wind.
1|sources       2097152     Triangles, vertices and pixels that particles are born on.
1|baked         8           Baked winds, of up to 12 forces each.
1|gas           4           Domains of gas.
1|gas_cells     268435456   Cells of all domains of gas, of which an edge has at most 1024.
1|gas_sources   8           Sources of a domain of gas.
1|substeps      16          Steps of gas in a step of the scene.
1|steps         4194303     Steps of a run, warm-up included.
1|
1|Positions are 32-bit floats, so small steps far from the origin are rounded. Speeds are true to
1|1 % from these on; kiln warns of systems whose particles are slower:
1|
1|FROM THE ORIGIN    60 steps/s   240 steps/s  1000 steps/s
1|           10 m   0.00286 m/s    0.0114 m/s    0.0477 m/s
1|          100 m    0.0229 m/s    0.0916 m/s     0.381 m/s
1|         1000 m     0.183 m/s     0.732 m/s      3.05 m/s
1|        10000 m      2.93 m/s      11.7 m/s      48.8 m/s
1|       100000 m      23.4 m/s      93.8 m/s       391 m/s
$ cat >far.yaml <<END
> kiln: 1
> output: {size: [32, 32], fps: 50, frames: 3}
> simulation: {rate: 1000}
> systems:
>   slow: {emit: {rate: 9, speed: 0.01, from: {point: {origin: [100, 0, 0], direction: [1, 0, 0]}}}}
> END
$ kiln check -q far.yaml && kiln render far.yaml -q -o none && kiln check -q far.yaml --set systems.slow.emit.speed=0.5
2|kiln: warning: far.yaml:5:33: systems.slow.emit.speed: a step of particles at 0.01 m/s is 1e-05 m, and positions 100 m from the origin are multiples of 7.6e-06 m, so that their speed is up to 38 % off; at 1000 steps a second, speeds from 0.381 m/s on are true to 1 % there: lower simulation.rate, or move the scene to the origin
2|kiln: warning: far.yaml:5:33: systems.slow.emit.speed: a step of particles at 0.01 m/s is 1e-05 m, and positions 100 m from the origin are multiples of 7.6e-06 m, so that their speed is up to 38 % off; at 1000 steps a second, speeds from 0.381 m/s on are true to 1 % there: lower simulation.rate, or move the scene to the origin

Cells of gas, and their number times the steps of the gas.

$ printf '%s\n' 'kiln: 1' 'gas: {a: {box: {size: [1, 1, 1]}, cells: 64, substeps: 2, sources: [{}]}}' >gas.yaml; kiln check -q gas.yaml --limits service
$ kiln check -q gas.yaml --limits gas_cells=262143
2|gas.yaml:2:6: gas: 262144 cells of gas, and the limit `gas_cells` is 262143
= 8
$ kiln check -q gas.yaml --limits gas_steps=156237823
2|gas.yaml:2:6: gas: 156237824 cells of gas in all steps, and the limit `gas_steps` is 156237823
= 8
$ kiln check -q gas.yaml --limits gas_steps=156237824
$ kiln check -q gas.yaml --set gas.a.cells=512 --limits service
2|gas.yaml:2:6: gas: 134217728 cells of gas, and the limit `gas_cells` is 33554432
= 8
$ kiln check -q gas.yaml --set gas.a.cells=400 --limits memory=1GiB
2|gas.yaml:2:6: gas: <n> of memory, and the limit `memory` is 1 GiB
= 8
$ kiln help limits | grep -E 'gas|substeps'
1|gas_cells     33554432    Cells of all domains of gas.
1|gas_steps     12 G        Cells of gas times its steps up to the last frame.
1|gas           4           Domains of gas.
1|gas_cells     268435456   Cells of all domains of gas, of which an edge has at most 1024.
1|gas_sources   8           Sources of a domain of gas.
1|substeps      16          Steps of gas in a step of the scene.
