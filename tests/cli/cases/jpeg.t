JPEG images, by both of their suffixes: numbered, of a quality, gone on with, encoded.

$ kiln render scenes/tiny.yaml -qo one.jpg --frames 9 && kiln render scenes/tiny.yaml -qo one.jpeg --frames 9 --quality 80 && cmp one.jpg one.jpeg && file -b one.jpg | cut -d, -f1-2
1|JPEG image data, JFIF standard 1.02
$ kiln render scenes/tiny.yaml -qo poor.jpg --frames 9 --quality 0 && kiln render scenes/tiny.yaml -qo rich.jpg --frames 9 --quality 100 && test $(stat -c %s poor.jpg) -lt $(stat -c %s one.jpg) -a $(stat -c %s one.jpg) -lt $(stat -c %s rich.jpg) && echo larger
1|larger
$ kiln render scenes/tiny.yaml -qo one.png --frames 9 && kiln compare one.png rich.jpg --tolerance psnr=40 | grep -v flip
1|rich.jpg against one.png: same
1|  metric                  value      limit
1|  ssim                    0.996          -
1|  psnr                   47.674         40  within
1|  abs.max                     6          -
1|  abs.mean              0.72526          -
1|  differing.count           123          -
1|  differing.share      0.053385          -
1|  window.share          0.11523          -
1|  largest difference at 26,17; densest window of 32x32 at 21,0: 118 pixels
$ kiln render scenes/tiny.yaml -o f_%02d.jpg --frames 0-5 --progress none && rm f_03.jpg && kiln render scenes/tiny.yaml -o f_%02d.jpg --frames 0-6 --resume --progress none
1|device: <device>
1|f_00.jpg and 5 more: 6 frames in <s> s
1|device: <device>
1|f_00.jpg and 6 more: 2 frames in <s> s, 5 kept
$ kiln render scenes/tiny.yaml -o f_%02d.jpg --frames 0-6 --resume --progress none --quality 81
1|device: <device>
2|kiln: f_%02d.jpg.journal: the journal belongs to other frames, or to other settings of the output (--force starts anew)
= 2
$ rm *.journal && kiln render scenes/tiny.yaml -o f_%02d.jpg --frames 0-6 --resume --progress none --quality 81
1|device: <device>
2|kiln: f_00.jpg: the file exists, and is not a whole frame 0 of this job (--force replaces it)
= 2
$ for n in 1 4; do kiln render scenes/tiny.yaml -qo $n/%02d.jpg --threads $n; done; KILN_SIMD=plain kiln render scenes/tiny.yaml -qo plain/%02d.jpg; diff -r 1 4 && diff -r 1 plain && ls 1 | wc -l
1|24

Clips of them know the scene and the rate.

$ kiln encode f_%02d.jpg -o clip.mp4 && ffprobe -v error -of csv=p=0 -show_entries format_tags=comment clip.mp4 | sed 's/version=[0-9.]*/version=N/; s/scene=[0-9a-f]*/scene=HASH/'
1|clip.mp4: 7 frames, 0-6
1|kiln:version=N kiln:scene=HASH kiln:seed=7 kiln:frames=0-6

What JPEG does not have, and what has no quality.

$ kiln render scenes/tiny.yaml -qo alpha.jpg --frames 9 --set backdrop.transparent=true
2|kiln: alpha.jpg: the backdrop is transparent, but a JPEG image has no alpha; write .png or .exr, or make the backdrop opaque
= 2
$ for output in x.png x.exr x.gif x.mkv x.apng -; do kiln render scenes/tiny.yaml -qo $output --quality 50; done
2|kiln: render: --quality: the format of 'x.png' has no quality; .jpg, .mp4, .webm, .mov and .webp have one
2|kiln: render: --quality: the format of 'x.exr' has no quality; .jpg, .mp4, .webm, .mov and .webp have one
2|kiln: render: --quality: the format of 'x.gif' has no quality; .jpg, .mp4, .webm, .mov and .webp have one
2|kiln: render: --quality: the format of 'x.mkv' has no quality; .jpg, .mp4, .webm, .mov and .webp have one
2|kiln: render: --quality: the format of 'x.apng' has no quality; .jpg, .mp4, .webm, .mov and .webp have one
2|kiln: render: --quality: not allowed with '--output -'
= 2
$ kiln encode f_%02d.jpg -o x.mkv --quality 50
2|kiln: encode: --quality: the format of 'x.mkv' has no quality; .jpg, .mp4, .webm, .mov and .webp have one
= 2
$ kiln render scenes/tiny.yaml -qo none --quality 50
