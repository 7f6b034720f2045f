kiln bench --against: this program and another one, in turn, on the same scenes. Numbers are masked.

$ printf '#!/bin/sh\nexec kiln "$@"\n' >same; chmod +x same
$ printf '#!/bin/sh\nsed -E "s/[0-9]+\\.[0-9]+/N/g; s/ +/ /g; s/ [(][0-9a-f]+[+]?[)]//; /^kiln|^$/d"\n' >masked; chmod +x masked
$ kiln bench scenes/tiny.yaml --against ./same --device cpu --quick --quiet --size 320x180 | ./masked
1|scenes/tiny.yaml: this program (new) and ./same, kiln N.0 (old)
1| frame measure technique ms quartiles turns times as fast as old
1| 12 CPU time old N N - N 3
1| 12 CPU time new N N - N 3 N (N - N)
1| 12 elapsed old N N - N 3
1| 12 elapsed new N N - N 3 N (N - N)
1| CPU time, new / old: N (N to N).
1| elapsed, new / old: N (N to N).
1| All 5 pictures are the same.
1| 320 x 180 pixels, frames 12-16; times are of a frame.
$ kiln bench scenes/tiny.yaml --against ./same --device cpu --quick -q --threads 1 --frame 3 --size 320x180 --format json >a.json; jq -c '.parts[] | .name, .suite, .unit, .reference, .sweep, (.rows[] | [.x, .measure, .technique, .value.turns, .value.median > 0, .times_as_fast != null])' a.json
1|"scenes/tiny.yaml"
1|"scenes/tiny.yaml"
1|"ms"
1|"old"
1|"frame"
1|[3,"CPU time","old",3,true,false]
1|[3,"CPU time","new",3,true,true]
1|[3,"elapsed","old",3,true,false]
1|[3,"elapsed","new",3,true,true]

Frames beyond the clip's end are added, and several scenes are parts of their own.

$ kiln bench scenes/tiny.yaml scenes/tiny.yaml --against ./same --device cpu --quick --quiet --set output.frames=1 --format json | jq -c '.parts[] | .suite, .notes[3]'
1|"scenes/tiny.yaml"
1|"64 x 36 pixels, frames 0-4; times are of a frame."
1|"scenes/tiny.yaml"
1|"64 x 36 pixels, frames 0-4; times are of a frame."

Pictures that differ are judged as by kiln compare.

$ printf '#!/bin/sh\ncase $1 in render) shift; exec kiln render --seed 9 "$@";; esac\nexec kiln "$@"\n' >differs; chmod +x differs
$ kiln bench scenes/tiny.yaml --against ./differs --device cpu --quick --quiet | grep differ | ./masked | sed 's/at worst .*/at worst <metrics>/'
1|scenes/tiny.yaml: this program (new) and ./differs, kiln N.0 (old)
1| 5 of 5 pictures differ, beyond the limits of kiln compare; at worst <metrics>

An old program that knows no --events: whole processes are compared.

$ printf '#!/bin/sh\nfor a; do case $a in --events*) echo "kiln: render: unknown option $a" >&2; exit 2;; esac; done\nexec kiln "$@"\n' >old; chmod +x old
$ kiln bench scenes/tiny.yaml --against ./old --device cpu --quick --quiet --size 320x180 | ./masked
1|scenes/tiny.yaml: this program (new) and ./old, kiln N.0 (old)
1| frame measure technique ms quartiles turns times as fast as old
1| 12 CPU time old N N - N 3
1| 12 CPU time new N N - N 3 N (N - N)
1| 12 elapsed old N N - N 3
1| 12 elapsed new N N - N 3 N (N - N)
1| CPU time, new / old: N (N to N).
1| elapsed, new / old: N (N to N).
1| All 5 pictures are the same.
1| 320 x 180 pixels, frames 12-16; times are of the whole process, since old knows no --events.

A scene that the other program cannot render, or hangs at, is not measured; others are.

$ printf '#!/bin/sh\ncase "$*" in *tiny*) echo "kiln: a: unknown key" >&2; exit 3;; esac\nexec kiln "$@"\n' >broken; chmod +x broken; cp scenes/tiny.yaml fine.yaml; cp scenes/puff.png .
$ kiln bench scenes/tiny.yaml fine.yaml --against ./broken --device cpu --quick --quiet --format json | jq -c '.parts[] | .suite, (.rows | length), .notes[0]' | ./masked
1|"scenes/tiny.yaml"
1|0
1|"Not measured: old: kiln render has exit code 3: kiln: a: unknown key"
1|"fine.yaml"
1|4
1|"CPU time, new / old: N (N to N)."
$ kiln bench scenes/tiny.yaml --against ./broken --device cpu --quick --quiet | tail -n 1; exit ${PIPESTATUS[0]}
1|  Not measured: old: kiln render has exit code 3: kiln: a: unknown key
2|kiln: bench: nothing could be measured; the notes of the tables say why
= 1
$ printf '#!/bin/sh\ncase $1 in render) sleep 1000;; esac\nexec kiln "$@"\n' >hangs; chmod +x hangs
$ kiln bench scenes/tiny.yaml --against ./hangs --device cpu --quick --quiet | tail -n 1 | sed -E 's/[0-9]+ s$/<n> s/'
1|  Not measured: old: kiln render has not ended within <n> s
2|kiln: bench: nothing could be measured; the notes of the tables say why

What cannot be.

$ kiln bench scenes/tiny.yaml --against ./nowhere --device cpu
2|kiln: bench: --against: ./nowhere: kiln --version cannot be started: No such file or directory
= 2
$ kiln bench scenes/tiny.yaml --against ./fine.yaml --device cpu
2|kiln: bench: --against: ./fine.yaml: kiln --version cannot be started: Permission denied
= 2
$ kiln bench scenes/tiny.yaml --against true --device cpu
2|kiln: bench: --against: true is not a kiln: its --version is 'Written by Jim Meyering.'
= 2
$ kiln bench scenes/tiny.yaml --against false --device cpu
2|kiln: bench: --against: false: kiln --version has exit code 1: Written by Jim Meyering.
= 2
$ kiln bench scenes/tiny.yaml --against echo --device cpu
2|kiln: bench: --against: echo is not a kiln: its --version is 'Written by Brian Fox and Chet Ramey.'
= 2
$ kiln bench --against ./same
2|kiln: bench: --against is for scenes, and no scene is given
= 2
$ kiln bench seed --against ./same
2|kiln: bench: --against is for scenes, not for the suite seed
= 2
$ kiln bench scenes/tiny.yaml --against ./same --stage sort
2|kiln: bench: --against compares whole frames, so --stage cannot be given
= 2

A signal leaves nothing behind.

$ mkdir scratch && (TMPDIR=$PWD/scratch exec env --default-signal timeout --foreground --preserve-status -s INT 2 kiln bench scenes/tiny.yaml --against ./same --device cpu --quiet --repeat 101 --seconds 100)
2|kiln: bench: stopped by SIGINT; nothing is written
= 130
$ ls -A scratch
