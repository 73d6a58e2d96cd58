"""Calls of the library that Ctrl-C can end.

Python hears of a signal only between two of its own steps, in the main thread. So there a call that may take long
runs in a thread of its own, and the main thread waits for it in a way that signals end.
"""

from __future__ import annotations

import atexit
import threading
import time
from queue import SimpleQueue
from typing import Any, Callable, Optional, TypeVar

Result = TypeVar("Result")

# How long a cancelled call may take to end before Ctrl-C goes on without it, and before the process ends, seconds.
patience_s = 0.9
_patience_at_exit_s = 60.0


class _Job:
    __slots__ = ("function", "done", "result", "error")

    def __init__(self, function: Callable[[], Any]) -> None:
        self.function = function
        self.done = threading.Lock()
        self.done.acquire()
        self.result: Any = None
        self.error: Optional[BaseException] = None


def _work(jobs: "SimpleQueue[Optional[_Job]]") -> None:
    while True:
        job = jobs.get()
        if job is None:
            return
        try:
            job.result = job.function()
        except BaseException as error:  # whatever it is, it is the caller's
            job.error = error
        job.done.release()
        del job  # else it would hold its result until the next one


def _nothing() -> None:
    pass


class Caller:
    """Runs functions one after the other; `cancel` ends the one that runs."""

    def __init__(self, cancel: Callable[[], None]) -> None:
        self._cancel = cancel
        self._jobs: "Optional[SimpleQueue[Optional[_Job]]]" = None
        self._thread: Optional[threading.Thread] = None
        self.lost = False  # a call did not end when it was cancelled

    def __call__(self, function: Callable[[], Result]) -> Result:
        if threading.current_thread() is not threading.main_thread():
            return function()
        if self._jobs is None:
            jobs: "SimpleQueue[Optional[_Job]]" = SimpleQueue()
            self._thread = threading.Thread(target=_work, args=(jobs,), name="pmdsim", daemon=True)
            self._thread.start()
            self._jobs = jobs
        job = _Job(function)
        try:
            self._jobs.put(job)
            job.done.acquire()
        except BaseException:
            self._end(self._jobs)
            raise
        if job.error is not None:
            try:
                raise job.error
            finally:
                del job
        return job.result

    def _end(self, jobs: "SimpleQueue[Optional[_Job]]") -> None:
        """Waits until the thread is through with all that it was given, which includes a job that the signal may
        or may not have let in."""
        self.lost = True
        last = _Job(_nothing)
        jobs.put(last)
        give_up = time.monotonic() + patience_s
        while time.monotonic() < give_up:
            self._cancel()  # again and again: the call may not have begun
            if last.done.acquire(timeout=0.02):
                self.lost = False
                return
        if self._thread is not None:  # the library may not be taken down under it
            atexit.register(self._thread.join, _patience_at_exit_s)
        self.stop()

    def stop(self) -> None:
        """Lets the thread end when it is through."""
        jobs, self._jobs = self._jobs, None
        if jobs is not None:
            jobs.put(None)
