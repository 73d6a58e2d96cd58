"""Scenes from arrays."""

from __future__ import annotations

import ctypes
from typing import Any, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import ArgumentError
from ._library import Mesh
from ._text import short

_farthest_m = 1e9


class Scene:
    """Triangles in place of a scene's file.

    Parameters
    ----------
    vertices : array_like (n, 3)
        Positions in the world frame (right-handed, +Y up), metres, to 1e9 on either side. float64 in C order is
        taken without a copy.
    triangles : array_like of integers (m, 3)
        The vertices of each triangle, counter-clockwise seen from the front. uint32 in C order is taken without a
        copy.
    reflectivity : float or array_like (m,), optional
        The share of light that comes back, 0 to 1, of all triangles or of each.
    object_ids : array_like of integers (m,), optional
        What the channel `object_id` shows of each triangle, below m; by default 0.
    double_sided : bool, optional
        False: the lens sees fronts alone; light is blocked by either side.

    Raises
    ------
    ArgumentError
        A shape, type, number or index is wrong; the text says which and where.

    Examples
    --------
    >>> wall = pmdsim.Scene([[-1, -1, -2], [1, -1, -2], [0, 1, -2]], [[0, 1, 2]], reflectivity=0.8)
    >>> with pmdsim.Simulator({"sensors": [...], "illuminators": [...]}, scene=wall) as simulator:   # doctest: +SKIP
    ...     frame = simulator.render()

    Notes
    -----
    The arrays are attributes that cannot be replaced: make a new scene for others. Their values may be changed in
    place, `scene.vertices[:, 2] -= 1`, which shows when the scene is loaded again and is checked then. They are views
    of the caller's arrays where these needed no copy.
    """

    def __init__(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        *,
        reflectivity: Union[float, ArrayLike] = 1.0,
        object_ids: Optional[ArrayLike] = None,
        double_sided: bool = True,
    ) -> None:
        # Views of its own, which nobody else has: numpy lets callers change an array's shape and type in place.
        self._vertices = _vertices(vertices).view()
        self._triangles = _triangles(triangles, len(self._vertices)).view()
        count = len(self._triangles)
        reflectivities = _reflectivity(reflectivity, count)
        self._reflectivity = None if reflectivities is None else reflectivities.view()
        ids = None if object_ids is None else _indices(object_ids, "object_ids", (count,), count, "the triangles")
        self._object_ids = None if ids is None else ids.view()
        self._double_sided = bool(double_sided)

    @property
    def vertices(self) -> NDArray[np.float64]:
        """(n, 3), metres."""
        return self._vertices.view()

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(m, 3), indices of vertices."""
        return self._triangles.view()

    @property
    def reflectivity(self) -> Optional[NDArray[np.float64]]:
        """(m,), 0 to 1; None where all is reflected."""
        return None if self._reflectivity is None else self._reflectivity.view()

    @property
    def object_ids(self) -> Optional[NDArray[np.uint32]]:
        """(m,); None where all are 0."""
        return None if self._object_ids is None else self._object_ids.view()

    @property
    def double_sided(self) -> bool:
        """Whether the lens sees backs, too."""
        return self._double_sided

    def __repr__(self) -> str:
        return f"<pmdsim.Scene of {len(self._triangles)} triangles, {len(self._vertices)} vertices>"

    def _mesh(self) -> Mesh:
        """The library's view of the arrays, which keeps them."""
        mesh = Mesh(
            struct_size=ctypes.sizeof(Mesh),
            positions_m=self._vertices.ctypes.data,
            vertex_count=len(self._vertices),
            triangles=self._triangles.ctypes.data,
            triangle_count=len(self._triangles),
            reflectivity=None if self._reflectivity is None else self._reflectivity.ctypes.data,
            object_ids=None if self._object_ids is None else self._object_ids.ctypes.data,
            double_sided=int(self._double_sided),
        )
        mesh.scene = self
        return mesh


def _array(values: Any, what: str) -> NDArray[Any]:
    try:
        return np.asarray(values)
    except (TypeError, ValueError):
        raise ArgumentError(f"{what}: expected numbers in rows of one length, found {short(values)}") from None


def _real(values: Any, what: str) -> NDArray[np.float64]:
    array = _array(values, what)
    if array.dtype.kind not in "fiu":
        raise ArgumentError(f"{what}: expected real numbers, found the type {array.dtype}")
    return np.ascontiguousarray(array, dtype=np.float64)


def _first(wrong: NDArray[np.bool_]) -> str:
    return "[" + ", ".join(str(int(index)) for index in np.argwhere(wrong)[0]) + "]"


def _vertices(values: Any) -> NDArray[np.float64]:
    array = _real(values, "vertices")
    if array.ndim != 2 or array.shape[1] != 3 or not len(array):
        raise ArgumentError(f"vertices: expected the shape (n, 3), found {array.shape}")
    wrong = ~(np.abs(array) <= _farthest_m)
    if wrong.any():
        place = _first(wrong)
        raise ArgumentError(f"vertices{place}: expected metres from -1e9 to 1e9, found {array[wrong][0]}", place=place)
    return array


def _indices(values: Any, what: str, shape: Tuple[Optional[int], ...], count: int, of: str) -> NDArray[np.uint32]:
    array = _array(values, what)
    if array.dtype.kind not in "iu":
        raise ArgumentError(f"{what}: expected whole numbers, found the type {array.dtype}")
    if array.ndim != len(shape) or any(n is not None and n != m for n, m in zip(shape, array.shape)):
        expected = "(" + ", ".join("m" if n is None else str(n) for n in shape) + ("," if len(shape) == 1 else "") + ")"
        raise ArgumentError(f"{what}: expected the shape {expected}, found {array.shape}")
    wrong = (array < 0) | (array >= count)
    if wrong.any():
        place = _first(wrong)
        raise ArgumentError(
            f"{what}{place}: expected 0 to {count - 1}, since {of} are {count}, found {array[wrong][0]}", place=place
        )
    return np.ascontiguousarray(array, dtype=np.uint32)


def _triangles(values: Any, vertex_count: int) -> NDArray[np.uint32]:
    array = _indices(values, "triangles", (None, 3), vertex_count, "the vertices")
    if not len(array):
        raise ArgumentError("triangles: expected at least one")
    return array


def _reflectivity(values: Any, count: int) -> Optional[NDArray[np.float64]]:
    array = _real(values, "reflectivity")
    if array.shape not in ((), (1,), (count,)):
        raise ArgumentError(f"reflectivity: expected a number or the shape ({count},), found {array.shape}")
    wrong = ~((array >= 0.0) & (array <= 1.0))
    if wrong.any():
        place = _first(wrong) if array.ndim else ""
        raise ArgumentError(f"reflectivity{place}: expected 0 to 1, found {array[wrong].flat[0]}", place=place)
    if array.size == 1 and array.flat[0] == 1.0:
        return None
    return np.ascontiguousarray(np.broadcast_to(array, (count,)))
