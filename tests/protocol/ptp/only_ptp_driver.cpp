// libgphoto2 loads all of its drivers, and what they need in turn, for each connection. The tests connect some hundred
// times and need one driver: they offer it that one alone.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

class OnlyPtpDriver final : public testing::Environment {
 public:
  void SetUp() override {
    const std::filesystem::path driver = std::filesystem::path(LUMITEXEL_GPHOTO_DRIVERS) / "ptp2.so";
    ASSERT_TRUE(std::filesystem::exists(driver)) << driver;
    folder_ = std::make_unique<TemporaryFolder>();
    std::filesystem::create_symlink(driver, *folder_ / "ptp2.so");
    setenv("CAMLIBS", folder_->path().c_str(), 1);
  }
  void TearDown() override { folder_.reset(); }

 private:
  std::unique_ptr<TemporaryFolder> folder_;
};

[[maybe_unused]] const auto* const kEnvironment = testing::AddGlobalTestEnvironment(new OnlyPtpDriver);

}  // namespace
}  // namespace lumitexel
