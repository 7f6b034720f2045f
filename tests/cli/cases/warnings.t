What is wrong with a picture that is read all the same is said, once for each file: a PNG file without its end, a
chunk with a wrong checksum, Exif data that mean nothing.

$ chunk() { head -c -12 scenes/puff.png; printf "$1"; tail -c 12 scenes/puff.png; }
> mkdir odd && head -c -12 scenes/puff.png >odd/1.png
> chunk '\0\0\0\3tEXta\0b\0\0\0\0' >odd/2.png
> chunk '\0\0\0\4eXIfnone\x8d\xe2\xd0\xfc' >odd/3.png
> chunk '\0\0\0\3tEXta\0b\0\0\0\0' | head -c -12 >odd/4.png
$ kiln compare --quiet odd/1.png scenes/puff.png && kiln compare --quiet scenes/puff.png odd/2.png && kiln compare --quiet odd/3.png odd/3.png
2|kiln: warning: odd/1.png: its end is missing (chunk IEND)
2|kiln: warning: odd/2.png: its chunk tEXt has a wrong checksum and is ignored
2|kiln: warning: odd/3.png: its Exif data are broken and are ignored
$ kiln compare --quiet odd odd
2|kiln: warning: odd/1.png: its end is missing (chunk IEND)
2|kiln: warning: odd/2.png: its chunk tEXt has a wrong checksum and is ignored
2|kiln: warning: odd/3.png: its Exif data are broken and are ignored
2|kiln: warning: odd/4.png: its chunk tEXt has a wrong checksum and is ignored; its end is missing (chunk IEND)
$ kiln encode odd -o odd.apng --fps 10 --quiet
2|kiln: warning: odd/1.png: its end is missing (chunk IEND)
2|kiln: warning: odd/2.png: its chunk tEXt has a wrong checksum and is ignored
2|kiln: warning: odd/3.png: its Exif data are broken and are ignored
2|kiln: warning: odd/4.png: its chunk tEXt has a wrong checksum and is ignored; its end is missing (chunk IEND)
$ kiln render scenes/tiny.yaml -o puff.jpg --frames 3 --quiet && (head -c 2 puff.jpg; printf '\xff\xe1\0\x0bExif\0\0nil'; tail -c +3 puff.jpg) >odd.jpg && kiln compare --quiet odd.jpg puff.jpg
2|kiln: warning: odd.jpg: its Exif data are broken and are ignored

An orientation of 0 is that of cameras without a sensor for it, and is no fault; 9 is one.

$ turned() { head -c 2 puff.jpg; printf "\xff\xe1\0\x22Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x0$1\0\0\0\0\0\0\0"; tail -c +3 puff.jpg; }
> for i in 0 1 9; do turned $i >turned_$i.jpg; kiln compare --quiet turned_$i.jpg puff.jpg; done
2|kiln: warning: turned_9.jpg: its Exif data are broken and are ignored

A clip that begins again, since a later frame is transparent, warns of no file twice.

$ mkdir two && ffmpeg -nostdin -loglevel error -i scenes/puff.png -pix_fmt rgb24 -bitexact solid.png && for i in 0 1 3; do head -c -12 solid.png >two/$i.png; done && cp odd/1.png two/2.png
$ kiln encode two -o two.apng --fps 10 --quiet
2|kiln: warning: two/0.png: its end is missing (chunk IEND)
2|kiln: warning: two/1.png: its end is missing (chunk IEND)
2|kiln: warning: two/2.png: its end is missing (chunk IEND)
2|kiln: warning: two/3.png: its end is missing (chunk IEND)

In a scene, it has the place of the file's name. Of an animation, a sky, floor or other texture is the first frame.

$ kiln render scenes/tiny.yaml -o a.webp --frames 0-2 --quiet && kiln render scenes/tiny.yaml -o a.gif --frames 0-2 --quiet 2>/dev/null && kiln render scenes/tiny.yaml -o a.apng --frames 0-2 --quiet && cp a.apng a.png
$ cat >odd.yaml <<'END'
> kiln: 1
> output: {size: [32, 18], frames: 2}
> backdrop:
>   sky: {image: a.webp}
>   floor: {image: a.gif}
>   objects: [{terrain: {image: odd/1.png, samples: [2, 2]}}]
> END
$ kiln render odd.yaml --frames 0-1 -o odd_%d.png --quiet
2|kiln: warning: odd.yaml:4:16: backdrop.sky.image: 'a.webp': it is an animation; the first frame is taken
2|kiln: warning: odd.yaml:5:18: backdrop.floor.image: 'a.gif': it is an animation; the first frame is taken
2|kiln: warning: odd.yaml:6:31: backdrop.objects.0.terrain.image: 'odd/1.png': its end is missing (chunk IEND)
$ kiln check odd.yaml --set backdrop.sky.image=a.png --set backdrop.floor.image=odd/1.png >/dev/null
2|kiln: warning: --set backdrop.sky.image: 'a.png': it is an animation; the first frame is taken
2|kiln: warning: --set backdrop.floor.image: 'odd/1.png': its end is missing (chunk IEND)

An atlas is a sheet of cells where its file is a PNG, also one with several frames.

$ kiln render scenes/tiny.yaml --asset-root . --set 'systems.*.look.atlas=a.png' --frames 0 -o sheet.png --quiet
$ kiln render scenes/tiny.yaml --asset-root . --set 'systems.*.look.atlas=a.webp' --frames 0 -o sheet.png --quiet --force
2|kiln: warning: --set systems.*.look.atlas: systems.smoke.look.atlas: 'a.webp': it is an animation; the first frame is taken

A test warns of its golden image in its log, where the reader of a failure looks.

$ printf 'kiln_test: 1\nscene: scenes/tiny.yaml\nframes: [3]\n' >fire.test.yaml; kiln test fire >/dev/null; kiln test approve fire
1|wrote golden/fire/frame_0003.png
1|wrote golden/fire/scene.yaml
1|wrote golden/fire/expect.yaml
$ f=golden/fire/frame_0003.png; head -c -12 $f >cut.png && mv cut.png $f && kiln test fire >/dev/null; cat out/test/fire/log.txt
1|kiln: warning: golden/fire/frame_0003.png: its end is missing (chunk IEND)

A node of a scene has one scale, and a node of a file may have three.

$ echo '{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"name": "wide", "scale": [3, 1, 1]}]}' >scenes/wide.gltf
$ kiln check scenes/tiny.yaml --set "nodes={a: {file: wide.gltf, node: wide}}" >/dev/null
2|kiln: warning: --set nodes: nodes.a.node: node 'wide' of the file has the scale [3, 1, 1]; a node of a scene has one scale, 1e-06 at least, so 1 is taken
$ echo '{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"scale": [0, 0, 0], "children": [1]}, {"name": "eye"}]}' >scenes/flat.gltf
$ kiln check scenes/tiny.yaml --set "nodes={a: {file: flat.gltf, node: eye}}" >/dev/null
2|kiln: warning: --set nodes: nodes.a.node: node 0 of the file has the scale [0, 0, 0]; a node of a scene has one scale, 1e-06 at least, so 1e-06 is taken
