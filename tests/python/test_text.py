"""Text that the library would take for another is refused, and messages are one line."""

from __future__ import annotations

import unittest
from typing import Any, Callable, Dict

import numpy as np

import pmdsim
from setups import scenes, small_setup, without_scene

setup_file = str(scenes / "room.json")


class Text(unittest.TestCase):
    def refused(self, actions: Dict[str, Callable[[], Any]], text: str) -> None:
        for name, action in actions.items():
            with self.subTest(name), self.assertRaisesRegex(pmdsim.ArgumentError, text) as caught:
                action()
            self.assertNotIn("\n", str(caught.exception))

    def test_nul_and_lone_surrogates(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            for wrong in ("\0x", "\udce4"):
                self.refused(
                    {
                        "device": lambda: pmdsim.render(small_setup(), device="cpu" + wrong),
                        "channels": lambda: pmdsim.render(small_setup(), channels="distance_m" + wrong),
                        "node": lambda: simulator.move(node="wall" + wrong, pose=np.eye(4)),
                        "path": lambda: simulator.set("sensors/0/taps" + wrong, 4),
                        "value": lambda: pmdsim.render(small_setup(), set={"sensors/0/name": "a" + wrong}),
                        "scene": lambda: pmdsim.render(small_setup(scene=small_setup()["scene"] + wrong)),
                        "key": lambda: pmdsim.render(small_setup(**{"bounces" + wrong: 1})),
                        "save": lambda: pmdsim.Setup({"scene": "a" + wrong}).save("/no/such/folder/a.json"),
                    },
                    "expected text without NUL and lone surrogates",
                )

    def test_names_of_files(self) -> None:
        frame = pmdsim.render(small_setup())
        for name in (setup_file + "\0x", "\ud800", 3, b"bytes"):
            actions = {
                "render": lambda: pmdsim.render(name),
                "Setup.load": lambda: pmdsim.Setup.load(name),
                "Setup.save": lambda: pmdsim.Setup().save(name),
                "directory": lambda: pmdsim.Setup(directory=name),
                "load": lambda: pmdsim.load(name),
                "Frame.save": lambda: frame.save(name),
            }
            self.refused(actions, "expected a path")

    def test_one_line(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            self.refused(
                {
                    "pose": lambda: simulator.move(node="wall", pose=np.eye(4) * np.nan),
                    "scene": lambda: pmdsim.render(without_scene(), scene=np.eye(4)),  # type: ignore[arg-type]
                    "setup": lambda: pmdsim.render(np.eye(4)),  # type: ignore[arg-type]
                    "mode": lambda: simulator.render(mode=np.eye(4)),  # type: ignore[arg-type]
                    "samples": lambda: simulator.render(samples=np.eye(4)),  # type: ignore[arg-type]
                    "set": lambda: simulator.set(np.eye(4)),  # type: ignore[arg-type]
                    "length": lambda: simulator.render(max_error=np.eye(4)),  # type: ignore[arg-type]
                },
                r"found array\(\[\[",
            )
        with self.assertRaises(pmdsim.InputError) as caught:
            pmdsim.Setup.load("/no/such\nfile.json")
        self.assertEqual(str(caught.exception).count("\n"), 0)

    def test_long_values_are_cut(self) -> None:
        with self.assertRaises(pmdsim.ArgumentError) as caught:
            pmdsim.render(small_setup(), mode="x" * 1000)
        self.assertLess(len(str(caught.exception)), 200)

    def test_numbers_of_very_many_digits(self) -> None:
        huge = 10**5000
        with pmdsim.Simulator(small_setup()) as simulator:
            self.refused(
                {
                    "value": lambda: simulator.set("illuminators/0/intensity_w_sr", huge),
                    "frame": lambda: simulator.render(frame=huge),
                    "max_error": lambda: simulator.render(max_error=huge),
                    "max_amplitude_error": lambda: simulator.render(max_amplitude_error=huge),
                    "pose": lambda: simulator.move(sensor=0, pose=([huge, 0, 0], [0, 0, 0, 1])),
                },
                "expected .* found",
            )


if __name__ == "__main__":
    unittest.main()
