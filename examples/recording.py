#!/usr/bin/python3
"""Odometry on a folder as TUM RGB-D packs it, from Python: recording.py FOLDER > trajectory.txt

The folder has rgb.txt, depth.txt and camera.txt (docs/formats.md), with depth registered to colour and no lens but that
of five numbers. Needs Debian's python3-numpy and python3-pil.
"""
import pathlib
import sys

import numpy as np
from PIL import Image

import roevo

LENS = "distortion_k1_k2_p1_p2_k3"
FARTHEST = 0.02  # s between a colour and its depth image


def read_list(file):
    """The names by stamp; lines that begin with # are comments."""
    lines = [line.split() for line in file.read_text().splitlines() if line.strip() and not line.startswith("#")]
    return {float(stamp): name for stamp, name in lines}


def read_pairs(folder):
    """Stamp, colour and depth of each frame: one to one, nearest in time first."""
    colours, depths = read_list(folder / "rgb.txt"), read_list(folder / "depth.txt")
    near = sorted((abs(d - c), c, d) for c in colours for d in depths if abs(d - c) <= FARTHEST)
    return sorted((c, colours.pop(c), depths.pop(d)) for _, c, d in near if c in colours and d in depths)


def read_camera(file):
    """The camera, and the units of depth per metre."""
    if not file.exists():
        sys.exit(f"{file} is missing: it tells the camera, see docs/formats.md (roevo-odometry knows those of TUM)")
    lines = [line.split("#")[0].split(":") for line in file.read_text().splitlines()]
    values = {key.strip(): value for key, value in (line for line in lines if len(line) == 2)}
    for key in values:
        if key.startswith(("distortion_k", "fisheye_k", "depth_width", "depth_to_colour")) and key != LENS:
            sys.exit(f"{file}: {key} is beyond this example")
    fx, fy, cx, cy = (float(values[key]) for key in ("fx", "fy", "cx", "cy"))
    lens = [float(word) for word in values.get(LENS, "0 0 0 0 0").split()]
    return roevo.Camera(int(values["width"]), int(values["height"]), fx, fy, cx, cy, lens), float(values["depth_scale"])


def main(folder):
    camera, depth_scale = read_camera(folder / "camera.txt")
    odometry = roevo.Odometry(camera)
    for stamp, colour, depth in read_pairs(folder):
        result = odometry.process(np.asarray(Image.open(folder / colour)),
                                  np.asarray(Image.open(folder / depth)).astype(np.uint16), stamp,
                                  depth_scale=depth_scale)
        if result.reason:
            print(result, file=sys.stderr)
    odometry.refine_all()
    np.savetxt(sys.stdout, odometry.trajectory(), fmt=["%.6f"] + 7 * ["%.9f"],
               header="timestamp tx ty tz qx qy qz qw")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: recording.py FOLDER")
    main(pathlib.Path(sys.argv[1]))
