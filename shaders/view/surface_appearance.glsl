// The look of a shape where a ray meets it: whether it is there at all, and how much it scatters back.
#ifndef PMDSIM_SURFACE_APPEARANCE_GLSL
#define PMDSIM_SURFACE_APPEARANCE_GLSL

#include "shaders/shared/buffers.glsl"
#include "shaders/shared/real.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer ShapePaints { ShapePaint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer SurfacePaints { SurfacePaint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Texels { vec4 at[]; };

// An affine function of the offset from the shape's origin: its gradient and, in w, its value there.
Real affine(vec4 hi, vec4 lo, Real3 offset) {
  return add(dot3(real3(hi.xyz, lo.xyz), offset), real(hi.w, lo.w));
}

Real round_down(Real a) {
  Real nearest = round_to_whole(a);
  return high(add(a, negate(nearest))) < 0.0 ? add(nearest, real(-1.0)) : nearest;
}

// One axis of a texture look-up (Vulkan's and glTF's rules): two texels and the weight of the second.
struct Between {
  uint first, second;
  float weight;
};

uint wrapped(int texel, int size, uint wrap) {
  int folded = texel;
  if (wrap == wrap_repeat)
    folded = texel < 0 ? texel + size : texel >= size ? texel - size : texel;
  else if (wrap == wrap_mirrored_repeat)
    folded = texel < 0 ? -1 - texel : texel >= 2 * size ? texel - 2 * size : texel >= size ? 2 * size - 1 - texel : texel;
  return uint(clamp(folded, 0, size - 1));
}

// `place` in texels, texel i between i and i + 1.
Between between(Real place, uint texels, uint wrap, uint filtering) {
  Real period = real(float(wrap == wrap_mirrored_repeat ? 2u * texels : texels));
  place = wrap == wrap_clamp ? real_clamp(place, -1.0, float(texels) + 1.0)
                             : add(place, negate(multiply(period, round_down(divide(place, period)))));
  Real from = filtering == filter_linear ? add(place, real(-0.5)) : place;
  Real whole = round_down(from);
  int first = int(high(whole)), size = int(texels);
  float weight = filtering == filter_linear ? high(add(from, negate(whole))) : 0.0;
  return Between(wrapped(first, size, wrap), wrapped(first + 1, size, wrap), weight);
}

// Between equal colours exactly that colour, so that an alpha that equals its cutoff makes no holes.
vec4 blend(vec4 a, vec4 b, float weight) { return a + weight * (b - a); }

vec4 texel_at(SurfacePaint surface, Real s, Real t) {
  Between column = between(s, surface.columns, surface.wrap_u, surface.filtering);
  Between row = between(t, surface.rows, surface.wrap_v, surface.filtering);
  Texels texels = Texels(surface.texels);
  uint above = row.first * surface.columns, below = row.second * surface.columns;
  vec4 upper = blend(texels.at[above + column.first], texels.at[above + column.second], column.weight);
  vec4 lower = blend(texels.at[below + column.first], texels.at[below + column.second], column.weight);
  return blend(upper, lower, row.weight);
}

struct Look {
  bool is_there;
  float backscatter; // as in TrianglePlane
};

Look look_of(ShapePaint shape, SurfacePaint surface, Real3 point) {
  Real3 offset = subtract3(point, real3(shape.origin_hi.xyz, shape.origin_lo.xyz));
  vec4 d = vec4(high3(offset), 1.0);
  vec4 vertex_colour = vec4(dot(shape.red, d), dot(shape.green, d), dot(shape.blue, d), dot(shape.alpha, d));
  vec4 colour = vertex_colour * texel_at(surface, affine(shape.s_hi, shape.s_lo, offset),
                                         affine(shape.t_hi, shape.t_lo, offset));
  bool opaque = surface.alpha_cutoff == 0.0 || surface.alpha * colour.a >= surface.alpha_cutoff;
  Real radius = real(shape.origin_hi.w, shape.origin_lo.w);
  bool inside = high(radius) == 0.0 || high(add(dot3(offset, offset), negate(multiply(radius, radius)))) <= 0.0;
  return Look(opaque && inside, max(0.0, dot(surface.backscatter.rgb, colour.rgb) + surface.backscatter.a));
}

Look look_of(uvec2 shape_paints, uvec2 surface_paints, uint id, Real3 point) {
  ShapePaint shape = ShapePaints(shape_paints).at[id];
  return look_of(shape, SurfacePaints(surface_paints).at[shape.surface], point);
}

#endif
