"""The frames of a setup as a dask.array, (frames, rows, columns), measured by the workers of a Dask cluster when they are
needed and never all in one memory.

    python3 dask_array.py SETUP [--channel distance_m] [--scheduler ADDRESS] [--save FILE.npy]

Prints mean and standard deviation over all frames; --save keeps their means pixel by pixel. A worker needs the module
pmdsim and the setup's files. What a worker that dies had measured is measured again by another.
"""

import argparse
from pathlib import Path

import dask
import dask.array
import numpy
from distributed import Client, LocalCluster

import pmdsim


@dask.delayed(pure=True)
def measure(setup, sensor, frame, channel):
    """rows x columns; a copy, so that the rest of the frame can go."""
    return pmdsim.render(setup, sensor=sensor, frame=frame, channels=[channel])[channel].copy()


def frames_of(setup, channel, sensor=0):
    """Nothing is measured yet but the first frame, which tells the shape."""
    with pmdsim.Simulator(setup) as simulator:
        first = simulator.render(sensor=sensor, channels=[channel])[channel]
        count = simulator.frame_count
    return dask.array.stack(
        [
            dask.array.from_delayed(measure(setup, sensor, frame, channel), first.shape, first.dtype)
            for frame in range(count)
        ]
    )


def main():
    parser = argparse.ArgumentParser(description="The frames of a setup as a dask.array.")
    parser.add_argument("setup", type=Path)
    parser.add_argument("--channel", default="distance_m", help="[distance_m]")
    parser.add_argument("--scheduler", help="address of a cluster that is there, tcp://HOST:8786")
    parser.add_argument("--workers", type=int, help="without a scheduler: processes of this machine [its cores]")
    parser.add_argument("--save", type=Path, help="the mean of each pixel, .npy")
    chosen = parser.parse_args()
    cluster = chosen.scheduler or LocalCluster(
        n_workers=chosen.workers, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
    )
    with dask.config.set({"distributed.scheduler.allowed-failures": 20}), Client(cluster):
        frames = frames_of(str(chosen.setup.resolve()), chosen.channel)
        pixels, mean, deviation = dask.compute(
            dask.array.nanmean(frames, axis=0), dask.array.nanmean(frames), dask.array.nanstd(frames)
        )
    print(f"{chosen.channel} of {frames.shape[0]} frames: {mean:.6g} +- {deviation:.6g}")
    if chosen.save:
        numpy.save(chosen.save, pixels)


if __name__ == "__main__":
    main()
