#!/usr/bin/env python3
"""Makes a data set: random views of a furnished room, noisy as a camera measures them and clean.

Every view is one file, view_000000.npz, with the arrays `noisy_distance_m`, `noisy_amplitude`, `clean_distance_m`,
`clean_amplitude`, `range_m` (ground truth), `object_id` and `world_from_camera` (4 x 4). A view follows from the seed
and its number alone, and its file appears whole or not at all: start the script again, and it makes what is missing.
Several processes share the work with --part. The folder's parameters.json has the seed and the binning of its views; a
folder of others is refused.
"""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path
from typing import Callable, Dict, List, Tuple

import numpy as np

import pmdsim

ROOM_M = np.array([5.0, 2.6, 4.0])  # along x, y (up) and z, one corner at the origin


def box(low: np.ndarray, high: np.ndarray, inside: bool) -> Tuple[np.ndarray, np.ndarray]:
    """The 8 corners and 12 triangles of a box, which show their fronts outside or inside."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (high - low) + low
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    triangles = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return corners, triangles[:, ::-1] if inside else triangles


def furnished_room(seed: int, pieces: int = 12) -> pmdsim.Scene:
    """Walls, and boxes on the floor; each is an object with a reflectivity of its own."""
    random = np.random.default_rng([seed, 1])
    boxes: List[Tuple[np.ndarray, np.ndarray]] = [box(np.zeros(3), ROOM_M, inside=True)]
    for _ in range(pieces):
        size = random.uniform([0.2, 0.2, 0.2], [1.0, 1.6, 1.0])
        low = random.uniform(0.05, 0.95, 3) * (ROOM_M - size)
        low[1] = 0.0
        boxes.append(box(low, low + size, inside=False))
    vertices = np.vstack([corners for corners, _ in boxes])
    triangles = np.vstack([indices + 8 * number for number, (_, indices) in enumerate(boxes)])
    return pmdsim.Scene(
        vertices,
        triangles,
        reflectivity=np.repeat(random.uniform(0.2, 0.9, len(boxes)), 12),
        object_ids=np.repeat(np.arange(len(boxes)), 12),
    )


def camera(binning: int) -> dict:
    """A noisy camera of 512 x 424 pixels, of which `binning` x `binning` make one, with a light at its lens."""
    return {
        "sensors": [
            {
                "name": "camera",
                "resolution": [512 // binning, 424 // binning],
                "pixel_pitch_m": [10e-6 * binning, 10e-6 * binning],
                "focal_length_m": 3.66e-3,
                "modulation_hz": [16e6],
                "samples": 2,
                "electronics": {
                    "preset": "kinect_v2_like",
                    "integration_time_s": 2e-3,
                    "lens_f_number": 1.1,
                    "background_radiance_w_m2_sr": 0.02,
                    "binning": [binning, binning],
                    "binning_after_adc": True,
                    "noiseless_channels": True,
                },
            }
        ],
        "illuminators": [
            {
                "name": "light",
                "diodes": {"rings": [{"radius_m": 0.04, "count": 3}]},
                "pattern": {"order": 1},
                "intensity_w_sr": 1.0,
            }
        ],
    }


def random_view(seed: int, number: int) -> Dict[str, object]:
    """What a view changes in the setup: the camera's pose and the noise."""
    random = np.random.default_rng([seed, 2, number])
    position_m = random.uniform([0.2, 1.7, 0.2], [ROOM_M[0] - 0.2, 2.4, ROOM_M[2] - 0.2])
    look_at_m = random.uniform(0.2 * ROOM_M, 0.8 * ROOM_M)
    look_at_m[1] = random.uniform(0.0, 1.0)
    return {
        "sensors/camera/pose": {"position_m": position_m, "look_at_m": look_at_m},
        "sensors/camera/electronics/seed": number,
    }


def partial_of(file: Path) -> Path:
    return file.with_name(f".{file.name}.{os.getpid()}.partial")


def write(file: Path, frame: pmdsim.Frame) -> None:
    partial = partial_of(file)
    with open(partial, "wb") as out:
        np.savez(
            out,
            noisy_distance_m=frame.distance_m,
            noisy_amplitude=frame.amplitude,
            clean_distance_m=frame.distance_m_noiseless,
            clean_amplitude=frame.amplitude_noiseless,
            range_m=frame.range_m,
            object_id=frame.object_id,
            world_from_camera=np.array(frame.camera["world_from_camera"]),
        )
    os.replace(partial, file)


def prepare(folder: Path, parameters: Dict[str, int]) -> None:
    """Makes the folder, or ValueError where it has views of other parameters."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "parameters.json"
    if not file.exists() and not any(folder.glob("view_*.npz")):
        partial = partial_of(file)
        partial.write_text(json.dumps(parameters))
        os.replace(partial, file)
    found = json.loads(file.read_text()) if file.exists() else "unknown ones"
    if found != parameters:
        raise ValueError(f"the folder has views of other parameters: expected {parameters}, found {found}")


def whole(least: int, most: int) -> Callable[[str], int]:
    def whole_number(text: str) -> int:
        if not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"expected a whole number from {least} to {most}, found {text}")
        return int(text)

    return whole_number


def part(text: str) -> Tuple[int, int]:
    index, of = (int(number) for number in text.split("/"))
    if not 0 <= index < of:
        raise ValueError
    return index, of


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path("out/random_views"), help="folder [%(default)s]")
    parser.add_argument("--count", type=whole(0, 10**6), default=1000, help="views [%(default)s]")
    parser.add_argument("--seed", type=whole(0, 2**63), default=0, help="of the room and all views [%(default)s]")
    parser.add_argument("--binning", type=whole(1, 16), default=8, help="8: 64 x 53 pixels, 1: 512 x 424 [%(default)s]")
    parser.add_argument(
        "--part", type=part, default=(0, 1), metavar="i/n", help="every n-th view from the i-th on, from 0"
    )
    arguments = parser.parse_args()

    try:
        prepare(arguments.output, {"seed": arguments.seed, "binning": arguments.binning})
    except (OSError, ValueError) as error:
        text = error.strerror if isinstance(error, OSError) else error
        parser.exit(2, f"{parser.prog}: {arguments.output}: {text}\n")
    index, of = arguments.part
    files = {number: arguments.output / f"view_{number:06d}.npz" for number in range(index, arguments.count, of)}
    missing = {number: file for number, file in files.items() if not file.exists()}
    print(f"{len(files)} views, {len(files) - len(missing)} of them are there")
    errors = []
    with pmdsim.Simulator(camera(arguments.binning), scene=furnished_room(arguments.seed)) as simulator:
        try:
            for number, file in missing.items():
                simulator.set(random_view(arguments.seed, number))
                frame = simulator.render()
                write(file, frame)
                errors.append(np.nanmedian(np.abs(frame.distance_m - frame.distance_m_noiseless)))
        except KeyboardInterrupt:
            there = len(files) - len(missing) + len(errors)
            parser.exit(130, f"{parser.prog}: {there} of {len(files)} views are whole, start again to go on\n")
    if errors:
        print(f"{len(errors)} made, {1e3 * np.median(errors):.1f} mm of noise in the median pixel of the median view")


if __name__ == "__main__":
    main()
