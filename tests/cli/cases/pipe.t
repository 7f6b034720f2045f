Frames go to another program by standard output, and nothing else does.

$ kiln render scenes/tiny.yaml -o f_%02d.png --quiet && kiln render scenes/tiny.yaml -o clip.mp4 --quality 100 --quiet
$ kiln render scenes/tiny.yaml -o - --pipe rgb24 --device cpu --progress none >rgb24
2|device: <device>
2|standard output: 24 frames in <s> s
$ ffmpeg -nostdin -loglevel error -i f_%02d.png -f rawvideo -pix_fmt rgb24 - | cmp - rgb24
$ kiln render scenes/tiny.yaml -o - --pipe rgba --quiet | cmp - <(ffmpeg -nostdin -loglevel error -i f_%02d.png -f rawvideo -pix_fmt rgba -)
$ kiln render scenes/tiny.yaml -o - --pipe rgba --quiet --frames 3-5 --set backdrop.transparent=true >rgba
$ kiln render scenes/tiny.yaml -o a_%02d.png --quiet --frames 3-5 --set backdrop.transparent=true
$ ffmpeg -nostdin -loglevel error -start_number 3 -i a_%02d.png -f rawvideo -pix_fmt rgba - | cmp - rgba

Floats are those of an EXR, pixel by pixel instead of plane by plane.

$ kiln render scenes/tiny.yaml -o - --pipe rgbaf32 --quiet --frames 7 --set backdrop.transparent=true | od -An -v -tx4 -w16 | awk '{print $2, $3, $1, $4}' >floats
$ kiln render scenes/tiny.yaml -o e.exr --exr-bits 32 --quiet --frames 7 --set backdrop.transparent=true
$ ffmpeg -nostdin -loglevel error -i e.exr -f rawvideo -pix_fmt gbrapf32le planes
$ plane() { tail -c +$(($1 * 64 * 36 * 4 + 1)) planes | head -c $((64 * 36 * 4)) | od -An -v -tx4 -w4 | tr -d ' '; }
> paste -d ' ' <(plane 0) <(plane 1) <(plane 2) <(plane 3) | cmp - floats && sort -u floats | wc -l | awk '{print ($1 > 100)}'
1|1

Y4M has the luma and chroma of an MP4 before that loses some: they differ by less than 1 of 255 (48 dB).

$ kiln render scenes/tiny.yaml -o - --quiet >clip.y4m; head -n 1 clip.y4m
1|YUV4MPEG2 W64 H36 F30:1 Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 XCOLORRANGE=LIMITED
$ ffmpeg -nostdin -i clip.y4m -i clip.mp4 -lavfi psnr -f null - 2>&1 | grep -o 'min:[0-9.]*' | awk -F: '{print ($2 > 48)}'
1|1
$ ffprobe -v error -count_frames -of csv=p=0 -show_entries stream=width,height,pix_fmt,color_range,chroma_location,r_frame_rate,nb_read_frames clip.y4m
1|64,36,yuv420p,tv,left,30/1,24
$ kiln render scenes/tiny.yaml -o - --quiet --size 33x17 --frames 0-1 | ffprobe -v error -count_frames -of csv=p=0 -show_entries stream=width,height,nb_read_frames -f yuv4mpegpipe -
1|33,17,2

What is printed otherwise goes to standard error. A manifest names no files.

$ kiln render scenes/tiny.yaml -o - --device cpu --json --frames 0-1 --manifest m.json 2>said | wc -c
1|7002
$ jq -r .event said
1|device
1|frame
1|frame
1|result
$ jq -c '.result.frames[].file' m.json
1|null
1|null

A reader that goes away, and a device that takes no more.

$ kiln render scenes/tiny.yaml --set output.frames=100000 -o - --quiet | head -c 7000 | wc -c; echo ${PIPESTATUS[0]}
1|7000
1|9
2|kiln: standard output: the reader went away after <n> frames
$ kiln render scenes/tiny.yaml -o - --quiet >/dev/full
2|kiln: standard output: cannot be written: No space left on device
= 6
$ kiln render scenes/tiny.yaml -o - --quiet >&-
2|kiln: standard output: cannot be written: Bad file descriptor
= 6

What cannot be.

$ kiln render scenes/tiny.yaml -o x.png --pipe rgba
2|kiln: render: --pipe: needs '--output -'
= 2
$ kiln render scenes/tiny.yaml -o - --resume >none
2|kiln: render: --resume: not allowed with '--output -'
= 2
$ kiln render scenes/tiny.yaml -o - --shard 1/2 >none
2|kiln: render: --shard: not allowed with '--output -'
= 2
$ kiln render scenes/tiny.yaml -o - --flipbook 2x2 >none
2|kiln: render: --flipbook: not allowed with '--output -'
= 2
$ kiln render scenes/tiny.yaml scenes/tiny.yaml -o - >none
2|kiln: render: --output: 'scenes/tiny.yaml' and 'scenes/tiny.yaml' would both write '-'; name a folder, or put {scene} into the name
= 2
$ kiln render scenes/tiny.yaml -o - --quiet --set backdrop.transparent=true >none
2|kiln: standard output: the backdrop is transparent, but y4m has no alpha; write rgba or rgbaf32, or make the backdrop opaque
= 2
$ kiln render scenes/tiny.yaml -o - --quiet --frames 0-1,4 >none
2|kiln: standard output: a clip cannot leave out frames, but frames 2-3 would be missing; write images, or one range
= 2
$ script -qec 'kiln render scenes/tiny.yaml -o -' /dev/null | tr -d '\r'; exit ${PIPESTATUS[0]}
1|kiln: render: --output -: standard output is a terminal, not a pipe
= 2
$ wc -c <none
1|0

A frame that waits for its reader is not one that takes long.

$ kiln render scenes/tiny.yaml -q -o - --frame-timeout 2 --set 'output.size=[640, 360]' | { sleep 2.5; wc -c; }
1|8294624
