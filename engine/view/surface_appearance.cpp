#include "engine/view/surface_appearance.h"

#include "engine/sampling/strip_memory.h"
#include "engine/vulkan/float_pair.h"

#include <algorithm>
#include <array>
#include <span>

namespace pmdsim {
namespace {

// Gradients of a triangle's barycentric coordinates of b and c.
struct Barycentric {
  glm::dvec3 b, c;
};

Barycentric barycentric(const std::array<glm::dvec3, 3> &corners_m) {
  const glm::dvec3 ab = corners_m[1] - corners_m[0], ac = corners_m[2] - corners_m[0];
  const glm::dvec3 normal = glm::cross(ab, ac);
  const double length2 = glm::dot(normal, normal);
  return {glm::cross(ac, normal) / length2, glm::cross(normal, ab) / length2};
}

// Per-vertex values of one shape as affine functions of the offset from its origin.
class Interpolation {
public:
  Interpolation(const CameraTriangle &shape, const Scene &scene) {
    if (scene.is_disc(shape.id)) {
      vertices_.fill(scene.discs[shape.id - scene.triangles.size()].vertex);
    } else {
      vertices_ = scene.triangles[shape.id].vertices;
      gradients_ = barycentric(shape.corners_m);
    }
  }

  // `value` gives what a vertex has.
  template <class Value>
  glm::dvec4 affine(Value value) const {
    const double a = value(vertices_[0]), b = value(vertices_[1]), c = value(vertices_[2]);
    return {(b - a) * gradients_.b + (c - a) * gradients_.c, a};
  }

private:
  std::array<std::uint32_t, 3> vertices_;
  Barycentric gradients_{glm::dvec3(0.0), glm::dvec3(0.0)};
};

void set_texture_coordinates(shader::ShapePaint &record, const Interpolation &shape, const Scene &scene,
                             const Texture &texture) {
  const auto axis = [&](glm::length_t k) {
    return shape.affine([&](std::uint32_t vertex) {
      return scene.texture_coordinates[vertex][k] * static_cast<double>(texture.size[k]);
    });
  };
  const DoublePair4 s(axis(0)), t(axis(1));
  record.s_hi = s.hi;
  record.s_lo = s.lo;
  record.t_hi = t.hi;
  record.t_lo = t.lo;
}

void set_colours(shader::ShapePaint &record, const Interpolation &shape, const Scene &scene) {
  const auto channel = [&](glm::length_t k) {
    return scene.colours.empty() ? glm::vec4(0, 0, 0, 1) : glm::vec4(shape.affine([&](std::uint32_t vertex) {
      return static_cast<double>(scene.colours[vertex][k]);
    }));
  };
  record.red = channel(0);
  record.green = channel(1);
  record.blue = channel(2);
  record.alpha = channel(3);
}

shader::ShapePaint shape_paint(const CameraTriangle &shape, const Scene &scene) {
  const bool disc = scene.is_disc(shape.id);
  const DoublePair4 origin(disc ? (shape.corners_m[0] + shape.corners_m[1] + shape.corners_m[2]) / 3.0
                                : shape.corners_m[0],
                           disc ? scene.discs[shape.id - scene.triangles.size()].radius_m : 0.0);
  shader::ShapePaint record{};
  record.origin_hi = origin.hi;
  record.origin_lo = origin.lo;
  record.red = record.green = record.blue = record.alpha = glm::vec4(0, 0, 0, 1);
  record.surface = scene.surface_of(shape.id);
  if (const auto &paint = scene.surfaces[record.surface].paint) {
    const Interpolation interpolation(shape, scene);
    set_colours(record, interpolation, scene);
    if (paint->texture && !scene.texture_coordinates.empty())
      set_texture_coordinates(record, interpolation, scene, *paint->texture);
  }
  return record;
}

// By the shapes' ids.
std::vector<shader::ShapePaint> shape_paints(const CameraScene &camera, const Scene &scene) {
  std::vector<shader::ShapePaint> records(scene.shape_count());
  for (const auto *shapes : {&camera.triangles, &camera.hidden})
    for (const CameraTriangle &shape : *shapes)
      records[shape.id] = shape_paint(shape, scene);
  return records;
}

shader::uint wrap_of(Wrap wrap) {
  return wrap == Wrap::repeat            ? shader::wrap_repeat
         : wrap == Wrap::mirrored_repeat ? shader::wrap_mirrored_repeat
                                         : shader::wrap_clamp;
}

const std::shared_ptr<const Texture> &white() {
  static const auto texture = std::make_shared<const Texture>(Texture{{1, 1}, {glm::vec4(1.0f)}});
  return texture;
}

const std::shared_ptr<const Texture> &texture_of(const Surface &surface, const Scene &scene) {
  return surface.paint && surface.paint->texture && !scene.texture_coordinates.empty()
             ? surface.paint->texture
             : white();
}

shader::SurfacePaint surface_paint(const Surface &surface, const Texture &texture,
                                   const vulkan::Buffer &texels, double per_reflectivity) {
  const Paint paint = surface.paint.value_or(Paint{});
  return {glm::vec4(per_reflectivity * glm::dvec4(paint.reflectivity_rgb, surface.reflectivity)),
          texels.words(),
          texture.size.x,
          texture.size.y,
          wrap_of(paint.wrap_u),
          wrap_of(paint.wrap_v),
          paint.filter == TextureFilter::linear ? shader::filter_linear : shader::filter_nearest,
          static_cast<float>(paint.alpha),
          static_cast<float>(paint.alpha_cutoff),
          0,
          0,
          0};
}

} // namespace

std::shared_ptr<const vulkan::Buffer> TextureCache::buffer_of(const std::shared_ptr<const Texture> &texture) {
  std::shared_ptr<const vulkan::Buffer> &buffer = buffers_[texture];
  if (!buffer)
    buffer = std::make_shared<const vulkan::Buffer>(
        vulkan::upload(device_, std::as_bytes(std::span(texture->texels))));
  return buffer;
}

void TextureCache::drop_unused() {
  std::erase_if(buffers_, [](const auto &entry) { return entry.second.use_count() == 1; });
}

PaintUse paint_use(const CameraScene &camera, const Scene &scene) {
  const auto is_masked = [&](const CameraTriangle &shape) { return scene.is_masked(shape.id); };
  PaintUse use;
  for (const CameraTriangle &shape : camera.triangles) {
    const bool disc = scene.is_disc(shape.id);
    use.painted = use.painted || disc || scene.surfaces[scene.surface_of(shape.id)].paint;
    use.cutouts = use.cutouts || disc || is_masked(shape);
  }
  // Holes that the lens does not see let light through all the same.
  use.holes_in_the_light = std::ranges::any_of(camera.hidden, is_masked);
  return use;
}

PaintBuffers upload_paint(const vulkan::Device &device, const PaintUse &use, const CameraScene &camera,
                          const Scene &scene, Backscatter backscatter, TextureCache &textures) {
  PaintBuffers buffers;
  buffers.painted = use.painted;
  buffers.cutouts = use.cutouts;
  if (!use.painted && !use.holes_in_the_light)
    return buffers;
  const std::vector<shader::ShapePaint> shapes = shape_paints(camera, scene);
  buffers.shapes = vulkan::upload(device, std::as_bytes(std::span(shapes)));
  std::vector<shader::SurfacePaint> surfaces;
  for (const Surface &surface : scene.surfaces) {
    const std::shared_ptr<const Texture> &texture = texture_of(surface, scene);
    buffers.textures.push_back(textures.buffer_of(texture));
    surfaces.push_back(surface_paint(surface, *texture, *buffers.textures.back(),
                                     backscatter_per_reflectivity(backscatter)));
  }
  buffers.surfaces = vulkan::upload(device, std::as_bytes(std::span(surfaces)));
  return buffers;
}

} // namespace pmdsim
