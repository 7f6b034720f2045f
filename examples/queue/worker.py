"""Renders the jobs of a spool folder in turn, for scenes from untrusted people (docs/service.md).

To submit a job, make a folder SPOOL/incoming/.NAME with scene.yaml and its files, which the user of the jobs can
read, and rename it to NAME. Jobs run in the order of their names. The worker moves a finished job to
SPOOL/done/NAME, with clip.mp4, or to SPOOL/failed/NAME, with the job as it came, and adds a line to
SPOOL/report.ndjson. The worker may be killed at any moment: when it starts, it goes on with the jobs in
SPOOL/running.
"""
import argparse
import fcntl
import hashlib
import itertools
import json
import os
import pathlib
import pwd
import select
import shutil
import signal
import stat
import subprocess
import sys
import time
import types

TRIES = 3  # the most tries of a job that may succeed when it is run again, or during which the worker went down
GRACE_S = 10  # seconds from --timeout until SIGTERM, and from there until SIGKILL
now = types.SimpleNamespace(stopping=False, job=None)  # job: the pidfd of the kiln that runs


def stop(*_):
    now.stopping = True
    if now.job is not None:
        signal.pidfd_send_signal(now.job, signal.SIGTERM)


def write_durably(path, text, mode):
    with open(path, mode, encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())


def hard_link(place):
    """Returns a file of the job that has another hard link, or None. Such a file may belong to somebody else."""
    for folder, _, names in os.walk(place / "job"):
        for name in names:
            path = pathlib.Path(folder, name)
            if path.lstat().st_nlink != 1:
                return path.relative_to(place)
    return None


def begin_try(events):
    """Creates the file of events, which counts the try, durably before kiln runs: the try may take the machine
    down."""
    write_durably(events, "", "w")
    folder = os.open(events.parent, os.O_RDONLY | os.O_DIRECTORY)
    os.fsync(folder)
    os.close(folder)


def run_kiln(place, events, given):
    """Runs kiln for the job in a folder and returns its exit code as a shell does (128 + the signal's number)."""
    rights = ["setpriv", "--no-new-privs", "--pdeathsig=KILL"]
    if given.user:
        rights += [f"--reuid={given.user[0]}", f"--regid={given.user[1]}", "--clear-groups"]
    for folder in ("output", "tmp"):
        (place / folder).mkdir(exist_ok=True)
        if given.user:
            os.chown(place / folder, *given.user)
    with open(events, "wb") as told, open(place / "messages", "wb") as messages:
        # kiln inherits the lock: if this worker is killed, the next one waits until kiln has ended.
        process = subprocess.Popen(
            [*rights, "--", given.kiln, "render", "job/scene.yaml", "--asset-root", "job", "--device", "cpu",
             "--sandbox=require", "--limits", given.limits, "--timeout", str(given.timeout), "--resume",
             "--events", "ndjson", "--quiet", "-o", "output/clip.mp4"],
            env={"PATH": os.defpath, "HOME": place / "tmp", "TMPDIR": place / "tmp",
                 "XDG_CACHE_HOME": given.spool / "cache"},
            cwd=place, stdin=subprocess.DEVNULL, stdout=told, stderr=messages, start_new_session=True,
            pass_fds=[given.lock])
    end = now.job = os.pidfd_open(process.pid)
    if now.stopping:
        process.terminate()
    for patience_s, then in ((given.timeout + GRACE_S, signal.SIGTERM), (GRACE_S, signal.SIGKILL), (None, 0)):
        if select.select([end], [], [], patience_s)[0]:
            break
        os.killpg(process.pid, then)
    os.killpg(process.pid, signal.SIGKILL)  # ends processes that kiln left; the number stays taken until wait()
    now.job = None
    os.close(end)
    code = process.wait()
    return code if code >= 0 else 128 - code


def what_kiln_told(place, events):
    """Reads the events of a try. Returns the first error, whether to run the job again, and whether kiln started."""
    message, again, started = "", True, False
    with open(events, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            try:
                event = json.loads(line)
                started = started or event["event"] == "started"
                if event["event"] == "error":
                    message = message or str(event["message"])
                if event["event"] == "ended":
                    # Memory that is short now (exit code 5) may be free later. Limits (exit code 8) do not change.
                    again = event["again"] == "again" or event["code"] == 5
            except (ValueError, LookupError, TypeError, RecursionError):  # half a line (a full disk), or no event
                continue
    with open(place / "messages", encoding="utf-8", errors="replace") as said:
        return message or said.read(1000).strip() or "kiln does not say why", again, started


def look_at_clip(place, given):
    """Returns the size and SHA-256 of the clip, and makes the worker its owner. The job could write to the folder,
    so the clip may be a link or a device, which is refused."""
    clip = os.open(place / "output/clip.mp4", os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    with open(clip, "rb") as file:
        status = os.fstat(clip)
        if not stat.S_ISREG(status.st_mode) or status.st_nlink != 1:
            raise OSError("output/clip.mp4 is not a file, or has another name, too (a hard link)")
        if given.user:
            os.fchown(clip, 0, 0)
        return {"bytes": status.st_size, "sha256": hashlib.file_digest(file, "sha256").hexdigest()}


def render(place, given):
    """Runs a job once. Returns its result, or None if the worker was told to stop."""
    tries = len(list(place.glob("events.*"))) + 1
    if not stat.S_ISDIR(os.lstat(place / "job").st_mode):
        return {"outcome": "failed", "code": 3, "message": "job: is not a folder"}
    if link := hard_link(place):
        return {"outcome": "failed", "code": 3, "message": f"{link}: has another name, too (a hard link)"}
    if tries > TRIES:  # the try before this one has no result
        return {"outcome": "failed", "code": 137,
                "message": f"given up after {TRIES} tries: the worker or the machine went down during the last"}
    events = place / f"events.{tries}.ndjson"
    begin_try(events)
    code = run_kiln(place, events, given)
    message, again, started = what_kiln_told(place, events)
    if code == 0:
        try:
            return {"outcome": "done", "code": 0, **look_at_clip(place, given)}
        except OSError as error:
            return {"outcome": "failed", "code": 0, "message": f"kiln ended well, and yet: {error}"}
    if now.stopping or (code < 128 and not started):
        events.unlink()  # does not count as a try
        return None if now.stopping else sys.exit(f"worker: kiln does not start: {message}")
    return {"outcome": "again" if again and tries < TRIES else "failed", "code": code, "message": message}


def settle(place, spool):
    """Moves a job with a result to `done` or `failed`. Each step can be repeated if the machine goes down."""
    outcome = json.loads((place / "result.json").read_text())["outcome"]
    if outcome == "done" and not (place / "clip.mp4").exists():
        (place / "output/clip.mp4").rename(place / "clip.mp4")
    for folder in ("output", "tmp", *(["job"] if outcome == "done" else [])):
        shutil.rmtree(place / folder, ignore_errors=True)
    names = (place.name + (f".{i}" if i > 1 else "") for i in itertools.count(1))
    place.rename(next(target for name in names if not (target := spool / outcome / name).exists()))


def work_on(name, given):
    """Takes a job from `incoming`, or goes on with it, and records its result."""
    place = given.spool / "running" / name
    place.mkdir(exist_ok=True)
    if not os.path.lexists(place / "job"):
        (given.spool / "incoming" / name).rename(place / "job")
    start = time.monotonic()
    if not (result := render(place, given)):
        return
    line = json.dumps({"job": name, **result, "seconds": round(time.monotonic() - start, 2),
                       "time": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())}) + "\n"
    if result["outcome"] != "again":
        write_durably(place / "result.tmp", line, "w")
        (place / "result.tmp").rename(place / "result.json")
    write_durably(given.spool / "report.ndjson", line, "a")
    if result["outcome"] != "again":
        settle(place, given.spool)


def recover(spool):
    """Completes the report, and the jobs whose results are known, after a worker was killed."""
    report = spool / "report.ndjson"
    lines = report.read_text().splitlines() if report.exists() else []
    if lines and not report.read_text().endswith("\n"):
        write_durably(report, "\n", "a")
    for place in (spool / "running").iterdir():
        if (place / "result.json").exists():
            if (line := (place / "result.json").read_text()).rstrip("\n") not in lines:
                write_durably(report, line, "a")
            settle(place, spool)
        elif not os.path.lexists(place / "job") and not os.path.lexists(spool / "incoming" / place.name):
            shutil.rmtree(place)


def user_of_jobs(name):
    """Returns the numbers of the user and group that jobs run as, or None if they run as the worker's own."""
    if os.geteuid() != 0:
        return None
    try:
        user = (int(name), int(name)) if name.isdigit() else pwd.getpwnam(name)[2:4]
    except KeyError:
        sys.exit(f"worker: --user: there is no '{name}'")
    if 0 in user:
        sys.exit(f"worker: jobs do not run as root: --user NAME, of a user without rights, instead of '{name}'")
    return user


def main():
    parser = argparse.ArgumentParser(description="Renders the jobs of a spool folder.")
    parser.add_argument("--once", action="store_true", help="end when no job is left")
    parser.add_argument("--user", default="root", help="whose rights jobs have, where root starts the worker")
    parser.add_argument("--kiln", default="kiln", help="the program")
    parser.add_argument("--limits", default="service", help="of kiln, for each job")
    parser.add_argument("--timeout", type=int, default=3600, help="seconds for each job")
    parser.add_argument("spool", type=pathlib.Path)
    given = parser.parse_args()
    given.user = user_of_jobs(given.user)
    given.kiln = os.path.abspath(shutil.which(given.kiln) or sys.exit(f"worker: no program '{given.kiln}'"))
    spool = given.spool = given.spool.absolute()
    for folder, mode in {"incoming": 0o700, "running": 0o711, "done": 0o700, "failed": 0o700, "cache": 0o711}.items():
        (spool / folder).mkdir(mode=mode, parents=True, exist_ok=True)
    if given.user:
        os.chown(spool / "cache", *given.user)
    given.lock = os.open(spool / "lock", os.O_RDWR | os.O_CREAT, 0o600)
    fcntl.flock(given.lock, fcntl.LOCK_EX)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, stop)
    recover(spool)
    while not now.stopping:
        running, incoming = (sorted(p.name for p in (spool / folder).iterdir() if p.name[0] != ".")
                             for folder in ("running", "incoming"))
        for name in [*running, *(name for name in incoming if name not in running)]:
            if not now.stopping:
                work_on(name, given)
        if not incoming:
            if given.once and not running:
                break
            time.sleep(1)


if __name__ == "__main__":
    main()
