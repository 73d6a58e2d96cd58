#!/usr/bin/env python3
"""Whether frames have the same bits in every way to measure them, as a table in Markdown (docs/reproducibility.md). Where
the same bits are promised and are not found, it ends with 1.

    PYTHONPATH=host/python PMDSIM_LIBRARY=... same_bits.py --program PROGRAM --scenes SCENES [--build BUILD]
        [--other NAME=PROGRAM]...

BUILD is installed into a folder and run there; NAME=PROGRAM is another build, as by clang or without optimization.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

import pmdsim

# The name of a scene in the table, its file, what is changed of it, and a frame of it.
SCENES = [
    ("wall", "analytic/inverse_square.json", {}, 0),
    ("shadows", "room.json", {"sensors/0/resolution": [80, 60], "sensors/0/pixel_pitch_m": [180e-6, 180e-6]}, 0),
    ("two frequencies", "signal.json", {"sensors/0/resolution": [64, 64], "sensors/0/pixel_pitch_m": [225e-6, 225e-6]}, 0),
    ("noise", "electronics/opt8241_like.json", {"sensors/0/resolution": [80, 60], "sensors/0/pixel_pitch_m": [60e-6, 60e-6]}, 0),
    ("bounces", "corner.json", {"sensors/0/resolution": [40, 30], "sensors/0/pixel_pitch_m": [180e-6, 180e-6]}, 0),
    ("motion", "motion.json", {"sensors/0/resolution": [40, 30], "sensors/0/pixel_pitch_m": [180e-6, 180e-6], "frames/count": 4}, 3),
]


def run(command, environment=None):
    done = subprocess.run([str(part) for part in command], env={**os.environ, **(environment or {})}, capture_output=True,
                          text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"same_bits.py: {' '.join(map(str, command))} ends with {done.returncode}: {done.stderr.strip()[-400:]}")


class Scene:
    """A setup with its changes, and what the program makes of it when nothing special is asked for."""

    def __init__(self, name, file, changes, frame, arguments, scratch):
        self.name, self.frame, self.scratch, self.program = name, frame, scratch, arguments.program
        setup = pmdsim.Setup.load(arguments.scenes / file)
        setup.scene = str((arguments.scenes / file).parent / setup.scene)
        for path, value in changes.items():
            put(setup, path.split("/"), value)
        self.frames = setup["frames"]["count"] if "frames" in setup else 1
        self.file = scratch / f"{name.replace(' ', '_')}.json"
        setup.save(self.file)
        self.expected = self.render()

    def render(self, *more, program=None, environment=None, before=(), parts=((),)):
        """The channels of the frame, by name; `parts` are the arguments of runs into the same folder, one after the other."""
        out = Path(tempfile.mkdtemp(dir=self.scratch))
        for part in parts:
            run([*before, program or self.program, "render", self.file, "--format", "npy", "-o", out, *more, *part], environment)
        return self.read(out)

    def read(self, out):
        found = {file.name.split(".", 1)[1].removesuffix(".npy"): np.load(file)
                 for file in out.glob(f"*_{self.frame:04d}.*.npy")}
        shutil.rmtree(out)
        return found

    def shards_merged(self):
        outs = [Path(tempfile.mkdtemp(dir=self.scratch)) for _ in range(3)]
        for index, out in enumerate(outs[:2]):
            run([self.program, "render", self.file, "--format", "npy", "-o", out, "--shard", f"{index}/2"])
        run([self.program, "merge", *outs[:2], "-o", outs[2]])
        return self.read(outs[2])

    def by_python(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", pmdsim.PmdsimWarning)
            frame = pmdsim.render(self.file, frame=self.frame)
        return {name: np.asarray(frame[name]) for name in frame.channels}


def put(setup, keys, value):
    for key in keys[:-1]:
        setup = setup[int(key) if key.isdigit() else key]
    setup[keys[-1]] = value


def difference(found, expected):
    """What is said in the table: nothing where all bits are the same."""
    names = sorted(found.keys() & expected.keys())
    if len(names) != len(expected):
        return f"other channels: {sorted(found.keys() ^ expected.keys())}"
    if all(np.array_equal(found[n].view(np.uint8), expected[n].view(np.uint8)) for n in names):
        return ""
    distances = [n for n in names if n.split(".")[-1] == "distance_m"]
    pixels, most = 0, 0.0
    for name in distances:
        apart = ~((found[name] == expected[name]) | (np.isnan(found[name]) & np.isnan(expected[name])))
        pixels += int(apart.sum())
        if apart.any():
            most = max(most, float(np.nanmax(np.abs(found[name][apart].astype(float) - expected[name][apart]))))
    if pixels == 0:
        return "distances equal, others not: " + ", ".join(n for n in names if found[n].tobytes() != expected[n].tobytes())
    return f"{most:.1e} m, {pixels} of {sum(expected[n].size for n in distances)}"


def ways(arguments, installed):
    """The name of a way, whether the same bits are promised, and how a scene is measured so."""
    one = {"LP_NUM_THREADS": "1"}
    yield "again", True, lambda s: s.render()
    yield "one thread", True, lambda s: s.render(environment=one, before=("taskset", "-c", "0"))
    yield "two shards, merged", True, lambda s: s.shards_merged()
    yield "begun, then resumed", True, lambda s: s.render("--resume", parts=(("--frames", "0:1"), ()))
    yield "only this frame", True, lambda s: s.render("--frames", f"{s.frame}:{s.frame + 1}")
    yield "Python, on the C library", True, lambda s: s.by_python()
    yield "under validation", True, lambda s: s.render(environment={"PMDSIM_VALIDATE": "1"})
    if installed:
        yield "installed", True, lambda s: s.render(program=installed)
    yield "lavapipe's vectors of 128 bits", False, lambda s: s.render(environment={"LP_NATIVE_VECTOR_WIDTH": "128"})
    yield "an error of 10 um", False, lambda s: s.render("--max-error", "10um")
    yield "doubles (`--precision fp64`)", False, lambda s: s.render("--precision", "fp64")
    for name, program in arguments.other:
        yield name, False, lambda s, program=program: s.render(program=program)


def absolute(text):
    return Path(text).resolve()


def named_program(text):
    name, program = text.split("=", 1)
    return name, absolute(program)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=absolute, required=True)
    parser.add_argument("--scenes", type=absolute, required=True)
    parser.add_argument("--build", type=absolute)
    parser.add_argument("--other", type=named_program, action="append", default=[])
    arguments = parser.parse_args()
    scratch = Path(tempfile.mkdtemp(prefix="pmdsim_same_bits_"))
    try:
        installed = None
        if arguments.build:
            run(["cmake", "--install", arguments.build, "--prefix", scratch / "installed"])
            installed = scratch / "installed" / "bin" / "pmdsim"
        scenes = [Scene(*scene, arguments, scratch) for scene in SCENES]
        broken = print_table(scenes, ways(arguments, installed))
    finally:
        shutil.rmtree(scratch)
    if broken:
        sys.exit(f"same_bits.py: promised and not found: {', '.join(broken)}")


def print_table(scenes, every_way):
    print("| measured | promised | " + " | ".join(scene.name for scene in scenes) + " |")
    print("|---|---|" + "---|" * len(scenes))
    broken = []
    for name, promised, measure in every_way:
        found = [difference(measure(scene), scene.expected) for scene in scenes]
        print(f"| {name} | {'yes' if promised else 'no'} | " + " | ".join(text or "same" for text in found) + " |", flush=True)
        if promised and any(found):
            broken.append(name)
    return broken


main()
