#include "rig/console/command_line.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

namespace lumitexel {
namespace {

// Decimal; CLI11 would take 0100 for an octal number.
template <typename Number>
std::optional<Number> number_in(const std::string& text) {
  Number number{};
  const char *begin = text.data(), *const end = begin + text.size();
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++begin;
  const auto [read, error] = std::from_chars(begin, end, number);
  if (error != std::errc() || read != end) return std::nullopt;
  return number;
}

// CLI11's own would say "not in range" of what is no number, and let NaN pass. Leaves the text as CLI11 reads it.
template <typename Number>
CLI::Validator within(Number least, Number most, const std::string& allowed) {
  const std::string kind = std::is_integral_v<Number> ? "a whole number " : "a finite number ";
  const auto check = [=](std::string& text) {
    const std::optional<Number> number = number_in<Number>(text);
    if (!number || !(*number >= least && *number <= most)) return "expected " + kind + allowed + ", got '" + text + "'";
    if constexpr (std::is_integral_v<Number>) text = std::to_string(*number);
    return std::string();
  };
  return {check, allowed};
}

template <typename Number>
std::string from_to(Number least, Number most) {
  std::ostringstream text;
  text << "from " << least << " to " << most;
  return text.str();
}

}  // namespace

CommandOption& CommandOption::required() {
  option_.required();
  return *this;
}

CommandOption& CommandOption::capture_default_str() {
  option_.capture_default_str();
  return *this;
}

CommandOption& CommandOption::type_name(const std::string& name) {
  option_.type_name(name);
  return *this;
}

CommandOption& CommandOption::delimiter(char between) {
  option_.delimiter(between);
  return *this;
}

CommandOption& CommandOption::one_each_time() {
  option_.expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

CommandOption& CommandOption::range(int least, int most) {
  option_.transform(within(least, most, from_to(least, most)));
  return *this;
}

CommandOption& CommandOption::range(double least, double most) {
  option_.check(within(least, most, from_to(least, most)));
  return *this;
}

CommandOption& CommandOption::positive() {
  constexpr double kLeast = std::numeric_limits<double>::denorm_min(), kMost = std::numeric_limits<double>::max();
  option_.check(within(kLeast, kMost, "above 0"));
  return *this;
}

Command::Command(CLI::App& app, const std::string& name, const std::string& description) : app_(*app.add_subcommand(name, description)) {}

template <typename Value>
CommandOption Command::add_option(const std::string& names, Value& value, const std::string& description) {
  return CommandOption(*app_.add_option(names, value, description));
}

template CommandOption Command::add_option(const std::string&, std::string&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::filesystem::path&, const std::string&);
template CommandOption Command::add_option(const std::string&, int&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::uint64_t&, const std::string&);
template CommandOption Command::add_option(const std::string&, double&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::optional<int>&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::optional<std::size_t>&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::optional<double>&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::optional<std::string>&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);

void Command::add_flag(const std::string& names, bool& value, const std::string& description) { app_.add_flag(names, value, description); }

void Command::add_flag_callback(const std::string& names, std::function<void()> when_given, const std::string& description) {
  app_.add_flag_callback(names, std::move(when_given), description);
}

void Command::footer(const std::string& text) { app_.footer(text); }

void Command::callback(std::function<void()> when_chosen) { app_.callback(std::move(when_chosen)); }

}  // namespace lumitexel
