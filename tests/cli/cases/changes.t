Pixels that have changed, hashes alone, and many pictures at once.

$ printf 'kiln_test: 1\nscene: scenes/tiny.yaml\nframes: [6]\nsize: [32, 18]\n' | tee a.test.yaml >b.test.yaml; printf 'golden: hash\n' | cat a.test.yaml - >hash.test.yaml
$ kiln test --filter a --filter b --filter hash -q --update missing --no-report; ls golden/a golden/hash; test $(wc -c <golden/hash/expect.yaml) -lt 300 && echo small
1|golden/a:
1|expect.yaml
1|frame_0006.png
1|scene.yaml
1|
1|golden/hash:
1|expect.yaml
1|small

What was accepted says of which kiln. A hash golden has no picture.

$ grep -o 'kiln: "[^"]*"' golden/a/expect.yaml golden/hash/expect.yaml
1|golden/a/expect.yaml:kiln: "0.2.0"
1|golden/hash/expect.yaml:kiln: "0.2.0"

Other pixels within the limits are a change: told, and strictly a failure.

$ cp -r golden right; sed -i 's/{hash: "..../{hash: "0000/' golden/*/expect.yaml
$ kiln test --filter a --no-report
1|change  a  1 frame in <s> s: frame 6: the renderer changed, from kiln 0.2.0 to kiln 0.2.0; the picture is within its limits
1|1 test in <s> s: 1 change
1|where the pictures are right, accept them: kiln test approve a
1|1 frame: 0 by pixels, 1 by metrics
$ kiln test --filter a --no-report --strict
1|fail    a  1 frame in <s> s: frame 6: the renderer changed, from kiln 0.2.0 to kiln 0.2.0; the picture is within its limits
1|1 test in <s> s: 1 fail
1|where the pictures are right, accept them: kiln test approve a
1|1 frame: 1 by pixels, 0 by metrics
= 1
$ sed -i '/^scene_hash/s/"..../"0000/' golden/a/expect.yaml && kiln test --filter a --no-report; rm -r golden/a && cp -r right/a golden
1|change  a  1 frame in <s> s: frame 6 has other pixels than the accepted ones on cpu; the picture is within its limits
1|1 test in <s> s: 1 change
1|where the pictures are right, accept them: kiln test approve a
1|1 frame: 0 by pixels, 1 by metrics
$ kiln test --filter hash --no-report
1|fail    hash  1 frame in <s> s: frame 6: the renderer changed, from kiln 0.2.0 to kiln 0.2.0; no picture is kept; --against PROGRAM draws it
1|1 test in <s> s: 1 fail
1|where the pictures are right, accept them: kiln test approve hash
1|1 frame: 1 by pixels, 0 by metrics
= 1

$ kiln test --filter hash --no-report --ignore-hashes
1|new     hash  1 frame in <s> s: frame 6: the test keeps hashes alone, and the hashes are ignored
1|1 test in <s> s: 1 new
1|where the pictures are right, accept them: kiln test approve hash
1|1 frame: 0 by pixels, 0 by metrics, 1 by nothing
= 7

Another kiln draws what was accepted; one that draws something else, or nothing, is told of.

$ printf '#!/bin/sh\nexec kiln "$@" --set post.exposure=0.3\n' >other; chmod +x other; cp -r right/. golden; sed -i '3a set: [post.exposure=0.4]' hash.test.yaml
$ kiln test --filter hash --no-report --against ./other; ls out/test/hash
1|fail    hash  1 frame in <s> s: frame 6 has other pixels than the accepted ones on cpu; no picture is kept
1|        ./other draws frame 6 with other pixels than the accepted ones, which kiln 0.2.0 drew: the program, the scene or the driver differs
1|1 test in <s> s: 1 fail
1|where the pictures are right, accept them: kiln test approve hash
1|1 frame: 1 by pixels, 0 by metrics
1|frame_0006.png
1|frame_0006_error.png
1|frame_0006_reference.png
1|log.txt
1|result.json
$ sed -i '/^set/d' hash.test.yaml; sed -i 's/{hash: "..../{hash: "0000/' golden/hash/expect.yaml; kiln test --filter hash --no-report --against kiln | head -n 2
1|fail    hash  1 frame in <s> s: frame 6: the renderer changed, from kiln 0.2.0 to kiln 0.2.0; no picture is kept
1|        kiln draws frame 6 with other pixels than the accepted ones, which kiln 0.2.0 drew: the program, the scene or the driver differs
$ kiln test --filter hash --no-report --against false | head -n 2
1|fail    hash  1 frame in <s> s: frame 6: the renderer changed, from kiln 0.2.0 to kiln 0.2.0; no picture is kept
1|        false failed to draw frame 6, exit code 1
$ kiln test --filter hash --no-report --against ./nowhere
1|fail    hash  1 frame in <s> s: frame 6: the renderer changed, from kiln 0.2.0 to kiln 0.2.0; no picture is kept
1|        ./nowhere cannot be run: No such file or directory
1|1 test in <s> s: 1 fail
1|where the pictures are right, accept them: kiln test approve hash
1|1 frame: 1 by pixels, 0 by metrics
= 1

No report replaces the program that draws.

$ kiln test --filter hash --against ./other --report ./other --force
2|kiln: ./other: --report would replace --against, which this command reads
= 2
$ grep -c exec other
1|1

One command accepts what a mass change has changed; others take names, patterns, and a device.

$ sed -i '3a set: [post.exposure=0.4]' a.test.yaml b.test.yaml hash.test.yaml; kiln test --filter a --filter b --filter hash
1|fail    a     1 frame in <s> s: frame 6 has other pixels than the accepted ones on cpu; flip.mean is <value>, beyond 0.01; flip.p99 is <value>, beyond 0.1; window.share is <value>, beyond 0.1
1|fail    b     1 frame in <s> s: frame 6 has other pixels than the accepted ones on cpu; flip.mean is <value>, beyond 0.01; flip.p99 is <value>, beyond 0.1; window.share is <value>, beyond 0.1
1|fail    hash  1 frame in <s> s: frame 6 has other pixels than the accepted ones on cpu; no picture is kept; --against PROGRAM draws it
1|3 tests in <s> s: 3 fail
1|report: out/test/report.html
1|where the pictures are right, accept them: kiln test approve --all
1|3 frames: 1 by pixels, 2 by metrics
= 1
$ grep -o 'kiln test approve --all' out/test/report.html | head -n 1
1|kiln test approve --all
$ kiln test approve --all --dry-run --device llvmpipe
1|all tests: nothing to accept
$ kiln test approve '[bc]*'
1|wrote golden/b/frame_0006.png
1|wrote golden/b/scene.yaml
1|wrote golden/b/expect.yaml
$ kiln test approve --all
1|wrote golden/a/frame_0006.png
1|wrote golden/a/scene.yaml
1|wrote golden/a/expect.yaml
1|wrote golden/b/frame_0006.png
1|wrote golden/b/scene.yaml
1|wrote golden/b/expect.yaml
1|wrote golden/hash/expect.yaml
$ kiln test approve --all; kiln test approve 'z*'; kiln test approve; kiln test approve --all a
1|wrote golden/a/frame_0006.png
1|wrote golden/a/scene.yaml
1|wrote golden/a/expect.yaml
1|wrote golden/b/frame_0006.png
1|wrote golden/b/scene.yaml
1|wrote golden/b/expect.yaml
1|wrote golden/hash/expect.yaml
2|kiln: test approve: no result of a test like 'z*' in out/test
2|kiln: test approve: names of tests are missing; give them, or --all
2|kiln: test approve: --all takes no names
= 2
$ kiln test --filter a --filter b --filter hash -q --strict --no-report

A test that was skipped keeps no other from it; hashes that others have accepted since are kept, and
those of a state that is not known are added.

$ printf 'kiln_test: 1\nscene: scenes/tiny.yaml\nframes: [6]\nsize: [32, 18]\ndevices: [no-such-device]\n' >skip.test.yaml; sed -i 's/0.4/0.5/' hash.test.yaml
$ kiln test --filter skip --filter hash -q --no-report | tail -n 1; sed -i 's/{hash: "..../{hash: "0000/' golden/hash/expect.yaml; kiln test approve --all
1|1 frame: 1 by pixels, 0 by metrics
2|hash: its goldens have changed since the run; run it again: kiln test hash.test.yaml
= 3
$ kiln test --filter skip --filter hash -q --no-report | tail -n 1; kiln test approve --all; kiln test approve --all --device nowhere
1|1 frame: 1 by pixels, 0 by metrics
1|wrote golden/hash/expect.yaml
1|all tests: nothing to accept
$ sed -i '/state:/d' golden/hash/expect.yaml; kiln test --filter hash --no-report; kiln test --filter hash -q --no-report --update all; grep -c state: golden/hash/expect.yaml
1|pass    hash  1 frame in <s> s
1|        no state is accepted for frame 6: --update all adds it
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
1|1
$ kiln test --filter hash -q --no-report --against true; sed -i 's/0.5/0.6/' hash.test.yaml; kiln test --filter hash --no-report --against true | head -n 2
1|fail    hash  1 frame in <s> s: frame 6 has other pixels than the accepted ones on cpu; no picture is kept
1|        true failed to draw frame 6: out/test/hash/frame_0006_reference.png: the image cannot be opened: No such file or directory

Pixels of cpu must be known, strictly.

$ sed -i '/^ *pixels:/,$d' golden/a/expect.yaml; kiln test --filter a --no-report; kiln test --filter a --no-report --strict
1|pass    a  1 frame in <s> s
1|1 test in <s> s: 1 pass
1|1 frame: 0 by pixels, 1 by metrics
1|fail    a  1 frame in <s> s: frame 6 has no accepted pixels of cpu, which are the same everywhere; --update all accepts them
1|1 test in <s> s: 1 fail
1|where the pictures are right, accept them: kiln test approve a
1|1 frame: 1 by pixels, 0 by metrics
= 1
