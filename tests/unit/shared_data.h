// Data that the project did not make and does not carry: $LUMITEXEL_SHARED_DATA, or shared/data beside the checkout.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace lumitexel {

inline std::filesystem::path shared_data() {
  const char* given = std::getenv("LUMITEXEL_SHARED_DATA");
  return given != nullptr ? std::filesystem::path(given)
                          : std::filesystem::path(LUMITEXEL_SOURCE_DIR).parent_path() / "shared" / "data";
}

#define SKIP_WITHOUT_SHARED_DATA(name)                                                    \
  if (!std::filesystem::exists(lumitexel::shared_data() / (name)))                        \
  GTEST_SKIP() << "SHARED DATA MISSING: " << (lumitexel::shared_data() / (name)).string() \
               << " is not there, so this is not tested"

}  // namespace lumitexel
