#pragma once
// Whether a frame keeps the error that was asked for.

#include "engine/model/accuracy.h"
#include "shaders/shared/interface.h"

#include <optional>
#include <string>

namespace pmdsim {

// Why not; nothing where no pixel's bound is beyond it (`broken`) and none that was checked is (`found`). The
// ambiguity range is that of the distances.
std::optional<std::string> promise_breach(const shader::BrokenPromise &broken, const AccuracyReport &found,
                                          const Accuracy &asked_for, double ambiguity_m);

} // namespace pmdsim
