#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "app/error.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/session.h"
#include "tools/facewire/session_writer.h"
#include "tools/facewire/stop_flag.h"

namespace facewire::tools {
namespace {

struct RecordOptions {
  SessionOptions session;
  std::string out;
  double seconds = 0;  // 0: to the end
};

void Record(const RecordOptions& options) {
  std::optional<StopFlag> stop;
  if (IsLive(options.session.face.input)) stop.emplace();
  const auto session = OpenSession(options.session);
  SessionWriter writer(options.out);
  std::size_t frames = 0;
  std::size_t rows = 0;
  while (!(stop && stop->Raised())) {
    const auto frame = session->Next();
    if (!frame) break;
    if (options.seconds > 0 && static_cast<double>(frame->t_us) >= options.seconds * 1e6) break;
    ++frames;
    if (frame->points_cm.empty()) continue;
    writer.Write(*frame, session->names());
    ++rows;
  }
  if (rows == 0)
    throw app::BadInput(options.session.face.input + ": nothing to record is seen in its " +
                        std::to_string(frames) + " frames");
  writer.Commit();
  std::fprintf(stderr, "facewire record: %zu frames, %zu rows of %zu markers\n", frames, rows,
               session->names().size());
  if (const std::string remark = session->Remark(); !remark.empty())
    std::fprintf(stderr, "facewire record: %s\n", remark.c_str());
}

}  // namespace

void AddRecord(CLI::App& facewire) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* command = facewire.add_subcommand(
      "record", "Record a session as markers without head motion: no pictures, only points");
  AddSessionOptions(*command, "INPUT", options->session);
  command
      ->add_option("--out", options->out,
                   "The .csv to write, which train and retarget read; or .jsonl")
      ->required();
  command
      ->add_option("--seconds", options->seconds,
                   "Stop after so many; else the recording's end, or Ctrl-C for a camera")
      ->check(CLI::PositiveNumber);
  command->callback([options] { Record(*options); });
}

}  // namespace facewire::tools
