"""The shipped Dask examples on a cluster of this machine whose workers are killed while they work.

    dask_workers.py PROGRAM

The shares together are the same bytes as one run, and the array of frames is what the program writes. Ends with 77, for
CTest "skipped", where Dask is not installed.
"""

import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from pathlib import Path

try:
    import dask.array  # noqa: F401
    import numpy
    from distributed import LocalCluster
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

source = Path(__file__).resolve().parents[2]
examples = source / "host" / "clusters"
shards = 8


def write_setup(folder):
    """A moving scene, 40 frames of about 0.3 s."""
    text = (source / "scenes" / "motion.json").read_text()
    for old, new in [
        ('"resolution": [160, 120]', '"resolution": [320, 240], "samples": 4'),
        ("45e-6, 45e-6", "22.5e-6, 22.5e-6"),
        ('"count": 20}', '"count": 40}'),
    ]:
        assert old in text, f"scenes/motion.json has no {old}"
        text = text.replace(old, new)
    shutil.copy(source / "scenes" / "moving.gltf", folder)
    (folder / "setup.json").write_text(text)
    return folder / "setup.json"


def data_of(folder):
    """The hash of each file but of records, which have times in them."""
    return {
        str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in sorted(folder.rglob("*"))
        if file.is_file() and not file.name.endswith(".record.json") and file.name != "run.json"
    }


def records(folder):
    return len(list(folder.rglob("*.record.json")))


class Killer(threading.Thread):
    """Kills a worker each time that some more frames are there; the nannies start others."""

    def __init__(self, cluster, out):
        super().__init__(daemon=True)
        self.cluster, self.out, self.killed, self.over = cluster, out, [], threading.Event()

    def run(self):
        for least in (3, 12, 20):
            while records(self.out) < least:
                if self.over.wait(0.05):
                    return
            worker = list(self.cluster.workers.values())[least % 2]
            pid = worker.pid  # the nanny's child; None while there is none
            if pid:
                os.kill(pid, signal.SIGKILL)
                self.killed.append(pid)


def check_shards(cluster, program, setup, folder):
    subprocess.run([program, "render", setup, "-o", folder / "one", "--format", "npy"], check=True, capture_output=True)
    killer = Killer(cluster, folder / "out")
    killer.start()
    done = subprocess.run(
        [sys.executable, examples / "dask_shards.py", setup, folder / "out", "--shards", str(shards)]
        + ["--scheduler", cluster.scheduler_address, "--program", program, "--option=--format", "--option=npy"],
        capture_output=True,
        text=True,
        timeout=300,
    )
    killer.over.set()
    assert done.returncode == 0, done.stderr
    assert len(killer.killed) == 3, f"expected 3 dead workers, found {len(killer.killed)}"
    one, merged = data_of(folder / "one"), data_of(folder / "out" / "all")
    assert len(one) > 40 and one == merged, f"files differ: {set(one.items()) ^ set(merged.items())}"
    # A dead worker's program may be at work a moment longer than the others.
    deadline = time.monotonic() + 30
    while (left := list((folder / "out").rglob("*.partial"))) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert not left, left
    print(f"{shards} shares by 2 workers, {len(killer.killed)} of which were killed: the same bytes as one run")


def check_array(cluster, setup, folder):
    """The means of an array's frames are those of the files of one run, but for the order of sums."""
    done = subprocess.run(
        [sys.executable, examples / "dask_array.py", setup, "--scheduler", cluster.scheduler_address]
        + ["--save", folder / "mean.npy"],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    frames = numpy.stack([numpy.load(file) for file in sorted((folder / "one").glob("pmd_*.distance_m.npy"))])
    assert len(frames) == 40
    warnings.simplefilter("ignore", RuntimeWarning)  # of pixels that never see anything
    expected = numpy.nanmean(frames.astype(float), axis=0)
    found = numpy.load(folder / "mean.npy")
    assert numpy.array_equal(numpy.isnan(found), numpy.isnan(expected))
    error_m = numpy.nanmax(numpy.abs(found - expected))
    assert error_m < 1e-5, f"means differ by {error_m} m"
    print("an array of 40 frames by 2 workers: as in the files")


def end_programs(folder):
    """Ends what dead workers have left at work in `folder`."""
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            if str(folder).encode() in (entry / "cmdline").read_bytes() and int(entry.name) != os.getpid():
                os.kill(int(entry.name), signal.SIGKILL)
        except OSError:
            pass  # it has ended by itself


def main():
    program = sys.argv[1]
    folder = Path(tempfile.mkdtemp(prefix="pmdsim_test."))
    try:
        setup = write_setup(folder)
        with LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            processes=True,
            dashboard_address=None,
            host="127.0.0.1",
            local_directory=str(folder / "dask"),
        ) as cluster:
            check_shards(cluster, program, setup, folder)
            check_array(cluster, setup, folder)
    finally:
        end_programs(folder)
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
