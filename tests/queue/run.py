#!/usr/bin/python3
"""Tests the worker of examples/queue with 200 jobs, 60 of them bad: run.py [--smoke] KILN.

If this fails, a service that renders scenes of strangers loses jobs, gives wrong clips, or lets a
job reach files of others. The worker is killed once and stopped once on the way. In the end, every
good clip must have the bytes of a plain `kiln render`, every bad job must be reported with its
cause, and nothing else may be left: no file, no process, no shared memory. As root, the test runs
jobs as a user of their own. --smoke has 13 jobs.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import pwd
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import jobs

WORKER = jobs.SOURCE / "examples/queue/worker.py"
PATIENCE_S = 1800
CAUSE = re.compile(r"job/scene\.yaml(:\d+:\d+)?: .|.*the limit `\w+`|output/clip\.mp4: .|job/[^:]+: has another name"
                   r"|job/[^:]+: is a (FIFO|socket|device)$")
# The paths that may lie in the spool when all jobs are done.
KEPT = re.compile(r"lock|session|report\.ndjson|cache(/kiln(/\w+\.\w+)?)?|incoming|running|done|failed"
                  r"|(done|failed)/[^/]+(/(result\.json|events\.\d\.ndjson|messages))?|done/[^/]+/clip\.mp4"
                  r"|failed/[^/]+/(job(/.*)?|secret\.txt)")
CACHE_BYTES = 512 << 20  # the limit of the cache that docs/service.md promises
problems = []


def expect(true, *text):
    if not true:
        problems.append(" ".join(map(str, text)))
        print("PROBLEM:", problems[-1], flush=True)


def processes(user, programs):
    """Returns the processes of the programs in a folder and, as root, those of the jobs' user."""
    found = []
    for place in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            program = os.readlink(place / "exe")
            if program.startswith(str(programs)) or (os.geteuid() == 0 and place.stat().st_uid == user):
                found.append(int(place.name))
        except OSError:  # it has ended, or is of another user
            continue
    return found


def fresh_user():
    """Returns a user number without account and process; without root, that of the present user."""
    if os.geteuid() != 0:
        return os.geteuid()
    known = {entry.pw_uid for entry in pwd.getpwall()} | {
        place.stat().st_uid for place in pathlib.Path("/proc").glob("[0-9]*") if place.exists()}
    return next(number for number in range(64000, 65000) if number not in known)


def files_elsewhere(user):
    """Returns temporary files and shared memory of the user, which no job may leave behind."""
    if os.geteuid() != 0:
        return []
    found = subprocess.run(["find", "/tmp", "/var/tmp", "/dev/shm", "-maxdepth", "2", "-uid", str(user)],
                           capture_output=True, text=True).stdout.splitlines()
    segments = pathlib.Path("/proc/sysvipc/shm").read_text().splitlines()[1:]
    return found + [f"shared memory {line.split()[1]}" for line in segments if line.split()[7] == str(user)]


def kibibytes(name):
    return int(re.search(rf"^{name}: +(\d+)", pathlib.Path("/proc/meminfo").read_text(), re.MULTILINE)[1])


def wait_for(what, condition):
    start = time.monotonic()
    while not condition():
        if time.monotonic() > start + PATIENCE_S:
            sys.exit(f"{what} does not come about")
        time.sleep(0.05)


class Queue:
    def __init__(self, work, kiln, smoke):
        self.user = fresh_user()
        self.spool, self.made, self.programs = work / "spool", work / "made", work / "bin"
        self.programs.mkdir()
        shutil.copy(kiln, self.programs / "kiln")  # the user of the jobs can start programs here
        shutil.copytree(kiln.parent / "libexec", self.programs / "libexec")
        self.kiln = self.programs / "kiln"
        (self.spool / "incoming").mkdir(parents=True)
        chosen = [job for job in [*jobs.good(kiln), *jobs.bad(smoke)] if job.smoke or not smoke]
        first, rest = chosen[0], chosen[1:]
        random.Random(1).shuffle(rest)
        self.jobs = {f"{i:03}-{re.sub('[^A-Za-z0-9]+', '-', job.name)}": job for i, job in enumerate([first, *rest])}

    def bring(self):
        """Makes all jobs in incoming/; good ones also in `made`, for a plain `kiln render`."""
        for name, job in self.jobs.items():
            root = self.made / name / "root"
            root.mkdir(parents=True)
            job.make(root)
            hidden = self.spool / "incoming" / f".{name}"
            if job.code == 0:
                shutil.copytree(root, hidden)
            else:
                root.rename(hidden)
            if job.kind == "bad paths":  # a secret lies where the bad paths lead
                (self.spool / "running" / name).mkdir(parents=True)
                (self.spool / "running" / name / "secret.txt").write_text(jobs.paths.SECRET)
            hidden.rename(self.spool / "incoming" / name)

    def start(self):
        return subprocess.Popen(["/usr/bin/python3", WORKER, "--once", "--user", str(self.user), "--kiln", self.kiln,
                                 "--limits", jobs.LIMITS, "--timeout", str(jobs.TIMEOUT_S), self.spool])

    def report(self):
        path = self.spool / "report.ndjson"
        return [json.loads(line) for line in path.read_text().split("\n")[:-1]] if path.exists() else []

    def play(self):
        """Runs the worker until all jobs are done, and disturbs it.

        The worker is killed when the first part of the first clip is whole. Started again, it
        resumes that job, and kiln is killed. The worker is stopped by SIGTERM when half of the jobs
        are done.
        """
        name = next(iter(self.jobs))
        journal = self.spool / "running" / name / "output/clip.mp4.journal"
        worker = self.start()
        wait_for("a whole part", lambda: journal.exists() and '{"part"' in journal.read_text())
        running = [path.read_text() for number in processes(self.user, self.programs)
                   if (path := pathlib.Path(f"/proc/{number}/status")).exists()]
        for status in running:
            expect(f"\nUid:\t{self.user}\t{self.user}\t{self.user}\t" in status, "a job has the rights of", status)
            expect("\nNoNewPrivs:\t1\n" in status and "\nCapEff:\t0000000000000000\n" in status, "a job can get rights")
        expect(running, "no job runs when its first part is there")
        worker.kill()
        worker.wait()
        wait_for("the end of a job whose worker was killed", lambda: not processes(self.user, self.programs))
        expect(not journal.with_suffix("").exists(), "the job has gone on without its worker")
        worker = self.start()
        wait_for("the job again", lambda: (self.spool / "running" / name / "events.2.ndjson").exists() and
                 processes(self.user, self.programs))
        for number in processes(self.user, self.programs):
            os.kill(number, signal.SIGKILL)
        wait_for("half of the jobs", lambda: len(self.report()) > len(self.jobs) // 2)
        wait_for("the next job", lambda: processes(self.user, self.programs))
        worker.send_signal(signal.SIGTERM)
        start = time.monotonic()
        expect(worker.wait(60) == 0, "the worker ends with", worker.returncode, "after SIGTERM")
        print(f"stopped within {time.monotonic() - start:.2f} s, when {len(self.report())} jobs were done")
        expect(not processes(self.user, self.programs), "a job runs on after SIGTERM")
        tried = {path.parent.name for path in self.spool.glob("running/*/events.*")}
        expect(tried <= {name}, "a job that was stopped has lost one of its tries:", tried)
        expect(self.start().wait(PATIENCE_S) == 0, "the worker does not end well")
        again = [(line["job"], line["code"]) for line in self.report() if line["outcome"] == "again"]
        expect(again == [(name, 137)], "tried again are", again)
        third = (self.spool / "done" / name / "events.3.ndjson").read_text()
        kept = [json.loads(line)["kept"] for line in third.splitlines() if '"event": "result"' in line]
        expect(kept and kept[0] > 0, "the job that was killed begins anew:", kept)
        print(f"the job that was killed twice kept {kept} frames")

    def plain(self, name):
        """Returns the SHA-256 of the clip that a plain `kiln render` makes of a job's scene."""
        clip = self.made / name / "clip.mp4"
        subprocess.run([self.kiln, "render", self.made / name / "root/scene.yaml", "--device", "cpu", "-q", "-o", clip],
                       check=True, env=dict(os.environ, XDG_CACHE_HOME=str(self.made)))
        return hashlib.sha256(clip.read_bytes()).hexdigest()

    def judge(self):
        """Compares the report and the clips of all jobs with what is expected."""
        lines = collections.defaultdict(list)
        for line in self.report():
            if line["outcome"] != "again":
                lines[line["job"]].append(line)
        expect(set(lines) == set(self.jobs), "reported are others:", set(lines) ^ set(self.jobs))
        good = [name for name, job in self.jobs.items() if job.code == 0]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            sums = dict(zip(good, pool.map(self.plain, good)))
        expect(len(set(sums.values())) == len(good), "some of the good clips are the same")
        for name, job in self.jobs.items():
            expect(len(lines[name]) == 1, name, "has so many results:", len(lines[name]))
            line = lines[name][0]
            expect(line["code"] == job.code, name, "ends with", line)
            expect(line["outcome"] == ("failed" if job.code else "done"), name, "is", line)
            if job.code == 0:
                clip = self.spool / "done" / name / "clip.mp4"
                expect(clip.exists() and hashlib.sha256(clip.read_bytes()).hexdigest() == sums[name] == line["sha256"],
                       name, "is another clip")
            else:
                expect(CAUSE.match(line["message"]) and job.says in line["message"] and
                       tells_no_secret(line["message"]), name, "says", line["message"])
                expect((self.spool / "failed" / name / "job").is_dir(), name, "is not in failed/")
        self.show({name: found[0] for name, found in lines.items()})

    def show(self, lines):
        print(f"\n{'kind':12} jobs  done failed  codes     seconds")
        for kind in sorted({job.kind for job in self.jobs.values()}):
            found = [lines[name] for name, job in self.jobs.items() if job.kind == kind]
            done = sum(line["outcome"] == "done" for line in found)
            codes = " ".join(map(str, sorted({line["code"] for line in found})))
            print(f"{kind:12} {len(found):4} {done:5} {len(found) - done:6}  {codes:8} "
                  f"{sum(line['seconds'] for line in found):8.1f}")
        done = sum(line["outcome"] == "done" for line in lines.values())
        print(f"{'all':12} {len(lines):4} {done:5} {len(lines) - done:6}  {'':8} "
              f"{sum(line['seconds'] for line in lines.values()):8.1f}\n\nfailed, as they should:")
        for name, job in self.jobs.items():
            if job.code:
                line = lines[name]
                print(f"{job.kind:12} {job.name:32} {line['code']} {line['seconds']:5.2f} s  "
                      f"{ascii(line['message'])[1:-1][:110]}")

    def look_around(self):
        """Checks that the jobs have left nothing else behind. Returns the bytes of the spool."""
        expect(not processes(self.user, self.programs), "processes are left")
        expect(not (left := files_elsewhere(self.user)), "it left", left)
        expect(not os.listdir(self.spool / "incoming") and not os.listdir(self.spool / "running"), "jobs are left")
        sizes = collections.Counter()
        for path in self.spool.rglob("*"):
            name = str(path.relative_to(self.spool))
            expect(KEPT.fullmatch(name), "the spool has", name)
            sizes[name.split("/")[0]] += path.lstat().st_blocks * 512
        expect(sizes["cache"] <= CACHE_BYTES, "the cache has", sizes["cache"], "bytes")
        print("\nthe spool, in KiB: " + ", ".join(f"{name} {size >> 10}" for name, size in sorted(sizes.items())))
        return sum(sizes.values())


# A program in place of kiln, which misbehaves in the way that the job's name says.
DOUBLE = """#!/bin/sh
if [ "$1" = help ]; then echo 'output        64 GiB      as kiln says it'; exit; fi
echo '{"event": "started"}'
case $PWD in
*/disk) echo '{"event": "error", "message": "no room"}'; echo '{"event": "ended", "code": 6, "again": "again"}'; exit 6 ;;
*/crash) kill -SEGV $$ ;;
*/link) ln -s /etc/passwd output/clip.mp4 ;;
*/pipe) mkfifo output/clip.mp4 ;;
*/hard) echo >output/a; ln output/a output/clip.mp4 ;;
*/leaves) sleep 60 & echo "{\\"event\\": \\"left\\", \\"process\\": $!}"; echo >output/clip.mp4 ;;
*/begun) echo >output/clip.mp4 ;;
*/nothing) ;;
esac
"""


def play_double(work, user):
    """Tests the worker with failures that kiln does not show, and with jobs of a killed worker."""
    double, spool = work / "double", work / "double-spool"
    double.write_text(DOUBLE)
    double.chmod(0o755)
    for name in ("disk", "crash", "link", "pipe", "hard", "leaves", "nothing", "a file"):
        (spool / "incoming" / name).mkdir(parents=True)
    (spool / "incoming/a file").rmdir()
    (spool / "incoming/a file").touch()
    (spool / "running/empty").mkdir(parents=True)
    (spool / "running/known/output").mkdir(parents=True)
    (spool / "running/known/clip.mp4").touch()
    for name, tries in (("begun", 1), ("given up", 3)):  # the worker was killed during the last try
        (spool / "running" / name / "job").mkdir(parents=True)
        for i in range(tries):
            (spool / "running" / name / f"events.{i + 1}.ndjson").touch()
    known = json.dumps({"job": "known", "outcome": "done", "code": 0})
    (spool / "running/known/result.json").write_text(known + "\n")
    (spool / "report.ndjson").write_text('{"job": "half a li')
    (spool / "done/known").mkdir(parents=True)  # by an earlier job
    command = ["/usr/bin/python3", WORKER, "--once", "--user", str(user), "--kiln", double, "--timeout", "1", spool]
    workers = [subprocess.Popen(command) for _ in range(2)]  # the second waits for the first
    expect([worker.wait(PATIENCE_S) for worker in workers] == [0, 0], "two workers of a spool do not end well")
    half, *lines = (spool / "report.ndjson").read_text().splitlines()
    expect(half == '{"job": "half a li' and lines[0] == known, "the report begins with", half, lines[0])
    told = collections.defaultdict(list)
    for line in map(json.loads, lines[1:]):
        told[line["job"]].append((line["outcome"], line["code"], line.get("message")))
    wanted = {"disk": 2 * [("again", 6, "no room")] + [("failed", 6, "no room")],
              "crash": 2 * [("again", 139, "kiln does not say why")] + [("failed", 139, "kiln does not say why")],
              "a file": [("failed", 3, "job: is not a folder")],
              "begun": [("done", 0, None)], "leaves": [("done", 0, None)],
              "given up": [("failed", 137, "given up after 3 tries: the worker or the machine went down during the last")]}
    for name in ("link", "pipe", "hard", "nothing"):
        wanted[name] = [("failed", 0, told[name][0][2])]
        expect("kiln ended well, and yet: " in str(told[name][0][2]), name, "is", told[name])
    expect(told == wanted, "reported are", dict(told))
    left = json.loads((spool / "done/leaves/events.1.ndjson").read_text().splitlines()[1])["process"]
    expect(not os.path.exists(f"/proc/{left}/exe"), "what a job has started runs on when the job is done")
    expect((spool / "done/begun/events.2.ndjson").exists(), "a try that the worker did not see the end of is none")
    expect(sorted(os.listdir(spool / "done")) == ["begun", "known", "known.2", "leaves"] and (spool / "done/known.2/clip.mp4").exists() and
           not os.listdir(spool / "running"), "it leaves", sorted(spool.rglob("*")))
    if os.geteuid() == 0:
        done = subprocess.run([*command[:3], spool], capture_output=True, text=True)
        expect(done.returncode and "do not run as root" in done.stderr, "it runs jobs as root", done.stderr)


def tells_no_secret(text):
    return jobs.paths.SECRET not in text and "root:x:" not in text


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--smoke", action="store_true")
    parser.add_argument("kiln", type=pathlib.Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="kiln-queue-") as work:
        work = pathlib.Path(os.path.realpath(work))
        work.chmod(0o711)
        queue = Queue(work, given.kiln.resolve(), given.smoke)
        queue.bring()
        os.sync()
        disk, memory, shared = shutil.disk_usage(work).used, kibibytes("MemAvailable"), kibibytes("Shmem")
        start = time.monotonic()
        queue.play()
        seconds = time.monotonic() - start
        kept = queue.look_around()
        os.sync()
        print(f"the whole disk has {(shutil.disk_usage(work).used - disk) >> 10:+} KiB, the machine "
              f"{kibibytes('MemAvailable') - memory:+} KiB available, {kibibytes('Shmem') - shared:+} KiB shared; "
              f"the spool keeps {kept >> 10} KiB")
        queue.judge()
        play_double(work, queue.user)
    print(f"{len(queue.jobs)} jobs in {seconds:.0f} s, {len(problems)} problems")
    return bool(problems)


sys.exit(main())
