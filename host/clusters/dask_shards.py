"""Measures the frames of a setup by the workers of a Dask cluster, into files as `pmdsim render` writes them.

    python3 dask_shards.py SETUP OUT [--shards N] [--scheduler ADDRESS] [--option=OPTION ...]

Each task is one share of the frames, measured by a process of its own into OUT/shard_I. The results are then put
together in OUT/all: the same bytes as those of one run. OUT must be on a file system that all workers see. Without
--scheduler the workers are processes of this machine.

Workers may die at any moment. Their nannies start new ones, and the tasks begin again behind the last frame that is
whole. The dead worker's program may still be at work then: two that write into one folder share the frames.
"""

import argparse
import subprocess
import sys
from pathlib import Path

try:
    import dask
    from distributed import Client, LocalCluster, as_completed
except ImportError as missing:
    if not {"-h", "--help"} & set(sys.argv):
        sys.exit(f"{Path(sys.argv[0]).name}: expected the packages dask and distributed: {missing}")


def arguments():
    parser = argparse.ArgumentParser(description="Frames of a setup by the workers of a Dask cluster.")
    parser.add_argument("setup", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--shards", type=int, default=8, help="several times as many as there are workers [8]")
    parser.add_argument("--scheduler", help="address of a cluster that is there, tcp://HOST:8786")
    parser.add_argument("--workers", type=int, help="without a scheduler: processes of this machine [its cores]")
    parser.add_argument("--program", default="pmdsim", help="[pmdsim]")
    parser.add_argument("--option", action="append", default=[], help="one of `pmdsim render`, several times")
    return parser.parse_args()


def pmdsim(command):
    """Runs the program; its error is this task's error."""
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} ended with {done.returncode}: {done.stderr.strip()}")


def measure(program, setup, folder, shard, shards, options):
    """One share of the frames: what of it is there already is kept."""
    pmdsim([program, "render", setup, "-o", folder, "--shard", f"{shard}/{shards}", "--resume", *options])
    return folder


def cluster_of(chosen):
    if chosen.scheduler:
        return chosen.scheduler
    return LocalCluster(
        n_workers=chosen.workers, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
    )


def main():
    chosen = arguments()
    setup, out = str(chosen.setup.resolve()), chosen.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    # A share on whose worker died is no suspect before that happened many times; a scheduler that is there has its own say.
    with dask.config.set({"distributed.scheduler.allowed-failures": 20}), Client(cluster_of(chosen)) as client:
        folders = [str(out / f"shard_{shard:04d}") for shard in range(chosen.shards)]
        shares = [
            client.submit(
                measure, chosen.program, setup, folder, shard, chosen.shards, chosen.option, pure=False, retries=2
            )
            for shard, folder in enumerate(folders)
        ]
        for done, share in enumerate(as_completed(shares), 1):
            print(f"{done} of {len(shares)}: {share.result()}", flush=True)
    pmdsim([chosen.program, "merge", *folders, "-o", str(out / "all")])
    print(f"all frames are in {out / 'all'}")


if __name__ == "__main__":
    main()
