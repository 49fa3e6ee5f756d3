// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/recipe_materials.h"

#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/core/nearest_word.h"
#include "libscan/io/image_file.h"
#include "synth/bsdf/fresnel.h"
#include "synth/gltf_material.h"
#include "tools/field_reader.h"
#include "tools/field_writer.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

[[noreturn]] void refuse_name(const JsonReader& reader, std::string_view key,
                              const std::string& word, double wavelength_m) {
  std::vector<std::string> words;
  std::string known;
  for (const std::string_view name : synth::refractive_index_names()) {
    words.emplace_back(name);
    known += (known.empty() ? "" : ", ") + words.back();
  }
  const std::string near = nearest_word(word, words);
  throw Error(Trouble::input,
              reader.place() + "/" + std::string(key) + ": no index of refraction of '" + word +
                  "' at " + std::to_string(wavelength_m * 1e9) + " nm; known are " + known,
              near.empty() ? "" : "did you mean '" + near + "'?");
}

// A name, or what the value says itself.
synth::RefractiveIndex read_index(JsonReader& reader, std::string_view key, double wavelength_m) {
  const nlohmann::json& value = reader.value(key);
  if (value.is_number()) return {.eta = reader.number(key), .k = 0};
  if (value.is_string()) {
    const std::string word = reader.text(key);
    const auto index = synth::refractive_index(word, wavelength_m);
    if (!index) refuse_name(reader, key, word, wavelength_m);
    return *index;
  }
  JsonReader inner = reader.object(key);
  const synth::RefractiveIndex index{.eta = inner.number("eta"), .k = inner.number("k")};
  inner.finish();
  return index;
}

void read_facets(JsonReader& reader, double& roughness, synth::Microfacets& facets) {
  roughness = reader.number("roughness", roughness);
  FieldReader fields(reader);
  int kind = static_cast<int>(facets);
  fields.choice("facets", kind, {"ggx", "beckmann"});
  facets = static_cast<synth::Microfacets>(kind);
}

synth::Bsdf read_bsdf(JsonReader& reader, double wavelength_m) {
  if (reader.has("conductor")) {
    const auto index = read_index(reader, "conductor", wavelength_m);
    synth::Conductor metal{.eta = index.eta, .k = index.k};
    read_facets(reader, metal.roughness, metal.facets);
    return metal;
  }
  if (reader.has("dielectric")) {
    synth::Dielectric glass{.index = read_index(reader, "dielectric", wavelength_m).eta};
    read_facets(reader, glass.roughness, glass.facets);
    return glass;
  }
  if (reader.has("plastic")) {
    synth::Plastic plastic{.index = read_index(reader, "plastic", wavelength_m).eta};
    plastic.albedo = reader.number("diffuse", plastic.albedo);
    read_facets(reader, plastic.roughness, plastic.facets);
    return plastic;
  }
  const double albedo = reader.number("diffuse", synth::Lambert{}.albedo);
  if (!reader.has_quantity("slope")) return synth::Lambert{albedo};
  return synth::OrenNayar{.albedo = albedo, .slope_rad = reader.angle_rad("slope")};
}

// Errors name the recipe's place as well as the file.
Image<std::uint8_t> read_grey_at(const std::filesystem::path& file, const std::string& place) {
  try {
    return read_grey8(file);
  } catch (const Error& error) {
    throw Error(error.trouble(), place + "/file: " + error.what(), error.hint());
  }
}

// Upon a plane of the object by its width, else laid on the mesh by its texture coordinates.
synth::Texture read_picture(JsonReader reader, const std::filesystem::path& folder,
                            std::filesystem::path& picture) {
  picture = std::filesystem::absolute(folder / reader.text("file")).lexically_normal();
  const Image<std::uint8_t> grey = read_grey_at(picture, reader.place());
  Image<float> factors(grey.width, grey.height);
  for (std::size_t i = 0; i < grey.pixels.size(); ++i)
    factors.pixels[i] = static_cast<float>(grey.pixels[i]) / 255;
  synth::Texture texture = synth::MeshTexture{factors};
  if (reader.has_quantity("width"))
    texture =
        synth::ImageTexture{.factors = std::move(factors), .width_m = reader.length_m("width")};
  reader.finish();
  return texture;
}

synth::CheckerTexture read_checker(JsonReader reader) {
  synth::CheckerTexture checker;
  checker.period_m = reader.length_m("period", checker.period_m);
  checker.contrast = reader.number("contrast", checker.contrast);
  reader.finish();
  return checker;
}

synth::NoiseTexture read_noise(JsonReader reader) {
  synth::NoiseTexture noise;
  noise.period_m = reader.length_m("period", noise.period_m);
  noise.octaves = static_cast<int>(reader.integer("octaves", noise.octaves));
  noise.contrast = reader.number("contrast", noise.contrast);
  reader.finish();
  return noise;
}

synth::Texture read_texture(JsonReader reader, const std::filesystem::path& folder,
                            std::filesystem::path& picture) {
  const std::string kind = reader.one_of({"picture", "checker", "noise"});
  reader.finish();
  if (kind == "picture") return read_picture(reader.object(kind), folder, picture);
  if (kind == "checker") return read_checker(reader.object(kind));
  return read_noise(reader.object(kind));
}

struct TextureWriter {
  const std::filesystem::path& picture;
  ordered_json operator()(const synth::PlainTexture&) const { return nullptr; }
  ordered_json operator()(const synth::CheckerTexture& t) const {
    return {{"checker", {{"period_m", t.period_m}, {"contrast", t.contrast}}}};
  }
  ordered_json operator()(const synth::ImageTexture& t) const {
    return {{"picture", {{"file", picture.string()}, {"width_m", t.width_m}}}};
  }
  ordered_json operator()(const synth::MeshTexture&) const {
    return {{"picture", {{"file", picture.string()}}}};
  }
  ordered_json operator()(const synth::NoiseTexture& t) const {
    return {
        {"noise", {{"period_m", t.period_m}, {"octaves", t.octaves}, {"contrast", t.contrast}}}};
  }
};

ordered_json with_facets(ordered_json json, double roughness, synth::Microfacets facets) {
  json["roughness"] = roughness;
  json["facets"] = facets == synth::Microfacets::ggx ? "ggx" : "beckmann";
  return json;
}

struct BsdfWriter {
  ordered_json operator()(const synth::Lambert& b) const { return {{"diffuse", b.albedo}}; }
  ordered_json operator()(const synth::OrenNayar& b) const {
    return {{"diffuse", b.albedo}, {"slope_rad", b.slope_rad}};
  }
  ordered_json operator()(const synth::Conductor& b) const {
    return with_facets({{"conductor", {{"eta", b.eta}, {"k", b.k}}}}, b.roughness, b.facets);
  }
  ordered_json operator()(const synth::Dielectric& b) const {
    return with_facets({{"dielectric", b.index}}, b.roughness, b.facets);
  }
  ordered_json operator()(const synth::Plastic& b) const {
    return with_facets({{"plastic", b.index}, {"diffuse", b.albedo}}, b.roughness, b.facets);
  }
};

synth::LinearRgb read_colour(JsonReader& reader, std::string_view key,
                             const synth::LinearRgb& otherwise) {
  if (!reader.has(key)) return otherwise;
  const std::vector<double> numbers = reader.numbers(key);
  if (numbers.size() != 3) reader.fail(key, "must have three numbers: red, green, blue");
  return {numbers[0], numbers[1], numbers[2]};
}

synth::Material read_gltf(JsonReader reader, const std::string& name, double wavelength_m) {
  synth::GltfMaterial gltf{.name = name};
  gltf.base_colour = read_colour(reader, "base_colour", gltf.base_colour);
  gltf.metallic = reader.number("metallic", gltf.metallic);
  gltf.roughness = reader.number("roughness", gltf.roughness);
  gltf.ior = reader.number("ior", gltf.ior);
  gltf.transmission = reader.number("transmission", gltf.transmission);
  gltf.attenuation_distance_m =
      reader.length_m("attenuation_distance", gltf.attenuation_distance_m);
  gltf.attenuation_colour = read_colour(reader, "attenuation_colour", gltf.attenuation_colour);
  reader.finish();
  return material_from_gltf(gltf, wavelength_m);
}

}  // namespace

void fields(Fields& f, synth::Medium& medium) {
  f.number("absorption_per_m", medium.absorption_per_m);
  f.number("scattering_per_m", medium.scattering_per_m);
  int phase = static_cast<int>(medium.phase.index());
  f.choice("phase", phase, {"henyey-greenstein", "rayleigh"});
  if (phase == 1) {
    medium.phase = synth::Rayleigh{};
    return;
  }
  synth::HenyeyGreenstein lobe;
  if (const auto* given = std::get_if<synth::HenyeyGreenstein>(&medium.phase)) lobe = *given;
  f.number("mean_cosine", lobe.mean_cosine);
  medium.phase = lobe;
}

synth::Material read_material(JsonReader reader, const std::string& name, double wavelength_m,
                              const std::filesystem::path& folder, std::filesystem::path& picture) {
  if (reader.has("gltf")) {
    synth::Material material = read_gltf(reader.object("gltf"), name, wavelength_m);
    reader.finish();
    return material;
  }
  synth::Material material{.name = name, .bsdf = read_bsdf(reader, wavelength_m)};
  if (reader.has("texture"))
    material.texture = read_texture(reader.object("texture"), folder, picture);
  if (reader.has("interior")) {
    JsonReader inner = reader.object("interior");
    FieldReader inner_fields(inner);
    synth::Medium medium;
    fields(inner_fields, medium);
    inner.finish();
    material.interior = medium;
  }
  reader.finish();
  return material;
}

ordered_json to_json(const synth::Material& material, const std::filesystem::path& picture) {
  ordered_json json = std::visit(BsdfWriter{}, material.bsdf);
  if (auto texture = std::visit(TextureWriter{picture}, material.texture); !texture.is_null())
    json["texture"] = std::move(texture);
  if (material.interior) {
    ordered_json interior = ordered_json::object();
    FieldWriter writer(interior);
    synth::Medium medium = *material.interior;
    fields(writer, medium);
    json["interior"] = std::move(interior);
  }
  return json;
}

}  // namespace scan
