"""The shared library and its functions, as pmdsim.h declares them."""

from __future__ import annotations

import ctypes
import json
import os
import threading
from pathlib import Path
from typing import Any, Dict, List, Optional

from ._errors import LibraryError, error_of_status

ABI = 0
SONAME = f"libpmdsim.so.{ABI}"


class Mesh(ctypes.Structure):
    """pmdsim_mesh"""

    scene: Any  # whose arrays it shows

    _fields_ = [
        ("struct_size", ctypes.c_size_t),
        ("positions_m", ctypes.c_void_p),
        ("vertex_count", ctypes.c_size_t),
        ("triangles", ctypes.c_void_p),
        ("triangle_count", ctypes.c_size_t),
        ("reflectivity", ctypes.c_void_p),
        ("object_ids", ctypes.c_void_p),
        ("double_sided", ctypes.c_int),
    ]


class RenderOptions(ctypes.Structure):
    """pmdsim_render_options"""

    _fields_ = [
        ("struct_size", ctypes.c_size_t),
        ("mode", ctypes.c_char_p),
        ("max_error_m", ctypes.c_double),
        ("max_amplitude_error", ctypes.c_double),
        ("precision", ctypes.c_char_p),
        ("samples", ctypes.c_char_p),
        ("channels", ctypes.c_char_p),
        ("paths", ctypes.c_uint32),
        ("strict", ctypes.c_int),
        ("output_precision", ctypes.c_char_p),
    ]


class Channel(ctypes.Structure):
    """pmdsim_channel"""

    _fields_ = [
        ("struct_size", ctypes.c_size_t),
        ("name", ctypes.c_char_p),
        ("unit", ctypes.c_char_p),
        ("type", ctypes.c_int),
        ("rows", ctypes.c_uint32),
        ("columns", ctypes.c_uint32),
        ("values", ctypes.c_void_p),
    ]


_handle = ctypes.c_void_p
_text = ctypes.c_char_p
_text_out = ctypes.POINTER(ctypes.c_char_p)
_handle_out = ctypes.POINTER(ctypes.c_void_p)
_channel_out = ctypes.POINTER(Channel)

# All but the first few return a pmdsim_status.
_functions: Dict[str, List[Any]] = {
    "pmdsim_devices": [_text_out],
    "pmdsim_schema": [_text_out],
    "pmdsim_channels": [_text_out],
    "pmdsim_simulator_create": [_text, _handle_out],
    "pmdsim_simulator_destroy": [_handle],
    "pmdsim_simulator_load": [_handle, _text],
    "pmdsim_simulator_load_text": [_handle, _text, ctypes.c_size_t, _text],
    "pmdsim_simulator_load_mesh": [_handle, _text, ctypes.c_size_t, _text, ctypes.POINTER(Mesh)],
    "pmdsim_simulator_set": [_handle, _text],
    "pmdsim_simulator_describe": [_handle, _text_out],
    "pmdsim_simulator_cancel": [_handle],
    "pmdsim_render": [_handle, ctypes.c_uint32, ctypes.c_uint32, ctypes.POINTER(RenderOptions), _handle_out],
    "pmdsim_frame_read": [_text, _handle_out],
    "pmdsim_frame_destroy": [_handle],
    "pmdsim_frame_channel_count": [_handle, ctypes.POINTER(ctypes.c_size_t)],
    "pmdsim_frame_channel": [_handle, ctypes.c_size_t, _channel_out],
    "pmdsim_frame_find": [_handle, _text, _channel_out],
    "pmdsim_frame_report": [_handle, _text_out],
    "pmdsim_frame_directions": [_handle, ctypes.c_void_p, ctypes.c_size_t],
    "pmdsim_simulator_allow_outside": [_handle, ctypes.c_int],
    "pmdsim_report": [_text, _text, ctypes.c_double, _text_out],
}
_texts = ["pmdsim_version", "pmdsim_error_message", "pmdsim_error_file", "pmdsim_error_place"]


def _place() -> str:
    """The library that is asked for, else that of a wheel, else the system's."""
    asked_for = os.environ.get("PMDSIM_LIBRARY")
    if asked_for:
        return asked_for
    beside = sorted((Path(__file__).parent / "lib").glob(SONAME + "*"))
    return str(beside[0]) if beside else SONAME


def _open(place: str) -> ctypes.CDLL:
    try:
        library = ctypes.CDLL(place)
    except OSError as error:
        raise LibraryError(
            f"{place}: the library cannot be loaded ({error}); expected it where PMDSIM_LIBRARY says, beside the "
            f"package in pmdsim/lib, or installed as {SONAME}",
            file=place,
        ) from None
    try:
        library.pmdsim_abi.argtypes = []
        library.pmdsim_abi.restype = ctypes.c_int
        found = library.pmdsim_abi()
    except AttributeError:
        raise LibraryError(f"{place}: this is not libpmdsim, it has no pmdsim_abi()", file=place) from None
    if found != ABI:
        raise LibraryError(f"{place}: expected a library with ABI {ABI}, found ABI {found}", file=place)
    return library


def _declare(library: ctypes.CDLL, place: str) -> None:
    try:
        for name in _texts:
            function = getattr(library, name)
            function.argtypes = []
            function.restype = ctypes.c_char_p
        for name, arguments in _functions.items():
            function = getattr(library, name)
            function.argtypes = arguments
            function.restype = ctypes.c_int
    except AttributeError as error:
        raise LibraryError(f"{place}: this is not all of libpmdsim ({error})", file=place) from None


_lock = threading.Lock()
_loaded: Optional[ctypes.CDLL] = None


def library() -> ctypes.CDLL:
    """The library, which is loaded when it is first asked for."""
    global _loaded
    if _loaded is None:
        with _lock:
            if _loaded is None:
                place = _place()
                opened = _open(place)
                _declare(opened, place)
                _loaded = opened
    return _loaded


def _decoded(text: Optional[bytes]) -> str:
    return (text or b"").decode("utf-8", "replace")


def check(status: int) -> None:
    """Raises what the status means, with the text that the library has for this thread."""
    if status == 0:
        return
    lib = library()
    error = error_of_status.get(status, error_of_status[1])
    raise error(
        _decoded(lib.pmdsim_error_message()) or f"status {status}",
        _decoded(lib.pmdsim_error_file()),
        _decoded(lib.pmdsim_error_place()),
    )


def _json_of(function_name: str) -> Any:
    text = ctypes.c_char_p()
    check(getattr(library(), function_name)(ctypes.byref(text)))
    return json.loads(text.value or b"null")


def devices() -> List[Dict[str, Any]]:
    """The devices of Vulkan's drivers, in the order of their indices; none where there is no driver.

    Returns
    -------
    list of dict
        Each with "index", which the argument `device` takes, "name", "driver", "kind" ("CPU", "discrete GPU", ...),
        "usable", and "lacks", what a device lacks that is not usable.

    Examples
    --------
    >>> [device["name"] for device in pmdsim.devices()]         # doctest: +SKIP
    ['llvmpipe (LLVM 15.0.6, 256 bits)']
    """
    return _json_of("pmdsim_devices")


def schema() -> Dict[str, Any]:
    """The JSON Schema of setups: every key with its meaning, unit, bounds and default."""
    return _json_of("pmdsim_schema")


def channels() -> List[Dict[str, Any]]:
    """The channels that frames may have, each with "name", "unit", "about" and "of_taps"."""
    return _json_of("pmdsim_channels")


def version() -> str:
    """The library's version, as "0.6.0"."""
    return _decoded(library().pmdsim_version())
