"""Thousands of frames in one process need no more memory than some."""

from __future__ import annotations

import gc
import unittest

import pmdsim
from setups import small_setup


def resident_mib() -> float:
    with open("/proc/self/status") as status:
        return next(float(line.split()[1]) for line in status if line.startswith("VmRSS:")) / 1024


class Memory(unittest.TestCase):
    def check(self, name: str, columns: int, action: str) -> None:
        setup = small_setup()
        setup["sensors"][0].update(resolution=[columns, columns], focal_length_m=0.0018 * columns / 8)
        with pmdsim.Simulator(setup) as simulator:

            def one(number: int) -> None:
                if action == "render":
                    frame = pmdsim.render(setup)
                else:
                    if action == "set":
                        simulator.set("illuminators/0/intensity_w_sr", 1 + number % 7)
                    frame = simulator.render()
                frame.distance_m.sum()
                frame.report

            for number in range(200):  # caches, pools and the allocator's arenas fill
                one(number)
            gc.collect()
            before = resident_mib()
            for number in range(1000):
                one(number)
            gc.collect()
            after = resident_mib()
        frame_mib = columns * columns * 13 * 4 / 2**20
        print(f"{name}: {before:.1f} MiB before, {after:.1f} MiB after 1,000 frames of {frame_mib:.2f} MiB")
        # A frame in a hundred that is kept would show.
        self.assertLess(after - before, 4 + 10 * frame_mib)

    def test_frames(self) -> None:
        self.check("8 x 8", 8, "frames")

    def test_large_frames(self) -> None:
        self.check("200 x 200", 200, "frames")

    def test_changes(self) -> None:
        self.check("8 x 8, set", 8, "set")

    def test_one_call(self) -> None:
        self.check("8 x 8, pmdsim.render", 8, "render")


if __name__ == "__main__":
    unittest.main()
