Which frames --frames means: numbers, ranges, ranges to the end and from the start, steps.

$ for frames in 7 20- -2 last 20-last 0-20/10 0-/7 -9/4 9,0-4/2,3-4,last; do rm -f f_*; kiln render scenes/tiny.yaml -qo f_%d.png --frames $frames; echo "$frames: $(ls -v f_*.png | tr -dc '0-9\n' | xargs)"; done
1|7: 7
1|20-: 20 21 22 23
1|-2: 0 1 2
1|last: 23
1|20-last: 20 21 22 23
1|0-20/10: 0 10 20
1|0-/7: 0 7 14 21
1|-9/4: 0 4 8
1|9,0-4/2,3-4,last: 0 2 3 4 9 23

They are the frames of the full run.

$ kiln render scenes/tiny.yaml -qo all_%d.png && kiln render scenes/tiny.yaml -qo some_%d.png --frames 2-/7 && cmp all_2.png some_2.png && cmp all_23.png some_23.png

Each piece is checked, and named.

$ for frames in last-3 last/2 5/2 0-9/0 0-9/ 0-9/2/2 - / -/2 0-5-6 lastly ' 3' 0-3,x-2,5 1,-,2; do kiln render scenes/tiny.yaml -o none --frames "$frames"; done
2|kiln: render: --frames: found 'last-3', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found 'last/2', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found '5/2', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found '0-9/0', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found '0-9/', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found '0-9/2/2', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found '-', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found '/', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found '-/2', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found '0-5-6', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found 'lastly', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found ' 3', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found 'x-2' in '0-3,x-2,5', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
2|kiln: render: --frames: found '-' in '1,-,2', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
= 2
$ for frames in 24- 0-24/8 -24 3-,30; do kiln render scenes/tiny.yaml -o none --frames "$frames"; done
2|kiln: render: --frames: found frame 24, but 'scenes/tiny.yaml' has frames 0-23
2|kiln: render: --frames: found frame 24, but 'scenes/tiny.yaml' has frames 0-23
2|kiln: render: --frames: found frame 24, but 'scenes/tiny.yaml' has frames 0-23
2|kiln: render: --frames: found frame 30, but 'scenes/tiny.yaml' has frames 0-23
= 2

A step is a list of frames: images go on and divide, a flipbook shows them; a video has no gaps.

$ kiln render scenes/tiny.yaml -qo r_%d.png --frames 0-20/10 --resume && rm r_10.png && kiln render scenes/tiny.yaml -o r_%d.png --frames 0-20/10 --resume --progress none
1|device: <device>
1|r_0.png and 2 more: 1 frame in <s> s, 2 kept
$ kiln render scenes/tiny.yaml -qo s_%d.png --frames 0-/2 --fps 1 --set simulation.rate=4 --shard 1/2 && kiln render scenes/tiny.yaml -qo s_%d.png --frames 0-/2 --fps 1 --set simulation.rate=4 --shard 2/2 && kiln join s_%d.png
1|s_%d.png: 12 frames in 6 parts, whole already
$ kiln render scenes/tiny.yaml -qo book.png --flipbook 2x1 --frames 0-20/10 2>/dev/null && grep -A 3 '"frames"' book.json
1|  "frames": [0, 10],
1|  "frame_rate": [30, 1],
1|  "cells_per_second": 3,
1|  "motion": null,
$ for output in v.mp4 '- --pipe rgb24' 'v.mp4 --resume' 'v.mp4 --shard 1/2'; do kiln render scenes/tiny.yaml -qo $output --frames 0-20/10; done
2|kiln: v.mp4: a clip cannot leave out frames, but frames 1-9 would be missing; write images, or one range
2|kiln: standard output: a clip cannot leave out frames, but frames 1-9 would be missing; write images, or one range
2|kiln: v.mp4: a clip cannot leave out frames, but frames 1-9 would be missing; write images, or one range
2|kiln: v.mp4: a clip cannot leave out frames, but frames 1-9 would be missing; write images, or one range
= 2
$ kiln render scenes/tiny.yaml -qo v.mp4 --frames 20- && kiln render scenes/tiny.yaml -qo w.mp4 --frames 20-23 && cmp v.mp4 w.mp4
$ kiln render scenes/tiny.yaml -qo v.mkv --frames 22-,0-/1 --resume && ls v.*
1|v.mkv
1|v.mkv.journal
1|v.mp4

Figures take them, too; of a clip, the last frame is not known before it is read.

$ kiln figure sheet scenes/tiny.yaml -o sheet.png --frames 0-/10,last && ls sheet.png
1|sheet.png
$ kiln figure strip all_%d.png -o strip.png --frames 0-20/10 && ls strip.png
1|strip.png
$ kiln figure strip all_%d.png -o strip2.png --frames 3-
2|kiln: figure strip: --frames: 'all_%d.png' is a clip, whose last frame must be given by its number
= 2
$ sed 's/frames: 24/frames: 30/' scenes/tiny.yaml > scenes/longer.yaml; kiln figure sheet scenes/tiny.yaml scenes/longer.yaml -o both.png --frames last
2|kiln: figure sheet: --frames: 'scenes/tiny.yaml' and 'scenes/longer.yaml' have different last frames; give the number of the frame
= 2
