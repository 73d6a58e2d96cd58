"""Scenes from arrays."""

from __future__ import annotations

import ctypes
from typing import Any, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import ArgumentError
from ._library import Mesh

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

    The arrays are those of the caller where they need no copy: change them and load the scene again to see it.
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
        self.vertices: NDArray[np.float64] = _vertices(vertices)
        self.triangles: NDArray[np.uint32] = _triangles(triangles, len(self.vertices))
        count = len(self.triangles)
        self.reflectivity: Optional[NDArray[np.float64]] = _reflectivity(reflectivity, count)
        self.object_ids: Optional[NDArray[np.uint32]] = (
            None if object_ids is None else _indices(object_ids, "object_ids", (count,), count, "the triangles")
        )
        self.double_sided = bool(double_sided)

    def __repr__(self) -> str:
        return f"<pmdsim.Scene of {len(self.triangles)} triangles, {len(self.vertices)} vertices>"

    def _mesh(self) -> Mesh:
        """The library's view of the arrays, which keeps them."""
        mesh = Mesh(
            struct_size=ctypes.sizeof(Mesh),
            positions_m=self.vertices.ctypes.data,
            vertex_count=len(self.vertices),
            triangles=self.triangles.ctypes.data,
            triangle_count=len(self.triangles),
            reflectivity=None if self.reflectivity is None else self.reflectivity.ctypes.data,
            object_ids=None if self.object_ids is None else self.object_ids.ctypes.data,
            double_sided=int(self.double_sided),
        )
        mesh.scene = self
        return mesh


def _real(values: Any, what: str) -> NDArray[np.float64]:
    array = np.asarray(values)
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
    array = np.asarray(values)
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
