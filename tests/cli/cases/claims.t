A call never replaces what it reads, and never writes one file twice, however the paths are spelt. It
is refused before any work.

$ cp scenes/puff.png . && cp scenes/tiny.yaml a.yaml && cp a.yaml b.yaml && ln -s a.yaml link.yaml && ln a.yaml hard.yaml && mkdir folder
$ kiln render a.yaml -q --frames 0 -o m.png --manifest ./m.png
2|kiln: ./m.png: --output and --manifest would both write this file
= 2
$ kiln render a.yaml -q --frames 0-2 -o fr_%04d.png --manifest fr_0001.png
2|kiln: fr_0001.png: --output and --manifest would both write this file
= 2
$ kiln render a.yaml -q --frames 0-2 -o fr.png --manifest folder/../fr_0001.png
2|kiln: folder/../fr_0001.png: --output and --manifest would both write this file
= 2
$ kiln render a.yaml -q -o fq.png --flipbook 2x2 --manifest fq.json
2|kiln: fq.json: --output and --manifest would both write this file
= 2
$ kiln render a.yaml -q -o fq.png --flipbook 2x2 --flipbook-motion --manifest nowhere/../fq_motion.png
2|kiln: nowhere/../fq_motion.png: --output and --manifest would both write this file
= 2
$ kiln render a.yaml -q --frames 0 -o a.png --manifest a.yaml --force
2|kiln: a.yaml: --manifest would replace the scene, which this command reads
= 2
$ kiln render a.yaml -q --frames 0 -o a.png --manifest folder/../link.yaml --force
2|kiln: folder/../link.yaml: --manifest would replace the scene, which this command reads
= 2
$ kiln render a.yaml -q --frames 0 -o a.png --manifest hard.yaml --force
2|kiln: hard.yaml: --manifest would replace the scene, which this command reads
= 2
$ kiln render a.yaml b.yaml -q --frames 0 -o {scene}.png --manifest {scene}.yaml --force
2|kiln: a.yaml: --manifest would replace the scene, which this command reads
= 2
$ kiln render a.yaml b.yaml -q --frames 0 -o {scene}.png --manifest ./{scene}.png
2|kiln: ./a.png: --output and --manifest would both write this file
= 2
$ ls
1|a.yaml
1|b.yaml
1|folder
1|hard.yaml
1|link.yaml
1|puff.png
1|scenes

Nor what its scene is made of, under whatever name.

$ cp scenes/puff.png t.png && ln t.png same.png && sed 's/^camera:/&/; s|atlas: [^,}]*|atlas: t.png|' a.yaml >t.yaml && grep -c t.png t.yaml
1|2
$ kiln render t.yaml -q --frames 0 -o ./t.png --force
2|kiln: ./t.png: --output would replace a file of the scene, which this command reads
= 2
$ kiln render t.yaml -q --frames 0 -o x.exr --manifest same.png --force
2|kiln: same.png: --manifest would replace a file of the scene, which this command reads
= 2

Comparing: references, tests and masks stay, and the two pictures of a pair of frames have two names.

$ kiln render a.yaml -q --frames 0-2 -o one/f_%04d.png && kiln render b.yaml -q --frames 0-2 --seed 3 -o two/f_%04d.png
$ kiln compare one/f_0001.png two/f_0001.png --diff e.png --error-map ./e.png
2|kiln: ./e.png: --diff and --error-map would both write this file
= 2
$ kiln compare one two --diff e_%01d.png --error-map e_%d.png
2|kiln: e_0.png: --diff and --error-map would both write this file
= 2
$ kiln compare one two --diff one/f_%04d.png --force
2|kiln: one/f_0000.png: --diff would replace a picture of the reference, which this command reads
= 2
$ kiln compare one two --diff two/ --force
2|kiln: two/f_0000.png: --diff would replace a picture of the test, which this command reads
= 2
$ kiln compare one/f_0001.png two/f_0001.png --mask t.png --diff same.png --force
2|kiln: same.png: --diff would replace a mask, which this command reads
= 2
$ kiln compare one/f_%04d.png two/f_%04d.png --error-map one/f_####.png --force -q
2|kiln: one/f_0000.png: --error-map would replace a picture of the reference, which this command reads
= 2
$ ls one two
1|one:
1|f_0000.png
1|f_0001.png
1|f_0002.png
1|
1|two:
1|f_0000.png
1|f_0001.png
1|f_0002.png

Pictures of folders are numbered in the order of their names.

$ kiln compare one two --diff d/x_%04d.png -q
= 1
$ ls d
1|x_0000.png
1|x_0001.png
1|x_0002.png

Clips, whose frames are counted as they come.

$ kiln render a.yaml -q -o one.mkv && kiln render a.yaml -q --seed 3 -o two.mkv
$ kiln compare one.mkv two.mkv --diff v/e_%d.png --error-map v/e_%02d.png -q
2|kiln: v/e_10.png: --diff and --error-map would both write this file
= 2
$ ls v
1|e_0.png
1|e_00.png
1|e_01.png
1|e_02.png
1|e_03.png
1|e_04.png
1|e_05.png
1|e_06.png
1|e_07.png
1|e_08.png
1|e_09.png
1|e_1.png
1|e_10.png
1|e_2.png
1|e_3.png
1|e_4.png
1|e_5.png
1|e_6.png
1|e_7.png
1|e_8.png
1|e_9.png

The file of --json is claimed as well.

$ kiln compare one/f_0001.png two/f_0001.png -q --json=two/../one/f_0001.png --force
2|kiln: two/../one/f_0001.png: --json would replace a picture of the reference, which this command reads
= 2
$ kiln compare one/f_0001.png two/f_0001.png -q --mask t.png --json=same.png --force
2|kiln: same.png: --json would replace a mask, which this command reads
= 2
$ kiln compare one two -q --diff e_%d.png --json=e_2.png
2|kiln: e_2.png: --json and --diff would both write this file
= 2
$ kiln plan t.yaml --device cpu --json=same.png --force
2|kiln: same.png: --json would replace a file of the scene, which this command reads
= 2
$ kiln plan t.yaml --device cpu --json=./t.yaml --force
2|kiln: ./t.yaml: --json would replace the scene, which this command reads
= 2
$ kiln bake t.yaml --device cpu -q -o states --json=t.yaml --force
2|kiln: t.yaml: --json would replace the scene, which this command reads
= 2
$ kiln bake t.yaml --device cpu -q -o states --json=./states
2|kiln: ./states: --output and --json would both write this file
= 2
$ kiln bake t.yaml --device cpu -q -o states --json=states/0.kilnstate --force
2|kiln: bake: --json: 'states/0.kilnstate' is a name of a state (.kilnstate), which only 'kiln bake' writes
= 2
$ cmp t.yaml <(sed 's|atlas: [^,}]*|atlas: t.png|' a.yaml) && cmp t.png scenes/puff.png && ls -d states
2|ls: cannot access 'states': No such file or directory
= 2

Figures.

$ kiln figure strip one/f_%04d.png -o one/f_0001.png --force
2|kiln: figure strip: one/f_0001.png: the figure would replace a frame that it is made of, which this command reads
= 2
$ kiln figure sheet t.yaml --frames 1 -o ./t.png --force
2|kiln: figure sheet: <folder>/work/t.png: the figure would replace a file of the scene, which this command reads
= 2
$ kiln figure triptych one/f_0001.png two/f_0001.png -o one/../two/f_0001.png --force
2|kiln: figure triptych: one/../two/f_0001.png: the figure would replace a file that it is made of, which this command reads
= 2
$ ls
1|a.yaml
1|b.yaml
1|d
1|folder
1|hard.yaml
1|link.yaml
1|one
1|one.mkv
1|puff.png
1|same.png
1|scenes
1|t.png
1|t.yaml
1|two
1|two.mkv
1|v
