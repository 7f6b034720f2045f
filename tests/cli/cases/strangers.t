Texts out of files that do something on a terminal are shown and do nothing.

$ printf 'kiln-grid 1\n\033[31mred\033[0m 2 2\n' >wind.grid
$ printf 'kiln: 1\nsystems: {a: {emit: {rate: 1}, forces: [{wind: {field: grid, file: wind.grid}}]}}\n' >wind.yaml
$ kiln check wind.yaml
2|wind.yaml:2:68: systems.a.forces.0.wind.file: 'wind.grid': 2: expected 'size' and three whole numbers from 2 to 1024, found '\x1b[31mred\x1b[0m 2 2'
= 3
$ printf 'kiln: 1\nsystems: {"\342\200\256gpj": {emit: {rat: 1}}}\n' >over.yaml
$ kiln check over.yaml
2|over.yaml:2:11: systems.\u202egpj: a name starts with a letter and has at most 32 letters, digits, '_' and '-'
= 3
$ kiln check "$(printf 'no\033]0;title\007 such\nfile.yaml')"
2|no\x1b]0;title\x07 such\nfile.yaml: No such file or directory
= 3
$ kiln render scenes/tiny.yaml --progress none -o "$(printf 'a\033[2J')/%02d.png" --frames 0-1 && cp -r a* b && kiln compare a* b --tolerance nonsense=1
1|device: <device>
1|a\x1b[2J/00.png and 1 more: 2 frames in <s> s
2|kiln: limit 'nonsense=1': unknown metric 'nonsense'; 'kiln help metrics' lists them
= 2
$ mv b/00.png "$(printf 'b/\302\2332J.png')" && kiln compare a* b
1|  frame                    verdict            flip.mean  of limit
1|  00.png                   missing     only in the reference
1|  01.png                   same                       0       0 %
1|  \u009b2J.png             extra       only in the test
1|b against a\x1b[2J: different
1|  3 frames: 1 same, 1 missing, 1 extra; the worst is 00.png
1|  metric                  worst         mean  at                        limit
1|  flip.mean                   0            0  01.png                     0.01  within
1|  flip.p50                    0            0  01.png                        -
1|  flip.p99                    0            0  01.png                      0.1  within
1|  flip.max                    0            0  01.png                        -
1|  ssim                        1            1  01.png                        -
1|  psnr                      inf          inf  01.png                        -
1|  abs.max                     0            0  01.png                        -
1|  abs.mean                    0            0  01.png                        -
1|  differing.count             0            0  01.png                        -
1|  differing.share             0            0  01.png                        -
1|  window.share                0            0  01.png                      0.1  within
= 1

A test file names no scene outside the root of its suite.

$ mkdir -p suite/tests away && cp scenes/tiny.yaml scenes/puff.png suite; cp suite/*.* away
$ printf 'kiln_test: 1\nscene: ../tiny.yaml\nframes: 3\n' >suite/tests/near.test.yaml
$ printf 'kiln_test: 1\nscene: ../../away/tiny.yaml\nframes: 3\n' >suite/tests/far.test.yaml
$ kiln test suite/tests --update=missing -q && rm -r golden
$ (cd suite && kiln test tests --update=missing --no-report)
1|error   tests/far   tests/far.test.yaml: scene: 'tests/../../away/tiny.yaml' is not below the root of the suite, <folder>/work/suite (--asset-root)
1|pass    tests/near  1 frame in <s> s
1|        wrote golden/tests/near/frame_0003.png
1|2 tests in <s> s: 1 pass, 1 error
1|1 picture was written: look at it before you keep it
1|1 frame: 0 by pixels, 0 by metrics, 1 by nothing
= 3
$ (cd suite && kiln test tests --update=missing -q --no-report --asset-root .. && kiln test tests -q --no-report --asset-root .. && kiln test list tests --asset-root ..)
1|tests/far
1|tests/near
$ (cd away && kiln test ../suite/tests --update=missing --no-report; kiln test ../suite --update=missing --no-report -q)
1|error   far   ../suite/tests/far.test.yaml: scene: '../suite/tests/../../away/tiny.yaml' is not below the root of the suite, <folder>/work/suite/tests (--asset-root)
1|error   near  ../suite/tests/near.test.yaml: scene: '../suite/tests/../tiny.yaml' is not below the root of the suite, <folder>/work/suite/tests (--asset-root)
1|2 tests in <s> s: 2 error
1|0 frames: 0 by pixels, 0 by metrics
1|error   far   ../suite/tests/far.test.yaml: scene: '../suite/tests/../../away/tiny.yaml' is not below the root of the suite, <folder>/work/suite (--asset-root)
1|2 tests in <s> s: 1 pass, 1 error
1|1 picture was written: look at it before you keep it
1|1 frame: 0 by pixels, 0 by metrics, 1 by nothing
= 3
$ (cd away && ln -s /etc/passwd suite.yaml; printf 'kiln_test: 1\nscene: suite.yaml\n' >link.test.yaml; kiln test . --update=missing --no-report)
1|error   link  link.test.yaml: scene: 'suite.yaml' is not below the root of the suite, <folder>/work/away (--asset-root)
1|pass    tiny  2 frames in <s> s
1|        wrote golden/tiny/frame_0012.png
1|        wrote golden/tiny/frame_0023.png
1|2 tests in <s> s: 1 pass, 1 error
1|2 pictures were written: look at them before you keep them
1|golden/near: no test uses these goldens; perhaps a test was renamed or lost
1|2 frames: 0 by pixels, 0 by metrics, 2 by nothing
= 3
