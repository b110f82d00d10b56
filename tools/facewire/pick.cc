#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/error.h"
#include "core/base/name.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/frame_picker.h"
#include "tools/facewire/output_file.h"
#include "tools/facewire/session.h"
#include "tools/facewire/session_writer.h"

namespace facewire::tools {
namespace {

struct PickOptions {
  SessionOptions session;
  std::string out;
  std::string count = "auto";
  double tolerance = PickRules{}.tolerance;
  std::string neutral;
  std::vector<std::string> targets;
  std::string template_file;
};

constexpr std::size_t kMostFrames = 200;

std::uint64_t ParseNumber(const std::string& option, const std::string& text) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || parsed != end)
    throw app::BadInput(option + " " + text + ": a whole number would be right");
  return value;
}

PickRules RulesOf(const PickOptions& options, const std::vector<SessionFrame>& frames) {
  PickRules rules;
  rules.tolerance = options.tolerance;
  if (options.count != "auto") {
    rules.most = ParseNumber("--count", options.count);
    rules.tolerance = 0;
    if (rules.most < 2 || rules.most > kMostFrames)
      throw app::BadInput("--count " + options.count + ": auto, or 2 to " +
                          std::to_string(kMostFrames) + " with the neutral, would be right");
  }
  if (options.neutral.empty()) return rules;
  const std::uint64_t number = ParseNumber("--neutral", options.neutral);
  const auto at = std::ranges::find(frames, number, &SessionFrame::frame);
  if (at == frames.end() || !IsComplete(*at))
    throw app::BadInput("--neutral " + options.neutral +
                        ": no frame of this number in which every marker is seen");
  rules.neutral = static_cast<std::size_t>(at - frames.begin());
  return rules;
}

void CheckTargets(const PickOptions& options) {
  if (options.targets.empty() != options.template_file.empty())
    throw app::BadInput(
        "--targets and --template belong together: the names, and the file for them");
  for (const std::string& target : options.targets) {
    if (!ShortName::From(target))
      throw app::BadInput("--targets: \"" + target + "\" cannot be a name; 1 to " +
                          std::to_string(kMaxNameLength) +
                          " printable characters without spaces can");
    if (std::ranges::count(options.targets, target) > 1)
      throw app::BadInput("--targets: " + target + " appears twice");
  }
  if (std::filesystem::exists(options.template_file))
    throw app::BadInput(
        "--template " + options.template_file +
        ": is there already, perhaps with values in it; another name would be right");
}

void WriteTemplate(const PickOptions& options, const std::vector<SessionFrame>& frames,
                   const PickedFrames& picked) {
  OutputFile out(options.template_file);
  std::string text = "frame";
  for (const std::string& target : options.targets) text += "," + target;
  for (std::size_t row = 0; row < picked.frames.size(); ++row) {
    text += "\n" + std::to_string(frames[picked.frames[row].index].frame);
    for (std::size_t i = 0; i < options.targets.size(); ++i) text += row == 0 ? ",0" : ",";
  }
  out.Write(text + "\n");
  out.Commit();
}

void PrintTable(const std::vector<SessionFrame>& frames, const std::vector<std::string>& names,
                const PickedFrames& picked) {
  constexpr std::size_t kNamed = 3;  // markers
  const SessionFrame& neutral = frames[picked.frames.front().index];
  std::printf("%4s %8s %9s %10s  %s\n", "row", "frame", "time", "explained",
              "what moves most that those above do not explain: cm from the neutral");
  for (std::size_t row = 0; row < picked.frames.size(); ++row) {
    const PickedFrame& pick = picked.frames[row];
    const SessionFrame& frame = frames[pick.index];
    std::printf("%4zu %8llu %7.2f s %8.1f %%  ", row + 1,
                static_cast<unsigned long long>(frame.frame),
                static_cast<double>(frame.t_us) * 1e-6, 100 * pick.explained);
    for (std::size_t i = 0; i < std::min(kNamed, pick.moved.size()); ++i) {
      const std::size_t m = pick.moved[i];
      const Point3 by = frame.points_cm[m] - neutral.points_cm[m];
      std::printf("%s%s %+.1f %+.1f %+.1f", i == 0 ? "" : ", ", names[m].c_str(),
                  static_cast<double>(by.x), static_cast<double>(by.y), static_cast<double>(by.z));
    }
    std::printf("%s\n", pick.moved.empty() ? "the face at rest" : "");
  }
  std::printf(
      "%zu frames explain %.0f %% of the motion; furthest from them is frame %llu, by %.2f cm\n",
      picked.frames.size(), 100 * picked.frames.back().explained,
      static_cast<unsigned long long>(frames[picked.furthest].frame), picked.furthest_cm);
}

void Pick(const PickOptions& options) {
  CheckTargets(options);
  if (IsLive(options.session.face.input))
    throw app::BadInput(options.session.face.input +
                        ": pick looks at a whole recording; `facewire record` makes one");
  const auto session = OpenSession(options.session);
  std::vector<SessionFrame> frames;
  while (auto frame = session->Next()) frames.push_back(std::move(*frame));
  if (std::ranges::none_of(frames, IsComplete))
    throw app::BadInput(options.session.face.input +
                        ": there is no frame in which every marker is seen; --markers leaves some "
                        "out");
  const PickedFrames picked = PickFrames(frames, RulesOf(options, frames));
  SessionWriter writer(options.out);
  for (const PickedFrame& pick : picked.frames) writer.Write(frames[pick.index], session->names());
  writer.Commit();
  if (!options.template_file.empty()) WriteTemplate(options, frames, picked);
  PrintTable(frames, session->names(), picked);
}

}  // namespace

void AddPick(CLI::App& facewire) {
  auto options = std::make_shared<PickOptions>();
  CLI::App* command = facewire.add_subcommand(
      "pick", "Suggest the frames of a recording to train with: its most different ones");
  AddSessionOptions(*command, "TAKE", options->session);
  command
      ->add_option("--out", options->out, "The markers of the picked frames, for train --markers")
      ->required();
  command->add_option("--count", options->count, "Frames with the neutral; auto: as few as needed")
      ->capture_default_str();
  command
      ->add_option("--tolerance", options->tolerance,
                   "With auto: what may stay unexplained, as part of the greatest motion")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  command->add_option(
      "--neutral", options->neutral,
      "Number of the frame that is the face at rest; else the most typical still one");
  command->add_option("--targets", options->targets, "Names of the targets of a template")
      ->delimiter(',');
  command->add_option("--template", options->template_file,
                      "A CSV to fill in, a row a frame, for train --targets");
  command->callback([options] { Pick(*options); });
}

}  // namespace facewire::tools
