#pragma once
// How the scene's shapes are painted, as the shaders read it, empty where nothing is; and all that the passes
// look up about the scene by a shape's id.

#include "engine/view/camera_scene.h"
#include "engine/vulkan/buffer.h"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace pmdsim {

// The textures on the device, which outlast the frame that they were uploaded for.
class TextureCache {
public:
  explicit TextureCache(const vulkan::Device &device) : device_(device) {}

  std::shared_ptr<const vulkan::Buffer> buffer_of(const std::shared_ptr<const Texture> &texture);
  // Drops the textures that no PaintBuffers hold.
  void drop_unused();

private:
  const vulkan::Device &device_;
  std::map<std::shared_ptr<const Texture>, std::shared_ptr<const vulkan::Buffer>> buffers_;
};

struct PaintBuffers {
  vulkan::Buffer shapes;                                       // ShapePaint of each of the scene's shapes
  vulkan::Buffer surfaces;                                     // SurfacePaint of each of its surfaces
  std::vector<std::shared_ptr<const vulkan::Buffer>> textures; // of each of its surfaces
  bool painted = false; // whether any shape that the lens can see is; else all else is empty
  bool cutouts = false; // whether any may have holes, or is a disc
};

// The uses of paint that a frame has to model.
struct PaintUse {
  bool painted = false;            // whether any shape that the lens can see is
  bool cutouts = false;            // whether any of these may have holes, or is a disc
  bool holes_in_the_light = false; // whether light may pass through shapes that the lens does not see
};

PaintUse paint_use(const CameraScene &camera, const Scene &scene);

// Empty where nothing is painted.
PaintBuffers upload_paint(const vulkan::Device &device, const PaintUse &use, const CameraScene &camera,
                          const Scene &scene, Backscatter backscatter, TextureCache &textures);

struct SceneBuffers {
  vulkan::Buffer planes; // TrianglePlane of each of the scene's shapes
  PaintBuffers paint;
  std::optional<float> backscatter; // TrianglePlane's, where all that the lens can see has the same
  double world_rounding_m;          // as in CameraScene
};

} // namespace pmdsim
