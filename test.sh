#!/bin/sh
# Builds everything and runs all tests. Usage: ./test.sh [release|asan|tsan] [arguments for ctest...]
set -eu
cd "$(dirname "$0")"
. scripts/set_up.sh

preset=release
case "${1:-}" in
release | asan | tsan) preset=$1 && shift ;;
-h | --help) echo "Usage: $0 [release|asan|tsan] [arguments for ctest, e.g. -R Evaluation]" && exit 0 ;;
-* | '') ;;
*) die "unknown preset '$1'; there are release, asan and tsan" ;;
esac

install_packages $roevo_batch_packages
build "$preset"
say "Testing (preset $preset)"
# Leaks inside the libraries of others (OpenGL drivers, MRPT's registries) are not ours to count.
export ASAN_OPTIONS="${ASAN_OPTIONS:-detect_leaks=0}"
export TSAN_OPTIONS="${TSAN_OPTIONS:-suppressions=$PWD/scripts/tsan.supp}"
status=0
ctest --test-dir "build/$preset" -j 2 --output-on-failure "$@" || status=$?
skipped=$(sed -n 's/^\[  SKIPPED \] \([A-Z][^ ,]*\)\(, where.*\)\{0,1\}$/  \1/p' "build/$preset/Testing/Temporary/LastTest.log")
[ -z "$skipped" ] || printf '\nSkipped:\n%s\n' "$skipped"
exit $status
