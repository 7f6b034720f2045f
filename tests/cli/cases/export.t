Gas as OpenVDB files. A scene without gas has nothing to export.

$ kiln export scenes/tiny.yaml -o gas_####.vdb
2|kiln: scenes/tiny.yaml: the scene has no gas to export (see 'kiln help scene gas')
= 2
$ kiln export scenes/tiny.yaml -o gas_####.vdb --gas fire --json
2|kiln: scenes/tiny.yaml: the scene has no gas to export (see 'kiln help scene gas')
= 2
$ kiln export scenes/tiny.yaml -o gas_####.vdb --events ndjson | jq -c '[.event, .code]'
1|["started",null]
1|["loaded",null]
1|["error",2]
1|["ended",2]
2|kiln: scenes/tiny.yaml: the scene has no gas to export (see 'kiln help scene gas')
$ kiln export none.yaml -o gas_####.vdb
2|none.yaml: No such file or directory
= 3

Options.

$ kiln export scenes/tiny.yaml
2|kiln: export: needs --output FILE
= 2
$ kiln export
2|kiln: export: needs SCENE
= 2
$ kiln export scenes/tiny.yaml scenes/tiny.yaml -o gas_####.vdb
2|kiln: export: one operand too many, 'scenes/tiny.yaml'
= 2
$ kiln export scenes/tiny.yaml -o gas_####.vdb --up x
2|kiln: export: --up: found 'x', expected one of y|z
= 2
$ kiln export scenes/tiny.yaml -o gas_####.vdb --temperature celsius
2|kiln: export: --temperature: found 'celsius', expected one of kelvin|unit
= 2
$ kiln export scenes/tiny.yaml -o gas_####.vdb --cutoff 2
2|kiln: export: --cutoff: found '2', expected a number from 0 to 1
= 2
$ kiln export scenes/tiny.yaml -o gas_####.vdb --frames 20-30
2|kiln: export: --frames: found frame 30, but 'scenes/tiny.yaml' has frames 0-23
= 2
$ kiln export scenes/tiny.yaml -o gas_####.vdb --halves
2|kiln: export: unknown option '--halves'
= 2
$ kiln help export | head -n 9
1|usage: kiln export [OPTION...] SCENE
1|
1|Steps through the clip and writes the smoke and fire of its gas, an OpenVDB file
1|for each frame and domain, for programs such as Houdini, Blender and Unreal. A
1|file has the grids density, temperature, flame and vel (velocities in m/s), and
1|Cd if smoke has colours of its own, with one voxel for each cell of the domain;
1|a frame without gas is a file with empty grids. Each file appears under its name
1|only when it is whole.
1|
$ ls
1|scenes

A domain without sources stays empty; its files say so. Each frame and domain has a file.

$ cat >gas.yaml <<END
> kiln: 1
> output: {size: [16, 16], fps: 10, frames: 4}
> nodes: {cart: {position: {keys: {0 s: [0, 0, 0], 1 s: [10, 0, 0]}}}}
> gas:
>   fire: {box: {center: [0, 1.5, 0], size: [1, 3, 1]}, cell: 0.125}
>   plume: {box: {center: [0, 1, 0], size: [2, 2, 2]}, cells: 16, attach: cart}
> END
$ kiln export gas.yaml -o 'out/{gas}/f_##.vdb' --half --up z --frames 1,3 2>/dev/null
1|out/fire/f_01.vdb: frame 1, 0 voxels, <n> bytes
1|out/plume/f_01.vdb: frame 1, 0 voxels, <n> bytes
1|out/fire/f_03.vdb: frame 3, 0 voxels, <n> bytes
1|out/plume/f_03.vdb: frame 3, 0 voxels, <n> bytes
1|out/{gas}/f_##.vdb: 4 files, <n> bytes, after 18 steps in <s> s
$ ls -R out
1|out:
1|fire
1|plume
1|
1|out/fire:
1|f_01.vdb
1|f_03.vdb
1|
1|out/plume:
1|f_01.vdb
1|f_03.vdb
$ kiln export gas.yaml --gas plume -o plume.vdb --json --frames 0-1 2>/dev/null
1|{"event": "exported", "scene": "gas.yaml", "gas": "plume", "file": "plume_0000.vdb", "frame": 0, "bytes": <n>, "voxels": 0, "done": 1, "total": 2, "elapsed_s": <s>}
1|{"event": "exported", "scene": "gas.yaml", "gas": "plume", "file": "plume_0001.vdb", "frame": 1, "bytes": <n>, "voxels": 0, "done": 2, "total": 2, "elapsed_s": <s>}
1|{"event": "result", "scene": "gas.yaml", "output": "plume.vdb", "first_file": "plume_0000.vdb", "frames": 2, "files": 2, "steps": 6, "bytes": <n>, "total_s": <s>}
$ kiln export gas.yaml --gas plume -o 'plume_####.vdb' --frames 0-1 2>&1 | tail -n 1
1|kiln: plume_0000.vdb: the file exists (--force replaces it)
$ kiln export gas.yaml --gas plume -o 'plume_####.vdb' --frames 0-1 --force --quiet 2>/dev/null
$ kiln export gas.yaml --gas plume -o 'p_#.vdb' --frames 0-1 --device cpu --events openjd 2>/dev/null
1|openjd_progress: 0
1|openjd_status: kiln 0.2.0: export
1|openjd_status: warning: gas.yaml:5:9: gas.fire.sources: the domain has no sources, so it stays empty
1|openjd_status: warning: gas.yaml:6:10: gas.plume.sources: the domain has no sources, so it stays empty
1|openjd_status: gas.yaml: 4 frames of 16x16
1|openjd_progress: 50
1|openjd_status: file 1 of 2
1|p_0.vdb: frame 0, 0 voxels, <n> bytes
1|p_1.vdb: frame 1, 0 voxels, <n> bytes
1|p_#.vdb: 2 files, <n> bytes, after 6 steps in <s> s
1|openjd_progress: 100
$ kiln export gas.yaml --gas fire -o fire.vdb --frames last --sandbox -q 2>/dev/null
$ kiln export gas.yaml --gas fire -o again.vdb --frames last -q 2>/dev/null && cmp fire.vdb again.vdb

What is refused.

$ kiln export gas.yaml -o 'gas_#.vdb' 2>&1 | tail -n 1
1|kiln: gas_#.vdb: the scene has 2 domains of gas, which need {gas} for their names in the name of the files, as in gas_{gas}_####.vdb
$ kiln export gas.yaml -o 'gas_#.vdb' --gas smoke 2>&1 | tail -n 1
1|kiln: gas.yaml: the scene has no gas 'smoke'; it has fire, plume
$ kiln export gas.yaml -o 'gas_#.png' --gas fire 2>&1 | tail -n 1
1|kiln: gas_#.png: gas is exported to files with the suffix .vdb
$ kiln export gas.yaml -o 'gas_#.vdb' --gas fire --set gas.fire.enabled=false 2>&1 | tail -n 1
1|kiln: gas.yaml: this gas is not enabled
$ kiln export gas.yaml -o 'gas_#.vdb' --gas fire --json=gas_2.vdb 2>&1 | tail -n 1
1|kiln: gas_2.vdb: --json and --output would both write this file
$ kiln export gas.yaml -o 'gas_#.vdb' --gas fire --limits output=3000 2>&1 | sed -n 's/[0-9.]* KiB of/N KiB of/p'
1|kiln: gas_1.vdb: N KiB of output, and the limit `output` is 2.93 KiB
$ ls gas*
1|gas.yaml
1|gas_0.vdb

Threads and saved states change no byte.

$ cat >hot.yaml <<END
> kiln: 1
> output: {size: [16, 16], frames: 10}
> gas: {fire: {box: {center: [0, 1, 0], size: [1, 2, 1]}, cells: 32, sources: [{from: {disc: {radius: 0.2 m}}}]}}
> END
$ kiln bake hot.yaml -o hot --every 4 -q
$ kiln export hot.yaml -o hot_1.vdb --frames 6 -q --threads 1
$ kiln export hot.yaml -o hot_2.vdb --frames 6 -q --threads 2 && cmp hot_1.vdb hot_2.vdb
$ kiln export hot.yaml -o hot_3.vdb --frames 6 -q --states hot && cmp hot_1.vdb hot_3.vdb
