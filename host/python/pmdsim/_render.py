"""One frame of one setup, in one call."""

from __future__ import annotations

import os
import threading
from typing import Any, Mapping, Optional, Tuple, Union

from ._errors import DeviceLostError, Error, InternalError
from ._frame import Frame
from ._options import Channels, Length, render_options
from ._scene import Scene
from ._setup_input import SetupLike
from ._simulator import Device, Simulator

_Key = Tuple[Optional[Device], int]

# One simulator that nobody uses now, so that calls in a loop do not make a device each.
_lock = threading.Lock()
_idle: Optional[Tuple[_Key, Simulator]] = None


def _take(key: _Key) -> Optional[Simulator]:
    global _idle
    with _lock:
        if _idle is None or _idle[0] != key:
            return None
        simulator = _idle[1]
        _idle = None
        return simulator


def _give(key: _Key, simulator: Simulator) -> None:
    global _idle
    with _lock:
        before, _idle = _idle, (key, simulator)
    if before is not None:
        before[1].close()


def render(
    setup: SetupLike,
    *,
    sensor: Union[int, str] = 0,
    frame: int = 0,
    device: Optional[Device] = None,
    mode: Optional[str] = None,
    max_error: Optional[Length] = None,
    max_amplitude_error: Optional[float] = None,
    precision: Optional[str] = None,
    samples: Optional[Union[int, str]] = None,
    channels: Optional[Channels] = None,
    paths: Optional[int] = None,
    strict: bool = False,
    output_precision: Optional[str] = None,
    set: Optional[Mapping[str, Any]] = None,
    scene: Optional[Scene] = None,
    allow_outside: bool = False,
) -> Frame:
    """Measures one frame of a setup: the same bits as `pmdsim render` writes.

    Parameters
    ----------
    setup : path, dict or pmdsim.Setup
        A setup file, or the same as dicts; docs/setup.md has the keys. Relative paths start at the file's folder, at
        `Setup.directory`, or, of a dict, at the process's directory. "scene" may be a pmdsim.Scene.
    sensor : int or str, optional
        Index or name of the sensor, the first by default.
    frame : int, optional
        Number of the frame, from 0.
    device : str or int, optional
        An index or a part of a name, as pmdsim.devices() has them; "cpu" or "gpu"; "reference", the CPU in double
        precision. By default the library chooses.
    mode : "exact", "reduced" or "auto", optional
        exact: every diode at every sample; reduced: few weighted diodes for all; auto: the cheapest that keeps the
        error. By default exact, or auto where an error is given.
    max_error : str or float, optional
        Largest error of distance, "10um", "0.1mm", or a number of metres.
    max_amplitude_error : float, optional
        Largest error of amplitude, relative, above 0, at most 1; any by default.
    precision : "fp32" or "fp64", optional
        Of the sum over the diodes; chosen by default.
    samples : int or "auto", optional
        S of S x S samples a pixel, 1 to 16; the setup's by default.
    channels : list of str, or str with commas, optional
        Names of channels ("distance_m", "range_m", ...), such as another frame's `channels`; all by default. Of
        several frequencies "distance_m" is that of each, "f1.distance_m" that of one. "tap", and likewise "tap3", is
        all taps. "all" is every channel but "normals" and "rays", which frames have only on demand. What only others need is not computed.
    paths : int, optional
        Of the reference, for each pixel where light bounces.
    strict : bool, optional
        Every warning of the setup and of the frame is an error: InputError, or AccuracyError where pixels may be off
        by more than was asked for, which else have the channel `error_bound_m`.
    output_precision : "float32" or "float64", optional
        Of distances and `range_m`, float32 by default. float64 keeps what rounding takes: a float32 at 2 m has steps of
        0.24 um.
    set : dict, optional
        Changes of the setup, as Simulator.set() takes them: {"sensors/0/focal_length_m": 0.02}.
    scene : pmdsim.Scene, optional
        Triangles in place of the setup's scene.
    allow_outside : bool, optional
        Whether files that the scene names may lie outside of its folder: for scenes that you trust.

    Returns
    -------
    Frame
        Named arrays (rows, columns), row 0 at the top, SI units, read-only: `frame.distance_m` (metres, from the lens
        along each pixel's ray, wrapped at the ambiguity range), `frame.amplitude` (W/(m² sr)), `frame.phase_rad`,
        `frame.range_m` (the true distance), ...; `frame.points_m` (rows, columns, 3), world frame, metres (glTF's:
        right-handed, +Y up); `frame.report`, a dict. NaN where nothing returned. With several modulation frequencies
        `frame.f0.distance_m`, `frame.f1.distance_m`, ...

    Raises
    ------
    InputError
        The setup, its scene or another file is wrong; `error.file` and `error.place` (a JSON pointer) tell where.
    ArgumentError
        An argument is wrong, such as a sensor or frame that the setup does not have.
    NoDeviceError, OutOfMemoryError, DeviceLostError
        Of the device.
    AccuracyError
        The accuracy asked for cannot be reached.
    KeyboardInterrupt
        Ctrl-C, within a second.

    Warns
    -----
    PmdsimWarning
        What the setup and the frame warn of.

    See Also
    --------
    Simulator : for many frames of one setup; it is faster, since nothing is read again.
    sweep : for many variants of a setup.

    Notes
    -----
    Threads may call it at once. The last device and scene are kept for the next call until the process ends.

    Examples
    --------
    >>> frame = pmdsim.render("room.json", max_error="10um")                    # doctest: +SKIP
    >>> frame.distance_m.shape, frame.units["distance_m"]                       # doctest: +SKIP
    ((320, 320), 'm')
    """
    options = render_options(
        mode, max_error, max_amplitude_error, precision, samples, channels, paths, strict, output_precision
    )
    key = (device, os.getpid())
    simulator = _take(key) or Simulator(device=device)
    try:
        simulator._load(setup, scene, allow_outside, stacklevel=3)
        if set is not None:
            simulator._set(set, stacklevel=4)
        measured = simulator._render(sensor, frame, options, stacklevel=3)
    except (DeviceLostError, InternalError):
        simulator.close()
        raise
    except Error:
        _give(key, simulator)
        raise
    except BaseException:
        simulator.close()
        raise
    _give(key, simulator)
    return measured
