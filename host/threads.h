#pragma once
// How many threads the process may have.

namespace pmdsim {

// TBB, and Embree with it, counts on a thread for each processor, and waits for ever where the system refuses
// to start one, as it does beyond a limit of processes (ulimit -u, a control group's pids.max). Where it
// refuses now, TBB is told to make do with those that start.
//
// To be called before TBB begins its work, and again where others have taken threads, as a device's driver
// does, which ends in an error of its own where it gets none.
void settle_threads();

} // namespace pmdsim
