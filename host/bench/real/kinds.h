#pragma once
// Kinds of procedural scenes: what cameras see, from smooth bodies to grass, and what is awkward for whatever
// traces them. The lens is in the world's origin and looks along -Z, half its view has the tangent 0.5; what
// is seen lies 0.2 to 6 m before it.

#include "engine/model/scene.h"

#include <cstdint>
#include <span>
#include <string_view>

namespace pmdsim {

struct SceneKind {
  const char *name; // "blob"
  const char *about;
  bool awkward; // tests want it and benchmarks do not
  // The scene of about that many triangles, 1000 at least; the same one every time.
  Scene (*make)(std::uint32_t triangles);
};

// All, the awkward ones last.
std::span<const SceneKind> scene_kinds();

// Nothing where there is none of that name.
const SceneKind *find_kind(std::string_view name);

// Smooth and rough bodies.
Scene blob(std::uint32_t triangles);
Scene knot(std::uint32_t triangles);
Scene scan(std::uint32_t triangles);
Scene head(std::uint32_t triangles);
Scene terrain(std::uint32_t triangles);
// Many thin parts.
Scene lattice(std::uint32_t triangles);
Scene blades(std::uint32_t triangles);
Scene forest(std::uint32_t triangles);
// Buildings, furniture and people.
Scene colonnade(std::uint32_t triangles);
Scene crowd(std::uint32_t triangles);
Scene furnished(std::uint32_t triangles);
// Awkward.
Scene soup(std::uint32_t triangles);
Scene fans(std::uint32_t triangles);
Scene flipped(std::uint32_t triangles);
Scene touching(std::uint32_t triangles);
Scene piercing(std::uint32_t triangles);
Scene close_body(std::uint32_t triangles);
Scene needles(std::uint32_t triangles);

} // namespace pmdsim
