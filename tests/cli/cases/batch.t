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
2|standard input: the file has no jobs
= 3

What is no job is refused before any begins, and so are frames, limits and files that two jobs would write.

$ printf '%s\n' 'printf "kiln_jobs: 1\njobs:\n" >bad.yaml; printf -- "  - %s\n" "$@" >>bad.yaml; exec kiln render --batch bad.yaml' >jobs; chmod +x jobs; sed -i '1i #!/bin/bash' jobs
$ printf 'kiln_jobs: 1\njobs: [{scene: scenes/tiny.yaml}]\n' >bad.yaml; kiln render --batch bad.yaml
2|bad.yaml:2:8: jobs.0.output: the key is missing and must be given
= 3
$ printf 'kiln_jobs: 1\njobs: [{scene: a.yaml, output: b.png, timeout: soon}]\n' >bad.yaml; kiln render --batch bad.yaml
2|bad.yaml:2:48: jobs.0.timeout: expected a number from 0 s to 10000000 s, found 'soon'
= 3
$ printf 'kiln_jobs: 1\njobs: []\n' >bad.yaml; kiln render --batch bad.yaml
2|bad.yaml: the file has no jobs
= 3
$ printf '{"scene": "a.yaml", "output": "a.png"}\n{"scene": "b.yaml", "output"\n' >bad.ndjson; kiln render --batch bad.ndjson
2|bad.ndjson:2:28: not valid JSON: the line ends too early
= 3
$ printf '{"scene": "a.yaml", "output": "a.png"}\n\n{\n"scene": "b.yaml"}\n' >bad.ndjson; kiln render --batch bad.ndjson
2|bad.ndjson:3:1: not valid JSON: the line ends too early
= 3
$ ./jobs '{scene: a.yaml, output: b.png, frames: 9-5}'
2|bad.yaml:3:44: jobs.0.frames: found '9-5', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
= 3
$ ./jobs '{scene: a.yaml, output: b.png}' '{scene: a.yaml, output: c.png, frames: "0-3,x", limits: particles=3}'
2|bad.yaml:4:44: jobs.1.frames: found 'x', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
= 3
$ ./jobs '{scene: a.yaml, output: b.png, limits: "particles=3,stpes=1"}'
2|bad.yaml:3:44: jobs.0.limits: 'stpes' is not a limit; did you mean 'steps'?
= 3
$ ./jobs '{scene: a.yaml, output: out/b.mp4}' '{name: twin, scene: c.yaml, output: out/../out/./b.mp4}'
2|bad.yaml:4:41: jobs.1.output: out/../out/./b.mp4: job 1 and twin would both write this file
= 3
$ ./jobs '{scene: a.yaml, output: out/}' '{scene: b.yaml, output: out/}' '{scene: x/a.yaml, output: out/a.mp4}'
2|bad.yaml:5:31: jobs.2.output: out/a.mp4: job 1 and job 3 would both write this file
= 3
$ ./jobs '{scene: a.yaml, output: "b_##.png", frames: 0-3}' '{scene: a.yaml, output: "b_##.png", frames: 0-3}'
2|bad.yaml:4:29: jobs.1.output: b_##.png of frames 0-3: job 1 and job 2 would both write this file
= 3
$ ./jobs '{scene: a.yaml, output: b.png, frames: 0}' '{scene: a.yaml, output: b.png, frames: 1}'
2|bad.yaml:4:29: jobs.1.output: b.png: job 1 and job 2 would both write this file
= 3
$ ./jobs '{scene: a.yaml, output: none, manifest: m.json}' '{scene: b.yaml, output: none, manifest: m.json}'
2|bad.yaml:4:45: jobs.1.manifest: m.json: job 1 and job 2 would both write this file
= 3
$ ./jobs '{scene: a.yaml, output: "-"}'
2|bad.yaml:3:29: jobs.0.output: a job cannot write to standard output; name a file
= 3
$ printf '{"scene": "a.yaml", "output": "a.mp4"}\n{"scene": "b.yaml", "output": "a.mp4"}\n' | kiln render --batch -
2|standard input:2:31: output: a.mp4: job 1 and job 2 would both write this file
= 3
$ kiln render --batch none.yaml
2|none.yaml: No such file or directory
= 3
$ kiln render --batch jobs.yaml scenes/tiny.yaml
2|kiln: render: --batch: a scene on the command line is not allowed with it; the file of jobs names the scenes
= 2
$ kiln render --batch jobs.yaml -o a.png
2|kiln: render: --output: not allowed with --batch; the file of jobs has a key for it
= 2
$ kiln render scenes/tiny.yaml -o none --jobs 2
2|kiln: render: --jobs: needs --batch
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
1|A file whose name ends in .ndjson or .jsonl has one job a line, and so has standard input, '-':
1|
1|    {"scene": "fire.yaml", "output": "out/fire.mp4", "set": ["seed=3"]}
1|    {"scene": "title.yaml", "output": "a.mp4", "params": {"brand": "#e61e28"}}
1|
1|kiln_jobs
1|    Version of the format of files of jobs.
1|    the number 1
1|    must be given
1|
1|jobs
1|    The jobs. They begin in this order.
1|    a list of up to 1024: a mapping of keys
1|    must be given
1|
1|jobs.N.name
1|    Name of the job in the results. Without a name, results have its number.
1|    a text
1|    default: ""
1|
1|jobs.N.scene
1|    The scene's path, from the folder of the file of jobs.
1|    a text
1|    must be given
1|
1|jobs.N.output
1|    Where to write, like --output, from the folder of the file of jobs. 'none' writes nothing.
1|    a text
1|    must be given
1|
1|jobs.N.params
1|    Values of the scene's parameters.
1|    a mapping of up to 256 names of parameters to values

Numbers and times are taken as they are written; so does the schema.

$ printf 'kiln_jobs: 1\njobs: [{name: 7, scene: scenes/tiny.yaml, output: numbers.png, frames: 5, timeout: 2 min}, {scene: scenes/tiny.yaml, output: "chunk_##.png", frames: 0-1}, {scene: scenes/tiny.yaml, output: "chunk_##.png", frames: 2-}]\n' >numbers.yaml; kiln render --batch numbers.yaml --device cpu -q --timeout 1h --frame-timeout '90 s' && ls numbers.png && ls chunk_* | wc -l
1|numbers.png
1|24
$ kiln help jobs-schema | jq -c '.properties.jobs.items.properties | .frames.type, (.timeout.pattern as $p | ["5 min", "2h", "3 d", "7 ms"] | map(test($p)))'
1|["string","number","boolean"]
1|[true,true,false,true]
$ kiln render scenes/tiny.yaml -o none --timeout '2 d'
2|kiln: render: --timeout: found '2 d', expected a time from 0.001 s to 10000000 s, as a number of seconds or in ms, s, min or h
= 2

Events say which jobs run, and where the file is wrong that a job has failed for. Nothing is named twice.

$ kiln render --batch mixed.yaml --device cpu --force --events ndjson 2>/dev/null | jq -c 'select(.event | startswith("job")) | [.event, .name, .code, .message, .file, .line, .column]'
1|["job_began","broken",null,null,null,null,null]
1|["job","broken",3,"wrong.yaml:2:22: systems.a.emit.raet: unknown key (did you mean 'rate'?)","wrong.yaml",2,22]
$ kiln render --batch - --device cpu <<<'{"scene": "scenes/tiny.yaml", "output": "n/1.png", "frames": "1"}'
1|job 1: exit code 2 after <s> s
1|1 of 1 jobs in <s> s, 1 failed
2|job 1: n/1.png: the file exists (--force replaces it)
= 2

A batch that was begun without --resume: images and jobs that were not done are gone on with; a clip that is done has no journal.

$ cat >go_on.yaml <<END
> kiln_jobs: 1
> jobs:
>   - {name: stills, scene: scenes/tiny.yaml, output: 'go/still_##.png', frames: 0-3}
>   - {name: clip, scene: scenes/tiny.yaml, output: go/clip.mp4, frames: 0-3}
>   - {name: undone, scene: scenes/tiny.yaml, output: go/undone.mp4, frames: 0-3}
> END
$ kiln render --batch go_on.yaml --device cpu -q && rm go/undone.mp4 go/still_02.png && kiln render --batch go_on.yaml --device cpu --resume --keep-going; ls go
1|stills: done in <s> s
1|clip: exit code 2 after <s> s
1|undone: done in <s> s
1|3 of 3 jobs in <s> s, 1 failed
1|clip.mp4
1|still_##.png.journal
1|still_00.png
1|still_01.png
1|still_02.png
1|still_03.png
1|undone.mp4
1|undone.mp4.journal
2|clip: go/clip.mp4: the file exists, and no journal says that this job made it (--force replaces it)
$ rm go/clip.mp4; kiln render --batch go_on.yaml --device cpu --resume -q && kiln render --batch go_on.yaml --device cpu --resume --events ndjson | jq -c 'select(.event == "job") | [.name, .code]'
1|["stills",0]
1|["clip",0]
1|["undone",0]

A signal ends the jobs that run, which are named; no process is left. So does the end of the batch by a kill.

$ kiln render --batch - --device cpu --set output.frames=100000 --set systems.smoke.emit.rate=100000 --jobs 2 -q <<<'{"scene": "scenes/tiny.yaml", "output": "never.mp4"}' --events ndjson:stopped.log 2>stopped.txt & until ls -A | grep -q never; do sleep 0.05; done; kill -TERM $!; wait $!; echo "exit code $?"; ls -A | grep never; tail -n 1 stopped.txt; jq -c 'select(.event | startswith("job")) | [.event, .name, .code, .again]' stopped.log
1|exit code 143
1|kiln: batch: stopped by SIGTERM after 0 of 1 jobs, while 1 ran
1|["job_began","job 1",null,null]
1|["job","job 1",143,"again"]

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
