#!/usr/bin/env python3
"""Chooses the layout of a ring light: radii and numbers of the diodes of two rings.

The light shall be even over the view of a wall, while the position of the diodes bends the measured distances little:
the light that comes by a longer way than along the lens's ray makes a wall seem too far away. A constant can be
calibrated away, so what counts is how much that error varies over the view. The search halves its steps until nothing
is better (a pattern search), from several beginnings; with scipy its Nelder-Mead polishes the radii.
"""

from __future__ import annotations

import argparse
from typing import List, Tuple

import numpy as np

import pmdsim

LEAST_M, MOST_M = 0.02, 0.25  # the lens's housing, and the camera's


def camera(distance_m: float) -> dict:
    """A wide view of a wall."""
    return {
        "backscatter": "lambert",
        "sensors": [
            {
                "name": "camera",
                "resolution": [48, 36],
                "pixel_pitch_m": [45e-6, 45e-6],
                "focal_length_m": 1.4e-3,
                "pose": {"position_m": [0, 0, distance_m], "look_at_m": [0, 0, 0]},
                "modulation_hz": [60e6],
            }
        ],
        "illuminators": [
            {"name": "light", "diodes": {"rings": [{"radius_m": 0.05, "count": 24}]}, "pattern": {"order": 1}}
        ],
    }


def wall() -> pmdsim.Scene:
    corners = np.array([[-9.0, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]])
    return pmdsim.Scene(corners, np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32), reflectivity=0.8)


class Judge:
    """What a layout (inner radius, outer radius, diodes of the inner ring) is worth; lower is better."""

    def __init__(self, simulator: pmdsim.Simulator, diodes: int, most_mm: float) -> None:
        self.simulator, self.diodes, self.most_mm = simulator, diodes, most_mm
        self.layouts = 0

    def measure(self, layout: np.ndarray) -> Tuple[float, float]:
        """Unevenness of the amplitude (standard deviation over mean), and the spread of the deformation, mm."""
        inner_m, outer_m, inner_count = float(layout[0]), float(layout[1]), int(round(layout[2]))
        rings = [{"radius_m": inner_m, "count": inner_count}, {"radius_m": outer_m, "count": self.diodes - inner_count}]
        self.simulator.set("illuminators/light/diodes/rings", [ring for ring in rings if ring["count"] > 0])
        frame = self.simulator.render(channels=["amplitude", "distance_m", "range_m"])
        self.layouts += 1
        deformation_mm = 1e3 * (frame.distance_m.astype(float) - frame.range_m)
        return float(frame.amplitude.std() / frame.amplitude.mean()), float(np.ptp(deformation_mm))

    def __call__(self, layout: np.ndarray) -> float:
        inner_m, outer_m, count = layout
        if not (LEAST_M <= inner_m <= outer_m <= MOST_M and 0 <= round(count) <= self.diodes):
            return np.inf
        unevenness, spread_mm = self.measure(layout)
        return unevenness + max(0.0, spread_mm - self.most_mm)


def pattern_search(judge: Judge, start: np.ndarray, steps: np.ndarray, least: np.ndarray) -> np.ndarray:
    best, best_value = start, judge(start)
    while (steps > least).any():
        tried: List[np.ndarray] = [best + sign * steps * axis for axis in np.eye(len(start)) for sign in (-1.0, 1.0)]
        values = [judge(layout) for layout in tried]
        if min(values) < best_value:
            best, best_value = tried[int(np.argmin(values))], min(values)
        else:
            steps = steps / 2
    return best


def polished(judge: Judge, layout: np.ndarray) -> np.ndarray:
    """The same with better radii, where scipy is there."""
    try:
        from scipy.optimize import minimize
    except ImportError:
        return layout
    count = layout[2]
    found = minimize(lambda radii: min(judge(np.append(radii, count)), 1e9), layout[:2], method="Nelder-Mead")
    return np.append(found.x, count)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--diodes", type=int, default=48, help="diodes of both rings together [%(default)s]")
    parser.add_argument("--distance-m", type=float, default=0.3, help="of the wall [%(default)s]")
    parser.add_argument("--most-mm", type=float, default=20.0, help="largest spread of the deformation [%(default)s]")
    arguments = parser.parse_args()

    start = np.array([0.05, 0.10, arguments.diodes / 2])
    random = np.random.default_rng(1)
    others = [
        np.append(np.sort(random.uniform(LEAST_M, MOST_M, 2)), random.uniform(0, arguments.diodes)) for _ in range(7)
    ]
    steps, least = np.array([0.04, 0.04, arguments.diodes / 4]), np.array([2e-4, 2e-4, 0.5])
    with pmdsim.Simulator(camera(arguments.distance_m), scene=wall()) as simulator:
        judge = Judge(simulator, arguments.diodes, arguments.most_mm)
        found = [pattern_search(judge, begin, steps, least) for begin in (start, *others)]
        best = polished(judge, min(found, key=judge))
        for name, layout in (("start", start), ("best", best)):
            unevenness, spread_mm = judge.measure(layout)
            inner = round(layout[2])
            print(
                f"{name:>5}: {inner} diodes at {1e3 * layout[0]:.1f} mm, {arguments.diodes - inner} at "
                f"{1e3 * layout[1]:.1f} mm; amplitude uneven by {100 * unevenness:.2f} %, "
                f"deformation spread {spread_mm:.2f} mm"
            )
        print(f"{judge.layouts} layouts measured")


if __name__ == "__main__":
    main()
