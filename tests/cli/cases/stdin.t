A scene comes through standard input: `-` is its name, and its files lie below the working directory.

$ cd scenes && kiln check - <tiny.yaml | diff - <(kiln check tiny.yaml) && cat tiny.yaml | kiln check --hash - && kiln check --hash /dev/stdin <tiny.yaml && kiln check --hash <(cat tiny.yaml) && kiln check --hash tiny.yaml
1|61f7a9567872296c542203e240af47c9fac1afc1f0618e3f85e06e11d78bb4ee
1|61f7a9567872296c542203e240af47c9fac1afc1f0618e3f85e06e11d78bb4ee
1|61f7a9567872296c542203e240af47c9fac1afc1f0618e3f85e06e11d78bb4ee
1|61f7a9567872296c542203e240af47c9fac1afc1f0618e3f85e06e11d78bb4ee
$ kiln check - <scenes/tiny.yaml
2|standard input:19:19: systems.smoke.look.atlas: cannot open 'puff.png': No such file or directory; a path starts at the scene's folder, or at the asset root that is given instead
= 3
$ kiln check /dev/stdin --asset-root scenes -q <scenes/tiny.yaml
$ cat scenes/tiny.yaml | kiln check - --asset-root scenes --hash scenes/empty.yaml | cut -c 65-
1|  -
1|  scenes/empty.yaml

Errors name it, with the place.

$ printf 'kiln: 1\nsystems:\n  fire: {emti: {}}\n' | kiln check -
2|standard input:3:10: systems.fire.emti: unknown key (did you mean 'emit'?)
= 3
$ printf 'kiln: 1\nsystems:\n  fire: {emti: {}}\n' | kiln check /dev/stdin
2|/dev/stdin:3:10: systems.fire.emti: unknown key (did you mean 'emit'?)
= 3
$ kiln check - </dev/null
2|standard input: the file is empty; a scene starts with 'kiln: 1'
= 3
$ kiln check - <&-
2|kiln: standard input: the scene cannot be read: Bad file descriptor
= 6
$ kiln check - </
2|kiln: standard input: the scene cannot be read: Is a directory
= 6
$ head -c 5000000 /dev/zero | tr '\0' '#' | kiln check -
2|standard input: the scene file has 4194305 bytes; at most 4194304 are allowed
= 3
$ kiln check - /dev/stdin </dev/null
2|kiln: check: /dev/stdin can be read only once
= 2
$ kiln render - - -o none </dev/null
2|kiln: render: standard input can be read only once
= 2

Jobs take it, too.

$ cd scenes && kiln render - -qo ../a.png --frames 3 <tiny.yaml && kiln render tiny.yaml -qo ../b.png --frames 3 && cmp ../a.png ../b.png
$ cd scenes && kiln render - -o '../{scene}.mkv' --frames 3 --progress none <tiny.yaml && kiln render /dev/stdin -qo .. --frames 3 <tiny.yaml && ls ..
1|device: <device>
1|../stdin.mkv: 1 frame in <s> s
1|a.png
1|b.png
1|scenes
1|stdin.mkv
1|stdin.mp4
$ cd scenes && kiln render - -o '../r.mkv' -q --resume <tiny.yaml && kiln render - -o '../r.mkv' --resume --progress none <tiny.yaml
1|device: <device>
1|../r.mkv: 0 frames in <s> s, 24 kept
$ cd scenes && for sandbox in on off; do kiln render - -qo ../c_$sandbox.png --frames 3 --sandbox=$sandbox <tiny.yaml; done; cmp ../b.png ../c_on.png && cmp ../b.png ../c_off.png
$ kiln render - -qo d.png --frames 3 --sandbox --asset-root scenes <scenes/tiny.yaml && cmp b.png d.png
$ cd scenes && kiln plan - <tiny.yaml | head -1 && kiln bake - -q -o ../states <tiny.yaml && ls ../states | wc -l
1|-: 1 part of 60 frames, motion a37c7513dbddf799
1|1
$ kiln render - -qo e.png --timeout 0.3 < <(sleep 3) 2>/dev/null
= 8
