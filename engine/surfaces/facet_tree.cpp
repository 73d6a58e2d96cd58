#include "engine/surfaces/facet_tree.h"

#include "engine/model/error.h"

#include <algorithm>

namespace pmdsim {
namespace {

[[noreturn]] void refuse_memory() {
  throw Error(ExitCode::out_of_memory, "not enough memory for the tree over the scene that light bounces in");
}

// Ends the hits of a packet that fall into cutouts.
void pass_holes(const RTCFilterFunctionNArguments *arguments) {
  const auto *tree = static_cast<const FacetTree *>(arguments->geometryUserPtr);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0)
      continue;
    const unsigned facet = RTCHitN_primID(arguments->hit, arguments->N, i);
    const float u = RTCHitN_u(arguments->hit, arguments->N, i),
                v = RTCHitN_v(arguments->hit, arguments->N, i);
    if (!tree->is_there(facet, u, v))
      arguments->valid[i] = 0;
  }
}

// Each facet has corners of its own.
void set_corners(RTCGeometry geometry, const std::vector<Facet> &facets) {
  auto *corners = static_cast<glm::vec3 *>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * facets.size()));
  auto *indices = static_cast<glm::uvec3 *>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), facets.size()));
  if (!corners || !indices)
    refuse_memory();
  for (std::size_t i = 0; i < facets.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      corners[3 * i + k] = glm::vec3(facets[i].corners_m[k]);
    indices[i] = static_cast<std::uint32_t>(3 * i) + glm::uvec3(0, 1, 2);
  }
}

RTCIntersectContext coherent_rays() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

} // namespace

FacetTree::FacetTree(const Scene &scene, const Elements &elements) : scene_(scene) {
  bool has_holes = false;
  for (const Facet &facet : elements.facets) {
    triangles_.push_back(facet.triangle);
    has_holes = has_holes || scene.is_masked(facet.triangle);
  }
  device_ = rtcNewDevice(nullptr);
  tree_ = device_ ? rtcNewScene(device_) : nullptr;
  if (!tree_)
    refuse_memory();
  rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_ROBUST);
  if (!elements.facets.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    set_corners(geometry, elements.facets);
    if (has_holes) {
      for (const Facet &facet : elements.facets)
        in_triangle_.push_back(facet.in_triangle);
      rtcSetGeometryUserData(geometry, this);
      rtcSetGeometryIntersectFilterFunction(geometry, pass_holes);
      rtcSetGeometryOccludedFilterFunction(geometry, pass_holes);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree_, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(tree_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
    refuse_memory();
}

FacetTree::~FacetTree() {
  rtcReleaseScene(tree_);
  rtcReleaseDevice(device_);
}

bool FacetTree::is_there(std::uint32_t facet, float u, float v) const {
  const std::uint32_t triangle = triangles_[facet];
  if (!scene_.is_masked(triangle))
    return true;
  const glm::dvec3 weights(1.0 - static_cast<double>(u) - static_cast<double>(v), u, v);
  return is_there_at(scene_, triangle, mixed(in_triangle_[facet], weights));
}

void FacetTree::trace(const glm::dvec3 &from_m, RayPacket &packet) const {
  alignas(32) RTCRayHit8 rays;
  alignas(32) std::array<int, packet_rays> valid;
  valid.fill(-1);
  const glm::vec3 from(from_m);
  for (std::size_t i = 0; i < packet_rays; ++i) {
    rays.ray.org_x[i] = from.x;
    rays.ray.org_y[i] = from.y;
    rays.ray.org_z[i] = from.z;
    rays.ray.dir_x[i] = packet.directions[i].x;
    rays.ray.dir_y[i] = packet.directions[i].y;
    rays.ray.dir_z[i] = packet.directions[i].z;
    rays.ray.tnear[i] = 0.0f;
    rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
    rays.ray.time[i] = 0.0f;
    rays.ray.mask[i] = ~0u;
    rays.ray.id[i] = 0;
    rays.ray.flags[i] = 0;
    rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context = coherent_rays();
  rtcIntersect8(valid.data(), tree_, &context, &rays);
  for (std::size_t i = 0; i < packet_rays; ++i) {
    packet.facet[i] = rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? no_facet : rays.hit.primID[i];
    const float along = rays.hit.Ng_x[i] * rays.ray.dir_x[i] + rays.hit.Ng_y[i] * rays.ray.dir_y[i] +
                        rays.hit.Ng_z[i] * rays.ray.dir_z[i];
    packet.side[i] = along < 0.0f ? 0 : 1;
    packet.u[i] = rays.hit.u[i];
    packet.v[i] = rays.hit.v[i];
    packet.length_m[i] = rays.ray.tfar[i];
  }
}

void FacetTree::look(const glm::dvec3 &from_m, std::span<const glm::vec3> to_m,
                     std::span<std::uint8_t> is_free) const {
  constexpr float before_the_end = 1.0f - 1e-5f;
  const glm::vec3 from(from_m);
  for (std::size_t first = 0; first < to_m.size(); first += packet_rays) {
    alignas(32) RTCRay8 rays;
    alignas(32) std::array<int, packet_rays> valid;
    for (std::size_t i = 0; i < packet_rays; ++i) {
      valid[i] = first + i < to_m.size() ? -1 : 0;
      const glm::vec3 way = to_m[std::min(first + i, to_m.size() - 1)] - from;
      rays.org_x[i] = from.x;
      rays.org_y[i] = from.y;
      rays.org_z[i] = from.z;
      rays.dir_x[i] = way.x;
      rays.dir_y[i] = way.y;
      rays.dir_z[i] = way.z;
      rays.tnear[i] = 0.0f;
      rays.tfar[i] = before_the_end;
      rays.time[i] = 0.0f;
      rays.mask[i] = ~0u;
      rays.id[i] = 0;
      rays.flags[i] = 0;
    }
    RTCIntersectContext context = coherent_rays();
    rtcOccluded8(valid.data(), tree_, &context, &rays);
    for (std::size_t i = 0; i < packet_rays && first + i < to_m.size(); ++i)
      is_free[first + i] = rays.tfar[i] > 0.0f ? 1 : 0; // occluded rays end at minus infinity
  }
}

} // namespace pmdsim
