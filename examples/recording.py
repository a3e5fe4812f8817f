#!/usr/bin/python3
"""Odometry on a folder as TUM RGB-D packs it, from Python: recording.py FOLDER > trajectory.txt

The folder has rgb.txt, depth.txt and camera.txt (docs/formats.md). Needs Debian's python3-numpy and python3-pil.
"""
import pathlib
import sys

import numpy as np
from PIL import Image

import roevo


def read_list(file):
    """The (stamp, name) of each line that is no comment."""
    lines = [line.split() for line in file.read_text().splitlines() if not line.startswith("#")]
    return [(float(stamp), name) for stamp, name in lines]


def read_camera(file):
    """The camera, and the units of depth per metre."""
    lines = [line.split("#")[0].split(":") for line in file.read_text().splitlines()]
    values = {key.strip(): value for key, value in (line for line in lines if len(line) == 2)}
    fx, fy, cx, cy = (float(values[key]) for key in ("fx", "fy", "cx", "cy"))
    return roevo.Camera(int(values["width"]), int(values["height"]), fx, fy, cx, cy), float(values["depth_scale"])


def main(folder):
    camera, depth_scale = read_camera(folder / "camera.txt")
    odometry = roevo.Odometry(camera)
    # As rawlog-simulate writes them, both lists have the same frames
    for (stamp, colour), (_, depth) in zip(read_list(folder / "rgb.txt"), read_list(folder / "depth.txt")):
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
