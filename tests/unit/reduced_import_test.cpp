#include "processing/calibration/import/reduced_import.h"

#include <gtest/gtest.h>

#include "drivers/error.h"
#include "processing/calibration/calibrated_session.h"
#include "rig/verify_session.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/small_import.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

class ReducedImport : public testing::Test {
 protected:
  ReducedImport() {
    layout_.replace("images.txt", "1 1 0 0", "# poses\n1 1 0 0");
    layout_.replace("images.txt", "a.exr\n\n", "a.exr\n5 5 -1\n");  // the image's points go with it
    layout_.replace("lights.csv", "b.exr", "# a second light\nb.exr");
    import_session(layout_.sources(), layout_.session(), progress_);
  }
  SessionStore original() const { return SessionStore::open(layout_.session(), OpenMode::ReadOnly); }
  std::int64_t copy(const SelectionOptions& options) {
    const SessionStore session = original();
    return copy_import(session, select_views(imported_views(session), options), copy_, progress_);
  }
  SessionStore copied() const { return SessionStore::open(copy_, OpenMode::ReadOnly); }

  SmallImport layout_;
  NoProgress progress_;
  fs::path copy_ = layout_.path("copy");
};

TEST_F(ReducedImport, OfEverythingIsTheSameSession) {
  EXPECT_EQ(copy({}), 6);
  EXPECT_EQ(copied().content_sha256(), original().content_sha256());
  EXPECT_TRUE(verify_session(copied(), progress_).ok());
}

TEST_F(ReducedImport, WithoutAViewIsOneThatCalibrates) {
  EXPECT_EQ(copy({{"view=a"}, {}}), 4);
  EXPECT_TRUE(verify_session(copied(), progress_).ok());
  const CalibratedSession session = calibrate_session(copied(), progress_);
  ASSERT_EQ(session.views.size(), 2u);
  EXPECT_EQ(session.views[0].name, "b.exr");
  EXPECT_EQ(session.views[0].camera_from_world.translation(), Eigen::Vector3d(0.1, 0, 2));
  EXPECT_EQ(session.views[0].light.intensity, (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(session.views[1].heldout);
  EXPECT_EQ(copied().document("mesh.obj"), original().document("mesh.obj"));
  EXPECT_NE(copied().document("images.txt").find("# poses"), std::string::npos);
}

TEST_F(ReducedImport, RefusesWhatItCannotDoAndLeavesNothing) {
  EXPECT_BAD_INPUT(copy({{"kind=dark"}, {}}), "--without", "dark", "no kind");
  EXPECT_BAD_INPUT(copy({{"views=0..1"}, {}}), "no view to fit", "2 c.exr (held out)");
  fs::resize_file(layout_.session() / "frames" / "c.exr", 100);
  EXPECT_THROW(copy({{"view=a"}, {}}), Corrupt);
  EXPECT_FALSE(fs::exists(copy_));
}

}  // namespace
}  // namespace lumitexel
