"""A device with a setup, for many frames."""

from __future__ import annotations

import ctypes
import json
import os
import warnings
import weakref
from functools import partial
from typing import Any, Callable, Dict, Iterable, Iterator, List, Mapping, Optional, Set, TypeVar, Union

from ._calls import Caller
from ._errors import ArgumentError, Error, HandleError, warning_of
from ._frame import Frame
from ._frame_sources import FrameHandle, LibrarySource
from ._library import check, library
from ._options import Channels, Length, render_options
from ._scene import Scene
from ._setup import Setup
from ._setup_input import SetupInput, SetupLike, changes_of, name_file
from ._text import short, text_bytes
from ._values import json_text, pose_value, several, whole_number

Result = TypeVar("Result")
Device = Union[str, int]

_most = 2**32 - 1

# The process whose threads and devices the library has, once it has some.
_process: Optional[int] = None


def _refuse_after_fork() -> None:
    """A forked child has the memory of the library's threads but not the threads, and would wait for them forever."""
    global _process
    if _process is None:
        _process = os.getpid()
    if _process != os.getpid():
        raise HandleError(
            f"this process was forked from process {_process}, which had used pmdsim, whose threads a fork does not "
            "copy; start processes with multiprocessing's 'spawn' or 'forkserver'"
        )


def _device_name(device: Optional[Device]) -> Optional[bytes]:
    if device is None:
        return None
    if isinstance(device, str):
        return text_bytes(device, "device")
    return str(whole_number(device, "device", 0, _most)).encode()


def _cancel(handle: ctypes.c_void_p) -> None:
    if handle.value:
        library().pmdsim_simulator_cancel(handle)


def _destroy(handle: int, process: int, caller: Caller) -> None:
    if os.getpid() == process:
        caller.stop()
        library().pmdsim_simulator_destroy(handle)


class Simulator:
    """A device that measures frames of a setup, which can be changed between them.

    Parameters
    ----------
    setup : path, dict or pmdsim.Setup, optional
        What `load` takes; without it `load` has to be called before `render`.
    device : str or int, optional
        An index or a part of a name, as pmdsim.devices() has them; "cpu" or "gpu", the first of that kind; or
        "reference", the CPU in double precision, which is slow. By default the library chooses.
    scene : pmdsim.Scene, optional
        Triangles in place of the setup's scene.
    allow_outside : bool, optional
        As `load` takes it.

    Raises
    ------
    NoDeviceError
        No device of that name is usable.
    InputError
        The setup or a file that it names is wrong.
    HandleError
        This process was forked from one that had used pmdsim.

    Notes
    -----
    A simulator is a context manager, and closes itself when it is forgotten. Different simulators may be used by
    different threads at once; the GIL is released meanwhile. One simulator serves one thread at a time: another gets
    BusyError. Ctrl-C ends a call within a second, with KeyboardInterrupt.

    Examples
    --------
    >>> with pmdsim.Simulator("room.json") as simulator:                       # doctest: +SKIP
    ...     for focal_length_m in (0.01, 0.02):
    ...         simulator.set("sensors/0/focal_length_m", focal_length_m)
    ...         print(simulator.render().distance_m.mean())
    """

    def __init__(
        self,
        setup: Optional[SetupLike] = None,
        device: Optional[Device] = None,
        *,
        scene: Optional[Scene] = None,
        allow_outside: bool = False,
    ) -> None:
        self._handle = 0
        _refuse_after_fork()
        self._owner = os.getpid()
        name = _device_name(device)
        handle = ctypes.c_void_p()
        self._caller = Caller(partial(_cancel, handle))  # which does not hold the simulator
        try:
            self._caller(lambda: check(library().pmdsim_simulator_create(name, ctypes.byref(handle))))
        except BaseException:  # Ctrl-C may come when it is made
            self._caller.stop()
            library().pmdsim_simulator_destroy(handle)
            raise
        self._handle = handle.value or 0
        self._finalizer = weakref.finalize(self, _destroy, self._handle, self._owner, self._caller)
        self._described: Optional[Dict[str, Any]] = None
        self._warned: Set[str] = set()
        self._warned_of_frames: Set[str] = set()  # since the setup was loaded or changed
        self._setup_file = ""  # of a setup that was read here, and not by the library
        self._setup_directory = ""
        if setup is not None:
            try:
                self._load(setup, scene, allow_outside, stacklevel=3)
            except BaseException:
                self.close()
                raise
        elif scene is not None:
            self.close()
            raise ArgumentError("scene: expected a setup beside it")

    def __enter__(self) -> "Simulator":
        self._usable()
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        if not self._handle:
            return "<pmdsim.Simulator, closed>"
        told = self._described or {}
        sensors = ", ".join(told.get("sensors") or ["no setup"])
        return f"<pmdsim.Simulator on {told.get('device', 'a device')} of {sensors}>"

    def close(self) -> None:
        """Gives the device and the memory back; frames that were measured stay. Twice does no harm.

        A call that another thread is in goes on to its end, and memory and device are given back then; `cancel` before
        ends it soon.
        """
        handle, self._handle = self._handle, 0
        if not handle or self._owner != os.getpid() or not self._finalizer.alive:
            return
        if self._caller.lost:  # a call that cannot be ended still uses it
            self._finalizer.detach()
            return
        try:
            check(library().pmdsim_simulator_destroy(handle))
        except BaseException:
            self._handle = handle
            raise
        self._finalizer.detach()
        self._caller.stop()

    def _usable(self) -> int:
        """The handle."""
        if not self._handle:
            raise HandleError("the simulator is closed")
        if self._owner != os.getpid():
            raise HandleError(f"the simulator belongs to process {self._owner}; make one in this process")
        if self._caller.lost:
            raise HandleError("the simulator was given up, since a call that was cancelled did not end")
        return self._handle

    def cancel(self) -> None:
        """Ends the call that another thread is in, soon, with CancelledError. Nothing happens where none is."""
        check(library().pmdsim_simulator_cancel(self._usable()))

    def _end_call(self) -> None:
        """As cancel(), and nothing where there is no simulator any more."""
        library().pmdsim_simulator_cancel(self._handle)

    def __reduce__(self) -> Any:
        raise TypeError("a simulator belongs to its process and cannot be pickled; make one in each")

    def _call(self, function: Callable[[], Result], setup_file: str) -> Result:
        """`setup_file` is that of the setup that errors may tell of."""
        try:
            return self._caller(function)
        except Error as error:
            name_file(error, setup_file)
            raise

    def load(self, setup: SetupLike, *, scene: Optional[Scene] = None, allow_outside: bool = False) -> None:
        """Takes a setup in place of the one before; changes that were set are gone.

        Parameters
        ----------
        setup : path, dict or pmdsim.Setup
            A setup file, or the same as dicts (docs/setup.md has the keys), whose relative paths start at
            `Setup.directory`, else at the process's. "scene" may be a pmdsim.Scene.
        scene : pmdsim.Scene, optional
            Triangles in place of the setup's "scene". Poses at nodes are an error then.
        allow_outside : bool, optional
            Whether files that the scene names may lie outside of its folder: for scenes that you trust.

        Raises
        ------
        InputError
            The setup or a file that it names is wrong. The setup from before stays.
        ArgumentError
            A value is none that JSON has, such as NaN.
        """
        self._load(setup, scene, allow_outside, stacklevel=3)

    def _load(self, setup: SetupLike, scene: Optional[Scene], allow_outside: bool, stacklevel: int) -> None:
        handle = self._usable()
        given = SetupInput(setup, scene)

        def take() -> None:
            check(library().pmdsim_simulator_allow_outside(handle, int(bool(allow_outside))))
            given.load(handle)

        self._call(take, given.file)
        self._setup_file, self._setup_directory = given.file, given.directory
        self._described = None
        self._warned = set()
        self._warned_of_frames = set()
        self._warn(stacklevel + 1)

    def set(self, path: Union[str, Mapping[str, Any]], value: Any = None) -> None:
        """Changes the setup: `set(path, value)`, or several at once, `set({path: value, ...})`.

        Parameters
        ----------
        path : str or dict
            A path is a JSON pointer into the setup, with or without its first slash; the name of an element may
            stand for its index: "sensors/pmd/focal_length_m", "illuminators/0/diodes/rings/0/radius_m". A number in
            it is always an index.
        value : numbers, text, lists, dicts, numpy arrays
            What stands there from now on. A pose may be what `move` takes.

        Raises
        ------
        InputError
            The changed setup is wrong. All changes are taken together, or none.
        ArgumentError
            A path is no text, or a value is none that JSON has.

        Notes
        -----
        Changes stay until the next load. Scene files are not read again.
        """
        if isinstance(path, str):
            path = {path: value}
        elif value is not None:
            raise ArgumentError("set: expected a path and a value, or a dict of them alone")
        self._set(path, stacklevel=4)

    def _set(self, changes: Mapping[str, Any], stacklevel: int) -> None:
        handle = self._usable()
        text = json_text(changes_of(changes), "set").encode("utf-8")
        self._call(lambda: check(library().pmdsim_simulator_set(handle, text)), self._setup_file)
        self._described = None
        self._warned_of_frames = set()
        self._warn(stacklevel)

    def move(
        self,
        *,
        pose: Any,
        node: Optional[str] = None,
        sensor: Optional[Union[str, int]] = None,
        illuminator: Optional[Union[str, int]] = None,
    ) -> None:
        """Puts a node of the scene, a sensor or an illuminator elsewhere.

        Parameters
        ----------
        pose : array_like (4, 4), or (position, quaternion), or dict
            World from the frame of what is moved, metres: a matrix, or a position and a quaternion (x, y, z, w); or a
            pose as setups have it. A node's frame is glTF's; a sensor's and an illuminator's is x right, y down, z
            forward. A node keeps its scale, and its children go with it.
        node : str
            The node's name. One of `node`, `sensor` and `illuminator` is needed.
        sensor, illuminator : str or int
            Its name or index.

        Raises
        ------
        ArgumentError
            The pose's shape is wrong, or a number in it is not finite; or there is no sensor or illuminator of that
            name.
        InputError
            There is no such node or index, or the matrix does more than turn and move.
        """
        named = {"nodes": node, "sensors": sensor, "illuminators": illuminator}
        given = [(part, name) for part, name in named.items() if name is not None]
        if len(given) != 1:
            raise ArgumentError("move: expected one of node, sensor and illuminator")
        part, name = given[0]
        element = _escaped(name) if part == "nodes" else self._index(part, name)
        self._set({f"{part}/{element}/pose": pose_value(pose)}, stacklevel=4)

    def _warn(self, stacklevel: int) -> None:
        for told in self._description().get("warnings", ()):
            warning = warning_of(told)
            if str(warning) not in self._warned:
                self._warned.add(str(warning))
                warnings.warn(warning, stacklevel=stacklevel)

    def _description(self) -> Dict[str, Any]:
        if self._described is None:
            handle = self._usable()

            def describe() -> Dict[str, Any]:
                text = ctypes.c_char_p()
                check(library().pmdsim_simulator_describe(handle, ctypes.byref(text)))
                return json.loads(text.value or b"{}")

            self._described = self._call(describe, self._setup_file)
        return self._described

    @property
    def device(self) -> str:
        """The device's name."""
        return self._told("device")

    @property
    def driver(self) -> str:
        """The driver's name and version."""
        return self._told("driver")

    @property
    def sensors(self) -> List[str]:
        """The sensors' names; none without a setup."""
        return list(self._told("sensors") or ())

    @property
    def objects(self) -> Dict[int, str]:
        """The names of the scene's objects by their ids, as object_id has them; none without a setup."""
        return dict(enumerate(self._told("objects") or ()))

    @property
    def frame_count(self) -> int:
        """The number of frames that the setup has; 0 without one."""
        return int(self._told("frames") or 0)

    @property
    def setup(self) -> Optional[Setup]:
        """The setup as used, with all changes and defaults and its directory; a copy. None without a setup."""
        setup = self._told("setup")
        return None if setup is None else Setup(setup, directory=self._setup_directory)

    def _told(self, key: str) -> Any:
        self._usable()
        return self._description().get(key)

    def _index(self, part: str, element: Any) -> int:
        """The index of one of the "sensors" or "illuminators" by name or index."""
        what = part[: -len("s")]
        if not isinstance(element, str):
            return whole_number(element, what, 0, _most)
        names = [described["name"] for described in (self._told("setup") or {}).get(part, ())]
        if element not in names:
            raise ArgumentError(f"{what}: expected one of {', '.join(names) or 'a setup'}, found {short(element)}")
        return names.index(element)

    def render(
        self,
        *,
        sensor: Union[int, str] = 0,
        frame: int = 0,
        mode: Optional[str] = None,
        max_error: Optional[Length] = None,
        max_amplitude_error: Optional[float] = None,
        precision: Optional[str] = None,
        samples: Optional[Union[int, str]] = None,
        channels: Optional[Channels] = None,
        paths: Optional[int] = None,
        strict: bool = False,
        output_precision: Optional[str] = None,
    ) -> Frame:
        """Measures one frame of one sensor. `pmdsim.render` explains the arguments and errors.

        Returns
        -------
        Frame
            Its arrays stay when the simulator is changed or closed.
        """
        options = render_options(
            mode, max_error, max_amplitude_error, precision, samples, channels, paths, strict, output_precision
        )
        return self._render(sensor, frame, options, stacklevel=3)

    def _render(self, sensor: Union[int, str], frame: int, options: Any, stacklevel: int) -> Frame:
        handle = self._usable()
        sensor_index = self._index("sensors", sensor)
        frame_index = whole_number(frame, "frame", 0, _most)

        def measure() -> FrameHandle:
            result = ctypes.c_void_p()
            check(
                library().pmdsim_render(handle, sensor_index, frame_index, ctypes.byref(options), ctypes.byref(result))
            )
            return FrameHandle(result.value or 0)

        measured = Frame(LibrarySource(self._call(measure, self._setup_file), self._told("objects") or ()))
        for told in measured.report.get("warnings", ()):
            key = f"{told['code']} {told['place']}"  # the text has the frame's own figures
            if key not in self._warned_of_frames:
                self._warned_of_frames.add(key)
                warnings.warn(warning_of(told), stacklevel=stacklevel)
        return measured

    def frames(
        self,
        *,
        sensors: Optional[Union[int, str, Iterable[Union[int, str]]]] = None,
        frames: Optional[Union[int, Iterable[int]]] = None,
        **options: Any,
    ) -> Iterator[Frame]:
        """Measures frame after frame, of every sensor each.

        Parameters
        ----------
        sensors : int or str, or iterable of these, optional
            Indices or names; by default all.
        frames : int or iterable of int, optional
            Numbers, e.g. range(10, 20); by default all that the setup has.
        **options
            As for `render`.

        Yields
        ------
        Frame
            Frame 0 of each sensor, then frame 1, ...; `frame.sensor` and `frame.frame` tell which.
        """
        prepared = render_options(**options)
        wanted = self.sensors if sensors is None else several(sensors)
        numbers = range(self.frame_count) if frames is None else several(frames)
        chosen = [self._index("sensors", sensor) for sensor in wanted]
        return self._measured_in_turn(chosen, [whole_number(n, "frames", 0, _most) for n in numbers], prepared)

    def _measured_in_turn(self, sensors: List[int], frames: Iterable[int], options: Any) -> Iterator[Frame]:
        for frame in frames:
            for sensor in sensors:
                yield self._render(sensor, frame, options, stacklevel=3)


def _escaped(node: Any) -> str:
    """A name as a part of a JSON pointer."""
    if not isinstance(node, str):
        raise ArgumentError(f"node: expected a name, found {short(node)}")
    return node.replace("~", "~0").replace("/", "~1")
