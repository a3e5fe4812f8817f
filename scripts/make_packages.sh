#!/bin/sh
# Makes the Debian packages libroevo-dev, roevo-tools and python3-roevo for the Debian that it runs on.
# Usage: scripts/make_packages.sh FOLDER
set -eu
cd "$(dirname "$0")/.."
. scripts/set_up.sh

case "${1:-}" in
-h | --help) echo "Usage: $0 FOLDER" && exit 0 ;;
'') die "no folder for the packages; e.g. $0 packages" ;;
esac
mkdir -p "$1"
folder=$(cd "$1" && pwd)

# cpack asks "file" what needs which libraries
roevo_packages="$roevo_packages dpkg-dev help2man file"
install_packages
say "Building what is packed"
# Without tests: all that is built then is packed
cmake --preset release -B build/packages -DROEVO_BUILD_TESTS=OFF >/dev/null || die "cmake could not configure the build"
cmake --build build/packages -j "$(nproc)" || die "the build failed"
say "Packing"
(cd build/packages && cpack -B "$folder") || die "cpack failed"
rm -rf "$folder/_CPack_Packages"
ls -l "$folder"/*.deb
