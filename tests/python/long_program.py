"""Every shipped setup has the same bytes from Python as from the program."""

from __future__ import annotations

import tempfile
import unittest
import warnings
from pathlib import Path

import pmdsim
from setups import same_bytes, scenes, write_by_program

frames_at_most = 3


class Program(unittest.TestCase):
    def test_every_scene(self) -> None:
        setups = sorted(scenes.rglob("*.json"))
        self.assertGreater(len(setups), 15)
        compared = 0
        for setup in setups:
            with self.subTest(setup.name), tempfile.TemporaryDirectory() as folder, pmdsim.Simulator() as simulator:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", pmdsim.PmdsimWarning)
                    simulator.load(setup)
                    count = min(frames_at_most, simulator.frame_count)
                    write_by_program(setup, Path(folder), "--format", "npy", "--frames", f"0:{count}")
                    for frame in simulator.frames(frames=range(count)):
                        prefix = f"{frame.sensor}_{frame.frame:04d}."
                        same_bytes(frame, list(Path(folder).glob(f"{prefix}*.npy")), prefix)
                        compared += 1
        print(f"{compared} frames of {len(setups)} setups")


if __name__ == "__main__":
    unittest.main()
