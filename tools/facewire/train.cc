#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/error.h"
#include "app/profile_file.h"
#include "tools/facewire/commands.h"
#include "tools/facewire/region_file.h"
#include "tools/facewire/settings.h"
#include "tools/facewire/training_files.h"

namespace facewire::tools {
namespace {

struct TrainOptions {
  std::string markers, targets, weights, out, regions;
  std::string method = "rbf";
  std::string kernel = "multiquadric";
  std::string epsilon = "auto";
  std::string smoothing = "auto";
  std::string tail = "linear";
  std::string tail_smoothing = "auto";
  std::uint16_t axes = 0;
  std::size_t neutral_row = 1;
  bool average_user = false;
};

// "auto", or a number from 0 up.
float ParseSetting(const char* option, const std::string& text) {
  if (text == "auto") return kAutomatic;
  float value = 0;
  const char* end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || parsed != end || !std::isfinite(value) || value < 0)
    throw app::BadInput(std::string(option) + ": \"" + text +
                        "\" is neither auto nor a number from 0 up");
  return value;
}

retarget::RegionConfig ToDefaults(const TrainOptions& options) {
  retarget::RegionConfig region;
  region.method = ParseMethod(options.method, "--method: ");
  region.axes = options.axes;
  region.rbf.kernel = ParseKernel(options.kernel, "--kernel: ");
  region.rbf.tail = ParseTail(options.tail, "--tail: ");
  region.rbf.epsilon = ParseEpsilon(options.epsilon, "--epsilon: ");
  region.rbf.smoothing = ParseSetting("--smoothing", options.smoothing);
  region.nnls.ridge = region.rbf.smoothing;
  region.rbf.tail_smoothing = ParseSetting("--tail-smoothing", options.tail_smoothing);
  return region;
}

// One number a row of `markers`, in the only column of the file.
std::vector<float> ReadWeights(const std::string& path, const std::string& markers,
                               std::size_t rows) {
  TrainingTable table = ReadTargets(path);
  if (table.names.size() != 1 || table.names[0].view() != "weight")
    throw app::BadInput(path + ":1: expected one column, weight");
  if (table.rows != rows)
    throw app::BadInput(path + ": " + std::to_string(table.rows) + " rows, but " + markers +
                        " has " + std::to_string(rows) + "; each row has a weight");
  for (std::size_t row = 0; row < rows; ++row)
    if (!(table.values[row] > 0))
      throw app::BadInput(path + ": row " + std::to_string(row + 1) +
                          ": a weight has to be a number above 0");
  return std::move(table.values);
}

app::TrainingSet ReadPairs(const TrainOptions& options) {
  TrainingTable markers = ReadSamples(options.markers);
  TrainingTable targets = ReadTargets(options.targets);
  if (markers.rows != targets.rows)
    throw app::BadInput(options.targets + ": " + std::to_string(targets.rows) + " rows, but " +
                        options.markers + " has " + std::to_string(markers.rows) +
                        "; each row is one sample in both files");
  if (options.neutral_row < 1 || options.neutral_row > markers.rows)
    throw app::BadInput("--neutral: " + std::to_string(options.neutral_row) + " is not a row of " +
                        options.markers + "; it has rows 1 to " + std::to_string(markers.rows));
  app::TrainingSet training;
  training.signals = std::move(targets.names);
  training.markers = std::move(markers.names);
  training.samples = std::move(markers.values);
  training.targets = std::move(targets.values);
  training.neutral_sample = options.neutral_row - 1;
  training.average_user = options.average_user;
  if (!options.weights.empty())
    training.weights = ReadWeights(options.weights, options.markers, markers.rows);
  return training;
}

void PrintTable(const app::TrainingSet& training, const std::vector<float>& leave_one_out) {
  std::size_t width = 6;
  for (const ShortName& signal : training.signals) width = std::max(width, signal.view().size());
  const int columns = static_cast<int>(width);
  std::printf("leave-one-out error: what the other rows predict for a row, against its target\n");
  std::printf("%-*s %10s %10s %8s\n", columns, "target", "rms", "worst", "in row");
  const std::size_t signals = training.signals.size();
  for (std::size_t o = 0; o < signals; ++o) {
    double sum = 0;
    std::size_t worst = 0;
    const std::size_t rows = leave_one_out.size() / signals;
    for (std::size_t s = 0; s < rows; ++s) {
      const float error = leave_one_out[s * signals + o];
      sum += static_cast<double>(error) * error;
      if (std::abs(error) > std::abs(leave_one_out[worst * signals + o])) worst = s;
    }
    const std::string name(training.signals[o].view());
    std::printf("%-*s %10.4f %10.4f %8zu\n", columns, name.c_str(),
                std::sqrt(sum / static_cast<double>(rows)),
                static_cast<double>(std::abs(leave_one_out[worst * signals + o])), worst + 1);
  }
}

void Train(const TrainOptions& options) {
  const retarget::RegionConfig defaults = ToDefaults(options);
  app::TrainingSet training = ReadPairs(options);
  training.regions = options.regions.empty() ? std::vector{WholeFace(training, defaults)}
                                             : ReadRegions(options.regions, training, defaults);
  DropUnusedMarkers(training);
  std::vector<Choice> choices;
  // What does not pass is refused by Profile below, in words.
  if (retarget::ExpressionMapping::Check(training.view())) {
    for (std::size_t r = 0; r < training.regions.size(); ++r)
      choices.push_back(ChooseSettings(training, r));
  }
  std::vector<float> leave_one_out(training.targets.size());
  const app::Profile profile(training, options.markers, leave_one_out);
  // What was chosen here is written down, so that loading does not search again.
  for (std::size_t r = 0; r < training.regions.size(); ++r)
    if (training.regions[r].method == retarget::Method::kRbf)
      training.regions[r].rbf.epsilon = profile.mapping().epsilon(r);
  app::SaveProfile(options.out, training);

  for (std::size_t r = 0; r < training.regions.size(); ++r)
    std::printf("%s\n", Describe(training.regions[r], choices[r]).c_str());
  PrintTable(training, leave_one_out);
  std::printf("%s: %zu rows, %zu markers, %zu targets; %zu kB in memory\n", options.out.c_str(),
              training.view().sample_count(), training.markers.size(), training.signals.size(),
              (profile.bytes() + 1023) / 1024);
}

}  // namespace

void AddTrain(CLI::App& facewire) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* train =
      facewire.add_subcommand("train", "Make a profile: a mapping from example pairs");
  train->add_option("--markers", options->markers, "CSV with columns NAME_x,NAME_y,NAME_z (cm)")
      ->required();
  train->add_option("--targets", options->targets, "CSV with any named numbers, row by row")
      ->required();
  train->add_option("--out", options->out, "The profile to write")->required();
  train->add_option(
      "--method", options->method,
      "rbf: radial basis functions (Umenhoffer 2012); nnls: non-negative least squares "
      "on blend-shape positions (Choe 2001)");
  train->add_option("--axes", options->axes,
                    "Take the inputs in so many principal axes (PCA; Pyun 2003, Deng 2006); 0: as "
                    "they are");
  train->add_option("--kernel", options->kernel,
                    "multiquadric (the paper's), inverse-multiquadric, gaussian, linear, cubic or "
                    "thin-plate");
  train->add_option("--epsilon", options->epsilon,
                    "Shape of the kernel per cm; auto: least leave-one-out error; mean: 1 / mean "
                    "distance of the rows");
  train->add_option("--smoothing", options->smoothing,
                    "0: through every sample; or auto: least leave-one-out error");
  train->add_option("--tail", options->tail, "none, constant or linear");
  train->add_option("--tail-smoothing", options->tail_smoothing,
                    "The same for a linear tail; auto or a number");
  train->add_option("--neutral", options->neutral_row, "Row that is the face at rest, from 1");
  train->add_option("--weights", options->weights,
                    "CSV with one column, weight: how much each row counts (default 1)");
  train->add_flag("--average-user", options->average_user,
                  "The rows are an average face: take performers there by their neutral first");
  train->add_option("--regions", options->regions, "TOML file that divides the face");
  train->callback([options] { Train(*options); });
}

}  // namespace facewire::tools
