// The options of one subcommand. CLI11 stands behind them and out of sight: its header makes a program of its own of every file that
// includes it, three seconds of compiling each.
#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lumitexel {

class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_(option) {}
  CommandOption& required();
  CommandOption& capture_default_str();  // the value that is there already, into the help
  CommandOption& type_name(const std::string& name);
  CommandOption& delimiter(char between);  // several values at once
  CommandOption& one_each_time();          // and may be given again
  CommandOption& range(int least, int most);
  CommandOption& range(double least, double most);
  CommandOption& positive();

 private:
  CLI::Option& option_;
};

class Command {
 public:
  Command(CLI::App& app, const std::string& name, const std::string& description);
  // Value: std::string or a path, a number, either of these optional, or a list of strings.
  template <typename Value>
  CommandOption add_option(const std::string& names, Value& value, const std::string& description);
  void add_flag(const std::string& names, bool& value, const std::string& description);
  void add_flag_callback(const std::string& names, std::function<void()> when_given, const std::string& description);
  void footer(const std::string& text);
  void callback(std::function<void()> when_chosen);

 private:
  CLI::App& app_;
};

}  // namespace lumitexel
