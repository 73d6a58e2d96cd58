// glTF materials as surfaces: known answers for reflectivity, alpha, samplers and texture transforms.

#include "host/input/gltf/material/material.h"

#include "host/input/gltf/data/buffers.h"
#include "host/input/gltf/document.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/host/input/gltf/builder.h"
#include "tests/host/input/image/image_bytes.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <numbers>
#include <sys/stat.h>
#include <tiny_gltf.h>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;
using nlohmann::json;

namespace {

// One material that a test describes, and an image for its texture.
struct MaterialBench {
  TemporaryFolder folder;
  json gltf = one_triangle();

  MaterialBench() {
    // Opaque red left, opaque green right.
    folder.write("opaque.png", png_bytes({2, 1, 8, 2, {255, 0, 0, 0, 255, 0}}));
    gltf["images"] = {{{"uri", "opaque.png"}}};
    gltf["textures"] = {{{"source", 0}}};
    gltf["materials"] = {json::object()};
  }

  json &material() { return gltf["materials"][0]; }
  json &base() { return material()["pbrMetallicRoughness"]; }
  json &texture_info() {
    base()["baseColorTexture"]["index"] = 0;
    return base()["baseColorTexture"];
  }
  // The texture has alphas 255 and 51.
  void make_translucent() {
    folder.write("translucent.png", png_bytes({2, 1, 8, 6, {255, 0, 0, 255, 0, 255, 0, 51}}));
    gltf["images"][0]["uri"] = "translucent.png";
    texture_info();
  }
  // Material 1, with image 1.
  void add_second(const char *image) {
    gltf["images"].push_back({{"uri", image}});
    gltf["textures"].push_back({{"source", 1}});
    gltf["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}});
  }
  GltfMaterials materials() const {
    const auto file = folder.write("scene.gltf", gltf.dump());
    const GltfDocument document = read_gltf_document(file, Place{file});
    tinygltf::Model model;
    for (Bytes &bytes : read_gltf_buffers(document, file))
      model.buffers.emplace_back().data = std::move(bytes);
    for (const json &view : document.json.at("bufferViews")) {
      tinygltf::BufferView &made = model.bufferViews.emplace_back();
      made.buffer = view.at("buffer");
      made.byteOffset = view.value("byteOffset", std::size_t{0});
      made.byteLength = view.at("byteLength");
    }
    return {document.json, std::make_shared<const tinygltf::Model>(std::move(model)), file};
  }
  GltfMaterial made(bool has_colours = false) const { return materials().material_of(0, has_colours); }
  Paint paint(bool has_colours = false) const {
    const Surface surface = made(has_colours).surface;
    REQUIRE(surface.paint.has_value());
    return *surface.paint;
  }
  std::string error(bool has_colours = false) const {
    return input_error_of([&] { made(has_colours); });
  }
  std::string error_of_image(const json &image) {
    gltf["images"][0] = image;
    return error();
  }
};

void check_rgb(const glm::dvec3 &found, const glm::dvec3 &expected) {
  for (int c = 0; c < 3; ++c)
    CHECK(found[c] == Approx(expected[c]).epsilon(1e-15));
}

glm::dvec2 texture_point(const GltfMaterial &material, double u, double v) {
  return glm::dvec2(material.texture_from_coordinates * glm::dvec3(u, v, 1.0));
}

void check_point(const glm::dvec2 &found, const glm::dvec2 &expected) {
  CHECK(found.x == Approx(expected.x).margin(1e-11));
  CHECK(found.y == Approx(expected.y).margin(1e-11));
}

} // namespace

TEST_CASE("The default material is white and single-sided") {
  GltfMaterials materials = MaterialBench().materials();
  const Surface plain = materials.material_of(-1, false).surface;
  CHECK(plain.reflectivity == 1.0);
  CHECK_FALSE(plain.double_sided);
  CHECK_FALSE(plain.paint);
  const Surface coloured = materials.material_of(-1, true).surface;
  REQUIRE(coloured.paint);
  CHECK(coloured.reflectivity == 0.0);
  CHECK(coloured.paint->reflectivity_rgb == glm::dvec3(0.2126, 0.7152, 0.0722));
  CHECK(coloured.paint->texture == nullptr);
  CHECK(coloured.paint->alpha_cutoff == 0.0);
}

TEST_CASE("A plain material has a reflectivity and no paint") {
  MaterialBench bench;
  bench.base()["baseColorFactor"] = {0.5, 0.25, 1.0, 0.5};
  bench.material()["doubleSided"] = true;
  bench.material()["extensions"] = {{"KHR_materials_unlit", json::object()}};
  const Surface surface = bench.made().surface;
  CHECK(surface.reflectivity == Approx(0.2126 * 0.5 + 0.7152 * 0.25 + 0.0722).epsilon(1e-15));
  CHECK(surface.double_sided);
  CHECK_FALSE(surface.paint);
}

TEST_CASE("Texture and vertex colours multiply the factor's luminance") {
  MaterialBench bench;
  bench.base()["baseColorFactor"] = {0.5, 0.25, 1.0, 1.0};
  const glm::dvec3 expected(0.2126 * 0.5, 0.7152 * 0.25, 0.0722);
  CHECK(bench.made(true).surface.reflectivity == 0.0);
  check_rgb(bench.paint(true).reflectivity_rgb, expected);
  CHECK(bench.paint(true).texture == nullptr);
  bench.texture_info();
  CHECK(bench.made().surface.reflectivity == 0.0);
  const Paint paint = bench.paint();
  check_rgb(paint.reflectivity_rgb, expected);
  REQUIRE(paint.texture);
  CHECK(paint.texture->size == glm::uvec2(2, 1));
  CHECK(paint.texture->texels == std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}});
  CHECK(paint.alpha_cutoff == 0.0);
}

TEST_CASE("A stated reflectivity needs neither texture nor vertex colours") {
  MaterialBench bench;
  bench.gltf["images"][0]["uri"] = "absent.png";
  bench.texture_info();
  bench.material()["extras"] = {{"pmdsim_reflectivity", 0.125}};
  const Surface surface = bench.made(true).surface;
  CHECK(surface.reflectivity == 0.125);
  CHECK_FALSE(surface.paint);
  bench.material()["extras"] = "dark"; // extras may be anything
  CHECK_THAT(bench.error(),
             EndsWith("/images/0/uri: " + in_quotes((bench.folder.path() / "absent.png").string()) +
                      ": no such file"));
}

TEST_CASE("A mask by a constant alpha") {
  MaterialBench bench;
  bench.material()["alphaMode"] = "MASK";
  bench.base()["baseColorFactor"] = {1, 1, 1, 0.5};
  CHECK_FALSE(bench.made().surface.paint); // 0.5 is not below 0.5
  bench.base()["baseColorFactor"][3] = 0.49;
  CHECK(bench.made().surface.reflectivity == 1.0);
  CHECK(bench.paint().alpha == 0.49);
  CHECK(bench.paint().alpha_cutoff == 0.5);
  CHECK(bench.paint().reflectivity_rgb == glm::dvec3(0.0));
  bench.material()["alphaCutoff"] = 0.25;
  CHECK_FALSE(bench.made().surface.paint);
  bench.material()["alphaCutoff"] = 1e300; // nothing is left
  CHECK(bench.paint().alpha_cutoff == 2.0);
  bench.material()["alphaCutoff"] = 0;
  CHECK_FALSE(bench.made().surface.paint);
}

TEST_CASE("A mask by a texture's alpha") {
  MaterialBench bench;
  bench.make_translucent();
  CHECK(bench.paint().alpha_cutoff == 0.0); // OPAQUE
  bench.material()["alphaMode"] = "MASK";
  bench.base()["baseColorFactor"] = {1, 1, 1, 0.75};
  CHECK(bench.paint().alpha == 0.75);
  CHECK(bench.paint().alpha_cutoff == 0.5);
  CHECK(bench.paint().texture->texels.at(1).a == Approx(0.2));
  check_rgb(bench.paint().reflectivity_rgb, {0.2126, 0.7152, 0.0722});
  bench.material()["alphaCutoff"] = 0.125; // below 0.75 * 0.2: no hole anywhere
  CHECK(bench.paint().alpha_cutoff == 0.0);
  bench.material()["alphaCutoff"] = 0.0;
  CHECK(bench.paint().alpha_cutoff == 0.0);
}

TEST_CASE("A mask leaves a stated reflectivity alone") {
  MaterialBench bench;
  bench.make_translucent();
  bench.material()["alphaMode"] = "MASK";
  bench.material()["extras"] = {{"pmdsim_reflectivity", 0.5}};
  CHECK(bench.made().surface.reflectivity == 0.5);
  CHECK(bench.paint().reflectivity_rgb == glm::dvec3(0.0));
  CHECK(bench.paint().alpha_cutoff == 0.5);
  REQUIRE(bench.paint().texture);
  bench.gltf["images"][0]["uri"] = "opaque.png";
  CHECK_FALSE(bench.made().surface.paint);
  CHECK(bench.paint(true).alpha_cutoff == 0.5); // the vertices' alpha may be anything
}

TEST_CASE("Blending is refused where something is translucent") {
  const std::string refused = "/materials/0/alphaMode: BLEND is not supported where alpha is below 1 "
                              "(expected \"MASK\" or \"OPAQUE\")";
  MaterialBench bench;
  bench.material()["alphaMode"] = "BLEND";
  CHECK_FALSE(bench.made().surface.paint);
  bench.texture_info();
  CHECK(bench.paint().alpha_cutoff == 0.0);
  bench.make_translucent();
  CHECK_THAT(bench.error(), EndsWith(refused));
  bench.material()["extras"] = {{"pmdsim_reflectivity", 0.5}};
  CHECK_THAT(bench.error(), EndsWith(refused));
  MaterialBench factor;
  factor.material()["alphaMode"] = "BLEND";
  factor.base()["baseColorFactor"] = {1, 1, 1, 0.999};
  CHECK_THAT(factor.error(), EndsWith(refused));
}

TEST_CASE("Samplers wrap and filter") {
  MaterialBench bench;
  bench.texture_info();
  CHECK(bench.paint().wrap_u == Wrap::repeat);
  CHECK(bench.paint().wrap_v == Wrap::repeat);
  CHECK(bench.paint().filter == TextureFilter::linear);
  bench.gltf["textures"][0]["sampler"] = 0;
  const auto with = [&](const json &sampler) {
    bench.gltf["samplers"] = {sampler};
    return bench.paint();
  };
  CHECK(with(json::object()).wrap_u == Wrap::repeat);
  CHECK(with(json::object()).filter == TextureFilter::linear);
  CHECK(with({{"wrapS", 33071}}).wrap_u == Wrap::clamp);
  CHECK(with({{"wrapS", 33071}}).wrap_v == Wrap::repeat);
  CHECK(with({{"wrapT", 33648}}).wrap_v == Wrap::mirrored_repeat);
  CHECK(with({{"wrapT", 33648}}).wrap_u == Wrap::repeat);
  CHECK(with({{"wrapS", 10497}, {"wrapT", 33071}}).wrap_v == Wrap::clamp);
  CHECK(with({{"magFilter", 9728}}).filter == TextureFilter::nearest);
  CHECK(with({{"magFilter", 9729}}).filter == TextureFilter::linear);
  for (int mip = 9984; mip <= 9987; ++mip)
    CHECK(with({{"minFilter", mip}}).filter == TextureFilter::linear);
}

TEST_CASE("Texture coordinates and their transform") {
  MaterialBench bench;
  json &info = bench.texture_info();
  CHECK(bench.made().texture_coordinates == 0);
  CHECK(bench.made().texture_from_coordinates == glm::dmat3(1.0));
  info["texCoord"] = 3;
  CHECK(bench.made().texture_coordinates == 3);
  json &transform = info["extensions"]["KHR_texture_transform"];
  transform = json::object();
  CHECK(bench.made().texture_coordinates == 3);
  CHECK(bench.made().texture_from_coordinates == glm::dmat3(1.0));
  transform["texCoord"] = 1;
  CHECK(bench.made().texture_coordinates == 1);
  transform = {{"offset", {0.5, -2}}, {"scale", {3, 4}}};
  check_point(texture_point(bench.made(), 0.25, 0.5), {0.5 + 0.75, -2 + 2});
  transform = {{"rotation", std::numbers::pi / 6}};
  check_point(texture_point(bench.made(), 1, 0), {std::sqrt(0.75), -0.5}); // counter-clockwise, v down
  check_point(texture_point(bench.made(), 0, 1), {0.5, std::sqrt(0.75)});
  transform = {{"offset", {1, 2}}, {"rotation", std::numbers::pi / 6}, {"scale", {2, 3}}};
  check_point(texture_point(bench.made(), 1, 1),
              {1 + 2 * std::sqrt(0.75) + 1.5, 2 - 1 + 3 * std::sqrt(0.75)});
}

TEST_CASE("The examples of KHR_texture_transform") {
  MaterialBench bench;
  json &transform = bench.texture_info()["extensions"]["KHR_texture_transform"];
  // "Utilizes only the lower left quadrant of the source image, rotated clockwise 90 degrees."
  transform = {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}};
  check_point(texture_point(bench.made(), 0, 0), {0, 1});   // the top left shows the image's bottom left,
  check_point(texture_point(bench.made(), 1, 0), {0, 0.5}); // the top right the left edge's middle,
  check_point(texture_point(bench.made(), 1, 1), {0.5, 0.5});
  check_point(texture_point(bench.made(), 0, 1), {0.5, 1});
  // "Inverts the T axis, effectively defining a bottom-left origin."
  transform = {{"offset", {0, 1}}, {"scale", {1, -1}}};
  check_point(texture_point(bench.made(), 0.25, 0.75), {0.25, 0.25});
}

TEST_CASE("Images in files, data URIs and buffers are the same") {
  const std::string png = png_bytes({2, 1, 8, 2, {255, 0, 0, 0, 255, 0}});
  const std::vector<glm::vec4> expected = {{1, 0, 0, 1}, {0, 1, 0, 1}};
  MaterialBench bench;
  bench.texture_info();
  const auto base64 = [](const std::string &bytes) {
    const std::string uri = data_uri(bytes);
    return uri.substr(uri.find(','));
  };
  json &image = bench.gltf["images"][0];
  CHECK(bench.paint().texture->texels == expected);
  image = {{"uri", "data:image/png;base64" + base64(png)}};
  CHECK(bench.paint().texture->texels == expected);
  std::filesystem::create_directory(bench.folder.path() / "parts");
  bench.folder.write("parts/a b.png", png);
  image = {{"uri", "parts/a%20b.png"}, {"mimeType", "image/png"}};
  CHECK(bench.paint().texture->texels == expected);
  const std::string buffer = "12345" + png;
  bench.gltf["buffers"].push_back({{"byteLength", buffer.size()}, {"uri", data_uri(buffer)}});
  bench.gltf["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 5}, {"byteLength", png.size()}});
  image = {{"bufferView", 1}, {"mimeType", "image/png"}};
  CHECK(bench.paint().texture->texels == expected);
  const std::string jpeg = jpeg_bytes(8, 8, std::vector<std::uint8_t>(64, 255), JpegColours::grey);
  image = {{"uri", "data:image/jpeg;base64" + base64(jpeg)}};
  CHECK(bench.paint().texture->texels == std::vector<glm::vec4>(64, glm::vec4(1.0f)));
}

TEST_CASE("An image is decoded once") {
  MaterialBench bench;
  bench.texture_info();
  bench.gltf["textures"].push_back({{"source", 0}});
  bench.gltf["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}});
  GltfMaterials materials = bench.materials();
  const auto first = materials.material_of(0, false).surface.paint->texture;
  std::filesystem::remove(bench.folder.path() / "opaque.png");
  CHECK(materials.material_of(0, true).surface.paint->texture == first);
  CHECK(materials.material_of(1, false).surface.paint->texture == first);
}

TEST_CASE("Images that no used material needs are not opened") {
  MaterialBench bench;
  bench.texture_info();
  bench.gltf["images"][0]["uri"] = "../../../etc/passwd";
  bench.gltf["materials"].push_back({{"emissiveTexture", {{"index", 0}}}});
  GltfMaterials materials = bench.materials();
  CHECK_NOTHROW(materials.material_of(1, false));
  CHECK_NOTHROW(materials.material_of(-1, true));
  CHECK_THAT(input_error_of([&] { materials.material_of(0, false); }),
             Contains("/images/0/uri: \"../../../etc/passwd\" lies outside the scene's folder"));
}

TEST_CASE("All images of a file together have a limit") {
  MaterialBench bench;
  bench.texture_info();
  bench.folder.write("huge.png", png_header(16384, 8192)); // all that is allowed, if nothing else were there
  bench.add_second("huge.png");
  GltfMaterials materials = bench.materials();
  materials.material_of(0, false);
  CHECK_THAT(
      input_error_of([&] { materials.material_of(1, false); }),
      EndsWith("/images/1: expected at most 134217726 further pixels, found an image of 16384 x 8192"));
}

TEST_CASE("All files of images together have a limit") {
  MaterialBench bench;
  bench.texture_info();
  const auto opaque_bytes = std::filesystem::file_size(bench.folder.path() / "opaque.png");
  const std::uintmax_t left_bytes = (std::uintmax_t{1} << 30) - opaque_bytes;
  std::filesystem::resize_file(bench.folder.write("sparse.png", ""), left_bytes + 1); // is not read
  bench.add_second("sparse.png");
  GltfMaterials materials = bench.materials();
  materials.material_of(0, false);
  CHECK_THAT(input_error_of([&] { materials.material_of(1, false); }),
             EndsWith(fmt::format("has {} bytes, expected at most {}", left_bytes + 1, left_bytes)));
}

TEST_CASE("Textures without an image that can be read") {
  const auto error_of = [](const json &texture) {
    MaterialBench bench;
    bench.texture_info();
    bench.gltf["textures"][0] = texture;
    return bench.error();
  };
  CHECK_THAT(error_of(json::object()), EndsWith("/textures/0: missing key \"source\""));
  CHECK_THAT(error_of({{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}),
             EndsWith("/textures/0: the image is in \"EXT_texture_webp\", which is not supported (expected a "
                      "\"source\" in PNG or JPEG)"));
  CHECK_THAT(error_of({{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}),
             Contains("\"KHR_texture_basisu\", which is not supported"));
  MaterialBench both;
  both.texture_info();
  both.gltf["textures"][0]["extensions"] = {{"EXT_texture_webp", {{"source", 7}}}};
  CHECK(both.paint().texture->size == glm::uvec2(2, 1));
}

TEST_CASE("Images that cannot be had") {
  MaterialBench bench;
  bench.texture_info();
  const auto error_of = [&](const json &image) { return bench.error_of_image(image); };
  CHECK_THAT(error_of(json::object()), EndsWith("/images/0: expected either \"uri\" or \"bufferView\""));
  CHECK_THAT(error_of({{"uri", "opaque.png"}, {"bufferView", 0}}), Contains("/images/0: expected either"));
  CHECK_THAT(
      error_of({{"uri", "https://x/y.png"}}),
      EndsWith("/images/0/uri: expected a relative file name or a data: URI, found \"https://x/y.png\""));
  CHECK_THAT(error_of({{"uri", "."}}), EndsWith("is a directory, expected a file"));
  REQUIRE(mkfifo((bench.folder.path() / "pipe").c_str(), 0600) == 0);
  CHECK_THAT(error_of({{"uri", "pipe"}}), EndsWith("is no regular file"));
  bench.folder.write("short.png", png_bytes({1, 1, 8, 0, {1}}).substr(0, 50));
  CHECK_THAT(error_of({{"uri", "short.png"}}), EndsWith("/images/0: no valid PNG: the image is cut short"));
}

TEST_CASE("Images that are in data URIs and buffers and are none") {
  MaterialBench bench;
  bench.texture_info();
  const auto error_of = [&](const json &image) { return bench.error_of_image(image); };
  const std::string data = "/images/0/uri: expected a base64 data URI of image/png or image/jpeg";
  const std::string neither = "/images/0: expected a PNG or JPEG image, found neither";
  CHECK_THAT(error_of({{"uri", "data:image/webp;base64,AAAA"}}), EndsWith(data));
  CHECK_THAT(error_of({{"uri", "data:image/png,AAAA"}}), EndsWith(data));
  CHECK_THAT(error_of({{"uri", "data:image/png;base64,"}}), EndsWith(data));
  CHECK_THAT(error_of({{"uri", "data:image/png;base64,AAAA"}}), EndsWith(neither));
  CHECK_THAT(error_of({{"bufferView", 0}}), EndsWith(neither));
  bench.gltf["bufferViews"][0]["byteLength"] = 37;
  CHECK_THAT(bench.error(), EndsWith("/bufferViews/0: ends at byte 37, its buffer has 36"));
}

TEST_CASE("Textures, images and samplers of a wrong type or to nowhere") {
  const auto error_with = [](const std::string &pointer, const json &value) {
    MaterialBench bench;
    bench.texture_info();
    bench.gltf["textures"][0]["sampler"] = 0;
    bench.gltf["samplers"] = {json::object()};
    bench.gltf[json::json_pointer(pointer)] = value;
    return bench.error();
  };
  const std::string info = "/materials/0/pbrMetallicRoughness/baseColorTexture";
  const std::string transform = info + "/extensions/KHR_texture_transform";
  CHECK_THAT(error_with(info + "/index", 1), EndsWith(info + "/index: index 1 into /textures, which has 1"));
  CHECK_THAT(error_with("/textures/0/source", 1),
             EndsWith("/textures/0/source: index 1 into /images, which has 1"));
  CHECK_THAT(error_with("/textures/0/sampler", 2),
             EndsWith("/textures/0/sampler: index 2 into /samplers, which has 1"));
  CHECK_THAT(error_with("/images/0/bufferView", 2),
             EndsWith("/images/0/bufferView: index 2 into /bufferViews, which has 1"));
  CHECK_THAT(error_with("/textures/0/source", "0"),
             EndsWith("/textures/0/source: expected an index, found \"0\"; write 0"));
  CHECK_THAT(error_with("/textures", 3), EndsWith("/textures: expected an array, each an object, found 3"));
  CHECK_THAT(error_with("/images/0/uri", 3), EndsWith("/images/0/uri: expected a string, found 3"));
  CHECK_THAT(error_with("/samplers/0/wrapS", 1),
             EndsWith("/samplers/0/wrapS: expected 33071 or 33648 or 10497, found 1"));
  CHECK_THAT(error_with("/samplers/0/wrapT", "clamp"), Contains("/samplers/0/wrapT: expected 33071 or"));
  CHECK_THAT(error_with("/samplers/0/magFilter", 9984),
             EndsWith("/samplers/0/magFilter: expected 9728 or 9729, found 9984"));
  CHECK_THAT(error_with("/samplers/0/minFilter", 0), Contains("/samplers/0/minFilter: expected 9728 or"));
  CHECK_THAT(error_with(info, 0), EndsWith(info + ": expected an object, found 0"));
  CHECK_THAT(error_with(info + "/texCoord", -1), EndsWith("/texCoord: expected an index, found -1"));
  CHECK_THAT(error_with(transform, 0), EndsWith(transform + ": expected an object, found 0"));
  CHECK_THAT(error_with(transform, {{"texCoord", 1.5}}), EndsWith("/texCoord: expected an index, found 1.5"));
  CHECK_THAT(error_with(transform, {{"offset", {1, 2, 3}}}),
             Contains(transform + "/offset: expected an array of 2"));
  CHECK_THAT(error_with(transform, {{"scale", {1, 2e6}}}),
             EndsWith("/scale/1: expected a number from -1000000 to 1000000, found 2000000"));
  CHECK_THAT(error_with(transform, {{"rotation", "90"}}), Contains("/rotation: expected a number from"));
  CHECK_THAT(error_with("/materials/0/alphaCutoff", -0.5),
             EndsWith("/materials/0/alphaCutoff: expected a number of at least 0, found -0.5"));
  CHECK_THAT(error_with("/materials/0/alphaMode", "CUT"),
             Contains("/materials/0/alphaMode: expected \"OPAQUE\" or"));
}
