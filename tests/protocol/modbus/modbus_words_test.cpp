#include "drivers/modbus/modbus_words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "drivers/error.h"
#include "modbus_bench.h"

namespace lumitexel {
namespace {

using Words = std::vector<std::uint16_t>;

ModbusRegister holding(RegisterType type, double counts_per_unit = 1.0, double offset_counts = 0.0) {
  return {RegisterTable::Holding, 4, type, counts_per_unit, offset_counts};
}

struct Example {
  ModbusRegister where;
  double value;
  Words high_first;
};

// The words are worked out by hand, not by the code under test.
const std::vector<Example> kExamples{
    {holding(RegisterType::Uint16), 65535.0, {0xffff}},
    {holding(RegisterType::Int16), -2.0, {0xfffe}},
    {holding(RegisterType::Int16, 100.0), -19.99, {0xf831}},            // -1999
    {holding(RegisterType::Int32), -70000.0, {0xfffe, 0xee90}},
    {holding(RegisterType::Int32, 1000.0), 53.3, {0x0000, 0xd034}},      // 53300
    {holding(RegisterType::Int32), -2147483648.0, {0x8000, 0x0000}},
    {holding(RegisterType::Uint32), 4294967295.0, {0xffff, 0xffff}},
    {holding(RegisterType::Uint32, 10.0, 3000.0), -200.0, {0x0000, 0x03e8}},  // 1000 = 3000 - 2000
    {holding(RegisterType::Float32), -1.5, {0xbfc0, 0x0000}},
    {holding(RegisterType::Int32, -1000.0), 53.3, {0xffff, 0x2fcc}},     // an axis that counts the other way
    {{RegisterTable::Coil, 7, RegisterType::Bit}, 1.0, {1}},
};

TEST(ModbusWords, ValuesBecomeTheWordsThatTheyShouldAndComeBackExactly) {
  for (const Example& example : kExamples) {
    SCOPED_TRACE(example.value);
    const Words low_first(example.high_first.rbegin(), example.high_first.rend());
    EXPECT_EQ(words_from_value(example.where, example.value, WordOrder::HighFirst, "x"), example.high_first);
    EXPECT_EQ(words_from_value(example.where, example.value, WordOrder::LowFirst, "x"), low_first);
    EXPECT_EQ(value_from_words(example.where, example.high_first, WordOrder::HighFirst, "x"), example.value);
    EXPECT_EQ(value_from_words(example.where, low_first, WordOrder::LowFirst, "x"), example.value);
  }
}

TEST(ModbusWords, EveryThousandthOfADegreeComesBackAsTheDoubleThatItIsWrittenAs) {
  const ModbusRegister where = holding(RegisterType::Int32, 1000.0);
  for (int count = -360000; count <= 360000; count += 7) {
    const double place = count / 1000.0;
    const Words words = words_from_value(where, place, WordOrder::HighFirst, "x");
    ASSERT_EQ(value_from_words(where, words, WordOrder::HighFirst, "x"), place);
  }
}

TEST(ModbusWords, WhatARegisterCannotHoldIsRefusedByName) {
  const auto refused = [](const ModbusRegister& where, double value) {
    EXPECT_THROW(words_from_value(where, value, WordOrder::HighFirst, "turntable target"), OutOfRange) << value;
    const std::string message =
        message_of([&] { words_from_value(where, value, WordOrder::HighFirst, "turntable target"); });
    EXPECT_NE(message.find("turntable target (holding register"), std::string::npos) << message;
  };
  for (const RegisterType type : {RegisterType::Int16, RegisterType::Uint16, RegisterType::Int32, RegisterType::Uint32,
                                  RegisterType::Float32}) {
    refused(holding(type), std::numeric_limits<double>::quiet_NaN());
    refused(holding(type), std::numeric_limits<double>::infinity());
    refused(holding(type), -1e300);
  }
  refused(holding(RegisterType::Int16, 1000.0), 32.768);
  refused(holding(RegisterType::Uint16), -1.0);
  refused(holding(RegisterType::Int32, 1000.0), 2147483.648);
  refused(holding(RegisterType::Uint32), 4294967296.0);
  EXPECT_THROW(words_from_value({RegisterTable::Coil, 1, RegisterType::Bit}, 2.0, WordOrder::HighFirst, "x"),
               OutOfRange);
  EXPECT_THROW(write_of({{RegisterTable::Input, 1}, 1.0}, WordOrder::HighFirst, "x"), OutOfRange);
}

TEST(ModbusWords, AFloatThatIsNoNumberIsNotPassedOn) {
  const Words nan{0x7fc0, 0x0000}, infinity{0x7f80, 0x0000};
  EXPECT_THROW(value_from_words(holding(RegisterType::Float32), nan, WordOrder::HighFirst, "x"), Protocol);
  EXPECT_THROW(value_from_words(holding(RegisterType::Float32), infinity, WordOrder::HighFirst, "x"), Protocol);
}

TEST(ModbusWords, WritesToAdjoiningAddressesAreOneRequest) {
  const auto coil = [](int address, std::uint16_t word) { return ModbusWrite{RegisterTable::Coil, address, {word}}; };
  const ModbusWrite start{RegisterTable::Holding, 10, {1}}, stop{RegisterTable::Holding, 10, {2}};
  const std::vector<ModbusWrite> result =
      joined({coil(7, 0), stop, coil(5, 0), coil(6, 1), start, coil(9, 1), coil(6, 1)});
  const std::vector<ModbusWrite> expected{{RegisterTable::Coil, 5, {0, 1, 0}}, coil(9, 1), stop, start};
  EXPECT_EQ(result, expected);
}

}  // namespace
}  // namespace lumitexel
