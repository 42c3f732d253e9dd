// The light from far away that the viewer's page offers beside its lamp: a picture of the whole sphere as processing/render/environment.h
// has it, its z the world's z.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "processing/image/image.h"
#include "processing/report/viewer/packed_chunks.h"

namespace lumitexel {

// No wider than this in the page: a page of megabytes for a sky would be out of proportion.
inline constexpr int kMostSkyWidth = 256;

// A dim room with two soft boxes, one large and high, one small and warm: what there is where nobody gives another. Three channels.
Image built_in_sky();
// Of an EXR file with R, G, B or Y. Throws BadInput naming it where it is no environment for a model of so many channels.
Image read_sky(const std::filesystem::path& path, int channels);
// Blocks of whole pixels made one, weighted by their solid angles, until it is no wider than kMostSkyWidth: the same light in all, and each
// pixel again holds for the patch that it covers. Rows and columns left over at the end make smaller blocks of their own, which the page
// would stretch, so sizes that do not divide are refused: throws BadInput naming `where`.
Image reduced_sky(const Image& sky, const std::string& where);

// {"width", "height"} and the chunk "sky": three floats a pixel, row by row, one channel repeated.
nlohmann::json viewer_sky_json(const Image& sky);
void add_sky_chunk(const Image& sky, PackedChunks& chunks);

}  // namespace lumitexel
