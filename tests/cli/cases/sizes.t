The largest scenes. At each limit the states are the same with OpenGL and without, and the pictures look
the same; one more is an error.

$ mkdir bin; cat >bin/series <<'END'
> #!/bin/sh
> for i in $(seq "$1"); do printf "$2" "$i"; done
> END
$ cat >bin/states <<'END'
> #!/bin/sh
> kiln render "$@" -q -o cpu.png --force --frames 1 --stats --device cpu | grep state >cpu
> kiln render "$@" -q -o gl.png --force --frames 1 --stats --device software --technique simulate=inplace \
>     --technique sort=radix --technique backdrop=gl --technique raster=geometry --technique bloom=gl \
>     --technique composite=gl | grep state | diff cpu - && cat cpu
> kiln compare -q cpu.png gl.png || echo the pictures differ
> END
$ chmod +x bin/*

Systems:

$ { printf 'kiln: 1\noutput: {size: [32, 18], frames: 2}\nsystems:\n'; bin/series 64 '  s%d: {emit: {rate: 600}, forces: [curl: 1]}\n'; } >64.yaml
$ bin/states 64.yaml
1|  state        7f47b5a1892ee8a0
$ { cat 64.yaml; echo '  more: {emit: {rate: 600}}'; } >65.yaml
$ kiln check 65.yaml
2|65.yaml:4:3: systems: found 65 entries; at most 64 are allowed
= 3
$ kiln render 64.yaml -q -o none --frames 0 --device software --technique simulate=feedback
2|kiln: systems: found 64 systems; the technique simulate=feedback takes at most 16: use simulate=inplace
= 2
$ kiln render 64.yaml -q -o none --frames 0 --device software --technique sort=oddeven:4
2|kiln: systems: found 64 systems; the technique sort=oddeven takes at most 16: use sort=radix
= 2

Nodes, each in the one before it, and the points of a path:

$ nodes() { printf 'kiln: 1\noutput: {size: [32, 18], frames: 9}\nnodes:\n  n0: {rotation: {keys: {0 s: [0, 0, 0], 1 s: [0, 90 deg, 0]}}}\n'; for i in $(seq $(($1 - 1))); do echo "  n$i: {parent: n$((i - 1)), position: [0.01, 0, 0]}"; done; echo 'systems: {a: {emit: {rate: 600, attach: n255}}}'; }
> nodes 256 >256.yaml; nodes 257 >257.yaml; bin/states 256.yaml; kiln check 257.yaml
1|  state        26802e2f29ca8a9c
2|257.yaml:4:3: nodes: found 257 entries; at most 256 are allowed
= 3
$ points() { printf 'kiln: 1\nnodes: {a: {position: {path: {over: [0, 1], points: ['; bin/series "$1" '[%d, 0, 0], '; echo ']}}}}'; }
> points 1024 >points.yaml; kiln check -q points.yaml; points 1025 >points.yaml; kiln check points.yaml
2|points.yaml:2:13283: more than 1024 entries in one list or mapping; no more are allowed
= 3

Forces of a system:

$ fire() { printf 'kiln: 1\noutput: {size: [32, 18], frames: 9}\nsystems:\n  fire: {emit: {rate: 600}, forces: ['; bin/series "$1" 'wind: [0.%d, 0, 0], '; echo ']}'; }
> fire 32 >32.yaml; fire 33 >33.yaml; bin/states 32.yaml; kiln check 33.yaml
1|  state        3a5d3548cee090fb
2|33.yaml:4:37: systems.fire.forces: found 33 entries; at most 32 are allowed
= 3
$ kiln render 32.yaml -q -o none --frames 0 --device software --technique simulate=texels
2|kiln: forces: found 32 forces of a system; the technique simulate=texels takes at most 16: use simulate=inplace
= 2

Textures, eight a system, of 32 cells each:

$ for i in $(seq 64); do cp scenes/puff.png $i.png; done
> printf 'kiln: 1\noutput: {size: [32, 18], frames: 2}\nsystems:\n' >textures.yaml
> for s in $(seq 0 8 56); do printf '  s%d: {emit: {rate: 60}, look: {cells: [8, 4], atlas: [' $s; for i in $(seq 8); do printf "$((s + i)).png, "; done; echo ']}}'; done >>textures.yaml
> bin/states textures.yaml
1|  state        c9b4ea0dbd18219e
$ sed -i 's/.8, 4./[8, 8]/' textures.yaml; kiln render textures.yaml -q -o none --frames 0 --device software --technique raster=geometry 2>&1 | sed 's/; .* takes/; <device> takes/'
1|kiln: the atlases have 4096 cells together; <device> takes at most 2048
$ sed -i 's/1.png,/1.png, 2.png,/' textures.yaml; kiln check textures.yaml
2|textures.yaml:4:55: systems.s0.look.atlas: expected "builtin:fire", "builtin:flame", "builtin:tongue", "builtin:smoke", "builtin:puff", "builtin:spark", "builtin:star", "builtin:drop", "builtin:splash", "builtin:debris", "builtin:trail", "builtin:band", or the path of an image or video file, from the scene's folder and inside it; or a list of 1 to 8 of these, found a list
= 3

Keys, 1024 a curve. Speeds and pulls are evaluated on the device, lives in drawing, too. Balls that collide have kernels
of their own:

$ cat >bin/keys <<'END'
> #!/bin/sh
> awk -v step=$1 'BEGIN { for (i = 0; i < 1024; i++) printf "%s%.5f: %.1f", i ? ", " : "", i * step, (i * 7 % 9 + 1) / 10 }'
> END
> chmod +x bin/keys; printf 'kiln: 1\noutput: {size: [32, 18], frames: 9}\nsystems:\n' >keys.yaml
> over_time="{keys: {$(bin/keys 0.0001)}}" over_life="{life: {$(bin/keys 0.0009)}}"
> for s in $(seq 31); do
>     echo "  s$s: {emit: {rate: 600, speed: $over_time}, forces: [wind: {velocity: [$s, 0, 0], pull: $over_life}]}"
> done >>keys.yaml
> echo "  last: {emit: {rate: 600, life: $over_time}, forces: [drag: $over_life]}" >>keys.yaml
> echo '  pair: {emit: {rate: 6000, life: [0.02 s, 4 s], from: {box: {size: [4, 3, 1]}}}, look: {size: 20 cm}}' >>keys.yaml
$ bin/states keys.yaml
1|  state        9a165a2abeb2f028
$ { grep -v ' s31' keys.yaml; echo '  ball: {emit: {rate: 600, speed: {keys: {0: 1, 1: 2}}}, look: {shape: sphere}, interact: [collide: {radius: {life: [1 cm, 2 cm]}}]}'; } >balls.yaml
$ bin/states balls.yaml
1|  state        80b421ae9f67b7b8
$ { cat keys.yaml; echo '  more: {emit: {rate: {keys: {0: 1}}}}'; } >more.yaml; kiln check more.yaml
2|more.yaml:37:30: systems.more.emit.rate.keys: 1 keys are too many; a scene has at most 65536, and 65536 of them are used already
= 3
$ grep -v ' s[23456789]' keys.yaml >few.yaml; kiln render few.yaml -q -o none --frames 0 --device software --technique simulate=pingpong
2|kiln: scene: found 24576 keys; the technique simulate=pingpong takes at most 1024: use simulate=inplace
= 2
$ sed '/ s/s/speed/life/' few.yaml >lives.yaml; kiln render lives.yaml -q -o none --frames 0 --device software --technique raster=geometry
2|kiln: systems: found up to 12288 keys of lives; OpenGL takes at most 1024: use the device cpu
= 2

Objects that collide, of which a lamp and the sun see each other's shadows:

$ objects() {
>     printf 'kiln: 1\noutput: {size: [96, 54], frames: 2}\nsimulation: {warmup: 1 s}\ncamera: {position: [0, 4, 9]}\nsystems:\n'
>     echo '  rain: {emit: {rate: 900, from: {box: {origin: [0, 3, 0], size: [8, 0.2, 8]}}}, forces: [gravity: {}], collide: {restitution: 0.5}}'
>     printf 'backdrop:\n  lights: [point: {position: [0, 4, 3], color: [20, 20, 20]}]\n  objects:\n'
>     for i in $(seq "$1"); do
>         at="center: [$((i % 16 / 2 - 4)).$((i % 2 * 5)), 0.3, $((i / 32 - 4)).$((i / 16 % 2 * 5))]"
>         case $((i % 4)) in
>         0) echo "    - box: {$at, size: [0.3, 0.6, 0.3]}" ;;
>         1) echo "    - sphere: {$at, radius: 0.2}" ;;
>         2) echo "    - cylinder: {$at, radius: 0.15, height: 0.6}" ;;
>         3) echo "    - capsule: {$at, radius: 0.15, height: 0.4}" ;;
>         esac
>     done
> }
> objects 256 >256.yaml; objects 257 >257.yaml; bin/states 256.yaml; kiln check 257.yaml
1|  state        e3545f431d0a379d
2|257.yaml:10:5: backdrop.objects: found 257 entries; at most 256 are allowed
= 3
$ sed 's/  rain: {/&look: {shape: sphere, size: 0.5 m, lit: 1}, /' 256.yaml >balls.yaml; bin/states balls.yaml
1|  state        e3545f431d0a379d
$ kiln render 256.yaml -q -o none --frames 0 --device software --technique sort=oddeven:4
2|kiln: backdrop.objects: found 256 objects; the technique sort=oddeven takes at most 32: use sort=radix
= 2

Meshes that collide, as fields and as volumes:

$ printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >tetrahedron.obj
> meshes() {
>     sed '/objects:/q' 256.yaml
>     for i in $(seq "$1"); do
>         case $((i % 4)) in 0) way=volume ;; *) way=field ;; esac
>         echo "    - mesh: {file: tetrahedron.obj, position: [$((i % 8 - 4)), 0.3, $((i / 8 - 4))], scale: 0.7, collide: true, collider: $way, cells: 24}"
>     done
> }
> meshes 64 >64.yaml; meshes 65 >65.yaml; meshes 9 >9.yaml; bin/states 64.yaml; kiln check 65.yaml
1|  state        d2db1e7274863321
2|65.yaml:10:5: backdrop.objects: more than 64 meshes; no more are allowed
= 3
$ kiln render 9.yaml -q -o none --frames 0 --device software --technique simulate=pingpong
2|kiln: backdrop.objects: found 9 meshes; the technique simulate=pingpong takes at most 8: use simulate=inplace
= 2

A saved state of as many systems and painted meshes:

$ cat >painted.obj <<'END'
> v 0 0 0
> v 1 0 0
> v 0 1 0
> v 0 0 1
> vt 0 0
> vt .4 0
> vt 0 .4
> vt .6 .6
> vt 1 .6
> vt .6 1
> vt .6 0
> vt 1 0
> vt .6 .4
> vt 0 .6
> vt .4 .6
> vt 0 1
> f 1/1 3/2 2/3
> f 1/4 2/5 4/6
> f 1/7 4/8 3/9
> f 2/10 3/11 4/12
> END
$ { printf 'kiln: 1\noutput: {size: [32, 18], frames: 9}\nsystems:\n'
> bin/series 64 '  s%d: {emit: {rate: 60, from: {box: {origin: [0, 1, 0], size: [8, 0.1, 8]}}}, forces: [gravity: {}], collide: {}, paint: {}}\n'
> printf 'backdrop:\n  objects:\n'
> bin/series 64 '    - mesh: {file: painted.obj, position: [0.%d, 0.3, 0], collide: true, cells: 16, paint: {size: 16}}\n'; } >painted.yaml
> kiln bake painted.yaml -q -o states --every 4 --device cpu
> kiln render painted.yaml -q -o painted.png --frames 8 --device cpu --stats | grep -w state >whole
> kiln render painted.yaml -q -o painted.png --force --frames 8 --device cpu --states states --stats | grep -w state | diff whole -

Lights, of which shapes hide each:

$ lights() { printf 'kiln: 1\noutput: {size: [64, 36], frames: 9}\nsystems:\n  fire: {emit: {rate: 600}, look: {light: [9, 4, 1], lights: 16}}\nbackdrop:\n  objects: [box: {center: [0, 1, 0]}, sphere: {center: [2, 1, 0]}]\n  lights:\n'; bin/series "$1" '    - point: {position: [%d, 3, 2], color: [1, 2, 3]}\n'; }
> lights 64 >64.yaml; lights 65 >65.yaml; bin/states 64.yaml; kiln check 65.yaml
1|  state        0f9c365d2b086fba
2|65.yaml:8:5: backdrop.lights: found 65 entries; at most 64 are allowed
= 3
$ kiln render 64.yaml -q -o none --frames 0 --device software --technique simulate=pingpong
2|kiln: backdrop.lights: found 64 lights; the technique simulate=pingpong takes at most 16: use simulate=inplace
= 2

Software GL ends the loops of an invocation silently, so that many objects with many lights are an error:

$ many() { sed '/systems:/,/rain:/d; /lights:/d; s/96, 54/48, 27/; s/^simulation.*/systems: {still: {emit: {rate: 0}}}/' 256.yaml; echo '  lights:'; bin/series "$1" '    - point: {position: [%d, 3, 2], color: [1, 2, 3]}\n'; }
> many 47 >47.yaml; bin/states 47.yaml; many 48 >48.yaml; kiln render 48.yaml -q -o none --frames 0 --device software --technique backdrop=gl
1|  state        0000000000000000
2|kiln: backdrop=gl: 256 objects and 48 lights take 66455 iterations a pixel; software GL runs at most 65535: use --technique backdrop=cpu, or fewer objects or lights
= 5

What particles are born on:

$ printf 'kiln: 1\noutput: {size: [2048, 1024], frames: 1}\nbackdrop: {sky: {top: 1, horizon: 1}, floor: none}\n' >white.yaml
> kiln render white.yaml -q -o at.png --device cpu; kiln render white.yaml -q --size 2048x1025 -o over.png --device cpu
> printf 'kiln: 1\noutput: {size: [32, 18], frames: 2}\nsystems:\n  dots:\n    emit: {rate: 600, from: {image: {file: at.png, threshold: 0}}}\n    look: {shape: point, size: 3 cm, color: source}\n' >at.yaml
> bin/states at.yaml; kiln check at.yaml --set systems.dots.emit.from.image.file=over.png
> { cat at.yaml; echo '  more: {emit: {from: {path: {points: [[0, 0, 0], [1, 0, 0]]}}}}'; } >more.yaml; kiln check more.yaml
1|  state        fa523aafc3b7fb35
2|--set systems.dots.emit.from.image.file: 2099200 pixels of the image are above the threshold; a scene has at most 2097152
2|more.yaml:7:30: systems.more.emit.from.path: triangles, vertices and pixels that particles are born on are 2097280 altogether; a scene has at most 2097152
= 3

Particles; OpenGL takes half as many. unit.sizes steps and draws them:

$ printf 'kiln: 1\noutput: {size: [32, 18]}\nsystems:\n  dust: {emit: {bursts: {0 s: 33554432}}}\n' >dust.yaml
> kiln check -q dust.yaml; { cat dust.yaml; echo '  more: {emit: {rate: 1}}'; } >more.yaml; kiln check more.yaml
2|more.yaml:5:16: systems.more.emit: up to 2 particles at once need 0 MiB; the systems of a scene may have 33554432 in all (1024 MiB), of which 33554432 are taken: lower rate, bursts or life
= 3
$ kiln render dust.yaml -q -o none --frames 0 --device software --technique raster=geometry
2|kiln: systems: found up to 33554432 particles at once; OpenGL takes at most 16777216: use the device cpu
= 2
