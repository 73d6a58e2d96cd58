// The beginning of headers that GLSL and C++ both read.
#ifndef PMDSIM_LANGUAGES_H
#define PMDSIM_LANGUAGES_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
namespace pmdsim::shader {
using uint = std::uint32_t;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec4;
} // namespace pmdsim::shader
#define PMDSIM_CONSTANT inline constexpr uint
#else
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#define PMDSIM_CONSTANT const uint
#endif

#endif
