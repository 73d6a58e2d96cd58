"""What the program wrote, in any format."""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
import types
import unittest
from pathlib import Path

import numpy as np

import pmdsim
from setups import small_setup, write_by_program


class Recordings(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.root = Path(cls.temporary.name)
        setup = small_setup(frames={"rate_hz": 10, "count": 3})
        setup["sensors"][0]["name"] = "front.left"
        setup["sensors"].append({**setup["sensors"][0], "name": "second", "resolution": [4, 3]})
        setup["illuminators"][0]["pose"]["sensor"] = "front.left"
        cls.setup = setup
        (cls.root / "setup.json").write_text(json.dumps(setup))
        for name in ("npy", "npz", "h5", "exr"):
            write_by_program(cls.root / "setup.json", cls.root / name, "--format", name)

    def test_every_format_has_the_same_frames(self) -> None:
        with pmdsim.Simulator(self.setup) as simulator:
            for name in ("npy", "npz", "h5", "exr"):
                with self.subTest(name):
                    recording = pmdsim.load(self.root / name)
                    self.assertEqual((recording.sensors, len(recording)), (["front.left", "second"], 6))
                    for frame in recording.frames:
                        measured = simulator.render(sensor=frame.sensor, frame=frame.frame)
                        self.assertEqual(set(frame.channels), set(measured.channels))
                        for channel in frame.channels:
                            self.assertEqual(frame[channel].tobytes(), measured[channel].tobytes(), channel)
                            self.assertEqual(frame.units[channel], measured.units[channel], channel)
                        self.assertEqual(frame.camera, measured.camera)
                        np.testing.assert_allclose(frame.points_m, measured.points_m, atol=1e-12)

    def test_by_sensor_and_number(self) -> None:
        recording = pmdsim.load(self.root / "npy")
        self.assertEqual(recording["second", 2].shape, (3, 4))
        self.assertEqual(recording[0, 1].time_s, 0.1)
        self.assertEqual([frame.frame for frame in recording.frames[:3:2]], [0, 1])
        self.assertEqual(recording.manifest["command"], "render")
        self.assertIn("front.left", repr(recording))
        self.assertFalse(recording["second", 2].distance_m.flags.writeable)
        for wrong in (("none", 0), (2, 0), ("second", 3), ("second", -1), ("second", [0]), 0, ("second",)):
            with self.subTest(wrong), self.assertRaises(pmdsim.ArgumentError):
                recording[wrong]

    def test_stack(self) -> None:
        recording = pmdsim.load(self.root / "npy")
        stacked = recording.stack("distance_m", "second")
        self.assertEqual((stacked.shape, stacked.dtype), ((3, 3, 4), np.float32))
        np.testing.assert_array_equal(stacked[1], recording["second", 1].distance_m)
        with self.assertRaises(pmdsim.UnknownChannelError):
            recording.stack("nothing")

    def test_xarray(self) -> None:
        module = types.ModuleType("xarray")
        module.Dataset = lambda variables, coords=None, attrs=None: (variables, coords, attrs)
        before = sys.modules.get("xarray")
        sys.modules["xarray"] = module
        try:
            variables, coordinates, _ = pmdsim.load(self.root / "npy").to_xarray("second")
        finally:
            sys.modules.pop("xarray")
            if before:
                sys.modules["xarray"] = before
        self.assertEqual(variables["z_m"][0], ("frame", "row", "column"))
        self.assertEqual(coordinates["frame"], [0, 1, 2])
        self.assertEqual(coordinates["time_s"][1], [0.0, 0.1, 0.2])

    def test_single_files(self) -> None:
        expected = pmdsim.load(self.root / "npy")["second", 0].distance_m.tobytes()
        for name in ("npz", "h5", "exr"):
            frame = pmdsim.load(self.root / name / f"second_0000.{name}")
            self.assertEqual(frame.distance_m.tobytes(), expected)
            with self.assertRaises(pmdsim.ArgumentError):
                frame.points_m

    def test_a_folder_of_pictures_alone(self) -> None:
        write_by_program(self.root / "setup.json", self.root / "png", "--format", "png")
        recording = pmdsim.load(self.root / "png")
        with self.assertRaisesRegex(pmdsim.InputError, "no format that has its values"):
            recording[0, 0]

    def test_what_is_missing_or_wrong(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(pmdsim.InputError, "manifest.json"):
                pmdsim.load(folder)
            with self.assertRaisesRegex(pmdsim.InputError, "no such file"):
                pmdsim.load(f"{folder}/none.npz")
            (Path(folder) / "a.txt").write_text("")
            with self.assertRaisesRegex(pmdsim.InputError, "expected a folder"):
                pmdsim.load(f"{folder}/a.txt")
            for ending in ("npz", "h5", "exr"):
                file = Path(folder) / f"a.{ending}"
                for content in (b"", b"no such thing", b"PK\x03\x04 broken"):
                    file.write_bytes(content)
                    with self.subTest(ending), self.assertRaises(pmdsim.InputError) as caught:
                        pmdsim.load(file)
                    self.assertEqual(caught.exception.file, str(file))
            (Path(folder) / "empty.npz").write_bytes(b"")
            with self.assertRaisesRegex(pmdsim.InputError, "empty.npz: .*expected a .npz file"):
                pmdsim.load(f"{folder}/empty.npz")
            for text in ("{", "[1]"):
                np.savez(f"{folder}/report.npz", distance_m=np.ones((2, 2)), report=np.array(text))
                with self.assertRaisesRegex(pmdsim.InputError, "report.npz: .*JSON object") as caught:
                    pmdsim.load(f"{folder}/report.npz")
                self.assertEqual(caught.exception.file, f"{folder}/report.npz")
            for text in (
                "",
                "[]",
                '{"frames": 1}',
                '{"frames": [{}]}',
                '{"frames": [{"sensor": "a", "frame": 0, "outputs": null}]}',
            ):
                (Path(folder) / "manifest.json").write_text(text)
                with self.subTest(text), self.assertRaises(pmdsim.InputError):
                    pmdsim.load(folder)

    def test_a_folder_without_frames(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "manifest.json").write_text('{"frames": []}')
            with self.assertRaisesRegex(pmdsim.ArgumentError, f"^{folder}: there are no frames$"):
                pmdsim.load(folder).stack("distance_m")

    def test_a_missing_channel_file(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(self.root / "npy", folder, dirs_exist_ok=True)
            (Path(folder) / "second_0001.z_m.npy").unlink()
            (Path(folder) / "second_0001.lit.npy").write_bytes(b"short")
            frame = pmdsim.load(folder)["second", 1]
            self.assertEqual(frame.distance_m.shape, (3, 4))
            for channel in ("z_m", "lit"):
                with self.assertRaisesRegex(pmdsim.InputError, f"{channel}.npy: (?!.*pickle)"):
                    frame[channel]


if __name__ == "__main__":
    unittest.main()
