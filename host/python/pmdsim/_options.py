"""How to measure, from keyword arguments to pmdsim_render_options."""

from __future__ import annotations

import ctypes
import math
import re
from typing import Any, Optional, Sequence, Union

from ._errors import ArgumentError
from ._library import RenderOptions
from ._text import short, text_bytes
from ._values import length_m, several, whole_number

Channels = Union[str, Sequence[str]]
Length = Union[str, float]

# "tap3", "f1.tap_a_e0": frames have a channel of each tap, and the library is asked for all of them by one name.
_numbered_tap = re.compile(r"((?:f\d+\.)?tap(?:_\w+?)?)\d+")


def _one_of(value: Any, what: str, names: Sequence[str]) -> Optional[bytes]:
    if value is None:
        return None
    if not isinstance(value, str) or value not in names:
        raise ArgumentError(f"{what}: expected {', '.join(names[:-1])} or {names[-1]}, found {short(value)}")
    return value.encode()


def _samples(value: Any) -> Optional[bytes]:
    if value is None:
        return None
    if isinstance(value, str) and value == "auto":
        return b"auto"
    return str(whole_number(value, "samples", 1, 16)).encode()


def _channels(value: Optional[Channels]) -> Optional[bytes]:
    if value is None:
        return None
    names = value.split(",") if isinstance(value, str) else several(value)
    if not names or not all(isinstance(name, str) and name for name in names):
        raise ArgumentError(f"channels: expected names of channels, found {short(value)}")
    return text_bytes(",".join(dict.fromkeys(_without_tap_number(name) for name in names)), "channels")


def _without_tap_number(name: str) -> str:
    tap = _numbered_tap.fullmatch(name)
    return tap.group(1) if tap else name


def _relative_error(value: Any) -> float:
    if value is None:
        return 0.0
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not 0.0 < number <= 1.0:
        raise ArgumentError(f"max_amplitude_error: expected a number above 0, at most 1, found {short(value)}")
    return number


def render_options(
    mode: Optional[str] = None,
    max_error: Optional[Length] = None,
    max_amplitude_error: Optional[float] = None,
    precision: Optional[str] = None,
    samples: Optional[Union[int, str]] = None,
    channels: Optional[Channels] = None,
    paths: Optional[int] = None,
    strict: bool = False,
    output_precision: Optional[str] = None,
) -> RenderOptions:
    """The struct for pmdsim_render(), or ArgumentError. `render` documents the arguments."""
    return RenderOptions(
        struct_size=ctypes.sizeof(RenderOptions),
        mode=_one_of(mode, "mode", ("exact", "reduced", "auto")),
        max_error_m=0.0 if max_error is None else length_m(max_error, "max_error"),
        max_amplitude_error=_relative_error(max_amplitude_error),
        precision=_one_of(precision, "precision", ("fp32", "fp64")),
        samples=_samples(samples),
        channels=_channels(channels),
        paths=0 if paths is None else whole_number(paths, "paths", 1, 10**9),
        strict=int(bool(strict)),
        output_precision=_one_of(output_precision, "output_precision", ("float32", "float64")),
    )
