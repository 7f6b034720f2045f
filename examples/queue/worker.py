"""Renders the jobs of a spool folder in turn, for scenes from untrusted people (docs/service.md).

To submit a job, make a folder SPOOL/incoming/.NAME with scene.yaml and its files, which the user of the jobs can
read, and rename it to NAME. Jobs run in the order of their names. The worker moves a finished job to
SPOOL/done/NAME, with clip.mp4, or to SPOOL/failed/NAME, with the job as it came, and adds a line to
SPOOL/report.ndjson. The worker may be killed at any moment: when it starts, it goes on with the jobs in
SPOOL/running.
"""
import argparse
import concurrent.futures
import errno
import fcntl
import itertools
import json
import os
import pathlib
import pwd
import re
import shutil
import signal
import subprocess
import sys
import time
import types

sys.dont_write_bytecode = True  # root runs this, and /usr/share is the package manager's
import foreign  # noqa: E402  (beside this file)
import processes  # noqa: E402

TRIES = 3  # the most tries of a job that may succeed when it is run again, or during which the worker went down
GRACE_S = 10  # seconds from --timeout until SIGTERM, and from there until SIGKILL
STOP_S = 5  # seconds from the SIGTERM that the worker passes on until SIGKILL
# The most that is read and kept of what a job says.
LINE_BYTES, EVENT_LINES, EVENT_BYTES, MESSAGE_CHARACTERS = 64 << 10, 500_000, 64 << 20, 4000
UNITS = {"": 1, "B": 1, **{f"{prefix}B": 1000 ** i for i, prefix in enumerate("kMGT", 1)},
         **{f"{prefix}iB": 1024 ** i for i, prefix in enumerate("KMGT", 1)}}
# Errors of the machine, of which the jobs that wait are not to blame.
MACHINE = {errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO, errno.EMFILE, errno.ENFILE, errno.ENOMEM}
JOB_ERRORS = (OSError, ValueError, LookupError, TypeError, RecursionError)  # what a job may lead the worker to
now = types.SimpleNamespace(stopping=False, told=os.pipe())  # told: a pipe, which has something when stopping


def stop(*_):
    if not now.stopping:
        now.stopping = True
        os.write(now.told[1], b".")


def sync(path):
    with foreign.opened(path, os.O_RDONLY | os.O_NOFOLLOW) as file:
        os.fsync(file)


def put_in_place(place, names):
    """Makes files durable, at the same time because each takes a turn of the disk, and then gives them their names."""
    with concurrent.futures.ThreadPoolExecutor(len(names)) as pool:
        list(pool.map(sync, [place / name for name in names]))
    for temporary, name in names.items():
        (place / temporary).rename(place / name)


def add_to_report(spool, line):
    """Adds a line. Half a line may be there, of a worker that was killed or of a full disk."""
    with open(spool / "report.ndjson", "a+b") as report:
        if end := report.tell():
            report.seek(end - 1)
            line = line if report.read(1) == b"\n" else "\n" + line
        report.write(line.encode())
        report.flush()
        os.fsync(report.fileno())


def begin_try(events):
    """Creates the file of events, which counts the try, durably before kiln runs: the try may take the machine
    down."""
    events.touch()
    with foreign.opened(events.parent, foreign.FOLDER) as folder:
        os.fsync(folder)


def make_folder(place, name, user):
    """Makes a folder that the job may write to. Another try may have filled it."""
    with foreign.opened(place, foreign.FOLDER) as top:
        try:
            os.mkdir(name, dir_fd=top)
        except FileExistsError:
            pass
        with foreign.opened(name, foreign.FOLDER, top) as folder:
            if user:
                os.fchown(folder, *user)


def run(command, place, told, messages, given):
    """Runs a command of a job in a folder. Returns its exit code as a shell does (128 + the signal's number), when
    nothing that it started is left."""
    environment = {"PATH": os.defpath, "HOME": place / "tmp", "TMPDIR": place / "tmp",
                   "XDG_CACHE_HOME": given.spool / "cache"}
    job = given.keeper.start(command, environment, place, told, messages)
    try:
        if not job.ends_within(given.timeout + GRACE_S, now.told[0]):
            if now.stopping:
                job.send(signal.SIGTERM)
            else:
                job.signal_all(signal.SIGTERM)
            job.ends_within(STOP_S if now.stopping else GRACE_S)
    finally:
        code = job.end()
    return code


def run_kiln(place, events, given):
    for folder in ("output", "tmp"):
        make_folder(place, folder, given.user)
    with open(events, "wb") as told, open(place / "messages", "wb") as messages:
        return run([given.kiln, "render", "job/scene.yaml", "--asset-root", "job", "--device", "cpu",
                    "--sandbox=require", "--limits", given.limits, "--timeout", str(given.timeout), "--resume",
                    "--events", "ndjson", "--quiet", "-o", "output/clip.mp4"],
                   place, told.fileno(), messages.fileno(), given)


def kiln_starts(place, given):
    """Returns whether kiln runs at all, without the files of the job: its events are what the job says."""
    with open(os.devnull, "wb") as null:
        return run([given.kiln, "help", "limits"], place, null.fileno(), null.fileno(), given) == 0


def lines_of(path):
    """Yields the lines of a file that a job wrote, up to a number. What is too long for an event is cut."""
    with open(path, "rb") as file:
        for line in itertools.islice(iter(lambda: file.readline(LINE_BYTES), b""), EVENT_LINES):
            yield line.decode(errors="replace")


def cut(place, most_bytes):
    """Cuts the files of what a job has said."""
    for path in (*place.glob("events.*.ndjson"), place / "messages"):
        if path.exists() and path.stat().st_size > most_bytes:
            os.truncate(path, most_bytes)


def is_full(spool):
    """Returns whether the disk has nearly no room, or no numbers for files. Then jobs keep no more than the worker
    needs."""
    status = os.statvfs(spool)
    return status.f_bavail < status.f_blocks / 20 or status.f_favail < status.f_files / 20


def make_room(place, spool):
    """Removes what a job has drawn so far, and most of what it has said: perhaps it has filled the disk."""
    foreign.remove(place, ("output", "tmp", "clip.tmp", "clip.mp4"))
    cut(place, LINE_BYTES)
    empty_full_cache(spool)


def empty_full_cache(spool):
    """Empties the cache if the disk is nearly full: a job that was taken over may have filled it there."""
    try:
        if is_full(spool):
            foreign.remove(spool / "cache", os.listdir(spool / "cache"))
    except OSError as error:  # jobs can do without a cache
        print(f"worker: the cache was not emptied: {error}", file=sys.stderr)


def what_kiln_told(place, events):
    """Reads the events of a try. Returns the first error, whether to run the job again, and whether kiln started."""
    message, again, started = "", True, False
    for line in lines_of(events):
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
    said = next(lines_of(place / "messages"), "")[:1000].strip()
    return message or said or "kiln does not say why", again, started


def failed(code, message):
    return {"outcome": "failed", "code": code, "message": message[:MESSAGE_CHARACTERS]}


def render(place, given):
    """Runs a job once. Returns its result, or None if the worker was told to stop."""
    tries = len(list(place.glob("events.*"))) + 1
    if objection := foreign.objection(place):
        return failed(3, objection)
    if tries > TRIES:  # the try before this one has no result
        return failed(137, f"given up after {TRIES} tries: the worker or the machine went down during the last")
    events = place / f"events.{tries}.ndjson"
    begin_try(events)
    code = run_kiln(place, events, given)
    cut(place, EVENT_BYTES)
    message, again, started = what_kiln_told(place, events)
    if code == 0:
        try:
            return {"outcome": "done", "code": 0, **foreign.copy_clip(place, given.most_output, given.owner)}
        except OSError as error:
            return failed(0, f"kiln ended well, and yet: {error}")
    if now.stopping:
        events.unlink()  # does not count as a try
        return None
    if code < 128 and not started and not kiln_starts(place, given):
        events.unlink()
        return None if now.stopping else sys.exit(f"worker: kiln does not start: {message!a}")
    return {**failed(code, message), "outcome": "again" if again and tries < TRIES else "failed"}


def free_name(folder, name):
    """Returns a path in a folder that is free: NAME, or NAME.2 and so on, cut to the length that a name may have."""
    most = os.pathconf(folder, "PC_NAME_MAX")
    for i in itertools.count(1):
        suffix, kept = f".{i}" if i > 1 else "", name
        while len(os.fsencode(kept + suffix)) > most:
            kept = kept[:-1]
        if not os.path.lexists(folder / (kept + suffix)):
            return folder / (kept + suffix)


def settle(place, spool):
    """Moves a job with a result to `done` or `failed`. Each step can be repeated if the machine goes down."""
    outcome = json.loads((place / "result.json").read_text())["outcome"]
    try:
        foreign.remove(place, ("output", "tmp", "clip.tmp", "job" if outcome == "done" else "clip.mp4"))
    except OSError as error:  # what is left moves along
        print(f"worker: {place.name!a}: not all was removed: {error}", file=sys.stderr)
    place.rename(free_name(spool / outcome, place.name))


def take(name, place, spool):
    """Moves a job from `incoming` to `running`. Returns false if somebody has removed it."""
    incoming = spool / "incoming" / name
    try:
        try:
            incoming.rename(place / "job")
        except PermissionError:  # a folder of the worker's own user, who may not write to it
            if incoming.is_symlink():
                raise
            incoming.chmod(0o700)
            incoming.rename(place / "job")
    except FileNotFoundError:
        place.rmdir()
        return False
    return True


def record(name, result, start, spool):
    """Writes the result of a try to the report, and moves the job if it was the last."""
    place = spool / "running" / name
    line = json.dumps({"job": name, **result, "seconds": round(time.monotonic() - start, 2),
                       "time": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())}) + "\n"
    if result["outcome"] != "again":
        (place / "result.tmp").write_text(line)
        clip = {"clip.tmp": "clip.mp4"} if result["outcome"] == "done" else {}
        put_in_place(place, {**clip, "result.tmp": "result.json"})
    add_to_report(spool, line)
    if result["outcome"] != "again":
        settle(place, spool)


def give_up(name, error, given):
    """Returns the result of a job that the worker cannot handle, when its folder is such that it can be recorded."""
    running = given.spool / "running"
    place = running / name
    if not os.path.lexists(place):
        place.mkdir()
        return failed(6, "was removed while it ran")
    if place.is_symlink() or not place.is_dir():
        place.rename(running / ".stray")
        place.mkdir()
        (running / ".stray").rename(place / "job")
        return failed(3, "is not a folder")
    if not os.path.lexists(place / "job"):
        given.stuck.add(name)  # it stays in `incoming`, and must not be tried for ever
    return failed(6, f"the worker cannot go on with it: {error}")


def work_on(name, given):
    """Takes a job from `incoming`, or goes on with it, and records its result. No job stops those after it."""
    place = given.spool / "running" / name
    start = time.monotonic()
    try:
        empty_full_cache(given.spool)
        place.mkdir(exist_ok=True)
        if not os.path.lexists(place / "job") and not take(name, place, given.spool):
            return
        result = render(place, given)
        if result and result["outcome"] != "done" and is_full(given.spool):
            make_room(place, given.spool)
    except JOB_ERRORS as error:
        result = give_up(name, error, given)
    if result:
        try:
            record(name, result, start, given.spool)
        except OSError as error:
            if error.errno not in MACHINE:
                raise
            make_room(place, given.spool)
            if result["outcome"] == "done":
                result = failed(0, f"kiln ended well, and yet: {error}")
            record(name, result, start, given.spool)


def recover_job(place, lines, given):
    """Goes on with a job whose worker was killed while it recorded the result."""
    known = place / "result.json"
    if known.exists():
        line = known.read_text()
        if json.loads(line)["outcome"] == "done" and not (place / "clip.mp4").exists():
            known.unlink()  # the job runs again, and keeps what it has drawn
            return
        if line.rstrip("\n") not in lines:
            add_to_report(given.spool, line)
        settle(place, given.spool)
    elif not os.path.lexists(place / "job") and not os.path.lexists(given.spool / "incoming" / place.name):
        place.rmdir()


def recover(given):
    """Completes the report, and the jobs whose results are known, after a worker was killed."""
    report = given.spool / "report.ndjson"
    lines = report.read_text(errors="replace").splitlines() if report.exists() else []
    for name in names_in(given.spool / "running"):
        try:
            if is_full(given.spool) and (given.spool / "running" / name).is_dir():
                make_room(given.spool / "running" / name, given.spool)
            recover_job(given.spool / "running" / name, lines, given)
        except JOB_ERRORS as error:
            record(name, give_up(name, error, given), time.monotonic(), given.spool)


def names_in(folder):
    return sorted(name for name in os.listdir(folder) if name[0] != ".")


def next_jobs(given):
    """Returns the names of jobs that are running, and of those that wait."""
    running, incoming = (names_in(given.spool / folder) for folder in ("running", "incoming"))
    return ([name for name in running if name not in given.stuck],
            [name for name in incoming if name not in given.stuck and name not in running])


def most_output(given):
    """Returns the limit `output` of --limits in bytes, or None where there is none. kiln says what `service` is."""
    text = None
    for key, _, value in (item.partition("=") for item in given.limits.split(",")):
        if key == "service":
            said = subprocess.run([given.kiln, "help", "limits"], stdout=subprocess.PIPE, text=True, errors="replace")
            row = re.search(r"^output\s+(\S+(?: \S+)?)  ", said.stdout, re.MULTILINE)
            text = row[1] if row else sys.exit("worker: 'kiln help limits' does not tell the limit `output`")
        elif key == "output":
            text = value
    if text in (None, "none"):
        return None
    amount = re.fullmatch(r"\s*([0-9.]+(?:e\+?[0-9]+)?)\s*([A-Za-z]*)\s*", text)
    if not amount or amount[2] not in UNITS:
        sys.exit(f"worker: --limits: output: found '{text}'; expected a number of bytes, such as 2 GiB")
    return int(float(amount[1]) * UNITS[amount[2]])


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


def work(given):
    """Works on jobs, in the order of their names, until none is left (--once) or the worker is stopped."""
    while not now.stopping:
        running, incoming = next_jobs(given)
        for name in [*running, *incoming]:
            if now.stopping:
                return
            try:
                work_on(name, given)
            except OSError as error:
                if error.errno in MACHINE:
                    raise
                given.stuck.add(name)
                print(f"worker: {name!a} stays where it is: {error}", file=sys.stderr)
        if not incoming:
            if given.once and not running:
                break
            time.sleep(1)


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
    given.owner, given.stuck, given.most_output = (given.user or [os.geteuid()])[0], set(), most_output(given)
    for folder in ("incoming", "running", "done", "failed", "cache"):
        (spool / folder).mkdir(mode=0o700, parents=True, exist_ok=True)
    if given.user:  # and nobody else may enter: a job may make programs with a set-uid bit
        os.chown(spool / "cache", *given.user)
        os.chown(spool / "running", -1, given.user[1])
    (spool / "running").chmod(0o710)
    (spool / "cache").chmod(0o700)
    # No job inherits the lock, since it could keep it. The next worker ends what the job of this one leaves.
    lock = os.open(spool / "lock", os.O_RDWR | os.O_CREAT, 0o600)
    fcntl.flock(lock, fcntl.LOCK_EX)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, stop)
    try:
        given.keeper = processes.Keeper(spool, given.user)
        try:
            given.keeper.end_what_was_left()
        except TimeoutError as error:  # they were killed, and run no code of theirs again
            print(f"worker: of a job whose worker was killed: {error}", file=sys.stderr)
        recover(given)
        work(given)
    except OSError as error:  # such as a full disk
        sys.exit(f"worker: {error}")


if __name__ == "__main__":
    main()
