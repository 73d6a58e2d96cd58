"""Names of files, and writing them."""

from __future__ import annotations

import contextlib
import os
from typing import Any, BinaryIO, Callable

from ._errors import ArgumentError, OutputError
from ._text import short


def file_name(path: Any, what: str) -> str:
    """A path as text, or ArgumentError where no file can have that name."""
    try:
        name = os.fspath(path)
        is_name = isinstance(name, str) and b"\0" not in _encoded(name)
    except (TypeError, UnicodeEncodeError):
        is_name = False
    if not is_name:
        raise ArgumentError(f"{what}: expected a path, found {short(path)}")
    return name


def file_bytes(path: Any, what: str) -> bytes:
    """A path as the library takes it, or ArgumentError."""
    return _encoded(file_name(path, what))


def _encoded(name: str) -> bytes:
    """Python has bytes of a name that are no UTF-8 as surrogates."""
    return name.encode("utf-8", "surrogateescape")


def write_whole(name: str, write: Callable[[BinaryIO], Any]) -> None:
    """Writes a file whole or not at all, or raises OutputError."""
    partial = f"{name}.{os.getpid()}.partial"
    try:
        with open(partial, "wb") as file:
            write(file)
        os.replace(partial, name)
    except BaseException as error:
        with contextlib.suppress(OSError):
            os.remove(partial)
        if isinstance(error, OSError):
            raise OutputError(f"{name}: cannot be written: {error.strerror or error}", name) from None
        raise
