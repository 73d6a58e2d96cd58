"""Frames: named arrays with units and a report."""

from __future__ import annotations

import copy
import json
import os
import re
import zipfile
from typing import TYPE_CHECKING, Any, BinaryIO, Dict, Iterator, List, Optional, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ._errors import ArgumentError, UnknownChannelError
from ._files import file_name, write_whole
from ._frame_sources import ArraySource, Source, is_pinhole

if TYPE_CHECKING:
    import xarray

_frequency = re.compile(r"f\d+")


class FrequencyChannels:
    """The channels of one of several frequencies: `frame.f0.distance_m` is `frame["f0.distance_m"]`."""

    __slots__ = ("_frame", "_prefix")

    def __init__(self, frame: "Frame", prefix: str) -> None:
        self._frame, self._prefix = frame, prefix

    @property
    def channels(self) -> Tuple[str, ...]:
        """The channels' names without the prefix."""
        begin = self._prefix + "."
        return tuple(name[len(begin) :] for name in self._frame.channels if name.startswith(begin))

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self._frame[f"{self._prefix}.{name}"]

    def __getattr__(self, name: str) -> NDArray[Any]:
        if name.startswith("_"):
            raise AttributeError(name)
        return self[name]

    def __dir__(self) -> List[str]:
        return sorted({*super().__dir__(), *self.channels})

    def __repr__(self) -> str:
        return f"<{self._prefix} of {self._frame!r}: {', '.join(self.channels)}>"


class Frame:
    """What one sensor measured at one time: named arrays.

    Every channel is an array of shape (rows, columns), row 0 at the top, float32 or uint32 (distances float64 where that
    was asked for), read-only: an attribute where its name is one (`frame.distance_m`), and an item
    (`frame["distance_m"]`). With several modulation frequencies those that each has are `frame.f0.distance_m`,
    `frame["f0.distance_m"]`, and so on. `frame.channels` names them; docs/outputs.md, "Channels", explains them. Floats
    are NaN where nothing was measured, ids 4294967295.

    Arrays of a frame that was just measured are views of the library's memory, without a copy; they keep it alive as
    long as one of them lives. Copying and pickling a frame copies its arrays.

    Attributes
    ----------
    channels : tuple of str
    units : dict of str
        Of each channel: "m", "rad", "W/(m² sr)", ...; "" for ids and shares.
    shape : (rows, columns)
    report : dict
        What the manifest says of a frame: sensor, frame, time_s, camera, mode, errors claimed and found, times.
    sensor : str
    frame : int
    time_s : float
    camera : dict
        As OpenCV has it: "camera_matrix", "distortion", "world_from_camera" (4 x 4, camera frame x right, y down, z
        forward), ...
    objects : dict of int to str
        The names of the scene's objects by their ids: `frame.objects[frame.object_id[row, column]]`.
    directions : float64 (rows, columns, 3)
        Unit vectors from the lens through the pixels' centres, camera frame.
    normals : float64 (rows, columns, 3)
        Unit vectors, camera frame, turned to the lens, of what the pixels' central samples see; NaN where that is
        nothing. ArgumentError unless `channels` asked for "normals".
    points_m : float64 (rows, columns, 3)
        Where the measured distance lies along them, world frame, metres; NaN where nothing returned. Of several
        frequencies `unwrapped_distance_m`; ArgumentError where there is none, or no distance.
    """

    __slots__ = ("_source", "_arrays", "_report", "_directions", "__weakref__")

    def __init__(self, source: Source) -> None:
        self._source = source
        self._arrays: Dict[str, NDArray[Any]] = {}
        self._report: Optional[Dict[str, Any]] = None
        self._directions: Optional[NDArray[np.float64]] = None

    @property
    def channels(self) -> Tuple[str, ...]:
        return self._source.names

    @property
    def units(self) -> Dict[str, str]:
        return {name: self._source.unit(name) for name in self.channels}

    @property
    def shape(self) -> Tuple[int, int]:
        rows, columns = self[self.channels[0]].shape
        return rows, columns

    @property
    def report(self) -> Dict[str, Any]:
        if self._report is None:
            self._report = self._source.report()
        return self._report

    @property
    def sensor(self) -> str:
        return self._reported("sensor")

    @property
    def frame(self) -> int:
        return self._reported("frame")

    @property
    def time_s(self) -> float:
        return self._reported("time_s")

    @property
    def camera(self) -> Dict[str, Any]:
        return self._reported("camera")

    @property
    def objects(self) -> Dict[int, str]:
        return dict(enumerate(self._reported("objects")))

    def _reported(self, key: str) -> Any:
        if key not in self.report:
            raise ArgumentError(f"{key}: the frame was read from a file that does not tell; load its folder")
        return self.report[key]

    @property
    def directions(self) -> NDArray[np.float64]:
        if self._directions is None:
            directions = self._source.directions(self.shape)
            directions.flags.writeable = False
            self._directions = directions
        return self._directions

    @property
    def normals(self) -> NDArray[np.float64]:
        names = ["normal_x", "normal_y", "normal_z"]
        missing = [name for name in names if name not in self.channels]
        if missing:
            raise ArgumentError(f'normals: the frame has no {", ".join(missing)}; ask for channels="all,normals"')
        return np.stack([self[name].astype(np.float64) for name in names], axis=-1)

    @property
    def points_m(self) -> NDArray[np.float64]:
        return self.points_of(self._distance_channel())

    def points_of(self, channel: str) -> NDArray[np.float64]:
        """The points that a channel of radial distances means.

        Parameters
        ----------
        channel : str
            "distance_m", "f1.distance_m", "range_m", "unwrapped_distance_m", ...; metres from the lens.

        Returns
        -------
        float64 (rows, columns, 3)
            World frame, metres; NaN where the distance is.
        """
        world = np.array(self.camera["world_from_camera"], dtype=np.float64)
        points = self.directions * self[channel][..., np.newaxis].astype(np.float64)
        return points @ world[:3, :3].T + world[:3, 3]

    def _distance_channel(self) -> str:
        distances = [name for name in self.channels if re.fullmatch(r"(f\d+\.)?distance_m", name)]
        if len(distances) > 1 and "unwrapped_distance_m" in self.channels:
            return "unwrapped_distance_m"
        if len(distances) != 1:
            # No AttributeError, after which Python would ask for a channel points_m.
            raise ArgumentError(
                f"points_m: the frame has {', '.join(distances) or 'no distance_m'}; "
                "points_of(channel) takes any distance"
            )
        return distances[0]

    def __getitem__(self, name: str) -> NDArray[Any]:
        array = self._arrays.get(name)
        if array is None:
            if name not in self._source.names:
                raise self._unknown(name)
            array = self._arrays[name] = self._source.array(name)
        return array

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if _frequency.fullmatch(name) and any(channel.startswith(name + ".") for channel in self.channels):
            return FrequencyChannels(self, name)
        return self[name]

    def _unknown(self, name: str) -> UnknownChannelError:
        of_frequencies = [channel for channel in self.channels if channel.endswith(f".{name}")]
        if of_frequencies:
            return UnknownChannelError(
                f"{name}: the sensor has several frequencies; expected {' or '.join(of_frequencies)}"
            )
        return UnknownChannelError(f"{name}: there is no such channel; the frame has {', '.join(self.channels)}")

    def __contains__(self, name: object) -> bool:
        return name in self.channels

    def __iter__(self) -> Iterator[str]:
        return iter(self.channels)

    def __len__(self) -> int:
        return len(self.channels)

    def keys(self) -> Tuple[str, ...]:
        """The channels' names."""
        return self.channels

    def items(self) -> Iterator[Tuple[str, NDArray[Any]]]:
        """The channels' names and arrays."""
        return ((name, self[name]) for name in self.channels)

    def __dir__(self) -> List[str]:
        names = {name.split(".")[0] for name in self.channels}
        return sorted({*super().__dir__(), *names})

    def __repr__(self) -> str:
        rows, columns = self.shape
        of = f" {self.report['frame']} of {self.report['sensor']}" if "sensor" in self.report else ""
        return f"<pmdsim.Frame{of}: {columns} x {rows} pixels, {', '.join(self.channels)}>"

    def _kept_directions(self) -> Optional[NDArray[np.float64]]:
        """Those that do not follow from the camera's matrix."""
        if "camera" not in self.report or is_pinhole(self.report["camera"]):
            return None
        try:
            return self.directions
        except ArgumentError:
            return None

    def __copy__(self) -> "Frame":
        return copy.deepcopy(self)

    def __reduce__(self) -> Tuple[Any, ...]:
        return _restored, (dict(self.items()), self.units, self.report, self._kept_directions())

    def save(self, file: Union[str, "os.PathLike[str]"]) -> None:
        """Writes all channels and the report into one .npz file, whole or not at all.

        `pmdsim.load(file)` reads it again, and `numpy.load(file)` does: its keys are the channels, and "report",
        which is JSON text.

        Raises
        ------
        ArgumentError
            The name does not end in .npz, or no file can have it.
        OutputError
            The file cannot be written.
        """
        name = file_name(file, "file")
        if not name.endswith(".npz"):
            raise ArgumentError(f"{name}: expected a name that ends in .npz")
        arrays = dict(self.items())
        arrays["report"] = np.array(json.dumps(self.report))
        directions = self._kept_directions()
        if directions is not None:
            arrays["directions"] = directions
        write_whole(name, lambda stream: _write_npz(stream, arrays))

    def to_xarray(self) -> "xarray.Dataset":
        """The channels as xarray.Dataset with the dimensions row and column and each channel's units.

        Raises
        ------
        ImportError
            xarray is not installed.
        """
        import xarray

        variables = {
            name: (("row", "column"), array, {"units": self._source.unit(name)}) for name, array in self.items()
        }
        attributes = {key: self.report[key] for key in ("sensor", "frame", "time_s") if key in self.report}
        return xarray.Dataset(variables, attrs=attributes)


def _write_npz(stream: BinaryIO, arrays: Dict[str, NDArray[Any]]) -> None:
    """As numpy.savez, which leaves the archive open where the disk is full."""
    with zipfile.ZipFile(stream, "w") as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as entry:
                np.lib.format.write_array(entry, array, allow_pickle=False)


def _restored(
    arrays: Dict[str, NDArray[Any]],
    units: Dict[str, str],
    report: Dict[str, Any],
    directions: Optional[NDArray[np.float64]],
) -> Frame:
    return Frame(ArraySource(arrays, units, report, directions))
