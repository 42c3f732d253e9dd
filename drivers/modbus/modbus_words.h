// Values in units, and the 16-bit words that carry them. Nothing here talks to anybody.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/modbus/register_map.h"

namespace lumitexel {

bool is_bit_table(RegisterTable table);      // coils and discrete inputs
bool is_writable(RegisterTable table);       // coils and holding registers
int word_count(const ModbusRegister& where);  // 1, or 2 for the types of 32 bits
std::string to_string(const ModbusRegister& where);  // "coil 3", "input registers 4-5"

// The words that stand for a value at a register, word_count() of them; a bit is one word, 0 or 1. Counts are rounded
// to the nearest. Throws OutOfRange, naming `what`, for NaN and for what the register's type cannot hold.
std::vector<std::uint16_t> words_from_value(const ModbusRegister& where, double value, WordOrder order,
                                            const std::string& what);

// The reverse: (count - offset_counts) / counts_per_unit. Throws Protocol, naming `what`, for a float that is no
// number.
double value_from_words(const ModbusRegister& where, std::span<const std::uint16_t> words, WordOrder order,
                        const std::string& what);

// One request that writes, in coils one bit a word.
struct ModbusWrite {
  RegisterTable table = RegisterTable::Holding;
  int address = 0;
  std::vector<std::uint16_t> words;
  bool operator==(const ModbusWrite&) const = default;
};

ModbusWrite write_of(const ModbusCommand& command, WordOrder order, const std::string& what);  // throws as above

// The same in as few requests as there are unbroken runs of addresses, none twice. Two different values for the same
// address are two requests, in the order given.
std::vector<ModbusWrite> joined(std::vector<ModbusWrite> writes);

}  // namespace lumitexel
