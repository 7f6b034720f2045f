"""Looks at, copies and removes files that a job, or the stranger whose job it is, has made.

Nothing here follows a link: each file is opened by its name in a folder that is open, and judged by what was opened.
"""
import contextlib
import errno
import hashlib
import itertools
import os
import stat

MOST_DEPTH = 64  # folders in each other
BLOCK_BYTES = 1 << 20
ZEROS = bytes(BLOCK_BYTES)
UNKNOWN = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY  # opens a FIFO or a device without waiting for it
FOLDER = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW
KINDS = {stat.S_IFIFO: "a FIFO", stat.S_IFSOCK: "a socket", stat.S_IFCHR: "a device", stat.S_IFBLK: "a device",
         stat.S_IFDIR: "a folder"}


@contextlib.contextmanager
def opened(name, flags, folder=None, mode=0o666):
    file = os.open(name, flags, mode, dir_fd=folder)
    try:
        yield file
    finally:
        os.close(file)


def kind_of(mode):
    return KINDS.get(stat.S_IFMT(mode), "an unknown kind of file")


def refuse(error):
    raise error


def objection(place):
    """Returns what is wrong with the files of the job in a folder, or None. A file with another hard link may belong
    to somebody else, and a folder that cannot be read may hide one."""
    if not stat.S_ISDIR(os.lstat(place / "job").st_mode):
        return "job: is not a folder"
    folder = "job"
    try:
        with opened(place, FOLDER) as top:
            for folder, _, names, handle in os.fwalk("job", onerror=refuse, dir_fd=top):
                if folder.count("/") > MOST_DEPTH:
                    return f"{folder[:60]}...: lies in more than {MOST_DEPTH} folders"
                for name in names:
                    status = os.stat(name, dir_fd=handle, follow_symlinks=False)
                    if not stat.S_ISREG(status.st_mode) and not stat.S_ISLNK(status.st_mode):
                        return f"{folder}/{name}: is {kind_of(status.st_mode)}"
                    if status.st_nlink != 1:
                        return f"{folder}/{name}: has another name, too (a hard link)"
    except OSError as error:
        name = f"{folder}/{error.filename}" if isinstance(error.filename, str) and error.filename != folder else folder
        return f"{name}: cannot be read: {error.strerror}"
    return None


def copy_clip(place, most_bytes, owner):
    """Copies output/clip.mp4 to clip.tmp, a file of the worker's own, which is not durable yet. Returns its size and
    SHA-256. Nothing of the job may live. Raises OSError with the reason if it is no clip of the job: the job could
    write to the folder."""
    with contextlib.ExitStack() as files:
        top = files.enter_context(opened(place, FOLDER))
        output = files.enter_context(opened("output", FOLDER, top))
        try:
            clip = files.enter_context(opened("clip.mp4", UNKNOWN, output))
        except OSError as error:
            said = "is a link" if error.errno == errno.ELOOP else f"cannot be opened: {error.strerror}"
            raise OSError(f"output/clip.mp4 {said}") from error
        status = os.fstat(clip)
        if not stat.S_ISREG(status.st_mode):
            raise OSError(f"output/clip.mp4 is {kind_of(status.st_mode)}")
        if status.st_nlink != 1:
            raise OSError("output/clip.mp4 has another name, too (a hard link)")
        if status.st_uid != owner:
            raise OSError(f"output/clip.mp4 belongs to the user {status.st_uid}, and not to the job's user {owner}")
        if most_bytes is not None and status.st_size > most_bytes:
            raise OSError(f"output/clip.mp4 has {status.st_size} bytes; the limit `output` is {most_bytes}")
        with contextlib.suppress(FileNotFoundError):
            os.unlink("clip.tmp", dir_fd=top)
        copy = files.enter_context(opened("clip.tmp", os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, top))
        try:
            return {"bytes": status.st_size, "sha256": copy_sparse(clip, copy, status.st_size)}
        except OSError:  # such as a full disk
            os.unlink("clip.tmp", dir_fd=top)
            raise


def copy_sparse(source, target, size):
    """Copies so many bytes, and leaves out blocks of zeros, which then take no room. Returns the SHA-256."""
    digest, left = hashlib.sha256(), size
    while left:
        block = os.read(source, min(left, BLOCK_BYTES))
        if not block:
            raise OSError(f"output/clip.mp4 ends {left} bytes early")
        digest.update(block)
        left -= len(block)
        if block == ZEROS[:len(block)]:
            os.lseek(target, len(block), os.SEEK_CUR)
            continue
        written = 0
        while written < len(block):
            written += os.write(target, block[written:])
    os.truncate(target, size)
    return digest.hexdigest()


def remove(place, names):
    """Removes files and folders of a folder, however deep they are, and whatever their modes. Each folder is moved up
    before what is in it is removed, so no path gets long. What was begun before the worker went down is completed."""
    with opened(place, FOLDER) as top:
        waiting = [*names, *(name for name in os.listdir(top) if name.startswith("removed."))]
        numbers = (number for number in itertools.count() if f"removed.{number}" not in waiting)
        while waiting:
            with contextlib.suppress(FileNotFoundError):
                remove_one(waiting.pop(), top, waiting, numbers)


def remove_one(name, top, waiting, numbers):
    """Removes a file, or a folder whose own folders are moved up and wait."""
    if not is_folder(name, top):
        os.unlink(name, dir_fd=top)
        return
    let_in(name, top)
    with opened(name, FOLDER, top) as folder:
        while entries := some_entries(folder):
            for entry in entries:
                if entry.is_dir(follow_symlinks=False):
                    let_in(entry.name, folder)
                    waiting.append(f"removed.{next(numbers)}")
                    os.rename(entry.name, waiting[-1], src_dir_fd=folder, dst_dir_fd=top)
                else:
                    os.unlink(entry.name, dir_fd=folder)
    os.rmdir(name, dir_fd=top)


def is_folder(name, folder):
    return stat.S_ISDIR(os.stat(name, dir_fd=folder, follow_symlinks=False).st_mode)


def some_entries(folder):
    """Returns entries of a folder, a thousand at most: a job may have made millions."""
    with os.scandir(folder) as entries:
        return list(itertools.islice(entries, 1000))


def let_in(name, folder):
    """Gives the owner all rights to a folder, where that is this user. Others need none: they are root."""
    if os.geteuid() != 0:
        with contextlib.suppress(PermissionError):
            os.chmod(name, 0o700, dir_fd=folder)
