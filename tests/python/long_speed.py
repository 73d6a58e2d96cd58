"""What Python costs: printed, not asserted."""

from __future__ import annotations

import json
import statistics
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

import pmdsim
from setups import scenes, small_setup, write_by_program


def median_ms(action, times: int) -> float:  # type: ignore[no-untyped-def]
    taken = []
    for _ in range(times):
        begin = time.perf_counter()
        action()
        taken.append(1e3 * (time.perf_counter() - begin))
    return statistics.median(taken)


class Speed(unittest.TestCase):
    def test_a_sweep_against_processes(self) -> None:
        path = "illuminators/0/intensity_w_sr"
        values = [1.0 + 0.01 * number for number in range(100)]
        setup = small_setup()
        setup["sensors"][0]["resolution"] = [64, 64]
        setup["sensors"][0]["focal_length_m"] = 0.0144
        with tempfile.TemporaryDirectory() as folder:
            begin = time.perf_counter()
            for number, value in enumerate(values):
                changed = json.loads(json.dumps(setup))
                changed["illuminators"][0]["intensity_w_sr"] = value
                file = Path(folder) / f"{number}.json"
                file.write_text(json.dumps(changed))
                write_by_program(file, Path(folder) / str(number), "--format", "npy")
            processes_s = time.perf_counter() - begin
            for workers in (1, 2):
                begin = time.perf_counter()
                found = [frame.amplitude for _, frame in pmdsim.sweep(setup, {path: values}, workers=workers)]
                sweep_s = time.perf_counter() - begin
                print(
                    f"100 variants: {processes_s:.2f} s by processes, {sweep_s:.3f} s by sweep(workers={workers}), "
                    f"{processes_s / sweep_s:.0f} times as fast"
                )
                for number, amplitude in enumerate(found):
                    written = np.load(Path(folder) / str(number) / "pmd_0000.amplitude.npy")
                    self.assertEqual(written.tobytes(), amplitude.tobytes())

    def test_a_frame(self) -> None:
        for setup in ("paper_ring.json", "room.json"):
            with pmdsim.Simulator(scenes / setup) as simulator:
                simulator.render()
                frame_ms = []

                def render() -> None:
                    frame = simulator.render()
                    frame.distance_m
                    frame_ms.append(frame.report["frame_ms"])

                whole_ms = median_ms(render, 30)
                inside_ms = statistics.median(frame_ms)
                print(
                    f"{setup}: render {whole_ms:.3f} ms, of which the frame itself {inside_ms:.3f} ms, "
                    f"the rest {whole_ms - inside_ms:.3f} ms"
                )

    def test_a_small_call(self) -> None:
        with pmdsim.Simulator(small_setup()) as simulator:
            simulator.render()
            render_ms = median_ms(simulator.render, 300)
            inside_ms = simulator.render().report["frame_ms"]
            set_ms = median_ms(lambda: simulator.set("illuminators/0/intensity_w_sr", 2), 300)
        print(f"8 x 6 pixels: render {render_ms:.3f} ms, the frame itself {inside_ms:.3f} ms; set {set_ms:.3f} ms")
        print(f"8 x 6 pixels: pmdsim.render {median_ms(lambda: pmdsim.render(small_setup()), 100):.3f} ms")


if __name__ == "__main__":
    unittest.main()
