// The atlas of a mesh that brings texture coordinates of its own: they are kept bit for bit, and lumitexels lie at the texels' centres.
#pragma once

#include <string>
#include <vector>

#include "processing/surface/atlas.h"

namespace lumitexel {

enum class LayoutChoice {
  Auto,         // the mesh's where it has one that serves, else cut from the photographs
  Photographs,  // make_atlas
  Mesh          // the mesh's, or BadInput that says why not
};
const char* to_string(LayoutChoice choice);  // "auto", "photographs", "mesh"

struct LayoutOptions {
  LayoutChoice choice = LayoutChoice::Auto;
  int size = 0;  // texels a side of a mesh's layout; 0: as fine as the best photographs
};

struct LayoutSummary {
  bool of_mesh = false;
  std::string refused;  // why the mesh's layout does not serve, if it has one; empty otherwise
  // How many pixels of its best photograph a texel of the mesh's layout spans in each direction: at 5, 50 and 95 % of the surface seen.
  double pixels_a_texel[3]{};
  std::size_t mirrored_triangles = 0;  // of the mesh's layout; they are served like any other
  // Texels of one chart that look-ups in another read too, because charts lie closer than a gutter: there materials bleed.
  std::size_t shared_texels = 0;
  std::size_t lumitexels_at_texels = 0;  // of an atlas cut from photographs: see atlas.h
};

// Texels about as fine as the best photographs' pixels: of a square layout, the side at which a texel spans one pixel in the middle of the
// surface seen (half is finer, half coarser); 64 to 16384.
int natural_size(const CalibratedSession& session, const std::vector<int>& best_view);

// What keeps a mesh's texture coordinates from being used with `size` texels a side: none at all, some outside [0, 1], triangles without
// area in the layout (over a thousandth of the surface), or charts on top of each other (over a thousandth of the texels). Empty: nothing.
std::string layout_fault(const Mesh& mesh, int size);

// The atlas that `options` asks for. Throws BadInput for LayoutChoice::Mesh where the mesh's does not serve, and for a size with
// LayoutChoice::Photographs; Error as make_atlas does.
Atlas lay_out(const CalibratedSession& session, const std::vector<int>& best_view, const LayoutOptions& options, LayoutSummary& summary);

}  // namespace lumitexel
