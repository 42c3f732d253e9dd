#include "processing/report/viewer/viewer_page.h"

#include <cstring>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/report/html.h"
#include "processing/report/viewer/packed_chunks.h"
#include "processing/report/viewer/page_files.h"
#include "processing/report/viewer/viewer_lumitexels.h"
#include "processing/report/viewer/viewer_model.h"

namespace lumitexel {
namespace {

// In the order in which they are run: each may use what those before it defined.
constexpr const char* kScripts[] = {"data.js",    "hierarchy.js", "reflectance.js", "camera.js", "textures.js",        "renderer.js",
                                    "picture.js", "orbit.js",     "panel.js",       "lumitexel_panel.js", "main.js"};
constexpr const char* kShaders[] = {"brdf.glsl",     "surface.glsl", "texels.glsl", "occlusion.glsl", "triangle.vert",
                                    "triangle.frag", "screen.vert",  "shade.frag",  "maps.frag",      "display.frag"};

std::string page_file(const std::string& name) {
  for (const PageFile* file = kPageFiles; file->name != nullptr; ++file) {
    if (name == file->name) return file->text;
  }
  throw Error("viewer: the page's file " + name + " is not in the program");
}

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

std::string inline_json(const std::string& json) {
  std::string text = json;
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) text.insert(at + 1, "\\");
  return text;
}

}  // namespace

ViewerPage viewer_page(const ViewerSubject& subject, Progress& progress) {
  if (subject.sample_lattice < 1) throw BadInput("samples", std::to_string(subject.sample_lattice), "1 or more");
  ViewerPage page;
  PackedChunks chunks;
  nlohmann::json document = viewer_model_json(subject.model);
  document["title"] = subject.name;
  page.textured_texels = textured_texels(subject.model).size();
  if (subject.session != nullptr) {
    const CarriedSamples carried = add_lumitexels(subject.model, *subject.session, subject.sample_lattice, document, chunks, progress);
    page.lumitexels = carried.lumitexels;
    page.samples = carried.samples;
  }
  progress.begin("viewer: packing", 1, "pages");
  add_model_chunks(subject.model, chunks);
  chunks.add_text("three", page_file("three.min.js"));
  document["chunks"] = nlohmann::json::parse(chunks.directory_json());

  page.bytes = chunks.bytes();
  const std::string own[] = {page_file("style.css"), inline_json(document.dump()), inline_json(shaders_json()), scripts()};
  page.html = page_file("page.html");
  replace(page.html, "title", html::escaped(subject.name));
  replace(page.html, "style", own[0]);
  replace(page.html, "document", own[1]);
  replace(page.html, "shaders", own[2]);
  replace(page.html, "chunks", chunks.markup());
  replace(page.html, "script", own[3]);
  page.bytes["description"] = own[1].size();
  page.bytes["program"] = own[0].size() + own[2].size() + own[3].size();
  progress.update(1);
  return page;
}

std::string viewer_frame(const ViewerPage& page, const std::string& title) {
  return "<iframe title=\"" + html::escaped(title) + "\" loading=\"lazy\" style=\"width:100%;height:720px;border:0\" srcdoc=\"" +
         html::escaped(page.html) + "\"></iframe>\n";
}

}  // namespace lumitexel
