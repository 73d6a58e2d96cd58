"""From Python's and numpy's values to those of JSON."""

from __future__ import annotations

import json
import math
import os
from typing import Any, Dict, List, Mapping, Optional, Union

import numpy as np
from numpy.typing import NDArray

from ._errors import ArgumentError
from ._text import checked_text, short


def _refused(value: Any, place: str, expected: str) -> ArgumentError:
    return ArgumentError(f"{place or '/'}: expected {expected}, found {short(value)}", place=place)


def plain(value: Any, place: str = "") -> Any:
    """The same value of dict, list, str, numbers, bool and None alone, or ArgumentError with the place."""
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, str):
        return checked_text(value, place or "/", place)
    if isinstance(value, (int, float, np.integer, np.floating)):
        if not _is_finite(value):
            raise _refused(value, place, "a finite number")
        return int(value) if isinstance(value, (int, np.integer)) else float(value)
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, np.ndarray):
        return plain(value.tolist(), place)
    if isinstance(value, os.PathLike):
        return plain(os.fspath(value), place)
    if isinstance(value, Mapping):
        return {_key(key, place): plain(element, f"{place}/{key}") for key, element in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(element, f"{place}/{index}") for index, element in enumerate(value)]
    raise _refused(value, place, "numbers, text, lists, dicts or numpy arrays")


def _is_finite(number: Any) -> bool:
    try:
        return math.isfinite(number)
    except OverflowError:  # of a whole number beyond all doubles
        return False


def _key(key: Any, place: str) -> str:
    if not isinstance(key, str):
        raise _refused(key, place, "a key that is text")
    return checked_text(key, place or "/", place)


def too_deep(what: str) -> ArgumentError:
    """For a RecursionError."""
    return ArgumentError(f"{what}: expected fewer levels, found a value that contains itself, or nearly so")


def json_text(value: Any, what: str, indent: Optional[int] = None) -> str:
    """The value as JSON, in which numbers are the same doubles again, or ArgumentError."""
    try:
        return json.dumps(plain(value), ensure_ascii=False, allow_nan=False, indent=indent)
    except RecursionError:
        raise too_deep(what) from None


def several(values: Any) -> List[Any]:
    """A list of what may be one thing alone, such as a number or a name."""
    if isinstance(values, str):
        return [values]
    try:
        return list(values)
    except TypeError:
        return [values]


def whole_number(value: Any, what: str, least: int, most: int) -> int:
    """An index or a count."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and least <= value <= most:
        return int(value)
    raise ArgumentError(f"{what}: expected a whole number from {least} to {most}, found {short(value)}")


_units_per_m = {"um": 1e6, "mm": 1e3, "m": 1.0}


def length_m(value: Union[str, float], what: str) -> float:
    """A length above 0 in metres, from a number of metres or "10um", "0.1mm", "1m"."""
    if isinstance(value, str):
        for unit, per_m in _units_per_m.items():
            if value.endswith(unit):
                number = _number(value[: -len(unit)])
                if number is not None and number > 0.0:
                    return number / per_m
                break
    elif isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool):
        if _is_finite(value) and value > 0.0:
            return float(value)
    raise ArgumentError(f'{what}: expected metres above 0, or a length like "10um", found {short(value)}')


def _number(text: str) -> Optional[float]:
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def pose_value(pose: Any, what: str = "pose") -> Dict[str, Any]:
    """A pose as setups have it: {"matrix": rows}, or the dict that it is already.

    Parameters
    ----------
    pose : array_like (4, 4), or (position, quaternion), or dict
        World from the frame of what is moved; or its position in metres and its quaternion (x, y, z, w), of any
        length but 0; or a pose as a setup has it.
    """
    if isinstance(pose, Mapping):
        return plain(pose)
    if isinstance(pose, (list, tuple)) and len(pose) == 2:
        return {"matrix": _matrix_of(pose[0], pose[1], what).tolist()}
    matrix = _numbers(pose, what)
    if matrix.shape != (4, 4):
        raise ArgumentError(
            f"{what}: expected a 4 x 4 matrix, or a position and a quaternion (x, y, z, w), found the shape "
            f"{matrix.shape}"
        )
    return {"matrix": matrix.tolist()}


def _numbers(values: Any, what: str) -> NDArray[np.float64]:
    try:
        numbers = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{what}: expected numbers, found {short(values)}") from None
    if not np.isfinite(numbers).all():
        raise ArgumentError(f"{what}: expected finite numbers, found {short(values)}")
    return numbers


def _matrix_of(position_m: Any, quaternion: Any, what: str) -> NDArray[np.float64]:
    position, turn = _numbers(position_m, what), _numbers(quaternion, what)
    if position.shape != (3,) or turn.shape != (4,):
        raise ArgumentError(
            f"{what}: expected a position of 3 and a quaternion of 4 numbers, found the shapes {position.shape} and "
            f"{turn.shape}"
        )
    length = float(np.linalg.norm(turn))
    if length == 0.0:
        raise ArgumentError(f"{what}: expected a quaternion, found one of length 0")
    x, y, z, w = turn / length
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = position
    return matrix
