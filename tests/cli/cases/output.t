What stands in the way of writing is said before the work, and leaves nothing behind.

$ kiln render scenes/tiny.yaml -q --frames 0 -o a.png
$ kiln render scenes/tiny.yaml -q --frames 0 -o a.png
2|kiln: a.png: the file exists (--force replaces it)
= 2
$ kiln render scenes/tiny.yaml -q --frames 0 -o a.png --force
$ kiln render scenes/tiny.yaml -q -o a.gfi
2|kiln: a.gfi: unknown output format '.gfi' (did you mean '.gif'?); allowed are .png, .jpg, .exr, .mp4, .webm, .mkv, .mov, .gif, .apng, .webp
= 2
$ kiln render scenes/tiny.yaml -q -o nosuffix
2|kiln: nosuffix: the output needs a file name with a suffix that names its format: .png, .jpg, .exr, .mp4, .webm, .mkv, .mov, .gif, .apng, .webp
= 2
$ kiln render scenes/tiny.yaml -q --frames 0 -o a.png/b.png
2|kiln: a.png: the path is not a folder, but a.png/b.png needs a folder here
= 2
$ kiln render scenes/tiny.yaml -q -o odd.mp4 --size 63x36
2|kiln: odd.mp4: the video would have 63 x 36 pixels; H.264 needs even sizes, the nearest is 64x36
= 2
$ kiln render scenes/tiny.yaml -q -o gap.mp4 --frames 0-3,8
2|kiln: gap.mp4: a clip cannot leave out frames, but frames 4-7 would be missing; write images, or one range
= 2
$ kiln render scenes/tiny.yaml -q -o frame_%s.png
2|kiln: frame_%s.png: '%s.' in the file name is not allowed; write %d, %04d or #### for the number of the frame, %% for a percent sign, and %# for a hash
= 2
$ kiln render scenes/tiny.yaml -q -o frame_%d_%d.png
2|kiln: frame_%d_%d.png: the file name has two frame numbers
= 2
$ kiln render scenes/tiny.yaml -q --frames 0 -o /dev/null/x.png
2|kiln: /dev/null: the path is not a folder, but /dev/null/x.png needs a folder here
= 2
$ kiln render scenes/tiny.yaml -q --frames 0 -o /sys/x.png
2|kiln: /sys/x.png: the file cannot be created: Permission denied
= 6
$ kiln render scenes/tiny.yaml -q --frames 0 -o b.png --manifest /dev/null/x.json
2|kiln: /dev/null: the path is not a folder, but /dev/null/x.json needs a folder here
= 2
$ mkfifo pipe.png && kiln render scenes/tiny.yaml -q --frames 0 -o pipe.png --force
2|kiln: pipe.png: a device, pipe or socket has this name
= 2
$ kiln render scenes/tiny.yaml -q --frames 0 -o b.png --manifest b.png --force
2|kiln: b.png: --output and --manifest would both write this file
= 2
$ kiln render scenes/tiny.yaml -q --frames 0 -o huge.png --size 16384x16384 --technique backdrop=gl
2|kiln: scene, 16384 x 16384 pixels: GL: the device is out of memory (0x0505)
= 5
$ find . -type f | sort | grep -v scenes/
1|./a.png

Clips: what a format cannot hold is refused before the work, what it bends is said.

$ for suffix in webm mkv mov apng webp; do kiln render scenes/tiny.yaml -q --frames 0-5 -o clips/a.$suffix --size 33x17 || exit; done; ls -A clips
1|a.apng
1|a.mkv
1|a.mov
1|a.webm
1|a.webp
$ kiln render scenes/tiny.yaml -q --frames 0-5 -o clips/frame_%d.png --size 33x17
$ for suffix in mkv apng; do kiln compare clips/frame_%d.png clips/a.$suffix | grep -E "differing.count|^ *all"; done
1|  differing.count             0            0  frame_0.png                   -
1|  differing.count             0            0  frame_0.png                   -
$ kiln render scenes/tiny.yaml -q -o clips/a.gif
2|kiln: warning: clips/a.gif: GIF counts times in 1/100 s; at 30 frames a second, frames last 0.03 or 0.04 s, on average 0.0333 s
$ ffprobe -v error -show_entries stream=nb_read_frames,duration -count_frames -of csv=p=0 clips/a.gif
1|0.800000,24
$ kiln render scenes/tiny.yaml -q -o clips/b.gif --fps 60
2|kiln: warning: clips/b.gif: GIF plays at most 50 frames a second; of the 60 frames a second, 1 in 2 is written; frames last 0.03 or 0.04 s, on average 0.0333 s
$ kiln render scenes/tiny.yaml -q -o clips/c.gif --fps 20
$ kiln render scenes/tiny.yaml -q -o clear.gif --set backdrop.transparent=true
2|kiln: clear.gif: the backdrop is transparent, but a GIF animation has no alpha; write images, a .webm or a .mov, or make the backdrop opaque
= 2
$ kiln render scenes/tiny.yaml -q -o clear.mp4 --set backdrop.transparent=true
2|kiln: clear.mp4: the backdrop is transparent, but an MP4 video has no alpha; write images, a .webm or a .mov, or make the backdrop opaque
= 2
$ kiln render scenes/tiny.yaml -q -o gap.webm --frames 0-3,8
2|kiln: gap.webm: a clip cannot leave out frames, but frames 4-7 would be missing; write images, or one range
= 2
$ kiln render scenes/tiny.yaml -q -o clip_%d.mov
2|kiln: clip_%d.mov: a video or flipbook is one file, so its name cannot have a frame number
= 2
$ kiln render scenes/tiny.yaml -q -o clips/a.gif
2|kiln: clips/a.gif: the file exists (--force replaces it)
= 2
$ kiln render scenes/tiny.yaml -q -o a.webn
2|kiln: a.webn: unknown output format '.webn' (did you mean '.webm'?); allowed are .png, .jpg, .exr, .mp4, .webm, .mkv, .mov, .gif, .apng, .webp
= 2

Flipbooks.

$ kiln render scenes/tiny.yaml -o book.png --flipbook 3x4 --flipbook-motion --flipbook-padding 2 --frames 0-11 --set backdrop.transparent=true --progress none
1|device: <device>
1|book.png and 2 more: 12 frames in <s> s
$ grep -v scene_hash book.json
1|{
1|  "kiln_flipbook": 2,
1|  "image": "book.png",
1|  "size": {"width": 204, "height": 160},
1|  "columns": 3,
1|  "rows": 4,
1|  "cells": 12,
1|  "order": "rows from the top, each from the left",
1|  "cell": {"width": 68, "height": 40, "padding": 2, "fade": 3},
1|  "alpha": "straight",
1|  "color_space": "srgb",
1|  "frames": [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11],
1|  "frame_rate": [30, 1],
1|  "cells_per_second": 30,
1|  "motion": {
1|    "image": "book_motion.png",
1|    "cell": {"width": 68, "height": 40},
1|    "encoding": "(channel - 128) / 127 * scale",
1|    "scale": 0.014705882,
1|    "unit": "cell",
1|    "red": "right",
1|    "green": "up",
1|    "from": "this cell",
1|    "to": "the next cell",
1|    "color_space": "linear"
1|  },
1|}
$ ls -A | grep book
1|book.json
1|book.png
1|book_motion.png
$ kiln render scenes/tiny.yaml -q -o whole/ --flipbook 4x2 --flipbook-alpha premultiplied && ls whole && grep -E 'frames|alpha' whole/tiny.json
1|tiny.json
1|tiny.png
1|  "alpha": "none",
1|  "frames": [0, 3, 6, 9, 12, 15, 18, 21],
2|kiln: warning: whole/tiny.png: the backdrop is opaque, so the flipbook has no alpha (backdrop.transparent: true)
$ kiln render scenes/tiny.yaml -q -o uneven.png --flipbook 4x4 --set backdrop.transparent=true
2|kiln: warning: uneven.png: the cells are 1 to 2 frames apart, so motion will not be even; choose a multiple of 16 frames
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 5x5
2|kiln: render: --flipbook: 'scenes/tiny.yaml': the 5 x 5 cells of a flipbook need more than the 24 frames that there are; at least 25 are needed: take fewer cells, or a higher rate
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 2x2 --frames 3-5
2|kiln: render: --flipbook: 'scenes/tiny.yaml': the 2 x 2 cells of a flipbook need more than the 3 frames that there are; at least 4 are needed: take fewer cells, or a higher rate
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 0x4
2|kiln: render: --flipbook: found '0x4', expected COLUMNSxROWS, such as 8x8, with at most 64 of each
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 65x4
2|kiln: render: --flipbook: found '65x4', expected COLUMNSxROWS, such as 8x8, with at most 64 of each
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook eight
2|kiln: render: --flipbook: found 'eight', expected COLUMNSxROWS, such as 8x8, with at most 64 of each
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook-motion
2|kiln: render: --flipbook-motion: needs --flipbook
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 2x2 --flipbook-green down
2|kiln: render: --flipbook-green: needs --flipbook-motion
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 2x2 --flipbook-motion --flipbook-green left
2|kiln: render: --flipbook-green: found 'left', expected one of up|down
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 2x2 --flipbook-alpha none
2|kiln: render: --flipbook-alpha: found 'none', expected one of straight|premultiplied
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 2x2 --flipbook-padding 300
2|kiln: render: --flipbook-padding: found '300', expected a whole number from 0 to 256
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 2x2 --flipbook-fade 51
2|kiln: render: --flipbook-fade: found '51', expected a whole number from 0 to 50
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook-fade 5
2|kiln: render: --flipbook-fade: needs --flipbook
= 2
$ kiln render scenes/tiny.yaml -q -o more.exr --flipbook 2x2
2|kiln: more.exr: a flipbook is one .png file, not .exr
= 2
$ kiln render scenes/tiny.yaml -q -o more_%d.png --flipbook 2x2
2|kiln: more_%d.png: a video or flipbook is one file, so its name cannot have a frame number
= 2
$ kiln render scenes/tiny.yaml -q -o more.png --flipbook 4x4 --size 8192x64
2|kiln: more.png: the flipbook would have 32768 x 256 pixels; allowed are 16384 a side: make the frames smaller (8192 x 64) or the cells fewer
= 2
$ kiln render scenes/tiny.yaml -q -o book.png --flipbook 3x4
2|kiln: book.png: the file exists (--force replaces it)
= 2
$ touch sole.json && kiln render scenes/tiny.yaml -q -o sole.png --flipbook 2x2 --frames 0-3
2|kiln: sole.json: the file exists (--force replaces it)
= 2
$ ls -A | grep -E 'more|sole'
1|sole.json

A full disk: the shell lets no file grow beyond a few kilobytes.

$ mkdir full && ulimit -f 2 && kiln render scenes/tiny.yaml -q -o full/a.mp4 --size 256x144; code=$?; find full -type f; exit $code
2|kiln: full/a.mp4: the file cannot be written: File too large
= 6
$ ulimit -f 2 && for suffix in webm gif mkv mov apng webp; do kiln render scenes/tiny.yaml -q -o full/a.$suffix --size 256x144 $(case $suffix in we*|mov) echo --quality 100;; esac) 2>&1 | grep -v warning; done; kiln render scenes/tiny.yaml -q -o full/a.png --flipbook 2x2 --frames 0-3; find full -type f
1|kiln: full/a.webm: the file cannot be written: File too large
1|kiln: full/a.gif: the file cannot be written: File too large
1|kiln: full/a.mkv: the file cannot be written: File too large
1|kiln: full/a.mov: the file cannot be written: File too large
1|kiln: full/a.apng: the file cannot be written: File too large
1|kiln: full/a.webp: the file cannot be written: File too large
2|kiln: warning: full/a.png: the backdrop is opaque, so the flipbook has no alpha (backdrop.transparent: true)
2|kiln: full/a.png: the file cannot be written: File too large
$ ulimit -f 2 && kiln render scenes/tiny.yaml -q -o full/a_%d.png --frames 0-3 --size 256x144; code=$?; find full -type f; exit $code
2|kiln: full/a_0.png: the file cannot be written: File too large
= 6

Standard output that cannot be written.

$ kiln check scenes/tiny.yaml >/dev/full
2|kiln: standard output: No space left on device
= 6
$ kiln help render >/dev/full
2|kiln: standard output: No space left on device
= 6
$ kiln devices >/dev/full
2|kiln: standard output: No space left on device
= 6
$ kiln --version >/dev/full
2|kiln: standard output: No space left on device
= 6
$ kiln check scenes/tiny.yaml >&-
2|kiln: standard output: Bad file descriptor
= 6
$ kiln render scenes/tiny.yaml -o none --frames 0 --progress none >/dev/full
2|kiln: standard output: No space left on device
= 6
$ kiln render scenes/tiny.yaml -o closed.png --frames 0 --progress none >&-; code=$?; ls closed.png; exit $code
1|closed.png
2|kiln: standard output: Bad file descriptor
= 6
$ kiln help scene | head -n 0; echo ${PIPESTATUS[0]}
1|9
$ kiln render scenes/tiny.yaml -o none --json | head -n 2 | wc -l; echo ${PIPESTATUS[0]}
1|2
1|9
2|kiln: standard output: the reader went away: stopped
