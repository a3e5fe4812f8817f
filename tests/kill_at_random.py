#!/usr/bin/env python3
"""Ends every program at random moments by SIGINT, SIGTERM and SIGKILL: what it writes must be absent or whole, what
was there before is kept until then, and only SIGKILL may leave temporary files (.part and .partial in their names).
roevo-study and roevo-compare write a folder file by file, each whole: there some of the files may be.

kill_at_random.py FOLDER_OF_PROGRAMS RECORDING [--kills 100] [--seed 1]"""
import argparse
import hashlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGKILL]


def snapshot(path):
    """Files below a path by name, with a hash of their bytes; temporary ones apart."""
    files, temporary = {}, []
    for folder, _, names in os.walk(path):
        for name in names:
            full = os.path.join(folder, name)
            relative = os.path.relpath(full, path)
            if ".part" in relative:
                temporary.append(relative)
            else:
                files[relative] = hashlib.sha256(open(full, "rb").read()).hexdigest()
    return files, temporary


def programs(recording, inputs):
    """Name, arguments with @ for the output, the output's name in its folder, whether it may exist before."""
    first = ["--first", "6", "--quiet"]
    return [
        ("roevo-odometry", ["--input", recording, "--output", "@", *first], "out", True),
        ("roevo-render", ["--scene", f"{inputs}/odometry/map.3Dscene", "--output", "@"], "view.png", True),
        ("roevo-eval", ["--reference", f"{recording}/groundtruth.txt", "--estimate",
                        f"{inputs}/odometry/trajectory.txt", "--json", "@"], "errors.json", True),
        ("rgbd2rawlog", ["--input", recording, "--output", "@"], "r.rawlog", False),
        ("rawlog2rgbd", ["--input", f"{inputs}/r.rawlog", "--output", "@"], "folder", False),
        ("rawlog-simulate", ["--scene", "livingroom", "--frames", "8", "--size", "160x120", "--output", "@"],
         "s.rawlog", False),
        ("roevo-study", ["--experiment", "depth-weight", "--input", recording, "--first", "6", "--output", "@"],
         "study", False),
        ("roevo-compare", ["--input", recording, "--methods", "roevo-tr", "--output", "@", *first], "compared", False),
    ]


def start(folder, name, arguments, output):
    filled = [output if a == "@" else a for a in arguments]
    return subprocess.Popen([os.path.join(folder, name), *filled], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)


def kill_once(options, program, chosen, seconds, whole):
    """@return what was wrong, or None; and whether the signal came in time"""
    name, arguments, target, may_exist = program
    with tempfile.TemporaryDirectory() as work:
        output = os.path.join(work, target)
        if may_exist and random.random() < 0.5:
            start(options.programs, name, arguments, output).wait()
        before, _ = snapshot(work)
        process = start(options.programs, name, arguments, output)
        time.sleep(random.uniform(0, 1.05 * seconds))
        in_time = process.poll() is None
        process.send_signal(chosen)
        process.wait()
        time.sleep(0.05)  # children that were told, too
        after, temporary = snapshot(work)
        if temporary and chosen != signal.SIGKILL:
            return f"left behind {temporary}", in_time
        by_file = name in ("roevo-study", "roevo-compare")
        if after == before or set(after) == whole or (by_file and set(after) < whole):
            return None, in_time
        return f"neither as before nor whole: {sorted(after)}", in_time


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs")
    parser.add_argument("recording")
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    random.seed(options.seed)
    failures = in_time_count = 0
    with tempfile.TemporaryDirectory() as inputs:
        start(options.programs, "roevo-odometry",
              ["--input", options.recording, "--output", f"{inputs}/odometry", "--quiet"], "").wait()
        start(options.programs, "rgbd2rawlog", ["--input", options.recording, "--output", f"{inputs}/r.rawlog"],
              "").wait()
        chosen = [p for p in programs(options.recording, inputs) if options.only in p[0]]
        for program in chosen:
            with tempfile.TemporaryDirectory() as work:
                begin = time.monotonic()
                code = start(options.programs, program[0], program[1], os.path.join(work, program[2])).wait()
                seconds, whole = time.monotonic() - begin, set(snapshot(work)[0])
            if code != 0:
                sys.exit(f"{program[0]} fails by itself: exit code {code}")
            counts = {}
            for k in range(options.kills // len(chosen)):
                how = SIGNALS[k % len(SIGNALS)]
                fault, in_time = kill_once(options, program, how, seconds, whole)
                in_time_count += in_time
                if fault:
                    failures += 1
                    counts[how.name] = counts.get(how.name, 0) + 1
                    print(f"{program[0]}, {how.name}: {fault}")
            print(f"{program[0]:16} {options.kills // len(chosen)} kills within {seconds:.1f} s: "
                  f"{sum(counts.values())} bad", flush=True)
    print(f"{in_time_count} kills of running programs, {failures} bad")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
