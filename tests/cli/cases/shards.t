A clip by several tasks: 61 frames in 4 parts, of which the last has one frame.

$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o ref.mp4 --manifest ref.json
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o c.mp4 --shard 1/3 --progress none
1|device: <device>
1|shard 1 of 3
1|c.mp4: parts 1-2: 40 frames in <s> s
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o c.mp4 --shard 3/3 --progress none
1|device: <device>
1|shard 3 of 3
1|c.mp4: part 4: 1 frame in <s> s
$ kiln join c.mp4; ls -d c.mp4*
1|c.mp4.1-of-3.journal
1|c.mp4.3-of-3.journal
1|c.mp4.parts
2|kiln: c.mp4: parts are missing or damaged: part 3 (frames 40-59)
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o c.mp4 --shard 2/3 && truncate -s -1 c.mp4.parts/00001.part && kiln join c.mp4
2|kiln: c.mp4: parts are missing or damaged: part 2 (frames 20-39)
= 6
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o c.mp4 --shard 1/3 --progress none
1|device: <device>
1|shard 1 of 3
1|c.mp4: parts 1-2: 20 frames in <s> s, 20 kept
$ kiln join c.mp4 --manifest m.json && cmp ref.mp4 c.mp4 && ls -d c.mp4*
1|c.mp4: 61 frames in 4 parts
1|c.mp4
1|c.mp4.journal
$ diff <(jq '.result | del(.output, .frames[].file, .files[].file)' ref.json) <(jq '.result | del(.output, .frames[].file, .files[].file)' m.json)
$ jq -c '.run.command[1], .run.kept, (.runs_before[] | [.shard, .error, .kept, .totals.asked, .totals.frames])' m.json
1|"join"
1|61
1|["1/3",null,0,40,40]
1|["1/3",null,20,20,20]
1|["2/3",null,0,20,20]
1|["3/3",null,0,1,1]
$ kiln join c.mp4 --manifest m.json && jq -c '[.runs_before[].shard]' m.json
1|c.mp4: 61 frames in 4 parts, whole already
1|["1/3","1/3","2/3","3/3"]

A share of a clip that is whole ends at once, however many shares there are, and leaves nothing. Where the clip is
damaged, or with --force, the share is drawn anew.

$ for shard in 1/3 3/3 2/2 9/9; do kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o c.mp4 --resume --shard $shard --progress none | tail -n 1; done; ls -d c.mp4*
1|c.mp4: parts 1-2: whole already, 40 frames kept
1|c.mp4: part 4: whole already, 1 frame kept
1|c.mp4: parts 3-4: whole already, 21 frames kept
1|c.mp4: this shard has none of its parts
1|c.mp4
1|c.mp4.journal
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 --seed 2 -q -o c.mp4 --resume --shard 1/3
2|kiln: c.mp4.journal: the journal belongs to another scene, or to this scene with other values or another size (--force starts anew)
= 2
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o c.mp4 --force --shard 3/3 --progress none | tail -n 1; ls -d c.mp4*
1|c.mp4: part 4: 1 frame in <s> s
1|c.mp4
1|c.mp4.3-of-3.journal
1|c.mp4.journal
1|c.mp4.parts
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o c.mp4 --resume --shard 3/3 --progress none | tail -n 1
1|c.mp4: part 4: whole already, 1 frame kept
$ kiln join c.mp4 && cmp ref.mp4 c.mp4 && ls -d c.mp4*
1|c.mp4: 61 frames in 4 parts, whole already
1|c.mp4
1|c.mp4.journal
$ truncate -s -1 c.mp4 && for i in 1 2; do kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o c.mp4 --resume --shard $i/2 --progress none | tail -n 1; done
1|c.mp4: parts 1-2: 40 frames in <s> s
1|c.mp4: parts 3-4: 21 frames in <s> s
$ kiln join c.mp4 && cmp ref.mp4 c.mp4 && ls -d c.mp4*
1|c.mp4: 61 frames in 4 parts
1|c.mp4
1|c.mp4.journal

Shards of different jobs are not joined.

$ for i in 1 2; do kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o d.webm --shard $i/2 --seed $i; done; kiln join d.webm; ls -d d.webm d.webm.journal
2|kiln: d.webm.1-of-2.journal: the journal belongs to another scene, or to this scene with other values or another size (--force starts anew)
2|kiln: d.webm: parts are missing or damaged: part 3 (frames 40-59), part 4 (frames 60-60)
2|ls: cannot access 'd.webm': No such file or directory
2|ls: cannot access 'd.webm.journal': No such file or directory
= 2

Nothing is lost by a refusal: while one shard is drawn, journals of the others stay. A plain run does not
write beside them; with --force it forgets them.

$ rm -r d.*; for i in 1 2; do kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o d.webm --shard $i/2; done
$ flock d.webm.2-of-2.journal kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o d.webm --resume; ls -d d.*
1|d.webm.1-of-2.journal
1|d.webm.2-of-2.journal
1|d.webm.parts
2|kiln: d.webm.2-of-2.journal: another process is writing this output: it has the journal
$ flock d.webm.2-of-2.journal kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o d.webm --force; ls -d d.*
1|d.webm.1-of-2.journal
1|d.webm.2-of-2.journal
1|d.webm.parts
2|kiln: d.webm.2-of-2.journal: another process is writing this output: it has the journal
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o d.webm
2|kiln: d.webm.1-of-2.journal: a job with --resume or --shard has begun this output (--force replaces it)
= 2
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o d.webm --resume --force --frames 0-30 && kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o d.webm --resume --frames 0-30; ls -d d.*
1|d.webm
1|d.webm.journal
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o d.webm --force; ls -d d.*
1|d.webm

A shard goes on with what a run of the whole has drawn, and not while that is at work.

$ kiln render scenes/tiny.yaml --fps 10 -q -o g_%02d.png --resume && echo damaged >g_23.png && rm g_22.png
$ flock g_%02d.png.journal kiln render scenes/tiny.yaml --fps 10 -q -o g_%02d.png --shard 2/2
2|kiln: g_%02d.png.journal: another process is writing this output: it has the journal
= 6
$ kiln render scenes/tiny.yaml --fps 10 -o g_%02d.png --shard 2/2 --progress none | tail -n 1; kiln join g_%02d.png; rm g_*
1|g_%02d.png: part 2: 2 frames in <s> s, 2 kept
1|g_%02d.png: 24 frames in 2 parts, whole already

A manifest replaces nothing but a manifest, and join no clip that it does not know.

$ for i in 1 2; do kiln render scenes/tiny.yaml --fps 10 -q -o m.mp4 --shard $i/2; done; kiln join m.mp4 --manifest m.mp4
2|kiln: m.mp4: --output and --manifest would both write this file
= 2
$ kiln join m.mp4 --manifest m.mp4.journal
2|kiln: m.mp4.journal: the journal and --manifest would both write this file
= 2
$ echo mine >m.mp4 && kiln join m.mp4; cat m.mp4
1|mine
2|kiln: m.mp4: the file exists, and no journal says that this job made it (--force replaces it)
$ kiln join m.mp4 --force --manifest m.json && kiln join m.mp4 --manifest m.json && jq .result.files[0].file m.json
1|m.mp4: 24 frames in 2 parts
1|m.mp4: 24 frames in 2 parts, whole already
1|"m.mp4"
$ echo mine >m.json && kiln join m.mp4 --manifest m.json; cat m.json
1|mine
2|kiln: m.json: the file exists (--force replaces it)

Images are only looked at; one task more than there are parts has none.

$ for i in 1 2 3 4 5; do kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o f_%02d.png --shard $i/5 --progress none | tail -n 1; done
1|f_%02d.png: part 1: 20 frames in <s> s
1|f_%02d.png: part 2: 20 frames in <s> s
1|f_%02d.png: part 3: 20 frames in <s> s
1|f_%02d.png: part 4: 1 frame in <s> s
1|f_%02d.png: this shard has none of its parts
$ rm f_30.png && echo x >f_31.png; kiln join f_%02d.png
2|kiln: f_%02d.png: parts are missing or damaged: frames 30-31
= 6
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o f_%02d.png --resume --progress none && kiln join f_%02d.png && ls *.journal
1|device: <device>
1|f_00.png and 60 more: 2 frames in <s> s, 59 kept
1|f_%02d.png: 61 frames in 4 parts, whole already
1|c.mp4.journal
1|f_%02d.png.journal
1|m.mp4.journal

A plain run with --resume draws what shards have left over.

$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -q -o g.gif --shard 2/2 && kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o g.gif --resume --progress none && ls -d g.gif*
1|device: <device>
1|g.gif: 40 frames in <s> s, 21 kept
1|g.gif
1|g.gif.journal
$ kiln render scenes/tiny.yaml --fps 10 --set output.frames=61 -o g.gif --resume --shard 1/2 --progress none | tail -n 1; ls -d g.gif*
1|g.gif: parts 1-2: whole already, 40 frames kept
1|g.gif
1|g.gif.journal

What schedulers say.

$ SLURM_ARRAY_TASK_ID=14 SLURM_ARRAY_TASK_MIN=10 SLURM_ARRAY_TASK_STEP=2 SLURM_ARRAY_TASK_COUNT=4 kiln render scenes/tiny.yaml -o h.mp4 --shard auto --progress none
1|device: <device>
1|shard 3 of 4, by SLURM_ARRAY_TASK_ID=14
1|h.mp4: this shard has none of its parts
$ SGE_TASK_ID=5 SGE_TASK_FIRST=1 SGE_TASK_LAST=9 SGE_TASK_STEPSIZE=4 kiln render scenes/tiny.yaml -o h.mp4 --shard auto --progress none
1|device: <device>
1|shard 2 of 3, by SGE_TASK_ID=5
1|h.mp4: this shard has none of its parts
$ JOB_COMPLETION_INDEX=0 kiln render scenes/tiny.yaml -o i.mp4 --shard auto/2 --progress none
1|device: <device>
1|shard 1 of 2, by JOB_COMPLETION_INDEX=0
1|i.mp4: part 1: 24 frames in <s> s
$ AWS_BATCH_JOB_ARRAY_INDEX=1 SGE_TASK_ID=undefined kiln render scenes/tiny.yaml -o i.mp4 --shard auto/2 --progress none
1|device: <device>
1|shard 2 of 2, by AWS_BATCH_JOB_ARRAY_INDEX=1
1|i.mp4: this shard has none of its parts
$ JOB_COMPLETION_INDEX=0 kiln render scenes/tiny.yaml -o i.mp4 --shard auto
2|kiln: render: --shard: auto: JOB_COMPLETION_INDEX gives the number of this task, but not the number of tasks; give it by auto/N
= 2
$ SLURM_ARRAY_TASK_ID=13 SLURM_ARRAY_TASK_MIN=10 SLURM_ARRAY_TASK_STEP=2 SLURM_ARRAY_TASK_COUNT=4 kiln render scenes/tiny.yaml -o h.mp4 --shard auto
2|kiln: render: --shard: SLURM_ARRAY_TASK_ID is 13; expected 10, or a number that is a multiple of 2 above it
= 2
$ SLURM_ARRAY_TASK_ID=ten kiln render scenes/tiny.yaml -o h.mp4 --shard auto/4
2|kiln: render: --shard: SLURM_ARRAY_TASK_ID: found 'ten', expected a whole number
= 2
$ JOB_COMPLETION_INDEX=4 kiln render scenes/tiny.yaml -o h.mp4 --shard auto/4
2|kiln: render: --shard: JOB_COMPLETION_INDEX says that this is task 5, but there are 4 tasks (at most 1000000 are allowed)
= 2
$ kiln render scenes/tiny.yaml -o h.mp4 --shard auto
2|kiln: render: --shard: auto: no scheduler says which task this is; looked for SLURM_ARRAY_TASK_ID, SGE_TASK_ID, JOB_COMPLETION_INDEX and AWS_BATCH_JOB_ARRAY_INDEX
= 2
$ for shard in 0/3 4/3 1/0 3 a/b 1/2000000 auto/0 auto/; do kiln render scenes/tiny.yaml -o h.mp4 --shard $shard; done 2>&1 | cut -c 1-60
1|kiln: render: --shard: found '0/3', expected I/N, such as 1/
1|kiln: render: --shard: found '4/3', expected I/N, such as 1/
1|kiln: render: --shard: found '1/0', expected I/N, such as 1/
1|kiln: render: --shard: found '3', expected I/N, such as 1/4,
1|kiln: render: --shard: found 'a/b', expected I/N, such as 1/
1|kiln: render: --shard: found '1/2000000', expected I/N, such
1|kiln: render: --shard: found 'auto/0', expected I/N, such as
1|kiln: render: --shard: found 'auto/', expected I/N, such as 
$ kiln render scenes/tiny.yaml -o none --shard 1/2
2|kiln: render: --shard: '--output none' writes nothing to share
= 2
$ kiln render scenes/tiny.yaml -o x.mp4 --manifest x.json --shard 1/2
2|kiln: render: --manifest: not allowed with --shard; 'kiln join --manifest' writes the manifest of all shards
= 2
$ kiln join nothing.mp4
2|kiln: nothing.mp4: the output has no journal: no job with --resume or --shard has begun it
= 6

A player that jumps to the start of a part shows the frame that it shows there when it plays on.

$ sums() { ffmpeg -nostdin -loglevel error "$@" -f framemd5 - | awk -F ', *' '!/^#/ {print $6}'; }
> for suffix in mp4 webm mkv mov; do
>     kiln render scenes/tiny.yaml -q --fps 10 --set output.frames=61 -o seek.$suffix
>     for part in 0 1 2 3; do sums -ss $((2 * part)) -i seek.$suffix -frames:v 1; done >jumped
>     sums -i seek.$suffix | sed -n '1p;21p;41p;61p' | cmp - jumped && sort -u jumped | wc -l
> done
1|4
1|4
1|4
1|4

A name that leaves no room for the journal's is an error of the command line.

$ kiln render scenes/tiny.yaml -q -o "$(printf 'a%.0s' {1..240}).png" --shard 1/2 2>&1 | sed 's/a\{20,\}/aaa/g'; echo "${PIPESTATUS[0]}"
1|kiln: aaa...: with ".1-of-2.journal" for the journal, the name has 259 bytes; allowed are 255
1|2
