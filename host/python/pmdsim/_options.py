"""How to measure, from keyword arguments to pmdsim_render_options."""

from __future__ import annotations

import ctypes
import math
from typing import Any, List, Optional, Sequence, Union

from ._errors import ArgumentError
from ._library import RenderOptions
from ._values import length_m, whole_number

Channels = Union[str, Sequence[str]]
Length = Union[str, float]


def _one_of(value: Any, what: str, names: Sequence[str]) -> Optional[bytes]:
    if value is None:
        return None
    if value not in names or not isinstance(value, str):
        raise ArgumentError(f"{what}: expected {', '.join(names[:-1])} or {names[-1]}, found {value!r:.80}")
    return value.encode()


def _samples(value: Any) -> Optional[bytes]:
    if value is None:
        return None
    if value == "auto":
        return b"auto"
    return str(whole_number(value, "samples", 1, 16)).encode()


def _channels(value: Optional[Channels]) -> Optional[bytes]:
    if value is None:
        return None
    names: List[Any] = value.split(",") if isinstance(value, str) else list(value)
    if not names or not all(isinstance(name, str) and name for name in names):
        raise ArgumentError(f"channels: expected names of channels, found {value!r:.80}")
    return ",".join(names).encode()


def _relative_error(value: Any) -> float:
    if value is None:
        return 0.0
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not 0.0 < number <= 1.0:
        raise ArgumentError(f"max_amplitude_error: expected a number above 0, at most 1, found {value!r:.80}")
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
    )
