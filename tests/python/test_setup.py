"""Setups as dicts with attributes."""

from __future__ import annotations

import copy
import json
import os
import pickle
import tempfile
import unittest
from pathlib import Path
from typing import Any, List

import pmdsim
from setups import scenes, small_setup, wall


class SetupTest(unittest.TestCase):
    def setUp(self) -> None:
        self.setup = pmdsim.Setup(small_setup())

    def test_attributes_and_keys_are_the_same(self) -> None:
        self.setup.sensors[0].focal_length_m = 0.02
        self.assertEqual(self.setup["sensors"][0]["focal_length_m"], 0.02)
        self.setup["illuminators"][0]["intensity_w_sr"] = 3
        self.assertEqual(self.setup.illuminators[0].intensity_w_sr, 3)
        self.assertEqual(self.setup.illuminators[0].diodes.rings[0].count, 16)
        del self.setup.illuminators[0].intensity_w_sr
        self.assertNotIn("intensity_w_sr", self.setup.illuminators[0])
        expected = small_setup()
        expected["sensors"][0]["focal_length_m"] = 0.02
        self.assertEqual(json.loads(json.dumps(self.setup)), expected)

    def test_what_is_added_has_attributes_too(self) -> None:
        self.setup.illuminators.append({"name": "lamp", "diodes": "monostatic"})
        self.assertEqual(self.setup.illuminators[1].name, "lamp")
        self.setup.illuminators[1] = {"name": "sun", "diodes": {"rings": [{"radius_m": 1, "count": 1}]}}
        self.assertEqual(self.setup.illuminators[1].diodes.rings[0].radius_m, 1)
        self.setup.illuminators += [{"name": "x", "diodes": "monostatic"}]
        self.assertEqual(self.setup.illuminators[2].name, "x")
        self.setup.update(frames={"rate_hz": 10, "count": 2})
        self.assertEqual(self.setup.frames.count, 2)
        self.setup.nodes = {"robot": {"pose": {"trajectory": "a.csv"}}}
        self.assertEqual(self.setup.nodes.robot.pose.trajectory, "a.csv")

    def test_completion(self) -> None:
        self.assertIn("bounces", dir(self.setup))
        self.assertIn("unwrap_range_m", dir(self.setup.sensors[0]))
        self.assertIn("radius_m", dir(self.setup.illuminators[0].diodes.rings[0]))
        self.assertIn("file", dir(self.setup.illuminators[0].diodes))
        self.setup.sensors[0].electronics = {}
        self.assertIn("quantum_efficiency", dir(self.setup.sensors[0].electronics))

    def test_unknown_keys_are_named_at_once(self) -> None:
        for wrong in (
            lambda: setattr(self.setup.sensors[0], "focal_lenth_m", 1),
            lambda: self.setup.sensors[0].focal_lenth_m,
            lambda: self.setup.sensors[0].update(focal_lenth_m=1),
            lambda: self.setup.sensors.append({"focal_lenth_m": 1}),
            lambda: pmdsim.Setup({"sensors": [{"focal_lenth_m": 1}]}),
        ):
            with self.assertRaisesRegex(pmdsim.UnknownKeyError, r"sensors/\d/focal_lenth_m.*focal_length_m") as caught:
                wrong()
            self.assertIsInstance(caught.exception, (AttributeError, KeyError, pmdsim.InputError))
            self.assertIn("/sensors/", caught.exception.place)

    def test_a_key_that_is_not_there(self) -> None:
        with self.assertRaisesRegex(pmdsim.UnknownKeyError, 'default is "auto"'):
            self.setup.shadows
        self.assertFalse(hasattr(self.setup, "shadows"))

    def test_files_with_comments(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "setup.json"
            file.write_text(
                '// a "comment"\n{"scene": "http://x//y.gltf", /* and\n another */ "bounces": "all"}  // end'
            )
            setup = pmdsim.Setup.load(file)
            self.assertEqual(setup, {"scene": "http://x//y.gltf", "bounces": "all"})
            self.assertEqual(
                setup.directory, os.path.realpath(folder) if folder == os.path.realpath(folder) else folder
            )
            setup.save(f"{folder}/again.json")
            self.assertEqual(pmdsim.Setup.load(f"{folder}/again.json"), setup)
            self.assertEqual(sorted(os.listdir(folder)), ["again.json", "setup.json"])

    def test_a_byte_order_mark(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "setup.json"
            file.write_text('\ufeff{"bounces": "all"}', encoding="utf-8")
            self.assertEqual(pmdsim.Setup.load(file), {"bounces": "all"})

    def test_values_that_are_no_setup(self) -> None:
        endless: List[Any] = []
        endless.append(endless)
        for values in ([1], [], "room.json", 3, {"sensors": endless}):
            with self.subTest(type(values)), self.assertRaises(pmdsim.ArgumentError):
                pmdsim.Setup(values)  # type: ignore[arg-type]

    def test_a_file_that_cannot_be_written(self) -> None:
        """A partial file that is a folder can neither be opened nor removed, as on a read-only file system."""
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / f"setup.json.{os.getpid()}.partial").mkdir()
            with self.assertRaisesRegex(pmdsim.OutputError, "setup.json: cannot be written: Is a directory"):
                self.setup.save(f"{folder}/setup.json")

    def test_nothing_is_left_of_what_cannot_be_written(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            self.setup.scene = "room\udce4.glb"
            with self.assertRaisesRegex(pmdsim.ArgumentError, "^/scene: ") as caught:
                self.setup.save(f"{folder}/setup.json")
            self.assertEqual(caught.exception.place, "/scene")
            (Path(folder) / "taken").mkdir()
            self.setup.scene = "room.glb"
            with self.assertRaises(pmdsim.OutputError):
                self.setup.save(f"{folder}/taken")
            self.assertEqual(os.listdir(folder), ["taken"])

    def test_errors_name_the_file_that_there_is(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "room.json"
            file.write_text(json.dumps(small_setup(bounces=-1)))
            loaded = pmdsim.Setup.load(file)
            of_a_folder = pmdsim.Setup(small_setup(bounces=-1), directory=folder)
            for setup, scene, name in (
                (file, None, str(file)),
                (file, wall(), str(file)),
                (loaded, None, str(file)),
                (loaded.copy(), None, str(file)),
                (pickle.loads(pickle.dumps(loaded)), None, str(file)),
                (of_a_folder, None, ""),
                (dict(loaded), None, ""),
            ):
                with self.subTest(name), self.assertRaises(pmdsim.InputError) as caught:
                    pmdsim.render(setup, scene=scene)
                self.assertEqual((caught.exception.file, caught.exception.place), (name, "/bounces"))
                self.assertRegex(str(caught.exception), f"^{name or 'the setup'}(:1:[0-9]+)?: /bounces: expected ")

    def test_errors_of_changes_name_the_file_that_there_is(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "room.json"
            file.write_text(json.dumps(small_setup()))
            with pmdsim.Simulator(pmdsim.Setup.load(file)) as simulator:
                with self.assertRaises(pmdsim.InputError):
                    simulator.load(small_setup(bounces=-1))  # after which the one before stays
                with self.assertRaisesRegex(pmdsim.InputError, f"^{file}: /bounces: ") as caught:
                    simulator.set("bounces", -1)
                self.assertEqual(caught.exception.file, str(file))

    def test_every_shipped_setup_is_read_as_the_library_does(self) -> None:
        for file in sorted(scenes.rglob("*.json")):
            with self.subTest(file.name):
                self.assertIn("sensors", pmdsim.Setup.load(file))

    def test_files_that_are_wrong(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "setup.json"
            for text, message, place in (
                ('{\n "scene": ]', "2:11", "2:11"),
                ('{"scene": "a", "scene": "b"}', "twice", ""),
                ("[]", "expected a JSON object", ""),
                ('{"bounces": NaN}', "NaN", ""),
                ('{"sensors": [{"nam": 1}]}', f"^{file}: /sensors/0/nam: there is no key", "/sensors/0/nam"),
                ("[" * 100000, "expected fewer levels", ""),
            ):
                file.write_text(text)
                with self.subTest(text[:80]), self.assertRaisesRegex(pmdsim.InputError, message) as caught:
                    pmdsim.Setup.load(file)
                self.assertEqual((caught.exception.file, caught.exception.place), (str(file), place))
            with self.assertRaisesRegex(pmdsim.InputError, "cannot be read"):
                pmdsim.Setup.load(f"{folder}/none.json")
            with self.assertRaises(pmdsim.OutputError):
                self.setup.save(f"{folder}/none/setup.json")

    def test_copies_are_of_their_own(self) -> None:
        self.setup.directory = "/somewhere"
        for made in (
            self.setup.copy(),
            copy.copy(self.setup),
            copy.deepcopy(self.setup),
            pickle.loads(pickle.dumps(self.setup)),
        ):
            self.assertIsInstance(made, pmdsim.Setup)
            self.assertEqual(made, self.setup)
            self.assertEqual(made.directory, "/somewhere")
            made.sensors[0].name = "other"
            self.assertEqual(self.setup.sensors[0].name, "pmd")

    def test_rendered_with_its_own_folder(self) -> None:
        setup = pmdsim.Setup.load(scenes / "corner.json")
        setup.sensors[0].resolution = [4, 3]
        setup.bounces = 0
        self.assertEqual(pmdsim.render(setup).shape, (3, 4))


if __name__ == "__main__":
    unittest.main()
