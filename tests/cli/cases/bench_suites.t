kiln bench: each kind of suite, with few and small comparisons. No number is looked at. Only tools/test --all
runs this file.

Of a suite, with published values beside, files and curves.

$ kiln bench table1 --quick --quiet -o out --device software --format json >table1.json; jq -r '.parts[] | .name, .unit, .reference, (.rows[] | select(.published) | "\(.x) \(.technique) \(.value.median) \(.published)")' table1.json
1|table1
1|fps
1|cpu
1|128 FP (2004) 22 UberFlow 2004, ATI 9800 Pro
1|128 GP/FP (2004) 40 UberFlow 2004, ATI 9800 Pro
1|128 GP/FP Packed (2004) 148 UberFlow 2004, ATI 9800 Pro
$ ls out | grep -v '\.svg$'
1|bench.csv
1|bench.json
1|bench.md
1|bench.txt
1|table1.dat
1|table1.gp
$ cmp table1.json out/bench.json && head -n 1 out/bench.csv
1|suite,part,sweep,x,measure,technique,unit,turns,median,first_quartile,third_quartile,least,most,reference,times_as_fast,times_as_fast_first_quartile,times_as_fast_third_quartile,published
$ ! command -v gnuplot >/dev/null || xmllint --noout out/table1.svg
$ for suite in figure4.4 groups bytes; do kiln bench $suite --quick --quiet --device software --format json | jq -c '.parts[] | .name, ([.rows[] | .value.median >= 0 and .value.turns >= 1] | all), ([.rows[].technique] | unique | length)'; done
1|"figure4.4"
1|true
1|5
1|"groups"
1|true
1|7
1|"bytes"
1|true
1|11

Of a clip in parts, each a process: what they cost, and how long many workers would take. `jobs` takes
a scene, which then is not measured itself.

$ kiln bench jobs --quick --quiet --device cpu -o jobs --format json >jobs.json; jq -r '.parts[] | .name, .unit, (.rows[] | select(.x | IN(1, 2, 1000)) | "\(.x) \(.measure), \(.technique): \(.value.turns)")' jobs.json
1|jobs
1|s
1|2 all, single run: 3
1|2 all, bake: 3
1|2 all, parts: 3
1|2 all, join: 3
1|2 start, parts: 3
1|2 first frame, parts: 3
1|2 state, parts: 3
1|2 other frames, parts: 3
1|2 end, parts: 3
1|jobs_ratio
1|times
1|2 parts + join, single run + bake: 3
1|2 bake + parts + join, single run + bake: 3
1|2 parts + join, single run: 3
1|jobs_elapsed
1|s
1|1 elapsed, single run: 3
1|1 elapsed, parts: 3
1|1 elapsed, bound: 3
1|2 elapsed, parts: 3
1|2 elapsed, bound: 3
1|1000 elapsed, parts: 3
1|1000 elapsed, bound: 3
1|jobs_speedup
1|times; %
1|1 speed-up, times: 3
1|1 efficiency, %: 3
1|2 speed-up, times: 3
1|2 efficiency, %: 3
1|1000 speed-up, times: 3
1|1000 efficiency, %: 3
$ jq -c '[.parts[].rows[].value.median > 0] | all' jobs.json
1|true
$ jq -r '.parts[0].notes[0]' jobs.json; jq -r '.parts[2].notes[0]' jobs.json | sed -E 's/[0-9]+\.[0-9]+/<s>/g; s/part [12], frames [0-9]+-[0-9]+/<part>/'
1|fire_beam.yaml, 40 x 22 pixels, 20 frames, 10 a part. The joined clip had the same bytes as the clip of the single run in all 3 turns.
1|Simulated from measured times: the bake comes first, then the parts in their order, each on the first free worker, then the join. A worker is a machine like this one. The bound is the bake (<s> s), the longest part and the join (<s> s). The longest part is <part>: <s> s.
$ ls jobs | grep -v '\.svg$'
1|bench.csv
1|bench.json
1|bench.md
1|bench.txt
1|jobs_elapsed.dat
1|jobs_elapsed.gp
$ kiln bench jobs scenes/tiny.yaml --quick --quiet --device cpu --parts 3 --size 32x32 --set output.fps=2 | grep -e ' bytes ' -e ' all  *join' | sed -E 's/[0-9]+\.[0-9]+/<n>/g; s/ +/ /g'
1| 3 all join <n> <n> - <n> 3
1| scenes/tiny.yaml, 32 x 32 pixels, 12 frames, 4 a part. The joined clip had the same bytes as the clip of the single run in all 3 turns.

Of threads: what of a frame's CPU time is serial. `threads` takes scenes, too.

$ kiln bench threads scenes/tiny.yaml --quick --quiet --device cpu --frame 3 --format json >threads.json; jq -r '.parts[] | .name, .unit, .notes[], (.rows[] | select(.x == 8) | "\(.x) \(.measure), \(.technique)")' threads.json
1|threads, scenes/tiny.yaml, 160x90
1|ms; %
1|Means of frames 4 to 6.
1|8 frame, all, ms
1|8 frame, serial, ms
1|8 frame, serial, %
1|8 simulate, serial, ms
1|8 sort, serial, ms
1|8 lighting, serial, ms
1|8 backdrop, serial, ms
1|8 gas, serial, ms
1|8 particles, serial, ms
1|8 bloom, serial, ms
1|8 composite, serial, ms
1|8 readback, serial, ms
1|8 between passes, serial, ms
$ jq -c '[.parts[].rows[] | .value.median] | (min > -0.01), .[1] < .[0]' threads.json
1|true
1|true

Of gas: steps of a box of 32 cells along an edge, its memory, and a fire that is stepped, saved, exported and drawn.

$ kiln bench gas --quick --quiet --device cpu --format json >gas.json; jq -r '.parts[] | .name, .unit, ([.rows[].measure] | unique | join(" ")), ([.rows[].technique | sub("^(plain|avx2|avx512|neon), "; "")] | unique | join("; "))' gas.json
1|gas
1|ns a cell of the box; ms
1|diverge elapsed, ms pressure project push react step trace
1|1 thread; 2 threads
1|gas_quarter
1|ns a cell of the box; ms
1|diverge elapsed, ms pressure project push react step trace
1|1 thread; 2 threads
1|gas_memory
1|bytes a cell
1|active idle
1|bytes
1|gas_fire
1|ns an active cell
1|diverge pressure project push react sources step trace
1|gas=cpu
1|gas_files
1|ms; bytes an active cell
1|export load save state
1|bytes; ms
1|gas_march
1|ms
1|field glow light march
1|all; full; half
1|gas_drawn
1|ms
1|frame gas simulate
1|auto
$ jq -c '[.parts[] | select(.name != "gas_memory") | .rows[].value.median > 0] | all' gas.json
1|true
$ jq -r '.parts[] | select(.name == "gas") | .notes[]' gas.json
1|32 cells: 100 % of the bricks were active.
$ kiln bench gas --cells 40 --repeat 3 --quiet --device cpu --quick --format csv | cut -d, -f4 | sort -u
1|48
1|x

Where nothing can be measured, that is no success. What a flag says of a technique is kept.

$ kiln bench groups --quick --quiet --device cpu >table; code=$?; grep -c '^  Not measured: ' table; exit $code
1|7
2|kiln: bench: nothing could be measured on this device; the notes of the tables say why
= 4
$ kiln bench figure4.6 --quick --quiet --device software --technique sort=oddeven:4 --format csv | cut -d, -f6 | grep oddeven | sort -u
1|sort=oddeven:4

A process that no SIGTERM ends is killed five seconds later.

$ mkdir scratch
$ TMPDIR=$PWD/scratch env --default-signal kiln bench jobs --device cpu --quiet & bench=$!
> until child=$(<"/proc/$bench/task/$bench/children") && grep -qs frames=3840 "/proc/${child% }/cmdline" && ! grep -qs frames=0 "/proc/${child% }/cmdline"; do sleep 0.1; done
> kill -STOP ${child% } && kill -TERM $bench; start=$SECONDS; wait $bench; code=$?
> echo $((SECONDS - start >= 4)); ls -A scratch; ! kill -0 ${child% } 2>/dev/null; exit $code
1|1
2|kiln: bench: stopped by SIGTERM; nothing is written
= 143
