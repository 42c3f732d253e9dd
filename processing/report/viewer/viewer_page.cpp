#include "processing/report/viewer/viewer_page.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/report/html.h"
#include "processing/report/viewer/packed_chunks.h"
#include "processing/report/viewer/page_files.h"
#include "processing/report/viewer/viewer_model.h"
#include "processing/report/viewer/viewer_samples.h"
#include "processing/report/viewer/viewer_sky.h"

namespace lumitexel {
namespace {

// In the order in which they are run: each may use what those before it defined.
constexpr const char* kScripts[] = {"data.js",     "bvh.js", "textures.js", "sky.js", "renderer.js",
                                    "texel_table.js", "samples.js", "sample_table.js", "ui.js",  "main.js"};
constexpr std::size_t kFewestSampleBytes = 100'000;
constexpr const char* kShaders[] = {"brdf.glsl", "surface.glsl", "shade.glsl", "sky.glsl", "pixel.glsl"};

void replace(std::string& text, const std::string& key, const std::string& value) {
  const std::string mark = "{{" + key + "}}";
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) throw Error("viewer: page.html has no " + mark);
  text.replace(at, mark.size(), value);
}

std::string shaders_json() {
  nlohmann::json shaders = nlohmann::json::object();
  for (const char* name : kShaders) shaders[name] = page_file(name);
  return shaders.dump();
}

std::string scripts() {
  std::string text = "\"use strict\";\n";
  for (const char* name : kScripts) text += page_file(name);
  return text;
}

std::size_t text_bytes() {
  std::size_t sum = 0;
  for (const PageFile* file = kPageFiles; file->name != nullptr; ++file) sum += std::strlen(file->text);
  return sum;
}

// Adds what goes into the page beside `page_bytes` of others; k where every k-th lumitexel does, 0 for none.
std::size_t add_samples(const ViewerSamples& samples, const Model& model, std::size_t page_bytes, nlohmann::json& document, PackedChunks& chunks) {
  PackedChunks residual;
  add_residual_chunk(samples.records, model, residual);
  const std::size_t others = page_bytes + residual.total_bytes();
  const std::size_t room = std::min(kMostSampleBytes, samples.most_page_bytes > others ? samples.most_page_bytes - others : 0);
  if (room < kFewestSampleBytes) return 0;
  chunks.append(std::move(residual));
  const std::size_t every = add_samples_within(room, samples.records, model.mesh, chunks);
  document["samples"] = viewer_samples_json(samples.records, samples.session, box_of(model.mesh).centre(), every);
  return every;
}

std::string inline_json(const std::string& json) {
  std::string text = json;
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) text.insert(at + 1, "\\");
  return text;
}

}  // namespace

std::string page_file(const std::string& name) {
  for (const PageFile* file = kPageFiles; file->name != nullptr; ++file) {
    if (name == file->name) return file->text;
  }
  throw Error("viewer: the page's file " + name + " is not in the program");
}

ViewerPage viewer_page(const std::string& title, const Model& model, const ViewerSamples* samples, const Image* given_sky) {
  if (model.mesh.triangles.size() > kMostViewerTriangles) {
    throw BadInput("the model's mesh", std::to_string(model.mesh.triangles.size()) + " triangles",
                   "at most " + std::to_string(kMostViewerTriangles) + " for the interactive view, whose page holds no larger numbers: fit to a coarser mesh");
  }
  PackedChunks chunks;
  add_model_chunks(model, chunks);
  nlohmann::json document = viewer_model_json(model);
  const Image sky = given_sky != nullptr ? *given_sky : built_in_sky();
  add_sky_chunk(sky, chunks);
  document["sky"] = viewer_sky_json(sky);
  std::size_t every = 0;
  if (samples != nullptr) every = add_samples(*samples, model, chunks.total_bytes() + document.dump().size() + text_bytes(), document, chunks);
  document["chunks"] = nlohmann::json::parse(chunks.directory_json());

  ViewerPage page{page_file("page.html"), chunks.bytes(), textured_texels(model).size(), every};
  page.bytes["three"] = page_file("three.min.js").size();
  replace(page.html, "title", html::escaped(title));
  replace(page.html, "title", html::escaped(title));
  replace(page.html, "style", page_file("viewer.css"));
  replace(page.html, "document", inline_json(document.dump()));
  replace(page.html, "shaders", inline_json(shaders_json()));
  replace(page.html, "three", page_file("three.min.js"));
  replace(page.html, "chunks", chunks.markup());
  replace(page.html, "script", scripts());
  return page;
}

}  // namespace lumitexel
