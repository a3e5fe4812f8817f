#!/bin/sh
# Makes the Debian packages, installs them in a bare Debian and uses what is in them there: programs on a simulated
# recording, the examples in C++ and in Python. Usage, as root: scripts/smoke_packages.sh 12|13
set -eu
cd "$(dirname "$0")/.."
. scripts/set_up.sh

case "${1:-}" in
12 | 13) ;;
installed) ;; # by this script itself, in the bare Debian
-h | --help) echo "Usage: $0 12|13" && exit 0 ;;
*) die "'${1:-}' is no release it knows: 12 and 13; e.g. $0 12" ;;
esac

if [ "$1" = installed ]; then
    export DEBIAN_FRONTEND=noninteractive
    apt="apt-get -qq -o Dpkg::Use-Pty=0 --no-install-recommends -y"
    $apt update
    say "Each package alone has what it needs"
    $apt install /exchange/python3-roevo_*.deb
    python3 -c "import roevo; print(roevo.Odometry(roevo.Camera(640, 480, 525, 525, 319.5, 239.5)).trajectory().shape)"
    $apt install /exchange/roevo-tools_*.deb
    roevo-odometry --version
    for program in $(dpkg -L roevo-tools | sed -n 's|^/usr/bin/||p'); do
        dpkg -L roevo-tools | grep -q "/man1/$program\.1" || die "$program has no man page"
    done
    $apt install /exchange/libroevo-dev_*.deb g++ cmake make
    cmake -S examples -B /tmp/core -DONLY_CORE=ON
    cmake --build /tmp/core
    say "Used together"
    recommended=$(dpkg-query -W -f '${Recommends}' libroevo-dev | tr -d ,)
    $apt install $recommended python3-pil
    tests/apps/use_installed.sh /usr /tmp/used -DCMAKE_BUILD_TYPE=Release
    $apt purge libroevo-dev roevo-tools python3-roevo
    [ -z "$(find /usr -name '*roevo*')" ] || die "left behind: $(find /usr -name '*roevo*')"
    exit 0
fi

folder=$(mktemp -d "${TMPDIR:-/var/tmp}/roevo-packages.XXXXXX")
trap 'rm -rf "$folder"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP
export ROEVO_EXCHANGE_DIR="$folder"
case "$(cat /etc/debian_version)" in
"$1".*) scripts/make_packages.sh "$folder" ;; # here it goes fastest
*) scripts/in_debian.sh "$1" scripts/make_packages.sh /exchange ;;
esac
scripts/in_debian.sh "$1" scripts/smoke_packages.sh installed
