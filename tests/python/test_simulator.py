"""Simulators: changes, poses, frames, threads, processes."""

from __future__ import annotations

import gc
import json
import os
import pickle
import shutil
import tempfile
import threading
import unittest
import weakref
from pathlib import Path

import numpy as np

import pmdsim
from setups import python, scenes, small_setup, wall, without_scene

moving = {"frames": {"rate_hz": 10, "count": 3}}


class SimulatorTest(unittest.TestCase):
    def test_changes(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            first = simulator.render()
            simulator.set("sensors/0/focal_length_m", 0.0009)
            second = simulator.render()
            simulator.set({"/sensors/pmd/focal_length_m": np.float64(0.0018), "illuminators/ring/intensity_w_sr": 1})
            third = simulator.render()
            self.assertNotEqual(first.distance_m.tobytes(), second.distance_m.tobytes())
            self.assertEqual(first.distance_m.tobytes(), third.distance_m.tobytes())
            self.assertEqual(simulator.setup.sensors[0].focal_length_m, 0.0018)

    def test_objects_have_names(self) -> None:
        with pmdsim.Simulator() as simulator:
            self.assertEqual(simulator.objects, {})
            simulator.load(scenes / "room.json")
            simulator.set("sensors/0/resolution", [8, 8])
            names = {0: "wall", 1: "floor", 2: "box", 3: "sphere"}
            self.assertEqual(simulator.objects, names)
            frame = simulator.render()
            self.assertEqual(frame.objects, names)
            self.assertEqual(frame.objects[frame.object_id[0, 0]], "wall")
            self.assertEqual(pickle.loads(pickle.dumps(frame)).objects, names)

    def test_files_stay_where_they_were_when_the_process_goes_elsewhere(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(scenes / "wall_2m.gltf", folder)
            setup = small_setup(scene="wall_2m.gltf")
            (Path(folder) / "setup.json").write_text(json.dumps(setup))
            before = os.getcwd()
            os.chdir(folder)
            try:
                simulators = [pmdsim.Simulator(of) for of in ("setup.json", setup, pmdsim.Setup(setup))]
            finally:
                os.chdir(before)
            for simulator in simulators:
                with simulator:
                    simulator.set("sensors/0/taps", 5)
                    used = simulator.setup
                    self.assertEqual(used.directory, os.path.realpath(folder))
                    np.testing.assert_array_equal(pmdsim.render(used).range_m, simulator.render().range_m)

    def test_a_wrong_change_changes_nothing(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            before = simulator.render().distance_m.tobytes()
            with self.assertRaises(pmdsim.InputError):
                simulator.set({"illuminators/0/intensity_w_sr": 5, "sensors/0/focal_length_m": -1})
            self.assertEqual(simulator.render().distance_m.tobytes(), before)
            self.assertEqual(simulator.setup.illuminators[0].intensity_w_sr, 1)

    def test_a_load_takes_changes_back(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            simulator.set("sensors/0/focal_length_m", 0.0009)
            simulator.load(small_setup())
            self.assertEqual(simulator.setup.sensors[0].focal_length_m, 0.0018)
            with self.assertRaises(pmdsim.InputError):
                simulator.load(small_setup(scene="none.gltf"))
            self.assertEqual(simulator.sensors, ["pmd"])

    def test_what_it_tells(self) -> None:
        with pmdsim.Simulator() as simulator:
            self.assertTrue(simulator.device)
            self.assertTrue(simulator.driver)
            self.assertEqual((simulator.setup, simulator.sensors, simulator.frame_count), (None, [], 0))
            simulator.load(small_setup(**moving))
            self.assertEqual((simulator.sensors, simulator.frame_count), (["pmd"], 3))
            self.assertIsInstance(simulator.setup, pmdsim.Setup)
            self.assertEqual(simulator.setup.sensors[0].taps, 4)
            self.assertIn("pmd", repr(simulator))
        self.assertIn("closed", repr(simulator))

    def test_poses(self) -> None:
        quarter = np.sqrt(0.5)
        with pmdsim.Simulator(small_setup()) as simulator:
            back = np.diag([1.0, -1.0, -1.0, 1.0])
            back[2, 3] = 0.5
            simulator.move(sensor="pmd", pose=back)
            self.assertAlmostEqual(float(np.nanmean(simulator.render().z_m)), 2.5, places=6)
            simulator.move(sensor=0, pose=([0, 0, 0.25], [1, 0, 0, 0]))
            self.assertAlmostEqual(float(np.nanmean(simulator.render().z_m)), 2.25, places=6)
            simulator.move(sensor=0, pose={"position_m": [0, 0, 1], "look_at_m": [0, 0, -1]})
            self.assertAlmostEqual(float(np.nanmean(simulator.render().z_m)), 3.0, places=6)
            simulator.move(illuminator="ring", pose=([0, 0, 0], [quarter, 0, 0, -quarter]))
            rows = simulator.setup.illuminators[0].pose.matrix
            np.testing.assert_allclose(np.array(rows)[:3, :3], [[1, 0, 0], [0, 0, 1], [0, -1, 0]], atol=1e-12)

    def test_names_that_are_numbers(self) -> None:
        setup = small_setup()
        setup["sensors"] = [{**setup["sensors"][0], "name": name} for name in ("1", "0")]
        setup["illuminators"] = [
            {**setup["illuminators"][0], "name": name, "pose": {"sensor": "1"}} for name in ("1", "0")
        ]
        pose = np.eye(4)
        pose[0, 3] = 7.0
        with pmdsim.Simulator(setup) as simulator:
            simulator.move(sensor="1", pose=pose)
            simulator.move(illuminator="0", pose=pose)
            used = simulator.setup
        self.assertEqual(used.sensors[0].pose.matrix[0][3], 7.0)
        self.assertEqual(used.illuminators[1].pose.matrix[0][3], 7.0)
        for part, other in ((used.sensors, 1), (used.illuminators, 0)):
            self.assertNotIn("matrix", part[other].get("pose", {}))

    def test_quaternions(self) -> None:
        """As they turn vectors: v + 2 w (u x v) + 2 u x (u x v)."""
        turn = np.array([0.1, -0.7, 0.3, 0.5])
        u, w = turn[:3] / np.linalg.norm(turn), turn[3] / np.linalg.norm(turn)
        with pmdsim.Simulator(small_setup()) as simulator:
            simulator.move(sensor=0, pose=([1, 2, 3], turn))
            matrix = np.array(simulator.setup.sensors[0].pose.matrix)
        for v in np.eye(3):
            turned = v + 2 * w * np.cross(u, v) + 2 * np.cross(u, np.cross(u, v))
            np.testing.assert_allclose(matrix[:3, :3] @ v, turned, atol=1e-12)
        np.testing.assert_array_equal(matrix[:, 3], [1, 2, 3, 1])

    def test_nodes_are_moved(self) -> None:
        with pmdsim.Simulator(scenes / "motion.json") as simulator:
            simulator.set("sensors/0/resolution", [16, 12])
            before = simulator.render().range_m.copy()
            name = next(iter(json.loads((scenes / "moving.gltf").read_text())["nodes"]))["name"]
            pose = np.eye(4)
            pose[2, 3] = -1.0
            simulator.move(node=name, pose=pose)
            self.assertFalse(np.array_equal(simulator.render().range_m, before, equal_nan=True))
            with self.assertRaises(pmdsim.InputError):
                simulator.move(node="nobody", pose=pose)

    def test_all_frames_of_all_sensors(self) -> None:
        setup = small_setup(**moving)
        setup["sensors"].append({**setup["sensors"][0], "name": "second", "resolution": [4, 3]})
        with pmdsim.Simulator(setup) as simulator:
            found = [(frame.frame, frame.sensor, frame.shape) for frame in simulator.frames()]
            expected = [(k, name, shape) for k in range(3) for name, shape in (("pmd", (6, 8)), ("second", (3, 4)))]
            self.assertEqual(found, expected)
            one = [frame.frame for frame in simulator.frames(sensors=["second"], frames=[2, 0], mode="exact")]
            self.assertEqual(one, [2, 0])
            self.assertEqual([frame.frame for frame in simulator.frames(sensors="second", frames=np.int64(1))], [1])
            for wrong in (1.5, "1", [0, -1], None, [None]):
                with self.subTest(wrong), self.assertRaises(pmdsim.ArgumentError):
                    simulator.frames(sensors=0, frames=[wrong] if wrong is None else wrong)
            self.assertAlmostEqual(simulator.render(frame=2).time_s, 0.2)
            self.assertEqual(simulator.render(sensor="second").shape, simulator.render(sensor=1).shape)

    def test_frames_stay(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            frame = simulator.render()
            before = frame.distance_m.copy()
            simulator.set("illuminators/0/intensity_w_sr", 9)
            simulator.render()
        np.testing.assert_array_equal(frame.distance_m, before)
        self.assertEqual(frame.points_m.shape, (6, 8, 3))

    def test_a_scene_of_arrays(self) -> None:
        with pmdsim.Simulator(without_scene(), scene=wall(-1.5)) as simulator:
            self.assertAlmostEqual(float(np.nanmean(simulator.render().z_m)), 1.5, places=6)
            simulator.set("illuminators/0/intensity_w_sr", 2)
            self.assertAlmostEqual(float(np.nanmean(simulator.render().z_m)), 1.5, places=6)
            simulator.load(without_scene(), scene=wall(-1.25))
            self.assertAlmostEqual(float(np.nanmean(simulator.render().z_m)), 1.25, places=6)

    def test_scene_details(self) -> None:
        vertices = [[-9, -9, -2], [9, -9, -2], [0, 18, -2], [-9, -9, -3], [0, 18, -3], [9, -9, -3]]
        scene = pmdsim.Scene(
            vertices, [[0, 2, 1], [3, 5, 4]], reflectivity=[1, 0.5], object_ids=[0, 1], double_sided=False
        )
        frame = pmdsim.render(without_scene(shadows="off"), scene=scene)
        np.testing.assert_allclose(frame.z_m, 3.0, atol=1e-6)  # the first shows its back
        self.assertEqual(set(frame.object_id.flat), {1})
        self.assertEqual(set(frame.triangle_id.flat), {1})

    def test_arrays_of_scenes_are_not_copied(self) -> None:
        vertices, triangles = np.zeros((3, 3)), np.array([[0, 1, 2]], dtype=np.uint32)
        scene = pmdsim.Scene(vertices, triangles)
        self.assertTrue(np.shares_memory(scene.vertices, vertices) and np.shares_memory(scene.triangles, triangles))

    def test_two_simulators_in_two_threads(self) -> None:
        expected = pmdsim.render(small_setup()).distance_m.tobytes()
        found, wrong = [], []

        def work() -> None:
            try:
                with pmdsim.Simulator(small_setup()) as simulator:
                    for _ in range(20):
                        found.append(simulator.render().distance_m.tobytes())
            except BaseException as error:
                wrong.append(error)

        threads = [threading.Thread(target=work) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual((wrong, len(found), set(found)), ([], 40, {expected}))

    def test_one_call_in_several_threads(self) -> None:
        expected = pmdsim.render(small_setup()).distance_m.tobytes()
        found = []
        threads = [
            threading.Thread(
                target=lambda: found.extend(pmdsim.render(small_setup()).distance_m.tobytes() for _ in range(3))
            )
            for _ in range(4)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual((len(found), set(found)), (12, {expected}))

    def test_two_threads_in_one_simulator(self) -> None:
        slow = small_setup()
        slow["sensors"][0]["resolution"] = [1000, 1000]
        slow["sensors"][0]["samples"] = 16
        with pmdsim.Simulator(slow, device="reference") as simulator:
            ended, begun = [], threading.Event()

            def work() -> None:
                begun.set()
                while not ended:
                    try:
                        simulator.render()
                    except pmdsim.BusyError:  # the other thread was there first
                        pass
                    except pmdsim.Error as error:
                        ended.append(error)

            thread = threading.Thread(target=work)
            thread.start()
            begun.wait()
            busy = 0
            while thread.is_alive() and busy < 3:
                try:
                    simulator.set("illuminators/0/intensity_w_sr", 2)
                except pmdsim.BusyError:
                    busy += 1
            while thread.is_alive():
                simulator.cancel()
                thread.join(0.01)
        self.assertEqual(busy, 3)
        self.assertEqual([type(error) for error in ended], [pmdsim.CancelledError])

    def test_one_that_is_forgotten_is_closed(self) -> None:
        simulator = pmdsim.Simulator(small_setup())
        simulator.render()
        gone = weakref.ref(simulator)
        del simulator
        gc.collect()
        self.assertIsNone(gone())

    def test_in_a_forked_child(self) -> None:
        child = python(
            "import os, pmdsim\n"
            "from setups import small_setup\n"
            "simulator = pmdsim.Simulator(small_setup())\n"
            "frame = simulator.render()\n"
            "for action in (simulator.render, lambda: pmdsim.render(small_setup()), pmdsim.Simulator):\n"
            "    process = os.fork()\n"
            "    if process == 0:\n"
            "        try:\n"
            "            frame.distance_m.sum()\n"
            "            action()\n"
            "        except pmdsim.HandleError as error:\n"
            "            del frame, simulator\n"
            "            os._exit(7 if 'process' in str(error) else 8)\n"
            "        os._exit(9)\n"
            "    assert os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]) == 7\n"
            "simulator.render()\n"
        )
        _, errors = child.communicate(timeout=60)
        self.assertEqual((child.returncode, errors), (0, ""))

    def test_a_child_of_a_process_that_has_not_used_it(self) -> None:
        child = python(
            "import multiprocessing, pmdsim\n"
            "from setups import small_setup\n"
            "with multiprocessing.get_context('fork').Pool(2) as pool:\n"
            "    frames = pool.map(pmdsim.render, [small_setup()] * 4)\n"
            "assert all(frame.distance_m.tobytes() == frames[0].distance_m.tobytes() for frame in frames)\n"
        )
        _, errors = child.communicate(timeout=60)
        self.assertEqual((child.returncode, errors), (0, ""))


if __name__ == "__main__":
    unittest.main()
