Saved states, one for each part of a clip: two seconds of it, here 20 frames.

$ kiln bake scenes/tiny.yaml -o states --fps 10 --set output.frames=50
1|frame 0: step 12, 24 particles, <n> bytes
1|frame 20: step 132, 38 particles, <n> bytes
1|frame 40: step 252, 38 particles, <n> bytes
1|states: 3 states of motion a37c7513dbddf799 after 252 steps in <s> s
$ ls states
1|a37c7513dbddf799-00000012.kilnstate
1|a37c7513dbddf799-00000132.kilnstate
1|a37c7513dbddf799-00000252.kilnstate
$ kiln render scenes/tiny.yaml -q --fps 10 --set output.frames=50 --frames 44-45 -o full_%d.png
$ kiln render scenes/tiny.yaml -q --fps 10 --set output.frames=50 --frames 44-45 -o part_%d.png --states states --stats | grep steps
1|  steps        30
$ cmp full_44.png part_44.png && cmp full_45.png part_45.png

A change of the look needs no new bake, one of the motion does.

$ kiln render scenes/tiny.yaml -q --fps 10 --set output.frames=50 --set post.exposure=1 --frames 45 -o none --states states --stats | grep steps
1|  steps        30
$ kiln render scenes/tiny.yaml -q --fps 10 --set output.frames=50 --seed 3 --frames 45 -o none --states states --stats | grep steps
1|  steps        282
2|kiln: warning: states: there is no state of 'scenes/tiny.yaml' at or before frame 45 (3 states belong to other motions: bake again); stepping from the start

Every N frames or seconds; what is there is kept with --resume, replaced with --force.

$ kiln bake scenes/tiny.yaml -o states --fps 10 --set output.frames=50
2|kiln: states/a37c7513dbddf799-00000012.kilnstate: the file exists (--force replaces it)
= 2
$ kiln bake scenes/tiny.yaml -o states --fps 10 --set output.frames=50 --every 1s --resume
1|frame 0: kept, <n> bytes
1|frame 10: step 72, 42 particles, <n> bytes
1|frame 20: kept, <n> bytes
1|frame 30: step 192, 38 particles, <n> bytes
1|frame 40: kept, <n> bytes
1|states: 5 states of motion a37c7513dbddf799 after 120 steps in <s> s
$ kiln bake scenes/tiny.yaml -o states --fps 10 --set output.frames=50 --every 20 --force --quiet && ls states | wc -l
1|5
$ kiln bake scenes/tiny.yaml -o other --fps 10 --set output.frames=50 --every 20 --json
1|{"event": "state", "file": "other/a37c7513dbddf799-00000012.kilnstate", "frame": 0, "step": 12, "alive": 24, "bytes": <n>, "kept": false, "done": 1, "total": 3}
1|{"event": "state", "file": "other/a37c7513dbddf799-00000132.kilnstate", "frame": 20, "step": 132, "alive": 38, "bytes": <n>, "kept": false, "done": 2, "total": 3}
1|{"event": "state", "file": "other/a37c7513dbddf799-00000252.kilnstate", "frame": 40, "step": 252, "alive": 38, "bytes": <n>, "kept": false, "done": 3, "total": 3}
1|{"event": "result", "scene": "scenes/tiny.yaml", "output": "other", "motion": "a37c7513dbddf799d33238a1a450baefcc1fd98bbd7cbc022401ce96aaac621a", "states": 3, "kept": 0, "steps": 252, "bytes": <n>, "total_s": <s>}

Of several states the last before the frame is used, one that is damaged is not.

$ printf X | dd of=$(ls states/*-00000252.kilnstate) bs=1 seek=300 conv=notrunc status=none
$ kiln render scenes/tiny.yaml -q --fps 10 --set output.frames=50 --frames 44 -o again_%d.png --states states --stats | grep steps
1|  steps        84
2|kiln: warning: states/a37c7513dbddf799-00000252.kilnstate: the file is damaged; the state is not used
$ cmp full_44.png again_44.png
$ for state in states/*; do truncate -s 100 $state; done
$ kiln render scenes/tiny.yaml -q --fps 10 --set output.frames=50 --frames 21 -o none --states states --stats | grep steps
1|  steps        138
2|kiln: warning: states/a37c7513dbddf799-00000132.kilnstate: the file is cut off; the state is not used
2|kiln: warning: states/a37c7513dbddf799-00000072.kilnstate: the file is cut off; the state is not used
2|kiln: warning: states/a37c7513dbddf799-00000012.kilnstate: the file is cut off; the state is not used
2|kiln: warning: states: there is no state of 'scenes/tiny.yaml' at or before frame 21; stepping from the start
$ kiln bake scenes/tiny.yaml -o states --fps 10 --set output.frames=50 --resume | tail -n 1
1|states: 3 states of motion a37c7513dbddf799 after 252 steps in <s> s
2|kiln: warning: states/a37c7513dbddf799-00000012.kilnstate: the file is cut off; the state is not used
2|kiln: warning: states: there is no state of 'scenes/tiny.yaml' at or before frame 0; stepping from the start
2|kiln: warning: states/a37c7513dbddf799-00000132.kilnstate: the file is cut off; the state is not used
2|kiln: warning: states/a37c7513dbddf799-00000072.kilnstate: the file is cut off; the state is not used
2|kiln: warning: states/a37c7513dbddf799-00000252.kilnstate: the file is cut off; the state is not used
2|kiln: warning: states/a37c7513dbddf799-00000192.kilnstate: the file is cut off; the state is not used
$ mv $(ls other/*-00000132.kilnstate) $(ls states/*-00000252.kilnstate)
$ kiln render scenes/tiny.yaml -q --fps 10 --set output.frames=50 --frames 44 -o none --states states --stats | grep steps
1|  steps        144
2|kiln: warning: states/a37c7513dbddf799-00000252.kilnstate: the file holds the state of step 132; the state is not used
2|kiln: warning: states/a37c7513dbddf799-00000192.kilnstate: the file is cut off; the state is not used

Wrong requests.

$ kiln bake scenes/tiny.yaml
2|kiln: bake: needs --output STATES, a folder
= 2
$ kiln bake scenes/tiny.yaml -o states --force --resume
2|kiln: bake: --resume and --force exclude each other: --resume keeps the states that --force replaces
= 2
$ kiln bake scenes/tiny.yaml -o states --every 0
2|kiln: bake: --every: found '0'; expected a time of at least one frame, such as 10s, or a number of frames from 1 to 1000000
= 2
$ kiln bake scenes/tiny.yaml -o states --every 1.5
2|kiln: bake: --every: found '1.5'; expected a time of at least one frame, such as 10s, or a number of frames from 1 to 1000000
= 2
$ kiln bake scenes/tiny.yaml -o scenes/tiny.yaml
2|kiln: scenes/tiny.yaml: the path is not a folder, but scenes/tiny.yaml/ needs a folder here
= 2
$ kiln render scenes/tiny.yaml -q -o none --states nowhere
2|kiln: nowhere: the folder of states cannot be read: No such file or directory
= 6

Plans: whole parts for each task.

$ kiln plan scenes/tiny.yaml --tasks 4 --fps 10 --set output.frames=50 --states other | sed -n 's/  *[0-9.]*$//; 3,7p'
1|   task  parts        frames            from step     steps       CPU s
1|      1  1            0-19                     12       114
1|      2  2            20-39                    12       234
1|      3  3            40-49                   252        54
1|      4  none
$ kiln plan scenes/tiny.yaml --tasks 2 --fps 10 --set output.frames=50 --json | jq -c '.parts, .part_frames, .measured.frame, (.tasks[] | del(.cpu_s))'
1|3
1|20
1|4
1|{"task":1,"first_part":0,"parts":2,"frames":[0,39],"from_step":0,"from_state":false,"steps":246}
1|{"task":2,"first_part":2,"parts":1,"frames":[40,49],"from_step":0,"from_state":false,"steps":306}
$ kiln plan scenes/tiny.yaml --tasks 0
2|kiln: plan: --tasks: found '0', expected a whole number from 1 to 1000000
= 2
$ kiln plan scenes/tiny.yaml --frame 1000
2|kiln: frame 1000: the scene has frames 0-23
= 2

A wind that is written every 7 steps is in a part of the clip what it is in the whole, wherever the part begins.

$ cat >winds.yaml <<END
> kiln: 1
> output: {size: [64, 36], fps: 20, frames: 24}
> simulation: {rate: 60}
> nodes: {n: {position: {keys: {0 s: [0, 0, 0], 1 s: [1, 1, 0]}}}}
> systems:
>   a:
>     emit: {rate: 300, life: 1 s, from: {box: {size: [2, 2, 2]}}}
>     forces:
>       - wind: {baked: {attach: n, box: {size: [4, 4, 4]}, cells: 9, every: 7, of: [
>           curl: {strength: 3, drift: [2, 0, 0], pull: 5}, vortex: {attach: n, speed: 3}]}}
> END
$ kiln render winds.yaml -q -o whole_%02d.png && kiln render winds.yaml -q -o whole.apng
$ kiln bake winds.yaml -q -o winds --every 5 && ls winds | wc -l
1|4
$ kiln render winds.yaml -q -o part_%02d.png --states winds --frames 11-14 --stats | grep steps
1|  steps        12
$ for i in 11 12 13 14; do cmp whole_$i.png part_$i.png; done
$ for shard in 1/4 2/4 3/4 4/4; do kiln render winds.yaml -q -o whole_b.apng --states winds --shard $shard; done; kiln join -q whole_b.apng && cmp whole.apng whole_b.apng
