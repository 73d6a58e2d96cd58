"""The examples run, do what they promise, and go on where they were stopped."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

import numpy as np

examples = Path(__file__).resolve().parents[2] / "host" / "python" / "examples"


def run(name: str, *arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "error", str(examples / name), *arguments], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def refused(name: str, *arguments: str) -> str:
    """What it says where it ends with exit code 2."""
    done = subprocess.run([sys.executable, str(examples / name), *arguments], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, ""), done
    return done.stderr


class Examples(unittest.TestCase):
    def test_calibrate_wiggling(self) -> None:
        output = run("calibrate_wiggling.py")
        before, after = (float(n) for n in re.findall(r"(\d+\.\d+) mm rms", output))
        self.assertIn("order 4", output)
        self.assertLess(after, before / 50, output)

    def test_choose_diode_layout(self) -> None:
        output = run("choose_diode_layout.py", "--diodes", "16")
        start, best = (float(n) for n in re.findall(r"uneven by (\d+\.\d+) %", output))
        self.assertLess(best, start, output)

    def test_random_views(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            views = Path(folder)
            run("random_views.py", "-o", folder, "--count", "5", "--binning", "16", "--part", "0/2")
            names = ["parameters.json", "view_000000.npz", "view_000002.npz", "view_000004.npz"]
            self.assertEqual(sorted(file.name for file in views.iterdir()), names)
            times = {file: file.stat().st_mtime_ns for file in views.iterdir()}
            self.assertIn(
                "3 of them are there", run("random_views.py", "-o", folder, "--count", "5", "--binning", "16")
            )
            self.assertEqual(len(list(views.iterdir())), 6)
            for file, when in times.items():
                self.assertEqual(file.stat().st_mtime_ns, when)
            with np.load(views / "view_000003.npz") as view:
                noise_m = view["noisy_distance_m"] - view["clean_distance_m"]
                self.assertEqual(noise_m.shape, (26, 32))
                self.assertLess(np.nanmedian(np.abs(noise_m)), 0.1)
                self.assertGreater(np.nanmedian(np.abs(noise_m)), 0)
                kept = view["noisy_distance_m"].tobytes()
            (views / "view_000003.npz").unlink()
            run("random_views.py", "-o", folder, "--count", "5", "--binning", "16")
            with np.load(views / "view_000003.npz") as view:
                self.assertEqual(view["noisy_distance_m"].tobytes(), kept)
            for arguments in (["--seed", "1", "--binning", "16"], ["--binning", "8"]):
                errors = refused("random_views.py", "-o", folder, "--count", "5", *arguments)
                self.assertRegex(errors, f"^random_views.py: {folder}: .* other parameters: .*\n$")
            (views / "parameters.json").unlink()
            self.assertIn("unknown", refused("random_views.py", "-o", folder, "--count", "5", "--binning", "16"))

    def test_training_pairs_of_the_documents(self) -> None:
        page = (examples.parents[2] / "docs" / "howto.md").read_text()
        block = page.split("## Make noisy and clean pairs for training\n\n")[1].split("\n\n- ")[0]
        program = textwrap.dedent(block).replace("count = 100", "count = 3")
        program = program.replace("simulator.set({", 'simulator.set({"sensors/0/resolution": [80, 60], ')
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(
                [os.environ["PMDSIM_PROGRAM"], "new", "room", "room"], cwd=folder, check=True, capture_output=True
            )
            subprocess.run([sys.executable, "-W", "error", "-c", program], cwd=folder, check=True)
            noises = []
            for number in range(3):
                with np.load(Path(folder) / f"pair_{number:04}.npz") as pair:
                    self.assertEqual(pair["noisy"].shape, (60, 80))
                    noises.append(pair["noisy"] - pair["clean"])
        for one, other in itertools.combinations(noises, 2):
            signs = np.sign(one * other)[np.isfinite(one * other)]
            self.assertLess(abs(signs.mean()), 0.2)  # the same noise: 1

    def test_wrong_arguments_of_random_views(self) -> None:
        for arguments in (["--binning", "0"], ["--seed", "-1"], ["--count", "x"], ["-o", __file__]):
            with self.subTest(arguments):
                errors = refused("random_views.py", *arguments)
                self.assertIn(f"random_views.py: {__file__ if '-o' in arguments else 'error: argument'}", errors)
                self.assertNotIn("Traceback", errors)


if __name__ == "__main__":
    unittest.main()
