"""Reading setups: JSON with comments."""

from __future__ import annotations

import json
import re
from typing import Any, Dict, List, Tuple

from ._errors import InputError
from ._text import short

# Text in quotes, which stays, or a comment, which becomes as many spaces and lines.
_quoted_or_comment = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)


def _blank(match: "re.Match[str]") -> str:
    text = match.group()
    return text if text.startswith('"') else re.sub(r"[^\n]", " ", text)


def parse_setup(text: str, file: str) -> Dict[str, Any]:
    """The object that the text is, or InputError with the file and "LINE:COLUMN"."""

    def once(pairs: List[Tuple[str, Any]]) -> Dict[str, Any]:
        found: Dict[str, Any] = {}
        for key, value in pairs:
            if key in found:
                raise InputError(f"{file}: the key {short(key)} is there twice in one object", file)
            found[key] = value
        return found

    def no_number(name: str) -> Any:
        raise InputError(f"{file}: expected a number, found {name}", file)

    try:
        setup = json.loads(_quoted_or_comment.sub(_blank, text), object_pairs_hook=once, parse_constant=no_number)
    except json.JSONDecodeError as error:
        place = f"{error.lineno}:{error.colno}"
        raise InputError(f"{file}:{place}: no JSON: {error.msg}", file, place) from None
    except RecursionError:
        raise InputError(f"{file}: expected fewer levels", file) from None
    if not isinstance(setup, dict):
        raise InputError(f"{file}: expected a JSON object", file)
    return setup
