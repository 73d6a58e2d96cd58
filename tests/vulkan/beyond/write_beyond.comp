#version 460
// Writes a word of a buffer, wherever that is: what the checks of shaders shall find.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

layout(local_size_x = 1) in;
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Words { uint at[]; };
layout(push_constant, std430) uniform Constants {
  uvec2 words;
  uint index;
};

void main() { Words(words).at[index] = 1u; }
