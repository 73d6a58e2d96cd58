#pragma once
// A point cloud seen from the side.

#include "host/output/clouds/cloud.h"
#include "host/output/clouds/cloud_view.h"
#include "host/output/pictures/canvas.h"

#include <string>
#include <vector>

namespace pmdsim {

// From the left of the camera and above it, in perspective, with the nearest point in front, the camera where
// it is not far off, a scale, and what the colours mean.
class CloudPicture {
public:
  // A view of the cloud, which must outlive it. Most of the work; needs no drawing_mutex().
  explicit CloudPicture(const PointCloud &cloud);

  Canvas draw(const std::string &title) const;

private:
  void fill();

  const PointCloud &cloud_;
  CloudView view_;
  std::vector<Colour> colours_; // of the picture's pixels, row by row
};

} // namespace pmdsim
