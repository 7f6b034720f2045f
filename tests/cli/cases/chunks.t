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
