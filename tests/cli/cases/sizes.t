The largest scenes. At each limit the state is the same with OpenGL and without; one more is an error.

$ mkdir bin; cat >bin/series <<'END'
> #!/bin/sh
> for i in $(seq "$1"); do printf "$2" "$i"; done
> END
$ cat >bin/states <<'END'
> #!/bin/sh
> kiln render "$@" -q -o none --frames 1 --stats --device cpu | grep state >cpu
> kiln render "$@" -q -o none --frames 1 --stats --device software --technique simulate=inplace --technique sort=radix \
>     --technique backdrop=gl --technique raster=geometry --technique bloom=gl --technique composite=gl | grep state | diff cpu - &&
>     cat cpu
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
