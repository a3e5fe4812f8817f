#!/usr/bin/python3
"""ATE and RPE of a TUM trajectory, recomputed by the text of the protocol in docs/formats.md.

Written from that text alone, so that it can tell whether the programs do what the page says.
Prints one JSON object: metres and degrees; null where nothing could be measured.
"""
import argparse
import json
import sys

import numpy as np

MAX_DT = 0.02  # s, of paired stamps
INTERVAL, TOLERANCE, JITTER = 1.0, 0.1, 0.002  # s, of the RPE per second


def read_tum(path):
    """Times (n), rotations (n, 3, 3) and positions (n, 3), in time order; the last of equal stamps counts."""
    with open(path, encoding="utf-8") as lines:
        rows = [line.split() for line in lines if line.strip() and not line.lstrip().startswith("#")]
    by_time = {float(row[0]): [float(x) for x in row[1:8]] for row in rows}
    times = np.array(sorted(by_time))
    values = np.array([by_time[t] for t in times])
    x, y, z, w = (values[:, 3:] / np.linalg.norm(values[:, 3:], axis=1, keepdims=True)).T
    rotations = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]).transpose(2, 0, 1)
    return times, rotations, values[:, :3]


def pair(reference, estimate):
    """Indices of paired poses, one to one, the closest pair of all first."""
    first = np.searchsorted(reference, estimate - 2 * MAX_DT)
    last = np.searchsorted(reference, estimate + 2 * MAX_DT)
    candidates = sorted((abs(reference[r] - estimate[e]), e, r)
                        for e in range(len(estimate)) for r in range(first[e], last[e])
                        if abs(reference[r] - estimate[e]) <= MAX_DT)
    taken = {}
    used = set()
    for _, e, r in candidates:
        if e not in taken and r not in used:
            taken[e] = r
            used.add(r)
    return [taken[e] for e in sorted(taken)], sorted(taken)


def align(source, target):
    """Rotation and translation that bring source onto target (Kabsch; Umeyama without scale)."""
    source_mean, target_mean = source.mean(axis=0), target.mean(axis=0)
    u, _, vt = np.linalg.svd((target - target_mean).T @ (source - source_mean))
    rotation = u @ np.diag([1, 1, np.linalg.det(u) * np.linalg.det(vt)]) @ vt
    return rotation, target_mean - rotation @ source_mean


def statistics(errors):
    errors = np.asarray(errors)
    if errors.size == 0:
        return None
    return {"rmse": float(np.sqrt(np.mean(errors ** 2))), "mean": float(errors.mean()),
            "median": float(np.median(errors)), "std": float(errors.std()), "max": float(errors.max()),
            "count": int(errors.size)}


def relative_errors(reference, estimate, intervals):
    """Length and angle of (R_i^-1 R_j)^-1 (E_i^-1 E_j) over pairs of indices."""
    lengths, angles = [], []
    for i, j in intervals:
        motions = []
        for rotations, positions in (reference, estimate):
            motions.append((rotations[i].T @ rotations[j], rotations[i].T @ (positions[j] - positions[i])))
        (rotation_r, translation_r), (rotation_e, translation_e) = motions
        lengths.append(np.linalg.norm(rotation_r.T @ (translation_e - translation_r)))
        turn = rotation_r.T @ rotation_e
        sine = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / 2
        angles.append(np.degrees(np.arctan2(np.linalg.norm(sine), (np.trace(turn) - 1) / 2)))
    return {"translation_m": statistics(lengths), "rotation_deg": statistics(angles)}


def second_later(times):
    """(i, j), j nearest to t_i + 1 s, as far as the trajectory goes."""
    intervals = []
    for i, t in enumerate(times):
        if t + INTERVAL > times[-1] + JITTER:
            continue
        j = int(np.argmin(np.abs(times - (t + INTERVAL))))
        if abs(times[j] - (t + INTERVAL)) <= TOLERANCE:
            intervals.append((i, j))
    return intervals


def evaluate(reference_file, estimate_file):
    reference_times, reference_rotations, reference_positions = read_tum(reference_file)
    estimate_times, estimate_rotations, estimate_positions = read_tum(estimate_file)
    r, e = pair(reference_times, estimate_times)
    if len(r) < 3:
        sys.exit(f"{len(r)} common poses, 3 are needed")
    reference = reference_rotations[r], reference_positions[r]
    estimate = estimate_rotations[e], estimate_positions[e]
    rotation, translation = align(estimate[1], reference[1])
    distances = np.linalg.norm(reference[1] - (estimate[1] @ rotation.T + translation), axis=1)
    every_frame = [(i, i + 1) for i in range(len(r) - 1)]
    return {"pairs": len(r), "ate_m": statistics(distances),
            "rpe_per_second": relative_errors(reference, estimate, second_later(estimate_times[e])),
            "rpe_per_frame": relative_errors(reference, estimate, every_frame)}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("reference")
    parser.add_argument("estimate")
    arguments = parser.parse_args()
    print(json.dumps(evaluate(arguments.reference, arguments.estimate), indent=2))
