// EXPECT_BAD_INPUT(statement, part, part…): it throws BadInput whose message, one line, holds every part.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <initializer_list>
#include <string>

#include "drivers/error.h"

namespace lumitexel {

inline testing::AssertionResult throws_bad_input(const std::function<void()>& action,
                                                 std::initializer_list<std::string> parts) {
  try {
    action();
  } catch (const BadInput& error) {
    const std::string message = error.what();
    if (message.find('\n') != std::string::npos) return testing::AssertionFailure() << "more than a line: " << message;
    for (const std::string& part : parts) {
      if (message.find(part) == std::string::npos)
        return testing::AssertionFailure() << "no '" << part << "' in: " << message;
    }
    return testing::AssertionSuccess();
  } catch (const std::exception& error) {
    return testing::AssertionFailure() << "threw something else: " << error.what();
  }
  return testing::AssertionFailure() << "threw nothing";
}

#define EXPECT_BAD_INPUT(statement, ...) EXPECT_TRUE(lumitexel::throws_bad_input([&] { statement; }, {__VA_ARGS__}))

}  // namespace lumitexel
