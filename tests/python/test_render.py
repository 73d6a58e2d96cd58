"""One call: frames, their channels, points, copies."""

from __future__ import annotations

import base64
import copy
import gc
import inspect
import json
import os
import pickle
import sys
import tempfile
import types
import unittest
import warnings
from pathlib import Path

import numpy as np

import pmdsim
from setups import python, same_bytes, scenes, small_setup, without_scene, wall, write_by_program

two_frequencies = {
    "sensors": [
        {**small_setup()["sensors"][0], "modulation_hz": [20e6, 60e6], "unwrap_range_m": 5, "waveform": "square"}
    ]
}


class Render(unittest.TestCase):
    def test_a_wall_at_2_m(self) -> None:
        frame = pmdsim.render(small_setup())
        self.assertEqual(frame.shape, (6, 8))
        self.assertEqual(frame.distance_m.dtype, np.float32)
        self.assertEqual(frame.triangle_id.dtype, np.uint32)
        self.assertEqual(frame.units["distance_m"], "m")
        self.assertEqual(frame.units["triangle_id"], "")
        self.assertLess(np.nanmax(np.abs(frame.range_m - 2.0)), 0.1)
        self.assertEqual((frame.sensor, frame.frame, frame.time_s), ("pmd", 0, 0.0))
        self.assertEqual(frame.report["mode"], "exact")
        self.assertIs(frame.distance_m, frame["distance_m"])
        self.assertIn("distance_m", frame)
        self.assertEqual(list(frame), list(frame.channels))
        self.assertEqual(dict(frame.items())["z_m"].shape, (6, 8))

    def test_the_same_bytes_as_the_program(self) -> None:
        variants = {
            "sine": {},
            "several": two_frequencies,
            "shadowless": {"shadows": "off", "backscatter": "constant"},
        }
        for name, changes in variants.items():
            for options, arguments in (
                ({}, []),
                ({"max_error": "10um"}, ["--max-error", "10um"]),
                ({"samples": 3}, ["--samples", "3"]),
            ):
                with self.subTest(name, **options), tempfile.TemporaryDirectory() as folder:
                    setup = Path(folder) / "setup.json"
                    setup.write_text(json.dumps(small_setup(**changes)))
                    write_by_program(setup, Path(folder) / "out", "--format", "npy", *arguments)
                    frame = pmdsim.render(setup, **options)
                    same_bytes(frame, list((Path(folder) / "out").glob("*.npy")), "pmd_0000.")

    def test_the_reference_too(self) -> None:
        frame = pmdsim.render(small_setup(), device="reference")
        self.assertLess(np.nanmax(np.abs(frame.distance_m - pmdsim.render(small_setup()).distance_m)), 1e-6)

    def test_a_device_by_its_kind(self) -> None:
        kinds = [device["kind"] for device in pmdsim.devices()]
        self.assertIn("CPU", kinds)
        with pmdsim.Simulator(device="cpu") as simulator:
            self.assertTrue(simulator.device)

    def test_points(self) -> None:
        frame = pmdsim.render(small_setup())
        self.assertEqual(frame.directions.shape, (6, 8, 3))
        np.testing.assert_allclose(np.linalg.norm(frame.directions, axis=-1), 1.0)
        truth = frame.points_of("range_m")
        np.testing.assert_allclose(truth[..., 2], np.where(np.isnan(frame.range_m), np.nan, -2.0), atol=1e-6)
        self.assertGreater(truth[0, 0, 1], truth[-1, 0, 1])  # row 0 is at the top
        self.assertLess(truth[0, 0, 0], truth[0, -1, 0])
        self.assertEqual(frame.points_m.shape, (6, 8, 3))
        np.testing.assert_array_equal(np.isnan(frame.points_m[..., 0]), np.isnan(frame.distance_m))

    def test_points_of_a_camera_that_is_moved(self) -> None:
        pose = {"position_m": [0.1, 0.2, 0.5], "look_at_m": [0.1, 0.2, -2]}
        frame = pmdsim.render(small_setup(), set={"sensors/pmd/pose": pose})
        np.testing.assert_allclose(np.nanmean(frame.points_of("range_m")[..., 2]), -2.0, atol=1e-6)

    def test_channels_of_several_frequencies(self) -> None:
        frame = pmdsim.render(small_setup(**two_frequencies))
        self.assertIs(frame.f1.distance_m, frame["f1.distance_m"])
        self.assertIn("tap0", frame.f0.channels)
        self.assertIn("distance_m", dir(frame.f0))
        with self.assertRaisesRegex(pmdsim.UnknownChannelError, "f0.distance_m or f1.distance_m"):
            frame.distance_m
        with self.assertRaisesRegex(AttributeError, "f0.distance_m or f1.distance_m"):
            frame.distance_m
        self.assertFalse(hasattr(frame, "f2"))
        without = {"sensors": [dict(two_frequencies["sensors"][0])]}
        del without["sensors"][0]["unwrap_range_m"]
        with self.assertRaisesRegex(pmdsim.ArgumentError, r"points_m: the frame has f0.distance_m, f1.distance_m; "):
            pmdsim.render(small_setup(**without)).points_m
        with self.assertRaisesRegex(pmdsim.ArgumentError, "points_m: the frame has no distance_m; "):
            pmdsim.render(small_setup(), channels="range_m").points_m
        np.testing.assert_array_equal(frame.points_m, frame.points_of("unwrapped_distance_m"))

    def test_chosen_channels(self) -> None:
        whole, few = pmdsim.render(small_setup()), pmdsim.render(small_setup(), channels=["distance_m", "range_m"])
        self.assertEqual(set(few.channels), {"distance_m", "range_m"})
        self.assertEqual(few.distance_m.tobytes(), whole.distance_m.tobytes())
        electronics = {"preset": "kinect_v2_like", "integration_time_s": 1e-6, "lens_f_number": 1.4}
        counting = {"sensors": [{**two_frequencies["sensors"][0], "taps": 12, "electronics": electronics}]}
        for changes in ({}, two_frequencies, counting):
            setup = small_setup(**changes)
            names = pmdsim.render(setup).channels
            self.assertEqual(pmdsim.render(setup, channels=names).channels, names)
        self.assertEqual(pmdsim.render(small_setup(), channels="tap2").channels, ("tap0", "tap1", "tap2", "tap3"))

    def test_arrays_are_views_that_outlive_the_frame(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            frame = simulator.render()
            amplitude = frame.amplitude
            before = amplitude.copy()
            self.assertFalse(amplitude.flags.owndata)
            self.assertFalse(amplitude.flags.writeable)
            with self.assertRaises(ValueError):
                amplitude[0, 0] = 1
            row = amplitude[2]
            del frame, amplitude
            gc.collect()
            simulator.set("illuminators/0/intensity_w_sr", 2)
            for _ in range(5):  # their memory is used again, this one's is not
                simulator.render()
                np.testing.assert_array_equal(row, before[2])
        np.testing.assert_array_equal(row, before[2])

    def test_copies_and_pickles(self) -> None:
        frame = pmdsim.render(small_setup())
        distorted = pmdsim.render(small_setup(), set={"sensors/0/distortion": {"model": "brown", "k1": -0.1}})
        for original in (frame, distorted):
            for made in (copy.copy(original), copy.deepcopy(original), pickle.loads(pickle.dumps(original))):
                self.assertEqual(made.channels, original.channels)
                self.assertEqual(made.units, original.units)
                self.assertEqual(made.report, original.report)
                self.assertEqual(made.distance_m.tobytes(), original.distance_m.tobytes())
                self.assertFalse(made.distance_m.flags.writeable)
                self.assertFalse(np.shares_memory(made.distance_m, original.distance_m))
                np.testing.assert_allclose(made.points_m, original.points_m, rtol=0, atol=1e-12)

    def test_save_and_load(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            frame = pmdsim.render(small_setup(), set={"sensors/0/distortion": {"model": "brown", "k1": -0.1}})
            frame.save(f"{folder}/a.npz")
            again = pmdsim.load(f"{folder}/a.npz")
            self.assertEqual(again.channels, frame.channels)
            self.assertEqual(again.units, frame.units)
            self.assertEqual(again.report, json.loads(json.dumps(frame.report)))
            np.testing.assert_array_equal(again.points_m, frame.points_m)
            self.assertEqual(os.listdir(folder), ["a.npz"])

    def test_a_full_disk(self) -> None:
        """Files of 1,000 bytes at most stand for it: one error, and nothing else is printed."""
        with tempfile.TemporaryDirectory() as folder:
            child = python(
                "import resource, sys, pmdsim\n"
                "from setups import small_setup\n"
                "frame = pmdsim.render(small_setup())\n"
                "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
                "try: frame.save(sys.argv[1])\n"
                "except pmdsim.OutputError as error: print(error)\n",
                f"{folder}/a.npz",
            )
            output, errors = child.communicate(timeout=60)
            self.assertEqual((output, errors), (f"{folder}/a.npz: cannot be written: File too large\n", ""))
            self.assertEqual(os.listdir(folder), [])

    def test_xarray(self) -> None:
        """With a module in xarray's place, which notes what it is given."""
        module = types.ModuleType("xarray")
        module.Dataset = lambda variables, coords=None, attrs=None: (variables, coords, attrs)
        before = sys.modules.get("xarray")
        sys.modules["xarray"] = module
        try:
            variables, _, attributes = pmdsim.render(small_setup()).to_xarray()
        finally:
            sys.modules.pop("xarray")
            if before:
                sys.modules["xarray"] = before
        dimensions, array, of_channel = variables["distance_m"]
        self.assertEqual((dimensions, array.shape, of_channel), (("row", "column"), (6, 8), {"units": "m"}))
        self.assertEqual(attributes["sensor"], "pmd")

    def test_repeated_calls_take_what_is_new(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            setup = Path(folder) / "setup.json"
            scene = Path(folder) / "scene.gltf"
            setup.write_text(json.dumps(small_setup(scene="scene.gltf")))
            scene.write_bytes((scenes / "wall_2m.gltf").read_bytes())
            first = pmdsim.render(setup)
            scene.write_bytes((scenes / "wall_0m3.gltf").read_bytes())
            second = pmdsim.render(setup)
        self.assertLess(np.nanmin(second.z_m), 0.31)
        self.assertGreater(np.nanmin(first.z_m), 1.99)

    def test_scene_of_arrays(self) -> None:
        from_argument = pmdsim.render(without_scene(), scene=wall())
        from_setup = pmdsim.render(small_setup(scene=wall()))
        from_both = pmdsim.render(small_setup(), scene=wall())
        np.testing.assert_allclose(from_argument.z_m[from_argument.coverage > 0], 2.0, atol=1e-6)
        self.assertTrue((from_argument.coverage > 0).any())
        for other in (from_setup, from_both):
            self.assertEqual(other.distance_m.tobytes(), from_argument.distance_m.tobytes())

    def test_warnings(self) -> None:
        """Each points at the line that calls, and comes once for a setup."""
        change = {"sensors/0/waveform": {"harmonics": [0, 1]}}
        warning = small_setup()
        warning["sensors"][0]["waveform"] = {"harmonics": [0, 1]}
        with pmdsim.Simulator(small_setup()) as simulator:
            for action in (
                lambda: pmdsim.render(small_setup(), set=change),
                lambda: pmdsim.render(warning),
                lambda: pmdsim.Simulator(warning).close(),
                lambda: simulator.load(warning),
                lambda: (
                    simulator.load(small_setup()),
                    simulator.set(change),
                    simulator.set(change),
                    simulator.render(),
                ),
                lambda: list(pmdsim.sweep(small_setup(), {"sensors/0/waveform": [change["sensors/0/waveform"]]})),
            ):
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always")
                    action()
                self.assertEqual([(w.category, w.filename) for w in caught], [(pmdsim.PmdsimWarning, __file__)])
                told = caught[0].message
                self.assertEqual(told.code, "unseen-harmonics")
                self.assertTrue(told.place.endswith("/sensors/0/waveform"))
                self.assertTrue(str(told).startswith(told.place + ": sensor "))

    def test_warnings_of_frames_come_once_for_a_setup(self) -> None:
        setup = small_setup()
        setup["sensors"][0]["pose"] = {"position_m": [0, 0, 0], "look_at_m": [0, 0, 1]}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            with pmdsim.Simulator(setup) as simulator:
                for _ in range(3):
                    frame = simulator.render()
        self.assertEqual([w.message.code for w in caught], ["nothing-in-view"])
        self.assertEqual((caught[0].message.place, caught[0].filename), ("sensor pmd", __file__))
        self.assertEqual(frame.report["warnings"][0]["code"], "nothing-in-view")
        with self.assertRaisesRegex(pmdsim.InputError, "nothing-in-view"):
            pmdsim.render(setup, strict=True)

    def test_strict_makes_warnings_errors(self) -> None:
        self.assertEqual(pmdsim.render(small_setup(), strict=True).report["warnings"], [])
        setup = small_setup()
        setup["sensors"][0]["waveform"] = {"harmonics": [0, 1]}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", pmdsim.PmdsimWarning)
            with self.assertRaises(pmdsim.InputError) as caught:
                pmdsim.render(setup, strict=True)
        self.assertTrue(str(caught.exception).endswith("[unseen-harmonics]; strict makes warnings errors"))

    def test_a_frame_that_may_be_off_by_more_warns(self) -> None:
        """Light that cancels in some pixels; 0.25 micrometres are close to what rounding leaves."""

        def render(max_error: str, strict: bool = False) -> pmdsim.Frame:
            change = {"sensors/0/resolution": [12, 15]}
            return pmdsim.render(scenes / "analytic" / "cancel.json", max_error=max_error, strict=strict, set=change)

        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            frame = render("0.25um")
        self.assertIn("error_bound_m", frame)
        self.assertEqual([(w.category, w.filename) for w in caught], [(pmdsim.PmdsimWarning, __file__)])
        self.assertEqual([w.message.code for w in caught], [w["code"] for w in frame.report["warnings"]])
        self.assertEqual(caught[0].message.code, "error-above-asked")
        with self.assertRaises(pmdsim.AccuracyError):
            render("0.25um", strict=True)
        with self.assertRaises(pmdsim.AccuracyError):
            render("0.05um")

    def test_distances_in_float64(self) -> None:
        single = pmdsim.render(small_setup())
        double = pmdsim.render(small_setup(), output_precision="float64")
        self.assertEqual(single.channels, double.channels)
        for name in single.channels:
            expected = np.float64 if name in ("distance_m", "range_m") else single[name].dtype
            self.assertEqual(double[name].dtype, expected, name)
            np.testing.assert_array_equal(double[name].astype(single[name].dtype), single[name])
        self.assertTrue(np.any(double.distance_m != single.distance_m))
        with pmdsim.Simulator(small_setup()) as simulator:
            np.testing.assert_array_equal(simulator.render(output_precision="float64").range_m, double.range_m)
            self.assertEqual(simulator.render(output_precision="float32").range_m.dtype, np.float32)
        with self.assertRaisesRegex(pmdsim.ArgumentError, "output_precision: expected float32 or float64"):
            pmdsim.render(small_setup(), output_precision="double")

    def test_a_scene_reads_outside_of_its_folder_only_where_that_is_allowed(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            inside = Path(folder, "inside")
            inside.mkdir()
            gltf = json.loads((scenes / "wall_2m.gltf").read_text())
            data = gltf["buffers"][0]["uri"]
            Path(folder, "wall.bin").write_bytes(base64.b64decode(data.split(",")[1]))
            gltf["buffers"][0]["uri"] = "../wall.bin"
            (inside / "wall.gltf").write_text(json.dumps(gltf))
            setup = small_setup(scene=str(inside / "wall.gltf"))
            with self.assertRaisesRegex(pmdsim.InputError, "lies outside the scene's folder"):
                pmdsim.render(setup)
            allowed = pmdsim.render(setup, allow_outside=True)
            np.testing.assert_array_equal(allowed.distance_m, pmdsim.render(small_setup()).distance_m)
            with self.assertRaisesRegex(pmdsim.InputError, "lies outside the scene's folder"):
                pmdsim.Simulator(setup)
            with pmdsim.Simulator(setup, allow_outside=True) as simulator:
                self.assertEqual(simulator.render().distance_m.shape, (6, 8))

    def test_normals_and_rays(self) -> None:
        with self.assertRaisesRegex(pmdsim.ArgumentError, 'normals: the frame has no normal_x, .*"all,normals"'):
            pmdsim.render(small_setup()).normals
        frame = pmdsim.render(small_setup(), channels="all,normals,rays", output_precision="float64")
        self.assertIn("amplitude", frame)
        self.assertEqual(frame.normals.shape, (6, 8, 3))
        sees = ~np.isnan(frame.range_m)
        np.testing.assert_allclose(frame.normals[sees], np.tile([0.0, 0.0, -1.0], (sees.sum(), 1)), atol=1e-12)
        self.assertTrue(np.isnan(frame.normals[~sees]).all())
        rays = np.stack([frame.ray_x, frame.ray_y, frame.ray_z], axis=-1)
        np.testing.assert_array_equal(rays, frame.directions)
        world = np.array(frame.camera["world_from_camera"])
        points = (frame.range_m[..., np.newaxis] * rays) @ world[:3, :3].T + world[:3, 3]
        np.testing.assert_allclose(points, frame.points_of("range_m"), atol=1e-15)
        np.testing.assert_allclose(points[sees, 2], -2.0, atol=1e-12)

    def test_float64_of_files(self) -> None:
        double = pmdsim.render(small_setup(), output_precision="float64")
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            (place / "setup.json").write_text(json.dumps(small_setup()))
            for kind in ("npy", "npz", "h5", "exr"):
                options = ["--format", kind, "--output-precision", "float64"]
                write_by_program(place / "setup.json", place / kind, *options)
                (frame,) = pmdsim.load(place / kind).frames
                for name in ("distance_m", "range_m"):
                    self.assertEqual(frame[name].dtype, np.float64, f"{name} in {kind}")
                    np.testing.assert_allclose(frame[name], double[name], rtol=2**-48 if kind == "exr" else 0)

    def test_what_there_is(self) -> None:
        self.assertIn("distance_m", [channel["name"] for channel in pmdsim.channels()])
        self.assertIn("sensors", pmdsim.schema()["properties"])
        self.assertEqual(pmdsim.version(), pmdsim.__version__)

    def test_help_suffices(self) -> None:
        for name in pmdsim.__all__:
            self.assertTrue(inspect.getdoc(getattr(pmdsim, name)), name)
        text = inspect.getdoc(pmdsim.render)
        for name in inspect.signature(pmdsim.render).parameters:
            self.assertRegex(text, rf"(?m)^{name} : ", name)
        for name in ("InputError", "metres", "(rows, columns)", "Examples"):
            self.assertIn(name, text)


if __name__ == "__main__":
    unittest.main()
