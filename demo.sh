#!/bin/sh
# From a bare Debian 12 or 13 to a trajectory and a picture of the map: simulates an RGB-D recording of a living room,
# runs the odometry on it, says how far it is from the truth and renders what was mapped. Results are in demo_output/.
set -eu
cd "$(dirname "$0")"
. scripts/set_up.sh

frames=300
out=demo_output
rawlog=$out/livingroom.rawlog

install_packages
build release rawlog-simulate roevo-odometry roevo-render
PATH="$PWD/build/release/bin:$PATH"
mkdir -p "$out"

if [ ! -f "$rawlog" ] || [ ! -f "${rawlog%.rawlog}_groundtruth.txt" ]; then
    say "Simulating $frames frames of a living room"
    rawlog-simulate --scene livingroom --frames "$frames" --output "$rawlog"
fi

say "Running the odometry"
roevo-odometry --input "$rawlog" --output "$out/odometry"

say "Rendering the map"
roevo-render --scene "$out/odometry/map.3Dscene" --output "$out/map.png" --size 1600x1000 --view iso
roevo-render --input "$out/odometry" --output "$out/view.html"

build release rgbd2rawlog rawlog2rgbd bag2rawlog roevo-eval roevo-compare roevo-study

say "Done"
cat <<END
picture     $out/map.png
look around $out/view.html              (in any browser, no network needed)
trajectory  $out/odometry/trajectory.txt
3-D map     $out/odometry/map.3Dscene   (look at it with: SceneViewer3D $out/odometry/map.3Dscene)
            $out/odometry/map.ply       (CloudCompare, MeshLab)
per frame   $out/odometry/frames.csv, summary in $out/odometry/summary.json
END
