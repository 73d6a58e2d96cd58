"""Setups as dicts with attributes."""

from __future__ import annotations

import copy
import json
import os
import pickle
import tempfile
import unittest
from pathlib import Path

import pmdsim
from setups import scenes, small_setup


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
                ('{"sensors": [{"nam": 1}]}', "/sensors/0/nam", "/sensors/0/nam"),
            ):
                file.write_text(text)
                with self.subTest(text), self.assertRaisesRegex(pmdsim.InputError, message) as caught:
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
