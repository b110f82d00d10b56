#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "app/error.h"
#include "app/neutral_file.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/neutral_taker.h"
#include "tools/facewire/performance.h"

namespace facewire::tools {
namespace {

struct NeutralOptions {
  FaceOptions face;
  std::string frames;
  std::string out;
};

void Neutral(const NeutralOptions& options) {
  if (IsLive(options.face.input)) {
    throw app::BadInput(options.face.input +
                        ": a video is needed; a live performer is calibrated by facewired");
  }
  NeutralTaker taker("--frames", options.frames);
  const auto performance = OpenVideo(options.face);
  while (const auto moment = performance->Next()) {
    if (taker.Add(*moment)) break;
  }
  app::SaveNeutral(options.out, taker.Take());
}

}  // namespace

void AddNeutralOf(CLI::App& facewire) {
  auto options = std::make_shared<NeutralOptions>();
  CLI::App* command = facewire.add_subcommand(
      "neutral-of", "Take a performer's face at rest from a video, for facewired");
  command->add_option("INPUT", options->face.input, "A video file")->required();
  command->add_option("--frames", options->frames,
                      "A:B, the median of frames A to B-1; else of the first two seconds");
  command
      ->add_option("--out", options->out,
                   "The file to write; facewired reads performer.neutral in its [neutral] folder")
      ->required();
  AddFaceOptions(*command, options->face);
  command->callback([options] { Neutral(*options); });
}

}  // namespace facewire::tools
