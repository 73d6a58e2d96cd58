#pragma once
// The bytes of a glTF document's buffers: from the .glb itself, from data URIs, or from files in the scene's
// folder; and what a URI leads to.

#include "host/input/file/input_error.h"
#include "host/input/gltf/document.h"

#include <filesystem>
#include <string>
#include <vector>

namespace pmdsim {

// The file that a relative reference at `place` names, from the folder of that place's file on. Throws Error
// (input) at `place`: also for a URI with a scheme and, with UriFiles::beside, for one that leads out of
// the folder, by "..", an absolute path or a link.
std::filesystem::path file_of_uri(const std::string &uri, UriFiles files, const Place &place);

// In the document's order, each of the byteLength that it states, together at most max_gltf_file_bytes. Those
// that only stand in for compressed bufferViews (meshopt_fallbacks()) are not read and stay empty. Throws
// Error (input): also for a URI that leads where the document's files must not lie, and for one with a scheme
// other than data:.
std::vector<Bytes> read_gltf_buffers(const GltfDocument &document, const std::filesystem::path &file);

} // namespace pmdsim
