#pragma once
// The shadow pass behind the sweep, for the light that triangles with holes and discs keep off. They have no
// silhouettes that the mesh knows, so the light's way is tested with each of them that it may meet.

#include "engine/light/accumulate_pass.h"
#include "engine/light/source_windows.h"
#include "engine/sampling/sample_grid.h"
#include "shaders/shadow/occluder.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace pmdsim {

class HolesPass {
public:
  // `records`: given where samples are depth records. Throws Error (out_of_memory).
  HolesPass(const PassSetup &on, const std::vector<shader::Occluder> &shapes, const SourceGroups &groups,
            const std::vector<SourceWindow> &windows, std::span<const PlannedStrip> strips,
            const std::optional<ChipGrid> &records);
  ~HolesPass();

  // Clears bits in the strip's visibility, and takes their diodes off `lit`.
  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip, std::size_t window) const;

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pmdsim
