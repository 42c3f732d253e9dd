#include "processing/calibration/import/import_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <sstream>

#include "processing/calibration/import/import_layout.h"
#include "processing/calibration/import/imported_views.h"
#include "rig/session_store.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/shared_data.h"
#include "tests/unit/small_import.h"

namespace lumitexel {
namespace {

ImportSummary import_small(const SmallImport& layout, const ImportSources& sources) {
  NoProgress progress;
  return import_session(sources, layout.session(), progress);
}
ImportSummary import_small(const SmallImport& layout) { return import_small(layout, layout.sources()); }

CalibratedSession calibrate_small(const SmallImport& layout) {
  NoProgress progress;
  return calibrate_imported(SessionStore::open(layout.session(), OpenMode::ReadOnly), progress).first;
}

TEST(ImportSession, KeepsTheSourcesUnchanged) {
  const SmallImport layout;
  const ImportSummary summary = import_small(layout);
  EXPECT_EQ(summary.views, 3);
  EXPECT_EQ(summary.heldout, 1);
  EXPECT_EQ(summary.channels, 3);

  const SessionStore store = SessionStore::open(layout.session(), OpenMode::ReadOnly);
  EXPECT_EQ(store.kind(), SessionKind::Imported);
  for (const char* name : {"cameras.txt", "images.txt", "lights.csv", "mesh.obj"}) {
    EXPECT_EQ(store.document(name), read_whole_file(layout.path(name))) << name;
  }
  ASSERT_EQ(store.frames().size(), 6u);
  for (const FrameRecord& frame : store.frames()) {
    const std::string source = frame.role == "mask" ? "masks/" + frame.name.substr(5) : "images/" + frame.name;
    EXPECT_EQ(read_whole_file(store.frame_path(frame)), read_whole_file(layout.path(source))) << frame.name;
  }
  // Nothing but the session is left beside it.
  for (const auto& entry : std::filesystem::directory_iterator(layout.path("made"))) {
    EXPECT_EQ(entry.path(), layout.session());
  }
}

TEST(ImportedViews, HavePoseLightAndRadianceOfTheSources) {
  const SmallImport layout;
  import_small(layout);
  const CalibratedSession session = calibrate_small(layout);
  EXPECT_EQ(session.channels, 3);
  EXPECT_EQ(session.mesh.triangles.size(), 4u);
  ASSERT_EQ(session.views.size(), 3u);
  const View& view = session.views[1];
  EXPECT_EQ(view.name, "b.exr");
  EXPECT_FALSE(view.heldout);
  EXPECT_TRUE(session.views[2].heldout);
  EXPECT_EQ(view.camera_from_world.translation(), Eigen::Vector3d(0.1, 0, 2));
  EXPECT_EQ(view.light.type, Light::Type::Directional);
  EXPECT_EQ(view.light.intensity, (std::vector<double>{1, 2, 3}));

  const RadianceImage image = read_radiance_image(view.photograph);
  EXPECT_EQ(image.radiance.data, SmallImport::photograph().data);
  EXPECT_EQ(image.variance.data, std::vector<float>(image.radiance.data.size(), 0.0f));
  for (int y = 0; y < SmallImport::kHeight; ++y) {
    for (int x = 0; x < SmallImport::kWidth; ++x) ASSERT_EQ(image.flag(x, y), x == 0 ? kPixelOutside : 0);
  }
}

TEST(ImportedViews, AreMadeOnceAndKeptByKey) {
  const SmallImport layout;
  import_small(layout);
  const CalibratedSession first = calibrate_small(layout);
  const auto written = std::filesystem::last_write_time(first.views[0].photograph);
  std::filesystem::remove(first.views[1].photograph);
  const CalibratedSession second = calibrate_small(layout);
  EXPECT_EQ(second.key, first.key);
  EXPECT_EQ(std::filesystem::last_write_time(second.views[0].photograph), written);
  EXPECT_TRUE(std::filesystem::exists(second.views[1].photograph));
}

TEST(ImportedViews, CodeValuesGoThroughTheResponseAndClippedOnesAreFlagged) {
  const SmallImport layout;
  Image code(SmallImport::kWidth, SmallImport::kHeight, 3, 51.0f / 255.0f);
  code.at(3, 2, 1) = 1.0f;
  layout.use_png(code);
  layout.put("response.csv", "0,0\n0.2,0.05\n1,4\n");
  ImportSources sources = layout.sources();
  sources.response = layout.path("response.csv").string();
  import_small(layout, sources);
  const RadianceImage image = read_radiance_image(calibrate_small(layout).views[0].photograph);
  EXPECT_NEAR(image.radiance.at(5, 5, 0), 0.05f, 1e-8f);  // code 51 of 255 stands on the curve's point
  EXPECT_EQ(image.radiance.at(3, 2, 1), 4.0f);
  EXPECT_EQ(image.flag(3, 2), kPixelSaturated);
  EXPECT_EQ(image.flag(5, 5), 0);
}

TEST(ImportedViews, AGrayscaleSessionHasOneChannelAndTheMeanIntensity) {
  const SmallImport layout;
  layout.use_png(Image(SmallImport::kWidth, SmallImport::kHeight, 1, 0.5f));
  ImportSources sources = layout.sources();
  sources.response = "srgb";
  EXPECT_EQ(import_small(layout, sources).channels, 1);
  const CalibratedSession session = calibrate_small(layout);
  EXPECT_EQ(session.views[0].light.intensity, (std::vector<double>{11.0}));
  const RadianceImage image = read_radiance_image(session.views[0].photograph);
  EXPECT_EQ(image.radiance.channels, 1);
  EXPECT_NEAR(image.radiance.at(4, 4), 0.21586f, 1e-5f);  // sRGB of code 128
}

struct BadCase {
  std::string name;
  std::function<void(const SmallImport&, ImportSources&)> spoil;
  std::vector<std::string> named;  // what the message must hold
};

void PrintTo(const BadCase& bad, std::ostream* out) { *out << bad.name; }

void spoil_pixel(const SmallImport& layout, float value) {
  Image image = SmallImport::photograph();
  image.at(7, 5, 1) = value;
  write_exr_colour(layout.path("images/b.exr"), image);
}

class BadImport : public testing::TestWithParam<BadCase> {};

TEST_P(BadImport, IsNamedAndLeavesNothingBehind) {
  const SmallImport layout;
  ImportSources sources = layout.sources();
  GetParam().spoil(layout, sources);
  try {
    import_small(layout, sources);
    FAIL() << "nothing was thrown";
  } catch (const BadInput& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : GetParam().named) {
      EXPECT_NE(message.find(part), std::string::npos) << "no '" << part << "' in: " << message;
    }
  }
  EXPECT_FALSE(std::filesystem::exists(layout.path("made"))) << "something was left behind";
}

const BadCase kBadCases[] = {
    {"MissingCameras", [](auto& l, auto&) { l.remove("cameras.txt"); }, {"cameras.txt", "no such file"}},
    {"MissingImagesTxt", [](auto& l, auto&) { l.remove("images.txt"); }, {"images.txt", "no such file"}},
    {"MissingLights", [](auto& l, auto&) { l.remove("lights.csv"); }, {"lights.csv", "no such file"}},
    {"MissingMesh", [](auto& l, auto&) { l.remove("mesh.obj"); }, {"mesh.obj", "no such file"}},
    {"MissingPhotograph", [](auto& l, auto&) { l.remove("images/b.exr"); }, {"images/b.exr", "no such file"}},
    {"MissingMask", [](auto& l, auto&) { l.remove("masks/b.png"); }, {"masks/b.png", "no such file"}},

    {"MeshNonManifold",
     [](auto& l, auto&) { l.replace("mesh.obj", "f 1 3 2", "v 1 1 1\nf 1 3 2\nf 1 2 5"); },
     {"mesh.obj:8", "manifold"}},
    {"MeshZeroArea", [](auto& l, auto&) { l.replace("mesh.obj", "f 1 2 4", "f 1 2 2"); }, {"mesh.obj:6", "zero area"}},
    {"MeshNan", [](auto& l, auto&) { l.replace("mesh.obj", "v 0 0.3 0", "v 0 nan 0"); }, {"mesh.obj:3", "nan"}},
    {"MeshEmpty", [](auto& l, auto&) { l.put("mesh.obj", ""); }, {"mesh.obj", "without faces"}},
    {"MeshOfUnknownFormat",
     [](auto& l, auto& s) {
       l.put("mesh.stl", "solid");
       s.mesh = l.path("mesh.stl");
     },
     {"mesh.stl", ".ply or .obj"}},

    {"PhotographOfWrongSize",
     [](auto& l, auto&) { write_exr_colour(l.path("images/b.exr"), Image(12, 16, 3, 1.0f)); },
     {"images/b.exr", "12x16", "16x12"}},
    {"PhotographTruncated",
     [](auto& l, auto&) { l.put("images/b.exr", read_whole_file(l.path("images/b.exr")).substr(0, 400)); },
     {"images/b.exr"}},
    {"PhotographWithNan", [](auto& l, auto&) { spoil_pixel(l, std::nanf("")); }, {"images/b.exr", "(7, 5)", "NaN"}},
    {"PhotographWithInfinity",
     [](auto& l, auto&) { spoil_pixel(l, std::numeric_limits<float>::infinity()); },
     {"images/b.exr", "(7, 5)", "infinite"}},
    {"PhotographAllBlack",
     [](auto& l, auto&) { write_exr_colour(l.path("images/b.exr"), Image(16, 12, 3)); },
     {"images/b.exr", "black"}},
    {"PhotographGrayAmongColour",
     [](auto& l, auto&) { write_exr_colour(l.path("images/b.exr"), Image(16, 12, 1, 1.0f)); },
     {"images/b.exr", "1 channels"}},
    {"PhotographPngTruncated",
     [](auto& l, auto& s) {
       l.use_png(Image(16, 12, 3, 0.5f));
       l.put("images/b.png", read_whole_file(l.path("images/b.png")).substr(0, 60));
       s.response = "linear";
     },
     {"images/b.png", "ends early"}},
    {"PhotographPngAllBlack",
     [](auto& l, auto& s) {
       l.use_png(Image(16, 12, 3));
       s.response = "linear";
     },
     {"images/a.png", "black"}},

    {"LightMissing",
     [](auto& l, auto&) { l.replace("lights.csv", "b.exr,directional,0,0,-1,1,2,3,fit\n", ""); },
     {"lights.csv", "image", "b.exr"}},
    {"LightMalformedNumber",
     [](auto& l, auto&) { l.replace("lights.csv", "1,0,-2,10", "1,0,-2..0,10"); },
     {"lights.csv:2: z", "-2..0"}},
    {"LightUnknownColumn",
     [](auto& l, auto&) { l.replace("lights.csv", "split", "spilt"); },
     {"lights.csv:1", "'spilt'"}},
    {"LightUnknownType",
     [](auto& l, auto&) { l.replace("lights.csv", "directional", "area"); },
     {"lights.csv:3: type", "area"}},
    {"LightWithoutImage", [](auto& l, auto&) { l.replace("lights.csv", "c.exr", "d.exr"); }, {"lights.csv", "c.exr"}},
    {"LightForNoImage",
     [](auto& l, auto&) { l.replace("images.txt", "3 1 0 0 0 -0.1 0 2 1 c.exr\n\n", ""); },
     {"lights.csv:4: image", "c.exr"}},
    {"EveryImageHeldOut",
     [](auto& l, auto&) {
       l.replace("lights.csv", ",fit", ",heldout");
       l.replace("lights.csv", ",fit", ",heldout");
     },
     {"lights.csv: split"}},

    {"MeshBehindTheCamera",
     [](auto& l, auto&) { l.replace("images.txt", "0.1 0 2", "0.1 0 -2"); },
     {"images.txt", "b.exr", "mesh.obj"}},
    {"MeshBesideTheFrame",
     [](auto& l, auto&) { l.replace("images.txt", "0.1 0 2", "5 0 2"); },
     {"images.txt", "b.exr", "mesh.obj"}},
    {"CameraUnknown",
     [](auto& l, auto&) { l.replace("images.txt", "2 1 b.exr", "2 9 b.exr"); },
     {"images.txt:3: CAMERA_ID", "9"}},

    {"MaskOfWrongSize",
     [](auto& l, auto&) { write_png8(l.path("masks/b.png"), Image(16, 11, 1, 1.0f)); },
     {"masks/b.png", "16x11", "16x12"}},
    {"MaskEmpty", [](auto& l, auto&) { write_png8(l.path("masks/b.png"), Image(16, 12, 1)); }, {"masks/b.png", "255"}},
    {"MaskNoImage", [](auto& l, auto&) { l.put("masks/b.png", "hello"); }, {"masks/b.png", "PNG"}},

    {"ResponseMissingForCodeValues",
     [](auto& l, auto&) { l.use_png(Image(16, 12, 3, 0.5f)); },
     {"--response", "a.png"}},
    {"ResponseForRadiance", [](auto&, auto& s) { s.response = "srgb"; }, {"--response", "srgb", "EXR"}},
    {"ResponseFileMissing",
     [](auto& l, auto& s) {
       l.use_png(Image(16, 12, 3, 0.5f));
       s.response = "nowhere.csv";
     },
     {"nowhere.csv", "no such file"}},
    {"ExrBesidePng",
     [](auto& l, auto&) {
       write_png8(l.path("images/b.png"), Image(16, 12, 3, 0.5f));
       l.replace("images.txt", "b.exr", "b.png");
       l.replace("lights.csv", "b.exr", "b.png");
     },
     {"images/b.png", "one kind"}},
    {"NamesThatCollide",
     [](auto& l, auto&) {
       std::filesystem::create_directory(l.path("images/x"));
       std::filesystem::copy(l.path("images/a.exr"), l.path("images/x/a.exr"));
       std::filesystem::create_directory(l.path("masks/x"));
       std::filesystem::copy(l.path("masks/a.png"), l.path("masks/x/a.png"));
       std::filesystem::copy(l.path("images/a.exr"), l.path("images/x_a.exr"));
       std::filesystem::copy(l.path("masks/a.png"), l.path("masks/x_a.png"));
       for (const char* file : {"images.txt", "lights.csv"}) {
         l.replace(file, "a.exr", "x/a.exr");
         l.replace(file, "b.exr", "x_a.exr");
       }
     },
     {"images.txt: NAME", "x_a.exr"}},
};

INSTANTIATE_TEST_SUITE_P(Import, BadImport, testing::ValuesIn(kBadCases),
                         [](const auto& test) { return test.param.name; });

TEST(ImportSession, ASessionInUseIsNotTouched) {
  const SmallImport layout;
  import_small(layout);
  EXPECT_BAD_INPUT(import_small(layout), layout.session().string());
  EXPECT_EQ(calibrate_small(layout).views.size(), 3u);
}

TEST(ImportSession, AStopLeavesNothingBehind) {
  const SmallImport layout;
  // Asked for at the first photograph stored, after everything has been checked.
  struct StopAtStoring final : Progress {
    std::stop_source source;
    std::string stage;
    void begin(const std::string& name, std::int64_t, const std::string&) override { stage = name; }
    void update(std::int64_t) override {
      if (stage == "storing") source.request_stop();
    }
  } progress;
  EXPECT_THROW(import_session(layout.sources(), layout.session(), progress, progress.source.get_token()), Cancelled);
  EXPECT_TRUE(progress.source.stop_requested());
  EXPECT_FALSE(std::filesystem::exists(layout.path("made")));
}

NamedText named_text(const std::filesystem::path& path) { return {read_whole_file(path), path.string()}; }

TEST(ImportLayout, JoinsTheViewsOfAnUnrelatedRenderer) {
  SKIP_WITHOUT_SHARED_DATA("oracle_a");
  const std::filesystem::path oracle = shared_data() / "oracle_a";
  const auto views = join_views(named_text(oracle / "cameras.txt"), named_text(oracle / "images.txt"),
                                named_text(oracle / "lights.csv"));
  EXPECT_EQ(views.size(), 30u);
  EXPECT_EQ(std::count_if(views.begin(), views.end(), [](const View& view) { return view.heldout; }), 6);
}

// The lines of a file that are comments, header, or of one of the images.
std::string lines_of_images(const std::filesystem::path& path, const std::vector<std::string>& images) {
  std::istringstream all(read_whole_file(path));
  std::string kept;
  for (std::string line; std::getline(all, line);) {
    const bool of_image = std::any_of(images.begin(), images.end(),
                                      [&](const std::string& image) { return line.find(image) != std::string::npos; });
    if (of_image || line.rfind("image,", 0) == 0) kept += line + "\n" + (path.extension() == ".txt" ? "\n" : "");
  }
  return kept;
}

TEST(ImportSession, ReadsPhotographsOfAnUnrelatedRenderer) {
  SKIP_WITHOUT_SHARED_DATA("oracle_a");
  const TemporaryFolder folder;
  const std::filesystem::path oracle = shared_data() / "oracle_a";
  const std::vector<std::string> images{"fit_000.exr", "fit_013.exr", "heldout_002.exr"};
  std::filesystem::copy(oracle / "cameras.txt", folder / "cameras.txt");
  write_whole_file(folder / "images.txt", lines_of_images(oracle / "images.txt", images));
  write_whole_file(folder / "lights.csv", lines_of_images(oracle / "lights.csv", images));
  NoProgress progress;
  const ImportSummary summary = import_session(
      {folder.path(), oracle / "images", folder / "lights.csv", oracle / "mesh.ply", oracle / "masks", ""},
      folder / "s", progress);
  EXPECT_EQ(summary.views, 3);
  EXPECT_EQ(summary.heldout, 1);
  const CalibratedSession session = calibrate_imported(SessionStore::open(folder / "s", OpenMode::ReadOnly), progress).first;
  // Poses, cameras and masks agree: nearly all vertices of the mesh fall on the object. The
  // masks' outline and the coarse mesh's may differ by a pixel or two of some hundred.
  for (const View& view : session.views) {
    const RadianceImage image = read_radiance_image(view.photograph);
    int on_object = 0;
    for (const Eigen::Vector3d& position : session.mesh.positions) {
      const Eigen::Vector2d pixel = view.camera.project(view.camera_from_world * position);
      on_object +=
          view.camera.contains(pixel) && image.flag(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())) == 0;
    }
    EXPECT_GT(on_object, 0.98 * static_cast<double>(session.mesh.positions.size())) << view.name;
    EXPECT_EQ(image.flag(0, 0), kPixelOutside) << view.name;
  }
}

}  // namespace
}  // namespace lumitexel
