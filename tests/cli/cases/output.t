What stands in the way of writing is said before the work, and leaves nothing behind.

$ kiln render scenes/tiny.yaml -q --frames 0 -o a.png
$ kiln render scenes/tiny.yaml -q --frames 0 -o a.png
2|kiln: a.png: the file exists (--force replaces it)
= 6
$ kiln render scenes/tiny.yaml -q --frames 0 -o a.png --force
$ kiln render scenes/tiny.yaml -q -o a.gfi
2|kiln: a.gfi: unknown output format '.gfi'; allowed are .png, .exr, .mp4
= 2
$ kiln render scenes/tiny.yaml -q -o nosuffix
2|kiln: nosuffix: the output needs a file name with a suffix that tells its format: .png, .exr, .mp4
= 2
$ kiln render scenes/tiny.yaml -q --frames 0 -o a.png/b.png
2|kiln: a.png: not a folder, but a.png/b.png needs one here
= 6
$ kiln render scenes/tiny.yaml -q -o odd.mp4 --size 63x36
2|kiln: odd.mp4: a video of 63 x 36 pixels; H.264 needs even sizes, the nearest is 64x36
= 2
$ kiln render scenes/tiny.yaml -q -o gap.mp4 --frames 0-3,8
2|kiln: gap.mp4: a video cannot leave out frames, but none lies between 3 and 8; write images, or one range
= 2
$ kiln render scenes/tiny.yaml -q -o frame_%s.png
2|kiln: frame_%s.png: '%s.' in the file name; after a percent sign only d, a width and d (%04d), a # or a second percent sign may follow
= 2
$ kiln render scenes/tiny.yaml -q -o frame_%d_%d.png
2|kiln: frame_%d_%d.png: the file name has two frame numbers
= 2
$ kiln render scenes/tiny.yaml -q --frames 0 -o /dev/null/x.png
2|kiln: /dev/null: not a folder, but /dev/null/x.png needs one here
= 6
$ kiln render scenes/tiny.yaml -q --frames 0 -o /sys/x.png
2|kiln: /sys/x.png: the file cannot be created: Permission denied
= 6
$ kiln render scenes/tiny.yaml -q --frames 0 -o b.png --manifest /dev/null/x.json
2|kiln: /dev/null: not a folder, but /dev/null/x.json needs one here
= 6
$ mkfifo pipe.png && kiln render scenes/tiny.yaml -q --frames 0 -o pipe.png --force
2|kiln: pipe.png: a device, pipe or socket has this name
= 6
$ kiln render scenes/tiny.yaml -q --frames 0 -o b.png --manifest b.png --force
2|kiln: render: --output and --manifest would both write 'b.png'
= 2
$ kiln render scenes/tiny.yaml -q --frames 0 -o huge.png --size 16384x16384 --device software
2|kiln: particles, 16384 x 16384 pixels: GL: the device is out of memory (0x0505)
= 5
$ find . -type f | sort | grep -v scenes/
1|./a.png

A full disk: the shell lets no file grow beyond a few kilobytes.

$ mkdir full && ulimit -f 2 && kiln render scenes/tiny.yaml -q -o full/a.mp4 --size 256x144; code=$?; find full -type f; exit $code
2|kiln: full/a.mp4: the file cannot be written: File too large
= 6
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
1|6
$ kiln render scenes/tiny.yaml -o none --progress ndjson | head -n 2 | wc -l; echo ${PIPESTATUS[0]}
1|2
1|6
