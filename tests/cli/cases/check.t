A scene with every default is a scene, and the same one.

$ kiln check scenes/tiny.yaml >whole.yaml
$ kiln check whole.yaml --asset-root scenes | cmp - whole.yaml
$ [ "$(kiln check --hash scenes/tiny.yaml)" = "$(kiln check --hash whole.yaml --asset-root scenes)" ]
$ kiln check --hash scenes/tiny.yaml | grep -cE '^[0-9a-f]{64}$'
1|1
$ kiln check --hash scenes/tiny.yaml whole.yaml --asset-root scenes | sed -E 's/^[0-9a-f]{64}/<hash>/'
1|<hash>  scenes/tiny.yaml
1|<hash>  whole.yaml
$ kiln check scenes/tiny.yaml scenes/empty.yaml | grep '^---'
1|--- # scenes/tiny.yaml
1|--- # scenes/empty.yaml
$ kiln check --quiet scenes/tiny.yaml scenes/empty.yaml

It renders to the same state and the same bytes.

$ kiln render scenes/tiny.yaml -o a.png --frames 20 --stats | grep state >a
$ kiln render whole.yaml --asset-root scenes -o b.png --frames 20 --stats | grep state >b
$ cmp a b && cmp a.png b.png

Values can be set; what was set is in the output.

$ kiln check scenes/tiny.yaml --set seed=9 --set output.size='[32, 18]' | grep -E '^seed|size: \[32'
1|seed: 9
1|  size: [32, 18]
$ [ "$(kiln check --hash scenes/tiny.yaml)" != "$(kiln check --hash scenes/tiny.yaml --set seed=9)" ]
$ kiln check -q scenes/tiny.yaml --set sed=9
2|--set sed: unknown key (did you mean 'seed'?)
= 3
$ kiln check -q scenes/tiny.yaml --set systems.fire.emit.raet=9
2|--set systems.fire.emit.raet: unknown key (did you mean 'rate'?)
= 3
$ kiln check -q scenes/tiny.yaml --set systems.fire.emit.rate=fast
2|--set systems.fire.emit.rate: expected a number from 0 1/s to 10000000 1/s, found 'fast'
= 3
$ kiln check -q scenes/tiny.yaml --set systems.fire.emit.rate=nan
2|--set systems.fire.emit.rate: nan is not a finite number
= 3

Files of a scene are below its folder, or below the asset root.

$ line=$(grep -n -m 1 'puff.png' whole.yaml | cut -d: -f1); kiln check -q whole.yaml 2>why; code=$?; sed "s/:$line:/:LINE:/" why >&2; (exit $code)
2|whole.yaml:LINE:14: systems.smoke.look.atlas: cannot open 'puff.png': No such file or directory; a path starts at the scene's folder, or at the asset root that is given instead
= 3
$ kiln check -q whole.yaml --asset-root nowhere
2|asset root 'nowhere': No such file or directory
= 3

A wrong scene does not hide the others, in any order.

$ kiln check --hash nowhere.yaml scenes/tiny.yaml | sed -E 's/^[0-9a-f]{64}/<hash>/'; echo ${PIPESTATUS[0]}
1|<hash>  scenes/tiny.yaml
1|3
2|nowhere.yaml: No such file or directory
$ kiln check -q scenes/tiny.yaml nowhere.yaml
2|nowhere.yaml: No such file or directory
= 3

An atlas that does not divide into its cells, with the place that says how many.

$ printf '%s\n' 'kiln: 1' 'systems:' '  smoke:' '    emit: {rate: 1, life: 1 s}' '    look: {atlas: puff.png, cells: [3, 2]}' >scenes/cells.yaml
> kiln check scenes/cells.yaml
2|scenes/cells.yaml:5:36: systems.smoke.look.cells: 'puff.png': 32 x 32 pixels do not divide into 3 columns and 2 rows
= 3

Particles that are meshes: there must be a file, and no more of them than memory and time allow.

$ printf '%s\n' 'kiln: 1' 'systems:' '  leaves:' '    emit: {rate: 1, life: 1 s}' '    look: {shape: mesh}' >scenes/leaves.yaml
> printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'f 1 2 3' >scenes/leaf.obj
> kiln check -q scenes/leaves.yaml
2|scenes/leaves.yaml:5:11: systems.leaves.look.mesh.file: must name a file where shape is mesh
= 3
$ kiln check -q scenes/leaves.yaml --set systems.leaves.look.mesh.file=none
2|--set systems.leaves.look.mesh.file: must name a file where shape is mesh
= 3
$ kiln check -q scenes/leaves.yaml --set systems.leaves.look.mesh.file=leaf.obj
$ kiln check -q scenes/leaves.yaml --set systems.leaves.look.mesh.file=leaf.obj --set systems.leaves.look.blend=add
2|--set systems.leaves.look.blend: must be alpha for meshes, which cover what is behind
= 3
$ kiln check -q scenes/leaves.yaml --set systems.leaves.look.mesh.file=leaf.obj --set systems.leaves.emit.rate=2000000
2|scenes/leaves.yaml:4:11: systems.leaves.emit: up to 2066667 particles at once are meshes; a scene has at most 1048576: lower rate, bursts or life
= 3
$ printf 'v %d 0 0\nv 0 1 0\nv 0 0 1\n' {1..400} >scenes/bush.obj; for i in {1..400}; do echo "f 1 $((3*i-1)) $((3*i))"; done >>scenes/bush.obj
> kiln check -q scenes/leaves.yaml --set systems.leaves.look.mesh.file=bush.obj --set systems.leaves.emit.rate=500000
2|scenes/leaves.yaml:4:11: systems.leaves.emit: up to 206666800 triangles are drawn for particles at once; a scene has at most 67108864: lower rate, bursts or life, or take a mesh of fewer than 400 triangles
= 3
$ printf '%s\n' 'v 1 1 1' 'v 1 1 1' 'v 1 1 1' 'f 1 2 3' >scenes/dot.obj
> kiln check -q scenes/leaves.yaml --set systems.leaves.look.mesh.file=dot.obj
2|--set systems.leaves.look.mesh.file: 'dot.obj': the mesh has no triangle with an area
= 3

What the file contains is part of the scene.

$ first=$(kiln check --hash scenes/leaves.yaml --set systems.leaves.look.mesh.file=leaf.obj)
> sed -i 's/v 0 1 0/v 0 2 0/' scenes/leaf.obj
> [ "$first" != "$(kiln check --hash scenes/leaves.yaml --set systems.leaves.look.mesh.file=leaf.obj)" ] && echo another
1|another

What a mesh is: a closed one.

$ printf '%s\n' 'kiln: 1' 'backdrop: {objects: [{mesh: {file: box.obj}}]}' 'systems: {a: {emit: {rate: 1, life: 1 s}}}' >scenes/box.yaml
> { printf 'v %s\n' {0,2}' '{0,1}' '{0,3}; printf 'f %s\n' '1 2 4 3' '5 7 8 6' '1 5 6 2' '3 4 8 7' '1 3 7 5' '2 6 8 4'; } >scenes/box.obj
> kiln check scenes/box.yaml | grep '^#'
1|# mesh box.obj: OBJ, 12 triangles, 24 vertices, from 0 0 0 to 2 1 3
1|#   closed, its thinnest part 1
1|# work: 150 frames of 1280 x 720 pixels, 298 steps, up to 2 particles, about <n> MiB

Open ones: a hole, and a triangle that faces the other way.

$ sed -i '$d' scenes/box.obj; kiln check scenes/box.yaml | grep -A1 '^# mesh'
1|# mesh box.obj: OBJ, 10 triangles, 20 vertices, from 0 0 0 to 2 1 3
1|#   not closed: 1 triangle is at the edge from 0 0 3 to 0 1 3, where there must be two
$ { cat scenes/box.obj; echo 'f 4 8 6'; echo 'f 2 6 4'; } >scenes/turned.obj
> kiln check scenes/box.yaml --set backdrop.objects.0.mesh.file=turned.obj | grep -A1 '^# mesh'
1|# mesh turned.obj: OBJ, 12 triangles, 26 vertices, from 0 0 0 to 2 1 3
1|#   not closed: 2 triangles are at the edge from 0 1 3 to 2 0 3, and do not face the same side

One with materials: one file of them is missing, and so is a texture. Names of strangers are shown with care.

$ printf '%s\n' 'newmtl old oak' 'Kd 0.8 0.5 0.25' 'Pr 0.75' 'map_Kd oak.png' 'map_Bump there.png' 'newmtl lamp' 'Kd 0 0 0' 'Ke 1 1 1' 'd 0.5' >scenes/box.mtl
> touch scenes/there.png
> { printf '%s\n' 'mtllib box.mtl' 'mtllib none.mtl'; sed 's/^v .*/& 1 0.5 0/; 9iusemtl old oak' scenes/box.obj; echo 'usemtl lamp'; echo 'f 2 6 8 4'; } >scenes/painted.obj
> kiln check scenes/box.yaml --set backdrop.objects.0.mesh.file=painted.obj | grep '^#'
1|# mesh painted.obj: OBJ, 12 triangles, 24 vertices, from 0 0 0 to 2 1 3
1|#   closed, its thinnest part 1
1|#   material 'old oak', not drawn yet: base colour 0.604 0.214 0.0509 times 'oak.png' (missing); roughness 0.75; metalness 0; heights of 'there.png'
1|#   material 'lamp', not drawn yet: base colour 0 0 0; alpha 0.5, blended; roughness 1; metalness 0; emission 1 1 1
1|#   colours of vertices, not drawn yet
1|#   note: the mesh file names the file 'none.mtl': the materials cannot be opened: No such file or directory
1|#   note: the mesh file names the file 'oak.png': the image cannot be opened: No such file or directory
1|# work: 150 frames of 1280 x 720 pixels, 298 steps, up to 2 particles, about <n> MiB
$ printf 'newmtl m\nmap_Kd a\033[2Jb.png\n' >scenes/escape.mtl
> printf '%s\n' 'mtllib escape.mtl' 'usemtl m' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'f 1 2 3' >scenes/escape.obj
> kiln check scenes/box.yaml --set backdrop.objects.0.mesh.file=escape.obj | grep '^#  '
1|#   not closed: 1 triangle is at the edge from 0 0 0 to 0 1 0, where there must be two
1|#   material 'm', not drawn yet: base colour 1 1 1 times 'a\x1b[2Jb.png' (missing); roughness 1; metalness 0
1|#   note: the mesh file names the file 'a\x1b[2Jb.png': the image cannot be opened: No such file or directory
$ [ "$(kiln check --hash scenes/box.yaml --set backdrop.objects.0.mesh.file=painted.obj)" = "$(rm scenes/box.mtl; kiln check --hash scenes/box.yaml --set backdrop.objects.0.mesh.file=painted.obj)" ]

A textured glTF that moves, with bones and a clip.

$ kiln check scenes/box.yaml --set backdrop.objects.0.mesh='{file: waving.gltf, animation: {}}' | grep '^#'
1|# mesh waving.gltf: glTF, 10 triangles, 7 vertices, from -0.8 0.019229 -0.691 to 1.27849 2.28961 0.33836
1|#   closed, its thinnest part 0.3043
1|#   2 joints
1|#   1 morph target
1|#   clip 0 'wave' of 1.5 s
1|#   material 'skin', not drawn yet: base colour 1 0.5 0.25 times 'puff.png'; alpha 1, cut at 0.5; roughness 0.5; metalness 0; normals of 'puff.png' (by the second texture coordinates); two-sided
1|# work: 150 frames of 1280 x 720 pixels, 298 steps, up to 2 particles, about <n> MiB

How large domains of gas are, and which keys of a scene with gas are printed. A scene that is printed is the same one.

$ printf '%s\n' 'kiln: 1' 'gas:' '  fire: {box: {size: [1.5, 2.4, 1.5]}, cells: 64, rate: 100, sources: [{from: {disc: {}}}]}' '  off: {use: fire, enabled: false}' '  smoke: {use: fire, cell: 10 cm, cells: auto, detail: 2, substeps: 3}' 'systems: {s: {emit: {rate: 9}, forces: [wind: {gas: fire}]}}' >gas.yaml
> kiln check gas.yaml | grep '^#'
1|# gas fire: 48 x 64 x 48 cells of 0.0375 m, up to 17 MiB, 2 steps or more in each of the scene
1|# gas off: not enabled
1|# gas smoke: 16 x 32 x 16 cells of 0.1 m, up to 1 MiB, 3 steps or more in each of the scene
1|# work: 150 frames of 1280 x 720 pixels, 298 steps, up to 10 particles, about <n> MiB
$ kiln check gas.yaml | sed -n '/^gas:/,/^    sides/p'
1|gas:
1|  fire:
1|    enabled: true
1|    attach: none
1|    box:
1|      center: [0, 1.2, 0]
1|      size: [1.5, 2.4, 1.5]
1|    cell: 0 m
1|    cells: 64
1|    sides:
$ kiln check gas.yaml | grep -A 7 'sources:' | head -n 8
1|    sources:
1|      -
1|        from:
1|          disc:
1|            origin: [0, 0, 0]
1|            direction: [0, 1, 0]
1|            radius: 0.25 m
1|            surface: false
$ kiln check gas.yaml >whole.yaml; [ "$(kiln check --hash gas.yaml)" = "$(kiln check --hash whole.yaml)" ]
$ kiln check --origin gas.yaml | grep -E ' (fire|off|smoke|gas):|detail: 2'
1|          gas: "fire"  # gas.yaml:6
1|  fire:  # gas.yaml:3
1|        smoke: 0  # default
1|  off:  # gas.yaml:4
1|        smoke: 0  # default
1|  smoke:  # gas.yaml:5
1|        smoke: 0  # default
1|    detail: 2  # gas.yaml:5
1|# gas fire: 48 x 64 x 48 cells of 0.0375 m, up to 17 MiB, 2 steps or more in each of the scene
1|# gas off: not enabled
1|# gas smoke: 16 x 32 x 16 cells of 0.1 m, up to 1 MiB, 3 steps or more in each of the scene
$ kiln check scenes/tiny.yaml | grep -c gas
1|0
= 1
