Jobs with gas give the same bytes, however they are cut, stopped and begun again.

$ cat >gas.yaml <<'END'
> # A small fire in wind that flows around a moving box, with coloured smoke and sparks that ride it, in 64 x 36 pixels.
> kiln: 1
> seed: 7
> output: {size: [64, 36], fps: 10, frames: 41}
> simulation: {rate: 20}
> camera: {position: [0, 0.8, 2.4], target: [0, 0.7, 0]}
> nodes:
>   mover: {position: {keys: {0 s: [-0.3, 0, 0], 3 s: [0.3, 0, 0]}}}
> backdrop:
>   objects:
>     block: {box: {center: [0, 0.5, 0], size: [0.2, 0.2, 0.2], attach: mover}}
> gas:
>   fire:
>     box: {size: [1, 1.6, 1]}
>     cells: 32
>     sources:
>       - {from: {disc: {radius: 0.2 m}}, smoke: 0.3, color: [0.9, 0.4, 0.1], velocity: [0, 0.5, 0], noise: {amount: 0.5}}
>     turbulence: {strength: 2}
>     forces: [wind: {velocity: [0.3, 0, 0], pull: 0.5}]
> systems:
>   sparks:
>     emit: {rate: 40, life: 1 s, from: {disc: {radius: 0.2 m}}}
>     forces: [wind: {gas: fire, pull: 4, cells: 16}]
>     look: {atlas: "builtin:spark", blend: add, size: 3 cm}
> END
$ kiln render gas.yaml -q -o ref_%02d.png --manifest ref.json
$ kiln bake gas.yaml -q -o states --every 10 && ls states | wc -l
1|4
$ kiln render gas.yaml -q -o part_%02d.png --frames 3,17,35-36 --states states --stats | grep steps
1|  steps        32
2|kiln: warning: states: there is no state of 'gas.yaml' at or before frame 3; stepping from the start
$ for frame in 03 17 35 36; do cmp ref_$frame.png part_$frame.png; done

States in which the gas has another size belong to another motion. What only the picture shows needs no other.

$ kiln render gas.yaml -q -o none --frames 35 --states states --set gas.fire.look.extinction=9 --stats | grep steps
1|  steps        10
$ kiln render gas.yaml -q -o none --frames 3 --states states --set gas.fire.cells=48 --stats 2>&1 | grep -o 'there is no state.*'
1|there is no state of 'gas.yaml' at or before frame 3 (4 states belong to other motions: bake again); stepping from the start

Frames that are missing are drawn anew, by steps from the beginning or by a state.

$ kiln render gas.yaml -q -o f_%02d.png --resume
$ rm f_05.png f_22.png && truncate -s 20 f_30.png && kiln render gas.yaml -o f_%02d.png --resume --states states --progress none
1|device: <device>
1|f_00.png and 40 more: 3 frames in <s> s, 38 kept
2|kiln: warning: states: there is no state of 'gas.yaml' at or before frame 5; stepping from the start
$ for file in ref_*.png; do cmp $file ${file/ref/f}; done

Shards of a clip, with and without states, make the clip of one run.

$ kiln render gas.yaml -q -o ref.mp4
$ kiln render gas.yaml -q -o c.mp4 --shard 1/2 && kiln render gas.yaml -q -o c.mp4 --shard 2/2 --states states
$ kiln join c.mp4 && cmp ref.mp4 c.mp4
1|c.mp4: 41 frames in 3 parts

A clip that was stopped goes on with its whole parts. The gas is stepped from the beginning.

$ mkfifo frames
> env --default-signal kiln render gas.yaml -o stopped.mp4 --resume --json >frames & job=$!
> exec 3<frames
> for line in {1..25}; do read -r -u 3; done
> kill -TERM $job; cat <&3 >/dev/null; wait $job
2|kiln: gas.yaml: stopped by SIGTERM after <n> frames
= 143
$ ls -d stopped.mp4* && kiln render gas.yaml -q -o stopped.mp4 --resume && cmp ref.mp4 stopped.mp4
1|stopped.mp4.journal
1|stopped.mp4.parts

Exports are those of a run from the beginning, too.

$ kiln export gas.yaml -q -o e_##.vdb --frames 0,35 && kiln export gas.yaml -q -o s_##.vdb --frames 0,35 --states states && cmp e_00.vdb s_00.vdb && cmp e_35.vdb s_35.vdb

Plans count what gas takes, step by step, also from saved states.

$ kiln plan gas.yaml --device cpu --tasks 2 --json | jq -c '.tasks[] | [.frames, .steps, .cpu_s > 0]'
1|[[0,39],78,true]
1|[[40,40],80,true]
$ kiln plan gas.yaml --device cpu --tasks 2 --states states --json | jq -c '.tasks[] | [.frames, .steps, .cpu_s > 0]'
1|[[0,39],78,true]
1|[[40,40],0,true]

Limits of cells, of their steps and of memory, before a step is run.

$ kiln check gas.yaml -q --limits service
$ kiln check gas.yaml -q --limits service --set gas.fire.cells=512
2|gas.yaml:13:3: gas: 52428800 cells of gas, and the limit `gas_cells` is 33554432
= 8
$ kiln render gas.yaml -q -o none --limits service --set gas.fire.cells=400 --set output.frames=2000
2|gas.yaml:13:3: gas: 104805171200 cells of gas in all steps, and the limit `gas_steps` is 12000000000
= 8
$ kiln check gas.yaml -q --limits gas_steps=2M
2|gas.yaml:13:3: gas: 2621440 cells of gas in all steps, and the limit `gas_steps` is 2000000
= 8
$ kiln check gas.yaml -q --limits memory=1GiB --set gas.fire.cells=400
2|gas.yaml:13:3: gas: <n> of memory, and the limit `memory` is 1 GiB
= 8
