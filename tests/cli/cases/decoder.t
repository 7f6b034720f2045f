Pictures, videos and meshes are decoded by a process of their own, which is beside the program.

$ cat >atlas <<'S' && cat >mesh <<'S2' && chmod +x atlas mesh
> printf 'kiln: 1\noutput: {size: [32, 18], frames: 1}\nsystems: {a: {emit: {rate: 9, life: 1 s}, look: {atlas: %s, cells: [1, 1]}}}\n' "$1" >scene.yaml; kiln check -q scene.yaml
> S
> printf 'kiln: 1\nbackdrop: {objects: [{mesh: {file: %s}}]}\nsystems: {a: {emit: {rate: 9, life: 1 s}}}\n' "$1" >scene.yaml; kiln check -q scene.yaml
> S2
$ cp scenes/puff.png puff.png && ./atlas puff.png && kiln render -q scene.yaml -o one.png && ls one.png
1|one.png
$ KILN_LIBEXEC_DIR=/nowhere ./atlas puff.png
2|kiln: scene.yaml:3:57: systems.a.look.atlas: 'puff.png': /nowhere/kiln-decode: the program that decodes pictures, videos and meshes is missing (KILN_LIBEXEC_DIR is set)
= 5
$ mkdir other && printf '#!/bin/sh\n' >other/kiln-decode && chmod +x other/kiln-decode && KILN_LIBEXEC_DIR=$PWD/other ./atlas puff.png
2|kiln: scene.yaml:3:57: systems.a.look.atlas: 'puff.png': <folder>/work/other/kiln-decode: the program ended before it began
= 5

A text of a PNG that unpacks to a thousand times its size is passed over, and so is what a mesh nests for ever.

$ python3 - <<'P'
> import struct, zlib
> def chunk(kind, data): return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
> head = b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 1, 1, 8, 2, 0, 0, 0))
> tail = chunk(b'IDAT', zlib.compress(bytes(4))) + chunk(b'IEND', b'')
> bomb = zlib.compress(bytes(1 << 28), 9)
> open('text.png', 'wb').write(head + 40 * chunk(b'zTXt', b'a\0\0' + bomb) + chunk(b'iCCP', b'a\0\0' + bomb) + tail)
> deep = ('{"asset": {"version": "2.0"}, "extras": ' + '[' * 64 + ']' * 64 + '}').encode()
> deep += b' ' * (-len(deep) % 4)
> open('deep.glb', 'wb').write(struct.pack('<4sIII4s', b'glTF', 2, 20 + len(deep), len(deep), b'JSON') + deep)
> open('lines.obj', 'w').write('v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n')
> P
$ timeout 5 true && ./atlas text.png
$ ./mesh deep.glb; ./mesh lines.obj
2|scene.yaml:2:36: backdrop.objects.0.mesh.file: 'deep.glb': the mesh has no triangles
2|scene.yaml:2:36: backdrop.objects.0.mesh.file: 'lines.obj': the mesh has no triangles, only points or lines
= 3

A link that leads out of the asset root after the scene was read is not followed.

$ mkdir inside && cp scenes/puff.png inside/puff.png && ln -s ../puff.png inside/link.png
$ (cd inside && ../atlas link.png)
2|scene.yaml:3:57: systems.a.look.atlas: 'link.png' leads outside the asset root
= 3

Nobody is left when kiln is killed while a mesh is imported.

$ python3 - >slow.obj <<'P'
> count = 20000 # corners of one polygon, which crosses itself everywhere
> print("\n".join(f"v {i * 7919 % 10007} {i * i % 10007} 0" for i in range(count)))
> print("f", *range(1, count + 1))
> P
$ ./mesh lines.obj 2>/dev/null; sed -i s/lines/slow/ scene.yaml
$ exec 2>/dev/null; set -m; kiln check -q scene.yaml & sleep 0.5; pgrep -r R,S,D -g $! | wc -l; kill -KILL $!; wait; sleep 1; pgrep -r R,S,D -g $! | wc -l
1|2
1|0

A video of float frames is refused, since FFmpeg reads EXR in another way than OpenEXR does.

$ for file in a.mov a.mkv; do ffmpeg -nostdin -loglevel error -f lavfi -i testsrc=size=8x8 -frames:v 2 -pix_fmt gbrpf32le -c:v exr $file && kiln compare -q $file $file; done
2|a.mov: its frames are floats, such as EXR, which kiln does not read from a video; EXR files are read one for each frame
2|a.mkv: its frames are floats, such as EXR, which kiln does not read from a video; EXR files are read one for each frame
= 3
