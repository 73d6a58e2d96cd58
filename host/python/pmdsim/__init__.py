"""pmdsim: a simulator of continuous-wave time-of-flight cameras.

    import pmdsim

    frame = pmdsim.render("room.json", max_error="10um")     # frame.distance_m, frame.amplitude, ...: numpy arrays
    with pmdsim.Simulator("room.json") as simulator:         # many frames
        simulator.set("sensors/0/focal_length_m", 0.02)
        frame = simulator.render()
    for variant, frame in pmdsim.sweep("room.json", {"illuminators/0/intensity_w_sr": [1, 2]}):
        ...
    recording = pmdsim.load("out/room/render")               # what the program wrote

`help(pmdsim.render)` explains the arguments. Units are SI; images are (rows, columns), row 0 at the top; the world frame
is glTF's (right-handed, +Y up), a camera's x right, y down, z forward. The library is the one that the environment
variable PMDSIM_LIBRARY names, else one in pmdsim/lib, else the system's.
"""

from ._errors import (
    AccuracyError,
    ArgumentError,
    BusyError,
    CancelledError,
    DeviceLostError,
    Error,
    HandleError,
    InputError,
    InternalError,
    LibraryError,
    NoDeviceError,
    OutOfMemoryError,
    OutputError,
    PmdsimWarning,
    UnknownChannelError,
    UnknownKeyError,
)
from ._frame import Frame
from ._library import channels, devices, schema, version
from ._recording import Recording, load
from ._render import render
from ._report import report
from ._scene import Scene
from ._setup import Setup
from ._simulator import Simulator
from ._sweep import sweep

__all__ = [
    "AccuracyError",
    "ArgumentError",
    "BusyError",
    "CancelledError",
    "DeviceLostError",
    "Error",
    "Frame",
    "HandleError",
    "InputError",
    "InternalError",
    "LibraryError",
    "NoDeviceError",
    "OutOfMemoryError",
    "OutputError",
    "PmdsimWarning",
    "Recording",
    "Scene",
    "Setup",
    "Simulator",
    "UnknownChannelError",
    "UnknownKeyError",
    "channels",
    "devices",
    "load",
    "render",
    "report",
    "schema",
    "sweep",
    "version",
]

# Tracebacks and pickles name the public place.
for _name in __all__:
    globals()[_name].__module__ = "pmdsim"
del _name


def __getattr__(name: str) -> str:
    if name == "__version__":
        return version()
    raise AttributeError(f"module 'pmdsim' has no attribute {name!r}")
