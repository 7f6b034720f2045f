What is drawn of particles that remember their ways: the same with OpenGL and without.

$ cat >alike <<'END'
> #!/bin/sh
> kiln render "$@" -q -o cpu.png --force --device cpu
> for raster in geometry tiled; do
>     kiln render "$@" -q -o gl.png --force --device software --technique backdrop=gl --technique raster=$raster
>     kiln compare -q cpu.png gl.png || echo "raster=$raster: the pictures differ"
> done
> END
$ chmod +x alike

Spins of two systems, with the ways of the first between them:

$ cat >spins.yaml <<'END'
> kiln: 1
> output: {size: [192, 108], frames: 60}
> camera: {position: [0, 1, 3.4], target: [0, 0.6, 0]}
> backdrop: {floor: {height: 0 m}}
> systems:
>   balls: &balls
>     emit: {bursts: {0 s: 20}, life: 9 s, speed: 1, from: {box: {origin: [-0.6, 1, 0], size: [0.8, 0.8, 0.8]}}}
>     forces: [gravity: {}]
>     interact: [collide: {radius: 12 cm, spin: true}]
>     collide: {friction: 0.5}
>     look: {shape: sphere, size: 24 cm, color: [0.8, 0.2, 0.1], sphere: {pattern: stripe, color: white}}
>   others:
>     <<: *balls
>     emit: {bursts: {0 s: 20}, life: 9 s, speed: 1, from: {box: {origin: [0.6, 1, 0], size: [0.8, 0.8, 0.8]}}}
>   beads:
>     emit: {parent: {system: balls, on: {trail: {per_metre: 20, most: 60}}}, life: 9 s, speed: 0}
>     look: {shape: sphere, size: 3 cm}
> END
$ ./alike spins.yaml --frames 40

Pictures of particles that have stopped turning:

$ cat >stuck.yaml <<'END'
> kiln: 1
> output: {size: [192, 108], frames: 60}
> camera: {position: [0, 1, 3.4], target: [0, 0.6, 0]}
> backdrop: {floor: {height: 0 m}}
> systems:
>   flakes:
>     emit: {rate: 60, life: 9 s, speed: 1, from: {box: {origin: [-0.5, 1, 0], size: [1, 0.2, 1], direction: [0, -1, 0]}}}
>     collide: {then: stick}
>     look: {atlas: "builtin:spark", size: 0.3 m, stretch: 0.1 s, spin: 200 deg/s}
>   cubes:
>     emit: {rate: 20, life: 9 s, speed: 1, from: {box: {origin: [0.7, 1, 0], size: [0.6, 0.2, 1], direction: [0, -1, 0]}}}
>     collide: {then: stop}
>     look: {shape: mesh, mesh: {file: tetrahedron.obj}, size: 0.3 m, spin: 200 deg/s}
>   pearls:
>     emit: {rate: 20, life: 9 s, speed: 1, from: {box: {origin: [0, 1, 1], size: [1, 0.2, 0.3], direction: [0, -1, 0]}}}
>     collide: {then: stop}
>     look: {shape: sphere, size: 0.2 m, spin: 200 deg/s, sphere: {pattern: segments}}
> END
$ printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >tetrahedron.obj
$ ./alike stuck.yaml --frames 50

Looks of parents, most of which are dead, also at moments between two steps:

$ cat >looks.yaml <<'END'
> kiln: 1
> output: {size: [192, 108], frames: 60}
> camera: {position: [0, 1, 3.4], target: [0, 0.8, 0], shutter: {samples: 3}}
> systems:
>   before: {emit: {rate: 30}}
>   shell:
>     emit: {rate: 40, life: [0.2 s, 0.4 s], speed: [1, 4], from: {cone: {angle: 60 deg}}}
>     look:
>       size: {life: [10 cm, 30 cm], times: {random: [0.5, 1]}}
>       color: {choose: [red, lime, blue], weights: [1, 2, 1]}
>       temperature: {age: {0 s: 1000, 0.4 s: 3000}}
>   balls:
>     emit: {parent: {system: shell, on: {death: 4}, inherit: {color: true, size: true}}, life: 1 s, speed: 2}
>     look: {shape: sphere, scale: 0.4}
>   cubes:
>     emit: {parent: {system: shell, on: {trail: 9}, inherit: {color: true, size: true}}, life: 1 s, speed: 2}
>     look: {shape: mesh, mesh: {file: tetrahedron.obj}, scale: 0.5}
>   smoke:
>     emit: {parent: {system: shell, on: {trail: {per_metre: 9, most: 20}}, inherit: {color: true}}, life: 1 s, speed: 1}
>     look: {size: 0.3 m, opacity: {life: [0.6, 0]}, lit: 0.5}
>   fire:
>     emit: {parent: {system: shell, on: {death: 6}, inherit: {temperature: true}}, life: 1 s, speed: 1}
>     look: {atlas: "builtin:spark", blend: add, size: 0.2 m, intensity: 9}
> END
$ ./alike looks.yaml --frames 50
