"""Setups and changes of them as the library takes them."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Dict, Mapping, Optional, Union

from ._errors import ArgumentError, Error
from ._files import file_bytes
from ._library import Mesh, check, library
from ._scene import Scene
from ._setup import Setup
from ._text import short
from ._values import json_text, pose_value

Path = Union[str, "os.PathLike[str]"]
SetupLike = Union[Path, Mapping[str, Any]]


def name_file(error: Error, file: str) -> None:
    """Puts the file that a setup was read from in place of the library's words for one that it gets as text."""
    begin = "the setup: "
    if file and error.message.startswith(begin):
        error.message = f"{file}: {error.message[len(begin):]}"
        error.args = (error.message,)
        error.file = file


class SetupInput:
    """A setup that `load` gives to a simulator of the library: a file, text, or text beside a mesh.

    Raises ArgumentError where it is none of these, and InputError where a file is wrong.
    """

    def __init__(self, setup: SetupLike, scene: Optional[Scene]) -> None:
        if not isinstance(setup, (str, os.PathLike, Mapping)):
            raise ArgumentError(f"setup: expected a path, a dict or a pmdsim.Setup, found {short(setup)}")
        if scene is not None and not isinstance(scene, Scene):
            raise ArgumentError(f"scene: expected a pmdsim.Scene, found {short(scene)}")
        self.file = ""  # that text was read from
        self.directory = ""  # absolute, where relative paths start
        self._path = b""  # of a setup that the library reads
        self._text: Optional[bytes] = None
        self._folder: Optional[bytes] = None
        self._mesh: Optional[Mesh] = None
        if isinstance(setup, Mapping):
            self._take(setup, scene)
        elif scene is not None:
            self._take(Setup.load(setup), scene)
        else:
            self._path = file_bytes(setup, "setup")
            self.directory = os.path.dirname(os.path.abspath(os.fsdecode(self._path)))

    def _take(self, setup: Mapping[str, Any], scene: Optional[Scene]) -> None:
        values = dict(setup)
        if scene is None and isinstance(values.get("scene"), Scene):
            scene = values["scene"]
        if scene is not None:
            values.pop("scene", None)
            self._mesh = scene._mesh()  # which keeps the arrays, however long the call takes
        self._text = json_text(values, "setup").encode("utf-8")
        folder = getattr(setup, "directory", None)
        if folder is not None:
            self._folder = file_bytes(folder, "directory")
        self.directory = os.path.abspath(folder or "")
        self.file = getattr(setup, "_file", "")

    def load(self, simulator: int) -> None:
        """A call of the library, which may take long."""
        lib, text = library(), self._text
        if text is None:
            check(lib.pmdsim_simulator_load(simulator, self._path))
        elif self._mesh is None:
            check(lib.pmdsim_simulator_load_text(simulator, text, len(text), self._folder))
        else:
            mesh = ctypes.byref(self._mesh)
            check(lib.pmdsim_simulator_load_mesh(simulator, text, len(text), self._folder, mesh))


def changes_of(changes: Mapping[str, Any]) -> Dict[str, Any]:
    """Paths and values as the library takes them: a node, a sensor or an illuminator that is given a pose as a matrix
    or as a position and a quaternion gets it as its pose."""
    if not isinstance(changes, Mapping):
        raise ArgumentError(f"set: expected a path and a value, or a dict of paths and values, found {short(changes)}")
    found: Dict[str, Any] = {}
    for path, value in changes.items():
        if not isinstance(path, str):
            raise ArgumentError(f'expected paths like "sensors/0/focal_length_m", found {short(path)}')
        parts = path.strip("/").split("/")
        is_whole_node = len(parts) == 2 and parts[0] == "nodes"
        if is_whole_node and not (isinstance(value, Mapping) and "pose" in value):
            path, value = "/".join([*parts, "pose"]), pose_value(value, path)
        elif parts[-1] == "pose" and len(parts) == 3:
            value = pose_value(value, path)
        found[path] = value
    return found
