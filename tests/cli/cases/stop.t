A signal leaves only whole files behind. The scene is long enough to be stopped half-way.

$ cat >stop <<'END'
> # stop SIGNAL OUTPUT: starts a render, waits for its third frame, sends the signal.
> mkfifo frames
> env --default-signal kiln render scenes/tiny.yaml --set output.frames=100000 -o "$2" --json >frames &
> job=$!
> exec 3<frames
> for line in 1 2 3 4; do read -r -u 3; done
> cat <&3 >/dev/null &
> kill -"$1" $job
> wait $job
> code=$?
> rm frames
> exit $code
> END
> chmod +x stop
$ mkdir term && bash stop TERM term/frame_%d.png
2|kiln: scenes/tiny.yaml: stopped by SIGTERM after <n> frames
= 143
$ [ "$(ls term | wc -l)" -ge 3 ] || ls term
$ ls -A term | grep -v '^frame_[0-9]*\.png$'
= 1
$ for file in term/*; do tail -c 8 $file | od -An -tx1; done | sort -u
1| 49 45 4e 44 ae 42 60 82
$ mkdir int && bash stop INT int/clip.mp4; code=$?; find int -type f; exit $code
2|kiln: scenes/tiny.yaml: stopped by SIGINT after <n> frames
= 130
$ for suffix in webm mkv mov gif apng webp; do bash stop TERM clip.$suffix; done; find . -name '*clip*'
2|kiln: scenes/tiny.yaml: stopped by SIGTERM after <n> frames
2|kiln: scenes/tiny.yaml: stopped by SIGTERM after <n> frames
2|kiln: scenes/tiny.yaml: stopped by SIGTERM after <n> frames
2|kiln: warning: clip.gif: GIF counts times in 1/100 s; at 30 frames a second, frames last 0.03 or 0.04 s, on average 0.0333 s
2|kiln: scenes/tiny.yaml: stopped by SIGTERM after <n> frames
2|kiln: scenes/tiny.yaml: stopped by SIGTERM after <n> frames
2|kiln: scenes/tiny.yaml: stopped by SIGTERM after <n> frames
$ mkdir hup && bash stop HUP hup/clip.mp4; code=$?; find hup -type f; exit $code
2|kiln: scenes/tiny.yaml: stopped by SIGHUP after <n> frames
= 129

A library that ends the program by abort() leaves no unfinished file, either, and the message names the signal.

$ mkdir abort && bash stop ABRT abort/clip.mp4; code=$?; find abort -type f; exit $code
2|kiln: ended by SIGABRT; perhaps the machine is short of memory; unfinished files are discarded
= 5

The stack gets its memory when the program starts, so that its lack has a message.

$ (ulimit -s 512; kiln render scenes/tiny.yaml -o small_stack.png)
2|kiln: the stack may have 512 KiB (ulimit -s); needed are 1024 KiB
= 5

A job that cannot answer is ended half a second after the signal: here nobody reads its progress, so that
it waits for ever. Then files in the making are removed, too.

$ mkdir twice && mkfifo frames
> kiln render scenes/tiny.yaml --set output.frames=100000 -o twice/%d.png --json >frames &
> job=$!
> exec 3<frames
> count=0
> until [ $count -gt 0 ] && [ $count = "$(ls twice | wc -l)" ]; do
>     count=$(ls twice | wc -l)
>     sleep 2
> done
> kill -TERM $job
> wait $job
2|kiln: stopped by SIGTERM; unfinished files are discarded
= 143
$ ls -A twice | grep -v '^[0-9]*\.png$'
= 1

Nor does it wait for who reads its errors.

$ mkfifo errors && exec 4<>errors
> kiln render scenes/tiny.yaml --set output.frames=100000 -o stuck.mp4 --progress lines --events ndjson:told 2>errors &
> job=$!
> head -c 70000 /dev/zero | timeout 1 tee errors >/dev/null
> kill -TERM $job
> wait $job
1|device: <device>
= 143
$ exec 4<&-; find . -name '*stuck*'; tail -n 2 told | jq -c '[.event, .code, .again]'
1|["error",143,"again"]
1|["ended",143,"again"]

A second signal ends it at once, and its events say so.

$ mkfifo full && exec 4<>full; head -c 65536 /dev/zero >&4
> kiln render scenes/tiny.yaml -q --set output.frames=100000 -o again.mp4 --events ndjson:again 2>full &
> job=$!
> until grep -qs '"frame"' again; do sleep 0.1; done
> kill -TERM $job; sleep 0.2; kill -TERM $job; wait $job
= 143
$ tail -n 2 again | jq -c '[.event, .code, .message]'; find . -name '*again.mp4*'
1|["error",143,"stopped by SIGTERM; unfinished files are discarded"]
1|["ended",143,null]

Another's alarm is no signal of ours, and ends it as it ends any program.

$ kiln render scenes/tiny.yaml -q --set output.frames=100000 -o alarm.mp4 & job=$!; sleep 0.5; kill -ALRM $job; wait $job 2>/dev/null
= 142
$ find . -name '*alarm*'

A frame that takes long is given up, too.

$ kiln render scenes/tiny.yaml -q -o huge.png --frames 0 --device cpu --threads 1 --size 4096x4096 \
> --set camera.shutter.samples=64 --set simulation.rate=3840 &
> job=$!
> sleep 1; kill -TERM $job; wait $job
2|kiln: scenes/tiny.yaml: stopped by SIGTERM after <n> frames
= 143
$ find . -name '*huge*'

A frame over its limit, and a device that does not open in time. Nothing half-written is left.

$ kiln render scenes/tiny.yaml -q -o late.mp4 --device cpu --frame-timeout 2 --set systems.smoke.emit.rate=1000000 --set 'simulation.warmup=4000 s'
2|kiln: scenes/tiny.yaml: frame 0 took longer than its limit of 2 s (--frame-timeout)
= 5
$ kiln render scenes/tiny.yaml -q -o late.mp4 --device software --frame-timeout 0.001 2>&1 | sed -E 's/(opening the device|loading the scenes|loading .*yaml)/.../'; echo ${PIPESTATUS[0]}
1|kiln: ... took longer than its limit of 0.001 s (--frame-timeout)
1|5
$ kiln render - -q -o late.mp4 --frame-timeout 0.1 < <(sleep 2)
2|kiln: loading standard input took longer than its limit of 0.1 s (--frame-timeout)
= 5
$ find . -name '*late*'
$ kiln render scenes/tiny.yaml -q -o intime.png --frames 0 --frame-timeout 100 && ls intime.png
1|intime.png
