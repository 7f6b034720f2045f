A scene that is made of parts: it includes a file, copies what is there, and has parameters.

$ mkdir -p parts && cat >parts/fire.yaml <<'END'
> params:
>   heat: {number: 2000 K, min: 500 K, max: 4000 K, help: temperature of the flames}
> systems:
>   flames:
>     enabled: false
>     emit: {rate: "= 40 1/s * $amount", life: [0.5 s, 1 s]}
>     look: {atlas: "builtin:spark", color: $brand, temperature: $heat}
> backdrop:
>   objects:
>     ball: {sphere: {center: [0, 1, 0], radius: 30 cm}}
> END
$ cat >title.yaml <<'END'
> kiln: 1
> include: [parts/fire.yaml]
> params:
>   brand: {color: "#e61e28", help: colour of the sparks}
>   length: {number: 2 s, min: 1 s, max: 30 s, help: length of the clip}
>   amount: {number: 1, min: 0, max: 3}
>   style: {choice: calm, of: [calm, wild]}
>   tilt: {number: 5 deg, max: 90 deg}
> output: {duration: $length, size: [64, 32]}
> camera: {roll: {keys: {0 s: 0 deg, 50 %: $tilt, "= $length - 0.5 s": 0 deg}}}
> systems:
>   left: {use: flames, emit: {speed: 2}}
>   right: {use: left, emit: {rate: 7}}
> backdrop: {objects: {other: {use: ball, sphere: {radius: 1 m}}}}
> END
$ kiln check title.yaml | grep -E 'frames|roll|objects|ball|other|radius|left|right|flames|enabled|  rate:|params|use|include'
1|  frames: 60
1|  rate: 60
1|  roll: {keys: {0 s: 0 deg, 1 s: 5 deg, 1.5 s: 0 deg}}
1|  objects:
1|    other:
1|        radius: 1 m
1|    ball:
1|        radius: 0.3 m
1|  left:
1|    enabled: true
1|      rate: 40 1/s
1|  right:
1|    enabled: true
1|      rate: 7 1/s
1|  flames:
1|    enabled: false
1|      rate: 40 1/s
1|    radius: 0.7
1|# work: 60 frames of 64 x 32 pixels, 118 steps, up to 51 particles, about <n> MiB
$ kiln check title.yaml | grep -E '^  (left|right|flames):' -A 2 | grep -vE 'enabled|--' # numbers of draws
1|  left:
1|    seed: 0
1|  right:
1|    seed: 1
1|  flames:
1|    seed: 2
$ kiln check title.yaml --origin | grep -v '# default'
1|kiln: 1  # title.yaml:1
1|output:  # title.yaml:9
1|  size: [64, 32]  # title.yaml:9
1|  frames: 60  # title.yaml:5, as $length at title.yaml:9
1|camera:  # title.yaml:10
1|  roll: {keys: {0 s: 0 deg, 1 s: 5 deg, 1.5 s: 0 deg}}  # title.yaml:10
1|backdrop:  # title.yaml:14
1|  objects:  # title.yaml:14
1|    other:  # title.yaml:14
1|      sphere:  # title.yaml:14
1|        center: [0, 1, 0]  # parts/fire.yaml:10, used at title.yaml:14
1|        radius: 1 m  # title.yaml:14
1|    ball:  # parts/fire.yaml:10
1|      sphere:  # parts/fire.yaml:10
1|        center: [0, 1, 0]  # parts/fire.yaml:10
1|        radius: 0.3 m  # parts/fire.yaml:10
1|systems:  # title.yaml:11
1|  left:  # title.yaml:12
1|    emit:  # title.yaml:12
1|      rate: 40 1/s  # parts/fire.yaml:6, used at title.yaml:12
1|      life: [0.5 s, 1 s]  # parts/fire.yaml:6, used at title.yaml:12
1|      speed: 2 m/s  # title.yaml:12
1|    look:  # parts/fire.yaml:7, used at title.yaml:12
1|      atlas: "builtin:spark"  # parts/fire.yaml:7, used at title.yaml:12
1|      color: [0.7912979, 0.0129830325, 0.02121901]  # title.yaml:4, as $brand at parts/fire.yaml:7
1|      temperature: 2000 K  # parts/fire.yaml:2, as $heat at parts/fire.yaml:7
1|  right:  # title.yaml:13
1|    emit:  # title.yaml:13
1|      rate: 7 1/s  # title.yaml:13
1|      life: [0.5 s, 1 s]  # parts/fire.yaml:6, used at title.yaml:13, used at title.yaml:12
1|      speed: 2 m/s  # title.yaml:12, used at title.yaml:13
1|    look:  # parts/fire.yaml:7, used at title.yaml:13, used at title.yaml:12
1|      atlas: "builtin:spark"  # parts/fire.yaml:7, used at title.yaml:13, used at title.yaml:12
1|      color: [0.7912979, 0.0129830325, 0.02121901]  # title.yaml:4, as $brand at parts/fire.yaml:7
1|      temperature: 2000 K  # parts/fire.yaml:2, as $heat at parts/fire.yaml:7
1|  flames:  # parts/fire.yaml:4
1|    enabled: false  # parts/fire.yaml:5
1|    emit:  # parts/fire.yaml:6
1|      rate: 40 1/s  # parts/fire.yaml:6
1|      life: [0.5 s, 1 s]  # parts/fire.yaml:6
1|    look:  # parts/fire.yaml:7
1|      atlas: "builtin:spark"  # parts/fire.yaml:7
1|      color: [0.7912979, 0.0129830325, 0.02121901]  # title.yaml:4, as $brand at parts/fire.yaml:7
1|      temperature: 2000 K  # parts/fire.yaml:2, as $heat at parts/fire.yaml:7
1|# work: 60 frames of 64 x 32 pixels, 118 steps, up to 51 particles, about <n> MiB
$ kiln check title.yaml >plain.yaml && kiln check --hash title.yaml plain.yaml | sort -u | cut -c 65-
1|  plain.yaml
1|  title.yaml
$ kiln check title.yaml --hash | diff - <(kiln check plain.yaml --hash)
$ kiln render title.yaml -o none --frames 10 --stats --device cpu | grep -c state
1|1

Its parameters.

$ kiln params title.yaml
1|brand: color "#e61e28"
1|    colour of the sparks
1|length: number 2 s, from 1 s to 30 s
1|    length of the clip
1|amount: number 1, from 0 to 3
1|style: choice "calm": calm, wild
1|tilt: number "5 deg", to 90 deg
1|heat: number 2000 K, from 500 K to 4000 K
1|    temperature of the flames
$ kiln params title.yaml --set params.amount=2 --set 'params.brand=#00ff00' --json
1|{
1|  "scene": "title.yaml",
1|  "params": [
1|    {"name": "brand", "kind": "color", "default": "#e61e28", "value": "#00ff00", "help": "colour of the sparks", "place": "title.yaml:4:3"},
1|    {"name": "length", "kind": "number", "unit": "s", "default": 2, "value": 2, "min": 1, "max": 30, "help": "length of the clip", "place": "title.yaml:5:3"},
1|    {"name": "amount", "kind": "number", "default": 1, "value": 2, "min": 0, "max": 3, "help": "", "place": "title.yaml:6:3"},
1|    {"name": "style", "kind": "choice", "default": "calm", "value": "calm", "of": ["calm", "wild"], "help": "", "place": "title.yaml:7:3"},
1|    {"name": "tilt", "kind": "number", "unit": "deg", "default": "5 deg", "value": "5 deg", "max": 90, "help": "", "place": "title.yaml:8:3"},
1|    {"name": "heat", "kind": "number", "unit": "K", "default": 2000, "value": 2000, "min": 500, "max": 4000, "help": "temperature of the flames", "place": "parts/fire.yaml:2:3"}
1|  ],
1|  "schema": {"$schema": "http://json-schema.org/draft-07/schema#", "type": "object", "additionalProperties": false, "properties": {"brand": {"anyOf": [{"type": "array", "minItems": 3, "maxItems": 3, "items": {"type": "number", "minimum": 0, "maximum": 1000000}}, {"type": "number", "minimum": 0, "maximum": 1000000}, {"type": "string", "pattern": "^(#[0-9A-Fa-f]{3}([0-9A-Fa-f]{3})?|[A-Za-z]+)$"}]}, "length": {"type": ["number", "string"], "minimum": 1, "maximum": 30, "pattern": "^[-+]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]+)? *(s|ms|min|h)$"}, "amount": {"type": "number", "minimum": 0, "maximum": 3}, "style": {"enum": ["calm", "wild"]}, "tilt": {"type": ["number", "string"], "minimum": 0, "maximum": 0, "pattern": "^[-+]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]+)? *(rad|deg)$"}, "heat": {"type": ["number", "string"], "minimum": 500, "maximum": 4000, "pattern": "^[-+]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]+)? *(K)$"}}}
1|}
$ printf '{"length": 3, "amount": 2, "brand": [1, 0, 0]}\n' >values.json
$ kiln check title.yaml --params values.json --set params.amount=3 --origin | grep -E 'frames|color: \[1'
1|  frames: 90  # values.json:1, as $length at title.yaml:9
1|        color: [1, 1, 1]  # default
1|      color: [1, 0, 0]  # values.json:1, as $brand at parts/fire.yaml:7
1|        color: [1, 1, 1]  # default
1|      color: [1, 0, 0]  # values.json:1, as $brand at parts/fire.yaml:7
1|        color: [1, 1, 1]  # default
1|      color: [1, 0, 0]  # values.json:1, as $brand at parts/fire.yaml:7
1|# work: 90 frames of 64 x 32 pixels, 178 steps, up to 133 particles, about <n> MiB
$ kiln params title.yaml --params values.json --sandbox | grep -A 1 length
1|length: number 3 s, from 1 s to 30 s
1|    length of the clip
1|amount: number 2, from 0 to 3
$ kiln params plain.yaml
$ kiln params title.yaml --json=values.json
2|kiln: values.json: the file exists (--force replaces it)
= 2
$ kiln params title.yaml --json=title.yaml --force
2|kiln: title.yaml: --json would replace the scene, which this command reads
= 2

Wrong values name the parameter, its range and where it is declared.

$ kiln check -q title.yaml --set params.length=40
2|--set params.length: 40 is out of range; allowed is from 1 s to 30 s; declared at title.yaml:5:3
= 3
$ kiln check -q title.yaml --set params.style=tame
2|--set params.style: expected calm or wild, found 'tame'; declared at title.yaml:7:3
= 3
$ kiln check -q title.yaml --set 'params.amount=$heat'
2|--set params.amount: expected a number from 0 to 3, found '$heat'; declared at title.yaml:6:3
= 3
$ kiln check -q title.yaml --set params.heat=3
2|--set params.heat: 3 is out of range; allowed is from 500 K to 4000 K; declared at parts/fire.yaml:2:3
= 3
$ kiln check -q title.yaml --set params.colour=red
2|--set params.colour: there is no parameter 'colour' (there are: brand, length, amount, style, tilt, heat)
= 3
$ printf 'length: 3\ntilt: 45\n' >wrong.yaml && kiln check -q title.yaml --params wrong.yaml
2|wrong.yaml:2:7: params.tilt: an angle needs its unit: 45 deg or 45 rad; declared at title.yaml:8:3
= 3
$ printf 'length: {a: 1}\n' >wrong.yaml && kiln check -q title.yaml --params wrong.yaml
2|wrong.yaml:1:9: params.length: expected a number from 1 s to 30 s, found a mapping; declared at title.yaml:5:3
= 3
$ kiln check -q title.yaml --params nowhere.yaml
2|nowhere.yaml: No such file or directory
= 3
$ kiln check -q title.yaml --set params={}
2|--set params: this key must stand in the file
= 3
$ kiln check -q title.yaml --set systems.left.use=flames
2|--set systems.left.use: this key must stand in the file
= 3
$ kiln check -q title.yaml --set 'systems.left.emit.rate="= 1 s + 2 m"'
2|--set systems.left.emit.rate: "= 1 s + 2 m": s + m: both need the same unit
= 3
$ kiln check -q title.yaml --set 'systems.left.emit.rate=$amuont'
2|--set systems.left.emit.rate: there is no parameter 'amuont' (did you mean 'amount'?); $$amuont is the text $amuont
= 3

What is wrong in a part is told with the way to it.

$ sed -i 's/life:/live:/' parts/fire.yaml; kiln check -q title.yaml; sed -i 's/live:/life:/' parts/fire.yaml
2|parts/fire.yaml:6:40: systems.left.emit.live: unknown key (did you mean 'life'?); included from title.yaml:2:11; used at title.yaml:12:15
$ sed -i 's/0.5 s, 1 s/5 s, 1 s/' parts/fire.yaml; kiln check -q title.yaml; sed -i 's/5 s, 1 s/0.5 s, 1 s/' parts/fire.yaml
2|parts/fire.yaml:6:46: systems.left.emit.life: the first must not be above the second; included from title.yaml:2:11; used at title.yaml:12:15
$ printf 'kiln: 1\ninclude: loop.yaml\n' >loop.yaml && kiln check -q loop.yaml
2|loop.yaml:2:10: include: this file includes itself
= 3
$ printf 'kiln: 1\ninclude: ../loop.yaml\n' >out.yaml && kiln check -q out.yaml
2|out.yaml:2:10: include: '../loop.yaml' is outside the asset root; a path starts at the scene's folder and stays below it
= 3
$ { echo 'kiln: 1'; echo 'a: &a0 [x, x, x, x, x, x, x, x, x, x]'; for i in {1..9}; do a=*a$((i - 1)); echo "b$i: &a$i [$a, $a, $a, $a, $a, $a, $a, $a, $a, $a]"; done; } >bomb.yaml && kiln check -q bomb.yaml
2|bomb.yaml:6:45: aliases, uses and parameters copy more than the 100000 nodes that are allowed
= 3

No output may overwrite a part, nor a file of parameters.

$ cp parts/fire.yaml part.png && printf 'kiln: 1\ninclude: part.png\nparams: {amount: {number: 1}, brand: {color: red}}\n' >a.yaml && kiln render a.yaml -o part.png --frames 0 --force
2|kiln: part.png: --output would replace a file of the scene, which this command reads
= 2
$ echo '{}' >v.png && kiln render plain.yaml --params v.png -o v.png --frames 0 --force
2|kiln: v.png: --output would replace the parameters, which this command reads
= 2

Jobs of a batch give parameters values.

$ cat >jobs.yaml <<'END'
> kiln_jobs: 1
> jobs:
>   - {scene: title.yaml, output: none, frames: 5, params: {length: 4 s, brand: "#00ff00"}}
>   - {scene: title.yaml, output: none, frames: 5, params: {style: tame}}
>   - {scene: title.yaml, output: none, frames: 200, params: {length: 7}}
> END
$ kiln render --batch jobs.yaml --jobs 1 --keep-going | sed 's/ in .*s/ in T/; s/[0-9.]* s$/T/; s/after .*/after T/'
1|job 1: done in T
1|job 2: exit code 3 after T
1|job 3: done in T
1|3 of 3 jobs in T, 1 failed
2|job 2: --set params.style: expected calm or wild, found 'tame'; declared at title.yaml:7:3
$ echo '{"scene": "title.yaml", "output": "none", "params": {"a b": 1}}' | kiln render --batch -
2|standard input:1:54: params.a b: this is no name of a parameter
= 3
$ echo '{"scene": "title.yaml", "output": "none", "params": 3}' | kiln render --batch -
2|standard input:1:53: params: expected a mapping of up to 256 names of parameters to values, found '3'
= 3

What changed in the scene of a golden test names the part and the line.

$ printf 'kiln_test: 1\nscene: title.yaml\nframes: [6]\n' >title.test.yaml && kiln test title.test.yaml -q --update missing --no-report --device cpu
$ sed -i 's/= 40 1/= 90 1/' parts/fire.yaml; kiln test title.test.yaml -q --no-report --device cpu --junit junit.xml >log; grep '^scene:' junit.xml
1|scene: systems.flames.emit.rate: 40 1/s -&gt; 90 1/s (parts/fire.yaml:6)
1|scene: systems.left.emit.rate: 40 1/s -&gt; 90 1/s (parts/fire.yaml:6, used at title.yaml:12)
$ kiln test title.test.yaml -q --no-report --device cpu --junit parts/fire.yaml
2|kiln: parts/fire.yaml: --junit would replace a file of a scene, which this command reads
= 2
