A figure needs a kind, something to show and a place.
$ kiln figure
2|kiln: figure: an operand is missing: sheet, triptych or strip; or give --check FIGURE or --update FIGURE
= 2
$ kiln figure shet
2|kiln: figure: unknown figure 'shet' (did you mean 'sheet'?); allowed are sheet, triptych and strip
= 2
$ kiln figure sheet -o a.png
2|kiln: figure sheet: needs SCENE...
= 2
$ kiln figure sheet scenes/tiny.yaml
2|kiln: figure sheet: needs --output FILE
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.bmp
2|kiln: figure sheet: a.bmp: the name of a figure must end in .png, .jpg, .jpeg, .svg or .pdf
= 2
$ kiln figure sheet scenes/none.yaml -o a.png
2|scenes/none.yaml: No such file or directory
= 3
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep rate
2|kiln: figure sheet: --sweep: found 'rate', expected KEY=VALUE,...
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep seed=
2|kiln: figure sheet: --sweep: found 'seed='; expected KEY=VALUE,VALUE,...
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep systems.*.emit.raet=1,2
2|--set systems.*.emit.raet: systems.smoke.emit.raet: unknown key (did you mean 'rate'?)
= 3
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep seed=1,2 --with fps=1
2|kiln: figure sheet: --with fps=1: found 1 values; expected as many as --sweep seed=1,2 before it has, 2
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --with seed=1
2|kiln: figure sheet: --with seed=1: there is no --sweep before it
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --variant 'seed=1;x'
2|kiln: figure sheet: --variant: found 'seed=1;x'; expected KEY=VALUE;KEY=VALUE...
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep frame=3,99
2|kiln: figure sheet: frame 99: 'scenes/tiny.yaml' has frames 0-23
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep frame=0.5
2|kiln: figure sheet: --sweep frame=0.5: found '0.5'; expected the number of a frame
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep frame=1,2 --frames 3
2|kiln: figure sheet: --frames: not allowed with --sweep frame=1,2, which chooses frames itself
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep time=soon
2|kiln: figure sheet: --sweep time=soon: found 'soon'; expected seconds, such as 1.5
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --inset 1,2,3
2|kiln: figure sheet: --inset: found '1,2,3'; expected X,Y,WxH in pixels or in parts, such as 320,180,160x90 or 0.4,0.25,0.2x0.2
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --inset 0,0,1x36 --inset 0,0,64x1
2|kiln: figure sheet: --inset: found 2 insets that are too flat to be shown below a picture of 64 pixels
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --title "$(printf '%030000d' 0)" --inset 0,0,1x36 && rm a.png*
$ kiln figure sheet - -o a.png <scenes/tiny.yaml
2|kiln: figure sheet: standard input is not allowed: a figure is drawn again from its files
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --alt "$(printf '%065534d' 0)"
2|kiln: figure sheet: --alt: found 65534 bytes; allowed are 65533
= 2
$ kiln figure --update -q a.png
2|kiln: figure: --update: needs a value, FIGURE, found '-q' (a value that looks like an option is joined: --update=-q)
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --inset 60,30,10x10
2|kiln: figure sheet: --inset 60,30,10x10: found a part that is not in a picture of 64 x 36
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --inset 0.5,0.5,0.2x0.2 --inset 0.9,0.5,0.2x0.2 --device none
2|kiln: figure sheet: --inset 0.9,0.5,0.2x0.2: found a part that is not in a picture of 64 x 36
= 2
$ kiln figure triptych scenes/puff.png scenes/puff.png -o a.png --inset 30,0,10x10
2|kiln: figure triptych: --inset 30,0,10x10: found a part that is not in a picture of 32 x 32
= 2
$ kiln figure strip scenes/puff.png -o a.png --count 1 --inset 30,0,10x10
2|kiln: figure strip: --inset 30,0,10x10: found a part that is not in a picture of 32 x 32
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --plain --title T
2|kiln: figure sheet: --plain leaves no room for a title or labels
= 2
$ kiln figure triptych scenes/puff.png scenes/puff.png -o scenes/../scenes/puff.png --force
2|kiln: figure triptych: scenes/../scenes/puff.png: the figure would replace a file that it is made of, which this command reads
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep seed=1,2 --label one
2|kiln: figure sheet: found 1 labels where 2 are needed
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --text-size 4
2|kiln: figure sheet: --text-size: found '4'; expected 4pt to 72pt on paper, or 8 to 64 pixels
= 2
$ kiln figure strip scenes/tiny.yaml -o a.png --count 0
2|kiln: figure strip: --count: found '0', expected a whole number from 1 to 1024
= 2
$ kiln figure triptych scenes/puff.png -o a.png
2|kiln: figure triptych: needs REFERENCE TEST
= 2
$ kiln figure triptych scenes/puff.png scenes/tiny.yaml -o a.png
2|scenes/tiny.yaml: the file is not an image: it starts with the bytes 23 20 41 20; allowed are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR files
= 3
$ kiln figure strip missing.mp4 -o a.png
2|missing.mp4: No such file or directory
= 3
$ kiln figure --check scenes
2|scenes: no figures in the folder: none has a sidecar .figure.json
= 3
$ kiln figure --check scenes/puff.png
2|scenes/puff.png: expected a folder, a figure that has a sidecar (NAME.figure.json) beside it, or a sidecar
= 3
$ kiln figure --check scenes/none.png
2|scenes/none.png: No such file or directory
= 3
$ kiln figure --check doc --update doc
2|kiln: figure: --check and --update exclude each other
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --width 84
$ rm a.png*
$ kiln figure sheet scenes/tiny.yaml -o a.png --width 84km
2|kiln: figure sheet: --width: found '84km'; expected a width on paper from 5mm to 2000mm, such as 84mm, 3.3in or 240pt, or 16 to 16384 pixels of each picture
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --width 3m
2|kiln: figure sheet: --width: found '3m'; expected a width on paper from 5mm to 2000mm, such as 84mm, 3.3in or 240pt, or 16 to 16384 pixels of each picture
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --width 12.5px
2|kiln: figure sheet: --width: found '12.5px'; expected a width on paper from 5mm to 2000mm, such as 84mm, 3.3in or 240pt, or 16 to 16384 pixels of each picture
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --width 2.1m
2|kiln: figure sheet: --width: found '2.1m'; expected a width on paper from 5mm to 2000mm, such as 84mm, 3.3in or 240pt, or 16 to 16384 pixels of each picture
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --width 84mm --dpi 30
2|kiln: figure sheet: --dpi: found '30', expected a whole number from 36 to 2400
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --width 84mm --text-size 3pt
2|kiln: figure sheet: --text-size: found '3pt'; expected 4pt to 72pt on paper, or 8 to 64 pixels
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --width 20mm --dpi 36 --sweep seed=1,2,3,4 --columns 4
2|kiln: figure sheet: --width 20 mm: found 28 pixels at 36 pixels an inch; 4 pictures in a row need 78
= 2
A sign that cannot be lettered is named before anything is drawn.
$ kiln figure sheet scenes/tiny.yaml -o a.png --title 'Größe 中' --device none
2|kiln: figure sheet: --title: character 7: found '中' (U+4E2D), for which figures have no glyph; they have glyphs for Latin, Greek, dashes, quotes and mathematics
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --label $'a\tb'
2|kiln: figure sheet: --label 'a\tb': character 2: found '\t' (U+0009), for which figures have no glyph; they have glyphs for Latin, Greek, dashes, quotes and mathematics
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --label $'a\xff'
2|kiln: figure sheet: --label 'a\xff': character 2: found the byte ff, which is not UTF-8
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --sweep '*.name=x,😀' --device none
2|kiln: figure sheet: the label of panel 2, 'name = 😀' (--label sets another one): character 8: found '😀' (U+1F600), for which figures have no glyph; they have glyphs for Latin, Greek, dashes, quotes and mathematics
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --alt $'a\xff'
2|kiln: figure sheet: --alt: found the byte ff behind 1 others, which is not UTF-8
= 2
Nothing was written so far, not even in part.
$ find . -type f -not -path './scenes/*'

A sheet over two sweeps, and its sidecar.
$ kiln figure sheet scenes/tiny.yaml -o doc/rates.png --sweep systems.*.emit.rate=5,60 --sweep time=0.2,0.4 --title 'Rates at 45°'
$ grep -o '"label": "[^"]*"' doc/rates.png.figure.json
1|"label": "rate = 5, 0.2 s"
1|"label": "rate = 5, 0.4 s"
1|"label": "rate = 60, 0.2 s"
1|"label": "rate = 60, 0.4 s"
$ grep '"folder"\|"command"' doc/rates.png.figure.json
1|"folder": "..",
1|"command": ["figure", "sheet", "scenes/tiny.yaml", "-o", "doc/rates.png", "--sweep", "systems.*.emit.rate=5,60", "--sweep", "time=0.2,0.4", "--title", "Rates at 45°"],
It is not replaced unless that is wanted, and comes out the same.
$ kiln figure sheet scenes/tiny.yaml -o doc/rates.png
2|kiln: figure sheet: doc/rates.png: the file exists (--force replaces it)
= 2
$ kiln figure sheet scenes/tiny.yaml -o doc/again.png --sweep systems.*.emit.rate=5,60 --sweep time=0.2,0.4 --title 'Rates at 45°' --threads 1
$ cmp doc/rates.png doc/again.png && rm doc/again.png*

The other kinds, and vectors.
$ kiln figure strip scenes/tiny.yaml --count 3 -o doc/strip.svg --dark && xmllint --noout doc/strip.svg
$ kiln render scenes/tiny.yaml -q -o clip/f_####.png --frames 8-11
$ kiln figure triptych clip/f_0008.png clip/f_0011.png -o doc/pair.pdf --inset 0.3,0.3,0.25x0.25
$ head -c 8 doc/pair.pdf; tail -n 1 doc/pair.pdf
1|%PDF-1.4%%EOF
$ kiln figure strip clip/f_####.png --count 2 -o doc/clip.png
$ grep -o '"label": "[^"]*"' doc/clip.png.figure.json
1|"label": "frame 8"
1|"label": "frame 11"
$ kiln figure strip clip/f_####.png --frames 8,30 -o doc/none.png
2|kiln: figure strip: clip/f_####.png: found 1 of the 2 frames that were asked for
= 2
$ kiln figure triptych clip/f_0008.png scenes/puff.png -o doc/none.png
2|scenes/puff.png: the sizes differ: the reference has 64 x 36 pixels, the test 32 x 32
= 3

A picture alone, as JPEG: no paper around it.
$ kiln figure sheet scenes/tiny.yaml --plain --frames 8 -o doc/alone.jpg
$ kiln figure sheet scenes/tiny.yaml --plain --frames 8 --force -o doc/alone.jpg
$ grep '"command"\|"size"' doc/alone.jpg.figure.json
1|"command": ["figure", "sheet", "scenes/tiny.yaml", "--plain", "--frames", "8", "-o", "doc/alone.jpg"],
1|"size": [64, 36],
$ kiln compare clip/f_0008.png doc/alone.jpg --quiet --tolerance psnr=40
$ rm doc/alone.jpg
$ kiln figure sheet scenes/tiny.yaml --plain --frames 8 -o doc/alone.jpg
2|kiln: figure sheet: doc/alone.jpg.figure.json: the file exists (--force replaces it)
= 2
$ rm doc/alone*

A width on paper is the same in all formats, and so is the size of the lettering, 8 points.
$ for e in png jpg svg pdf; do kiln figure sheet scenes/tiny.yaml --size 640x360 --sweep systems.*.emit.rate=5,60 --width 84mm --label 'Größe ≤ ½ µm' --label 'α − β' --title 'Ärø – “λ”' --alt 'Two puffs: α, β, 中.' -o paper/p.$e; done
$ grep -h '"size"\|"alt"' paper/p.*.json | sort | uniq -c | sed 's/^ *//'
1|4 "alt": "Two puffs: α, β, 中.",
1|4 "size": [992, 432],
$ head -n 3 paper/p.svg | cut -c1-100
1|<svg xmlns="http://www.w3.org/2000/svg" width="84mm" height="36.58065mm" viewBox="0 0 992 432" role=
1|<title>Ärø – “λ”</title>
1|<desc>Two puffs: α, β, 中.</desc>
$ xmllint --noout paper/p.svg && grep -o '<text.*</text>' paper/p.svg
1|<text x="3" y="48.5" font-family="sans-serif" font-size="46.67" textLength="180.67" lengthAdjust="spacingAndGlyphs" fill="#24272b" fill-opacity="0" xml:space="preserve">Ärø – “λ”</text>
1|<text x="3" y="421.5" font-family="sans-serif" font-size="33.33" textLength="203.81" lengthAdjust="spacingAndGlyphs" fill="#24272b" fill-opacity="0" xml:space="preserve">Größe ≤ ½ µm</text>
1|<text x="512" y="421.5" font-family="sans-serif" font-size="33.33" textLength="72.86" lengthAdjust="spacingAndGlyphs" fill="#24272b" fill-opacity="0" xml:space="preserve">α − β</text>
$ pdfinfo paper/p.pdf | grep 'Title\|Tagged\|Page size\|PDF version'
1|Title:           Ärø – “λ”
1|Tagged:          yes
1|Page size:       238.11 x 103.693 pts
1|PDF version:     1.4
$ pdffonts paper/p.pdf | tail -n 1 | cut -c1-80
1|KILNAA+KilnLettering                 CID TrueType      Identity-H       yes yes 
$ pdftotext -layout paper/p.pdf - | grep -v '^ *$' | sed 's/   */  /g'
1|Ärø – “λ”
1|Größe ≤ ½ µm  α−β
1|
$ python3 -c 'import re; print(bytes.fromhex(re.search(rb"/Alt <(\w+)>", open("paper/p.pdf", "rb").read())[1].decode()).decode("utf-16"))'
1|Two puffs: α, β, 中.
$ kiln figure sheet scenes/tiny.yaml --width 3.3in --dpi 600 --text-size 6pt -o paper/small.pdf
2|kiln: warning: paper/small.pdf: pictures of 64 pixels are enlarged to 1968 pixels for 600 pixels an inch; a larger --size renders scenes sharper
$ pdfinfo paper/small.pdf | grep 'Page size'
1|Page size:       237.6 x 134.28 pts
$ kiln figure sheet scenes/tiny.yaml --dpi 96 -o paper/pixels.svg && head -n 1 paper/pixels.svg
1|<svg xmlns="http://www.w3.org/2000/svg" width="28.04583mm" height="20.6375mm" viewBox="0 0 106 78">
$ kiln figure --check paper --quiet && rm -r paper

What a figure is made of, for make. A file that goes, or has an odd name, does not stop it.
$ mkdir -p 'odd $x#' && cp scenes/tiny.yaml 'odd $x#/a: 1%.yaml' && cp scenes/puff.png 'odd $x#'
$ kiln figure sheet 'odd $x#/a: 1%.yaml' -o 'odd.png' --depfile odd.d && cat odd.d
1|odd.png: \
1|  odd\ $$x\#/a\:\ 1%.yaml \
1|  odd\ $$x\#/puff.png
1|
1|odd\ $$x\#/a\:\ 1\%.yaml:
1|
1|odd\ $$x\#/puff.png:
$ printf 'odd.png:\n\t@echo redrawn\n-include odd.d\n' >odd.mk
$ touch -d 2020-01-01 odd*/* && make -s -f odd.mk odd.png
$ touch -d 2020-01-01 odd.png && touch -d 2020-01-02 odd*/puff.png && make -s -f odd.mk odd.png
1|redrawn
$ rm odd*/puff.png && make -s -f odd.mk odd.png
1|redrawn
$ cp scenes/tiny.yaml 'scenes/a=b.yaml' && kiln figure sheet 'scenes/a=b.yaml' -o odd3.png --depfile odd3.d; ls odd3*; rm scenes/a=*
2|kiln: figure sheet: --depfile: scenes/a=b.yaml: make cannot read a name with '='
2|ls: cannot access 'odd3*': No such file or directory
$ kiln figure sheet scenes/tiny.yaml -o odd3.png --depfile /proc/self/x/odd3.d; ls odd3*
2|kiln: /proc/self/x: the folder cannot be made: No such file or directory
2|ls: cannot access 'odd3*': No such file or directory
= 2
$ kiln figure sheet scenes/tiny.yaml -o odd2.png --depfile odd.d
2|kiln: figure sheet: odd.d: the file exists (--force replaces it)
= 2
$ kiln figure sheet scenes/tiny.yaml -o odd2.png --depfile scenes/tiny.yaml --force
2|kiln: figure sheet: scenes/tiny.yaml: --depfile would replace a file that it is made of, which this command reads
= 2
$ rm -r odd*

All of them are what their commands make, from wherever one asks.
$ kiln figure --check doc
1|doc/clip.png: up to date
1|doc/pair.pdf: up to date
1|doc/rates.png: up to date
1|doc/strip.svg: up to date
$ cd doc && kiln figure --check strip.svg.figure.json
1|strip.svg: up to date
$ kiln figure --check doc --quiet
$ kiln figure --check doc/strip.svg doc/rates.png
1|doc/strip.svg: up to date
1|doc/rates.png: up to date
What another machine drew may look a little different; vectors cannot be looked at.
$ sed -i.old 's/"device": "\([^"]\)/"device": "an older \1/; s/^"pixels": "......../"pixels": "01234567/' doc/*.json
$ kiln figure --check doc | sed 's/an older [^\x27]*/an older device/'; echo ${PIPESTATUS[0]}
1|doc/clip.png: stale: its layout or its lettering has changed
1|doc/pair.pdf: stale: its layout or its lettering has changed
1|doc/rates.png: up to date: drawn by 'an older device', within the limits: flip.mean 0.0000 of 0.01, flip.p99 0.0000 of 0.1, window.share 0.0000 of 0.1
1|doc/strip.svg: up to date: drawn by 'an older device'; scene and simulation are the same, and pictures within vectors are not compared
1|1
$ for f in doc/*.old; do mv $f ${f%.old}; done
Not another picture, though, nor one of another size.
$ kiln figure sheet scenes/tiny.yaml --plain --frames 8 -o far/far.png
$ sed -i 's/"device": "/"device": "an older /; s/^"pixels": "......../"pixels": "01234567/' far/*.json
$ cp clip/f_0011.png far/far.png
$ sed -i "s/^\"file\": \"[0-9a-f]*/\"file\": \"$(sha256sum <far/far.png | cut -d' ' -f1)/" far/*.json
$ kiln figure --check far | grep -o 'stale: drawn by\|beyond the limits: flip.mean'
1|stale: drawn by
1|beyond the limits: flip.mean
$ cp scenes/puff.png far/far.png
$ sed -i "s/^\"file\": \"[0-9a-f]*/\"file\": \"$(sha256sum <far/far.png | cut -d' ' -f1)/" far/*.json
$ kiln figure --check far
1|far/far.png: stale: it has another size now
= 1
Copies and new names have the command of another figure.
$ cp doc/rates.png doc/copy.png; cp doc/rates.png.figure.json doc/copy.png.figure.json
$ kiln figure --check doc/copy.png.figure.json
1|doc/copy.png: stale: the command makes another file, 'doc/rates.png'
= 1
$ rm doc/copy*
$ cp doc/rates.png doc/copy.png; cp doc/rates.png.figure.json doc/copy.png.figure.json
$ kiln figure --update doc/copy.png
1|doc/copy.png: stale: the command makes another file, 'doc/rates.png'
= 1
$ rm doc/copy*
Then a scene changes, a picture, a file, a sidecar.
$ sed -i 's/drag: 0.2/drag: 0.9/' scenes/tiny.yaml
$ cp clip/f_0010.png clip/f_0011.png
$ rm doc/clip.png
$ kiln figure --check doc
1|doc/clip.png: stale: the figure is missing
1|doc/pair.pdf: stale: the picture has changed in 'result'
1|doc/rates.png: stale: the scene has changed in 'rate = 5, 0.2 s'
1|doc/strip.svg: stale: the scene has changed in '0.00 s'
= 1
One that is none does not keep the others from being checked.
$ kiln figure --check scenes/tiny.yaml doc/rates.png gone.png scenes/puff.png
1|doc/rates.png: stale: the scene has changed in 'rate = 5, 0.2 s'
2|scenes/tiny.yaml: expected a folder, a figure that has a sidecar (NAME.figure.json) beside it, or a sidecar
2|gone.png: No such file or directory
2|scenes/puff.png: expected a folder, a figure that has a sidecar (NAME.figure.json) beside it, or a sidecar
= 3
A sidecar may be a stranger's: what is redrawn replaces no other file.
$ mkdir strange && kiln figure sheet scenes/tiny.yaml -o strange/z.png && echo precious >victim && rm strange/z.png
$ sed -i 's/"-o"/"--depfile", "victim", "-o"/' strange/z.png.figure.json
$ kiln figure --update strange && cat victim && grep -c depfile strange/z.png.figure.json; rm -r strange
1|strange/z.png: redrawn: the figure is missing
1|precious
1|1
What is stale is drawn anew, from wherever one asks, and nothing else is touched.
$ touch -d 2020-01-01 doc/rates.png
$ cd doc && kiln figure --update ../doc/strip.svg clip.png
1|../doc/strip.svg: redrawn: the scene has changed in '0.00 s'
1|clip.png: redrawn: the figure is missing
$ find doc -newermt 2021-01-01 -name '*.png' | sort
1|doc/clip.png
$ kiln figure --update doc
1|doc/clip.png: up to date
1|doc/pair.pdf: redrawn: the picture has changed in 'result'
1|doc/rates.png: redrawn: the scene has changed in 'rate = 5, 0.2 s'
1|doc/strip.svg: up to date
$ kiln figure --update doc --quiet
$ kiln figure --check doc
1|doc/clip.png: up to date
1|doc/pair.pdf: up to date
1|doc/rates.png: up to date
1|doc/strip.svg: up to date
$ sed -i 's/"pixels": "/"pixels": "x/' doc/pair.pdf.figure.json
$ kiln figure --check doc
1|doc/clip.png: up to date
1|doc/rates.png: up to date
1|doc/strip.svg: up to date
2|doc/pair.pdf.figure.json:10:11: pixels: expected 64 hex digits
= 3
