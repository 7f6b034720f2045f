Tests of scenes against golden pictures. What a folder has: a test file, and the scenes that no test
file names.

$ cat >fire.test.yaml <<'END'
> kiln_test: 1
> scene: scenes/tiny.yaml
> frames: [6]
> END
$ kiln test list --files
1|fire	fire.test.yaml
1|scenes/empty	scenes/empty.yaml

A golden that is missing is a failure, and is not written before one is told to.

$ kiln test fire
1|new     fire  1 frame in <s> s: frame 6 has no golden: the file golden/fire/frame_0006.png is missing
1|1 test in <s> s: 1 new
1|report: out/test/report.html
1|where the pictures are right, accept them: kiln test approve fire
1|1 frame: 0 by pixels, 0 by metrics, 1 by nothing
= 7
$ ls golden
2|ls: cannot access 'golden': No such file or directory
= 2
$ kiln test fire --update missing --dry-run
1|new     fire  1 frame in <s> s: frame 6 has no golden: the file golden/fire/frame_0006.png is missing
1|        would write golden/fire/frame_0006.png
1|1 test in <s> s: 1 new
1|report: out/test/report.html
1|1 picture would be written; this was a dry run
1|where the pictures are right, accept them: kiln test approve fire
1|1 frame: 0 by pixels, 0 by metrics, 1 by nothing
= 7
$ ls golden
2|ls: cannot access 'golden': No such file or directory
= 2
$ kiln test fire --update missing
1|pass    fire  1 frame in <s> s
1|        wrote golden/fire/frame_0006.png
1|1 test in <s> s: 1 pass
1|report: out/test/report.html
1|1 picture was written: look at it before you keep it
1|1 frame: 0 by pixels, 0 by metrics, 1 by nothing
$ find golden -type f | sort
1|golden/fire/expect.yaml
1|golden/fire/frame_0006.png
1|golden/fire/scene.yaml
$ kiln test fire
1|pass    fire  1 frame in <s> s
1|1 test in <s> s: 1 pass
1|report: out/test/report.html
1|1 frame: 1 by pixels, 0 by metrics
$ kiln test fire -q
$ kiln test fire --repeat 2 --threads 3 --strict
1|pass    fire  1 frame in <s> s
1|1 test in <s> s: 1 pass
1|report: out/test/report.html
1|1 frame: 1 by pixels, 0 by metrics

A picture that has changed fails, and can be accepted.

$ echo 'set: [systems.fire.look.size=0.6]' >>fire.test.yaml
$ kiln test fire
1|fail    fire  1 frame in <s> s: frame 6 has other pixels than the accepted ones on cpu; flip.mean is <value>, beyond 0.01; flip.p99 is <value>, beyond 0.1
1|1 test in <s> s: 1 fail
1|report: out/test/report.html
1|where the pictures are right, accept them: kiln test approve fire
1|1 frame: 0 by pixels, 1 by metrics
= 1
$ kiln test fire -q --update missing
1|fail    fire  1 frame in <s> s: frame 6 has other pixels than the accepted ones on cpu; flip.mean is <value>, beyond 0.01; flip.p99 is <value>, beyond 0.1
1|1 test in <s> s: 1 fail
1|report: out/test/report.html
1|where the pictures are right, accept them: kiln test approve fire
1|1 frame: 0 by pixels, 1 by metrics
= 1
$ kiln complete -- test approve fi | cut -f 1,2
1|file:*.y*ml	
1|word	fire
$ kiln test approve fire --dry-run
1|would write golden/fire/frame_0006.png
1|would write golden/fire/scene.yaml
1|would write golden/fire/expect.yaml
$ kiln test approve fire
1|wrote golden/fire/frame_0006.png
1|wrote golden/fire/scene.yaml
1|wrote golden/fire/expect.yaml
$ kiln test fire
1|pass    fire  1 frame in <s> s
1|1 test in <s> s: 1 pass
1|report: out/test/report.html
1|1 frame: 1 by pixels, 0 by metrics
$ kiln test approve fire
1|fire: nothing to accept
$ kiln test approve fir
2|kiln: no result of a test 'fir' in out/test (did you mean 'fire'?)
= 2
$ kiln test approve
2|kiln: test approve: names of tests are missing; give them, or --all
= 2

So does a simulation that has changed, however like the picture is.

$ sed -i 's/^set:.*/set: [systems.fire.look.size=0.6, simulation.rate=120]/' fire.test.yaml
$ kiln test fire
1|fail    fire  1 frame in <s> s: the simulation changed: the state is a6edc2d5ec8d500c at frame 6, but 3bdb35dd0e9813d8 was accepted; the picture is within its limits
1|1 test in <s> s: 1 fail
1|report: out/test/report.html
1|where the pictures are right, accept them: kiln test approve fire
1|1 frame: 0 by pixels, 0 by metrics, 1 by state
= 1
$ kiln test fire --ignore-hashes --json | jq -c '.tests[] | [.name, .status]'
1|["fire","pass"]
2|pass    fire  1 frame in <s> s
2|        the scene has changed in 1 key, and the test passes
2|1 test in <s> s: 1 pass
2|report: out/test/report.html
2|1 frame: 0 by pixels, 1 by metrics
$ kiln test fire --update failed
1|pass    fire  1 frame in <s> s
1|        wrote golden/fire/frame_0006.png
1|1 test in <s> s: 1 pass
1|report: out/test/report.html
1|1 picture was written: look at it before you keep it
1|1 frame: 0 by pixels, 0 by metrics, 1 by state
$ kiln test fire
1|pass    fire  1 frame in <s> s
1|1 test in <s> s: 1 pass
1|report: out/test/report.html
1|1 frame: 1 by pixels, 0 by metrics

What is no test, and names of none.

$ kiln test fier
2|kiln: no test has the name 'fier' (did you mean 'fire'?)
= 2
$ kiln test 'f*z'
2|kiln: no test has the name 'f*z'; 'kiln test list' lists the tests
= 2
$ kiln test aprove
2|kiln: no test has the name 'aprove'; 'kiln test list' lists the tests
2|kiln: test: 'aprove' is no command either (did you mean 'kiln test approve'?)
= 2
$ kiln test nowhere.yaml
2|kiln: nowhere.yaml: No such file or directory
= 2
$ mkdir void; kiln test void
2|kiln: void: the folder has no tests: no *.test.yaml, and no scene
= 2
$ kiln test fire --shard 2/2
2|kiln: test: --shard: part 2 of 2 has no tests; take fewer parts
= 2
$ kiln test fire --shard 3/2
2|kiln: test: --shard: found '3/2', expected I/N, the I-th of N parts, such as 1/4
= 2
$ kiln test fire --dry-run
2|kiln: test: --dry-run: needs --update missing, failed or all; it prints what --update would write
= 2
$ kiln test fire --strict --ignore-hashes
2|kiln: test: --ignore-hashes and --strict exclude each other
= 2
$ kiln test fire --report page.html --no-report
2|kiln: test: --report and --no-report exclude each other
= 2
$ kiln test fire -q --no-report --json old.json && jq '.tests | length' old.json
1|1
2|kiln: warning: test: '--json FILE' is an older spelling of '--json=FILE', and version 0.3 will not know it
$ kiln test fire --json --tap -
2|kiln: test: only one of --json, --junit, --tap, --report, --github and --events can go to standard output
= 2
$ kiln help test aprove
2|kiln: help: unknown topic 'test aprove' (did you mean 'test approve'?); 'kiln help' lists the topics
= 2

A test that is wrong, one for a device that is not here, and one that takes too long are the errors
of these tests. Lines come in the order of the names.

$ echo 'scne: x' >wrong.test.yaml
> printf 'kiln_test: 1\nscene: scenes/empty.yaml\nframes: [0]\ndevices: [no-such-device]\n' >elsewhere.test.yaml
> printf 'kiln_test: 1\nscene: scenes/tiny.yaml\nframes: [0]\nset: [systems.smoke.emit.rate=1000000, simulation.warmup=4000 s]\n' >slow.test.yaml
$ kiln test fire wrong
1|pass    fire   1 frame in <s> s
1|error   wrong  wrong.test.yaml:1:1: scne: unknown key (did you mean 'scene'?)
1|2 tests in <s> s: 1 pass, 1 error
1|report: out/test/report.html
1|1 frame: 1 by pixels, 0 by metrics
= 3
$ kiln test elsewhere
1|skip    elsewhere  there is no device 'no-such-device'; there are: <devices>
1|1 test in <s> s: 1 skip
1|report: out/test/report.html
1|0 frames: 0 by pixels, 0 by metrics
2|kiln: test: every test was skipped, so nothing was tested: none is for a device of this machine
= 4
$ kiln test approve elsewhere wrong
2|elsewhere: the test was skipped and has no pictures; run it again: kiln test elsewhere.test.yaml
2|wrong: the test ended with an error, so nothing can be accepted: wrong.test.yaml:1:1: scne: unknown key (did you mean 'scene'?)
= 3
$ kiln test elsewhere fire
1|skip    elsewhere  there is no device 'no-such-device'; there are: <devices>
1|pass    fire       1 frame in <s> s
1|2 tests in <s> s: 1 pass, 1 skip
1|report: out/test/report.html
1|1 frame: 1 by pixels, 0 by metrics
$ echo 'time_limit: 0.5 s' >>slow.test.yaml
$ kiln test slow fire
1|pass    fire  1 frame in <s> s
1|error   slow  took longer than 0.5 s
1|2 tests in <s> s: 1 pass, 1 error
1|report: out/test/report.html
1|1 frame: 1 by pixels, 0 by metrics
= 5
$ kiln test wrong slow fire elsewhere -q
1|error   slow       took longer than 0.5 s
1|error   wrong      wrong.test.yaml:1:1: scne: unknown key (did you mean 'scene'?)
1|4 tests in <s> s: 1 pass, 1 skip, 2 error
1|report: out/test/report.html
1|1 frame: 1 by pixels, 0 by metrics
= 5

Names, patterns and shards.

$ kiln test list 'f*' elsewhere
1|elsewhere
1|fire
$ kiln test list --filter '*e*' --shard 1/2; kiln test list --filter '*e*' --shard 2/2
1|elsewhere
1|fire

Reports are written also when tests fail, and each can go to standard output instead of the text.

$ kiln test fire wrong --no-report --junit out/r/junit.xml --json=out/r/all.json --tap out/r/all.tap; echo $?; ls out/r
1|pass    fire   1 frame in <s> s
1|error   wrong  wrong.test.yaml:1:1: scne: unknown key (did you mean 'scene'?)
1|2 tests in <s> s: 1 pass, 1 error
1|1 frame: 1 by pixels, 0 by metrics
1|3
1|all.json
1|all.tap
1|junit.xml
$ kiln test fire wrong --no-report --junit - 2>/dev/null | grep -c '<testcase'
1|2
$ kiln test fire wrong --no-report --tap - 2>/dev/null | grep -E '^(1\.\.|ok|not ok)'
1|1..2
1|ok 1 - fire
1|not ok 2 - wrong
$ kiln test fire wrong --no-report --json 2>/dev/null | jq -c '.tests[] | [.name, .status]'
1|["fire","pass"]
1|["wrong","error"]
$ kiln test fire wrong --no-report --github
1|pass    fire   1 frame in <s> s
1|error   wrong  wrong.test.yaml:1:1: scne: unknown key (did you mean 'scene'?)
1|::error file=wrong.test.yaml,title=Golden image test broke%3A wrong::wrong.test.yaml:1:1: scne: unknown key (did you mean 'scene'?)%0Ato run it again: kiln test wrong.test.yaml
1|::notice title=kiln test::2 tests: 1 pass, 1 error; in <s> s
1|2 tests in <s> s: 1 pass, 1 error
1|1 frame: 1 by pixels, 0 by metrics
= 3
$ kiln test fire --report page.html --junit fire.test.yaml/junit.xml; echo $?; ls page.html
1|pass    fire  1 frame in <s> s
1|1 test in <s> s: 1 pass
1|report: page.html
1|1 frame: 1 by pixels, 0 by metrics
1|2
1|page.html
2|kiln: fire.test.yaml: the path is not a folder, but fire.test.yaml/junit.xml needs a folder here
$ kiln test wrong -q --junit fire.test.yaml/junit.xml
1|error   wrong  wrong.test.yaml:1:1: scne: unknown key (did you mean 'scene'?)
1|1 test in <s> s: 1 error
1|report: out/test/report.html
1|0 frames: 0 by pixels, 0 by metrics
2|kiln: fire.test.yaml: the path is not a folder, but fire.test.yaml/junit.xml needs a folder here
= 3
$ kiln test slow -q --test-timeout 0.25 --junit fire.test.yaml/junit.xml
1|error   slow  took longer than 0.25 s
1|1 test in <s> s: 1 error
1|report: out/test/report.html
1|0 frames: 0 by pixels, 0 by metrics
2|kiln: fire.test.yaml: the path is not a folder, but fire.test.yaml/junit.xml needs a folder here
= 5
$ kiln test fire --results fire.test.yaml
2|kiln: fire.test.yaml: cannot open the folder: Not a directory
= 6
$ kiln test fire --no-report >/dev/full
2|kiln: standard output: No space left on device
= 6

A test that is gone leaves its goldens, which a run of a whole folder tells.

$ mkdir one; cp -r fire.test.yaml scenes one; mkdir golden/one; mv golden/fire golden/one/fir
$ kiln test one --no-report; mv golden/one/fir golden/fire; rm -r one golden/one
1|new     one/fire          1 frame in <s> s: frame 6 has no golden: the file golden/one/fire/frame_0006.png is missing
1|new     one/scenes/empty  1 frame in <s> s: frame 1 has no golden: the file golden/one/scenes/empty/frame_0001.png is missing
1|2 tests in <s> s: 2 new
1|golden/one/fir: no test uses these goldens; perhaps a test was renamed or lost
1|where the pictures are right, accept them: kiln test approve --all one
1|2 frames: 0 by pixels, 0 by metrics, 2 by nothing

Results do not go where goldens are, whose pictures they would replace.

$ cp -r golden kept; ln -s golden link
$ kiln test fire --results golden; kiln test fire --golden none --results none/
2|kiln: golden: the folder of the results is also the folder of the goldens; results need a folder of their own
2|kiln: none: the folder of the results is also the folder of the goldens; results need a folder of their own
= 2
$ kiln test fire --results link/
2|kiln: link: the folder of the results is also the folder of the goldens; results need a folder of their own
= 2
$ mkdir -p out/nested; cp -r golden/fire out/nested/fire
$ kiln test fire --results out/nested --no-report
2|kiln: out/nested/fire: the folder holds goldens; results need a folder of their own
= 2
$ diff -r golden kept; diff -rq golden/fire out/nested/fire; rm -r kept link

Shards are merged.

$ kiln test fire wrong --shard 1/2 --results out/1 --no-report -q; kiln test fire wrong --shard 2/2 --results out/2 --no-report -q
1|error   wrong  wrong.test.yaml:1:1: scne: unknown key (did you mean 'scene'?)
1|1 test in <s> s: 1 error
1|0 frames: 0 by pixels, 0 by metrics
= 3
$ kiln test report out/1 out/2 --tap out/all.tap; echo $?; ls out/1/report.html; grep -c 'ok ' out/all.tap
1|2 tests in <s> s: 1 pass, 1 error
1|1 frame: 1 by pixels, 0 by metrics
1|report: out/1/report.html
1|3
1|out/1/report.html
1|2
$ kiln test report out/1 -q --junit out/half.xml; echo $?; grep -c 'message="shard 2 of 2 is missing' out/half.xml; kiln test report void
1|2 tests in <s> s: 1 pass, 1 error
1|1 frame: 1 by pixels, 0 by metrics
1|report: out/1/report.html
1|3
1|1
2|kiln: test report: shard 2 of 2 is missing: its tests were judged nowhere
2|void/run.json: No such file or directory
= 3

What follows ends tests itself, while they run.

$ sed -i '/^time_limit/d' slow.test.yaml

A crash is the error of its test, and the other tests go on. The process is killed from outside: the
run is the parent of it.

$ cat >child <<'END'
> # child FOLDER RUN: waits until the test 'slow' has begun, and prints the children of the run.
> children=
> until [ -e "out/$1/slow/log.txt" ] && [ -n "$children" ]; do
>     sleep 0.1
>     children=$(cat "/proc/$2/task/$2/children")
> done
> echo $children
> END
$ kiln test fire slow -j1 --results out/crash --no-report & run=$!
> child=$(bash child crash $run); kill -SEGV $child; wait $run
1|pass    fire  1 frame in <s> s
1|error   slow  crashed: signal 11 (Segmentation fault)
1|2 tests in <s> s: 1 pass, 1 error
1|1 frame: 1 by pixels, 0 by metrics
= 5

A signal to the run ends its tests, and leaves neither processes nor half-written files.

$ env --default-signal kiln test slow fire -j2 --results out/stop >/dev/null & run=$! # may end before
> child=$(bash child stop $run); kill -TERM $run; wait $run; code=$?
> for id in $child; do [ ! -d /proc/$id ] || echo "$id is left"; done
> find out/stop -name '*.tmp'; exit $code
2|kiln: test: stopped by SIGTERM after <n> of 2 tests
= 143
$ env --default-signal kiln test slow --results out/int & run=$!
> child=$(bash child int $run); kill -INT $run; wait $run
2|kiln: test: stopped by SIGINT after <n> of 1 tests
= 130
$ env --default-signal kiln test slow --results out/killed & run=$!
> child=$(bash child killed $run); kill -KILL $run; wait $run 2>/dev/null
> for try in {1..300}; do
>     left=$(grep -s '^State' /proc/$child/status | grep -v zombie) || break
>     sleep 0.1
> done
> echo "left: $left"
1|left: 

Two runs do not share a folder of results.

$ env --default-signal kiln test slow --results out/both & run=$!
> bash child both $run >/dev/null; kiln test fire --results out/both; echo $?
> kill -TERM $run; wait $run
1|2
2|kiln: out/both: another run writes its results there; give this one another folder by --results
2|kiln: test: stopped by SIGTERM after <n> of 1 tests
= 143

Limits from measurements.

$ kiln test calibrate fire --repeat 2 | sed 's/^  threads=.*/  <threads and techniques>/'
1|fire
1|  <threads and techniques>
1|  <threads and techniques>
1|  2 renders, equal to the bit
1|  metric                  limit     measured     proposed
1|  flip.mean                0.01            0        0.001
1|  flip.p99                  0.1            0        0.025
1|  window.share              0.1            0         0.01
$ kiln test calibrate fire --repeat 2 -q --write; grep -E '^(measured|limits)' golden/fire/expect.yaml
1|limits: {flip.mean: 0.001, flip.p99: 0.025, window.share: 0.01}
1|measured: {flip.mean: 0, flip.p99: 0, window.share: 0}
$ kiln test fire --no-report
1|pass    fire  1 frame in <s> s
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
$ kiln test calibrate wrong fier
2|kiln: no test has the name 'fier' (did you mean 'fire'?)
= 2
$ kiln test calibrate wrong
1|wrong
2|wrong.test.yaml:1:1: scne: unknown key (did you mean 'scene'?)
= 3
$ kiln test calibrate fire --repeat 1
2|kiln: test calibrate: --repeat: found '1', expected a whole number from 2 to 1000
= 2
