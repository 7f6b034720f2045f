Two pictures: the table, the verdict, the exit code.

$ picture() { ffmpeg -nostdin -loglevel error -y -f lavfi -i "$1" -frames:v 1 ${3-} "$2"; }
> declare -f picture >picture.sh
$ . ./picture.sh; picture color=c=0x808080:s=64x48,format=rgb24 grey.png
> picture color=c=0x888888:s=64x48,format=rgb24 lighter.png
> picture color=c=0x808080:s=48x64,format=rgb24 tall.png
> picture color=c=0x808080:s=64x48,format=rgba clear.png
> picture 'color=c=0x808080:s=64x48,format=rgb24,drawbox=x=20:y=10:w=5:h=5:color=white:t=fill' box.png
$ kiln compare grey.png grey.png
1|grey.png against grey.png: same
1|  metric                  value      limit
1|  flip.mean                   0       0.01  within
1|  flip.p50                    0          -
1|  flip.p99                    0        0.1  within
1|  flip.max                    0          -
1|  ssim                        1          -
1|  psnr                      inf          -
1|  abs.max                     0          -
1|  abs.mean                    0          -
1|  differing.count             0          -
1|  differing.share             0          -
1|  window.share                0        0.1  within
1|  not one value differs
$ kiln compare grey.png lighter.png
1|lighter.png against grey.png: different
1|  metric                  value      limit
1|  flip.mean             0.12758       0.01  beyond
1|  flip.p50              0.12758          -
1|  flip.p99              0.12758        0.1  beyond
1|  flip.max              0.12758          -
1|  ssim                  0.99816          -
1|  psnr                   30.069          -
1|  abs.max                     8          -
1|  abs.mean                    8          -
1|  differing.count          3072          -
1|  differing.share             1          -
1|  window.share                1        0.1  beyond
1|  largest difference at 0,0; densest window of 32x32 at 0,0: 1024 pixels
= 1
$ kiln compare grey.png box.png
1|box.png against grey.png: different
1|  metric                  value      limit
1|  flip.mean            0.017372       0.01  beyond
1|  flip.p50              0.69899          -
1|  flip.p99              0.94889        0.1  beyond
1|  flip.max              0.94889          -
1|  ssim                  0.95641          -
1|  psnr                    26.95          -
1|  abs.max                   127          -
1|  abs.mean               1.0335          -
1|  differing.count            25          -
1|  differing.share      0.008138          -
1|  window.share         0.024414        0.1  within
1|  largest difference at 20,10; densest window of 32x32 at 0,0: 25 pixels
= 1
$ kiln compare -q grey.png lighter.png
= 1

Limits are the caller's, all of them.

$ kiln compare -q grey.png lighter.png --tolerance abs.max=8 --tolerance psnr=30,flip.p99.9=0.2
$ kiln compare -q grey.png lighter.png --tolerance abs.max=7.9
= 1
$ kiln compare grey.png box.png --tolerance flip.p10=0.5 --window 5 --threshold 0 | grep -E 'p10|window'
1|  window.share                1          -
1|  flip.p10              0.17468        0.5  within
1|  largest difference at 20,10; densest window of 5x5 at 20,10: 25 pixels
$ kiln compare grey.png grey.png --tolerance flip.maen=0.1
2|kiln: limit 'flip.maen=0.1': unknown metric 'flip.maen' (did you mean 'flip.mean'?)
= 2
$ kiln compare grey.png grey.png --tolerance flip.mean=x
2|kiln: limit 'flip.mean=x': expected a number, 0 to 1
= 2
$ kiln compare grey.png grey.png --tolerance flip.mean
2|kiln: compare: --tolerance: found 'flip.mean', expected METRIC=VALUE
= 2
$ kiln compare grey.png grey.png --tolerance flip.p200=0.5
2|kiln: limit 'flip.p200=0.5': found the percentile '200'; allowed are 0 to 100, as in flip.p99.9
= 2
$ kiln help metrics
1|  flip.mean                FLIP: how different the pictures look when flipped; mean over all pixels, 0 to 1
1|  flip.p50                 median of FLIP, weighted by the errors
1|  flip.p99                 99th percentile of FLIP, weighted by the errors
1|  flip.pN                  any other percentile of FLIP, such as flip.p99.9
1|  flip.max                 FLIP of the worst pixel
1|  ssim                     structural similarity of luma (Wang 2004): 1 for equal pictures
1|  psnr             dB      peak signal to noise over all channels: infinite for equal pictures
1|  abs.max          levels  the largest difference of a channel, in 1/255 of sRGB's range
1|  abs.mean         levels  the mean difference over all channels
1|  differing.count  pixels  number of pixels that differ by more than --threshold levels
1|  differing.share          part of the picture that differs by more than --threshold levels, 0 to 1
1|  window.share             part of the densest --window that differs by more than --threshold levels; it finds small faults
1|
1|A limit is the worst value that passes: the least value of ssim and psnr, and the greatest value
1|of the other metrics. Without --tolerance it is flip.mean=0.01,flip.p99=0.1,window.share=0.1.

What does not match is no pass.

$ kiln compare grey.png tall.png
1|the sizes differ: the reference has 64 x 48 pixels, the test 48 x 64
1|tall.png against grey.png: different
= 1

Alpha that is opaque everywhere is none.

$ kiln compare grey.png clear.png
1|clear.png against grey.png: same
1|  metric                  value      limit
1|  flip.mean                   0       0.01  within
1|  flip.p50                    0          -
1|  flip.p99                    0        0.1  within
1|  flip.max                    0          -
1|  ssim                        1          -
1|  psnr                      inf          -
1|  abs.max                     0          -
1|  abs.mean                    0          -
1|  differing.count             0          -
1|  differing.share             0          -
1|  window.share                0        0.1  within
1|  not one value differs
1|  the test has alpha, which is opaque everywhere; the reference has none

$ kiln compare grey.png nowhere.png
2|nowhere.png: No such file or directory
= 3
$ printf 'version https://git-lfs.github.com/spec/v1\noid sha256:%064d\nsize 12345\n' 7 >pointer.png; kiln compare grey.png pointer.png
1|pointer.png against grey.png: unreadable
2|pointer.png: the image is a Git LFS pointer: run git lfs pull
= 3
$ : >empty.png
$ kiln compare grey.png empty.png
1|empty.png against grey.png: unreadable
2|empty.png: the image file is empty
= 3
$ head -c 100 grey.png >short.png
$ kiln compare short.png grey.png 2>&1 | grep -c 'short.png: the PNG image is broken or cut short'; echo ${PIPESTATUS[0]}
1|1
1|3
$ kiln compare grey.png
2|kiln: compare: needs REFERENCE TEST
= 2
$ kiln compare grey.png grey.png grey.png
2|kiln: compare: one operand too many, 'grey.png'
= 2
$ kiln compare grey.png . --range high
2|kiln: compare: --range: found 'high', expected one of auto|ldr|hdr
= 2

JSON: an object a line.

$ kiln compare grey.png lighter.png --json | jq -c '[.event, .verdict, .same, .beyond, .score > 10]'
1|["frame","different",null,["flip.mean","flip.p99","window.share"],true]
1|["result",null,false,null,false]
$ kiln compare grey.png grey.png --json | jq -c '.metrics.psnr'
1|null
1|{"worst":null,"mean":null,"at":"grey.png","unit":"dB","better":"higher","limit":null}
$ kiln compare grey.png lighter.png --json | jq -r 'select(.event == "result").metrics | keys[]'
1|abs.max
1|abs.mean
1|differing.count
1|differing.share
1|flip.max
1|flip.mean
1|flip.p50
1|flip.p99
1|psnr
1|ssim
1|window.share
$ kiln compare grey.png tall.png --json | jq -c '[.event, .verdict, .message, .same]'
1|["frame","different","the sizes differ: the reference has 64 x 48 pixels, the test 48 x 64",null]
1|["result",null,null,false]

Pictures of the difference: reference, test, error map.

$ kiln compare -q grey.png box.png --diff out/d.png
= 1
$ ffprobe -v error -show_entries stream=width,height -of csv=p=0 out/d.png
1|192,48
$ pixel() { ffmpeg -nostdin -loglevel error -i out/d.png -vf crop=1:1:$1:$2 -f rawvideo -pix_fmt rgb24 - | od -An -tu1; }
> pixel 22 12; pixel 86 12; pixel 128 47
1| 128 128 128
1| 255 255 255
1|   0   0   4
$ kiln compare -q grey.png box.png --diff out/d.png
2|kiln: out/d.png: the file exists (--force replaces it)
= 2
$ kiln compare -q grey.png box.png --diff out/d.png --force
= 1
$ kiln compare -q grey.png box.png --diff out/d.jpg
2|kiln: out/d.jpg: pictures of differences are PNG; the name must end in .png, or be a folder
= 2
$ kiln compare -q grey.png box.png --diff grey.png/d.png
2|kiln: grey.png: the path is not a folder, but grey.png/d.png needs a folder here
= 2

$ kiln compare -q grey.png box.png --error-map out/map.png --diff out/both.png
= 1
$ ffprobe -v error -show_entries stream=width,height -of csv=p=0 out/map.png
1|64,48
$ bytes() { ffmpeg -nostdin -loglevel error -i $1 -vf crop=64:48:$2:0 -f rawvideo -pix_fmt rgb24 - | sha256sum; }
> [ "$(bytes out/map.png 0)" = "$(bytes out/both.png 128)" ] && echo the same map
1|the same map
$ kiln compare -q grey.png box.png --error-map out/map.png
2|kiln: out/map.png: the file exists (--force replaces it)
= 2
$ kiln compare -q grey.png box.png --error-map out/map.exr
2|kiln: out/map.exr: pictures of differences are PNG; the name must end in .png, or be a folder
= 2

What is not judged: rectangles and masks, black where nothing is.

$ kiln compare -q grey.png box.png --ignore 20,10,5x5
$ kiln compare -q grey.png box.png --ignore 20,10,5x4 --tolerance abs.max=0
= 1
$ kiln compare -q grey.png box.png -i 20,10,5x4 -i 0,14,4000000000x1 --tolerance abs.max=0
$ . ./picture.sh; picture 'color=c=white:s=64x48,format=rgb24,drawbox=x=20:y=10:w=5:h=5:color=black:t=fill' mask.png
> kiln compare -q grey.png box.png --mask mask.png --tolerance abs.max=0
$ . ./picture.sh; picture 'color=c=white:s=64x48,format=rgb24,drawbox=x=21:y=10:w=5:h=5:color=black:t=fill' aside.png
> kiln compare grey.png box.png --mask aside.png | grep -E 'differing.count|largest'
1|  differing.count             5          -
1|  largest difference at 20,10; densest window of 32x32 at 0,0: 5 pixels
$ kiln compare -q grey.png box.png --mask aside.png --ignore 20,0,1x48 --tolerance abs.max=0
$ kiln compare -q grey.png grey.png --ignore 0,0,64x48
2|kiln: the masks cover all 64 x 48 pixels: nothing is left to judge
= 2
$ kiln compare -q grey.png box.png --ignore 0,0,64x24 --ignore 0,24,64x24
2|kiln: the masks cover all 64 x 48 pixels: nothing is left to judge
= 2
$ kiln compare -q grey.png box.png --ignore 64,48,9x9
= 1
$ kiln compare -q grey.png grey.png --mask tall.png
2|tall.png: the mask has 48 x 64 pixels, the pictures 64 x 48
= 3
$ kiln compare -q grey.png grey.png --mask nowhere.png
2|nowhere.png: the image cannot be opened: No such file or directory
= 3
$ kiln compare -q grey.png tall.png --mask mask.png
= 1
$ kiln compare -q grey.png grey.png --ignore 1,2,3
2|kiln: compare: --ignore: found '1,2,3', expected X,Y,WxH in pixels, such as 0,0,320x24
= 2
$ kiln compare -q grey.png grey.png --ignore 1,2,0x3
2|kiln: compare: --ignore: found '1,2,0x3', expected X,Y,WxH in pixels, such as 0,0,320x24
= 2
$ kiln compare -q grey.png grey.png --ignore=-1,2,3x3
2|kiln: compare: --ignore: found '-1,2,3x3', expected X,Y,WxH in pixels, such as 0,0,320x24
= 2

Sequences: folders pair by name, patterns and videos by number.

$ mkdir a b; for i in 0 1 2 3; do cp grey.png a/f_000$i.png; cp grey.png b/f_000$i.png; done
> cp box.png b/f_0002.png; rm b/f_0001.png; cp grey.png b/f_0007.png; cp tall.png b/f_0003.png; : >b/notes.txt
$ kiln compare a b
1|  frame                    verdict            flip.mean  of limit
1|  f_0000.png               same                       0       0 %
1|  f_0001.png               missing     only in the reference
1|  f_0002.png               different           0.017372     949 %
1|  f_0003.png               different   the sizes differ: the reference has 64 x 48 pixels, the test 48 x 64
1|  f_0007.png               extra       only in the test
1|b against a: different
1|  5 frames: 1 same, 2 different, 1 missing, 1 extra; the worst is f_0001.png
1|  metric                  worst         mean  at                        limit
1|  flip.mean            0.017372     0.008686  f_0002.png                 0.01  beyond
1|  flip.p50              0.69899      0.34949  f_0002.png                    -
1|  flip.p99              0.94889      0.47444  f_0002.png                  0.1  beyond
1|  flip.max              0.94889      0.47444  f_0002.png                    -
1|  ssim                  0.95641       0.9782  f_0002.png                    -
1|  psnr                    26.95          inf  f_0002.png                    -
1|  abs.max                   127         63.5  f_0002.png                    -
1|  abs.mean               1.0335      0.51676  f_0002.png                    -
1|  differing.count            25         12.5  f_0002.png                    -
1|  differing.share      0.008138     0.004069  f_0002.png                    -
1|  window.share         0.024414     0.012207  f_0002.png                  0.1  within
= 1
$ kiln compare a/f_%04d.png b/f_####.png --json | jq -c 'select(.event == "frame") | [.name, .verdict]'
1|["f_0000.png","same"]
1|["f_0001.png","missing"]
1|["f_0002.png","different"]
1|["f_0003.png","different"]
1|["f_0007.png","extra"]
$ kiln compare a b --json | jq -c 'select(.event == "result") | [.same, .frames, .counts, .worst_frame]'
1|[false,5,{"same":1,"different":2,"missing":1,"extra":1,"unreadable":0},"f_0001.png"]
$ kiln compare -q a a
$ kiln compare -q a/f_%04d.png a/f_%04d.png --diff out/f_%02d.png
$ kiln compare -q a b --diff out/b/
= 1
$ ls out out/b
1|out:
1|b
1|both.png
1|d.png
1|f_00.png
1|f_01.png
1|f_02.png
1|f_03.png
1|map.png
1|
1|out/b:
1|f_0000.png
1|f_0002.png
$ cp empty.png b/f_0000.png
$ kiln compare a b
1|  frame                    verdict            flip.mean  of limit
1|  f_0000.png               unreadable  b/f_0000.png: the image file is empty
1|  f_0001.png               missing     only in the reference
1|  f_0002.png               different           0.017372     949 %
1|  f_0003.png               different   the sizes differ: the reference has 64 x 48 pixels, the test 48 x 64
1|  f_0007.png               extra       only in the test
1|b against a: unreadable
1|  5 frames: 2 different, 1 missing, 1 extra, 1 unreadable; the worst is f_0000.png
1|  metric                  worst         mean  at                        limit
1|  flip.mean            0.017372     0.017372  f_0002.png                 0.01  beyond
1|  flip.p50              0.69899      0.69899  f_0002.png                    -
1|  flip.p99              0.94889      0.94889  f_0002.png                  0.1  beyond
1|  flip.max              0.94889      0.94889  f_0002.png                    -
1|  ssim                  0.95641      0.95641  f_0002.png                    -
1|  psnr                    26.95        26.95  f_0002.png                    -
1|  abs.max                   127          127  f_0002.png                    -
1|  abs.mean               1.0335       1.0335  f_0002.png                    -
1|  differing.count            25           25  f_0002.png                    -
1|  differing.share      0.008138     0.008138  f_0002.png                    -
1|  window.share         0.024414     0.024414  f_0002.png                  0.1  within
2|b/f_0000.png: the image file is empty
= 3
$ kiln compare a a/f_0000.png
2|kiln: a is a folder and a/f_0000.png is a picture: they cannot be compared
= 2
$ kiln compare a/f_%04d.png a/g_%04d.png
2|a/g_%04d.png: no file fits the pattern
= 3
$ mkdir void
$ kiln compare void a
2|void: the folder has no pictures (PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR, by their suffix)
= 3

Videos, whole ones and not.

$ kiln render scenes/tiny.yaml -q -o v.mp4 --frames 0-9
> kiln render scenes/tiny.yaml -q -o w.mp4 --frames 0-8
> kiln render scenes/tiny.yaml -q -o v_%02d.png --frames 0-9
$ kiln compare -q v.mp4 v.mp4
$ kiln compare v.mp4 w.mp4 --tolerance flip.mean=0.1 | grep -E 'missing'
1|  9                        missing     only in the reference
1|  10 frames: 9 same, 1 missing; the worst is 9
$ kiln compare -q v.mp4 v_%02d.png --tolerance flip.mean=0.2
$ head -c $(($(wc -c <v.mp4) - 1)) v.mp4 >short.mp4
$ kiln compare -q v.mp4 short.mp4 2>&1 | sed 's/ (.*//'; echo ${PIPESTATUS[0]}
1|short.mp4: the video is cut short
1|3
$ for kind in mov avi mkv; do
>     ffmpeg -nostdin -loglevel error -i v.mp4 v.$kind && head -c -50 v.$kind >short.$kind
>     kiln compare -q v.$kind v.$kind; echo "$kind: $?"
>     kiln compare -q v.$kind short.$kind 2>/dev/null; echo "$kind cut short: $?"
> done
1|mov: 0
1|mov cut short: 3
1|avi: 0
1|avi cut short: 3
1|mkv: 0
1|mkv cut short: 3
$ kiln compare v_00.png v.mp4 --tolerance flip.mean=0.2 | grep -v "  [a-z]*[.]" | head -12
1|  v_00.png                 same                0.032724      16 %
1|  1                        extra       only in the test
1|  2                        extra       only in the test
1|  3                        extra       only in the test
1|  4                        extra       only in the test
1|  5                        extra       only in the test
1|  6                        extra       only in the test
1|  7                        extra       only in the test
1|  8                        extra       only in the test
1|  9                        extra       only in the test
1|v.mp4 against v_00.png: different
1|  10 frames: 1 same, 9 extra; the worst is 1
$ kiln compare -q v.mp4 v_00.png
= 1
$ cp grey.png fake.mp4
$ kiln compare -q fake.mp4 v.mp4 2>&1 | sed 's/ (.*//'
1|fake.mp4: the file is not a video; allowed are MP4, MOV, Matroska, WebM, AVI, GIF, APNG or animated WebP files

Layers of EXR files.

$ kiln render scenes/tiny.yaml -q -o x.exr --frames 10
> kiln render scenes/tiny.yaml -q -o y.exr --frames 10 --set systems.fire.emit.rate=0
$ for layer in beauty depth fire; do kiln compare -q x.exr x.exr --layer $layer || echo $layer; done
$ kiln compare -q x.exr y.exr
= 1
$ kiln compare -q x.exr y.exr --layer fire
= 1
$ kiln compare -q x.exr y.exr --layer depth
$ kiln compare x.exr y.exr | head -8
1|  layer                    verdict
1|  beauty                   different   flip.p99 0.45895 of 0.1
1|  bloom                    same        not one value differs
1|  depth                    same        not one number differs
1|  fire                     different   flip.mean 0.090145 of 0.01, flip.p99 0.99518 of 0.1
1|  smoke                    same        not one value differs
1|y.exr against x.exr: different
1|  metric                  value      limit
$ kiln compare x.exr y.exr --layer depth
1|  layer                    verdict
1|  depth                    same        not one number differs
1|y.exr against x.exr: same
$ kiln compare x.exr y.exr --json | python3 -c '
> import json, sys
> for line in sys.stdin:
>     for layer in json.loads(line).get("layers", []):
>         print(layer["name"], layer["kind"], layer["verdict"], layer.get("difference", "-"))'
1|beauty color different -
1|bloom color same -
1|depth data same 0
1|fire color different -
1|smoke color same -
$ mkdir exr_a exr_b; cp x.exr exr_a/1.exr; cp x.exr exr_b/1.exr; cp x.exr exr_a/2.exr; cp y.exr exr_b/2.exr
> kiln compare exr_a exr_b | head -5
1|  frame                    verdict            flip.mean  of limit
1|  1.exr                    same                       0       0 %
1|  2.exr                    different           0.090145     995 %
1|    layer beauty: flip.p99 0.45895 of 0.1
1|    layer fire: flip.mean 0.090145 of 0.01, flip.p99 0.99518 of 0.1
$ kiln compare x.exr y.exr --data-limit -1
2|kiln: compare: --data-limit: found '-1', expected a number from 0 to 1e+30
= 2
$ kiln compare -q x.exr x.exr --layer fier
2|x.exr: no layer 'fier'; the file has the channels A, B, G, R, Z, bloom.A, bloom.B, bloom.G, bloom.R, fire.A, fire.B, fire.G, fire.R, smoke.A, smoke.B, smoke.G, smoke.R
= 3
$ kiln compare -q grey.png grey.png --layer fire
2|grey.png: no layer 'fire': PNG images have no layers but 'beauty'
= 3
$ kiln compare -q x.exr grey.png
= 1
$ head -c $(($(wc -c <x.exr) / 2)) x.exr >short.exr
$ kiln compare -q x.exr short.exr 2>&1 | sed 's/ (.*//'
1|short.exr: the EXR image is broken or cut short

Numbers that are none.

$ exr() { ffmpeg -nostdin -loglevel error -f rawvideo -pix_fmt gbrpf32le -s 2x2 -i - -c:v exr -y $1; }
> one='\0\0\x80\x3f' nan='\0\0\xc0\x7f' inf='\0\0\x80\x7f'
> printf "$one$one$one$one$one$one$one$one$one$one$one$one" | exr one.exr
> printf "$one$one$one$nan$one$one$one$one$one$one$one$one" | exr nan.exr
> printf "$one$one$one$one$one$one$one$one$one$inf$one$one" | exr inf.exr
> kiln compare -q one.exr one.exr
$ . ./picture.sh; picture color=c=white:s=2x2,format=rgb24 white.png; kiln compare white.png one.exr | tail -2
1|  largest difference at 0,0; densest window of 2x2 at 0,0: 0 pixels
1|  the reference is of integers, the test of floats
$ kiln compare -q one.exr nan.exr
2|nan.exr: pixel 1,1 has a value that is not finite
= 3
$ kiln compare -q nan.exr nan.exr
2|nan.exr: pixel 1,1 has a value that is not finite
= 3
$ kiln compare -q inf.exr one.exr --range ldr
2|inf.exr: pixel 1,0 has a value that is not finite
= 3

$ kiln compare -q one.exr nan.exr --ignore 1,1,1x1
$ kiln compare -q nan.exr one.exr --ignore 1,1,1x1 --tolerance abs.max=0
$ kiln compare -q inf.exr nan.exr --ignore 1,1,1x1
2|inf.exr: pixel 1,0 has a value that is not finite
= 3

Times.

$ kiln compare grey.png grey.png --stats | tail -n 2
1|  FLIP in <s> s
1|  all in <s> s
$ kiln compare grey.png grey.png --stats --json | tail -n 1 | grep -o '"flip_s.*'
1|"flip_s": <s>, "total_s": <s>}
$ kiln compare grey.png grey.png >/dev/full
2|kiln: standard output: No space left on device
= 6
