A clip of images has the bytes of one that was drawn at once: images say of which scene, seed and frame they
are, and their rate.

$ one() { suffix=$1; shift; kiln render scenes/tiny.yaml --quiet "$@" -o $suffix/f_%03d.png && kiln render scenes/tiny.yaml --quiet "$@" -o one.$suffix 2>/dev/null && kiln encode $suffix -o two.$suffix --quiet 2>/dev/null && cmp one.$suffix two.$suffix && echo $suffix; }
> one mp4; one mkv; one webp; one webm --set backdrop.transparent=true; one apng --png-bits 16; one gif --png-bits 16 2>&1; one mov --png-bits 16 --set backdrop.transparent=true
1|mp4
1|mkv
1|webp
1|webm
1|apng
1|gif
1|mov
$ kiln render scenes/tiny.yaml --quiet --frames 5-20 --fps 30000/1001 --set simulation.rate=60000/1001 -o chunk.mp4 --quality 30
$ kiln render scenes/tiny.yaml --quiet --frames 5-20 --fps 30000/1001 --set simulation.rate=60000/1001 -o chunk/%d.png
$ kiln encode chunk/%d.png -o again.mp4 --quality 30 && cmp chunk.mp4 again.mp4
1|again.mp4: 16 frames, 5-20
$ ffprobe -v error -count_frames -of csv=p=0 -show_entries stream=nb_read_frames,r_frame_rate,color_space,color_transfer,color_primaries,color_range again.mp4
1|tv,bt709,iec61966-2-1,bt709,30000/1001,16

EXR images are light, so they need a tone map; floats of 32 bits give the same pixels as a scene's own.

$ kiln render scenes/tiny.yaml --quiet -o light/%02d.exr --exr-bits 32 && kiln encode light -o light.mp4 --tonemap agx --quiet && cmp light.mp4 one.mp4
$ kiln encode light -o dark.mp4 --tonemap agx --exposure -3 --quiet && cmp -s dark.mp4 one.mp4
= 1
$ kiln encode light -o none.mp4
2|kiln: light/00.exr: the image is linear light; choose by --tonemap (none, agx or aces) how it becomes colours
= 2
$ mkdir hdr && for i in 0 1; do (printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 2\n' && for y in {1..32}; do printf '\200\100\40\200'; done) >hdr/$i.hdr; done
$ kiln encode hdr -o hdr.apng --fps 10
2|kiln: hdr/0.hdr: the image is linear light; choose by --tonemap (none, agx or aces) how it becomes colours
= 2
$ kiln encode hdr -o hdr.apng --fps 10 --tonemap none --quiet && ffmpeg -nostdin -loglevel error -i hdr.apng -frames:v 1 -f rawvideo -pix_fmt rgb24 - | head -c 3 | od -An -tu1
1| 187 136  99
$ kiln encode mp4 -o none.mp4 --tonemap agx
2|kiln: --tonemap: not allowed; mp4/f_000.png has colours already, not linear light
= 2

Images of another depth, and of other programs, whose rate must be said.

$ kiln encode gif -o deep.mp4 --quiet
2|kiln: warning: gif/f_000.png: the images have 16 bits a channel, but deep.mp4 takes 8: the clip differs a little from one that is rendered at once
$ ffmpeg -nostdin -i deep.mp4 -i one.mp4 -lavfi psnr -f null - 2>&1 | grep -o 'min:[0-9.]*' | awk -F: '{print ($2 > 45)}'
1|1
$ mkdir foreign && ffmpeg -nostdin -loglevel error -f lavfi -i testsrc=size=32x16:rate=10 -frames:v 12 -bitexact foreign/%d.bmp
$ kiln encode foreign/%d.bmp -o none.mp4
2|kiln: foreign/1.bmp: the image does not say its rate; give the rate with --fps
= 2
$ kiln encode foreign/%d.bmp -o foreign.mp4 --fps 10
1|foreign.mp4: 12 frames, 1-12
$ ffprobe -v error -of csv=p=0 -show_entries format_tags=comment foreign.mp4
1|kiln:version=0.2.0 kiln:frames=1-12

Numbers in the names of a folder count as numbers, and a gap is told.

$ kiln encode chunk -o ordered.mp4
1|ordered.mp4: 16 frames, 5-20
$ rm foreign/4.bmp && kiln encode foreign -o gap.mp4 --fps 10
1|gap.mp4: 11 frames, 0-10
2|kiln: warning: foreign: 1 number is missing between 3.bmp and 5.bmp

Alpha that is opaque needs no format with alpha. A format that has alpha keeps that of any frame, also where the first
one has none.

$ mkdir solid && for i in 0 1 2 3; do ffmpeg -nostdin -loglevel error -f lavfi -i color=red:size=32x16,format=rgba -frames:v 1 -bitexact -update 1 solid/$i.png; done && kiln encode solid -o solid.mp4 --fps 10
1|solid.mp4: 4 frames, 0-3
$ ffmpeg -nostdin -loglevel error -y -f lavfi -i color=red:size=32x16,format=rgb24 -frames:v 1 -bitexact -update 1 solid/0.png
$ ffmpeg -nostdin -loglevel error -y -f lavfi -i color=red@0.5:size=32x16,format=rgba -frames:v 1 -bitexact -update 1 solid/2.png
$ kiln encode solid -o none.mp4 --fps 10
2|solid/2.png: the image is transparent in places, and none.mp4 has no alpha; expected .webm, .mkv, .mov, .apng or .webp
= 3
$ kiln encode solid -o solid.apng --fps 10 && kiln compare solid/%d.png solid.apng --quiet
1|solid.apng: 4 frames, 0-3

What is no clip, with the reason. Nothing is written then.

$ rm chunk/9.png && kiln encode chunk/%d.png -o none.mp4
2|chunk/10.png: found frame 10 where frame 9 must follow; a clip leaves out no frame, and takes the files of a folder in the order of their names
= 3
$ kiln render scenes/tiny.yaml --quiet --frames 9 --seed 77 --fps 30000/1001 --set simulation.rate=60000/1001 -o chunk/9.png && kiln encode chunk/%d.png -o none.mp4
2|chunk/9.png: the image belongs to another scene or seed than chunk/5.png
= 3
$ cp foreign/1.bmp mp4/f_003.png && kiln encode mp4 -o none.mp4
2|mp4/f_003.png: 32 x 16 pixels; mp4/f_000.png has 64 x 36
= 3
$ head -c 300 mkv/f_004.png >mp4/f_003.png && kiln encode mp4 -o none.mp4 2>&1 | sed 's/:.*//'
1|mp4/f_003.png
$ kiln encode one.mp4 -o none.mp4
2|kiln: one.mp4: is a video; expected images: a folder, or a pattern such as frame_%04d.png
= 2
$ kiln encode mkv -o none.png
2|kiln: none.png: PNG images are not a clip; expected .mp4, .webm, .mkv, .mov, .gif, .apng or .webp
= 2
$ kiln encode mkv
2|kiln: encode: needs --output FILE
= 2
$ kiln encode mkv -o none.mp4 --fps fast
2|kiln: encode: --fps: found 'fast', expected a rate such as 30, 29.97 or 30000/1001
= 2
$ kiln encode nowhere -o none.mp4
2|nowhere: No such file or directory
= 3
$ kiln encode mkv -o one.mp4
2|kiln: one.mp4: the file exists (--force replaces it)
= 2
$ kiln encode mkv -o none.mp4 --exposure 1
2|kiln: --exposure: not allowed; mkv/f_000.png has colours already, not linear light
= 2
$ kiln encode mkv -o none.mp4 --fps 0.5
2|kiln: --fps 0.5: expected a rate from 1 to 1000, such as 30, 29.97 or 30000/1001
= 2
$ kiln encode mkv -o one.mp4 --force
1|one.mp4: 24 frames, 0-23
$ find . -name '*none*'

Smoke may cover a whole frame of a clip with alpha: an EXR image says whether its alpha counts.

$ cat >cover.yaml <<END
> kiln: 1
> output: {size: [64, 36], fps: 10, frames: 12}
> backdrop: {transparent: true}
> systems:
>   smoke:
>     emit:
>       rate: {keys: {0 s: 0, 0.3 s: 0, 0.35 s: 3000}}
>       life: 3 s
>       from: {box: {origin: [0, 1, 2], size: [5, 4, 1], direction: [0, 1, 0]}}
>     look: {atlas: "builtin:smoke", blend: alpha, size: 3, opacity: 1}
> END
$ kiln render cover.yaml -q -o cover.webm && kiln render cover.yaml -q -o cover/%02d.exr --exr-bits 32
$ kiln encode cover -o again.webm --tonemap agx && cmp cover.webm again.webm
1|again.webm: 12 frames, 0-11

Of a job that was not done, a warning says what is not there.

$ kiln render scenes/tiny.yaml -q -o half/%02d.png --resume && rm half/2?.png && kiln encode half -o half.mp4
1|half.mp4: 20 frames, 0-19
2|kiln: warning: half: the job has frames 0-23, but only 0-19 are here
$ kiln encode half/%02d.png -q -o half.mkv
2|kiln: warning: half/%02d.png: the job has frames 0-23, but only 0-19 are here
