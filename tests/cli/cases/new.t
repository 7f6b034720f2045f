A scene to begin with: checked, drawn, and with the schema for editors in its first line.

$ kiln new effect.yaml && head -n 2 effect.yaml | sed 's|=.*/|=FOLDER/|' && kiln check -q effect.yaml
1|effect.yaml: a scene to begin with; render it by: kiln render effect.yaml -o clip.mp4
1|# yaml-language-server: $schema=FOLDER/scene.schema.json
1|# A fire on logs: flames, smoke above them and sparks.
$ test -f "$(sed -n '1s/.*schema=//p' effect.yaml)" && kiln help schema | cmp - "$(sed -n '1s/.*schema=//p' effect.yaml)"
$ kiln new effect.yaml -t snow; echo $?; kiln new effect.yaml -qt snow --force && sed -n 2p effect.yaml
1|2
1|# Snow that falls on hills at dusk, past a lamp, in air that eddies.
2|kiln: effect.yaml: the file exists (--force replaces it)
$ kiln new below/a/folder.yaml -q && ls below/a
1|folder.yaml
$ kiln new below
2|kiln: below: a folder has this name
= 2
$ kiln new - --template smoke | kiln check -q -
$ kiln new x.yaml --template snwo
2|kiln: new: --template: there is no template 'snwo' (did you mean 'snow'?); there are campfire, fire, fireball, fog, fountain, plume, smoke, snow, steam
= 2
$ kiln new
2|kiln: new: needs SCENE
= 2
$ kiln new x.yaml y.yaml
2|kiln: new: one operand too many, 'y.yaml'
= 2
$ ls
1|below
1|effect.yaml
1|scenes

Every template renders as it is, and its particles show, or its gas, which is coarse here.

$ for name in $(kiln help templates | sed -nE 's/^  ([a-z]+) .*/\1/p'); do kiln new $name.yaml -qt $name && what=systems && coarse= && if grep -q "^gas:" $name.yaml; then what=gas; coarse="--set gas.*.cells=32 --set gas.*.detail=1"; fi; for enabled in true false; do kiln render $name.yaml -qo $name.$enabled.png --size 96x54 --frames 2 $coarse --set "$what.*.enabled=$enabled"; done; cmp -s $name.true.png $name.false.png || echo $name; done
1|campfire
1|fire
1|fireball
1|fog
1|fountain
1|plume
1|smoke
1|snow
1|steam
