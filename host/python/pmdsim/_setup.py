"""Setups as nested dicts with attributes."""

from __future__ import annotations

import json
import os
from functools import lru_cache
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Mapping, Optional, Tuple, Union

from ._errors import ArgumentError, InputError, UnknownKeyError
from ._files import file_name, write_whole
from ._library import schema as library_schema
from ._scene import Scene
from ._setup_text import parse_setup
from ._text import short
from ._values import json_text, too_deep

Schema = Dict[str, Any]


@lru_cache(maxsize=1)
def _root_schema() -> Schema:
    return library_schema()


def _forms(schema: Schema) -> Iterator[Schema]:
    """The schema and the alternatives in it."""
    reference = schema.get("$ref")
    if reference:
        target: Any = _root_schema()
        for part in reference.lstrip("#/").split("/"):
            target = target[part]
        yield from _forms(target)
        return
    yield schema
    for alternative in schema.get("anyOf", ()):
        yield from _forms(alternative)


def _keys(schema: Schema) -> Optional[Dict[str, Schema]]:
    """The keys that an object may have; None where it may have any."""
    known: Dict[str, Schema] = {}
    for form in _forms(schema):
        if form.get("additionalProperties", False) is not False:
            return None
        known.update(form.get("properties", {}))
    return known


def _schema_of_key(schema: Schema, key: str) -> Schema:
    for form in _forms(schema):
        if key in form.get("properties", {}):
            return form["properties"][key]
        if isinstance(form.get("additionalProperties"), dict):
            return form["additionalProperties"]
    return {}


def _schema_of_elements(schema: Schema) -> Schema:
    for form in _forms(schema):
        if isinstance(form.get("items"), dict):
            return form["items"]
    return {}


def _wrapped(value: Any, schema: Schema, place: str) -> Any:
    if isinstance(value, Scene):
        return value
    if isinstance(value, Mapping):
        return Part(value, schema, place)
    if isinstance(value, (list, tuple)):
        return _Parts(value, _schema_of_elements(schema), place)
    return value


class _Parts(List[Any]):
    """A list in a setup, whose objects are Part."""

    def __init__(self, values: Iterable[Any], schema: Schema, place: str) -> None:
        self._schema = schema
        self._place = place
        super().__init__(self._wrap(value, index) for index, value in enumerate(values))

    def _wrap(self, value: Any, index: Any) -> Any:
        return _wrapped(value, self._schema, f"{self._place}/{index}")

    def append(self, value: Any) -> None:
        super().append(self._wrap(value, len(self)))

    def insert(self, index: Any, value: Any) -> None:
        super().insert(index, self._wrap(value, index))

    def extend(self, values: Iterable[Any]) -> None:
        for value in values:
            self.append(value)

    def __iadd__(self, values: Iterable[Any]) -> "_Parts":  # type: ignore[misc]
        self.extend(values)
        return self

    def __setitem__(self, index: Any, value: Any) -> None:
        if isinstance(index, slice):
            value = [self._wrap(element, index.start or 0) for element in value]
        else:
            value = self._wrap(value, index)
        super().__setitem__(index, value)

    def __reduce__(self) -> Tuple[Any, ...]:
        return list, (list(self),)

    def __deepcopy__(self, memory: Any) -> "_Parts":
        return _Parts(_copied(self), self._schema, self._place)


def _copied(value: Any) -> Any:
    """A copy in which everything but scenes is new, of plain types."""
    if isinstance(value, Mapping):
        return {key: _copied(element) for key, element in value.items()}
    if isinstance(value, (list, tuple)):
        return [_copied(element) for element in value]
    return value


class Part(Dict[str, Any]):
    """An object in a setup: a dict whose keys are attributes, too."""

    # Attributes of this class that are no keys.
    _own = frozenset({"_schema", "_place", "_file", "directory"})

    def __init__(self, values: Mapping[str, Any], schema: Schema, place: str) -> None:
        super().__init__()
        self._schema = schema
        self._place = place
        for key, value in values.items():
            self[key] = value

    def _check(self, key: Any) -> None:
        known = _keys(self._schema)
        if not isinstance(key, str) or (known and key not in known):
            place = f"{self._place}/{key}"
            raise UnknownKeyError(
                f"{place}: there is no key {short(key)}; expected one of {', '.join(sorted(known or ()))}", place=place
            )

    def __setitem__(self, key: str, value: Any) -> None:
        self._check(key)
        super().__setitem__(key, _wrapped(value, _schema_of_key(self._schema, key), f"{self._place}/{key}"))

    def update(self, *values: Any, **named: Any) -> None:
        for key, value in dict(*values, **named).items():
            self[key] = value

    def setdefault(self, key: str, default: Any = None) -> Any:
        if key not in self:
            self[key] = default
        return self[key]

    def __ior__(self, values: Any) -> "Part":  # type: ignore[override,misc]
        self.update(values)
        return self

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name in self._own:
            raise AttributeError(name)
        if name in self:
            return self[name]
        self._check(name)
        schema = _schema_of_key(self._schema, name)
        default = f"; its default is {json.dumps(schema['default'])}" if "default" in schema else ""
        place = f"{self._place}/{name}"
        raise UnknownKeyError(f"{place}: the setup does not have this key{default}", place=place)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self._own:
            object.__setattr__(self, name, value)
        else:
            self[name] = value

    def __delattr__(self, name: str) -> None:
        if name not in self:
            raise UnknownKeyError(f"{self._place}/{name}: the setup does not have this key")
        del self[name]

    def __dir__(self) -> List[str]:
        keys = set(self) | set(_keys(self._schema) or ())
        return sorted(set(super().__dir__()) | {key for key in keys if key.isidentifier()})

    def __reduce__(self) -> Tuple[Any, ...]:
        return dict, (dict(self),)

    def __deepcopy__(self, memory: Any) -> "Part":
        return Part(_copied(self), self._schema, self._place)


class Setup(Part):
    """A setup: what is seen, by which camera, in which light, as nested dicts with attributes.

    Parameters
    ----------
    values : mapping, optional
        The setup's keys, as docs/setup.md explains them; SI units.
    directory : path, optional
        Where relative paths in it start; by default the process's directory at the time of use.

    Attributes
    ----------
    directory : str or None
        As above. `Setup.load` sets it to the file's folder.

    Raises
    ------
    UnknownKeyError
        At once, where a key is set, or asked for as an attribute, that setups do not have, and where `values` has
        one. It is an InputError, an AttributeError and a KeyError. Values are checked when a simulator loads the
        setup.
    ArgumentError
        `values` are no mapping, or contain themselves.

    Examples
    --------
    >>> setup = pmdsim.Setup.load("room.json")                          # doctest: +SKIP
    >>> setup.sensors[0].focal_length_m = 0.02                          # doctest: +SKIP
    >>> setup["illuminators"][0]["intensity_w_sr"] *= 2                 # doctest: +SKIP
    >>> setup.sensors[0].focal_lenth_m                                  # doctest: +SKIP
    pmdsim.UnknownKeyError: /sensors/0/focal_lenth_m: there is no key ...
    """

    def __init__(
        self,
        values: Optional[Mapping[str, Any]] = None,
        *,
        directory: Optional[Union[str, "os.PathLike[str]"]] = None,
    ) -> None:
        if values is not None and not isinstance(values, Mapping):
            raise ArgumentError(f"setup: expected a dict, found {short(values)}; Setup.load reads files")
        self.directory: Optional[str] = None if directory is None else file_name(directory, "directory")
        self._file = ""  # that it was read from, for errors
        try:
            super().__init__(values or {}, _root_schema(), "")
        except RecursionError:
            raise too_deep("setup") from None

    @classmethod
    def load(cls, file: Union[str, "os.PathLike[str]"]) -> "Setup":
        """Reads a setup file; // comments are allowed.

        Raises
        ------
        InputError
            The file cannot be read, is no JSON object, or has an unknown or doubled key; an unknown one is an
            UnknownKeyError.
        ArgumentError
            No file can have that name.
        """
        name = file_name(file, "file")
        try:
            text = Path(name).read_text(encoding="utf-8-sig")
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{name}: cannot be read: {error}", name) from None
        values = parse_setup(text, name)
        try:
            setup = cls(values, directory=os.path.dirname(os.path.abspath(name)))
        except UnknownKeyError as error:
            raise UnknownKeyError(f"{name}: {error.message}", name, error.place) from None
        setup._file = os.path.abspath(name)
        return setup

    def save(self, file: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the setup as JSON, whole or not at all. Relative paths in it stay as they are.

        Raises
        ------
        ArgumentError
            A value is none that JSON has, or the scene is one of arrays; or no file can have that name.
        OutputError
            The file cannot be written.
        """
        name = file_name(file, "file")
        text = json_text(self, "setup", indent=2) + "\n"
        write_whole(name, lambda stream: stream.write(text.encode("utf-8")))

    def copy(self) -> "Setup":
        """A setup of its own, to the last list."""
        return _restored(_copied(self), self.directory, self._file)

    __copy__ = copy

    def __deepcopy__(self, memory: Any) -> "Setup":
        return self.copy()

    def __reduce__(self) -> Tuple[Any, ...]:
        return _restored, (_copied(self), self.directory, self._file)


def _restored(values: Dict[str, Any], directory: Optional[str], file: str = "") -> Setup:
    setup = Setup(values, directory=directory)
    setup._file = file
    return setup
