"""What a batch is made of: recordings of a folder, of a list, or of a list of sequences in JSON."""

import glob
import json
import os
import re

from messages import Fault, say

ENDINGS = (".rawlog", ".bag", ".db3", ".mcap")
IMAGES = (".png", ".jpg", ".jpeg")
PARTS_OF_A_RECORDING = ("rgb", "depth", "depths", "aligned_depth", "rgb.txt", "associations.txt", "metadata.yaml",
                        "camera.txt")


def recording(path, name=None, **more):
    return {"input": os.path.abspath(path), "name": name, "skip": 0, "first": 0, **more}


def recordings_in(folder, output):
    entries = sorted(os.listdir(folder))
    paths = [os.path.join(folder, e) for e in entries if not e.startswith(".") and not e.endswith("_Images")]
    found = [path for path in paths if path.endswith(ENDINGS) or (os.path.isdir(path) and os.path.abspath(path) != output)]
    is_one = not found and any(entry.lower().endswith(IMAGES) for entry in entries)
    if is_one or any(entry in PARTS_OF_A_RECORDING for entry in entries):
        return [recording(folder)]
    return [recording(path) for path in found]


def recordings_of_list(file):
    if os.path.basename(file) in PARTS_OF_A_RECORDING:
        raise Fault(f"{file} is a part of a recording: give its folder")
    with open(file, encoding="utf-8-sig", errors="surrogateescape") as lines:
        paths = [line.strip() for line in lines if line.strip() and not line.startswith("#")]
    if any("\0" in path for path in paths):
        raise Fault(f"{file} is no list of recordings: it is no text")
    return [recording(os.path.join(os.path.dirname(file), path)) for path in paths]


def parts(entry, found, where):
    """What of a sequence counts: all, a range of frames, or several, each as a recording of its own."""
    ate = ((entry.get("paper") or {}).get("ate_cm") or {}).get("ROEVO-TR+BA")
    truncation = entry["truncation"]
    if truncation is None:
        return [recording(found, entry["name"], paper_ate=ate)]
    note, frames = truncation.get("note") or "", truncation["frames"]
    if frames is None:
        note = f"{note} The whole sequence was run; the paper's figure is not comparable.".strip()
        return [recording(found, entry["name"], note=note)]
    ranges = frames if frames and isinstance(frames[0], list) else [frames]
    made = []
    for begin, end in ranges:
        if not 0 <= begin < end:
            raise Fault(f"{where}: 'truncation.frames' has [{begin}, {end}], which is no range [begin, end)")
        one = recording(found, entry["name"], note=note) | {"skip": begin, "first": end - begin}
        if len(ranges) == 1:
            one["paper_ate"] = ate
        else:
            one["name"] += f"_{begin}_{end}"
        made.append(one)
    return made


def recordings_of_json(file, data):
    """@return what is on this disk, and names of what is not"""
    with open(file, encoding="utf-8-sig") as text:
        entries = json.load(text)["sequences"]
    made, missing = [], []
    for i, entry in enumerate(entries):
        where = f"{file}: sequence {i + 1} ('{entry.get('name')}')"
        names = [n for folder in dict.fromkeys((entry["folder"], entry["name"])) if folder for n in (folder, folder + ".rawlog")]
        found = next((os.path.join(data, n) for n in names if os.path.exists(os.path.join(data, n))), None)
        wanted = parts(entry, found or "", where)
        if found:
            made += wanted
        else:
            missing.append(f"{entry['name']}: not in {data} ({', '.join(names)})")
    return made, missing


def recordings(args):
    missing = []
    try:
        if args.data:
            if not os.path.isdir(args.data):
                raise Fault(f"--data {args.data}: there is no such folder")
            found, missing = recordings_of_json(args.input, args.data)
        elif os.path.isdir(args.input):
            found = recordings_in(args.input, args.output)
        else:
            found = [recording(args.input)] if args.input.endswith(ENDINGS) else recordings_of_list(args.input)
    except OSError as e:
        raise Fault(f"cannot read {args.input}: {e.strerror}") from e
    except (ValueError, TypeError, AttributeError, IndexError) as e:
        raise Fault(f"{args.input} is no list of sequences: {e}") from e
    except KeyError as e:
        raise Fault(f"{args.input} is no list of sequences: the key {e} is missing") from e
    for line in missing:
        say(args, f"skipped {line}")
    if not found:
        raise Fault(f"there is no recording in {args.input}" + (f"; e.g. {missing[0]}" if missing else ""))
    return named(args, found)


def names_in_runs(output):
    """Of the rows of earlier commands: the names that an input has."""
    names = {}
    for file in glob.glob(os.path.join(glob.escape(output), "runs", "*", "*", "run.json")):
        try:
            with open(file, encoding="utf-8") as row:
                path = json.load(row)["input"]
            names.setdefault(path, set()).add(os.path.basename(os.path.dirname(os.path.dirname(file))))
        except (OSError, ValueError, LookupError, TypeError):
            continue  # it will be made anew
    return names


def named(args, found):
    """Names that are unique and good for folders, whatever the files are called. A recording keeps the name that it has:
    it would be in the report twice if another one's end gave it that one's."""
    earlier = names_in_runs(args.output)
    for one in found:
        stem = os.path.basename(one["input"])
        stem = os.path.splitext(stem)[0] if stem.endswith(ENDINGS) else stem
        one["plain"] = re.sub(r"[^A-Za-z0-9._+-]", "_", one["name"] or stem).lstrip(".") or "recording"
        one["name"] = next((name for name in sorted(earlier.get(one["input"], ()))
                            if re.fullmatch(re.escape(one["plain"]) + r"(_\d+)?", name)), None)
    taken = set()
    for one in sorted(found, key=lambda one: one["name"] is None):
        name, i = one["plain"], 2
        unique = one["name"] or name
        while unique in taken:
            unique, i = f"{name}_{i}", i + 1
        taken.add(unique)
        if unique != name:
            say(args, f"{one['input']} is called {unique}: another recording has the name {name}")
        one["name"] = unique
    return found
