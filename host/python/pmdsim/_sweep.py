"""Many variants of a setup."""

from __future__ import annotations

import itertools
import threading
import time
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Any, Deque, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from ._calls import patience_s
from ._errors import ArgumentError, CancelledError
from ._frame import Frame
from ._options import render_options
from ._scene import Scene
from ._setup_input import SetupLike, changes_of
from ._simulator import Device, Simulator
from ._text import short
from ._values import several, whole_number

Variant = Dict[str, Any]


def _variants(variations: Mapping[str, Iterable[Any]], combine: str) -> Iterator[Variant]:
    if combine not in ("product", "zip"):
        raise ArgumentError(f'combine: expected "product" or "zip", found {short(combine)}')
    if not isinstance(variations, Mapping) or not variations:
        raise ArgumentError(f"variations: expected a dict of paths and values, found {short(variations)}")
    lists: List[Sequence[Any]] = []
    for path, values in variations.items():
        if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, Iterable):
            raise ArgumentError(f"variations[{short(path)}]: expected a list of values, found {short(values)}")
        lists.append(list(values))
        changes_of({path: value for value in lists[-1][:1]})
    lengths = {len(values) for values in lists}
    if combine == "zip" and len(lengths) > 1:
        counts = ", ".join(f"{len(values)} of {path}" for path, values in zip(variations, lists))
        raise ArgumentError(f"variations: expected as many values of each path, found {counts}")
    combined = itertools.product(*lists) if combine == "product" else zip(*lists)
    return (dict(zip(variations, values)) for values in combined)


class _Workers:
    """Threads with a simulator each."""

    def __init__(
        self, setup: SetupLike, device: Optional[Device], scene: Optional[Scene], allow_outside: bool, count: int
    ) -> None:
        self._setup, self._device, self._scene, self._allow_outside = setup, device, scene, allow_outside
        self._of_thread = threading.local()
        self._lock = threading.Lock()
        self._simulators: List[Simulator] = []
        self._stopped = False
        self._pool = ThreadPoolExecutor(count, thread_name_prefix="pmdsim-sweep")

    def _simulator(self) -> Simulator:
        simulator = getattr(self._of_thread, "simulator", None)
        if simulator is None:
            made = Simulator(device=self._device)
            with self._lock:
                self._simulators.append(made)
            self._go_on()
            made.load(self._setup, scene=self._scene, allow_outside=self._allow_outside)
            simulator = self._of_thread.simulator = made
        return simulator

    def _go_on(self) -> None:
        if self._stopped:
            raise CancelledError("the sweep was ended")

    def _measure(self, variant: Variant, sensor: Union[int, str], frames: Sequence[int], options: Any) -> List[Frame]:
        simulator = self._simulator()
        simulator.set(variant)
        measured = []
        for frame in frames:
            self._go_on()
            measured.append(simulator._render(sensor, frame, options, stacklevel=4))
        return measured

    def submit(self, *work: Any) -> "Future[List[Frame]]":
        return self._pool.submit(self._measure, *work)

    def stop(self, pending: Iterable["Future[List[Frame]]"]) -> None:
        """Ends what runs, and closes the simulators when all threads are through, which the process waits for."""
        self._stopped = True
        running = {future for future in pending if not future.cancel()}
        give_up = time.monotonic() + patience_s
        while running and time.monotonic() < give_up:
            with self._lock:  # again and again: a thread may have been between two calls
                for simulator in self._simulators:
                    simulator._end_call()
            running = wait(running, timeout=0.02).not_done
        self._pool.shutdown(wait=not running)
        if not running:
            for simulator in self._simulators:
                simulator.close()


def sweep(
    setup: SetupLike,
    variations: Mapping[str, Iterable[Any]],
    *,
    workers: int = 1,
    device: Optional[Device] = None,
    combine: str = "product",
    sensor: Union[int, str] = 0,
    frames: Optional[Union[int, Iterable[int]]] = None,
    scene: Optional[Scene] = None,
    allow_outside: bool = False,
    **options: Any,
) -> Iterator[Tuple[Variant, Frame]]:
    """Measures many variants of a setup, for which device, pipelines and scene are made once.

    Parameters
    ----------
    setup : path, dict or pmdsim.Setup
        As for `render`.
    variations : dict of str: list
        Paths into the setup, as Simulator.set() takes them, with the values that each gets in turn:
        {"illuminators/0/intensity_w_sr": [1, 2], "nodes/robot": [pose, pose]}. A pose is what Simulator.move() takes.
    workers : int, optional
        Threads, each with a simulator of its own. One frame uses all processor cores where it is large; several
        workers help with small frames.
    device : str or int, optional
        As for `render`.
    combine : "product" or "zip", optional
        Every value with every other, the last path's fastest; or first with first, second with second, ...
    sensor : int or str, optional
        Index or name of the sensor.
    frames : int or iterable of int, optional
        Which frames of each variant; by default frame 0.
    scene : pmdsim.Scene, optional
        Triangles in place of the setup's scene.
    allow_outside : bool, optional
        As `render` takes it.
    **options
        mode, max_error, max_amplitude_error, precision, samples, channels, paths, strict, output_precision, as for
        `render`.

    Yields
    ------
    variant : dict of str: value
        The path's values of this variant.
    frame : Frame
        In the order of the variants, whatever the workers; of several frames `frame.frame` tells which.

    Raises
    ------
    ArgumentError
        An argument is wrong; at once, not with the first frame.
    Error
        What `render` raises; the first ends the sweep.

    Notes
    -----
    At most twice as many variants as there are workers are measured ahead of the one that is asked for. The iterator
    may be left early: its threads end with it.

    Examples
    --------
    >>> radii_m = [0.05, 0.1, 0.15]
    >>> for variant, frame in pmdsim.sweep("room.json", {"illuminators/0/diodes/rings/0/radius_m": radii_m}):
    ...     print(variant, frame.distance_m.mean())                               # doctest: +SKIP
    """
    count = whole_number(workers, "workers", 1, 1024)
    numbers = [0] if frames is None else several(frames)
    chosen = [whole_number(number, "frames", 0, 2**32 - 1) for number in numbers]
    prepared = render_options(**options)
    variants = _variants(variations, combine)
    if count == 1:
        return _in_turn(setup, device, scene, allow_outside, variants, sensor, chosen, prepared)
    return _ahead(setup, device, scene, allow_outside, count, variants, sensor, chosen, prepared)


def _in_turn(
    setup: SetupLike,
    device: Optional[Device],
    scene: Optional[Scene],
    allow_outside: bool,
    variants: Iterator[Variant],
    sensor: Union[int, str],
    frames: Sequence[int],
    options: Any,
) -> Iterator[Tuple[Variant, Frame]]:
    with Simulator(setup, device, scene=scene, allow_outside=allow_outside) as simulator:
        for variant in variants:
            simulator._set(variant, stacklevel=4)
            for frame in frames:
                yield variant, simulator._render(sensor, frame, options, stacklevel=3)


def _ahead(
    setup: SetupLike,
    device: Optional[Device],
    scene: Optional[Scene],
    allow_outside: bool,
    count: int,
    variants: Iterator[Variant],
    sensor: Union[int, str],
    frames: Sequence[int],
    options: Any,
) -> Iterator[Tuple[Variant, Frame]]:
    workers = _Workers(setup, device, scene, allow_outside, count)
    pending: Deque[Tuple[Variant, "Future[List[Frame]]"]] = deque()
    try:
        for variant in itertools.islice(variants, 2 * count):
            pending.append((variant, workers.submit(variant, sensor, frames, options)))
        while pending:
            variant, future = pending.popleft()
            measured = future.result()
            for following in itertools.islice(variants, 1):
                pending.append((following, workers.submit(following, sensor, frames, options)))
            for frame in measured:
                yield variant, frame
    finally:
        workers.stop(future for _, future in pending)
