// Pixels that wait for their samples to be summed.
#ifndef PMDSIM_PIXEL_LIST_GLSL
#define PMDSIM_PIXEL_LIST_GLSL

#include "shaders/shared/interface.h"

layout(buffer_reference, std430, buffer_reference_align = 16) buffer PixelLists {
  PixelList head;
  uint pixels[];
};

// Invocations work through the list's pixels in whole workgroups. Those beyond its end get places of their own among the
// padding after the strip's last pixel.
uint listed_pixel(PixelLists list, uint at, uint padded_pixels) {
  return at < list.head.count ? list.pixels[at] : padded_pixels - workgroup_size + at % workgroup_size;
}

void append_pixel(PixelLists list, uint pixel) {
  uint at = atomicAdd(list.head.count, 1u);
  list.pixels[at] = pixel;
}

uint padded_count(PixelLists list) { return (list.head.count + workgroup_size - 1) / workgroup_size * workgroup_size; }

// The sample of an invocation, where there is one for each.
uint listed_sample(PixelLists list, uint invocation, uint padded_pixels) {
  uint count = padded_count(list);
  return invocation / count * padded_pixels + listed_pixel(list, invocation % count, padded_pixels);
}

#endif
