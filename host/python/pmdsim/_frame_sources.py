"""Where a frame's channels come from: the library's memory, arrays, or files."""

from __future__ import annotations

import ctypes
import json
import os
import re
import weakref
from functools import lru_cache
from typing import Any, Dict, List, Mapping, Optional, Protocol, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from ._errors import ArgumentError, InputError
from ._library import Channel, channels, check, library

_types: Dict[int, "np.dtype[Any]"] = {0: np.dtype(np.float32), 1: np.dtype(np.uint32), 2: np.dtype(np.float64)}


class Source(Protocol):
    """The channels of a frame and what is told of it."""

    @property
    def names(self) -> Tuple[str, ...]:
        ...

    def array(self, name: str) -> NDArray[Any]:
        ...

    def unit(self, name: str) -> str:
        ...

    def report(self) -> Dict[str, Any]:
        ...

    def directions(self, shape: Tuple[int, int]) -> NDArray[np.float64]:
        ...


def _destroy(handle: int, process: int) -> None:
    """In a forked child the library may be in the middle of another thread's call, which is not there."""
    if os.getpid() == process:
        library().pmdsim_frame_destroy(handle)


class FrameHandle:
    """Owns a frame of the library."""

    __slots__ = ("value", "__weakref__")

    def __init__(self, value: int) -> None:
        self.value = value
        weakref.finalize(self, _destroy, value, os.getpid()).atexit = False


class _Memory:
    """What numpy sees of a channel; the array keeps it, and it keeps the frame."""

    __slots__ = ("__array_interface__", "handle")

    def __init__(self, handle: FrameHandle, channel: Channel) -> None:
        self.handle = handle
        self.__array_interface__ = {
            "version": 3,
            "shape": (channel.rows, channel.columns),
            "typestr": _types[channel.type].str,
            "data": (channel.values, True),
        }


class LibrarySource:
    """A frame in the library's memory."""

    def __init__(self, handle: FrameHandle, objects: Sequence[str] = ()) -> None:
        self._handle = handle
        self._objects = objects  # their names, by object_id
        self._channels = self._read_channels()

    def _read_channels(self) -> Dict[str, Channel]:
        lib, handle = library(), self._handle.value
        count = ctypes.c_size_t()
        check(lib.pmdsim_frame_channel_count(handle, ctypes.byref(count)))
        found: Dict[str, Channel] = {}
        for index in range(count.value):
            channel = Channel(struct_size=ctypes.sizeof(Channel))
            check(lib.pmdsim_frame_channel(handle, index, ctypes.byref(channel)))
            found[channel.name.decode("utf-8")] = channel
        return found

    @property
    def names(self) -> Tuple[str, ...]:
        return tuple(self._channels)

    def array(self, name: str) -> NDArray[Any]:
        return np.asarray(_Memory(self._handle, self._channels[name]))

    def unit(self, name: str) -> str:
        return (self._channels[name].unit or b"").decode("utf-8")

    def report(self) -> Dict[str, Any]:
        text = ctypes.c_char_p()
        check(library().pmdsim_frame_report(self._handle.value, ctypes.byref(text)))
        report: Dict[str, Any] = json.loads(text.value or b"{}")
        if self._objects:
            report["objects"] = list(self._objects)
        return report

    def directions(self, shape: Tuple[int, int]) -> NDArray[np.float64]:
        values = np.empty((*shape, 3))
        check(library().pmdsim_frame_directions(self._handle.value, values.ctypes.data, values.size))
        return values


def is_pinhole(camera: Mapping[str, Any]) -> bool:
    """Whether the camera is its matrix alone."""
    return not any(camera.get("distortion") or ()) and not any(_tilt(camera)) and camera.get("model") != "fisheye"


def _tilt(camera: Mapping[str, Any]) -> List[float]:
    tilt = camera.get("tilt_rad") or ()
    return list(tilt) if isinstance(tilt, (list, tuple)) else [float(tilt)]


def pinhole_directions(camera: Mapping[str, Any], shape: Tuple[int, int]) -> NDArray[np.float64]:
    """Unit vectors through the pixels' centres, from the camera matrix."""
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    pixels = np.stack([columns, rows, np.ones(shape)], axis=-1).astype(np.float64)
    slopes = pixels @ np.linalg.inv(np.array(camera["camera_matrix"], dtype=np.float64)).T
    return slopes / np.linalg.norm(slopes, axis=-1, keepdims=True)


@lru_cache(maxsize=1)
def _units_by_name() -> Dict[str, str]:
    return {channel["name"]: channel["unit"] for channel in channels()}


def unit_of(name: str) -> str:
    """The unit of a channel of that name: "f1.tap3" has that of "tap"."""
    units = _units_by_name()
    base = re.sub(r"^f\d+\.", "", name)
    for known in (base, re.sub(r"\d+$", "", base), re.sub(r"\d+$", "0", base)):
        if known in units:
            return units[known]
    return {"deformation_mm": "mm"}.get(base, "")


class ArraySource:
    """A frame of arrays; `directions` only where they do not follow from the camera's matrix."""

    def __init__(
        self,
        arrays: Mapping[str, NDArray[Any]],
        units: Mapping[str, str],
        report: Dict[str, Any],
        directions: Optional[NDArray[np.float64]],
    ) -> None:
        self._arrays, self._units, self._report, self._directions = arrays, units, report, directions

    @property
    def names(self) -> Tuple[str, ...]:
        return tuple(self._arrays)

    def array(self, name: str) -> NDArray[Any]:
        view = self._arrays[name].view()
        view.flags.writeable = False
        return view

    def unit(self, name: str) -> str:
        return self._units[name] if name in self._units else unit_of(name)

    def report(self) -> Dict[str, Any]:
        return self._report

    def directions(self, shape: Tuple[int, int]) -> NDArray[np.float64]:
        if self._directions is not None:
            return self._directions
        return directions_of(self._report, shape)


def directions_of(report: Mapping[str, Any], shape: Tuple[int, int]) -> NDArray[np.float64]:
    """The directions of a camera without distortion, from its report."""
    camera = report.get("camera")
    if camera is None:
        raise ArgumentError("the frame was read from a file that does not tell of its camera; load its folder")
    if not is_pinhole(camera):
        raise ArgumentError(
            "the camera has distortion or tilt: the directions of a frame that was read follow from report['camera'] "
            "by OpenCV's undistortPoints, as the manifest's \"points\" says"
        )
    return pinhole_directions(camera, shape)


class FileSource:
    """A frame of which each channel is a .npy file, opened when it is asked for."""

    def __init__(self, files: Mapping[str, str], report: Dict[str, Any]) -> None:
        self._files, self._report = files, report

    @property
    def names(self) -> Tuple[str, ...]:
        return tuple(self._files)

    def array(self, name: str) -> NDArray[Any]:
        file = self._files[name]
        try:
            return np.lib.format.open_memmap(file, mode="r")
        except (OSError, ValueError, EOFError) as error:
            raise InputError(f"{file}: cannot be read: {error}", file) from None

    def unit(self, name: str) -> str:
        return unit_of(name)

    def report(self) -> Dict[str, Any]:
        return self._report

    def directions(self, shape: Tuple[int, int]) -> NDArray[np.float64]:
        return directions_of(self._report, shape)


class ReadSource(LibrarySource):
    """A frame that the library read from a file, with what the manifest says of it."""

    def __init__(self, handle: FrameHandle, report: Dict[str, Any]) -> None:
        super().__init__(handle)
        self._report = report

    def report(self) -> Dict[str, Any]:
        return self._report

    def directions(self, shape: Tuple[int, int]) -> NDArray[np.float64]:
        return directions_of(self._report, shape)
