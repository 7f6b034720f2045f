Events: one stream of lines of JSON tells other programs how a command goes.

$ kiln render scenes/tiny.yaml -o e_%d.png --frames 0-1 --device cpu --threads 1 --events ndjson | sed -E 's/"(hash|state|sha256)": "[0-9a-f]+"/"\1": <hash>/g; s/"pass_ms": \{[^}]*\}/"pass_ms": {}/; s/"eta_s": [0-9.]+/"eta_s": <s>/'
1|{"event": "started", "time": <time>, "kiln": "0.2.0", "command": "render", "arguments": ["scenes/tiny.yaml", "-o", "e_%d.png", "--frames", "0-1", "--device", "cpu", "--threads", "1", "--events", "ndjson"], "host": <host>}
1|{"event": "loaded", "time": <time>, "scene": "scenes/tiny.yaml", "hash": <hash>, "size": [64, 36], "fps": "30/1", "frames": 24, "steps": 58, "particles": 82, "memory_bytes": <bytes>}
1|{"event": "device", "time": <time>, "device": <device>}
1|{"event": "frame", "time": <time>, "scene": "scenes/tiny.yaml", "frame": 0, "done": 1, "total": 2, "elapsed_s": <s>, "eta_s": <s>, "alive": 24, "state": <hash>, "pass_ms": {}, "file": "e_0.png", "bytes": <n>, "sha256": <hash>}
1|{"event": "frame", "time": <time>, "scene": "scenes/tiny.yaml", "frame": 1, "done": 2, "total": 2, "elapsed_s": <s>, "eta_s": <s>, "alive": 28, "state": <hash>, "pass_ms": {}, "file": "e_1.png", "bytes": <n>, "sha256": <hash>}
1|{"event": "result", "time": <time>, "scene": "scenes/tiny.yaml", "output": "e_%d.png", "first_file": "e_0.png", "frames": 2, "kept": 0, "total_s": <s>}
1|{"event": "ended", "time": <time>, "code": 0, "again": "never"}
$ kiln render scenes/tiny.yaml -o e_%d.png --frames 0-1 --device cpu --force --events ndjson -q | jq -r 'select(.event == "frame") | "\(.sha256)  \(.file)"' | sort -k 2 | sha256sum --check
1|e_0.png: OK
1|e_1.png: OK

Of a clip each frame that was drawn, its parts where they wait in files, and the clip.

$ kiln render scenes/tiny.yaml -o e.mp4 --device cpu -q --resume --events ndjson:e.log; jq -rc '[.event, .frames, .file]' e.log | uniq -c | sed 's/^ *//'
1|1 ["started",null,null]
1|1 ["loaded",24,null]
1|1 ["device",null,null]
1|24 ["frame",null,null]
1|1 ["part",[0,23],"e.mp4.parts/00000.part"]
1|1 ["file",[0,23],"e.mp4"]
1|1 ["result",24,null]
1|1 ["ended",null,null]
$ jq -r 'select(.event == "file") | "\(.sha256)  \(.file)"' e.log | sha256sum --check
1|e.mp4: OK

Every command has a result, which has all that --json has.

$ kiln plan scenes/tiny.yaml --device cpu --tasks 2 --events ndjson 2>/dev/null | jq -c 'select(.event == "result") | del(.event, .time) | keys' && kiln plan scenes/tiny.yaml --device cpu --tasks 2 --json | jq -c keys
1|["cpu_s","measured","motion","part_frames","parts","scene","tasks","techniques"]
1|["cpu_s","measured","motion","part_frames","parts","scene","tasks","techniques"]
$ kiln devices --events ndjson 2>/dev/null | jq -S 'select(.event == "result") | del(.event, .time)' >told && kiln devices --json | jq -S . | cmp - told
$ kiln render scenes/tiny.yaml -o joined.mp4 --device cpu -q --shard 1/1; for i in 1 2; do kiln join joined.mp4 --events ndjson 2>/dev/null | grep result; done
1|{"event": "result", "time": <time>, "output": "joined.mp4", "frames": 24, "parts": 1, "was_whole": false}
1|{"event": "result", "time": <time>, "output": "joined.mp4", "frames": 24, "parts": 1, "was_whole": true}
$ kiln encode e_%d.png -o encoded.mp4 --events ndjson 2>/dev/null | grep result
1|{"event": "result", "time": <time>, "output": "encoded.mp4", "frames": 2, "range": [0, 1]}
$ kiln test scenes --golden golden --device cpu --json=test.json --events ndjson 2>/dev/null >test.events; jq -c 'select(.event == "test").report' test.events | cmp - <(jq -c '.tests[]' test.json) && jq -c 'select(.event == "result") | del(.event, .time)' test.events | cmp - <(jq -c 'del(.tests)' test.json); jq -c '[.event, .name, .report.status, .counts.new, .code]' test.events
1|["started",null,null,null,null]
1|["test","scenes/empty","new",null,null]
1|["test","scenes/tiny","new",null,null]
1|["result",null,null,2,7]
1|["ended",null,null,null,7]
$ for command in 'check scenes/tiny.yaml' 'new told.yaml' 'figure sheet scenes/tiny.yaml -o told.png --frames 0 --device cpu' 'figure --check told.png' 'test list scenes' 'test report out/test' 'bench --list'; do kiln $command --events ndjson 2>/dev/null | jq -r 'select(.event == "result") | .event' | sed "s|^|$command: |"; done
1|check scenes/tiny.yaml: result
1|new told.yaml: result
1|figure sheet scenes/tiny.yaml -o told.png --frames 0 --device cpu: result
1|figure --check told.png: result
1|test list scenes: result
1|test report out/test: result
1|bench --list: result

Standard output keeps its text when events go elsewhere. With `-o -` they go to standard error, and then
nothing else does.

$ kiln render scenes/tiny.yaml -o none --frames 0 --device cpu --events ndjson:fd=3 --progress none 3>three | sed 's/(.*)/(...)/'; jq -r .event three
1|device: <device>
1|scenes/tiny.yaml: nothing written: 1 frame in <s> s
1|started
1|loaded
1|device
1|frame
1|result
1|ended
$ kiln render scenes/tiny.yaml -o - --frames 0 --device cpu --events ndjson --progress lines 2>err >/dev/null; jq -r .event err
1|started
1|loaded
1|device
1|frame
1|result
1|ended
$ kiln render scenes/tiny.yaml -o none.xyz --events ndjson:fd=2 2>err; jq -r .event err
1|started
1|loaded
1|error
1|ended
$ kiln render scenes/tiny.yaml -o - --events ndjson:fd=1 | wc -c
1|0
2|kiln: render: --events: 'ndjson:fd=1' and '--output -' would both write to standard output; without ':fd=1' events go to standard error
$ kiln render scenes/tiny.yaml -o - --events openjd:fd=1 | wc -c
1|0
2|kiln: render: --events: 'openjd:fd=1' and '--output -' would both write to standard output; without ':fd=1' events go to standard error
$ kiln test scenes --golden golden --json --events ndjson 2>/dev/null | jq -r 'select(.event == "error").message'
1|test: only one of --json, --junit, --tap, --report, --github and --events can go to standard output

Failures have a code, a place, and whether to try again; a signal is a failure, too.

$ printf 'kiln: 1\nsystems: {a: {emit: {raet: 1}}}\n' >wrong.yaml; kiln check wrong.yaml --events ndjson 2>/dev/null | tail -n 2
1|{"event": "error", "time": <time>, "code": 3, "again": "never", "message": "wrong.yaml:2:22: systems.a.emit.raet: unknown key (did you mean 'rate'?)", "file": "wrong.yaml", "line": 2, "column": 22}
1|{"event": "ended", "time": <time>, "code": 3, "again": "never"}
$ kiln render scenes/tiny.yaml -q -o e.mp4 --events ndjson:fd=2 2>&1 | grep -v '^kiln' | tail -n 2
1|{"event": "error", "time": <time>, "code": 2, "again": "never", "message": "e.mp4.journal: a job with --resume or --shard has begun this output (--force replaces it)"}
1|{"event": "ended", "time": <time>, "code": 2, "again": "never"}
$ kiln render scenes/tiny.yaml -q -o never.mp4 --set output.frames=100000 --set systems.smoke.emit.rate=100000 --device cpu --events ndjson 2>/dev/null >stopped & until grep -qs '"frame"' stopped; do sleep 0.05; done; kill -TERM $!; wait $!; echo "exit code $?"; jq -c 'select(.event == "error" or .event == "ended") | [.event, .code, .again]' stopped
1|exit code 143
1|["error",143,"again"]
1|["ended",143,"again"]
$ kiln render scenes/tiny.yaml -q -o slow.png --frames 0 --size 4096x4096 --set camera.shutter.samples=64 --set simulation.rate=3840 --threads 1 --device cpu --timeout 0.5 --events ndjson 2>/dev/null | jq -c 'select(.event == "error" or .event == "ended") | [.event, .code, .again]'
1|["error",8,"with more"]
1|["ended",8,"with more"]
$ kiln render - -q -o slow.png --timeout 0.1 --events ndjson < <(sleep 2) 2>/dev/null | jq -c 'select(.event == "error" or .event == "ended") | [.event, .code, .file, .message]' | sed 's/taken .* since/taken <s> since/'
1|["error",8,null,"loading standard input: the job has taken <s> since it began, and the limit `time` is 0.1 s; unfinished files are discarded"]
1|["ended",8,null,null]
$ kiln compare e_0.png e_1.png --events ndjson | jq -c '[.event, .verdict, .same, .code]'
1|["started",null,null,null]
1|["frame","different",null,null]
1|["result",null,false,null]
1|["ended",null,null,1]
$ kiln bake scenes/tiny.yaml -o baked --every 10 --device cpu --events ndjson | jq -c '[.event, .done, .states, .code]'
1|["started",null,null,null]
1|["loaded",null,null,null]
1|["state",1,null,null]
1|["state",2,null,null]
1|["state",3,null,null]
1|["result",null,3,null]
1|["ended",null,null,0]

The form of Open Job Description: progress, status and failure, a line each. Text for people stays.

$ kiln render scenes/tiny.yaml -o j_%d.png --frames 0-3 --device cpu --progress none --events openjd | sed -E 's/, [0-9.]+ a second.*/, .../'
1|openjd_progress: 0
1|openjd_status: kiln 0.2.0: render
1|openjd_status: scenes/tiny.yaml: 24 frames of 64x36
1|device: <device>
1|openjd_progress: 25
1|openjd_status: scenes/tiny.yaml: 1 of 4 frames, ...
1|openjd_progress: 50
1|openjd_status: scenes/tiny.yaml: 2 of 4 frames, ...
1|openjd_progress: 75
1|openjd_status: scenes/tiny.yaml: 3 of 4 frames, ...
1|j_0.png and 3 more: 4 frames in <s> s
1|openjd_progress: 100
$ kiln render scenes/tiny.yaml -o j.mp4 --shard 1/2 --device cpu --set output.frames=130 -q --events openjd:j.log; grep -c ^openjd_progress j.log; grep progress j.log | uniq -d; grep progress j.log | sort -c -n -k 2; tail -n 3 j.log | sed -E 's/, [0-9.]+ a second.*/, .../'
1|101
1|openjd_progress: 99
1|openjd_status: scenes/tiny.yaml: 119 of 120 frames, ...
1|openjd_progress: 100
$ kiln render scenes/tiny.yaml -o j.mp4 --shard 2/2 --device cpu --set output.frames=130 -q; kiln join j.mp4 --events openjd
1|openjd_progress: 0
1|openjd_status: kiln 0.2.0: join
1|j.mp4: 130 frames in 3 parts
1|openjd_progress: 100
$ cp scenes/tiny.yaml scenes/twice.yaml; kiln render scenes/tiny.yaml scenes/twice.yaml -o '{scene}_%d.png' --frames 0-1 --device cpu -q --events openjd | grep -e progress -e of | sed -E 's/, [0-9.]+ a second.*/, .../'
1|openjd_progress: 0
1|openjd_status: scenes/tiny.yaml: 24 frames of 64x36
1|openjd_status: scenes/twice.yaml: 24 frames of 64x36
1|openjd_progress: 25
1|openjd_status: scenes/tiny.yaml: 1 of 2 frames, ...
1|openjd_progress: 50
1|openjd_status: scenes/tiny.yaml: 2 of 2 frames, ...
1|openjd_progress: 75
1|openjd_status: scenes/twice.yaml: 1 of 2 frames, ...
1|openjd_progress: 100
$ kiln bake scenes/tiny.yaml -o openjd_states --every 10 --device cpu -q --events openjd
1|openjd_progress: 0
1|openjd_status: kiln 0.2.0: bake
1|openjd_status: scenes/tiny.yaml: 24 frames of 64x36
1|openjd_progress: 20
1|openjd_status: state 1 of 3, step 12
1|openjd_progress: 55
1|openjd_status: state 2 of 3, step 32
1|openjd_progress: 89
1|openjd_status: state 3 of 3, step 52
1|openjd_progress: 100
$ printf '{"scene": "scenes/tiny.yaml", "output": "j_batch.png", "frames": "0"}\n{"name": "b\\na", "scene": "none.yaml", "output": "x.png"}\n' | kiln render --batch - --keep-going --device cpu -q --events openjd 2>/dev/null
1|openjd_progress: 0
1|openjd_status: kiln 0.2.0: render
1|openjd_progress: 50
1|openjd_status: 1 of 2 jobs
1|openjd_fail: b\na: none.yaml: No such file or directory
1|openjd_status: exit code 3, again: never
= 3
$ kiln encode j_%d.png -o j_encoded.mp4 -q --events openjd | grep progress
1|openjd_progress: 0
1|openjd_progress: 25
1|openjd_progress: 50
1|openjd_progress: 75
1|openjd_progress: 100
$ kiln render scenes/tiny.yaml -o - --frames 0 --device cpu --events openjd -q 2>&1 >/dev/null | grep progress
1|openjd_progress: 0
1|openjd_progress: 100
$ kiln render "$(printf 'a\nopenjd_env: B=C')" -q -o a.png --events openjd 2>/dev/null
1|openjd_progress: 0
1|openjd_status: kiln 0.2.0: render
1|openjd_fail: a\nopenjd _env: B=C: No such file or directory
1|openjd_status: exit code 3, again: never
= 3
$ kiln render scenes/tiny.yaml -q -o j_never.mp4 --set output.frames=3000 --device cpu --events openjd 2>/dev/null >stopped & until grep -qsx "openjd_progress: 1" stopped; do sleep 0.05; done; kill -TERM $!; wait $!; tail -n 2 stopped
1|openjd_fail: scenes/tiny.yaml: stopped by SIGTERM after <n> frames
1|openjd_status: exit code 143, again: again
$ kiln render scenes/tiny.yaml -q -o slow.png --frames 0 --size 4096x4096 --set camera.shutter.samples=64 --set simulation.rate=3840 --threads 1 --device cpu --frame-timeout 0.2 --events openjd 2>/dev/null | tail -n 2
1|openjd_fail: scenes/tiny.yaml: frame 0 took longer than its limit of 0.2 s (--frame-timeout)
1|openjd_status: exit code 5, again: with more
$ kiln check scenes/tiny.yaml -q --events openjd:e.log
2|kiln: check: --events: e.log: the file exists and holds no events, so nothing is added to it; name another file
= 2
$ kiln check scenes/tiny.yaml -q --events openjson
2|kiln: check: --events: found 'openjson'; expected ndjson or openjd, or one of them with :FILE or :fd=N, where N is a descriptor that is open for writing
= 2

What is no stream is refused, and nothing is added to other files.

$ kiln check scenes/tiny.yaml -q --events xml
2|kiln: check: --events: found 'xml'; expected ndjson or openjd, or one of them with :FILE or :fd=N, where N is a descriptor that is open for writing
= 2
$ kiln check scenes/tiny.yaml -q --events ndjson:
2|kiln: check: --events: found 'ndjson:'; expected ndjson or openjd, or one of them with :FILE or :fd=N, where N is a descriptor that is open for writing
= 2
$ kiln check scenes/tiny.yaml -q --events ndjson:fd=9
2|kiln: check: --events: found 'ndjson:fd=9'; expected ndjson or openjd, or one of them with :FILE or :fd=N, where N is a descriptor that is open for writing
= 2
$ kiln check scenes/tiny.yaml -q --events ndjson:fd=0
2|kiln: check: --events: found 'ndjson:fd=0'; expected ndjson or openjd, or one of them with :FILE or :fd=N, where N is a descriptor that is open for writing
= 2
$ kiln check scenes/tiny.yaml -q --events ndjson:scenes/tiny.yaml
2|kiln: check: --events: scenes/tiny.yaml: the file exists and holds no events, so nothing is added to it; name another file
= 2
$ kiln check scenes/tiny.yaml -q --events ndjson:none/e.log
2|kiln: check: --events: none/e.log: No such file or directory
= 6
$ kiln check scenes/tiny.yaml -q --events ndjson:/dev/full
2|kiln: --events: /dev/full cannot be written
= 6
$ kiln plan scenes/tiny.yaml --events ndjson 2>text | jq -r .event; kiln devices --events ndjson 2>>text | jq -r .event; grep -Ec '^scenes/tiny.yaml: |^sandbox:' text
1|started
1|loaded
1|result
1|ended
1|started
1|result
1|ended
1|2
$ kiln plan scenes/tiny.yaml --events ndjson 2>text >/dev/full; echo $?; tail -n 1 text
1|6
1|kiln: standard output: No space left on device
$ kiln render scenes/tiny.yaml -o none --set output.frames=100000 --device cpu -q --events ndjson | head -n 1 | cut -c 1-20; echo "${PIPESTATUS[0]}"
1|{"event": "started",
1|9
2|kiln: standard output: the reader went away: stopped
$ kiln help events | head -n 25
1|--events ndjson          writes events to standard output, and the text for people to standard
1|                         error; with '--output -', events go to standard error
1|--events ndjson:FILE     writes events at the end of a file
1|--events ndjson:fd=N     writes events to a descriptor that is open
1|
1|Where events of `ndjson` go to standard error, nothing else is printed there: errors and warnings
1|are events, too.
1|
1|`openjd` instead of `ndjson` writes lines for engines of Open Job Description. The text for people
1|is printed as well, and the engine passes it on:
1|
1|openjd_progress: PERCENT   whole percents from 0 to 100; 100 means that all is done
1|openjd_status: MESSAGE     what the command does, and warnings; after a failure, the last one
1|                           has the exit code and says whether to try again
1|openjd_fail: MESSAGE       why something failed
1|
1|A line of `ndjson` is a JSON object. `event` is its name, `time` is UTC. Later versions may add
1|events and members. 'kiln help events-schema' prints the JSON schema.
1|
1|started (every command): The command line was read.
1|    kiln               Version and commit of kiln.
1|    command            Name of the command.
1|    arguments          Options and operands of the command line.
1|    host               Name of the machine.
1|    process            Process ID.

Several scenes: --keep-going renders the others, too.

$ touch kept_empty.png; kiln render wrong.yaml scenes/empty.yaml scenes/tiny.yaml -o 'kept_{scene}.png' --frames 0 --device cpu -q; echo "exit code $?"; ls kept*
1|exit code 3
1|kept_empty.png
2|wrong.yaml:2:22: systems.a.emit.raet: unknown key (did you mean 'rate'?)
$ kiln render wrong.yaml scenes/empty.yaml scenes/tiny.yaml -o 'kept_{scene}.png' --frames 0 --device cpu -q --keep-going; echo "exit code $?"; ls kept*
1|exit code 3
1|kept_empty.png
1|kept_tiny.png
2|wrong.yaml:2:22: systems.a.emit.raet: unknown key (did you mean 'rate'?)
2|kiln: kept_empty.png: the file exists (--force replaces it)
