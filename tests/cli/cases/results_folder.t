In a folder of results kiln removes and replaces only what it wrote there itself.

$ printf 'kiln_test: 1\nscene: scenes/tiny.yaml\nframes: [6]\nsize: [32, 18]\n' >fire.test.yaml
$ kiln test fire -q --update missing --no-report && cp -r out first

Somebody's folder is refused, and left as it is.

$ mkdir -p mine/fire && echo mine | tee mine/frame_0001.png mine/run.json mine/fire/result.json mine/fire/frame_0006.png >mine/notes
$ kiln test fire -q --results mine
2|kiln: mine: the folder is not empty, but has no .kiln-results, so its files may not be kiln's; name another folder by --results, or empty this one
= 2
$ find mine -type f | sort | xargs grep -c mine
1|mine/fire/frame_0006.png:1
1|mine/fire/result.json:1
1|mine/frame_0001.png:1
1|mine/notes:1
1|mine/run.json:1
$ mkdir hidden && touch hidden/.profile && kiln test fire -q --results hidden; ls -A hidden
1|.profile
2|kiln: hidden: the folder is not empty, but has no .kiln-results, so its files may not be kiln's; name another folder by --results, or empty this one

An empty one is taken. It gets a list of what was written, which sha256sum can read.

$ mkdir fresh && kiln test fire -q --results fresh && ls -A fresh fresh/fire && (cd fresh && sha256sum --quiet --check .kiln-results && wc -l <.kiln-results)
1|fresh:
1|.kiln-results
1|fire
1|report.html
1|run.json
1|
1|fresh/fire:
1|frame_0006.png
1|frame_0006_reference.png
1|log.txt
1|result.json
1|6
$ kiln test fire -q --results fresh && (cd fresh && sha256sum --quiet --check .kiln-results && wc -l <.kiln-results)
1|6

What somebody adds stays; what stands in the way is named, and nothing is removed before.

$ echo mine >fresh/fire/notes.txt && echo mine >fresh/notes.txt && kiln test fire -q --results fresh && cat fresh/fire/notes.txt fresh/notes.txt
1|mine
1|mine
$ cp -r fresh before && echo mine >fresh/fire/frame_0007.png && kiln test fire -q --results fresh
2|kiln: fresh/fire/frame_0007.png: kiln did not write this file; move it away, or name another folder by --results
= 2
$ diff -r before fresh
1|Only in fresh/fire: frame_0007.png
= 1
$ rm fresh/fire/frame_0007.png && echo mine >>fresh/fire/result.json && kiln test fire -q --results fresh
2|kiln: fresh/fire/result.json: changed since kiln wrote this file; move it away, or name another folder by --results
= 2
$ cp before/fire/result.json fresh/fire/ && echo '{}' >fresh/run.json && kiln test fire -q --results fresh
2|kiln: fresh/run.json: changed since kiln wrote this file; move it away, or name another folder by --results
= 2
$ rm fresh/run.json fresh/fire/log.txt && kiln test fire -q --results fresh && (cd fresh && sha256sum --quiet --check .kiln-results)

Tests that are not in a run keep their results, and their lines.

$ sed 's/\[6\]/[7]/' fire.test.yaml >smoke.test.yaml
$ kiln test smoke -q --results fresh --update missing && (cd fresh && sha256sum --quiet --check .kiln-results && cut -c 67- .kiln-results | sort)
1|
1|fire/frame_0006.png
1|fire/frame_0006_reference.png
1|fire/log.txt
1|fire/result.json
1|run.json
1|smoke/frame_0007.png
1|smoke/log.txt
1|smoke/result.json

A run that was killed leaves what it had begun, which the next may replace.

$ sed -i '/fire/d; 1a # writing fire' fresh/.kiln-results && touch fresh/fire/.frame_0006.png.kiln-1-0.tmp && kiln test fire -q --results fresh; ls -A fresh/fire; head -n 2 fresh/.kiln-results | cut -c 65-
1|frame_0006.png
1|frame_0006_reference.png
1|log.txt
1|notes.txt
1|result.json
1|
1|  smoke/frame_0007.png

A list of something else, or of a later kiln, is none.

$ mkdir other && echo '# kiln results 2' >other/.kiln-results && kiln test fire -q --results other
2|kiln: other/.kiln-results: not a list of results by this version of kiln; name another folder by --results
= 2
$ printf '# kiln results 1\nrun.json\n' >other/.kiln-results && kiln test fire -q --results other
2|kiln: other/.kiln-results: 'run.json' is not a line of a list of results
= 2

Reports replace reports of their kind by kiln, and nothing else; what is read never.

$ kiln test fire -q --report r.html --junit r.xml --json=r.json --tap r.tap && kiln test fire -q --report r.html --junit r.xml --json=r.json --tap r.tap && touch empty && kiln test fire -q --tap empty && head -n 2 empty
1|TAP version 13
1|# kiln
$ for report in 'junit r.tap' 'tap r.json' 'json r.xml' 'report r.xml' 'junit r.html' 'junit notes'; do echo mine >notes; kiln test fire -q --${report% *}=${report#* } 2>&1 || kiln test report out/test -q --${report% *}=${report#* }; done
1|kiln: r.tap: the file exists, and --junit did not write it (--force replaces it)
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
1|kiln: r.json: the file exists, and --tap did not write it (--force replaces it)
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
1|kiln: r.xml: the file exists, and --json did not write it (--force replaces it)
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
1|kiln: r.xml: the file exists, and --report did not write it (--force replaces it)
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
1|kiln: r.html: the file exists, and --junit did not write it (--force replaces it)
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
1|kiln: notes: the file exists, and --junit did not write it (--force replaces it)
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
2|kiln: r.tap: the file exists, and --junit did not write it (--force replaces it)
2|kiln: r.json: the file exists, and --tap did not write it (--force replaces it)
2|kiln: r.xml: the file exists, and --json did not write it (--force replaces it)
2|kiln: r.xml: the file exists, and --report did not write it (--force replaces it)
2|kiln: r.html: the file exists, and --junit did not write it (--force replaces it)
2|kiln: notes: the file exists, and --junit did not write it (--force replaces it)
= 2
$ cat notes
1|mine
$ kiln test fire -q --junit notes --force && head -n 1 notes
1|<?xml version="1.0" encoding="UTF-8"?>
$ for file in fire.test.yaml scenes/tiny.yaml scenes/puff.png golden/fire/frame_0006.png golden/fire/expect.yaml golden/fire/../fire/scene.yaml out/test/fire/frame_0006.png out/test/run.json out/test/fire/result.json out/test/.kiln-results; do kiln test fire -q --force --report $file; done
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
2|kiln: fire.test.yaml: --report would replace a test file, which this command reads
2|kiln: scenes/tiny.yaml: --report would replace a scene, which this command reads
2|kiln: scenes/puff.png: --report would replace a file of a scene, which this command reads
2|kiln: golden/fire/frame_0006.png: --report would replace a golden, which this command reads
2|kiln: golden/fire/expect.yaml: --report would replace a golden, which this command reads
2|kiln: golden/fire/../fire/scene.yaml: --report would replace a golden, which this command reads
2|kiln: out/test/fire/frame_0006.png: --report would replace a picture of a result, which this command reads
2|kiln: out/test/run.json: the results and --report would both write this file
2|kiln: out/test/fire/result.json: the results and --report would both write this file
2|kiln: out/test/.kiln-results: the results and --report would both write this file
= 2
$ kiln test fire -q --junit j --json=./j
2|kiln: j: --json and --junit would both write this file
= 2
$ kiln test fire -q --report out/test/x.html --tap out/../out/test/x.html
2|kiln: out/test/x.html: --tap and --report would both write this file
= 2
$ for file in out/test/run.json out/test/fire/result.json out/test/fire/frame_0006.png; do kiln test report out/test -q --force --report $file; done
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
1|1 test in <s> s: 1 pass
1|1 frame: 1 by pixels, 0 by metrics
2|kiln: out/test/run.json: --report would replace a run, which this command reads
2|kiln: out/test/fire/result.json: --report would replace a result, which this command reads
2|kiln: out/test/fire/frame_0006.png: --report would replace a picture of a result, which this command reads
= 2
$ kiln test fire -q --no-report && diff -r golden first/../golden && grep -c kiln: scenes/tiny.yaml
1|1
