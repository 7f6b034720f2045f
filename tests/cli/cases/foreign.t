Options as other programs spell them: the message names kiln's.

$ for option in -y --overwrite --out=x.png --output-dir --resolution --res -r '-framerate 30' -crf -ss --verbose --workers; do kiln render scenes/tiny.yaml $option; done
2|kiln: render: unknown option '-y' (did you mean '--force'?)
2|kiln: render: unknown option '--overwrite' (did you mean '--force'?)
2|kiln: render: unknown option '--out' (did you mean '--output'?)
2|kiln: render: unknown option '--output-dir' (did you mean '--output'?)
2|kiln: render: unknown option '--resolution' (did you mean '--size'?)
2|kiln: render: unknown option '--res' (did you mean '--size'?)
2|kiln: render: unknown option '-r' (did you mean '--fps'?)
2|kiln: render: unknown option '-framerate' (did you mean '--fps'?)
2|kiln: render: unknown option '-crf' (did you mean '--quality'?)
2|kiln: render: unknown option '-ss'; '--frames' chooses frames, such as --frames 10- from frame 10 on
2|kiln: render: unknown option '--verbose' (did you mean '--stats'?)
2|kiln: render: unknown option '--workers' (did you mean '--threads'?)
= 2

Blender's and husk's, which choose frames otherwise.

$ for option in -b -s -e -f -a -j -F -x -t -E --background --frame-start --frame-end --render-frame --render-anim --render-output --render-format --frame --frame-count --frame-inc; do kiln render scenes/tiny.yaml $option; done
2|kiln: render: unknown option '-b'; kiln always works without a window
2|kiln: render: unknown option '-s'; '--size WxH' sets the size; '--frames' chooses frames
2|kiln: render: unknown option '-e'; '--frames' chooses frames, such as --frames -50 up to frame 50
2|kiln: render: unknown option '-f'; '--frames' chooses frames, and the suffix of '--output' the format
2|kiln: render: unknown option '-a'; kiln draws every frame unless '--frames' chooses some
2|kiln: render: unknown option '-j'; '--frames 0-100/10' draws every tenth frame
2|kiln: render: unknown option '-F'; the suffix of '--output' chooses the format (see 'kiln help outputs')
2|kiln: render: unknown option '-x'; the suffix of '--output' chooses the format (see 'kiln help outputs')
2|kiln: render: unknown option '-t'; '--threads N' sets the number of threads; '--frames' sets the length of a clip
2|kiln: render: unknown option '-E' (did you mean '--technique'?)
2|kiln: render: unknown option '--background'; kiln always works without a window
2|kiln: render: unknown option '--frame-start'; '--frames' chooses frames, such as --frames 10- from frame 10 on
2|kiln: render: unknown option '--frame-end'; '--frames' chooses frames, such as --frames -50 up to frame 50
2|kiln: render: unknown option '--render-frame'; '--frames' chooses frames, such as --frames 10-50
2|kiln: render: unknown option '--render-anim'; kiln draws every frame unless '--frames' chooses some
2|kiln: render: unknown option '--render-output' (did you mean '--output'?)
2|kiln: render: unknown option '--render-format'; the suffix of '--output' chooses the format (see 'kiln help outputs')
2|kiln: render: unknown option '--frame' (did you mean '--frames'?)
2|kiln: render: unknown option '--frame-count'; '--frames' chooses frames, such as --frames 10-50
2|kiln: render: unknown option '--frame-inc'; '--frames 0-100/10' draws every tenth frame
= 2

A row counts only where the command has what it names, and its own options come first.

$ kiln devices --overwrite; kiln plan scenes/tiny.yaml --frame x; kiln check scenes/tiny.yaml -t 4; kiln compare a b -y; kiln check --version
2|kiln: devices: unknown option '--overwrite' (did you mean '--force'?)
2|kiln: plan: --frame: found 'x', expected a whole number from 0 to 4294967295
2|kiln: check: unknown option '-t'
2|kiln: compare: unknown option '-y' (did you mean '--force'?)
2|kiln: check: unknown option '--version'; 'kiln --version' prints the version
= 2

Letters share one dash; the last may have a value, in the same word or the next.

$ kiln render scenes/tiny.yaml -qo a.png --frames 3 && kiln render scenes/tiny.yaml -qob.png --frames 3 && cmp a.png b.png && ls
1|a.png
1|b.png
1|scenes
$ kiln render scenes/tiny.yaml -qh | head -1
1|usage: kiln render [OPTION...] SCENE...
$ kiln test list -lh | head -1
1|usage: kiln test list [OPTION...] [PATH | NAME]...

A letter that is no option is named, and nothing of its bundle counts.

$ kiln render scenes/tiny.yaml -qzo c.png
2|kiln: render: unknown option '-z' in '-qzo'
= 2
$ kiln render scenes/tiny.yaml -qyo c.png
2|kiln: render: unknown option '-y' in '-qyo' (did you mean '--force'?)
= 2
$ kiln render scenes/tiny.yaml -hz
2|kiln: render: unknown option '-z' in '-hz'
= 2
$ kiln render scenes/tiny.yaml -qo
2|kiln: render: --output: needs a value, FILE
= 2
$ kiln render scenes/tiny.yaml -qquiet
2|kiln: render: unknown option '-qquiet' (did you mean '--quiet'?)
= 2

A scene without a command, and colours as elsewhere.

$ kiln scenes/tiny.yaml -o x.mp4
2|kiln: a command is missing: 'kiln render scenes/tiny.yaml' renders a scene
= 2
$ for color in red '#ff0000' 0xff0000 "'#ff0000'"; do kiln check -q scenes/tiny.yaml --set "backdrop.floor.color=$color"; done
2|--set backdrop.floor.color: expected [red, green, blue] or one number for grey, linear, each from 0 to 1, or in sRGB "#e61e28", "#abc" or a name of CSS, or {keys: {time: value}}, found '0xff0000'

$ for option in -c --camera --samples --snapshot; do kiln render scenes/tiny.yaml $option; done; kiln compare a b --out
2|kiln: render: unknown option '-c'; a scene has one camera, such as '--set camera.position=[0,1,5] --set camera.target=[0,1,0]'
2|kiln: render: unknown option '--camera'; a scene has one camera, such as '--set camera.position=[0,1,5] --set camera.target=[0,1,0]'
2|kiln: render: unknown option '--samples'; '--set camera.shutter.samples=16' sets the number of samples in the shutter's time
2|kiln: render: unknown option '--snapshot'; '--resume' keeps whole files and goes on from there
2|kiln: compare: unknown option '--out'; the output is an operand, or another option sets it ('--help')
= 2
