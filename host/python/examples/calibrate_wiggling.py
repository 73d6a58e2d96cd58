#!/usr/bin/env python3
"""Calibrates the wiggling error of a camera with square light.

Four taps see the third and fifth harmonic of square light, and the measured distance wiggles about the true one with a
quarter of the ambiguity range for a period. As on a real rail, a wall is measured at known distances; the error is
fitted as a Fourier series of the measured phase; and the correction is tried at distances that it has not seen.
"""

from __future__ import annotations

import argparse
from typing import Tuple

import numpy as np

import pmdsim

LIGHT_M_S = 299_792_458.0


def camera(modulation_hz: float) -> dict:
    """A few pixels around the axis, one diode in the lens, and a delay of the light that nobody knows."""
    return {
        "sensors": [
            {
                "name": "camera",
                "resolution": [4, 4],
                "pixel_pitch_m": [45e-6, 45e-6],
                "focal_length_m": 0.0125,
                "modulation_hz": [modulation_hz],
                "waveform": "square",
            }
        ],
        "illuminators": [{"name": "lamp", "diodes": "monostatic", "modulation_phase_deg": 11}],
    }


def wall() -> pmdsim.Scene:
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    return pmdsim.Scene(corners, np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32), reflectivity=0.8)


def rail(setup: dict, distances_m: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Measured and true distances of all pixels, with the camera at these distances from the wall."""
    poses = [{"position_m": [0, 0, z_m], "look_at_m": [0, 0, 0]} for z_m in distances_m]
    measured, true = [], []
    for _, frame in pmdsim.sweep(
        setup, {"sensors/camera/pose": poses}, scene=wall(), channels=["distance_m", "range_m"]
    ):
        measured.append(frame.distance_m.ravel())
        true.append(frame.range_m.ravel())
    return np.concatenate(measured).astype(float), np.concatenate(true).astype(float)


def wrapped(error_m: np.ndarray, ambiguity_m: float) -> np.ndarray:
    return (error_m + ambiguity_m / 2) % ambiguity_m - ambiguity_m / 2


def waves(measured_m: np.ndarray, ambiguity_m: float, orders: int) -> np.ndarray:
    """1, and the cosine and sine of multiples of the measured phase."""
    phase = 2 * np.pi * measured_m[:, np.newaxis] / ambiguity_m * np.arange(1, orders + 1)
    return np.hstack([np.ones((len(measured_m), 1)), np.cos(phase), np.sin(phase)])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--modulation-hz", type=float, default=20e6)
    parser.add_argument("--distances", type=int, default=200, help="places on the rail [%(default)s]")
    parser.add_argument("--orders", type=int, default=24, help="orders of the Fourier series [%(default)s]")
    parser.add_argument("--plot", metavar="FILE", help="draw the error before and after (needs matplotlib)")
    arguments = parser.parse_args()

    setup = camera(arguments.modulation_hz)
    ambiguity_m = LIGHT_M_S / (2 * arguments.modulation_hz)
    places_m = np.linspace(0.05, 0.99, arguments.distances) * ambiguity_m

    measured, true = rail(setup, places_m)
    error = wrapped(measured - true, ambiguity_m)
    coefficients, *_ = np.linalg.lstsq(waves(measured, ambiguity_m, arguments.orders), error, rcond=None)

    new_places_m = np.random.default_rng(1).uniform(0.06, 0.98, arguments.distances) * ambiguity_m
    measured, true = rail(setup, new_places_m)
    before = wrapped(measured - true, ambiguity_m)
    after = wrapped(measured - waves(measured, ambiguity_m, arguments.orders) @ coefficients - true, ambiguity_m)

    constant_mm = 1e3 * coefficients[0]
    strength = 1e3 * np.hypot(*coefficients[1:].reshape(2, -1))
    strongest = int(np.argmax(strength))
    print(
        f"fitted: a constant of {constant_mm:.1f} mm, and a wave of {strength[strongest]:.1f} mm, order {strongest + 1}"
    )
    for name, left in (("before", before - coefficients[0]), ("after", after)):
        print(f"{name:>6}: {1e3 * np.sqrt(np.mean(left**2)):8.3f} mm rms, {1e3 * np.abs(left).max():8.3f} mm at most")
    if arguments.plot:
        draw(arguments.plot, true, before - coefficients[0], after)


def draw(file: str, true: np.ndarray, before: np.ndarray, after: np.ndarray) -> None:
    from matplotlib import pyplot

    for name, error in (("before", before), ("after", after)):
        pyplot.plot(true, 1e3 * error, ".", label=name, markersize=2)
    pyplot.xlabel("distance, m")
    pyplot.ylabel("error, mm")
    pyplot.legend()
    pyplot.savefig(file)


if __name__ == "__main__":
    main()
