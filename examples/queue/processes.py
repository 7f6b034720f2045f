"""Starts the process of a job, and ends it with all that it has started.

A job that was taken over may start processes that try to outlive it. Where the worker may make cgroups of version 2,
each job has a group of its own, whose processes the kernel kills together. Elsewhere, kiln's sandbox keeps them in one
process group (it refuses setsid and setpgid), and an orphan becomes a child of the worker (a subreaper), which waits
until it has no child left. A worker that starts finds what a killed worker left: by the name of the group, by the
session, or by the user.
"""
import ctypes
import errno
import os
import pathlib
import re
import select
import signal
import time

PATIENCE_S = 10  # after SIGKILL; a process that waits for a device cannot end before the device answers
NO_END = "its processes do not end"
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER, PR_SET_NO_NEW_PRIVS = 1, 36, 38
SYS_CLONE3, CLONE_INTO_CGROUP = 435, 1 << 33
library = ctypes.PyDLL(None, use_errno=True)


def checked(returned):
    if returned < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    return returned


def prctl(option, value):
    checked(library.prctl(option, ctypes.c_ulong(value), ctypes.c_ulong(0), ctypes.c_ulong(0), ctypes.c_ulong(0)))


def fork_into(group):
    """Forks, and returns as os.fork does. The child is born in the cgroup: to move it there takes ten milliseconds."""
    if group is None:
        return os.fork()
    with_group = (ctypes.c_uint64 * 11)()  # struct clone_args
    with_group[0], with_group[4] = CLONE_INTO_CGROUP, signal.SIGCHLD
    folder = with_group[10] = os.open(group, os.O_RDONLY | os.O_DIRECTORY)
    try:
        return checked(library.syscall(ctypes.c_long(SYS_CLONE3), ctypes.byref(with_group),
                                       ctypes.c_size_t(ctypes.sizeof(with_group))))
    except OSError as error:
        if error.errno not in (errno.ENOSYS, errno.EPERM):  # a container may forbid clone3
            raise
        child = os.fork()
        if child == 0:
            try:
                (group / "cgroup.procs").write_text("0")
            except OSError:
                os._exit(126)
        return child
    finally:
        os.close(folder)


# ---- processes of this machine


def boot():
    return pathlib.Path("/proc/sys/kernel/random/boot_id").read_text().strip()


def processes():
    """Yields number, parent, session and user of each process that runs, and whether it can gain no rights."""
    for place in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{place}/stat", "rb") as file:
                fields = file.read().rpartition(b")")[2].split()
            with open(f"/proc/{place}/status", "rb") as file:
                status = file.read()
        except OSError:  # it has ended, or is hidden from this user
            continue
        state, parent, _, session, threads = *fields[:4], fields[17]
        # A process whose first thread has ended counts as a zombie, although its other threads run.
        if state not in (b"Z", b"X") or int(threads) > 1:
            user = int(re.search(rb"\nUid:\t(\d+)", status)[1])
            yield int(place), int(parent), int(session), user, b"\nNoNewPrivs:\t1\n" in status


def children():
    return {number for number, parent, *_ in processes() if parent == os.getpid()}


def kill(numbers):
    for number in numbers:
        try:
            os.kill(number, signal.SIGKILL)
        except ProcessLookupError:
            pass


def kill_all_of(user):
    """Kills all processes of a user at once, as that user: a process that forks all the time cannot escape from it."""
    child = os.fork()
    if child == 0:
        try:
            take_rights(user)
            os.kill(-1, signal.SIGKILL)
        finally:
            os._exit(0)
    handle = os.pidfd_open(child)
    if not select.select([handle], [], [], 1)[0]:  # a process of that user may have stopped it
        os.kill(child, signal.SIGKILL)
    os.close(handle)
    os.waitpid(child, 0)


def take_rights(user):
    os.setgroups([])
    os.setresgid(user[1], user[1], user[1])
    os.setresuid(user[0], user[0], user[0])


def until(condition):
    """Waits until a condition holds, with growing pauses. Raises TimeoutError when it takes too long."""
    end, pause_s = time.monotonic() + PATIENCE_S, 0.0005
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(NO_END)
        time.sleep(pause_s)
        pause_s = min(2 * pause_s, 0.05)


# ---- cgroups


def hierarchy():
    """Returns where the cgroups of version 2 are mounted, and the worker's own group there, or None twice."""
    try:
        own = re.search(r"^0::(/.*)$", pathlib.Path("/proc/self/cgroup").read_text(), re.MULTILINE)
        for line in pathlib.Path("/proc/self/mountinfo").read_text().splitlines():
            fields, _, kind = line.partition(" - ")
            if own and kind.startswith("cgroup2 "):
                root, mount = (re.sub(r"\\(\d{3})", lambda found: chr(int(found[1], 8)), field)
                               for field in fields.split()[3:5])
                inside = os.path.relpath(own[1], root)
                return pathlib.Path(mount), None if inside.startswith("..") else pathlib.Path(mount, inside)
    except OSError:
        pass
    return None, None


def end_group(group):
    """Kills all processes of a cgroup, and removes it when none is left."""
    events = os.open(group / "cgroup.events", os.O_RDONLY | os.O_CLOEXEC)
    try:
        changed = select.poll()
        changed.register(events, select.POLLPRI)
        end = time.monotonic() + PATIENCE_S
        while b"populated 1" in os.pread(events, 4096, 0):
            (group / "cgroup.kill").write_text("1")
            # The kernel signals the first thread of each process, and nothing happens if that thread has ended.
            kill(filter(None, map(int, (group / "cgroup.procs").read_text().split())))
            if b"populated 1" in os.pread(events, 4096, 0):
                changed.poll(100)
            if time.monotonic() > end:
                raise TimeoutError(NO_END)
    finally:
        os.close(events)
    group.rmdir()


class Keeper:
    """Starts jobs of a spool folder, one at a time, and ends them."""

    def __init__(self, spool, user):
        status = spool.stat()
        self.user = user
        self.name = f"kiln-queue-{status.st_dev:x}-{status.st_ino:x}."
        self.boot = boot()
        self.dying = set()  # children that were killed, and that wait for a device: they run no code of theirs again
        self.record = os.open(spool / "session", os.O_RDWR | os.O_CREAT, 0o600)
        self.null = os.open(os.devnull, os.O_RDONLY)
        self.mount, self.parent = hierarchy()
        prctl(PR_SET_CHILD_SUBREAPER, 1)
        for number in map(int, os.listdir("/proc/self/fd")):
            try:
                os.set_inheritable(number, number < 3)  # what this worker was given, it does not pass on
            except OSError:  # the descriptor of the listing itself
                pass
        if not self.can_make_groups():
            self.parent = None

    def can_make_groups(self):
        """Tries a group, since rights to folders do not tell whether the kernel lets a process in."""
        group = None
        try:
            if group := self.make_group():
                child = fork_into(group)
                if child == 0:
                    os._exit(0)
                born = os.waitpid(child, 0)[1] == 0
                (group / "cgroup.kill").write_text("1")  # from Linux 5.14 on
                return born
        except OSError:
            pass
        finally:
            if group:
                group.rmdir()  # no process is left in it
        return False

    def make_group(self):
        """Makes the group of a job. Its number is free: a group whose processes do not end stays."""
        for number in range(1000):
            try:
                group = self.parent / f"{self.name}{number}" if self.parent else None
                if group:
                    group.mkdir()
                return group
            except FileExistsError:
                continue
        raise OSError(errno.EEXIST, "there are too many cgroups whose processes do not end")

    def end_what_was_left(self):
        """Ends what the job of a killed worker has left. Raises TimeoutError when it was killed and does not end."""
        folders = os.walk(self.mount) if self.mount else ()
        left = [pathlib.Path(top, name) for top, names, _ in folders for name in names if name.startswith(self.name)]
        dying = None
        for group in left:
            try:
                end_group(group)
            except TimeoutError as error:
                dying = error
        if self.user and not self.parent:
            kill_all_of(self.user)  # at once: /proc is too slow for a process that forks all the time
            until(lambda: not self.kill_jobs())
        then, _, session = os.pread(self.record, 100, 0).decode(errors="replace").strip().partition(" ")
        if then == self.boot and session.isdigit():
            until(lambda: not self.kill_session(int(session)))
        if dying:
            raise dying

    def kill_jobs(self):
        """Kills all processes of the jobs' user, which is not the worker's. Returns whether there were any."""
        left = [number for number, _, _, user, _ in processes() if user == self.user[0]]
        if left:
            kill_all_of(self.user)
        return bool(left)

    def kill_session(self, number):
        """Kills the processes of a job's session. Returns whether there were any. They are one process group, which
        the kernel kills at once: one that forks all the time may never be seen in /proc. The number may be that of
        another session by now: of its processes, some are seen, and they may gain rights or are of another user."""
        owner = self.user[0] if self.user else os.geteuid()
        seen = [user == owner and fixed for _, _, session, user, fixed in processes() if session == number]
        if seen and not any(seen):
            return False
        try:
            os.killpg(number, signal.SIGKILL)
        except (ProcessLookupError, PermissionError):
            return False
        return bool(seen)

    def start(self, command, environment, folder, told, messages):
        """Starts a job, which writes to the descriptors `told` and `messages`."""
        group = self.make_group()
        worker = os.getpid()
        process = fork_into(group)
        if process == 0:
            try:
                for number in (signal.SIGTERM, signal.SIGINT):
                    signal.signal(number, signal.SIG_DFL)  # until the program runs, the worker's handler is in force
                os.setsid()
                os.pwrite(self.record, f"{self.boot} {os.getpid():010}\n".encode(), 0)
                for number, file in enumerate((self.null, told, messages)):
                    os.dup2(file, number)
                os.chdir(folder)
                if self.user:
                    take_rights(self.user)
                prctl(PR_SET_NO_NEW_PRIVS, 1)
                prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
                for number in (signal.SIGPIPE, signal.SIGXFSZ):
                    signal.signal(number, signal.SIG_DFL)  # Python ignores them
                if os.getppid() == worker:  # or the worker ended before it could have taken this process along
                    os.execve(command[0], command, environment)
            except OSError as error:
                os.write(2, f"{command[0]}: {error}".encode(errors="replace"))
            finally:
                os._exit(126)
        return Job(self, process, group)


class Job:
    """A process that runs. `handle` is its pidfd."""

    def __init__(self, keeper, process, group):
        self.keeper, self.process, self.group, self.rounds = keeper, process, group, 0
        self.handle = os.pidfd_open(process)

    def ends_within(self, patience_s, told_to_stop=None):
        """Returns whether the job has ended. Returns earlier if something can be read from `told_to_stop`."""
        files = [self.handle, *([told_to_stop] if told_to_stop is not None else [])]
        return self.handle in select.select(files, [], [], patience_s)[0]

    def send(self, number):
        signal.pidfd_send_signal(self.handle, number)

    def signal_all(self, number):
        os.killpg(self.process, number)  # the number of the group stays taken until end()

    def end(self):
        """Ends the job with all that it has started. Returns its exit code as a shell does (128 + the signal's number).
        Raises TimeoutError when processes do not end."""
        self.signal_all(signal.SIGKILL)
        ended = self.ends_within(PATIENCE_S)
        os.close(self.handle)
        try:
            if not ended:
                raise TimeoutError(NO_END)
            code = os.waitstatus_to_exitcode(os.waitpid(self.process, 0)[1])
            if self.group:
                end_group(self.group)
            until(self.no_child_is_left)
        except TimeoutError:
            self.keeper.dying |= children()
            raise
        return code if code >= 0 else 128 - code

    def no_child_is_left(self):
        """Collects children that have ended. Kills those that have not, whose own children then are the worker's."""
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            self.keeper.dying.clear()
            return True
        if not (left := children() - self.keeper.dying):
            return True
        kill(left)
        self.rounds += 1
        if self.rounds % 10 == 0 and self.keeper.user:
            kill_all_of(self.keeper.user)  # for a process that forks faster than it is found
        return False
