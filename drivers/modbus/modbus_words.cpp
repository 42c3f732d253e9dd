#include "drivers/modbus/modbus_words.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostWordsInARequest = 100;  // below every limit of the protocol

struct CountRange {
  double min, max;
};

CountRange range_of(const ModbusRegister& where) {
  if (is_bit_table(where.table)) return {0.0, 1.0};
  switch (where.type) {
    case RegisterType::Bit: return {0.0, 1.0};
    case RegisterType::Int16: return {-32768.0, 32767.0};
    case RegisterType::Uint16: return {0.0, 65535.0};
    case RegisterType::Int32: return {-2147483648.0, 2147483647.0};
    case RegisterType::Uint32: return {0.0, 4294967295.0};
    case RegisterType::Float32: break;
  }
  constexpr double kMost = std::numeric_limits<float>::max();
  return {-kMost, kMost};
}

std::uint32_t bits_of(const ModbusRegister& where, double count) {
  if (where.type == RegisterType::Float32) return std::bit_cast<std::uint32_t>(static_cast<float>(count));
  // By way of 64 signed bits: negative counts keep their two's complement.
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::round(count)));
}

double count_of(const ModbusRegister& where, std::uint32_t bits) {
  switch (where.type) {
    case RegisterType::Int16: return static_cast<std::int16_t>(bits);
    case RegisterType::Int32: return static_cast<std::int32_t>(bits);
    case RegisterType::Float32: return std::bit_cast<float>(bits);
    default: return bits;
  }
}

bool follows(const ModbusWrite& before, const ModbusWrite& after) {
  return before.table == after.table && before.address + static_cast<int>(before.words.size()) == after.address &&
         before.words.size() + after.words.size() <= kMostWordsInARequest;
}

}  // namespace

bool is_bit_table(RegisterTable table) {
  return table == RegisterTable::Coil || table == RegisterTable::DiscreteInput;
}

bool is_writable(RegisterTable table) { return table == RegisterTable::Coil || table == RegisterTable::Holding; }

int word_count(const ModbusRegister& where) {
  if (is_bit_table(where.table)) return 1;
  return where.type == RegisterType::Int32 || where.type == RegisterType::Uint32 || where.type == RegisterType::Float32
             ? 2
             : 1;
}

std::string to_string(const ModbusRegister& where) {
  const std::string address = std::to_string(where.address);
  switch (where.table) {
    case RegisterTable::Coil: return "coil " + address;
    case RegisterTable::DiscreteInput: return "discrete input " + address;
    case RegisterTable::Holding: break;
    case RegisterTable::Input: break;
  }
  const std::string kind = where.table == RegisterTable::Holding ? "holding" : "input";
  if (word_count(where) == 1) return kind + " register " + address;
  return kind + " registers " + address + "-" + std::to_string(where.address + 1);
}

std::vector<std::uint16_t> words_from_value(const ModbusRegister& where, double value, WordOrder order,
                                            const std::string& what) {
  const double count = value * where.counts_per_unit + where.offset_counts;
  const CountRange range = range_of(where);
  const double rounded = where.type == RegisterType::Float32 && !is_bit_table(where.table) ? count : std::round(count);
  if (!(rounded >= range.min && rounded <= range.max)) {  // reached for NaN, too
    std::ostringstream text;
    text << what << " (" << to_string(where) << "): " << value << " asked for, which is " << count
         << " counts; the register holds " << range.min << " to " << range.max;
    throw OutOfRange(text.str());
  }
  const std::uint32_t bits = bits_of(where, rounded);
  const auto high = static_cast<std::uint16_t>(bits >> 16), low = static_cast<std::uint16_t>(bits & 0xffffu);
  if (word_count(where) == 1) return {low};
  return order == WordOrder::HighFirst ? std::vector{high, low} : std::vector{low, high};
}

double value_from_words(const ModbusRegister& where, std::span<const std::uint16_t> words, WordOrder order,
                        const std::string& what) {
  if (is_bit_table(where.table)) return words[0] != 0 ? 1.0 : 0.0;
  std::uint32_t bits = words[0];
  if (word_count(where) == 2) {
    const bool high_first = order == WordOrder::HighFirst;
    bits = std::uint32_t{words[high_first ? 0 : 1]} << 16 | words[high_first ? 1 : 0];
  }
  const double value = (count_of(where, bits) - where.offset_counts) / where.counts_per_unit;
  if (!std::isfinite(value)) throw Protocol(what + " (" + to_string(where) + "): reads as something that is no number");
  return value;
}

ModbusWrite write_of(const ModbusCommand& command, WordOrder order, const std::string& what) {
  if (!is_writable(command.where.table)) {
    throw OutOfRange(what + " (" + to_string(command.where) +
                     "): such a register cannot be written; use a coil or a holding one");
  }
  return {command.where.table, command.where.address, words_from_value(command.where, command.value, order, what)};
}

std::vector<ModbusWrite> joined(std::vector<ModbusWrite> writes) {
  std::stable_sort(writes.begin(), writes.end(), [](const ModbusWrite& a, const ModbusWrite& b) {
    return a.table != b.table ? a.table < b.table : a.address < b.address;
  });
  std::vector<ModbusWrite> unique;
  for (const ModbusWrite& write : writes) {
    if (std::find(unique.begin(), unique.end(), write) == unique.end()) unique.push_back(write);
  }
  std::vector<ModbusWrite> result;
  for (const ModbusWrite& write : unique) {
    if (!result.empty() && follows(result.back(), write)) {
      result.back().words.insert(result.back().words.end(), write.words.begin(), write.words.end());
    } else {
      result.push_back(write);
    }
  }
  return result;
}

}  // namespace lumitexel
