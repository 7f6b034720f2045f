Many jobs in one call, each in a process of its own.

$ cat >jobs.yaml <<END
> kiln_jobs: 1
> jobs:
>   - {name: clip, scene: scenes/tiny.yaml, output: out/clip.mp4, frames: 0-3}
>   - {scene: scenes/tiny.yaml, output: 'out/still_##.png', frames: '0,2', set: [seed=3, "output.size=[32, 32]"]}
>   - {scene: scenes/empty.yaml, output: none, frames: 0}
> END
$ kiln render --batch jobs.yaml --device cpu; ls out
1|clip: done in <s> s
1|job 2: done in <s> s
1|job 3: done in <s> s
1|3 of 3 jobs in <s> s, 0 failed
1|clip.mp4
1|still_00.png
1|still_02.png
$ kiln render scenes/tiny.yaml -q --device cpu -o alone_##.png --frames 0,2 --set seed=3 --size 32x32; for i in 00 02; do cmp alone_$i.png out/still_$i.png; done

A failure is that job's alone; with --keep-going the others are rendered, too. The exit code is the greatest.

$ cat >mixed.yaml <<END
> kiln_jobs: 1
> jobs:
>   - {name: broken, scene: wrong.yaml, output: m/broken.png}
>   - {name: greedy, scene: scenes/tiny.yaml, output: m/greedy.mp4, limits: frames=3}
>   - {name: late, scene: scenes/tiny.yaml, output: m/late.mp4, limits: particles=3}
>   - {name: good, scene: scenes/tiny.yaml, output: m/good.png, frames: 0}
> END
$ printf 'kiln: 1\nsystems: {a: {emit: {raet: 1}}}\n' >wrong.yaml
$ kiln render --batch mixed.yaml --device cpu; ls m
1|broken: exit code 3 after <s> s
1|1 of 4 jobs in <s> s, 1 failed
2|broken: wrong.yaml:2:22: systems.a.emit.raet: unknown key (did you mean 'rate'?)
2|ls: cannot access 'm': No such file or directory
= 2
$ kiln render --batch mixed.yaml --device cpu --keep-going 2>&1; echo "exit code $?"; ls m
1|broken: wrong.yaml:2:22: systems.a.emit.raet: unknown key (did you mean 'rate'?)
1|broken: exit code 3 after <s> s
1|greedy: scenes/tiny.yaml:4:43: output.frames: 24 frames of the clip, and the limit `frames` is 3
1|greedy: exit code 8 after <s> s
1|late: scenes/tiny.yaml:13:7: systems.smoke.emit: 82 particles at once, and the limit `particles` is 3
1|late: exit code 8 after <s> s
1|good: done in <s> s
1|4 of 4 jobs in <s> s, 3 failed
1|exit code 8
1|good.png
$ kiln render --batch mixed.yaml --device cpu --keep-going --force --events ndjson 2>/dev/null | jq -c 'select(.event == "job" or .event == "ended") | [.event, .name, .code, .again]'
1|["job","broken",3,"never"]
1|["job","greedy",8,"with more"]
1|["job","late",8,"with more"]
1|["job","good",0,"never"]
1|["ended",null,8,"with more"]
$ kiln render --batch jobs.yaml --device cpu --force --jobs 3 -q --sandbox --limits service && ls out
1|clip.mp4
1|still_00.png
1|still_02.png

Lines of JSON on standard input.

$ for i in 1 2 3; do echo "{\"name\": \"n$i\", \"scene\": \"scenes/tiny.yaml\", \"output\": \"n/$i.png\", \"frames\": \"$i\"}"; done | kiln render --batch - --device cpu --threads 1 --jobs 1; ls n
1|n1: done in <s> s
1|n2: done in <s> s
1|n3: done in <s> s
1|3 of 3 jobs in <s> s, 0 failed
1|1.png
1|2.png
1|3.png
$ printf '{"scene": "scenes/tiny.yaml", "output": "n/4.png", "frames": "4"}\n\n{"scene": "a.yaml", "outptu": "b.png"}\n' >bad.ndjson; kiln render --batch bad.ndjson; ls n
1|1.png
1|2.png
1|3.png
2|bad.ndjson:3:21: outptu: unknown key (did you mean 'output'?)
$ kiln render --batch - </dev/null
2|standard input: there are no jobs in it
= 3

What is no job is refused before any begins.

$ printf 'kiln_jobs: 1\njobs: [{scene: scenes/tiny.yaml}]\n' >bad.yaml; kiln render --batch bad.yaml
2|bad.yaml:2:8: jobs.0.output: missing; it must be given
= 3
$ printf 'kiln_jobs: 1\njobs: [{scene: a.yaml, output: b.png, timeout: soon}]\n' >bad.yaml; kiln render --batch bad.yaml
2|bad.yaml:2:48: jobs.0.timeout: expected a number from 0 s to 10000000 s, found 'soon'
= 3
$ kiln render --batch none.yaml
2|none.yaml: No such file or directory
= 3
$ kiln render --batch jobs.yaml scenes/tiny.yaml
2|kiln: render: --batch: not with a scene; its file names them
= 2
$ kiln render --batch jobs.yaml -o a.png
2|kiln: render: --output: not with --batch, whose file says it of each job
= 2
$ kiln render scenes/tiny.yaml -o none --jobs 2
2|kiln: render: --jobs: there is no --batch to apply it to
= 2
$ kiln render -o none
2|kiln: render: needs SCENE...
= 2
$ kiln help jobs | head -n 40
1|'kiln render --batch jobs.yaml' renders every job of a file, each in a process of its own:
1|
1|    kiln_jobs: 1
1|    jobs:
1|      - {scene: fire.yaml, output: out/fire.mp4, set: [seed=3], timeout: 600 s}
1|      - {scene: rain.yaml, output: out/rain_####.png, frames: 0-9}
1|
1|A file whose name ends in .ndjson or .jsonl, and '-', standard input, has a job a line:
1|
1|    {"scene": "fire.yaml", "output": "out/fire.mp4", "set": ["seed=3"]}
1|
1|kiln_jobs
1|    Version of the format of files of jobs.
1|    the number 1
1|    must be given
1|
1|jobs
1|    The jobs, which begin in their order.
1|    a list of up to 1024: a mapping of keys
1|    must be given
1|
1|jobs.N.name
1|    What results call the job; its number where it has no name.
1|    a text
1|    default: ""
1|
1|jobs.N.scene
1|    The scene's path, from the folder of the file of jobs.
1|    a text
1|    must be given
1|
1|jobs.N.output
1|    Where to write, as --output; from the same folder. 'none' writes nothing.
1|    a text
1|    must be given
1|
1|jobs.N.set
1|    Keys of the scene to change.
1|    a list of up to 64: key=value, as for --set
1|    default: []

A signal ends the jobs that run; no process is left. So does the end of the batch by a kill.

$ kiln render --batch - --device cpu --set output.frames=100000 --set systems.smoke.emit.rate=100000 --jobs 2 -q <<<'{"scene": "scenes/tiny.yaml", "output": "never.mp4"}' & until ls -A | grep -q never; do sleep 0.05; done; kill -TERM $!; wait $!; echo "exit code $?"; ls -A | grep never
1|exit code 143
2|kiln: batch: stopped by SIGTERM after 0 of 1 jobs
= 1

$ kiln render --batch - --device cpu --set output.frames=100000 --set systems.smoke.emit.rate=100000 --events ndjson:killed.log -q <<<'{"scene": "scenes/tiny.yaml", "output": "killed.mp4"}' & until ls -A | grep -q '^.killed.mp4'; do sleep 0.05; done; kill -KILL $!; { wait $!; } 2>/dev/null; for i in $(seq 100); do ls -A | grep -q '^.killed.mp4' || break; sleep 0.1; done; ls -A | grep killed
1|killed.log

What the call limits stays so where a job limits something else; other folders and relative paths are as everywhere.

$ printf '{"scene": "scenes/tiny.yaml", "output": "l.mp4", "limits": "steps=1M"}\n' | kiln render --batch - --device cpu --limits frames=3
1|job 1: exit code 8 after <s> s
1|1 of 1 jobs in <s> s, 1 failed
2|job 1: scenes/tiny.yaml:4:43: output.frames: 24 frames of the clip, and the limit `frames` is 3
= 8
$ mkdir -p deep/er && cd deep && kiln render --batch ../jobs.yaml --device cpu --force -q && ls ../out . && cd er && kiln render --batch ../../mixed.yaml --keep-going -q --device cpu --force 2>/dev/null; ls ../../m
1|.:
1|er
1|
1|../out:
1|clip.mp4
1|still_00.png
1|still_02.png
1|good.png
