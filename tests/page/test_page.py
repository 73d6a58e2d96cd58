"""The report of a run in Chromium: it shows what the files have, by mouse and by keys, and asks for nothing."""

from __future__ import annotations

import base64
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from typing import Any, Dict, List, Tuple

import numpy as np
from browser import Browser
from numpy.typing import NDArray

PROGRAM = os.environ["PMDSIM_PROGRAM"]
SCENES = Path(os.environ["PMDSIM_SCENES"])
HOSTILE = "</script><script>window.hacked = 1</script><img src=x onerror='window.hacked = 2'>&\u2028\"'"
NO_ID = 4294967295


def measure(command: str, setup: Path, out: Path, *more: str) -> Path:
    """The run's directory, with NPY beside the page."""
    arguments = [PROGRAM, command, str(setup), "-o", str(out), "--format", "exr,npy", "--report", *more]
    ended = subprocess.run(arguments, capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        raise AssertionError(ended.stderr)
    return out


def channels_of(out: Path, stem: str) -> Dict[str, NDArray[Any]]:
    return {file.name[len(stem) + 1 : -4]: np.load(file) for file in sorted(out.glob(f"{stem}.*.npy"))}


def number_of(text: str) -> float:
    """What a cell of the table says."""
    words = {"no return": np.nan, "nothing hit": np.nan, "no value": np.nan, "infinite": np.inf}
    return float(words.get(text, 0.0)) if text in words else float(text.replace("\u2212", "-"))


class PageTest(unittest.TestCase):
    browser: Browser
    folder: "tempfile.TemporaryDirectory[str]"
    runs: Dict[str, Path]

    @classmethod
    def setUpClass(cls) -> None:
        cls.browser = Browser()
        cls.folder = tempfile.TemporaryDirectory(prefix="pmdsim_page.")
        cls.runs = {}

    @classmethod
    def tearDownClass(cls) -> None:
        cls.browser.close()
        cls.folder.cleanup()

    def out(self, scene: str, command: str = "render", *more: str) -> Path:
        """A run of a shipped scene, measured once."""
        name = f"{scene}_{command}"
        if name not in self.runs:
            self.runs[name] = measure(command, SCENES / f"{scene}.json", Path(self.folder.name) / name, *more)
        return self.runs[name]

    def opened(self, out: Path) -> float:
        seconds = self.browser.open(out / "report.html")
        self.browser.settle()
        return seconds

    def tearDown(self) -> None:
        self.assertEqual(self.browser.console(), [])
        self.assertIsNone(self.browser.run("return window.hacked ?? null"))

    def point_at(self, column: int, row: int) -> None:
        """Moves the mouse to the middle of a pixel."""
        box = self.browser.box_of("picture")
        image = self.browser.run("return report.pictureBox()")
        shape = self.browser.run("return [report.shown.frame.columns, report.shown.frame.rows]")
        x = box["x"] + image["x"] + (column + 0.5) / shape[0] * image["width"]
        y = box["y"] + image["y"] + (row + 0.5) / shape[1] * image["height"]
        self.browser.mouse("mouseMoved", x, y)

    def check_probe(self, channels: Dict[str, NDArray[Any]], column: int, row: int) -> None:
        self.assertEqual(self.browser.text_of("probe-place").split(":")[0], f"column {column}, row {row}")
        table = self.browser.probe()
        self.assertEqual(set(table), set(channels))
        for name, values in channels.items():
            expected = values[row, column]
            with self.subTest(channel=name, column=column, row=row):
                if expected == NO_ID:
                    self.assertEqual(table[name], "nothing hit")
                elif name.endswith("saturated"):
                    self.assertEqual(table[name] == "none", expected == 0)
                else:
                    found = number_of(table[name].split(" (")[0])
                    np.testing.assert_allclose(found, float(expected), rtol=1e-6)

    def check_bits(self, channels: Dict[str, NDArray[Any]]) -> None:
        for name, values in channels.items():
            pixels: List[int] = np.random.default_rng(5).integers(0, values.size, 200).tolist()
            expected = values.ravel().view(np.uint32)[pixels]
            np.testing.assert_array_equal(self.browser.bits_of(name, pixels), expected, err_msg=name)

    def test_frame_of_640_x_640_pixels(self) -> None:
        out = self.out("room")
        seconds = self.opened(out)
        print(f"\na page of {(out / 'report.html').stat().st_size / 2**20:.1f} MiB was there after {seconds:.1f} s")
        channels = channels_of(out, "pmd_0000")
        self.check_bits(channels)
        for column, row in ((0, 0), (639, 639), (320, 320), (17, 600), (450, 401)):
            self.point_at(column, row)
            self.check_probe(channels, column, row)

    def test_nothing_is_asked_for(self) -> None:
        out = self.out("corner")
        self.opened(out)
        for channel in ("distance_m", "phase_rad", "object_id"):
            self.browser.choose("channel", channel)
        asked = [url for url in self.browser.requests() if not url.startswith(("data:", "blob:"))]
        self.assertEqual(set(asked), {(out / "report.html").as_uri()})

    def test_keys_move_the_pixel(self) -> None:
        out = self.out("corner")
        self.opened(out)
        channels = channels_of(out, "pmd_0000")
        rows, columns = channels["distance_m"].shape
        self.browser.press("picture", "Home")
        column, row = columns // 2, rows // 2
        self.check_probe(channels, column, row)
        for key, modifiers, right, down in (
            ("ArrowRight", 0, 1, 0),
            ("ArrowDown", 0, 0, 1),
            ("ArrowLeft", 8, -10, 0),
            ("ArrowUp", 8, 0, -10),
        ):
            before = self.browser.pixels_of("picture")
            self.browser.press("picture", key, modifiers)
            column, row = column + right, row + down
            self.check_probe(channels, column, row)
            self.assertNotEqual(self.browser.pixels_of("picture"), before)

    def test_a_click_holds_the_pixel(self) -> None:
        self.opened(self.out("corner"))
        self.point_at(20, 30)
        box, image = self.browser.box_of("picture"), self.browser.run("return report.pictureBox()")
        at = (box["x"] + image["x"] + 0.25 * image["width"], box["y"] + image["y"] + 0.25 * image["height"])
        for kind, buttons in (("mousePressed", 1), ("mouseReleased", 1)):
            event = {"type": kind, "x": at[0], "y": at[1], "button": "left", "buttons": buttons, "clickCount": 1}
            self.browser.command("Input.dispatchMouseEvent", event)
        self.browser.drawn()
        held = self.browser.text_of("probe-place")
        self.assertTrue(held.endswith("(held)"), held)
        self.point_at(100, 100)
        self.assertEqual(self.browser.text_of("probe-place"), held)

    def test_the_slider_shows_other_frames(self) -> None:
        out = self.out("motion")
        self.opened(out)
        pictures = set()
        for frame in (0, 7, 19):
            slide = "const f = document.getElementById('frame'); f.value = arguments[0];"
            self.browser.run(slide + "f.dispatchEvent(new Event('input'))", frame)
            self.browser.settle()
            channels = channels_of(out, f"pmd_{frame:04}")
            self.check_bits(channels)
            self.point_at(80, 60)
            self.check_probe(channels, 80, 60)
            pictures.add(self.browser.pixels_of("picture"))
            self.assertIn(f"frame {frame}", self.browser.text_of("picture-title"))
        self.assertEqual(len(pictures), 3)

    def test_colours_are_alike_in_all_frames_if_so_wished(self) -> None:
        self.opened(self.out("motion"))
        slide = "const f = document.getElementById('frame'); f.value = arguments[0];"
        ends: Dict[Tuple[bool, int], List[float]] = {}
        for same in (True, False):
            self.browser.run(
                "document.getElementById('same').checked !== arguments[0] && document.getElementById('same').click()",
                same,
            )
            for frame in (0, 12):
                self.browser.run(slide + "f.dispatchEvent(new Event('input'))", frame)
                self.browser.settle()
                ends[same, frame] = self.browser.run("return report.shown.ends")
        self.assertEqual(ends[True, 0], ends[True, 12])
        self.assertNotEqual(ends[False, 0], ends[False, 12])

    def test_every_channel_has_a_picture_and_a_histogram(self) -> None:
        for scene, command in (("corner", "render"), ("paper_ring", "deform")):
            self.opened(self.out(scene, command))
            options = self.browser.run("return [...document.getElementById('channel').options].map(o => o.value)")
            self.assertGreater(len(options), 9)
            for channel in options:
                self.browser.choose("channel", channel)
                with self.subTest(scene=scene, channel=channel):
                    self.assertEqual(self.browser.run("return report.shown.channel.quantity"), channel)
                    count = "return new Set(new Uint32Array(report.shown.pixels)).size"
                    self.assertGreaterEqual(self.browser.run(count), 1)
                    self.assertNotEqual(self.browser.text_of("statistics"), "")

    def test_points_turn_and_are_where_the_camera_sees_them(self) -> None:
        out = self.out("room")
        self.opened(out)
        self.browser.box_of("cloud")
        before = self.browser.pixels_of("cloud")
        self.browser.press("cloud", "ArrowLeft")
        turned = self.browser.pixels_of("cloud")
        self.assertNotEqual(turned, before)
        self.browser.press("cloud", "+")
        self.assertNotEqual(self.browser.pixels_of("cloud"), turned)
        box = self.browser.box_of("cloud")
        middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        before = self.browser.pixels_of("cloud")
        self.browser.mouse("mousePressed", *middle, buttons=1)
        self.browser.mouse("mouseMoved", middle[0] + 60, middle[1] + 20, buttons=1)
        self.browser.mouse("mouseReleased", middle[0] + 60, middle[1] + 20, buttons=1)
        self.assertNotEqual(self.browser.pixels_of("cloud"), before)
        self.check_points(out, "pmd_0000", "distance_m")

    def check_points(self, out: Path, stem: str, channel: str) -> None:
        """By the manifest's steps from distances to points, for a camera without distortion."""
        camera = json.loads((out / "manifest.json").read_text())["frames"][0]["camera"]
        distances = np.load(out / f"{stem}.{channel}.npy").astype(float)
        rows, columns = distances.shape
        pixels = np.random.default_rng(7).integers(0, distances.size, 100)
        found = self.browser.run(
            "return arguments[0].map(i => [0, 1, 2].map(k => report.cloud.points[3 * i + k]))", pixels.tolist()
        )
        xy = np.stack([pixels % columns, pixels // columns, np.ones_like(pixels)])
        rays = np.linalg.solve(np.array(camera["camera_matrix"]), xy.astype(float))
        points = distances.ravel()[pixels] * rays / np.linalg.norm(rays, axis=0)
        world = np.array(camera["world_from_camera"]) @ np.vstack([points, np.ones_like(points[0])])
        np.testing.assert_allclose(np.array(found, dtype=float), world[:3].T, rtol=1e-5, atol=1e-5)

    def test_rays_through_lenses_with_distortion(self) -> None:
        """Depth over distance is the cosine of the ray's angle: both are ground truth of the pixel's one sample."""
        for distortion in (
            {"model": "brown", "k1": -0.2, "k2": 0.05, "p1": 0.01, "p2": -0.02, "k3": 0.01},
            {"model": "fisheye", "k1": 0.05, "k2": -0.01, "k3": 0.002, "k4": 0.001},
        ):
            with self.subTest(model=distortion["model"]):
                setup = json.loads(re.sub(r"^\s*//.*$", "", (SCENES / "room.json").read_text(), flags=re.M))
                setup["scene"] = str(SCENES / "room.glb")
                sensor = setup["sensors"][0]
                sensor.update(distortion=distortion, samples=1, resolution=[160, 160])
                sensor["pixel_pitch_m"] = [4 * pitch for pitch in sensor["pixel_pitch_m"]]
                sensor["chip"] = {"rotation_deg": [3, -4, 20], "translation_m": [0, 0, 0]}
                if distortion["model"] == "fisheye":
                    del sensor["chip"]
                folder = Path(self.folder.name) / str(distortion["model"])
                folder.mkdir()
                (folder / "setup.json").write_text(json.dumps(setup))
                out = measure("render", folder / "setup.json", folder / "out")
                self.opened(out)
                depth, distance = (np.load(out / f"pmd_0000.{name}.npy").astype(float) for name in ("z_m", "range_m"))
                self.browser.choose("cloud-distance", "range_m")
                points = np.array(self.browser.run("return [...report.cloud.points]"), dtype=float).reshape(-1, 3)
                camera = json.loads((out / "manifest.json").read_text())["frames"][0]["camera"]
                pose = np.array(camera["world_from_camera"])
                found = (points - pose[:3, 3]) @ pose[:3, 2]
                hit = np.isfinite(depth.ravel())
                self.assertGreater(hit.sum(), 1000)
                np.testing.assert_allclose(found[hit], depth.ravel()[hit], rtol=2e-5)
                np.testing.assert_allclose(
                    np.linalg.norm(points - pose[:3, 3], axis=1)[hit], distance.ravel()[hit], rtol=1e-5
                )

    def test_it_prints(self) -> None:
        self.opened(self.out("corner"))
        pdf = base64.b64decode(self.browser.command("Page.printToPDF", {"printBackground": True})["data"])
        self.assertTrue(pdf.startswith(b"%PDF"))
        self.assertGreater(len(pdf), 50_000)

    def test_names_of_a_setup_do_no_harm(self) -> None:
        out = self.out("corner")
        manifest = json.loads((out / "manifest.json").read_text())
        manifest["setup"]["sensors"][0]["pose"] = {"node": HOSTILE}
        manifest["warnings"] = [{"code": HOSTILE, "place": HOSTILE, "text": HOSTILE}]
        manifest["objects"] = [HOSTILE, "left wall"]
        manifest["device"] = HOSTILE
        manifest["frames"][0]["sensor"] = HOSTILE
        folder = Path(self.folder.name) / "hostile"
        folder.mkdir()
        (folder / "manifest.json").write_text(json.dumps(manifest))
        os.link(out / "pmd_0000.exr", folder / "pmd_0000.exr")
        subprocess.run([PROGRAM, "report", str(folder)], check=True, capture_output=True)
        self.opened(folder)
        self.browser.run("document.querySelectorAll('details').forEach(each => { each.open = true; })")
        self.browser.drawn()
        for element in ("warnings", "setup", "objects", "facts", "picture-title"):
            self.assertIn("window.hacked = 1", self.browser.text_of(element))
        self.assertEqual(self.browser.run("return document.images.length"), 0)
        self.browser.choose("channel", "object_id")
        self.assertIn("left wall", self.browser.text_of("objects"))

    def test_a_manifest_that_lacks_things(self) -> None:
        """Anyone may have edited it: the pictures are there all the same."""
        out = self.out("corner")
        entry = {"sensor": "pmd", "frame": 0, "outputs": ["pmd_0000.exr"]}
        odd = {"camera": {"camera_matrix": 3}, "modulation_hz": 5, "warnings": 3, "ambiguity_m": {}, "bounces": 2}
        for name, manifest in (
            ("bare", {"frames": [entry]}),
            ("odd", {"frames": [{**entry, **odd}], "warnings": "x", "objects": {"1": 7}, "inputs": 5, "setup": 3}),
        ):
            with self.subTest(manifest=name):
                folder = Path(self.folder.name) / name
                folder.mkdir()
                (folder / "manifest.json").write_text(json.dumps(manifest))
                os.link(out / "pmd_0000.exr", folder / "pmd_0000.exr")
                subprocess.run([PROGRAM, "report", str(folder)], check=True, capture_output=True)
                self.opened(folder)
                self.check_bits(channels_of(out, "pmd_0000"))
                self.point_at(12, 34)
                self.check_probe(channels_of(out, "pmd_0000"), 12, 34)
                self.assertEqual(self.browser.console(), [])

    def test_several_sensors_and_frequencies(self) -> None:
        setup = json.loads(re.sub(r"^\s*//.*$", "", (SCENES / "corner.json").read_text(), flags=re.M))
        setup["scene"] = str(SCENES / "corner.gltf")
        first = setup["sensors"][0]
        setup["sensors"].append({**first, "name": "second", "modulation_hz": [20e6, 50e6], "resolution": [80, 60]})
        folder = Path(self.folder.name) / "several"
        folder.mkdir()
        (folder / "setup.json").write_text(json.dumps(setup))
        out = measure("render", folder / "setup.json", folder / "out")
        self.opened(out)
        self.assertTrue(self.browser.run("return document.getElementById('frequency-chooser').hidden"))
        self.browser.choose("sensor", "1")
        self.assertFalse(self.browser.run("return document.getElementById('frequency-chooser').hidden"))
        channels = channels_of(out, "second_0000")
        self.check_bits(channels)
        self.browser.choose("frequency", "1")
        self.assertEqual(self.browser.run("return report.shown.channel.name"), "f1.multipath_m")
        self.point_at(11, 50)
        self.check_probe(channels, 11, 50)

    def test_everything_has_a_name_and_can_be_reached_by_keys(self) -> None:
        self.opened(self.out("motion"))
        nameless = self.browser.run(
            "return [...document.querySelectorAll('canvas, select, button, input, table, section')].filter("
            "e => !e.closest('[hidden]')).filter(e => !(e.ariaLabel || e.getAttribute('aria-labelledby') || e.labels?.length"
            " || e.textContent.trim())).map(e => e.outerHTML)"
        )
        self.assertEqual(nameless, [])
        reached = set()
        self.browser.run("document.activeElement.blur()")
        for _ in range(60):
            for kind in ("keyDown", "keyUp"):
                tab = {"type": kind, "key": "Tab", "code": "Tab", "windowsVirtualKeyCode": 9}
                self.browser.command("Input.dispatchKeyEvent", tab)
            reached.add(self.browser.run("return document.activeElement.id"))
        self.assertLessEqual(
            {"channel", "play", "frame", "range", "same", "picture", "cloud", "cloud-distance"}, reached
        )


if __name__ == "__main__":
    unittest.main()
