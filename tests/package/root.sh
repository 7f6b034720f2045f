# Defines functions that make root folders of Debian 12 and run commands in them. The tests of
# packages source this file; $work is their folder.

# make_root FOLDER: makes a fresh Debian 12 with apt and nothing else. It is unpacked from a tar
# file, which the first call makes.
make_root() {
    if [[ ! -s $work/base.tar ]]; then
        mmdebstrap --quiet --format=tar --variant=apt bookworm "$work/base.tar.new" || return 1
        mv "$work/base.tar.new" "$work/base.tar"
    fi
    rm -rf "$1"
    mkdir -p "$1"
    tar -xf "$work/base.tar" -C "$1" --exclude='./dev/*'
    cp --dereference /etc/resolv.conf "$1/etc/"
}

# inside ROOT COMMAND...: runs a command in the root folder as root, with a /proc and a small /dev
# of its own.
inside() {
    # shellcheck disable=SC2016
    unshare --mount --pid --fork --kill-child bash -c '
        mount -t proc proc "$1/proc" && mount -t tmpfs tmpfs "$1/dev" &&
            for device in null zero random urandom; do
                touch "$1/dev/$device" && mount --bind "/dev/$device" "$1/dev/$device" || exit 1
            done
        ln -s /proc/self/fd "$1/dev/fd"
        exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
            ${SET_INSIDE:-} chroot "$@"' inside "$@"
}

# apt_install ROOT PACKAGE...: installs packages of Debian's archive by name, or files "./x.deb" of
# the root's folder /release.
apt_install() {
    local root=$1
    shift
    inside "$root" sh -c 'apt-get -q update && cd /release && apt-get -q -y --no-install-recommends install "$@"' \
        sh "$@" >"$root/apt.log" 2>&1 || { tail -n 20 "$root/apt.log"; return 1; }
}

fail() { echo "$*"; exit 1; }
