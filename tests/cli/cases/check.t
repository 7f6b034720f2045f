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

$ kiln check -q whole.yaml
2|whole.yaml:98:14: systems.smoke.look.atlas: cannot open 'puff.png': No such file or directory; a path starts at the scene's folder, or at the asset root that is given instead
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
