Frames are the same whether they are rendered alone, in chunks or in a full run.

$ kiln render scenes/tiny.yaml -q -o full_%02d.png
$ kiln render scenes/tiny.yaml -q -o chunk_%02d.png --frames 10-19
$ for frame in {10..19}; do cmp full_$frame.png chunk_$frame.png; done
$ kiln render scenes/tiny.yaml -q -o list_%02d.png --frames 23,4-5,0,5,3-4
$ ls list_*
1|list_00.png
1|list_03.png
1|list_04.png
1|list_05.png
1|list_23.png
$ for file in list_*; do cmp $file ${file/list/full}; done

So are the layers of EXR files, however they are composed.

$ for compose in merged separate; do
>     for frames in 0-6 5-6; do
>         kiln render scenes/tiny.yaml -q -o ${compose}_$frames/%d.exr --frames $frames --set post.compose=$compose
>     done
>     cmp ${compose}_0-6/5.exr ${compose}_5-6/5.exr && cmp ${compose}_0-6/6.exr ${compose}_5-6/6.exr
> done

A clip of a chunk holds the frames of the full run, and is the same with any number of threads.

$ for suffix in mkv webm; do
>     kiln render scenes/tiny.yaml -q -o part.$suffix --frames 10-19 --threads 1
>     kiln render scenes/tiny.yaml -q -o again.$suffix --frames 10-19 --threads 5
>     cmp part.$suffix again.$suffix
> done
$ for i in {0..9}; do cp full_1$i.png part_$i.png; done
$ kiln compare part_%d.png part.mkv | grep -E "differing.count|frames"
1|  10 frames: 10 same
1|  differing.count             0            0  part_0.png                    -
