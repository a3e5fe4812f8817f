#!/bin/sh
# Runs a command of the project in a bare Debian made for it, as a release is checked: from nothing, and gone afterwards.
# Usage, as root: scripts/in_debian.sh RELEASE COMMAND..., e.g. scripts/in_debian.sh 13 ./test.sh
# The command sees a copy of the sources (without build folders), and the real clips where ROEVO_DATA_DIR or
# ../shared/data has them; a folder named in ROEVO_EXCHANGE_DIR is its /exchange, to take from and to leave in.
# Needs the network and 10 GB in TMPDIR, or else /var/tmp.
set -eu
cd "$(dirname "$0")/.."
. scripts/set_up.sh

case "${1:-}" in
12) suite=bookworm ;;
13) suite=trixie ;;
-h | --help) echo "Usage: $0 12|13 COMMAND..., e.g. $0 13 ./test.sh" && exit 0 ;;
*) die "'${1:-}' is no release it knows: 12 and 13; e.g. $0 13 ./test.sh" ;;
esac
[ $# -ge 2 ] || die "no command to run; e.g. $0 $1 ./test.sh"
[ "$(id -u)" -eq 0 ] || die "only root can make a Debian to run things in"
command -v mmdebstrap >/dev/null || die "mmdebstrap is missing: apt-get install mmdebstrap"
release=$1
shift

root=$(mktemp -d "${TMPDIR:-/var/tmp}/roevo-debian-$release.XXXXXX")
# What is mounted below is not there for this rm: it is in a namespace of its own.
trap 'rm -rf --one-file-system "$root"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

say "Making a Debian $release in $root"
mmdebstrap --quiet --variant=minbase "$suite" "$root" ||
    die "mmdebstrap could not make a Debian $release; is the network reachable?"
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
mkdir "$root/roevo" "$root/data" "$root/exchange"
tar -c --exclude=./.git --exclude='./build*' --exclude=./demo_output . | tar -x --no-same-owner -C "$root/roevo"

say "Debian $(cat "$root/etc/debian_version"): $*"
start=$(date +%s)
status=0
# In namespaces of its own: whatever the command mounts or leaves running ends with it.
unshare --mount --propagation private --pid --fork --kill-child sh -eu -c '
    root=$1 data=$2 exchange=$3
    shift 3
    mount --rbind /dev "$root/dev"
    mount -t proc proc "$root/proc"
    mount -o ro -t sysfs sysfs "$root/sys"
    [ ! -d "$data" ] || mount -o bind,ro "$data" "$root/data"
    [ -z "$exchange" ] || mount -o bind "$exchange" "$root/exchange"
    exec chroot "$root" env -i HOME=/root LC_ALL=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM="${TERM:-dumb}" \
        ROEVO_DATA_DIR=/data sh -c "cd /roevo && exec \"\$@\"" sh "$@"
' sh "$root" "${ROEVO_DATA_DIR:-../shared/data}" "${ROEVO_EXCHANGE_DIR-}" "$@" || status=$?
say "Debian $release: exit code $status after $(($(date +%s) - start)) s: $*"
exit "$status"
