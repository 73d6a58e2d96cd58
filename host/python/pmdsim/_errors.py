"""What can go wrong, by name. The codes are those of the C interface, pmdsim_status."""

from __future__ import annotations

import re
from typing import Any, Dict, Mapping, Tuple, Type

_breaks = re.compile(r"[\x00-\x1f\x7f]+")


class Error(Exception):
    """Anything that pmdsim refuses or fails at; its text is one line for people.

    Attributes
    ----------
    file : str
        The file that is wrong, or "". A setup that is changed or given beside a scene is still that of the file that
        it was read from; one of dicts has none.
    place : str
        The place in it, a JSON pointer, "LINE:COLUMN" or, of tables such as CSV, "LINE", or "". Of a setup that is
        no file it is the place in the setup, of an array of a pmdsim.Scene the index in it, "[0, 2]".
    code : int
        The pmdsim_status of the C interface; up to 8 they are the program's exit codes.
    """

    code = 1

    def __init__(self, message: str, file: str = "", place: str = "") -> None:
        self.message = _breaks.sub(" ", message)  # names of files may have line breaks
        super().__init__(self.message)
        self.file = file
        self.place = place

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (self.message, self.file, self.place)


class InternalError(Error, RuntimeError):
    """A mistake in pmdsim itself."""


class ArgumentError(Error, ValueError):
    """An argument is wrong."""

    code = 2


class InputError(Error, ValueError):
    """A setup, a scene or another file is wrong; `file` and `place` tell which and where."""

    code = 3


class NoDeviceError(Error, RuntimeError):
    """There is no usable device of that name."""

    code = 4


class OutOfMemoryError(Error, MemoryError):
    """The host or the device has too little memory."""

    code = 5


class DeviceLostError(Error, RuntimeError):
    """The device failed; its simulator is of no use any more."""

    code = 6


class OutputError(Error, OSError):
    """A file cannot be written."""

    code = 7


class AccuracyError(Error, ArithmeticError):
    """The accuracy asked for cannot be reached."""

    code = 8


class HandleError(Error, ValueError):
    """A simulator is closed, or belongs to another process."""

    code = 9


class BusyError(Error, RuntimeError):
    """The simulator is in another call, of another thread."""

    code = 10


class CancelledError(Error, RuntimeError):
    """The call was ended by Simulator.cancel()."""

    code = 130


class UnknownChannelError(ArgumentError, AttributeError, KeyError):
    """A frame has no channel of that name; the text says which it has."""


class UnknownKeyError(InputError, AttributeError, KeyError):
    """A setup cannot have that key; the text says which it can have."""


class LibraryError(Error, ImportError):
    """The shared library is not there, or is of another version."""


class PmdsimWarning(UserWarning):
    """What a setup or a frame warns of; its text is one line for people.

    Attributes
    ----------
    code : str
        Its kind, such as "nothing-in-view", which stays the same from version to version (docs/warnings.md).
    place : str
        What it is about: a file and a JSON pointer, a file, or "sensor NAME".
    """

    def __init__(self, message: str, code: str = "", place: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.place = place

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (str(self), self.code, self.place)


def warning_of(told: Mapping[str, str]) -> PmdsimWarning:
    """Of one of a description's or report's "warnings"."""
    return PmdsimWarning(f"{told['place']}: {told['text']}", told["code"], told["place"])


error_of_status: Dict[int, Type[Error]] = {
    error.code: error
    for error in (
        InternalError,
        ArgumentError,
        InputError,
        NoDeviceError,
        OutOfMemoryError,
        DeviceLostError,
        OutputError,
        AccuracyError,
        HandleError,
        BusyError,
        CancelledError,
    )
}
