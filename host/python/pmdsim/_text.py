"""Text on its way to the library, and values in messages."""

from __future__ import annotations

from typing import Any

from ._errors import ArgumentError

_longest = 80


def short(value: Any) -> str:
    """The value as messages show it: one line of at most 80 characters."""
    try:
        text = " ".join(repr(value).split())
    except (ValueError, RecursionError):  # of a number of very many digits, and of very many levels
        text = f"a value of the type {type(value).__name__}"
    return text if len(text) <= _longest else text[: _longest - 3] + "..."


def checked_text(text: str, what: str, place: str = "") -> str:
    """The text itself, or ArgumentError where the library would take it for another: NUL ends its texts, and a lone
    surrogate is no UTF-8."""
    try:
        is_whole = b"\0" not in text.encode("utf-8")
    except UnicodeEncodeError:
        is_whole = False
    if not is_whole:
        raise ArgumentError(f"{what}: expected text without NUL and lone surrogates, found {short(text)}", place=place)
    return text


def text_bytes(text: str, what: str) -> bytes:
    """UTF-8 for the library, or ArgumentError."""
    return checked_text(text, what).encode("utf-8")
