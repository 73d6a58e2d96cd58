"""What `pmdsim render` wrote."""

from __future__ import annotations

import ctypes
import json
import os
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ._errors import ArgumentError, InputError
from ._files import file_bytes, file_name
from ._frame import Frame
from ._frame_sources import ArraySource, FileSource, FrameHandle, ReadSource
from ._library import check, library
from ._text import short

if TYPE_CHECKING:
    import xarray


def _arrays_of_npz(file: str) -> Dict[str, NDArray[Any]]:
    try:
        with open(file, "rb") as stream:
            # numpy takes what is no archive for something else, and says so.
            if stream.read(2) != b"PK":
                raise zipfile.BadZipFile("it begins otherwise")
            stream.seek(0)
            with np.load(stream, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
    except (OSError, ValueError, EOFError, KeyError) as error:
        raise InputError(f"{file}: cannot be read: {error}", file) from None
    except Exception as error:  # zipfile.BadZipFile and zlib.error
        raise InputError(f"{file}: expected a .npz file: {error}", file) from None


def _saved_report(text: str, file: str) -> Dict[str, Any]:
    try:
        report = json.loads(text)
    except (ValueError, RecursionError):
        report = None
    if not isinstance(report, dict):
        raise InputError(f'{file}: expected "report" to be a JSON object, found {short(text)}', file)
    return report


def _read_npz(file: str, report: Dict[str, Any]) -> Frame:
    arrays = _arrays_of_npz(file)
    saved = arrays.pop("report", None)
    if saved is not None and not report:
        report = _saved_report(str(saved), file)
    directions = arrays.pop("directions", None)
    images = {name: array for name, array in arrays.items() if array.ndim == 2}
    if not images:
        raise InputError(f"{file}: expected channels of rows and columns, found none", file)
    return Frame(ArraySource(images, {}, report, directions))


def _read_by_library(file: str, report: Dict[str, Any]) -> Frame:
    handle = ctypes.c_void_p()
    check(library().pmdsim_frame_read(file_bytes(file, "path"), ctypes.byref(handle)))
    return Frame(ReadSource(FrameHandle(handle.value or 0), report))


_readers: Dict[str, Callable[[str, Dict[str, Any]], Frame]] = {
    ".npz": _read_npz,
    ".h5": _read_by_library,
    ".exr": _read_by_library,
}


class _Frames(Sequence[Frame]):
    """Frames that are read when they are asked for."""

    def __init__(self, recording: "Recording") -> None:
        self._recording = recording

    def __len__(self) -> int:
        return len(self._recording._entries)

    def __getitem__(self, index: Any) -> Any:
        entries = self._recording._entries[index]
        if isinstance(index, slice):
            return [self._recording._read(entry) for entry in entries]
        return self._recording._read(entries)

    def __repr__(self) -> str:
        return f"<{len(self)} frames of {self._recording!r}>"


class Recording:
    """A folder that `pmdsim render` or `pmdsim deform` wrote; `pmdsim.load` makes it.

    Attributes
    ----------
    folder : str
    manifest : dict
        docs/outputs.md, "The manifest".
    sensors : list of str
        The sensors' names, in the manifest's order.
    objects : dict of int to str
        The names of the scene's objects by their ids, as object_id has them.
    frames : sequence of Frame
        All frames of all sensors in the manifest's order, each read when it is asked for. Of .npy files each channel
        is mapped into memory, and read when it is used.

    Examples
    --------
    >>> recording = pmdsim.load("out/room/render")                        # doctest: +SKIP
    >>> recording["pmd", 0].distance_m                                    # doctest: +SKIP
    >>> recording.stack("distance_m").shape                               # doctest: +SKIP
    (40, 320, 320)
    """

    def __init__(self, folder: Union[str, "os.PathLike[str]"]) -> None:
        self.folder = file_name(folder, "folder")
        self.manifest: Dict[str, Any] = _read_manifest(self.folder)
        self._entries: List[Dict[str, Any]] = self.manifest["frames"]
        self.objects: Dict[int, str] = _objects_of(self.manifest, self.folder)
        self.sensors: List[str] = list(dict.fromkeys(entry["sensor"] for entry in self._entries))
        self._by_key = {(entry["sensor"], entry["frame"]): entry for entry in self._entries}

    @property
    def frames(self) -> "_Frames":
        return _Frames(self)

    def __len__(self) -> int:
        return len(self._entries)

    def __iter__(self) -> Iterator[Frame]:
        return iter(self.frames)

    def __repr__(self) -> str:
        return f"<pmdsim.Recording {self.folder}: {len(self)} frames of {', '.join(self.sensors)}>"

    def __getitem__(self, key: Tuple[Union[int, str], int]) -> Frame:
        """The frame of a sensor (name or index) and a number: `recording["pmd", 0]`.

        Raises
        ------
        ArgumentError
            There is no such frame.
        InputError
            A file of it is missing or wrong.
        """
        if not isinstance(key, tuple) or len(key) != 2:
            raise ArgumentError(f"expected recording[sensor, frame], found {short(key)}")
        sensor, number = self._sensor_name(key[0]), key[1]
        if not isinstance(number, (int, np.integer)) or (sensor, number) not in self._by_key:
            numbers = self._numbers(sensor)
            raise ArgumentError(f"{self.folder}: {sensor} has {len(numbers)} frames, but no frame {short(number)}")
        return self._read(self._by_key[sensor, number])

    def _sensor_name(self, sensor: Union[int, str]) -> str:
        if isinstance(sensor, str) and sensor in self.sensors:
            return sensor
        if isinstance(sensor, (int, np.integer)) and 0 <= sensor < len(self.sensors):
            return self.sensors[sensor]
        if not self.sensors:
            raise ArgumentError(f"{self.folder}: there are no frames")
        raise ArgumentError(
            f"{self.folder}: expected one of the sensors {', '.join(self.sensors)}, found {short(sensor)}"
        )

    def _numbers(self, sensor: str) -> List[int]:
        return sorted(number for name, number in self._by_key if name == sensor)

    def _read(self, entry: Dict[str, Any]) -> Frame:
        files = [os.path.join(self.folder, name) for name in entry.get("outputs", ())]
        entry = {**entry, "objects": list(self.objects.values())} if self.objects else entry
        arrays = {_channel_of(file, entry): file for file in files if file.endswith(".npy")}
        if arrays:
            return Frame(FileSource(arrays, entry))
        for ending, read in _readers.items():
            for file in files:
                if file.endswith(ending):
                    return read(file, entry)
        raise InputError(
            f"{self.folder}: frame {entry['frame']} of {entry['sensor']} was written in no format that has its values; "
            "expected npy, npz, h5 or exr",
            self.folder,
        )

    def stack(self, channel: str, sensor: Union[int, str] = 0) -> NDArray[Any]:
        """One channel of all frames of a sensor.

        Returns
        -------
        array (frames, rows, columns)
            In the order of the frames' numbers.
        """
        name = self._sensor_name(sensor)
        numbers = self._numbers(name)
        first = self[name, numbers[0]][channel]
        stacked = np.empty((len(numbers), *first.shape), dtype=first.dtype)
        for index, number in enumerate(numbers):
            stacked[index] = first if index == 0 else self[name, number][channel]
        return stacked

    def to_xarray(self, sensor: Union[int, str] = 0) -> "xarray.Dataset":
        """All channels of all frames of a sensor as xarray.Dataset with the dimensions frame, row and column.

        The coordinates are `frame`, the number, and `time_s`.

        Raises
        ------
        ImportError
            xarray is not installed.
        """
        import xarray

        name = self._sensor_name(sensor)
        numbers = self._numbers(name)
        units = self[name, numbers[0]].units
        variables = {
            channel: (("frame", "row", "column"), self.stack(channel, name), {"units": unit})
            for channel, unit in units.items()
        }
        times = [self._by_key[name, number].get("time_s", np.nan) for number in numbers]
        return xarray.Dataset(variables, coords={"frame": numbers, "time_s": ("frame", times)}, attrs={"sensor": name})


def _objects_of(manifest: Mapping[str, Any], folder: str) -> Dict[int, str]:
    """Earlier versions named no objects."""
    try:
        return {index: str(of["name"]) for index, of in enumerate(manifest.get("objects", ()))}
    except (KeyError, TypeError) as error:
        file = os.path.join(folder, "manifest.json")
        raise InputError(f"{file}: /objects: expected a list of objects with names", file, "/objects") from error


def _channel_of(file: str, entry: Mapping[str, Any]) -> str:
    """ "distance_m" of SENSOR_FRAME.distance_m.npy, where the sensor's name may have dots, too."""
    begin = f"{entry['sensor']}_{entry['frame']:04d}."
    name = os.path.basename(file)[: -len(".npy")]
    return name[len(begin) :] if name.startswith(begin) else name.split(".", 1)[-1]


def _read_manifest(folder: str) -> Dict[str, Any]:
    file = os.path.join(folder, "manifest.json")
    try:
        manifest = json.loads(Path(file).read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(f"{file}: there is no such file; expected a folder that pmdsim render wrote", file) from None
    except (OSError, ValueError) as error:
        raise InputError(f"{file}: cannot be read: {error}", file) from None
    frames = manifest.get("frames") if isinstance(manifest, dict) else None
    if not isinstance(frames, list) or not all(map(_is_entry, frames)):
        raise InputError(f'{file}: expected a manifest with "frames"', file, "/frames")
    return manifest


def _is_entry(entry: Any) -> bool:
    return (
        isinstance(entry, dict)
        and isinstance(entry.get("sensor"), str)
        and isinstance(entry.get("frame"), int)
        and isinstance(entry.get("outputs", []), list)
        and all(isinstance(name, str) for name in entry.get("outputs", []))
    )


def load(path: Union[str, "os.PathLike[str]"]) -> Union[Recording, Frame]:
    """What `pmdsim render` wrote: a folder, or one file of it.

    Parameters
    ----------
    path : path
        A folder with a manifest.json, whatever the format; or a .npz, .h5 or .exr file.

    Returns
    -------
    Recording
        Of a folder: its frames by sensor and number, read when they are asked for.
    Frame
        Of a file. Without the manifest only a file that Frame.save() wrote knows its report.

    Raises
    ------
    InputError
        The folder or file is missing or wrong.
    ArgumentError
        No file can have that name.

    Examples
    --------
    >>> for frame in pmdsim.load("out/room/render").frames:               # doctest: +SKIP
    ...     print(frame.sensor, frame.frame, frame.amplitude.max())
    """
    name = file_name(path, "path")
    if os.path.isdir(name):
        return Recording(name)
    reader: Optional[Callable[[str, Dict[str, Any]], Frame]] = _readers.get(os.path.splitext(name)[1].lower())
    if not os.path.exists(name):
        raise InputError(f"{name}: there is no such file or folder", name)
    if reader is None:
        raise InputError(f"{name}: expected a folder, or a .npz, .h5 or .exr file", name)
    return reader(name, {})
