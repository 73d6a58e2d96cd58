"""The page of a run, made in Python."""

from __future__ import annotations

import json
import tempfile
import unittest
from pathlib import Path

import pmdsim
from setups import small_setup, write_by_program


class ReportTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="pmdsim_report.")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        setup = self.folder / "setup.json"
        setup.write_text(json.dumps(small_setup()))
        self.out = self.folder / "out"
        write_by_program(setup, self.out, "--format", "exr", "--report")

    def test_the_page_is_that_of_the_program(self) -> None:
        page = self.out / "report.html"
        of_program = page.read_bytes()
        page.unlink()
        self.assertEqual(pmdsim.report(self.out), page)
        self.assertEqual(page.read_bytes(), of_program)
        self.assertEqual(pmdsim.report(self.out, self.folder / "third.html", max_size=1), self.folder / "third.html")

    def test_what_is_wrong_is_told(self) -> None:
        with self.assertRaisesRegex(pmdsim.InputError, "manifest.json: no such file"):
            pmdsim.report(self.folder)
        with self.assertRaisesRegex(pmdsim.OutputError, "nowhere"):
            pmdsim.report(self.out, self.folder / "nowhere" / "page.html")
        for size in (0.5, 1001, float("nan"), "ten", True):
            with self.assertRaisesRegex(pmdsim.ArgumentError, "max_size: expected a number of MiB"):
                pmdsim.report(self.out, max_size=size)  # type: ignore[arg-type]
        with self.assertRaisesRegex(pmdsim.ArgumentError, "directory: expected a path"):
            pmdsim.report(7)  # type: ignore[arg-type]


if __name__ == "__main__":
    unittest.main()
