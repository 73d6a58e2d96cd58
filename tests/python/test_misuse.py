"""Ways to use it wrongly: each is an exception of a named class, and none a crash."""

from __future__ import annotations

import ctypes
import os
import pickle
import subprocess
import sys
import tempfile
import unittest
from typing import Any, Callable, Type

import numpy as np

import pmdsim
from pmdsim import _library
from setups import python, small_setup, wall, without_scene

triangle = [[0, 0, -2], [1, 0, -2], [0, 1, -2]]


class Misuse(unittest.TestCase):
    def refused(self, error: Type[Exception], text: str, wrong: Callable[[], Any]) -> Any:
        with self.subTest(text), self.assertRaisesRegex(error, text) as caught:
            wrong()
        return getattr(caught, "exception", None)

    def test_arguments_of_render(self) -> None:
        def render(**options: Any) -> Callable[[], Any]:
            return lambda: pmdsim.render(small_setup(), **options)

        for text, options in {
            "sensor: expected a whole number from 0": dict(sensor=-1),
            "sensor: expected a whole number": dict(sensor=0.5),
            "sensor: expected one of pmd": dict(sensor="none"),
            "sensor below 1": dict(sensor=1),
            "frame: expected a whole number": dict(frame=-1),
            "frame: expected a whole number from 0 to 4294967295": dict(frame=2**32),
            "frame below 1": dict(frame=1),
            "mode: expected exact": dict(mode="best"),
            "max_error: expected metres": dict(max_error="10 furlongs"),
            "max_error: .* found nan": dict(max_error=float("nan")),
            "max_error: .* found -1": dict(max_error=-1),
            "max_error: .* found 'nanm'": dict(max_error="nanm"),
            "max_error: .* found True": dict(max_error=True),
            "max_amplitude_error: .* found 2": dict(max_amplitude_error=2),
            "max_amplitude_error: .* found 'x'": dict(max_amplitude_error="x"),
            "exact keeps no bound": dict(mode="exact", max_error="1mm"),
            "precision: expected fp32 or fp64": dict(precision="fp16"),
            "samples: expected a whole number from 1 to 16": dict(samples=0),
            "samples: .* found 17": dict(samples=17),
            "samples: .* found 'many'": dict(samples="many"),
            "paths": dict(paths=-5),
            "paths: expected 0, or 16": dict(paths=100),
            "channels: expected names": dict(channels=[]),
            "channels: .* found \\[3\\]": dict(channels=[3]),
            "channels: .* found 5": dict(channels=5),
            r"set: expected .* a dict of paths and values, found \[1\]": dict(set=[1]),
            "device: expected a whole number": dict(device=-1),
        }.items():
            self.refused(pmdsim.ArgumentError, text, render(**options))
        self.refused(TypeError, "colour", render(colour=1))
        self.refused(pmdsim.NoDeviceError, "no such thing", render(device="no such thing"))
        self.refused(pmdsim.NoDeviceError, "99", render(device=99))
        self.refused(ValueError, "mode", render(mode=3))

    def test_setups(self) -> None:
        endless = small_setup()
        endless["nodes"] = endless
        for text, setup in {
            "expected a path, a dict or a pmdsim.Setup": 3,
            "found b'x'": b"x",
            "/sensors/0/focal_length_m: expected a finite number, found nan": small_setup(
                sensors=[{**small_setup()["sensors"][0], "focal_length_m": float("nan")}]
            ),
            "/bounces: expected numbers, text": small_setup(bounces=object()),
            "expected a key that is text": small_setup(nodes={1: 2}),
            "/sensors: expected numbers, text, .* found {": small_setup(sensors={1, 2}),
            "setup: .* a value that contains itself": endless,
        }.items():
            self.refused(pmdsim.ArgumentError, text, lambda: pmdsim.render(setup))
        error = self.refused(pmdsim.InputError, "focal_lenth_m", lambda: pmdsim.render(small_setup(focal_lenth_m=1)))
        self.assertIn(error.place, ("", "/focal_lenth_m"))
        wrong = small_setup()
        wrong["sensors"][0]["resolution"] = [-8, 6]
        error = self.refused(pmdsim.InputError, "resolution", lambda: pmdsim.render(wrong))
        self.assertEqual(error.place, "/sensors/0/resolution/0")
        self.assertEqual(error.code, 3)
        error = self.refused(pmdsim.InputError, "none.json", lambda: pmdsim.render("/none.json"))
        self.assertEqual(error.file, "/none.json")
        self.refused(pmdsim.InputError, "none.gltf", lambda: pmdsim.render(small_setup(scene="none.gltf")))
        self.refused(pmdsim.InputError, 'missing key "scene"', lambda: pmdsim.render({}))
        with tempfile.TemporaryDirectory() as folder:
            file = f"{folder}/setup.json"
            with open(file, "w") as out:
                out.write('{"scene": "a.gltf", "sensors": 3}')
            error = self.refused(pmdsim.InputError, "setup.json", lambda: pmdsim.render(file))
            self.assertEqual(error.file, file)
            self.assertTrue(error.place)

    def test_changes(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            for error, text, change in (
                (pmdsim.InputError, "focal_lenth_m", {"sensors/0/focal_lenth_m": 1}),
                (pmdsim.InputError, "7", {"sensors/7/focal_length_m": 1}),
                (pmdsim.InputError, "nobody", {"sensors/nobody/focal_length_m": 1}),
                (pmdsim.InputError, "count", {"illuminators/0/diodes/rings/0/count": -4}),
                (pmdsim.ArgumentError, "finite number, found inf", {"illuminators/0/intensity_w_sr": np.inf}),
                (pmdsim.ArgumentError, "expected paths", {0: 1}),
                (pmdsim.ArgumentError, "expected numbers, text", {"illuminators/0/intensity_w_sr": 1j}),
            ):
                self.refused(error, text, lambda: simulator.set(change))
            self.refused(pmdsim.ArgumentError, "a dict of them alone", lambda: simulator.set({}, 3))
            self.assertEqual(simulator.render().shape, (6, 8))

    def test_poses(self) -> None:
        nan = np.eye(4)
        nan[0, 3] = np.nan
        with pmdsim.Simulator(small_setup()) as simulator:
            for error, text, pose in (
                (pmdsim.ArgumentError, r"expected a 4 x 4 matrix.*\(3, 3\)", np.eye(3)),
                (pmdsim.ArgumentError, "finite", nan),
                (pmdsim.ArgumentError, "length 0", ([0, 0, 0], [0, 0, 0, 0])),
                (pmdsim.ArgumentError, "a position of 3 and a quaternion of 4", ([0, 0], [0, 0, 0, 1])),
                (pmdsim.ArgumentError, "expected numbers", "north"),
                (pmdsim.InputError, "", 2 * np.eye(4)),
                (pmdsim.InputError, "", {"position_m": [0, 0, 0]}),
            ):
                self.refused(error, text, lambda: simulator.move(sensor=0, pose=pose))
            self.refused(pmdsim.ArgumentError, "one of node", lambda: simulator.move(pose=np.eye(4)))
            self.refused(
                pmdsim.ArgumentError, "one of node", lambda: simulator.move(node="a", sensor=0, pose=np.eye(4))
            )
            self.refused(pmdsim.InputError, "nobody", lambda: simulator.move(node="nobody", pose=np.eye(4)))
            self.refused(pmdsim.InputError, "a/b~c", lambda: simulator.move(node="a/b~c", pose=np.eye(4)))
            self.refused(pmdsim.ArgumentError, "node: .* found 3", lambda: simulator.move(node=3, pose=np.eye(4)))
            for part in ("sensor", "illuminator"):
                self.refused(
                    pmdsim.ArgumentError, f"{part}: .*'1'", lambda: simulator.move(**{part: "1"}, pose=np.eye(4))
                )
                self.refused(pmdsim.InputError, "7", lambda: simulator.move(**{part: 7}, pose=np.eye(4)))

    def test_scenes(self) -> None:
        for text, wrong in {
            r"vertices: expected the shape \(n, 3\), found \(2, 2\)": lambda: pmdsim.Scene(
                [[0, 0], [1, 1]], [[0, 1, 1]]
            ),
            r"vertices: expected the shape \(n, 3\), found \(0": lambda: pmdsim.Scene(np.zeros((0, 3)), [[0, 1, 2]]),
            r"vertices: .* rows of one length, found \[\[1, 2, 3\], \[1\]\]": lambda: pmdsim.Scene(
                [[1, 2, 3], [1]], [[0, 1, 2]]
            ),
            "triangles: .* rows of one length": lambda: pmdsim.Scene(triangle, [[0, 1, 2], [0]]),
            "vertices: expected real numbers": lambda: pmdsim.Scene([["a", "b", "c"]], [[0, 0, 0]]),
            "vertices: expected real numbers, found the type complex": lambda: pmdsim.Scene([[1j, 0, 0]], [[0, 0, 0]]),
            r"vertices\[1, 2\]: .* found nan": lambda: pmdsim.Scene([[0, 0, 0], [0, 0, np.nan]], [[0, 1, 1]]),
            r"vertices\[0, 0\]: .* found 2000000000": lambda: pmdsim.Scene([[2e9, 0, 0]], [[0, 0, 0]]),
            r"triangles: expected the shape \(m, 3\), found \(3,\)": lambda: pmdsim.Scene(triangle, [0, 1, 2]),
            "triangles: expected whole numbers, found the type float64": lambda: pmdsim.Scene(triangle, [[0, 1, 2.0]]),
            r"triangles\[0, 2\]: expected 0 to 2, .* found 3": lambda: pmdsim.Scene(triangle, [[0, 1, 3]]),
            r"triangles\[0, 0\]: .* found -1": lambda: pmdsim.Scene(triangle, [[-1, 1, 2]]),
            "triangles: expected at least one": lambda: pmdsim.Scene(triangle, np.zeros((0, 3), dtype=int)),
            r"reflectivity\[0\]: expected 0 to 1, found 1.5": lambda: pmdsim.Scene(
                triangle, [[0, 1, 2]], reflectivity=[1.5]
            ),
            "reflectivity.*found nan": lambda: pmdsim.Scene(triangle, [[0, 1, 2]], reflectivity=np.nan),
            r"reflectivity: expected a number or the shape \(1,\)": lambda: pmdsim.Scene(
                triangle, [[0, 1, 2]], reflectivity=[1, 1]
            ),
            r"object_ids\[0\]: expected 0 to 0": lambda: pmdsim.Scene(triangle, [[0, 1, 2]], object_ids=[1]),
            "object_ids: expected whole numbers": lambda: pmdsim.Scene(triangle, [[0, 1, 2]], object_ids=["a"]),
            r"object_ids: expected the shape \(1,\)": lambda: pmdsim.Scene(triangle, [[0, 1, 2]], object_ids=[0, 0]),
            "scene: expected a pmdsim.Scene": lambda: pmdsim.render(without_scene(), scene=triangle),  # type: ignore
            "scene: expected a setup": lambda: pmdsim.Simulator(scene=wall()),
        }.items():
            self.refused(pmdsim.ArgumentError, text, wrong)
        self.refused(
            pmdsim.InputError,
            "nodes",
            lambda: pmdsim.render(small_setup(nodes={"a": {"pose": {"matrix": np.eye(4)}}}), scene=wall()),
        )

    def test_a_scene_whose_arrays_were_spoilt(self) -> None:
        """What Python checked may have changed since."""
        vertices, triangles = np.array(triangle, dtype=float), np.array([[0, 1, 2]], dtype=np.uint32)
        scene = pmdsim.Scene(vertices, triangles)
        vertices[0, 0] = np.nan
        self.refused(pmdsim.Error, "vertex 0", lambda: pmdsim.render(without_scene(), scene=scene))
        vertices[0, 0], triangles[0, 0] = 0, 77
        self.refused(pmdsim.Error, "77", lambda: pmdsim.render(without_scene(), scene=scene))

    def test_the_arrays_of_a_scene_cannot_be_replaced(self) -> None:
        scene = pmdsim.Scene(triangle, [[0, 1, 2]], reflectivity=0.5, object_ids=[0])
        for name in ("vertices", "triangles", "reflectivity", "object_ids", "double_sided"):
            with self.subTest(name), self.assertRaises(AttributeError):
                setattr(scene, name, np.zeros((9, 3), dtype=np.float32))

    def test_the_form_of_a_scene_s_arrays_is_its_own(self) -> None:
        """numpy lets the owner of an array change its shape and type in place."""
        vertices, triangles = wall().vertices.copy(), wall().triangles.copy()
        scene = pmdsim.Scene(vertices, triangles)
        expected = pmdsim.render(without_scene(), scene=scene).distance_m.tobytes()
        for array in (vertices, triangles, scene.vertices, scene.triangles):
            array.shape = (array.size, 1)
            array.dtype = np.uint8
        self.assertEqual(scene.vertices.shape, (4, 3))
        self.assertEqual(scene.triangles.dtype, np.uint32)
        self.assertEqual(pmdsim.render(without_scene(), scene=scene).distance_m.tobytes(), expected)
        scene.vertices[:, 2] = -1.0
        self.assertAlmostEqual(float(np.nanmean(pmdsim.render(without_scene(), scene=scene).z_m)), 1.0, places=6)

    def test_closed_simulators(self) -> None:
        simulator = pmdsim.Simulator(small_setup())
        simulator.close()
        simulator.close()
        for action in (
            simulator.render,
            simulator.cancel,
            lambda: simulator.load(small_setup()),
            lambda: simulator.set("bounces", 0),
            lambda: simulator.move(sensor=0, pose=np.eye(4)),
            lambda: list(simulator.frames()),
            lambda: simulator.setup,
            lambda: simulator.device,
            simulator.__enter__,
        ):
            self.refused(pmdsim.HandleError, "closed", action)
            self.refused(ValueError, "closed", action)

    def test_frames_of_a_closed_simulator_in_turn(self) -> None:
        with pmdsim.Simulator(small_setup(frames={"rate_hz": 1, "count": 3})) as simulator:
            frames = simulator.frames()
            next(frames)
        self.refused(pmdsim.HandleError, "closed", lambda: next(frames))

    def test_no_setup(self) -> None:
        with pmdsim.Simulator() as simulator:
            self.refused(pmdsim.ArgumentError, "no setup", simulator.render)
            self.refused(pmdsim.ArgumentError, "no setup", lambda: simulator.set("bounces", 1))
            self.assertEqual(list(simulator.frames()), [])

    def test_frames(self) -> None:
        frame = pmdsim.render(small_setup())
        self.refused(pmdsim.UnknownChannelError, "no such channel; the frame has amplitude", lambda: frame["nothing"])
        self.refused(KeyError, "no such channel", lambda: frame["nothing"])
        self.refused(AttributeError, "no such channel", lambda: frame.nothing)
        self.refused(pmdsim.ArgumentError, "npz", lambda: frame.save("a.txt"))
        self.refused(pmdsim.OutputError, "cannot be written", lambda: frame.save("/no/such/folder/a.npz"))
        self.refused(OSError, "cannot be written", lambda: frame.save("/no/such/folder/a.npz"))
        self.assertRaises(AttributeError, setattr, frame, "distance_m", 3)
        self.assertRaises(AttributeError, setattr, frame, "anything", 3)

    def test_handles_that_are_none(self) -> None:
        """Below the package: numbers in place of objects."""
        lib = _library.library()
        count, options = ctypes.c_size_t(), _library.RenderOptions(struct_size=ctypes.sizeof(_library.RenderOptions))
        result = ctypes.c_void_p()
        for number in (None, 1, 0xDEADBEEF):
            self.assertEqual(lib.pmdsim_frame_channel_count(number, ctypes.byref(count)), 9)
            self.assertEqual(lib.pmdsim_render(number, 0, 0, ctypes.byref(options), ctypes.byref(result)), 9)
            self.refused(pmdsim.HandleError, "handle", lambda: _library.check(lib.pmdsim_simulator_set(number, b"{}")))
        with pmdsim.Simulator(small_setup()) as simulator:
            options.struct_size = 3
            status = lib.pmdsim_render(simulator._handle, 0, 0, ctypes.byref(options), ctypes.byref(result))
            self.refused(pmdsim.ArgumentError, "", lambda: _library.check(status))

    def test_errors_are_pickled(self) -> None:
        try:
            pmdsim.render(small_setup(bounces=-1))
        except pmdsim.InputError as error:
            again = pickle.loads(pickle.dumps(error))
            self.assertEqual((type(again), str(again), again.place), (pmdsim.InputError, str(error), error.place))
        else:
            self.fail("no error")

    def test_the_library(self) -> None:
        """Libraries that are none, or of another version: one line that says so."""
        for place, text in (
            (os.environ["PMDSIM_WRONG_ABI"], "expected a library with ABI 0, found ABI 99"),
            ("/no/such/library.so", "cannot be loaded"),
            ("libm.so.6", "this is not libpmdsim"),
        ):
            environment = dict(os.environ, PMDSIM_LIBRARY=place)
            code = (
                "import pmdsim\ntry: pmdsim.version()\nexcept ImportError as error: print(type(error).__name__, error)"
            )
            done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertRegex(done.stdout, f"^LibraryError {place}.*{text}.*\n$")

    def test_a_simulator_is_not_pickled(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            self.assertRaises(TypeError, pickle.dumps, simulator)

    def test_left_open_at_the_end(self) -> None:
        child = python(
            "import pmdsim\n"
            "from setups import small_setup\n"
            "simulator = pmdsim.Simulator(small_setup())\n"
            "frames = simulator.frames()\n"
            "first = next(frames)\n"
            "sweep = pmdsim.sweep(small_setup(), {'illuminators/0/intensity_w_sr': range(1, 99)}, workers=2)\n"
            "next(sweep)\n"
        )
        output, errors = child.communicate(timeout=60)
        self.assertEqual((child.returncode, output, errors), (0, "", ""))


if __name__ == "__main__":
    unittest.main()
