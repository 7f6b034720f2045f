#!/usr/bin/python3
"""Attacks the worker of examples/queue: attacks.py [--smoke] [--worker WORKER] TAKEN_OVER [WAY...]

TAKEN_OVER stands for a kiln whose job has taken it over (taken_over.c); it runs in libkiln's own sandbox. If this
test fails, such a job outlives its end, keeps the worker from its next job, or gets a file of somebody else
delivered. One poisoned job never stops the others: each has its result. The worker runs in up to four ways: as
root, whose jobs have a user of their own, or as a plain user; with a cgroup for each job, or without. --smoke takes the
first and the last of these ways. --worker names another worker, such as an older one.
"""
import argparse
import json
import os
import pathlib
import pwd
import resource
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
SECRET = "the secret of somebody else"
LIMIT = 8 << 20  # bytes of `output`, as taken_over.c knows it
WORKER_BYTES = 1 << 30  # of address space
PATIENCE_S = 60 * float(os.environ.get("KILN_TEST_TIMEOUT_SCALE", "1"))
PROMPT_S = 5 * float(os.environ.get("KILN_TEST_TIMEOUT_SCALE", "1"))
# The attacks of taken_over.c: the outcome, the exit code, and what the message has.
ATTACKS = {
    "swap at the result": ("done", 0, None), "swap always": (None, 0, None), "outlive": ("done", 0, None),
    "chains": ("done", 0, None), "link": ("failed", 0, "is a link"), "loop": ("failed", 0, "is a link"),
    "second name": ("failed", 0, "hard link"), "pipe": ("done", 0, None), "folder": ("failed", 0, "is a folder"),
    "terabyte": ("failed", 0, "limit `output`"), "beyond the limit": ("failed", 0, "limit `output`"),
    "up to the limit": ("done", 0, None), "no clip": ("failed", 0, "cannot be opened: No such file"),
    "hidden files": ("done", 0, None),
    "deep": ("done", 0, None), "never started": ("failed", 1, "kiln does not say why"),
    "endless line": ("done", 0, None), "many events": ("done", 0, None), "long message": ("failed", 3, "aaaa"),
    "strange events": ("failed", 3, None),
}
problems = []


def expect(true, *text):
    if not true:
        problems.append(" ".join(map(str, text)))
        print("PROBLEM:", problems[-1], flush=True)


def owner(path):
    try:
        return path.stat().st_uid
    except OSError:
        return None


def free_user():
    """Returns the number of a user without account and process, another one for each run of this test."""
    known = {entry.pw_uid for entry in pwd.getpwall()}
    known |= {owner(place) for place in pathlib.Path("/proc").glob("[0-9]*")}
    return next(number for i in range(1000) if (number := 63000 + (os.getpid() + i) % 1000) not in known)


def lives(number):
    try:
        fields = pathlib.Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()
        return fields[0] not in "ZX" or int(fields[17]) > 1  # threads, of which the first may have ended
    except OSError:
        return False


def own_group():
    """Returns the folder of this test's cgroup of version 2, or None."""
    sys.path.insert(0, str(SOURCE / "examples/queue"))
    sys.dont_write_bytecode = True
    import processes
    return processes.hierarchy()[1]


class Way:
    """A way to run the worker, in a spool of its own."""

    def __init__(self, name, work, given):
        self.name, self.given = name, given
        self.is_root, self.has_groups = name.startswith("root"), name.endswith("cgroup")
        self.user = free_user() if os.geteuid() == 0 else os.geteuid()
        self.work = work / name.replace(" ", "-")
        self.spool, self.secret = self.work / "spool", self.work / "secret"
        (self.spool / "incoming").mkdir(parents=True)
        self.secret.write_text(SECRET)
        self.group = None
        self.own(self.work)

    def own(self, path):
        if os.geteuid() == 0 and not self.is_root:
            subprocess.run(["chown", "-hR", f"{self.user}:{self.user}", path], check=True)

    def command(self):
        """Returns how the worker starts."""
        before = []
        if self.is_root and not self.has_groups:
            before = ["unshare", "--mount", "--", "sh", "-c", 'umount -t cgroup2 -a; exec "$@"', "sh"]
        elif os.geteuid() == 0 and not self.is_root:
            before = ["setpriv", f"--reuid={self.user}", f"--regid={self.user}", "--clear-groups", "--"]
        return [*before, "/usr/bin/python3", str(self.given.worker), "--user", str(self.user), "--once", "--timeout",
                "1000", "--kiln", str(self.given.taken_over), str(self.spool)]

    def prepare(self):
        """Limits the worker's memory. Moves it to a cgroup that belongs to its user."""
        resource.setrlimit(resource.RLIMIT_AS, (WORKER_BYTES, WORKER_BYTES))
        if self.group:
            (self.group / "cgroup.procs").write_text("0")

    def begin(self):
        return subprocess.Popen(self.command(), preexec_fn=self.prepare, stdin=subprocess.DEVNULL)

    def make_group(self):
        """Makes a cgroup as systemd does for a unit with Delegate=, or as `systemd-run --user` has one."""
        if not self.is_root and self.has_groups:
            self.group = own_group() / f"kiln-attacks-{os.getpid()}"
            self.group.mkdir()
            for path in (self.group, self.group / "cgroup.procs"):
                os.chown(path, self.user, self.user)

    def bring(self, name, attack, make=lambda root: None):
        root = self.spool / "incoming" / ".new"
        root.mkdir()
        (root / "attack").write_text(f"{attack}\n{self.secret}\n")
        make(root)
        self.own(root)
        if (root / "mode").exists():
            root.chmod(int((root / "mode").read_text(), 8))
        root.rename(self.spool / "incoming" / name)

    def report(self):
        path = self.spool / "report.ndjson"
        lines = path.read_text().splitlines() if path.exists() else []
        return [json.loads(line) for line in lines if line.endswith("}")]

    def results(self):
        return {line["job"]: line for line in self.report() if line["outcome"] != "again"}

    def left(self):
        """Returns the processes that jobs have left and that live."""
        numbers = []
        for events in self.spool.glob("*/*/events.*.ndjson"):
            with open(events, errors="replace") as file:
                for line in iter(lambda: file.readline(1000), ""):
                    if '"left"' in line:
                        numbers.append(json.loads(line)["process"])
                    elif line[0] == "\0":
                        break
        # Another process may have the number of one that has ended.
        living = {number for number in numbers if owner(pathlib.Path(f"/proc/{number}")) == self.user and lives(number)}
        for _ in range(20 if os.geteuid() == 0 else 0):  # some have another number at each moment
            living |= {int(place.name) for place in pathlib.Path("/proc").glob("[0-9]*")
                       if owner(place) == self.user and lives(place.name)}
        return sorted(living)

    def wait_for(self, what, condition):
        end = time.monotonic() + PATIENCE_S
        while not condition():
            if time.monotonic() > end:
                expect(False, self.name, what, "does not come about")
                return
            time.sleep(0.01)

    def end(self, worker):
        """Waits for the end of a worker. Returns how long that took."""
        start = time.monotonic()
        try:
            code = worker.wait(PATIENCE_S)
            expect(code == 0, self.name, "the worker ends with", code)
        except subprocess.TimeoutExpired:
            expect(False, self.name, "the worker hangs")
            worker.kill()
            worker.wait()
        return time.monotonic() - start

    # ---- attacks

    def attack_at_once(self):
        """Gives the worker all attacks in one queue, with good jobs between them."""
        for number, attack in enumerate(ATTACKS):
            self.bring(f"{number:02} {attack}", attack)
            self.bring(f"{number:02} and a good one", "good")
        seconds = self.end(self.begin())
        results = self.results()
        for number, (attack, (outcome, code, says)) in enumerate(ATTACKS.items()):
            good = results.get(f"{number:02} and a good one", {})
            expect(good.get("outcome") == "done", self.name, "the good job after", attack, "is", good)
            found = results.get(name := f"{number:02} {attack}", {})
            expect(found.get("code") == code and (outcome or found.get("outcome")) == found.get("outcome") and
                   (says or "") in found.get("message", ""), self.name, attack, "is", str(found)[:300])
            expect(len(str(found)) < 5000, self.name, attack, "has a result of", len(str(found)), "characters")
            self.look_at_delivery(name, found)
        expect(not (left := self.left()), self.name, "processes outlive their jobs:", left)
        slowest = max(results.values(), key=lambda line: line["seconds"], default={"seconds": 0})
        expect(slowest["seconds"] < 5 * PROMPT_S, self.name, "a job takes long:", slowest)
        print(f"{self.name}: {len(results)} jobs in {seconds:.1f} s")

    def look_at_delivery(self, name, result):
        clip = self.spool / "done" / name / "clip.mp4"
        if result.get("outcome") != "done":
            expect(not os.path.lexists(clip), self.name, name, "is delivered and failed")
            return
        status = clip.lstat() if os.path.lexists(clip) else None
        expect(status and stat.S_ISREG(status.st_mode) and status.st_nlink == 1, self.name, name,
               "delivers what is no file of its own")
        expect(not clip.exists() or SECRET.encode() not in clip.read_bytes(), self.name, name, "DELIVERS THE SECRET")
        if status:
            expect(status.st_uid == (0 if self.is_root else self.user), self.name, name, "is of", status.st_uid)
            expect(status.st_size == result["bytes"] and status.st_blocks * 512 <= 64 << 10, self.name, name, "takes",
                   status.st_blocks * 512, "bytes")
        rest = sorted(os.listdir(clip.parent))
        expect(rest == ["clip.mp4", "events.1.ndjson", "messages", "result.json"], self.name, name, "keeps", rest)

    def attack_names(self):
        """Submits names that leave no room for a number, twice, and other names that are hard to handle."""
        names = ["n" * 254, "m" * 255, "ü" * 127, "--help", "a\nb", os.fsdecode(b"\xff\xfe"), "*", "a" * 250 + ".2"]
        for _ in range(3):
            for name in names:
                self.bring(name, "good")
            self.end(self.begin())
        report = [line for line in self.report() if line["job"] in names]
        expect(len(report) == 3 * len(names) and all(line["outcome"] == "done" for line in report), self.name,
               "the names lead to", [(line["job"][:9], line["outcome"]) for line in report])
        expect(not os.listdir(self.spool / "incoming") and not os.listdir(self.spool / "running"), self.name,
               "names are left")

    def look_from_outside(self, output):
        """Looks at a job that runs as somebody else would: it may have made a program with a set-uid bit for him."""
        if os.geteuid() == 0:
            found = subprocess.run(["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "ls", output,
                                    self.spool / "cache"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            expect(not found.stdout, self.name, "others see the files of a job")

    def attack_removals(self):
        """Removes a job that waits, and one that runs."""
        for name, attack in (("a waits", "wait for go"), ("b removed", "good"), ("c removed", "wait for removal"),
                             ("d good", "good")):
            self.bring(name, attack)
        worker = self.begin()
        running = self.spool / "running"
        self.wait_for("a job that waits", (running / "a waits/output").exists)
        self.look_from_outside(running / "a waits/output")
        shutil.rmtree(self.spool / "incoming/b removed")
        (running / "a waits/job/go").touch()
        self.wait_for("a job to remove", lambda: (running / "c removed/messages").exists())
        time.sleep(0.1)
        (running / "c removed").rename(self.work / "removed")
        shutil.rmtree(self.work / "removed")
        self.end(worker)
        found = {name: line["outcome"] for name, line in self.results().items() if name[1:] in
                 (" waits", " removed") or name == "d good"}
        expect(found == {"a waits": "done", "c removed": "failed", "d good": "done"}, self.name, "removed:", found)

    def attack_with_files(self):
        """Submits folders that hide a hard link, or that are hard to read, to move and to remove."""
        jobs = {
            "hidden 0311": (lambda root: hide(root, self.secret, 0o311), "failed"),
            "hidden 0000": (lambda root: hide(root, self.secret, 0), "failed"),
            "hard link": (lambda root: os.link(self.secret, root / "a"), "failed"),
            "fifo": (lambda root: os.mkfifo(root / "a"), "failed"),
            "loop": (lambda root: os.symlink("a", root / "a"), "done"),
            "deep": (lambda root: deepen(root, 100), "failed"),
            "deeper than paths": (lambda root: deepen(root, 2100), "failed"),
            "long names": (lambda root: deepen(root, 60, "n" * 250), "failed"),
            "read only": (lambda root: (root / "mode").write_text("555"), "done"),
            "no rights": (lambda root: (root / "mode").write_text("0"), "done"),
        }
        if os.geteuid() == 0:
            jobs["device"] = (lambda root: os.mknod(root / "a", stat.S_IFCHR | 0o666, os.makedev(1, 3)), "failed")
        if self.is_root:
            jobs["no rights"] = (jobs["no rights"][0], "failed")  # the jobs' user cannot read it
        for name, (make, _) in jobs.items():
            self.bring(f"files {name}", "good", make)
        (self.spool / "incoming/files none").touch()
        os.mkfifo(self.spool / "incoming/files pipe")
        os.symlink("/etc", self.spool / "incoming/files link")
        (self.spool / "running").mkdir(exist_ok=True)
        (self.spool / "running/files stray").touch()
        (self.spool / "running/files broken").mkdir()
        (self.spool / "running/files broken/result.json").write_text("{")
        self.own(self.spool)
        self.bring("files then a good one", "good")
        self.end(self.begin())
        wanted = {f"files {name}": outcome for name, (_, outcome) in jobs.items()}
        wanted |= {f"files {name}": "failed" for name in ("none", "pipe", "link", "stray", "broken")}
        wanted["files then a good one"] = "done"
        results = self.results()
        found = {name: results.get(name, {}).get("outcome") for name in wanted}
        expect(found == wanted, self.name, "files:",
               {name: results.get(name) for name in wanted if wanted[name] != found[name]})
        longest = max(len(str(result)) for result in results.values())
        expect(longest < 5000, self.name, "a result has", longest, "characters")
        for name, outcome in wanted.items():
            expect((self.spool / outcome / name / "result.json").exists(), self.name, name, "is not in", outcome)
        expect(self.secret.read_text() == SECRET and os.listdir("/etc"), self.name, "a file of others has changed")

    def attack_with_places(self):
        """Begins with jobs that were running, whose outputs are of somebody else, or lie elsewhere."""
        elsewhere = self.work / "elsewhere"
        elsewhere.mkdir()
        (elsewhere / "clip.mp4").write_text(SECRET)
        owned, linked = (self.spool / "running" / f"places {name}" for name in ("owned", "linked"))
        for place in (owned, linked):
            (place / "job").mkdir(parents=True)
            (place / "job/attack").write_text("no clip\n")
        self.own(self.spool)
        os.symlink(elsewhere, linked / "output")
        (owned / "output").mkdir()
        if os.geteuid() == 0:
            os.chown(owned / "output", self.user, self.user)
        (owned / "output/clip.mp4").write_text(SECRET)
        before = elsewhere.stat().st_uid
        self.end(self.begin())
        results = self.results()
        if os.geteuid() == 0:
            expect("belongs to the user 0" in results["places owned"]["message"], self.name, results["places owned"])
        expect(results["places linked"]["outcome"] == "failed", self.name, results["places linked"])
        expect(elsewhere.stat().st_uid == before and (elsewhere / "clip.mp4").exists(), self.name,
               "a folder of others has changed")

    def attack_disk(self):
        """Lets a job fill the disk, which is small. The next job has room again, and the report has both."""
        options = "size=4m,nr_inodes=500,mode=755"
        if not self.is_root or subprocess.run(["mount", "-t", "tmpfs", "-o", options, "none", self.spool],
                                              stderr=subprocess.DEVNULL).returncode:
            return
        try:
            (self.spool / "incoming").mkdir()
            attacks = ("fill the disk", "fill by events", "fill by messages", "fill the cache", "many files")
            for number, attack in enumerate(attacks):
                self.bring(f"{number} fills", attack)
                self.bring(f"{number} good", "good")
            self.end(self.begin())
            found = {(line["job"], line["outcome"]) for line in self.report()}
            expect({(f"{i} {name}", outcome) for name, outcome in (("fills", "failed"), ("good", "done"))
                    for i in range(len(attacks))} <= found, self.name, "a full disk leads to", found)
        finally:
            subprocess.run(["umount", self.spool], check=True)

    def attack_next_worker(self, name, attack, processes):
        """Kills a worker. Its job tries to live on, to keep the lock, and to disturb its own second try."""
        self.bring(name, attack)
        worker = self.begin()
        events = self.spool / "running" / name / "events.1.ndjson"
        self.wait_for("the job's processes",
                      lambda: events.exists() and events.read_text().count('"left"') == processes)
        worker.kill()
        worker.wait()
        group = int((self.spool / "session").read_text().split()[1])
        seconds = self.end(self.begin())
        expect(not self.lives_as_group(group), self.name, "the group of the job outlives its worker")
        result = self.results().get(name, {})
        expect(result.get("outcome") == "done", self.name, "the job of a killed worker is", result)
        expect(seconds < PROMPT_S, self.name, "the next worker takes", round(seconds, 1), "s")
        expect(not (left := self.left()), self.name, "processes outlive their worker:", left)
        print(f"{self.name}: the next worker took {seconds:.2f} s")

    def lives_as_group(self, group):
        """Returns whether a process group has a process: one that always forks is seldom seen in /proc."""
        for _ in range(50):
            try:
                os.killpg(group, 0)
            except ProcessLookupError:
                return False
            time.sleep(0.02)  # init may have to collect what has ended
        return True

    def attack_next_workers(self):
        self.attack_next_worker("next", "next worker", 3)
        self.attack_next_worker("hidden", "hidden from the next worker", 2)

    def attack_stop(self):
        """Stops a worker whose job does not end when it is told to. That is no try of the job."""
        self.bring("stays", "stay")
        worker = self.begin()
        events = self.spool / "running/stays/events.1.ndjson"
        self.wait_for("the job that stays", lambda: events.exists() and '"left"' in events.read_text())
        worker.terminate()
        seconds = self.end(worker)
        expect(seconds < 2 * PROMPT_S, self.name, "the worker ends", round(seconds, 1), "s after SIGTERM")
        expect(not (left := self.left()), self.name, "processes outlive their worker:", left)
        expect(not events.exists() and "stays" not in self.results(), self.name, "a job that stays counts as tried")
        (self.spool / "running/stays/job/go").touch()
        self.end(self.begin())
        expect(self.results().get("stays", {}).get("outcome") == "done", self.name, self.results().get("stays"))

    def run(self):
        self.make_group()
        try:
            for attack in (self.attack_at_once, self.attack_names, self.attack_removals, self.attack_with_files,
                           self.attack_with_places, self.attack_disk, self.attack_next_workers, self.attack_stop):
                attack()
        finally:
            for number in self.left():
                try:
                    os.kill(number, signal.SIGKILL)
                except ProcessLookupError:
                    continue
            if self.group:
                left = [entry.name for entry in self.group.iterdir() if entry.is_dir()]
                expect(not left, self.name, "leaves cgroups:", left)
                if not left:
                    self.group.rmdir()


def hide(root, secret, mode):
    (root / "folder").mkdir()
    os.link(secret, root / "folder/link")
    (root / "folder").chmod(mode)


def deepen(root, many, name="d"):
    """Makes folders in each other, with a FIFO in the last."""
    here = os.open(".", os.O_PATH)
    os.chdir(root)
    for _ in range(many):
        os.mkdir(name)
        os.chdir(name)
    os.mkfifo("fifo")
    os.fchdir(here)
    os.close(here)


def ways():
    """Returns the ways in which the worker can run here."""
    if os.geteuid() != 0:
        return ["user"]
    group = own_group()
    can_group = group and os.access(group, os.W_OK) and (group / "cgroup.procs").exists()
    can_unshare = subprocess.run(["unshare", "--mount", "true"], stderr=subprocess.DEVNULL).returncode == 0
    return [*(["root cgroup"] if can_group else []), *(["root"] if can_unshare else []),
            *(["user cgroup"] if can_group else []), "user"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--smoke", action="store_true")
    parser.add_argument("--worker", type=pathlib.Path, default=SOURCE / "examples/queue/worker.py")
    parser.add_argument("taken_over", type=pathlib.Path)
    parser.add_argument("ways", nargs="*")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="kiln-attacks-") as work:
        work = pathlib.Path(os.path.realpath(work))
        work.chmod(0o755)
        shutil.copy(given.taken_over, work / "kiln")  # the user of the jobs can start it here
        given.taken_over = work / "kiln"
        found = given.ways or ways()
        for name in dict.fromkeys([found[0], found[-1]] if given.smoke else found):
            Way(name, work, given).run()
        # Python's own removal fails at deep folders, and rm at those without rights.
        for command in (["chmod", "-R", "u+rwx"], ["rm", "-rf"]):
            subprocess.run([*command, *work.iterdir()], stderr=subprocess.DEVNULL)
    print(f"{len(problems)} problems")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
