#version 460
// The uniform-pixel pass: from a pixel's IDs to its channels at once, where the pixel shows one surface that all diodes light
// and face, so that few diodes may stand in for all and one point, or four, for all samples. Other pixels are listed for the
// passes that go sample by sample.
#extension GL_GOOGLE_include_directive : require
#include "shaders/sampling/chip.glsl"
#include "shaders/sampling/pixel_list.glsl"
#include "shaders/view/points.glsl"
#include "shaders/signal/demodulation.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Lights {
  UniformPixelsLight at;
  LightRun runs[];
};
layout(buffer_reference, std430, buffer_reference_align = 8) readonly buffer Works { UniformPixelsWork at; };
layout(push_constant, std430) uniform Constants { UniformPixelsConstants constants; };
#define DIAGRAM_VALUES Lights(constants.light).at.diagrams
#include "shaders/light/moments.glsl"
layout(constant_id = constant_general_chip) const uint general_chip = 0;
layout(constant_id = constant_depth_records) const uint depth_records = 0;
layout(constant_id = constant_runs) const uint runs = 1;
layout(constant_id = constant_side) const uint side = 1; // S
layout(constant_id = constant_quadrature_points) const uint quadrature_points = 0;
layout(constant_id = constant_lists_pixels) const uint lists_pixels = lists_in_two;
const bool by_four = quadrature_points == 4;
const uint evaluations = by_four ? 4 : 1;
// The variance of the samples' points, in half steps between them. Four points at its root from the centre each way share all
// moments up to the third with the samples.
float variance() { return float(side * side - 1u) / 3.0; }

// The record has the depth of a pixel's only sample, and no more of its plane is loaded than the light asks for: lavapipe loads
// lane by lane.
TrianglePlane load_seen_plane(uint triangle) {
  if (depth_records == 0)
    return load_plane(constants.planes, triangle);
  uvec2 appearance = load_words(constants.planes, 6 * triangle + 4);
  return TrianglePlane(load_vec4(constants.planes, 3 * triangle), vec4(0.0), uintBitsToFloat(appearance.x), appearance.y, 0.0, 0.0);
}

// Properties that the samples of a pixel share.
struct Seen {
  uvec2 ids;  // of the first
  bool alike; // all have these
  bool lit;   // every diode lights whatever they see
};

// Whether all of the box around the light is in front of a surface.
bool faces(TrianglePlane plane, UniformPixelsLight light) {
  float height = dot(plane.plane_hi.xyz, light.middle_m.xyz) - plane.plane_hi.w;
  return height > dot(abs(plane.plane_hi.xyz), light.extent_m.xyz);
}

// `plane`: that of the first sample; any where it hits nothing.
Seen see(uint pixel, UniformPixelsLight light, out TrianglePlane plane) {
  Strip strip = constants.strip;
  uvec2 in_strip = uvec2(pixel % strip.columns, pixel / strip.columns), extent = uvec2(strip.columns, strip.rows);
  uint diodes = Works(constants.work).at.diodes;
  Seen seen = Seen(uvec2(0), true, true);
  for (uint s = 0; s < side * side; ++s) {
    uvec2 ids = load_ids(constants.ids, id_index(in_strip, uvec2(s % side, s / side), extent, side, tiled != 0), depth_records);
    if (s == 0) {
      seen.ids = ids;
      plane = load_seen_plane(ids.x != 0u ? ids.y : 0u);
    }
    seen.alike = seen.alike && ids == seen.ids;
    if (backscatter_model != backscatter_flat) {
      TrianglePlane of_sample = plane;
      if (s > 0)
        of_sample = load_plane(constants.planes, ids.x != 0u ? ids.y : 0u);
      seen.lit = seen.lit && (ids.x == 0u || faces(of_sample, light));
    }
    if (lit_is_kept != 0)
      seen.lit = seen.lit && (ids.x == 0u || Words(constants.lit).at[s * strip.padded_pixels + pixel] == diodes);
  }
  return seen;
}

// The errors of the points that stand in for a plane pixel's samples, to be multiplied by the condition (docs/theory.md,
// "Quadrature within a pixel"). `ray` leads to the pixel's centre on the chip, `point` is what it meets.
Errors errors_of_quadrature(TrianglePlane plane, vec3 ray, vec3 step_x, vec3 step_y, vec3 point, UniformPixelsLight light) {
  float along = dot(plane.plane_hi.xyz, ray);
  float depth = length(point) / length(ray);
  vec2 tilt = vec2(dot(plane.plane_hi.xyz, step_x), dot(plane.plane_hi.xyz, step_y)) / along;
  vec3 to_x = depth * (step_x - tilt.x * ray), to_y = depth * (step_y - tilt.y * ray); // of the point
  float tilt2 = variance() * dot(tilt, tilt), way2 = variance() * (dot(to_x, to_x) + dot(to_y, to_y));
  float range = length(point);
  float nearest = max(0.0, distance(point, light.middle_m.xyz) - light.extent_m.w);
  // ln w falls by slope / r a metre at most: r^-2, the cosine's r^-1 and the diagram.
  float slope = (3.0 + light.pattern_slope) / nearest;
  float bent = 2.0 * sqrt(tilt2 * way2) + 0.5 * way2 * (1.0 / range + 1.0 / nearest); // of the path
  float amplitude = sqrt(tilt2 * way2) * slope + way2 * (slope * (slope + 1.0 / nearest) + 2.0 * light.wavenumber * light.wavenumber);
  float path = bent + 2.0 * way2 * slope + amplitude * light.spread_m;
  // These are of the second order, which four points have right. Beyond it all is analytic within `nearest`, and the series of
  // what is left begins with the fourth.
  float farthest2 = 3.0 * max(way2 * slope * slope / 9.0, max(tilt2, 4.0 * light.wavenumber * light.wavenumber * way2));
  float share = by_four ? 20.0 * farthest2 : 1.0 + 10.0 * farthest2;
  share = farthest2 < 0.03 ? share : 1.0 / 0.0;
  return Errors(share * 0.5 * path, share * amplitude);
}

// Adds up the terms of all diodes at a point.
void sum_runs(UniformPixelsLight light, Real3 position, vec4 surface, float backscatter, out vec4 z[tones], out vec3 terms) {
  [[unroll]] for (uint t = 0; t < tones; ++t)
    z[t] = vec4(0.0);
  terms = vec3(0.0);
  [[unroll]] for (uint r = 0; r < runs; ++r) {
    LightRun run = Lights(constants.light).runs[r];
    Point point;
    ReferencePath path = see_point(position, surface, run, point);
    float moment[moments];
    Weights weights;
    sum_run(0u, point, run, constants.diodes, r * blocks_per_run, blocks_per_run, moment, weights);
    terms += backscatter > 0.0 ? backscatter * terms_of(weights, point, run) : vec3(0.0);
    [[unroll]] for (uint t = 0; t < tones; ++t) {
      vec2 value = tone_return(moment, path, run, Lights(constants.light).at.tones[t]);
      z[t] = compensated_add(z[t], backscatter > 0.0 ? backscatter * value : vec2(0.0)); // black may not be a number
    }
  }
}

// The results of a pixel's points beside their returns.
struct Quadrature {
  vec3 terms;
  Real range, depth, reference_m; // two sums; the first point's range, which the returns' phases are relative to
  float least_m, most_m;          // of the ranges
};

uvec2 in_frame(uint pixel) {
  Strip strip = constants.strip;
  return uvec2(strip.column, strip.row) + uvec2(pixel % strip.columns, pixel / strip.columns);
}

// The ray to a point of the pixel, given from its centre in half steps between samples.
Real3 ray_to(uint pixel, vec2 from_centre) {
  return general_chip != 0 ? chip_ray(Chips(constants.chip).at, constants.strip, in_frame(pixel), from_centre)
                           : nominal_ray(constants.slope, constants.strip, in_frame(pixel), from_centre);
}

// `z`: the return of each tone.
void add_point(UniformPixelsLight light, TrianglePlane plane, uint triangle, uint pixel, Real3 ray, uint number,
               inout Quadrature sum, inout vec4 z[tones]) {
  Real3 position;
  if (depth_records != 0)
    position = point_at_depth(ray, load_record_depth(constants.ids, pixel));
  else
    position = point_on_plane(ray, plane);
  float backscatter = backscatter_of(constants.shapes, constants.surfaces, high3(ray), position, triangle, plane);
  vec4 of_point[tones];
  vec3 terms;
  sum_runs(light, position, vec4(plane.plane_hi.xyz, -plane.plane_hi.w), backscatter, of_point, terms);
  Real range = length3(position);
  if (number == 0u)
    sum.reference_m = range;
  Real excess = add(range, negate(sum.reference_m));
  [[unroll]] for (uint t = 0; t < tones; ++t) {
    if (!by_four) {
      z[t] = of_point[t];
      continue;
    }
    Real turns = multiply(excess, turns_per_m(Lights(constants.light).at.frequencies[t], 0));
    z[t] = compensated_add(z[t], complex_multiply(compensated_value(of_point[t]), unit_phasor(turn_fraction(turns))));
  }
  sum.terms += terms;
  sum.range = add(sum.range, range);
  sum.depth = add(sum.depth, position.z);
  sum.least_m = min(sum.least_m, high(range));
  sum.most_m = max(sum.most_m, high(range));
}

Quadrature sum_points(UniformPixelsLight light, TrianglePlane plane, uint triangle, uint pixel, out vec4 z[tones]) {
  Quadrature sum = Quadrature(vec3(0.0), real(0.0), real(0.0), real(0.0), 1.0 / 0.0, 0.0);
  [[unroll]] for (uint t = 0; t < tones; ++t)
    z[t] = vec4(0.0);
  [[unroll]] for (uint p = 0; p < evaluations; ++p) { // lavapipe fetches lane by lane in loops
    vec2 side_of = vec2((p & 1u) == 0u ? -1.0 : 1.0, (p & 2u) == 0u ? -1.0 : 1.0);
    vec2 from_centre = by_four ? sqrt(variance()) * side_of : vec2(0.0);
    add_point(light, plane, triangle, pixel, ray_to(pixel, from_centre), p, sum, z);
  }
  return sum;
}

// Stores a pixel's channels and returns whether what was asked for of them holds; `worst` is what they may be off by.
bool store_pixel(Channels to, UniformPixelsLight light, uint pixel, bool hits, Quadrature seen, vec4 z[tones], Errors added,
                 out Errors worst) {
  bool kept = true;
  worst = Errors(0.0, 0.0);
  [[unroll]] for (uint t = 0; t < tones; ++t) {
    Frequency frequency = Lights(constants.light).at.frequencies[t];
    PixelSum sum;
    see_nothing(sum);
    if (hits) {
      sum.z[0] = z[t];
      sum.range = seen.range;
      sum.depth = seen.depth;
      sum.reference_m = seen.reference_m;
      sum.hits = sum.lit = evaluations;
    }
    Return of_pixel = store_return(to, frequency, evaluations, pixel, sum);
    Errors errors = errors_of(frequency, hits ? seen.terms : vec3(0.0), of_pixel, added, hits ? seen.most_m - seen.least_m : 0.0);
    kept = kept && is_kept(frequency, errors);
    worst = Errors(max(worst.distance_m, errors.distance_m), max(worst.amplitude, errors.amplitude));
    store_bound(to, frequency, pixel, of_pixel, errors);
    if (t == 0) {
      if (ground_truth != 0)
        store_ground_truth(to, evaluations, pixel, sum);
      if (lit_is_kept != 0)
        store_lit(to, Works(constants.work).at.lit_channel, 1u, pixel, sum);
    }
  }
  return kept;
}

// Half a step from sample to sample, in a ray (x, y, 1).
vec3 half_step(uint axis, uvec2 pixel) {
  if (general_chip == 0)
    return axis == 0 ? vec3(constants.slope.x, 0.0, 0.0) : vec3(0.0, constants.slope.z, 0.0);
  ChipPlace chip = Chips(constants.chip).at;
  float depth = high(place_on_chip(chip, constants.strip, pixel, vec2(0.0)).z);
  return (axis == 0 ? chip.half_step_x_hi.xyz : chip.half_step_y_hi.xyz) / depth;
}

Errors errors_of_pixel(UniformPixelsLight light, TrianglePlane plane, uint pixel, bool hits, Quadrature of_pixel) {
  if (side == 1 || !hits)
    return Errors(0.0, 0.0);
  Real3 ray = ray_to(pixel, vec2(0.0));
  uvec2 at = in_frame(pixel);
  Errors errors = errors_of_quadrature(plane, high3(ray), half_step(0, at), half_step(1, at), high3(point_on_plane(ray, plane)), light);
  if (by_four && side == 2) // these are the samples
    errors = Errors(0.0, 0.0);
  if (by_four && of_pixel.most_m - of_pixel.least_m > light.point_spread_m)
    errors = Errors(1.0 / 0.0, 1.0 / 0.0);
  return errors;
}

void main() {
  Strip strip = constants.strip;
  uint to = gl_GlobalInvocationID.x; // beyond the last pixel is room for what only pads
  if (by_four)
    to = listed_pixel(PixelLists(Works(constants.work).at.lists[list_refined]), to, strip.padded_pixels);
  bool pads = to >= strip.columns * strip.rows;
  uint pixel = pads ? 0u : to;
  UniformPixelsLight light = Lights(constants.light).at;
  TrianglePlane plane;
  Seen seen = see(pixel, light, plane);
  bool done = false;
  if (runs > 0) {
    bool hits = seen.ids.x != 0u;
    uint triangle = hits ? seen.ids.y : 0u;
    vec4 z[tones];
    Quadrature quadrature = sum_points(light, plane, triangle, pixel, z);
    Errors added = errors_of_pixel(light, plane, pixel, hits, quadrature);
    Channels channels = Channels(constants.channels, strip.padded_pixels);
    Errors worst;
    bool kept = store_pixel(channels, light, to, hits, quadrature, z, added, worst);
    if (ground_truth != 0)
      store_ids(channels, seen.ids, plane.object, to);
    done = seen.alike && seen.lit && kept && (side == 1 || quadrature_points != 0 || !hits);
    if (done && !pads && hits)
      report_kept(Works(constants.work).at.violations, worst);
  }
  if (lists_pixels != lists_no_pixel && !done && !pads) {
    uint list = seen.lit && lists_pixels != lists_in_rest ? list_unshadowed : list_rest;
    if (lists_pixels == lists_in_three)
      list = seen.alike && seen.lit ? list_refined : list;
    append_pixel(PixelLists(Works(constants.work).at.lists[list]), pixel);
  }
}
