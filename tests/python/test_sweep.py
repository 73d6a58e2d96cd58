"""Many variants of a setup."""

from __future__ import annotations

import threading
import time
import unittest

import numpy as np

import pmdsim
from setups import small_setup, wall, without_scene

intensity, radius = "illuminators/0/intensity_w_sr", "illuminators/ring/diodes/rings/0/radius_m"


def sweep_threads() -> list:
    return [thread for thread in threading.enumerate() if thread.name.startswith("pmdsim-sweep")]


class Sweep(unittest.TestCase):
    def test_the_same_frames_whatever_the_workers(self) -> None:
        variations = {intensity: [1, 2, 3], radius: np.linspace(0.05, 0.15, 4)}
        expected = [
            ({intensity: i, radius: r}, pmdsim.render(small_setup(), set={intensity: i, radius: r}).amplitude.tobytes())
            for i in variations[intensity]
            for r in variations[radius]
        ]
        for workers in (1, 3):
            found = [(v, f.amplitude.tobytes()) for v, f in pmdsim.sweep(small_setup(), variations, workers=workers)]
            self.assertEqual(found, expected)
        self.assertEqual(sweep_threads(), [])

    def test_zip(self) -> None:
        found = [v for v, _ in pmdsim.sweep(small_setup(), {intensity: [1, 2], radius: [0.1, 0.2]}, combine="zip")]
        self.assertEqual(found, [{intensity: 1, radius: 0.1}, {intensity: 2, radius: 0.2}])

    def test_poses(self) -> None:
        def at(z_m: float) -> np.ndarray:
            pose = np.diag([1.0, -1.0, -1.0, 1.0])
            pose[2, 3] = z_m
            return pose

        poses = [at(0.5), ([0, 0, 1.0], [1, 0, 0, 0]), {"position_m": [0, 0, 1.5], "look_at_m": [0, 0, 0]}]
        found = [float(np.nanmean(f.z_m)) for _, f in pmdsim.sweep(small_setup(), {"sensors/pmd/pose": poses})]
        np.testing.assert_allclose(found, [2.5, 3.0, 3.5], atol=1e-5)

    def test_nodes(self) -> None:
        poses = []
        for z_m in (-3.0, -2.0, -1.5):
            pose = np.eye(4)
            pose[2, 3] = z_m
            poses.append(pose)
        found = [float(np.nanmean(f.z_m)) for _, f in pmdsim.sweep(small_setup(), {"nodes/wall": poses}, workers=2)]
        np.testing.assert_allclose(found, [3.0, 2.0, 1.5], atol=1e-5)

    def test_frames_and_a_scene_of_arrays(self) -> None:
        setup = without_scene(frames={"rate_hz": 1, "count": 3})
        found = [
            (v[intensity], f.frame) for v, f in pmdsim.sweep(setup, {intensity: [1, 2]}, frames=[0, 2], scene=wall())
        ]
        self.assertEqual(found, [(1, 0), (1, 2), (2, 0), (2, 2)])
        for number in (2, np.int64(2), np.array([2])):
            found = [f.frame for _, f in pmdsim.sweep(setup, {intensity: [1]}, frames=number, scene=wall())]
            self.assertEqual(found, [2])

    def test_the_first_error_ends_it(self) -> None:
        for workers in (1, 2):
            found = []
            with self.assertRaisesRegex(pmdsim.InputError, "intensity"):
                for variant, _ in pmdsim.sweep(small_setup(), {intensity: [1, 2, -3, 4, 5, 6, 7]}, workers=workers):
                    found.append(variant[intensity])
            self.assertEqual(found, [1, 2])
            self.assertEqual(sweep_threads(), [])

    def test_may_be_left_early(self) -> None:
        for workers in (1, 2):
            iterator = pmdsim.sweep(small_setup(), {intensity: range(1, 1000)}, workers=workers)
            next(iterator)
            iterator.close()
            self.assertEqual(sweep_threads(), [])
            with self.assertRaises(StopIteration):
                next(iterator)

    def test_looks_only_a_little_ahead(self) -> None:
        measured = []
        original = pmdsim.Simulator._render

        def counting(self, *arguments, **options):  # type: ignore[no-untyped-def]
            measured.append(1)
            return original(self, *arguments, **options)

        pmdsim.Simulator._render = counting
        try:
            iterator = pmdsim.sweep(small_setup(), {intensity: range(1, 100)}, workers=2)
            next(iterator)
            time.sleep(0.5)
            self.assertLessEqual(len(measured), 5)
            iterator.close()
        finally:
            pmdsim.Simulator._render = original

    def test_arguments_are_checked_at_once(self) -> None:
        for wrong in (
            dict(variations={}),
            dict(variations={intensity: 3}),
            dict(variations={intensity: "123"}),
            dict(variations={1: [1]}),
            dict(variations={intensity: [1], radius: [1, 2]}, combine="zip"),
            dict(variations={intensity: [1]}, combine="sum"),
            dict(variations={intensity: [1]}, workers=0),
            dict(variations={intensity: [1]}, workers=1.5),
            dict(variations={intensity: [1]}, frames=[-1]),
            dict(variations={intensity: [1]}, frames=1.5),
            dict(variations={intensity: [1]}, frames="0"),
            dict(variations={intensity: [1]}, mode="best"),
        ):
            with self.subTest(str(wrong)), self.assertRaises(pmdsim.ArgumentError):
                pmdsim.sweep(small_setup(), **wrong)


if __name__ == "__main__":
    unittest.main()
