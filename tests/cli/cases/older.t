Older spellings of options: they work until version 0.3 and say what to write instead. A letter that
other commands have for another option is refused.

$ kiln bench --repeat 3 --list | tail -n 1 | cut -c 1-10
1|All suites
$ kiln bench --repetitions 3 --list | tail -n 1 | cut -c 1-10
1|All suites
2|kiln: warning: bench: --repetitions is an older spelling of --repeat, and version 0.3 will not know it
$ kiln bench --repetitions 2 --list
2|kiln: warning: bench: --repetitions is an older spelling of --repeat, and version 0.3 will not know it
2|kiln: bench: --repeat: found '2', expected a whole number from 3 to 101
= 2
$ kiln bench -n 9 --list
2|kiln: bench: -n is --dry-run in other commands; write '--repeat N'
= 2
$ kiln bench -qn9 --list
2|kiln: bench: -n is --dry-run in other commands; write '--repeat N'
= 2
$ kiln bench -n
2|kiln: bench: -n is --dry-run in other commands; write '--repeat N'
= 2

Limits of metrics are not those of a job.

$ kiln compare scenes/puff.png scenes/puff.png --tolerance flip.mean=0.1 | grep flip.mean
1|  flip.mean                   0        0.1  within
$ kiln compare scenes/puff.png scenes/puff.png --limit flip.mean=0.1 | grep flip.mean
1|  flip.mean                   0        0.1  within
2|kiln: warning: compare: --limit is an older spelling of --tolerance, and version 0.3 will not know it
$ kiln compare scenes/puff.png scenes/puff.png --limit=flip.mean=0.1,psnr=30 -l ssim=0.9 | grep -E 'flip.mean|psnr|ssim'
1|  flip.mean                   0        0.1  within
1|  ssim                        1        0.9  within
1|  psnr                      inf         30  within
2|kiln: warning: compare: --limit is an older spelling of --tolerance, and version 0.3 will not know it
2|kiln: warning: compare: -l is an older spelling of --tolerance, and version 0.3 will not know it
$ kiln compare -qlabs.max=0 scenes/puff.png scenes/puff.png
2|kiln: warning: compare: -l is an older spelling of --tolerance, and version 0.3 will not know it
$ kiln compare scenes/puff.png scenes/puff.png --limit
2|kiln: warning: compare: --limit is an older spelling of --tolerance, and version 0.3 will not know it
2|kiln: compare: --tolerance: needs a value, METRIC=VALUE
= 2
$ kiln compare scenes/puff.png scenes/puff.png -limit flip.mean=0.1
2|kiln: compare: unknown option '-limit' (did you mean '--tolerance'?)
= 2
$ kiln compare scenes/puff.png scenes/puff.png --limits flip.mean=0.1
2|kiln: compare: unknown option '--limits' (did you mean '--tolerance'?)
= 2

The letters of a figure's frames.

$ kiln figure strip scenes/tiny.yaml --count 2 -o two.png && kiln figure strip scenes/tiny.yaml -n 2 -o same.png && cmp two.png same.png
2|kiln: warning: figure strip: -n is an older spelling of --count, and version 0.3 will not know it
$ kiln figure strip scenes/tiny.yaml --frames 3,5 -o two.png --force && kiln figure strip scenes/tiny.yaml -f 3,5 -o same.png --force && cmp two.png same.png
2|kiln: warning: figure strip: -f is an older spelling of --frames, and version 0.3 will not know it
$ kiln figure sheet scenes/tiny.yaml --frames 3 -o one.png && kiln figure sheet scenes/tiny.yaml -f3 -o same.png --force && cmp one.png same.png
2|kiln: warning: figure sheet: -f is an older spelling of --frames, and version 0.3 will not know it

A figure's sidecar has the command as it was given.

$ kiln figure strip scenes/tiny.yaml -n 2 -o same.png --force 2>/dev/null; kiln figure --check same.png
1|same.png: up to date
2|kiln: warning: figure strip: -n is an older spelling of --count, and version 0.3 will not know it

Commands for tests.

$ printf 'kiln_test: 1\nscene: scenes/tiny.yaml\nframes: [6]\ngolden: hash\n' >fire.test.yaml
$ kiln test fire --update missing --no-report -q --results r --test-timeout 60
$ kiln test fire --no-report -q -o r --time-limit 60
2|kiln: warning: test: -o is an older spelling of --results, and version 0.3 will not know it
2|kiln: warning: test: --time-limit is an older spelling of --test-timeout, and version 0.3 will not know it
$ kiln test fire --no-report -q --timeout 60
2|kiln: test: unknown option '--timeout' (did you mean '--test-timeout'?)
= 2
$ kiln test approve fire -o r --dry-run
1|fire: nothing to accept
2|kiln: warning: test approve: -o is an older spelling of --results, and version 0.3 will not know it
$ kiln test list -o r
1|fire
1|scenes/empty
2|kiln: warning: test list: -o is an older spelling of --results, and version 0.3 will not know it
$ kiln test calibrate fire -o r --renders 2 -q
2|kiln: warning: test calibrate: -o is an older spelling of --results, and version 0.3 will not know it
2|kiln: warning: test calibrate: --renders is an older spelling of --repeat, and version 0.3 will not know it
$ kiln test calibrate fire --results r --repeat 2 -q

The shell completes values after older spellings, and does not offer these.

$ kiln complete -- compare --limit flip.me
1|part	flip.mean=	FLIP: how different the pictures look when flipped; mean over all pixels, 0 to 1
$ kiln complete -- compare -l flip.me
1|part	flip.mean=	FLIP: how different the pictures look when flipped; mean over all pixels, 0 to 1
$ kiln complete -- compare --lim
$ kiln complete -- compare --limit flip.mean=1 --tol
1|word	--tolerance	The worst value of a metric that passes, its limit; separate several by commas (see 'kiln help metrics').

What kiln calls otherwise than people may expect.

$ kiln figure sheet scenes/tiny.yaml -o a.png --font-size 8pt
2|kiln: figure sheet: unknown option '--font-size' (did you mean '--text-size'?)
= 2
$ kiln figure sheet scenes/tiny.yaml -o a.png --theme dark
2|kiln: figure sheet: unknown option '--theme'; '--dark' draws light lettering on dark paper
= 2
$ kiln bench --runs 5
2|kiln: bench: unknown option '--runs' (did you mean '--repeat'?)
= 2
