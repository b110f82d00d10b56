#include "tools/facewire/servo/open.h"

#include <CLI/CLI.hpp>

#include "app/error.h"

namespace facewire::tools {

std::string WithService(const std::string& line) {
  if (line.find("in use by another program") == std::string::npos) return line;
  return line + "; if it is the service: sudo systemctl stop facewired, or move with --live";
}

void OpenOutput(app::ServoOutput& output) {
  try {
    output.Open();
  } catch (const app::BadInput& error) {
    throw app::BadInput(WithService(error.what()));
  }
}

void AddConfigOption(CLI::App& command, std::string& config) {
  command.add_option("--config", config, "The service's configuration")->capture_default_str();
}

}  // namespace facewire::tools
