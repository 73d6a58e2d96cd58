"""The page of a run for a browser."""

from __future__ import annotations

import ctypes
import json
import os
from pathlib import Path
from typing import Optional, Union

from ._errors import ArgumentError
from ._files import file_bytes
from ._library import check, library
from ._text import short


def report(
    directory: Union[str, "os.PathLike[str]"],
    file: Optional[Union[str, "os.PathLike[str]"]] = None,
    max_size: float = 10.0,
) -> Path:
    """Makes one HTML page of what `pmdsim render` or `pmdsim deform` wrote, as `pmdsim report` does.

    Parameters
    ----------
    directory : path
        A folder with a manifest.json and frames as .exr or .h5.
    file : path, optional
        The page; by default report.html in the folder. One that is there is replaced.
    max_size : float, optional
        MiB that the page may have, about, 1 to 1000. What does not fit is left out, and the page says what.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    InputError
        The folder has no run, or a file of it is wrong.
    OutputError
        The page cannot be written.
    ArgumentError
        An argument is wrong.

    Examples
    --------
    >>> webbrowser.open(pmdsim.report("out/room/render").as_uri())          # doctest: +SKIP
    """
    page = None if file is None else file_bytes(file, "file")
    if isinstance(max_size, bool) or not isinstance(max_size, (int, float)) or not 1 <= max_size <= 1000:
        raise ArgumentError(f"max_size: expected a number of MiB from 1 to 1000, found {short(max_size)}")
    told = ctypes.c_char_p()
    check(library().pmdsim_report(file_bytes(directory, "directory"), page, float(max_size), ctypes.byref(told)))
    return Path(json.loads(told.value or b"null")["report"])
