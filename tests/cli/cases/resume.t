Going on with a job. What is whole stays, what is missing or changed is drawn.

$ kiln render scenes/tiny.yaml -q --frames 0-5 -o ref_%d.png --manifest ref.json
$ kiln render scenes/tiny.yaml --frames 0-5 -o f_%d.png --resume --progress none --manifest m.json
1|device: <device>
1|f_0.png and 5 more: 6 frames in <s> s
$ rm f_1.png f_4.png && truncate -s 20 f_2.png
$ kiln render scenes/tiny.yaml --frames 0-5 -o f_%d.png --resume --progress none --manifest m.json
1|device: <device>
1|f_0.png and 5 more: 3 frames in <s> s, 3 kept
$ for i in 0 1 2 3 4 5; do cmp ref_$i.png f_$i.png; done
$ diff <(jq '.result | del(.output, .frames[].file)' ref.json) <(jq '.result | del(.output, .frames[].file)' m.json)
$ jq -c '.run | [.kept, (.frames | length), .command[0:2]]' m.json
1|[3,3,["kiln","render"]]
$ jq -c '.runs_before[] | [.error, .totals.asked, .totals.frames]' m.json
1|[null,6,6]
$ kiln render scenes/tiny.yaml --frames 0-5 -o f_%d.png --resume --progress none --json | jq -c 'select(.event == "result") | [.frames, .kept, .steps]'
1|[0,6,0]

The manifest of a run that failed says why, how far it came, and which frames are there.

$ kiln render scenes/tiny.yaml -q --frames 0-5 -o l_%d.png --limits output=3000 --manifest l.json 2>&1 | sed 's/l_[01].png: .* of/.../'
1|kiln: ... output, and the limit `output` is 2.93 KiB
$ jq -c '.run.error.code, .run.totals.asked, .result.missing + (.result.frames | length), (.result.missing > 3)' l.json
1|8
1|6
1|6
1|true
$ diff <(jq -r '.result.frames[].file' l.json) <(ls l_*.png 2>/dev/null)

A journal that a crash has cut off says less; without one, frames say themselves whose they are.

$ sed -i '/"run"/d' f_%d.png.journal && truncate -s -30 f_%d.png.journal && kiln render scenes/tiny.yaml --frames 0-5 -o f_%d.png --resume --progress none
1|device: <device>
1|f_0.png and 5 more: 0 frames in <s> s, 6 kept
$ rm f_%d.png.journal f_3.png && kiln render scenes/tiny.yaml --frames 0-5 -o f_%d.png --resume --progress none
1|device: <device>
1|f_0.png and 5 more: 1 frame in <s> s, 5 kept
$ cmp ref_3.png f_3.png && grep -c "{.frame" f_%d.png.journal
1|6
$ kiln render scenes/tiny.yaml -q --frames 0-2 -o e_%d.exr && rm e_1.exr && kiln render scenes/tiny.yaml --frames 0-2 -o e_%d.exr --resume --progress none
1|device: <device>
1|e_0.exr and 2 more: 1 frame in <s> s, 2 kept

$ rm e_%d.exr.journal && kiln render scenes/tiny.yaml -q --frames 0-2 -o e_%d.exr --resume --exr-bits 32; rm f_%d.png.journal && kiln render scenes/tiny.yaml -q --frames 0-5 -o f_%d.png --resume --png-bits 16; ls *.journal
2|kiln: e_0.exr: the file exists, and is not a whole frame 0 of this job (--force replaces it)
2|kiln: f_0.png: the file exists, and is not a whole frame 0 of this job (--force replaces it)
2|ls: cannot access '*.journal': No such file or directory
= 2
$ kiln render scenes/tiny.yaml --frames 0-5 -o f_%d.png --resume --progress none
1|device: <device>
1|f_0.png and 5 more: 0 frames in <s> s, 6 kept

What is of another job is refused, --force starts anew.

$ kiln render scenes/tiny.yaml -q --frames 0-5 -o f_%d.png --resume --seed 1
2|kiln: f_%d.png.journal: the journal belongs to another scene, or to this scene with other values or another size (--force starts anew)
= 2
$ kiln render scenes/tiny.yaml -q --frames 0-4 -o f_%d.png --resume
2|kiln: f_%d.png.journal: the journal belongs to other frames, or to other settings of the output (--force starts anew)
= 2
$ kiln render scenes/tiny.yaml -q --frames 0-5 -o f_%d.png --resume --png-bits 16
2|kiln: f_%d.png.journal: the journal belongs to other frames, or to other settings of the output (--force starts anew)
= 2
$ kiln render scenes/tiny.yaml -q --frames 0-5 -o f_%d.png --resume --technique simulate=inplace 2>&1 | sed "s/(kiln.*//"
1|kiln: f_%d.png.journal: the output was begun by another program, device or techniques 
$ echo mine >f_%d.png.journal; kiln render scenes/tiny.yaml -q --frames 0-5 -o f_%d.png --resume
2|kiln: f_%d.png.journal: the file is not a journal (--force starts anew)
= 2
$ kiln render scenes/tiny.yaml --frames 0-5 -o f_%d.png --resume --force --progress none
1|device: <device>
1|f_0.png and 5 more: 6 frames in <s> s
$ echo mine >x_1.png; kiln render scenes/tiny.yaml -q --frames 0-2 -o x_%d.png --resume
2|kiln: x_1.png: the file exists, and is not a whole frame 1 of this job (--force replaces it)
= 2
$ (flock 9; kiln render scenes/tiny.yaml -q --frames 0-5 -o f_%d.png --resume) 9<f_%d.png.journal
2|kiln: f_%d.png.journal: another process is writing this output: it has the journal
= 6
$ kiln render scenes/tiny.yaml -q -o none --resume
2|kiln: render: --resume: '--output none' writes nothing to go on with
= 2
$ mkfifo p_%d.png.journal; kiln render scenes/tiny.yaml -q --frames 0-2 -o p_%d.png --resume
2|kiln: p_%d.png.journal: the path is not a regular file
= 2

Clips wait in parts: here of 20 frames, the last of one.

$ kiln render scenes/tiny.yaml -q --fps 10 --set output.frames=41 -o ref.mp4
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=41 -o c.mp4 --resume --progress none
1|device: <device>
1|c.mp4: 41 frames in <s> s
$ cmp ref.mp4 c.mp4 && ls -d c.mp4*
1|c.mp4
1|c.mp4.journal
$ jq -c 'if .part then .frames elif .run then .run.totals.frames else .clip end' c.mp4.journal
1|null
1|[0,19]
1|[20,39]
1|[40,40]
1|"c.mp4"
1|41
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=41 -o c.mp4 --resume --progress none
1|device: <device>
1|c.mp4: 0 frames in <s> s, 41 kept
$ rm c.mp4; kiln render scenes/tiny.yaml --fps 10 --set output.frames=41 -o c.mp4 --resume --progress none
1|device: <device>
1|c.mp4: 41 frames in <s> s
$ cmp ref.mp4 c.mp4
$ echo mine >d.mp4; kiln render scenes/tiny.yaml -q -o d.mp4 --resume; ls d.mp4* x_*
1|d.mp4
1|x_1.png
2|kiln: d.mp4: the file exists, and no journal says that this job made it (--force replaces it)

Of a journal, the job does not heed what its format does not: a PNG has no bits of EXR.

$ kiln render scenes/tiny.yaml -q --frames 0-1 -o q_%d.png --resume && kiln render scenes/tiny.yaml --frames 0-1 -o q_%d.png --resume --exr-bits 32 --progress none
1|device: <device>
1|q_0.png and 1 more: 0 frames in <s> s, 2 kept

The folder of parts is no link: nothing is written or removed behind it.

$ mkdir elsewhere && touch elsewhere/00000.part && ln -s elsewhere linked.mp4.parts && kiln render scenes/tiny.yaml -q -o linked.mp4 --resume --device cpu; ls -d linked* elsewhere/*
1|elsewhere/00000.part
1|linked.mp4.parts
2|kiln: linked.mp4.parts: not a folder; the parts of the clip need a folder of this name
