A job in a sandbox makes the same bytes.

$ kiln render scenes/tiny.yaml -q --frames 0-3 -o free/c.mp4 && kiln render scenes/tiny.yaml -q --frames 0-3 -o kept/deep/c.mp4 --manifest kept/m.json --sandbox
$ cmp free/c.mp4 kept/deep/c.mp4 && ls -A kept kept/deep
1|kept:
1|deep
1|m.json
1|
1|kept/deep:
1|c.mp4
$ KILN_SANDBOX=on kiln bake scenes/tiny.yaml -o states --every 10 -q && kiln render scenes/tiny.yaml -q --sandbox --states states --frames 20 -o a.png && kiln render scenes/tiny.yaml -q --frames 20 -o b.png && cmp a.png b.png
$ kiln render scenes/tiny.yaml -q --sandbox --frames 0-1 -o - --pipe rgb24 | wc -c
1|13824

It is for the device cpu, and for files that the command names.

$ kiln render scenes/tiny.yaml -q --sandbox --device software -o a.png
2|kiln: render: --device software: not allowed with a sandbox; a sandbox is for the device 'cpu', because drivers of OpenGL need more rights than a job does
= 2
$ kiln render scenes/tiny.yaml -q --sandbox=perhaps -o a.png
2|kiln: render: --sandbox: found 'perhaps', expected one of on|require|off
= 2
$ KILN_SANDBOX=1 kiln check -q scenes/tiny.yaml
2|kiln: KILN_SANDBOX: found '1'; allowed are on, require or off
= 2
$ KILN_SANDBOX=1 kiln check -q scenes/tiny.yaml --sandbox=off
2|kiln: KILN_SANDBOX: found '1'; allowed are on, require or off
= 2
$ mkdir away && cp scenes/puff.png away && printf 'kiln: 1\nsystems: {a: {emit: {rate: 9, life: 1 s}, look: {atlas: puff.png, cells: [1, 1]}}}\n' >away/s.yaml && mkdir by && cp away/s.yaml by
$ kiln check -q --sandbox --asset-root away by/s.yaml && kiln check -q --sandbox by/s.yaml
2|by/s.yaml:2:57: systems.a.look.atlas: cannot open 'puff.png': No such file or directory; a path starts at the scene's folder, or at the asset root that is given instead
= 3
$ kiln devices | grep -c '^sandbox: '
1|1
