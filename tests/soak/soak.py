#!/usr/bin/env python3
"""Many frames of a small moving scene in one process: what it holds must not grow, and the last frame is the one that is
measured alone. First by the program, into a folder, with what is done there afterwards; then by the library, in a loop.

    PYTHONPATH=host/python PMDSIM_LIBRARY=... soak.py PROGRAM SCENES [FRAMES]     # 2000 without FRAMES
"""

import filecmp
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pmdsim

SAMPLES = 20
PAGE_KIB = os.sysconf("SC_PAGE_SIZE") / 1024
# What a process may hold more at the end than after a fifth of the frames. Heaps breathe by some hundred KiB; of 2000
# frames it is a loss of 2 KiB a frame that is found, of 100,000 one of 50 bytes.
MOST_GROWTH_KIB = 4096


class Watch:
    """What a process holds, read from /proc after so many frames."""

    def __init__(self, process):
        self.folder = Path("/proc", str(process))
        self.rows = []
        self.begin = time.monotonic()

    def look(self, frames):
        resident = int(Path(self.folder, "statm").read_text().split()[1]) * PAGE_KIB
        handles, threads = self.least("fd"), self.least("task")
        self.rows.append((frames, time.monotonic() - self.begin, resident, handles, threads))
        print(f"{frames:>9} frames {self.rows[-1][1]:>8.1f} s {resident / 1024:>9.2f} MiB {handles:>4} handles "
              f"{threads:>4} threads", flush=True)

    def least(self, part):
        """A single look may fall on a file that is being written, or on the thread that prepares the next exposure."""
        counts = []
        for _ in range(20):
            counts.append(len(os.listdir(self.folder / part)))
            time.sleep(0.002)
        return min(counts)

    def judge(self, what):
        """Growth from a fifth of the frames on; a straight line through the rows tells what a day would take."""
        settled = [row for row in self.rows if row[0] >= self.rows[-1][0] / 5]
        frames, seconds, resident, handles, threads = zip(*settled)
        mean_frames, mean_resident = sum(frames) / len(frames), sum(resident) / len(resident)
        spread = sum((f - mean_frames) ** 2 for f in frames)
        slope = sum((f - mean_frames) * (r - mean_resident) for f, r in zip(frames, resident)) / spread
        rate = (frames[-1] - frames[0]) / (seconds[-1] - seconds[0])
        half = len(settled) // 2
        rates = [(frames[b] - frames[a]) / (seconds[b] - seconds[a]) for a, b in ((0, half), (half, -1))]
        print(f"{what}: {slope * 1024:+.1f} bytes a frame, {rate:.0f} frames a second ({rates[0]:.0f}, then {rates[1]:.0f}); "
              f"in 24 hours {rate * 86400 / 1e6:.1f} million frames and {slope * rate * 86400 / 1024:+.1f} MiB", flush=True)
        expect(resident[-1] - resident[0] < MOST_GROWTH_KIB, f"{what}: {resident[-1] - resident[0]:.0f} KiB more")
        expect(handles[-1] <= handles[0], f"{what}: {handles[0]} open files, then {handles[-1]}")
        expect(threads[-1] <= threads[0], f"{what}: {threads[0]} threads, then {threads[-1]}")


def expect(is_so, otherwise):
    if not is_so:
        sys.exit(f"soak.py: {otherwise}")


def small_setup(scenes, frames):
    """The board of scenes/motion.json goes and comes, as long as it takes."""
    setup = pmdsim.Setup.load(scenes / "motion.json")
    setup.scene = str(scenes / "moving.gltf")
    setup.sensors[0].resolution = [16, 12]
    setup.sensors[0].pixel_pitch_m = [450e-6, 450e-6]
    setup.frames = {"start_s": 0, "rate_hz": frames / 2.0, "count": frames}
    return setup


def run(arguments):
    began = time.monotonic()
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True, check=False)
    expect(done.returncode == 0, f"{arguments[1]} ends with {done.returncode}: {done.stderr.strip()[-300:]}")
    return time.monotonic() - began


def frames_there(folder):
    with os.scandir(folder) as entries:
        return sum(entry.name.endswith(".record.json") for entry in entries)


def soak_program(program, setup, frames, scratch):
    """The process is looked at while it is at work, so that frames are counted by its records."""
    out = scratch / "out"
    command = [str(program), "render", str(setup), "--format", "npz", "-o", str(out)]
    with open(scratch / "log", "w", encoding="utf-8") as log:
        with subprocess.Popen(command, stdout=log, stderr=log) as process:
            watch, wanted = Watch(process.pid), 0
            while process.poll() is None:
                time.sleep(0.05 if frames <= 10000 else 0.5)
                done = frames_there(out) if out.exists() else 0
                if frames > done >= wanted > 0 or done and not wanted:
                    try:
                        watch.look(done)
                    except (FileNotFoundError, ProcessLookupError, IndexError):
                        break # it has just ended
                    wanted = done + frames // SAMPLES
            process.wait()
    took = time.monotonic() - watch.begin
    expect(process.returncode == 0, f"render ends with {process.returncode}: {(scratch / 'log').read_text()[-300:]}")
    watch.judge("render")
    print(f"render: {took:.1f} s, {took - watch.rows[-1][1]:.1f} of them after the last row, with the manifest", flush=True)
    return out


def check_folder(program, setup, frames, scratch, out):
    expect(frames_there(out) == frames, "a record is missing")
    manifest = json.loads((out / "manifest.json").read_bytes())
    expect(len(manifest["frames"]) == frames, "the manifest lacks frames")
    last = frames - 1
    run([program, "render", setup, "--format", "npz", "-o", scratch / "alone", "--frames", f"{last}:{frames}"])
    alone = [file for file in (scratch / "alone").iterdir() if file.suffix == ".npz"]
    expect(len(alone) == 1, "the last frame alone is no file")
    expect(filecmp.cmp(alone[0], out / alone[0].name, shallow=False), "the last frame has other bytes alone")
    resumed = run([program, "render", setup, "--format", "npz", "-o", out, "--resume"])
    merged = run([program, "merge", out, "-o", scratch / "merged"])
    expect(filecmp.cmp(out / "manifest.json", scratch / "merged" / "manifest.json", shallow=False), "merge changes the manifest")
    print(f"all {frames} frames there: --resume {resumed:.2f} s, merge {merged:.2f} s; the last frame has the same bytes alone; "
          f"manifest {(out / 'manifest.json').stat().st_size / 2**20:.1f} MiB", flush=True)


def soak_library(setup, frames):
    with pmdsim.Simulator(setup) as simulator:
        watch = Watch(os.getpid())
        for frame in range(frames):
            taken = simulator.render(frame=frame)
            taken.distance_m.sum()
            if frame % (frames // SAMPLES) == frames // SAMPLES - 1:
                watch.look(frame + 1)
        watch.judge("library")
        alone = pmdsim.render(setup, frame=frames - 1)
        for channel in taken.channels:
            expect(taken[channel].tobytes() == alone[channel].tobytes(), f"{channel} of the last frame has other bits alone")


def main():
    program, scenes = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    frames = int(sys.argv[3]) if len(sys.argv) > 3 else 2000
    place = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    scratch = Path(tempfile.mkdtemp(prefix="pmdsim_soak_", dir=place))
    try:
        setup = scratch / "setup.json"
        small_setup(scenes, frames).save(setup)
        check_folder(program, setup, frames, scratch, soak_program(program, setup, frames, scratch))
        soak_library(setup, frames)
    finally:
        shutil.rmtree(scratch)


main()
