What a run is judged by.

$ printf 'kiln_test: 1\nscene: scenes/tiny.yaml\nframes: [6]\nsize: [32, 18]\n' >fire.test.yaml
$ kiln test fire -q --update missing --no-report && kiln test fire -q --no-report

A picture without what was accepted of its state is not accepted, strictly or not.

$ rm golden/fire/expect.yaml && kiln test fire --no-report
1|new     fire  1 frame in <s> s: frame 6 is like its golden, but there is no golden/fire/expect.yaml, so the accepted state is not known
1|1 test in <s> s: 1 new
1|where the pictures are right, accept them: kiln test approve fire
1|1 frame: 0 by pixels, 1 by metrics
= 7
$ kiln test fire -q --strict --no-report
1|new     fire  1 frame in <s> s: frame 6 is like its golden, but there is no golden/fire/expect.yaml, so the accepted state is not known
1|1 test in <s> s: 1 new
1|where the pictures are right, accept them: kiln test approve fire
1|1 frame: 0 by pixels, 1 by metrics
= 7
$ kiln test fire -q --ignore-hashes --no-report
$ kiln test fire --update missing --dry-run --no-report | grep would
1|        would accept the hashes of frame 6 on cpu
$ cp golden/fire/frame_0006.png before.png && kiln test fire -q --update missing --no-report && cmp before.png golden/fire/frame_0006.png && grep -c state: golden/fire/expect.yaml
1|1
$ kiln test fire -q --strict --no-report

A scene that an older kiln accepted lacks keys that there are now. They are no changes; what was
changed is.

$ sed -i '/dither:/d; /restitution:/d' golden/fire/scene.yaml && sed -i 's/^scene_hash: "./scene_hash: "0/' golden/fire/expect.yaml && kiln test fire --no-report
1|pass    fire  1 frame in <s> s
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
$ echo 'set: [systems.smoke.look.soft=3]' >>fire.test.yaml && kiln test fire --no-report; jq -r '.changes[] | .key, .before, .after' out/test/fire/result.json; sed -i '$d' fire.test.yaml
1|pass    fire  1 frame in <s> s
1|        the scene has changed in 1 key, and the test passes
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
1|systems.smoke.look.soft
1|2 1/m
1|3 1/m

Nor is a picture right that differs.

$ rm golden/fire/expect.yaml && sed -i '4a set: [post.exposure=1]' fire.test.yaml && kiln test fire --no-report | head -n 1
1|fail    fire  1 frame in <s> s: frame 6: flip.mean is <value>, beyond 0.01; flip.p99 is <value>, beyond 0.1; window.share is <value>, beyond 0.1

A file whose name cannot be that of a test is the error of one test. Names have letters of any script.

$ mkdir names && cd names && cp -r ../scenes . && for name in 'my fire' Glühen; do sed 's/, frames.*//' ../fire.test.yaml >"$name.test.yaml"; done && kiln test . --no-report --update missing; ls golden
1|pass    Glühen        1 frame in <s> s
1|        wrote golden/Glühen/frame_0006.png
1|error   my_fire       my fire.test.yaml: 'my fire' cannot name a test: a name has up to 200 bytes of letters, digits, '.', '_' and '-', and does not start with '.' or '-'
1|pass    scenes/empty  1 frame in <s> s
1|        wrote golden/scenes/empty/frame_0001.png
1|3 tests in <s> s: 2 pass, 1 error
1|2 pictures were written: look at them before you keep them
1|2 frames: 0 by pixels, 0 by metrics, 2 by nothing
1|Glühen
1|scenes
