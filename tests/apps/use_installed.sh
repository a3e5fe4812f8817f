#!/bin/sh
# Uses what is installed as a user would: programs, the examples in C++ and in Python, all on a simulated recording.
# Usage: tests/apps/use_installed.sh PREFIX WORK_FOLDER [arguments for cmake]
set -eu
sources=$(cd "$(dirname "$0")/../.." && pwd)
prefix=$1 work=$2
shift 2
PATH="$prefix/bin:$PATH"

fail() {
    echo "use_installed.sh: $*" >&2
    exit 1
}

# same A B: what users' own programs print is what roevo-odometry writes
same() {
    cmp "$1" "$2" || fail "$1 and $2 differ"
}

mkdir -p "$work"
for program in roevo-odometry roevo-eval roevo-render roevo-compare roevo-study rgbd2rawlog rawlog2rgbd bag2rawlog; do
    "$program" --version
done
simulate="rawlog-simulate --scene livingroom --frames 8 --size 320x240"
$simulate --output "$work/room.rawlog"
$simulate --layout tum --output "$work/room"
roevo-odometry --input "$work/room.rawlog" --output "$work/out" --quiet
roevo-render --input "$work/out" --output "$work/view.html"
roevo-render --scene "$work/out/map.3Dscene" --output "$work/map.png"

# The core has to do without all that the rest needs: such packages are not found here
alone=
for package in mrpt-maps mrpt-obs mrpt-opengl mrpt-poses CLI11 ZLIB JPEG BZip2 SQLite3 PkgConfig; do
    alone="$alone -DCMAKE_DISABLE_FIND_PACKAGE_$package=ON"
done
cmake -S "$sources/examples" -B "$work/core" -DONLY_CORE=ON -DCMAKE_PREFIX_PATH="$prefix" $alone "$@"
cmake --build "$work/core"
cmake -S "$sources/examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$prefix" "$@"
cmake --build "$work/examples"
cmake -S "$sources/tests/apps/consumer" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$prefix" "$@"
cmake --build "$work/consumer"
"$work/consumer/consumer"
cmake --build "$work/consumer" --target laid_out_otherwise >"$work/link.txt" 2>&1 && fail "other matrices do link"
grep -q builtWithEigenAlignment "$work/link.txt" || fail "$work/link.txt does not say why other matrices do not link"

camera() {
    sed -n "s/^$1: *\([^ ]*\).*/\1/p" "$work/room/camera.txt"
}
"$work/core/images" "$work/room/rgb" "$work/room/depth" "$(camera fx)" "$(camera fy)" "$(camera cx)" "$(camera cy)" \
    "$(camera depth_scale)" >"$work/images.txt"
[ "$(grep -c '^ok ' "$work/images.txt")" -eq 7 ] || fail "$work/images.txt: not all frames were tracked"

for input in room.rawlog room; do
    "$work/examples/recording" "$work/$input" >"$work/recording.txt"
    same "$work/recording.txt" "$work/out/trajectory.txt"
done

sed "s|LOG_ROEVO|$work/mrpt|" "$sources/config_ini/mrpt_application.ini" >"$work/application.ini"
"$work/examples/mrpt_rawlog" "$work/application.ini" "$work/room.rawlog"
[ "$(grep -vc '^%' "$work/mrpt/path.txt")" -eq 8 ] || fail "$work/mrpt/path.txt: not a pose for every frame"
[ -s "$work/mrpt/map.simplemap" ] && [ -s "$work/mrpt/map.3Dscene" ] || fail "$work/mrpt: no map"
echo "[MappingApplication]" >"$work/empty.ini"
for ini in none empty; do
    "$work/examples/mrpt_rawlog" "$work/$ini.ini" 2>"$work/$ini.txt" && fail "mrpt_rawlog does without $ini.ini"
    [ "$(grep -c . "$work/$ini.txt")" -eq 1 ] || fail "$work/$ini.txt: more than one line"
done

# Debian's Python finds by itself what is below /usr
for folder in "$prefix"/lib/python3*/dist-packages; do
    [ "$prefix" = /usr ] || PYTHONPATH="$folder${PYTHONPATH:+:$PYTHONPATH}"
done
export PYTHONPATH="${PYTHONPATH-}"
if [ -z "${WITHOUT_PYTHON-}" ]; then
    ls "$prefix"/lib/python3*/dist-packages/roevo-stubs/__init__.pyi  # where type checkers look
    /usr/bin/python3 -B -c "import roevo; print('roevo', roevo.__version__)"
    /usr/bin/python3 -B "$sources/examples/recording.py" "$work/room" >"$work/python.txt"
    same "$work/python.txt" "$work/out/trajectory.txt"
fi
