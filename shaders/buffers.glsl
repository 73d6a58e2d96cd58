// Buffers by their device address.
#ifndef PMDSIM_BUFFERS_GLSL
#define PMDSIM_BUFFERS_GLSL

#include "interface.h"

layout(buffer_reference, std430, buffer_reference_align = 16) buffer Vec4s { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Floats { float at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Tags { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Planes { TrianglePlane at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Diodes { GroupDiode at[]; };

#endif
