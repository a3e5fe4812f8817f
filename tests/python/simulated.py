"""A simulated recording, and what the tests of the Python module do with it."""
import os
import pathlib
import subprocess
import tempfile

import numpy as np
from PIL import Image

import roevo

BIN = pathlib.Path(os.environ["ROEVO_BIN_DIR"])
OPTIONS = {"keyframe.max_translation": 0.02}  # several keyframes in a short recording


def run(program, *arguments):
    subprocess.run([str(BIN / program), *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def read_list(file):
    lines = [line.split() for line in file.read_text().splitlines() if not line.startswith("#")]
    return [(float(stamp), name) for stamp, name in lines]


class Recording:
    """A simulated recording as TUM packs it: frames, camera, and what roevo-odometry makes of it."""

    def __init__(self, folder):
        self.folder, self.out = folder / "room", folder / "out"
        run("rawlog-simulate", "--scene", "livingroom", "--frames", 16, "--size", "320x240", "--layout", "tum",
            "--output", self.folder)
        values = dict(line.split("#")[0].split(":") for line in (self.folder / "camera.txt").read_text().splitlines()
                      if ":" in line.split("#")[0])
        self.camera = roevo.Camera(int(values["width"]), int(values["height"]),
                                   *(float(values[key]) for key in ("fx", "fy", "cx", "cy")))
        self.depth_scale = float(values["depth_scale"])
        pairs = zip(read_list(self.folder / "rgb.txt"), read_list(self.folder / "depth.txt"))
        self.frames = [(np.asarray(Image.open(self.folder / rgb)),
                        np.asarray(Image.open(self.folder / depth)).astype(np.uint16), stamp)
                       for (stamp, rgb), (_, depth) in pairs]
        settings = [word for name, value in OPTIONS.items() for word in ("--set", f"{name}={value}")]
        run("roevo-odometry", "--input", self.folder, "--output", self.out, "--quiet", "--map-out",
            folder / "room.map", "--covariances", folder / "covariances.txt", *settings)


def track(frames=None, convert=lambda array: array, odometry=None, **keywords):
    """An odometry that has seen the frames, and its results."""
    odometry = odometry or roevo.Odometry(recording.camera, roevo.Options(OPTIONS))
    keywords = keywords or {"depth_scale": recording.depth_scale}
    results = [odometry.process(convert(colour), convert(depth), stamp, **keywords)
               for colour, depth, stamp in frames or recording.frames]
    return odometry, results


def tum_text(trajectory):
    lines = [" ".join([f"{row[0]:.6f}", *(f"{value:.9f}" for value in row[1:])]) for row in trajectory]
    return "\n".join(["# timestamp tx ty tz qx qy qz qw", *lines, ""])


scratch = tempfile.TemporaryDirectory()
folder = pathlib.Path(scratch.name)
recording = Recording(folder)
