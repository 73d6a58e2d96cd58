// What the host and the shaders of the shadow pass agree on, by the rules of interface.h.
#ifndef PMDSIM_LIT_INTERFACE_H
#define PMDSIM_LIT_INTERFACE_H

#include "shaders/light/source_windows.h"

#ifdef __cplusplus
namespace pmdsim::shader {
#endif

// Which diodes reach which sample. Samples are taken in tiles of pixels, diodes in bundles; a sample has a
// word for each bundle, a bit for each diode. A window is the bundles whose words are kept at a time.
PMDSIM_CONSTANT own_shapes = 16; // of a tile part that are known one by one
PMDSIM_CONSTANT parts_per_tile = 2;
// That a part tries one by one; where there are more, rays are traced.
PMDSIM_CONSTANT largest_candidates = 256;
PMDSIM_CONSTANT candidate_words = largest_candidates + 1; // of a part; their number comes first
// lavapipe ends the loops of the invocations that share its vectors after 65,535 iterations of all of them
// together, silently. So a walk through the tree counts its steps; whether it was too long is seen from where
// it ended, whatever ended it; and a walk that must not be too long is a single loop over so many nodes.
PMDSIM_CONSTANT steps_per_walk = 32000;
PMDSIM_CONSTANT no_occluder = 0xffffffffu;
PMDSIM_CONSTANT no_body = 0xffffffffu;

// What may stand in the light: a triangle, or the one around a disc. Camera frame, m.
struct Occluder {
  vec4 plane_hi, plane_lo; // unit normal (counter-clockwise abc in front), offset
  vec4 a_hi, b_hi, c_hi;   // corners
  vec4 a_lo, b_lo, c_lo;
  uint id;            // of the shape in the scene
  uint edges;         // bit 0, 1, 2: ab, bc, ca run from the corner that comes later (mesh_edges.h)
  uint may_be_absent; // 1: it has holes, or is a disc
  uint body;          // the convex body that it is a part of, or no_body
};

// A box of the tree over the occluders, rounded outwards, camera frame, m. Nodes lie in the order of a walk:
// whoever meets the box goes on with the next node, whoever misses it at `skip`.
struct TreeNode {
  float low_x, low_y, low_z;
  uint skip;
  float high_x, high_y, high_z;
  uint occluder; // of a leaf; else no_occluder
};

// Samples of a tile that lie at similar depths. A tile has two parts, one of them empty where it is all of
// one depth.
struct TilePart {
  vec4 low, high;              // box around their points, camera frame, m
  float nearest_m, farthest_m; // depths z: nearest_m <= z < farthest_m
  uint own;  // shapes that they lie on, 0 where it is empty; beyond own_shapes: more than these
  uint body; // the convex body that all of these are parts of, or no_body
  uint own_ids[own_shapes];
};

// What is left to do, in lists of tiles' parts: `open`, whose light something may block; and of each bundle
// of the window the parts that try candidates, those that have too many of them, those of which samples are
// unclear all the same and trace rays, and those of which a ray was too long and walks again.
PMDSIM_CONSTANT list_open = 0;
PMDSIM_CONSTANT list_tried = 1; // of the first bundle; those of the others follow
PMDSIM_CONSTANT list_traced = list_tried + bundles_per_window;
PMDSIM_CONSTANT list_unclear = list_traced + bundles_per_window;
PMDSIM_CONSTANT list_walked = list_unclear + bundles_per_window;
PMDSIM_CONSTANT list_said = list_walked + bundles_per_window; // append_once() in lit.glsl
PMDSIM_CONSTANT lists = list_said + 1;

// Arguments of the indirect dispatch over a list: a workgroup a part along x and then z; over `open` an
// invocation a part.
struct Dispatch {
  uint x, y, z;
  uint count; // of the list
};

// The lists follow in words, each as long as there are parts.
struct LitWork {
  Dispatch list[lists];
};

// What the shadow pass looks up about the scene.
struct LitScene {
  uvec2 planes;         // TrianglePlane[]
  uvec2 occluders;      // Occluder[]
  uvec2 tree;           // TreeNode[]
  uvec2 bodies;         // uint[], of each shape the convex body that it is a part of, or no_body
  uvec2 shapes;         // ShapePaint[], where occluders may have holes
  uvec2 surfaces;       // SurfacePaint[], likewise
  uint nodes;           // of the tree
  float world_rounding; // what double rounding in the world's frame leaves of places, m
};

struct LitTilesConstants {
  Strip strip;
  uvec2 position;
  uvec2 ids;
  uvec2 scene; // in: LitScene
  uvec2 parts; // out: TilePart[]
};

struct LitGatherConstants {
  Strip strip;
  uvec2 position;
  uvec2 ids;
  uvec2 parts;      // in: TilePart[]
  uvec2 scene;      // in: LitScene
  uvec2 boxes;      // in: DiodeBox of the window, then of its bundles
  uvec2 work;       // in and out: LitWork and its lists
  uvec2 candidates; // out: candidate_words of each part
  uint part_count;
  uint bundle; // of the window; open: not asked
  uint slots;  // parts that `candidates` has room for; further ones trace rays
};

struct LitDecideConstants {
  Strip strip;
  uvec2 position;
  uvec2 ids;
  uvec2 parts;
  uvec2 scene;
  uvec2 diodes;     // in: BundleDiodes
  uvec2 work;       // in, trace: and out
  uvec2 candidates; // in, try
  uvec2 visibility; // in and out: the bundle's word of each sample
  uint bundle;      // of the window
  uint part_count;
  uint slots;                 // clear, trace: parts that `candidates` has room for
  uint first_node, last_node; // trace: of a walk that must not be too long
};

struct LitCountConstants {
  uvec2 visibility;
  uvec2 diodes; // in: for each bundle the bits of its diodes
  uvec2 lit;    // out, and but for the first window in: uint a sample, the diodes that reach it
  uint plane;   // samples
};

#ifdef __cplusplus
static_assert(steps_per_walk < 65535);
static_assert(sizeof(Occluder) == 144 && sizeof(TreeNode) == 32 && sizeof(DiodeBox) == 32 &&
              sizeof(TilePart) == 112);
static_assert(sizeof(LitWork) == 16 * lists && sizeof(LitScene) == 56 &&
              sizeof(BundleDiodes) == 16 * (2 + diodes_per_bundle));
static_assert(sizeof(LitDecideConstants) == 116 && offsetof(LitDecideConstants, position) == 32);
} // namespace pmdsim::shader
#endif

#endif
