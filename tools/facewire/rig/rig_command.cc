#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/error.h"
#include "app/profile_file.h"
#include "app/rig_file.h"
#include "app/servo_rig_file.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/output_file.h"
#include "tools/facewire/rig/gltf_json.h"
#include "tools/facewire/rig/rig_check.h"
#include "tools/facewire/rig/rig_import.h"
#include "tools/facewire/rig/rig_picture.h"
#include "tools/facewire/rig/shape_names.h"
#include "tools/sheet/png.h"

namespace facewire::tools {
namespace {

struct ImportOptions {
  std::string character;
  std::string out;
  std::string unit = "auto";
  bool force = false;
};

const std::map<std::string, double> kUnits = {{"auto", 0}, {"m", 100}, {"cm", 1}, {"mm", 0.1}};

void Import(const ImportOptions& options) {
  // A device or a pipe is there already, too, and takes what comes.
  if (!options.force && std::filesystem::is_regular_file(options.out))
    throw app::BadInput(
        "--out " + options.out +
        ": is there already, perhaps edited; another name or --force would be right");
  const rig::ImportedRig imported =
      rig::ImportRig(rig::ReadBytes(options.character), options.character, kUnits.at(options.unit));
  OutputFile out(options.out);
  out.Write(imported.toml);
  out.Commit();
  std::fputs(imported.summary.c_str(), stdout);
}

void AddImport(CLI::App& rig) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command = rig.add_subcommand(
      "import",
      "Propose a rig for a character: its blend shapes and bones by their names, VRM's "
      "expressions, and bones by where they lie");
  command->add_option("CHARACTER", options->character, "A .glb, .gltf or .vrm")->required();
  command->add_option("--out", options->out, "The rig.toml to write")->required();
  command
      ->add_option("--unit", options->unit,
                   "Of the character's file; auto judges it by the distance between the eyes")
      ->check(CLI::IsMember({"auto", "m", "cm", "mm"}))
      ->capture_default_str();
  command->add_flag("--force", options->force, "Overwrite a rig that is there");
  command->callback([options] { Import(*options); });
}

struct CheckOptions {
  std::string rig;
  std::string profile;
};

// The signals of a profile, or those of the one that ships.
std::vector<std::string> SignalsOf(const std::string& profile) {
  std::vector<std::string> signals;
  if (profile.empty()) {
    for (const std::string& shape : rig::ArkitShapes())
      if (shape != rig::UnseenShape()) signals.push_back(shape);
  } else {
    for (const ShortName& name : app::ReadTrainingSet(profile).signals)
      signals.emplace_back(name.view());
  }
  return signals;
}

void Check(const CheckOptions& options) {
  const Rig character = app::LoadRig(options.rig);
  const servo::ServoRig servos = app::LoadServoRig(options.rig, character);
  const std::vector<rig::Remark> remarks =
      rig::CheckRig(character, servos, SignalsOf(options.profile));
  std::printf("%s: %zu bones, %zu channels, %zu servos\n",
              std::string(character.name.view()).c_str(), character.bones.size(),
              character.channels.size(), servos.servos.size());
  for (const rig::Remark& remark : remarks)
    std::printf("%s %s\n", remark.lacks ? "lacks" : "hint ", remark.text.c_str());
  const auto lacking = std::ranges::count_if(remarks, &rig::Remark::lacks);
  if (remarks.empty()) {
    std::printf("a face reads on it, and nothing needs a word\n");
  } else {
    std::printf("%zu lacking, %zu hints\n", static_cast<std::size_t>(lacking),
                remarks.size() - static_cast<std::size_t>(lacking));
  }
}

void AddCheck(CLI::App& rig) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = rig.add_subcommand(
      "check", "Say what a rig still lacks for a face to read on it, and what looks unintended");
  command->add_option("RIG", options->rig, "A rig.toml")->required();
  command->add_option("--profile", options->profile,
                      "The profile whose signals drive it; else the names of the default one");
  command->callback([options] { Check(*options); });
}

struct ShowOptions {
  std::string rig;
  std::string out;
};

void Show(const ShowOptions& options) {
  const Rig character = app::LoadRig(options.rig);
  OutputFile out(options.out);
  out.Write(EncodePng(rig::DrawRig(character)));
  out.Commit();
}

void AddShow(CLI::App& rig) {
  auto options = std::make_shared<ShowOptions>();
  CLI::App* command = rig.add_subcommand(
      "show", "Draw a rig: its bones on a face, and every channel with its range and drives");
  command->add_option("RIG", options->rig, "A rig.toml")->required();
  command->add_option("--out", options->out, "The PNG to write")->required();
  command->callback([options] { Show(*options); });
}

}  // namespace

void AddRig(CLI::App& facewire) {
  CLI::App* command = facewire.add_subcommand("rig", "Make, check and draw the rig of a character");
  command->require_subcommand(1);
  command->footer(
      "import CHARACTER with --out writes a rig.toml; check RIG prints a line for each thing that "
      "is "
      "lacking or looks unintended; show RIG with --out draws a PNG.\n"
      "`facewire rig VERB --help` tells more about a verb.");
  AddImport(*command);
  AddCheck(*command);
  AddShow(*command);
}

}  // namespace facewire::tools
