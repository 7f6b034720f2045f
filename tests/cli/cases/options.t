Every way to write an option wrongly: what was found, what is allowed, exit 2.

$ kiln render scenes/tiny.yaml
2|kiln: render: needs --output FILE; '--output none' writes nothing
= 2
$ kiln render -o x.png
2|kiln: render: needs SCENE...
= 2
$ kiln render scenes/tiny.yaml -o x.png --frame 0
2|kiln: render: unknown option '--frame' (did you mean '--frames'?)
= 2
$ kiln render scenes/tiny.yaml -output x.png --frames 0
2|kiln: render: unknown option '-output' (did you mean '--output'?)
= 2
$ kiln render scenes/tiny.yaml -x
2|kiln: render: unknown option '-x'; the suffix of '--output' chooses the format (see 'kiln help outputs')
= 2
$ kiln render scenes/tiny.yaml -quiet
2|kiln: render: unknown option '-quiet' (did you mean '--quiet'?)
= 2
$ kiln render scenes/tiny.yaml -o
2|kiln: render: --output: needs a value, FILE
= 2
$ kiln render scenes/tiny.yaml --output
2|kiln: render: --output: needs a value, FILE
= 2
$ kiln render scenes/tiny.yaml --output --force
2|kiln: render: --output: needs a value, FILE, found '--force' (a value that looks like an option is joined: --output=--force)
= 2
$ kiln render scenes/tiny.yaml --output=
2|kiln: render: --output: found '', expected FILE
= 2
$ kiln render scenes/tiny.yaml --quiet=yes -o x.png
2|kiln: render: --quiet: takes no value, found 'yes'
= 2
$ kiln render scenes/tiny.yaml -o x.png --frames 5-3
2|kiln: render: --frames: found '5-3', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
= 2
$ kiln render scenes/tiny.yaml -o x.png --frames 1,,2
2|kiln: render: --frames: found '' in '1,,2', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
= 2
$ kiln render scenes/tiny.yaml -o x.png --frames 99999999999999999999
2|kiln: render: --frames: found '99999999999999999999', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
= 2
$ kiln render scenes/tiny.yaml -o x.png --frames ''
2|kiln: render: --frames: found '', expected frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10
= 2
$ kiln render scenes/tiny.yaml -o x.png --frames 0-2,24
2|kiln: render: --frames: found frame 24, but 'scenes/tiny.yaml' has frames 0-23
= 2
$ kiln render scenes/tiny.yaml -o x.png --size 64
2|kiln: render: --size: found '64', expected WxH in pixels, such as 1280x720
= 2
$ kiln render scenes/tiny.yaml -o x.png --size 0x36
2|kiln: render: --size: found '0x36', expected WxH in pixels, such as 1280x720
= 2
$ kiln render scenes/tiny.yaml -o x.png --size 64x36x2
2|kiln: render: --size: found '64x36x2', expected WxH in pixels, such as 1280x720
= 2
$ kiln render scenes/tiny.yaml -o x.png --size 64X36
2|kiln: render: --size: found '64X36', expected WxH in pixels, such as 1280x720
= 2
$ kiln render scenes/tiny.yaml -o x.png --fps 0
2|kiln: render: --fps: found '0', expected a rate such as 30, 29.97 or 30000/1001
= 2
$ kiln render scenes/tiny.yaml -o x.png --fps 30/0
2|kiln: render: --fps: found '30/0', expected a rate such as 30, 29.97 or 30000/1001
= 2
$ kiln render scenes/tiny.yaml -o x.png --fps fast
2|kiln: render: --fps: found 'fast', expected a rate such as 30, 29.97 or 30000/1001
= 2
$ kiln render scenes/tiny.yaml -o x.png --seed -1
2|kiln: render: --seed: found '-1', expected a whole number from 0 to 4294967295
= 2
$ kiln render scenes/tiny.yaml -o x.png --seed 4294967296
2|kiln: render: --seed: found '4294967296', expected a whole number from 0 to 4294967295
= 2
$ kiln render scenes/tiny.yaml -o x.png --set seed
2|kiln: render: --set: found 'seed', expected KEY=VALUE
= 2
$ kiln render scenes/tiny.yaml -o x.png --set =7
2|kiln: render: --set: found '=7', expected KEY=VALUE
= 2
$ kiln render scenes/tiny.yaml -o x.png --technique cpu
2|kiln: render: --technique: found 'cpu', expected STAGE=NAME
= 2
$ kiln render scenes/tiny.yaml -o x.png --technique simulate=cpu,
2|kiln: render: --technique: found 'simulate=cpu,', expected STAGE=NAME
= 2
$ kiln render scenes/tiny.yaml -o x.png --threads 257
2|kiln: render: --threads: found '257', expected a whole number from 0 to 256
= 2
$ kiln render scenes/tiny.yaml -o x.png --threads two
2|kiln: render: --threads: found 'two', expected a whole number from 0 to 256
= 2
$ kiln render scenes/tiny.yaml -o x.png --png-bits 12
2|kiln: render: --png-bits: found '12', expected one of 8|16
= 2
$ kiln render scenes/tiny.yaml -o x.png --exr-bits 8
2|kiln: render: --exr-bits: found '8', expected one of 16|32
= 2
$ kiln render scenes/tiny.yaml -o x.png --quality 101
2|kiln: render: --quality: found '101', expected a whole number from 0 to 100
= 2
$ kiln render scenes/tiny.yaml -o x.png --frame-timeout 0
2|kiln: render: --frame-timeout: found '0', expected a time from 0.001 s to 86400 s, as a number of seconds or in ms, s, min or h
= 2
$ kiln render scenes/tiny.yaml -o x.png --frame-timeout nan
2|kiln: render: --frame-timeout: found 'nan', expected a time from 0.001 s to 86400 s, as a number of seconds or in ms, s, min or h
= 2
$ kiln render scenes/tiny.yaml -o x.png --progress bar
2|kiln: render: --progress: found 'bar', expected one of tty|lines|ndjson|none
= 2
$ kiln render scenes/tiny.yaml -o x.png --stats=xml
2|kiln: render: --stats: found 'xml', expected one of text|json
= 2
$ kiln render scenes/tiny.yaml -o x.png --device=
2|kiln: render: --device: found '', expected DEVICE
= 2
$ kiln render scenes/tiny.yaml -o x.png --asset-root=
2|kiln: render: --asset-root: found '', expected FOLDER
= 2
$ kiln render scenes/tiny.yaml -o x.png --manifest=
2|kiln: render: --manifest: found '', expected FILE
= 2
$ kiln check scenes/tiny.yaml --jsn
2|kiln: check: unknown option '--jsn'
= 2
$ kiln devices --jsn
2|kiln: devices: unknown option '--jsn' (did you mean '--json'?)
= 2

Nothing was written.

$ ls
1|scenes
