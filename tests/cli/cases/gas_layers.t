EXR files of a scene with gas have layers of it. Those of other scenes have none.

$ cat >gas.yaml <<'END'
> # A small fire in smoke, with sparks before and behind it, and a pillar that hides a part of it, in 64 x 36 pixels.
> kiln: 1
> seed: 7
> output: {size: [64, 36], fps: 10, frames: 21}
> simulation: {rate: 20}
> camera: {position: [0, 0.8, 2.4], target: [0, 0.6, 0]}
> backdrop: {objects: [{box: {center: [0, 0.4, 0.7], size: [0.1, 0.8, 0.1]}}]}
> gas:
>   fire:
>     box: {size: [1, 1.6, 1]}
>     cells: 32
>     sources: [{from: {disc: {radius: 0.2 m}}, smoke: 1, velocity: [0, 0.5, 0]}]
>     look: {extinction: 20, intensity: 300}
> systems:
>   sparks:
>     emit: {rate: 40, life: 1 s, from: {disc: {radius: 0.2 m}}}
>     look: {atlas: "builtin:spark", blend: add, size: 3 cm}
> END
$ kiln render gas.yaml -q -o a_##.exr --frames 9-10 && kiln render gas.yaml -q -o none.exr --frames 10 --set gas.fire.enabled=false
$ kiln compare -q a_10.exr a_10.exr --layer smock
2|a_10.exr: no layer 'smock'; the file has the channels A, B, G, R, Z, bloom.A, bloom.B, bloom.G, bloom.R, fire.A, fire.B, fire.G, fire.R, gas.density.Y, gas.depth.Z, gas.emission.A, gas.emission.B, gas.emission.G, gas.emission.R, smoke.A, smoke.B, smoke.G, smoke.R
= 3
$ kiln compare -q none.exr none.exr --layer gas.depth
2|none.exr: no layer 'gas.depth'; the file has the channels A, B, G, R, Z, bloom.A, bloom.B, bloom.G, bloom.R, fire.A, fire.B, fire.G, fire.R, smoke.A, smoke.B, smoke.G, smoke.R
= 3

They do not depend on the frames that a job draws, nor on threads.

$ kiln render gas.yaml -q -o b.exr --frames 10 --threads 3 && cmp a_10.exr b.exr

Particles change none of them. Thinner gas changes all but those of the scene, and what is behind a pillar is not seen.

$ cat >table.sh <<'END'
> kiln compare "$@" | sed -n 's/^  \([a-z.]*\)  *\(same\|different\).*/\1 \2/p'
> END
$ kiln render gas.yaml -q -o calm.exr --frames 10 --set systems.sparks.enabled=false && . ./table.sh a_10.exr calm.exr
1|beauty different
1|bloom same
1|depth same
1|fire different
1|gas.density same
1|gas.depth same
1|gas.emission same
1|smoke same
$ kiln render gas.yaml -q -o thin.exr --frames 10 --set gas.fire.look.extinction=10 && . ./table.sh a_10.exr thin.exr
1|beauty different
1|bloom different
1|depth same
1|fire different
1|gas.density different
1|gas.depth different
1|gas.emission different
1|smoke different
$ kiln render gas.yaml -q -o free.exr --frames 10 --set 'backdrop.objects=[]' && . ./table.sh a_10.exr free.exr
1|beauty different
1|bloom different
1|depth different
1|fire different
1|gas.density different
1|gas.depth different
1|gas.emission different
1|smoke different

Layers of gas do not change the picture.

$ kiln render gas.yaml -q -o png/##.png --frames 9-10 && kiln render gas.yaml -q -o exr/##.exr --frames 9-10 --exr-bits 32
$ kiln encode exr -q -o exr.mkv --tonemap agx && kiln encode png -q -o png.mkv && cmp exr.mkv png.mkv
