What a run says.

$ kiln render scenes/tiny.yaml -o tiny.png --frames 3 --progress none
1|device: <device>
1|tiny.png: 1 frame in <s> s
$ kiln render scenes/tiny.yaml -o all_%d.png --frames 0-3 --progress none
1|device: <device>
1|all_0.png and 3 more: 4 frames in <s> s
$ ls
1|all_0.png
1|all_1.png
1|all_2.png
1|all_3.png
1|scenes
1|tiny.png
$ kiln render scenes/tiny.yaml -o quiet.png --frames 3 --quiet && cmp tiny.png quiet.png
$ kiln render scenes/tiny.yaml -o none --frames 3 --progress lines
1|device: <device>
1|scenes/tiny.yaml: nothing written: 1 frame in <s> s
$ kiln render scenes/tiny.yaml -o tiny.mp4 --frames 0-5 --progress none && ls tiny.mp4
1|device: <device>
1|tiny.mp4: 6 frames in <s> s
1|tiny.mp4
$ kiln render scenes/tiny.yaml -o tiny.exr --frames 3 --progress none && ls tiny.exr
1|device: <device>
1|tiny.exr: 1 frame in <s> s
1|tiny.exr

Options and operands in any order; the last use of an option counts, --set adds up.

$ kiln render -o b.png scenes/tiny.yaml --frames=3 --quiet && cmp tiny.png b.png
$ kiln render --frames 9 --frames 3 -q -oc.png -- scenes/tiny.yaml && cmp tiny.png c.png
$ kiln render scenes/tiny.yaml -q --frames 3 -o d.png --seed 9 --set seed=7 && cmp tiny.png d.png
$ kiln render scenes/tiny.yaml -q --frames 3 -o e.png --set seed=7 --seed 9 && cmp -s tiny.png e.png
= 1
$ kiln render scenes/tiny.yaml -q --frames 3 -o f.png --size 32x18 --fps 60 && od -An -j16 -N8 -tu4 --endian=big f.png
1|         32         18
$ kiln render scenes/tiny.yaml -q --frames 3 -o g.png --png-bits 16 && od -An -j24 -N1 -tu1 g.png
1|  16
$ kiln render scenes/tiny.yaml -q --frames 3 -o small.png --png-effort small && kiln compare tiny.png small.png | head -n 1; test $(stat -c %s small.png) -lt $(stat -c %s tiny.png)
1|small.png against tiny.png: same
$ for threads in 1 2 5; do kiln render scenes/tiny.yaml -q --frames 3 -o threads.png --size 640x360 --threads $threads --force; sha256sum <threads.png; done | uniq | wc -l
1|1
$ kiln render scenes/tiny.yaml -q --frames 3 -o i.png --fps 30/1 --size 64x36 && cmp tiny.png i.png
$ cd scenes && cp tiny.yaml ./--odd.yaml && kiln render -q --frames 3 -o ../h.png -- --odd.yaml && cmp ../tiny.png ../h.png

A rate of the command line changes the length of the clip, which is said.

$ kiln render scenes/tiny.yaml --frames 3 -o fast.png --fps 60 --progress none
1|device: <device>
1|scenes/tiny.yaml: 24 frames at 60 a second last 0.4 s
1|fast.png: 1 frame in <s> s
$ kiln render scenes/tiny.yaml --frames 3 -o slow.png --set output.fps=30000/1001 --set simulation.rate=60000/1001 --progress none
1|device: <device>
1|scenes/tiny.yaml: 24 frames at 29.97 a second last 0.8008 s
1|slow.png: 1 frame in <s> s
$ kiln render scenes/tiny.yaml --frames 3 -o long.png --fps 60 --set output.frames=48 --progress none
1|device: <device>
1|long.png: 1 frame in <s> s
$ kiln check scenes/tiny.yaml --fps 15 | tail -n 1
1|# scenes/tiny.yaml: 24 frames at 15 a second last 1.6 s

Options of the formats.

$ kiln render scenes/tiny.yaml -q --frames 3 -o float.exr --exr-bits 32 && [ $(stat -c %s float.exr) -gt $(stat -c %s tiny.exr) ]
$ kiln render scenes/tiny.yaml -q -o poor.mp4 --quality 0 && kiln render scenes/tiny.yaml -q -o rich.mp4 --quality 100
> [ $(stat -c %s poor.mp4) -lt $(stat -c %s rich.mp4) ]

A device by its number and by a part of its name is the same device.

$ number=$(kiln devices --json | jq '[.devices[] | select(.gl and .usable)][0].index')
> name=$(kiln devices --json | jq -r '[.devices[] | select(.gl and .usable)][0].name')
> kiln render scenes/tiny.yaml -o none --frames 0 --device $number --progress none >number
> kiln render scenes/tiny.yaml -o none --frames 0 --device "${name:1:6}" --progress none >name
> head -qn 1 number name | uniq | wc -l
1|1

Threads and techniques change nothing.

$ for threads in 1 2 8; do
>     kiln render scenes/tiny.yaml --frames 20 -o t$threads.png --threads $threads --stats | grep state
> done | uniq | wc -l
1|1
$ cmp t1.png t2.png && cmp t1.png t8.png
$ for technique in simulate=cpu simulate=inplace simulate=pingpong simulate=feedback simulate=texels; do
>     kiln render scenes/tiny.yaml --frames 20 -o none --technique $technique --stats | grep state
> done | uniq | wc -l
1|1
Two buffers count twice, textures once more; sorting takes 16 bytes a slot.
$ for technique in cpu inplace pingpong feedback texels; do
>     kiln render scenes/tiny.yaml --frames 20 -o none --technique simulate=$technique --stats | grep slots
> done
1|  particles    52 alive, 82 slots, 3280 bytes (40.0 a slot)
1|  particles    52 alive, 82 slots, 3280 bytes (40.0 a slot)
1|  particles    52 alive, 82 slots, 5904 bytes (72.0 a slot)
1|  particles    52 alive, 82 slots, 5904 bytes (72.0 a slot)
1|  particles    52 alive, 82 slots, 8528 bytes (104.0 a slot)
$ for sort in cpu radix bitonic; do
>     kiln render scenes/tiny.yaml --frames 20 -o $sort.png --technique simulate=inplace,sort=$sort
> done
1|device: <device>
1|cpu.png: 1 frame in <s> s
1|device: <device>
1|radix.png: 1 frame in <s> s
1|device: <device>
1|bitonic.png: 1 frame in <s> s
$ cmp cpu.png radix.png && cmp cpu.png bitonic.png
Of the frame at 0 s alone, the particles are counted that it shows, which its state does not have yet.
$ printf 'kiln: 1\noutput: {size: [32, 18], frames: 1}\nsystems: {a: {emit: {bursts: {0 s: 12}}}}\n' >one.yaml
$ for technique in cpu inplace; do
>     kiln render one.yaml -o none --technique simulate=$technique --stats | grep -E 'slots|state'
> done
1|  particles    12 alive, 12 slots, 480 bytes (40.0 a slot)
1|  state        0000000000000000
1|  particles    12 alive, 12 slots, 480 bytes (40.0 a slot)
1|  state        0000000000000000
$ kiln render one.yaml -o none --device cpu --json --stats | jq -c 'select(.event != "device") | [.event, .alive]'
1|["frame",12]
1|["result",12]
$ kiln render scenes/tiny.yaml --frames 20 -o none --technique simulate=cup
1|device: <device>
2|kiln: technique: simulate 'cup' is not known (did you mean 'cpu'?); allowed are cpu, inplace, pingpong, feedback, texels, auto
= 2
$ kiln render scenes/tiny.yaml --frames 20 -o none --technique simulat=cpu
1|device: <device>
2|kiln: technique: stage 'simulat' is not known (did you mean 'simulate'?); allowed are simulate, gas, sort, backdrop, march, raster, bloom, composite
= 2

Statistics and progress for people and for programs.

$ kiln render scenes/tiny.yaml -o none --frames 0-3 --stats=text --progress none --technique simulate=cpu,sort=cpu --technique raster=geometry
1|device: <device>
1|scenes/tiny.yaml: nothing written: 4 frames in <s> s
1|  pass                   ms   ms a frame   of total
1|  simulate <ms>
1|  sort <ms>
1|  lighting <ms>
1|  backdrop <ms>
1|  gas <ms>
1|  particles <ms>
1|  bloom <ms>
1|  composite <ms>
1|  readback <ms>
1|  output <ms>
1|  set-up <ms>
1|  total <ms>
1|  steps        18
1|  particles    36 alive, 82 slots, 3280 bytes (40.0 a slot)
1|  memory <MiB> at the peak
1|  techniques   simulate=cpu gas=cpu sort=cpu backdrop=cpu march=cpu raster=geometry bloom=cpu composite=cpu
1|  chosen       simulate=cpu: as asked for
1|               gas=cpu: vectors on the host are some 20 times as fast as GL on the same cores
1|               sort=cpu: as asked for
1|               backdrop=cpu: vectors on the host are several times as fast as GL on the same cores
1|               march=cpu: vectors on the host are several times as fast as GL on the same cores
1|               raster=geometry: as asked for
1|               bloom=cpu: vectors on the host are several times as fast as GL on the same cores
1|               composite=cpu: the host is faster than GL on the same cores
1|  scene        <hash>
1|  state        83c0efe7248147d7
$ kiln render scenes/tiny.yaml -o none --frames 0-1 --json --progress none | jq -r 'keys_unsorted | join(" ")'
1|event index name software
1|event scene frame done total elapsed_s eta_s alive state pass_ms
1|event scene frame done total elapsed_s eta_s alive state pass_ms
1|event scene output first_file frames kept total_s setup_s steps pass_ms alive particle_capacity particle_bytes peak_memory_bytes techniques chosen scene_hash state
$ kiln render scenes/tiny.yaml -o x_%d.png --frames 0,2 --json | jq -c '[.event, .frame, .done, .total]'
1|["device",null,null,null]
1|["frame",0,1,2]
1|["frame",2,2,2]
1|["result",null,null,null]
$ kiln render scenes/tiny.yaml -o none --frames 0-1 --progress tty 2>&1 >/dev/null | cat -v | sed -E 's/, [^\^]*/, .../g'
1|^Mscenes/tiny.yaml: 1 of 2 frames, ...^[[K^Mscenes/tiny.yaml: 2 of 2 frames, ...^[[K^M^[[K
$ kiln render scenes/tiny.yaml -o none --json | jq -r 'select(.frame == 23).state' >last_state
> kiln render scenes/tiny.yaml -o none --stats | sed -n 's/^  state *//p' | cmp - last_state

Several scenes share a device.

$ kiln render scenes/tiny.yaml scenes/empty.yaml -o x.mp4
2|kiln: render: --output: 'scenes/tiny.yaml' and 'scenes/empty.yaml' would both write 'x.mp4'; name a folder, or put {scene} into the name
= 2
$ kiln render scenes/tiny.yaml scenes/tiny.yaml -o scenes
2|kiln: render: --output: 'scenes/tiny.yaml' and 'scenes/tiny.yaml' would both write 'scenes/tiny.mp4'; name a folder, or put {scene} into the name
= 2
$ kiln render scenes/tiny.yaml scenes/empty.yaml -o '{scene}_s.png' --manifest x.json --frames 1
2|kiln: render: --manifest: 'scenes/tiny.yaml' and 'scenes/empty.yaml' would both write 'x.json'; name a folder, or put {scene} into the name
= 2
$ kiln render scenes/tiny.yaml scenes/empty.yaml -o '{scene}_s.png' --frames 1 --progress none
1|device: <device>
1|tiny_s.png: 1 frame in <s> s
1|empty_s.png: 1 frame in <s> s
$ mkdir folder && kiln render scenes/tiny.yaml scenes/empty.yaml -o folder --manifest folder --frames 0-1 --progress none && ls folder
1|device: <device>
1|folder/tiny.mp4: 2 frames in <s> s
1|folder/empty.mp4: 2 frames in <s> s
1|empty.json
1|empty.mp4
1|tiny.json
1|tiny.mp4
$ kiln render scenes/tiny.yaml scenes/empty.yaml -o new/ --frames 1 --progress none && ls new
1|device: <device>
1|new/tiny.mp4: 1 frame in <s> s
1|new/empty.mp4: 1 frame in <s> s
1|empty.mp4
1|tiny.mp4
$ for scene in tiny empty; do jq -r .result.frames[].frame folder/$scene.json; done
1|0
1|1
1|0
1|1

What means a frame's number in a pattern is only a letter in the name of a scene or folder.

$ mkdir '50%' && cp scenes/tiny.yaml 'scenes/100% #1.yaml'
$ kiln render 'scenes/100% #1.yaml' -o '50%' --frames 0-1 --progress none
1|device: <device>
1|50%/100% #1.mp4: 2 frames in <s> s
$ kiln render 'scenes/100% #1.yaml' -o '50%/{scene}/{scene}_#.png' --frames 0-1 --progress none
1|device: <device>
1|50%/100% #1/100% #1_0.png and 1 more: 2 frames in <s> s
$ kiln render scenes/tiny.yaml -o '50%/50%%%#.mp4' --frames 0-1 --progress none && ls '50%'
1|device: <device>
1|50%/50%#.mp4: 2 frames in <s> s
1|100% #1
1|100% #1.mp4
1|50%#.mp4

A path may be as long as the system allows, and is reported whole.

$ long=long/$(printf '%0200d/%0200d/%0200d/%0200d/%0200d/%0200d' 0 0 0 0 0 0)
> kiln render scenes/tiny.yaml -o $long/x.png --frames 0-1 --progress none --manifest long.json | sed -n 's/ and .*//p' | wc -c
> jq '.result.frames[].file | length' long.json
1|1222
1|1221
1|1221

Paths are those of the working directory, wherever that is.

$ mkdir -p a/b && cd a/b && kiln render ../../scenes/tiny.yaml -q --frames 3 -o ../here.png && cmp ../here.png ../../tiny.png

Nothing to see, and one frame.

$ kiln render scenes/empty.yaml -o empty_%d.png --stats --progress none | grep -E 'empty|particles'
1|empty_0.png and 1 more: 2 frames in <s> s
1|  particles <ms>
1|  particles    0 alive, 1 slots, 40 bytes (40.0 a slot)
$ kiln render scenes/tiny.yaml -o one.png --set output.frames=1 --progress none
1|device: <device>
1|one.png: 1 frame in <s> s

What programs read: on standard output in place of the text, or beside it in a file. Older spellings say so.

$ kiln render scenes/tiny.yaml -o j.png --frames 1 --progress none --json=new/j.json && jq -c '[.event, .frame, (.techniques | type)]' new/j.json
1|device: <device>
1|j.png: 1 frame in <s> s
1|["device",null,"null"]
1|["frame",1,"null"]
1|["result",null,"string"]
$ kiln render scenes/tiny.yaml -o j.png --frames 1 -q --json=new/j.json
2|kiln: new/j.json: the file exists (--force replaces it)
= 2
$ kiln render scenes/tiny.yaml -o j.png --frames 1 -q --json=bad.json; ls bad.json
2|kiln: j.png: the file exists (--force replaces it)
2|ls: cannot access 'bad.json': No such file or directory
= 2
$ kiln render scenes/tiny.yaml -o none --frames 1 --json --events ndjson | jq -r .message
1|null
1|render: --json and --events exclude each other; events of ndjson have all that --json has
1|null
2|kiln: render: --json and --events exclude each other; events of ndjson have all that --json has
$ kiln render scenes/tiny.yaml -o none --frames 1 --stats=json --progress ndjson | jq -r .event
1|device
1|frame
1|result
2|kiln: warning: render: --progress ndjson is an older spelling of --json, and version 0.3 will not know it
2|kiln: warning: render: --stats=json is an older spelling of --json, and version 0.3 will not know it
$ kiln devices --json=d.json | tail -n 1 | sed 's/:.*//' && kiln devices --json=d.json --force >text && jq -r '.devices[0].name' d.json
1|sandbox
1|cpu
$ kiln plan scenes/tiny.yaml --json=p.json | head -n 1 | sed 's/,.*//' && jq '.tasks | length' p.json
1|scenes/tiny.yaml: 1 part of 60 frames
1|1
$ kiln compare j.png j.png -q --json=c.json && kiln bake scenes/tiny.yaml -o st -q --json=b.json && jq -r .event c.json b.json
1|frame
1|result
1|state
1|result
