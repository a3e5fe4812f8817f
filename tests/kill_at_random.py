#!/usr/bin/env python3
"""Ends every program at random moments by SIGINT, SIGTERM and SIGKILL, half of the time over the results of an
earlier, shorter run. What a program writes must be absent or whole, and what was there before is kept until then:
every file is, byte for byte, as it was or as a run that is not disturbed leaves it (those that hold times: as the
end of such a file is). All files are old or all are new, but for SIGKILL, which may hit between two renames, and
for roevo-study and roevo-compare, which write a folder file by file. Only SIGKILL may leave temporary files (.part
and .partial in their names). A comparison that was ended is made by the same command, whatever was left.

kill_at_random.py FOLDER_OF_PROGRAMS RECORDING [--kills 200] [--seed 1] [--only PROGRAM]"""
import argparse
import hashlib
import os
import random
import signal
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time
from collections import namedtuple

SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGKILL]

# arguments: with @ for the output. earlier: arguments of the run before, or None where there must not be one
Program = namedtuple("Program", "name arguments output earlier by_file")


def cdr(fields):
    """Fields (format, value) as ROS 2 writes them: little-endian, aligned; text and bytes after their length."""
    out = b""
    for kind, value in fields:
        if kind in ("text", "bytes"):
            out += b"\0" * (-len(out) % 4)
            data = value.encode() + b"\0" if kind == "text" else value
            out += struct.pack("<I", len(data)) + data
        else:
            out += b"\0" * (-len(out) % struct.calcsize("<" + kind)) + struct.pack("<" + kind, value)
    return b"\0\1\0\0" + out


def write_bag(path, frames, width=320, height=240):
    """A small recording as rosbag2_storage_sqlite3 keeps it."""
    def head(stamp):
        return [("i", int(stamp)), ("I", int(stamp % 1 * 1e9)), ("text", "camera")]

    def image(stamp, encoding, pixel_bytes):
        pixels = bytearray(random.randbytes(width * height * pixel_bytes))
        if encoding == "16UC1":
            pixels[1::2] = b"\6" * (width * height)  # 1.54 to 1.79 m
        return cdr(head(stamp) + [("I", height), ("I", width), ("text", encoding), ("B", 0),
                                  ("I", width * pixel_bytes), ("bytes", bytes(pixels))])

    matrices = [300, 0, 160, 0, 300, 120, 0, 0, 1] + [1, 0, 0, 0, 1, 0, 0, 0, 1] + [300, 0, 160, 0] * 3
    info = cdr(head(1) + [("I", height), ("I", width), ("text", "plumb_bob"), ("I", 5)]
               + [("d", 0)] * 5 + [("d", value) for value in matrices] + [("I", 0)] * 6 + [("B", 0)])
    topics = [("/rgb/image", "Image"), ("/depth/image", "Image"), ("/rgb/camera_info", "CameraInfo")]
    with sqlite3.connect(path) as bag:
        bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, "
                    "offered_qos_profiles TEXT)")
        bag.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)")
        for i, (topic, kind) in enumerate(topics):
            bag.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (i + 1, topic, f"sensor_msgs/msg/{kind}"))
        messages = [(3, info)]
        for i in range(frames):
            messages += [(1, image(1 + i / 8, "bgr8", 3)), (2, image(1 + i / 8, "16UC1", 2))]
        bag.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, 1, ?)", messages)
    bag.close()


def programs(recording, inputs):
    def first(count):
        return ["--first", str(count), "--quiet"]

    odometry = ["--input", recording, "--output", "@out", "--map-out", "@places.map"]
    render = ["--scene", f"{inputs}/odometry/map.3Dscene", "--output", "@view.png", "--size"]
    errors = ["--reference", f"{recording}/groundtruth.txt", "--json", "@errors.json", "--estimate"]
    rawlog = ["--input", recording, "--output", "@r.rawlog", "--to"]
    simulated = ["--scene", "livingroom", "--output", "@s.rawlog", "--size", "160x120", "--frames"]
    return [
        Program("roevo-odometry", odometry + first(6), "out", odometry + first(4), False),
        Program("roevo-render", render + ["640x480"], "view.png", render + ["320x240"], False),
        Program("roevo-eval", errors + [f"{inputs}/odometry/trajectory.txt"], "errors.json",
                errors + [f"{inputs}/odometry/trajectory_live.txt"], False),
        Program("rgbd2rawlog", rawlog + ["0.3"], "r.rawlog", rawlog + ["0.15"], False),
        Program("bag2rawlog", ["--input", f"{inputs}/a.db3", "--output", "@b.rawlog"], "b.rawlog",
                ["--input", f"{inputs}/b.db3", "--output", "@b.rawlog"], False),
        Program("rawlog2rgbd", ["--input", f"{inputs}/r.rawlog", "--output", "@folder"], "folder", None, False),
        Program("rawlog-simulate", simulated + ["8"], "s.rawlog", simulated + ["4"], False),
        Program("roevo-study", ["--experiment", "depth-weight", "--input", recording, "--first", "6", "--output",
                                "@study"], "study", None, True),
        Program("roevo-compare", ["--input", recording, "--methods", "roevo-tr,roevo-ct", "--output", "@compared",
                                  *first(6)], "compared", None, True),
    ]


def start(options, program, arguments, work):
    filled = [os.path.join(work, a[1:]) if a.startswith("@") else a for a in arguments]
    return subprocess.Popen([os.path.join(options.programs, program.name), *filled], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)


def snapshot(path):
    """Bytes of the files below a path by name; names of temporary ones, and of empty folders, apart."""
    files, temporary = {}, []
    for folder, folders, names in os.walk(path):
        if folder != path and not folders and not names:
            temporary.append(os.path.relpath(folder, path) + "/")
        for name in names:
            full = os.path.join(folder, name)
            relative = os.path.relpath(full, path)
            if ".part" in relative:
                temporary.append(relative)
            else:
                with open(full, "rb") as file:
                    files[relative] = file.read()
    return files, temporary


class Whole:
    """The files of runs that nobody disturbs: those that differ between two runs have times in them."""

    def __init__(self, options, program, arguments):
        made = []
        for _ in range(2):
            with tempfile.TemporaryDirectory() as work:
                begin = time.monotonic()
                code = start(options, program, arguments, work).wait()
                self.seconds = time.monotonic() - begin
                if code != 0:
                    sys.exit(f"{program.name} fails by itself: exit code {code}")
                made.append(snapshot(work)[0])
        self.digests, self.ends = {}, {}
        for name, content in made[0].items():
            if content == made[1][name]:
                self.digests[name] = hashlib.sha256(content).digest()
            else:
                self.ends[name] = content[-1:]
        self.names = set(made[0])

    def has(self, name, content):
        if name in self.digests:
            return hashlib.sha256(content).digest() == self.digests[name]
        return name in self.ends and content.endswith(self.ends[name])


def fault(program, chosen, before, after, temporary, whole):
    """What is wrong with what a program left, or None."""
    if program.by_file:  # what is begun is gone on with, in the same folders
        temporary = [name for name in temporary if not name.endswith("/")]
    if temporary and chosen != signal.SIGKILL:
        return f"left behind {temporary}"
    if after == before:
        return None
    for name, content in after.items():
        if before.get(name) != content and not whole.has(name, content):
            return f"{name} is neither as before nor whole"
    if set(after) == whole.names and all(whole.has(name, content) for name, content in after.items()):
        return None
    if program.by_file or chosen == signal.SIGKILL:
        return None
    return f"neither as before nor all new: {sorted(after)}"


def kill_once(options, program, chosen, whole):
    """@return what was wrong, or None; and whether the signal came in time"""
    with tempfile.TemporaryDirectory() as work:
        if program.earlier and random.random() < 0.5:
            start(options, program, program.earlier, work).wait()
        before, _ = snapshot(work)
        process = start(options, program, program.arguments, work)
        time.sleep(random.uniform(0, 1.05 * whole.seconds))
        in_time = process.poll() is None
        process.send_signal(chosen)
        process.wait()
        time.sleep(0.05)  # children that were told, too
        after, temporary = snapshot(work)
        wrong = fault(program, chosen, before, after, temporary, whole)
        if wrong is None and program.name == "roevo-compare":
            code = start(options, program, program.arguments, work).wait()
            names = set(snapshot(work)[0])
            if code != 0 or names != whole.names:
                wrong = f"does not go on: exit code {code}, {sorted(whole.names ^ names)}"
        return wrong, in_time


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs")
    parser.add_argument("recording")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    random.seed(options.seed)
    failures = in_time_count = 0
    with tempfile.TemporaryDirectory() as inputs:
        for name, output in (("roevo-odometry", "odometry"), ("rgbd2rawlog", "r.rawlog")):
            subprocess.run([os.path.join(options.programs, name), "--input", options.recording, "--output",
                            f"{inputs}/{output}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        write_bag(f"{inputs}/a.db3", 20)
        write_bag(f"{inputs}/b.db3", 4)
        chosen = [p for p in programs(options.recording, inputs) if options.only in p.name]
        for k, program in enumerate(chosen):
            whole = Whole(options, program, program.arguments)
            count = options.kills // len(chosen) + (k < options.kills % len(chosen))
            bad = in_time_here = 0
            for i in range(count):
                how = SIGNALS[i % len(SIGNALS)]
                wrong, in_time = kill_once(options, program, how, whole)
                in_time_here += in_time
                if wrong:
                    bad += 1
                    print(f"{program.name}, {how.name}: {wrong}")
            failures += bad
            in_time_count += in_time_here
            print(f"{program.name:16} {count} kills ({in_time_here} while it ran, of {whole.seconds:.1f} s): {bad} bad",
                  flush=True)
    print(f"{in_time_count} kills of running programs, {failures} bad")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
