"""Small setups, the program, and processes of their own, for the tests."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, Sequence

import numpy as np

import pmdsim

scenes = Path(__file__).resolve().parents[2] / "scenes"
program = os.environ["PMDSIM_PROGRAM"]


def small_setup(**changes: Any) -> Dict[str, Any]:
    """A ring of 16 diodes before a wall at 2 m, which one triangle of 0.4 m does not fill: 8 columns, 6 rows."""
    setup = {
        "scene": str(scenes / "wall_2m.gltf"),
        "sensors": [
            {
                "name": "pmd",
                "resolution": [8, 6],
                "pixel_pitch_m": [45e-6, 45e-6],
                "focal_length_m": 0.0018,
                "modulation_hz": [20e6],
            }
        ],
        "illuminators": [
            {
                "name": "ring",
                "pose": {"sensor": "pmd"},
                "diodes": {"rings": [{"radius_m": 0.146, "count": 16}]},
            }
        ],
    }
    setup.update(changes)
    return setup


def wall(z_m: float = -2.0, half_m: float = 0.3) -> pmdsim.Scene:
    """A square that faces a camera at the origin."""
    corners = [[-half_m, -half_m, z_m], [half_m, -half_m, z_m], [half_m, half_m, z_m], [-half_m, half_m, z_m]]
    return pmdsim.Scene(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32), reflectivity=0.5)


def without_scene(**changes: Any) -> Dict[str, Any]:
    setup = small_setup(**changes)
    del setup["scene"]
    return setup


def write_by_program(setup: Path, folder: Path, *options: str) -> None:
    """What `pmdsim render` makes of the setup."""
    environment = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}  # ASan's, for Python
    command = [program, "render", str(setup), "-o", str(folder), *options]
    subprocess.run(command, check=True, capture_output=True, env=environment)


def python(code: str, *arguments: str, **options: Any) -> "subprocess.Popen[str]":
    """A Python process of its own with the tests' modules."""
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join([str(Path(__file__).parent), os.environ["PYTHONPATH"]]))
    return subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **options,
    )


def same_bytes(frame: pmdsim.Frame, files: Sequence[Path], prefix: str) -> None:
    """The frame's channels are those of the program's .npy files, bit by bit."""
    written = {file.name[len(prefix) : -len(".npy")]: file for file in files}
    assert set(written) == set(frame.channels), (sorted(written), sorted(frame.channels))
    for name, file in written.items():
        array = np.load(file)
        assert array.dtype == frame[name].dtype and array.shape == frame[name].shape, name
        assert array.tobytes() == frame[name].tobytes(), f"{prefix}{name} differs"
