Every wrong scene says where, what was found and what is allowed; exit 3, and nothing is written.
`try NAME` reads a scene from standard input and renders it.

$ cat >try <<'END'
> cat >"$1.yaml"; kiln render "$1.yaml" -o "out_$1.png" --frames 0; code=$?; rm "$1.yaml"; exit $code
> END
> chmod +x try

Keys and values.

$ printf 'kiln: 1\nsystems:\n  fire:\n    emit: {raet: 20, life: 1 s, speed: 1}\n' | ./try unknown_key
2|unknown_key.yaml:4:12: systems.fire.emit.raet: unknown key (did you mean 'rate'?)
= 3
$ printf 'kiln: 1\nfrobnicate: 2\n' | ./try unknown_far
2|unknown_far.yaml:2:1: frobnicate: unknown key (there are: kiln, include, params, seed, output, simulation, nodes, camera, backdrop, systems, gas, post)
= 3
$ printf 'kiln: 1\nseed: soon\n' | ./try wrong_type
2|wrong_type.yaml:2:7: seed: expected a whole number from 0 to 4294967295, found 'soon'
= 3
$ printf 'kiln: 1\nseed: [1, 2]\n' | ./try wrong_shape
2|wrong_shape.yaml:2:7: seed: expected a whole number from 0 to 4294967295, found a list
= 3
$ printf 'kiln: 1\noutput: {size: [0, 36]}\n' | ./try zero_size
2|zero_size.yaml:2:17: output.size: 0 is out of range; allowed is from 16 px to 16384 px
= 3
$ printf 'kiln: 1\noutput: {size: [64, 360000]}\n' | ./try large_size
2|large_size.yaml:2:21: output.size: 360000 is out of range; allowed is from 16 px to 16384 px
= 3
$ printf 'kiln: 1\noutput: {frames: -1}\n' | ./try negative
2|negative.yaml:2:18: output.frames: -1 is out of range; allowed is from 1 to 1000000
= 3
$ printf 'kiln: 1\ncamera: {fov: .nan}\n' | ./try nan
2|nan.yaml:2:15: camera.fov: .nan is not a finite number
= 3
$ printf 'kiln: 1\ncamera: {fov: .inf}\n' | ./try inf
2|inf.yaml:2:15: camera.fov: .inf is not a finite number
= 3
$ printf 'kiln: 1\ncamera: {fov: 1e999}\n' | ./try huge
2|huge.yaml:2:15: camera.fov: expected a number from 1 deg to 170 deg, found '1e999'
= 3
$ printf 'kiln: 1\nsimulation: {warmup: 2 deg}\n' | ./try wrong_unit
2|wrong_unit.yaml:2:22: simulation.warmup: unit 'deg' is wrong; allowed is s, ms, min or h
= 3
$ printf 'kiln: 1\nseed: 1\nseed: 2\n' | ./try duplicate
2|duplicate.yaml:3:1: duplicate key 'seed' (first in line 2)
= 3
$ printf 'kiln: 2\n' | ./try version
2|version.yaml:1:7: kiln: 2 is out of range; allowed is 1
= 3
$ printf 'seed: 2\n' | ./try no_version
2|no_version.yaml:1:1: kiln: the key is missing and must be given
= 3
$ printf 'kiln: 1\npost: {tonemap: agxx}\n' | ./try choice
2|choice.yaml:2:17: post.tonemap: unknown word 'agxx' (did you mean 'agx'?)
= 3
$ printf 'kiln: 1\nsystems:\n  fire:\n    emit: {rate: 10000000, life: 1000 s, speed: 1}\n' | ./try capacity
2|capacity.yaml:4:11: systems.fire.emit: up to 49666667 particles at once need 1515 MiB; the systems of a scene may have 33554432 in all (1024 MiB), of which 0 are taken: lower rate, bursts or life
= 3

Files.

$ kiln render nowhere.yaml -o x.png
2|nowhere.yaml: No such file or directory
= 3
$ kiln render scenes -o x.png
2|scenes: the path is a folder, not a scene file
= 3
$ printf '' | ./try empty
2|empty.yaml: the file is empty; a scene starts with 'kiln: 1'
= 3
$ printf '\x7fELF\x00\x01\x02' | ./try binary
2|binary.yaml:1:5: not a text: a zero byte
= 3
$ printf 'kiln: 1\nseed: "\xff\xfe"\n' | ./try utf8
2|utf8.yaml:2:8: not a text: invalid UTF-8 (byte 0xff)
= 3
$ printf 'kiln: 1\nseed: {a: [}\n' | ./try syntax
2|syntax.yaml:2:12: not valid YAML: mismatched flow mapping end
= 3
$ printf 'kiln: 1\nseed: *a\n' | ./try alias
2|alias.yaml:2:7: there is no anchor 'a' above
= 3
$ printf 'kiln: 1\n<<: [{seed: 2}, 3]\n' | ./try merge
2|merge.yaml:2:17: <<: expected a mapping or a list of mappings
= 3
$ { printf 'kiln: 1\nseed: '; printf '[%.0s' {1..200}; printf ']%.0s' {1..200}; echo; } | ./try deep
2|deep.yaml:2:70: nested deeper than the 64 levels that are allowed
= 3
$ truncate -s 100M large.yaml && kiln render large.yaml -o x.png; code=$?; rm large.yaml; exit $code
2|large.yaml: the file has 104857600 bytes; a scene file has at most 4194304
= 3

Textures.

$ cat >texture <<'END'
> printf 'kiln: 1\nsystems: {a: {emit: {rate: 1, life: 1 s, speed: 1}, look: {atlas: "%s"}}}\n' "$1" | ./try "$2"
> END
> chmod +x texture
$ ./texture missing.png missing
2|missing.yaml:2:67: systems.a.look.atlas: cannot open 'missing.png': No such file or directory; a path starts at the scene's folder, or at the asset root that is given instead
= 3
$ ./texture builtin:fier builtin
2|builtin.yaml:2:67: systems.a.look.atlas: unknown built-in asset 'builtin:fier' (did you mean 'fire'?)
= 3
$ ./texture ../../../etc/passwd outside
2|outside.yaml:2:67: systems.a.look.atlas: '../../../etc/passwd' is outside the asset root; a path starts at the scene's folder and stays below it
= 3
$ ./texture /etc/passwd absolute
2|absolute.yaml:2:67: systems.a.look.atlas: '/etc/passwd' is outside the asset root; a path starts at the scene's folder and stays below it
= 3
$ echo text >text.png && ./texture text.png no_image
2|no_image.yaml:2:67: systems.a.look.atlas: 'text.png': the file is not an image: it starts with the bytes 74 65 78 74; allowed are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR files
= 3
$ : >nothing.png && ./texture nothing.png nothing
2|nothing.yaml:2:67: systems.a.look.atlas: 'nothing.png': the image file is empty
= 3

Whole PNG files of no pixels and of 100000 x 1 pixels.

$ echo iVBORw0KGgoAAAANSUhEUgAAAAAAAAAACAAAAAAe4CPOAAAACElEQVR42gMAAAAAAW/dyZEAAAAASUVORK5CYII= |
>     base64 -d >zero.png && ./texture zero.png zero
2|zero.yaml:2:67: systems.a.look.atlas: 'zero.png': the PNG image is broken or cut short (Invalid IHDR data)
= 3
$ echo iVBORw0KGgoAAAANSUhEUgABhqAAAAABCAAAAAB4FUkJAAAAeElEQVR42u3BMQEAAADCoPVPbQ0PoAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAIBbA4awAAF6KyntAAAAAElFTkSuQmCC |
>     base64 -d >wide.png && ./texture wide.png wide
2|wide.yaml:2:67: systems.a.look.atlas: 'wide.png': PNG image of 100000 x 1 pixels; allowed are 1 to 16384 a side and at most 67108864 in all
= 3
$ mkfifo pipe.png && ./texture pipe.png pipe
2|pipe.yaml:2:67: systems.a.look.atlas: 'pipe.png' is not a file
= 3
$ ls
1|nothing.png
1|pipe.png
1|scenes
1|text.png
1|texture
1|try
1|wide.png
1|zero.png
