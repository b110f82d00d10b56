#include "tools/facewire/settings.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "tools/facewire/region_file.h"

namespace facewire::tools {
namespace {

using retarget::Method;
using retarget::RegionConfig;

// Beyond this part of the spread, the other rows do not know what a row shows.
constexpr float kTrusted = 0.7F;
// Relative to phi(0) of the multiquadric.
constexpr std::array<float, 5> kSmoothings = {0, 0.01F, 0.1F, 0.5F, 2};
// Relative to the squared mean distance of two rows: a tail's ridge has the inputs' unit squared.
constexpr std::array<float, 5> kTailSmoothings = {1e-4F, 1e-2F, 0.1F, 1, 10};
constexpr std::array<float, 6> kRidges = {1e-6F, 1e-4F, 1e-3F, 1e-2F, 0.1F, 1};

// The training of one region alone, fitted again and again.
class Trial {
 public:
  Trial(const app::TrainingSet& training, const RegionConfig& config) : config_(config) {
    part_.markers = training.markers;
    part_.samples = training.samples;
    part_.neutral_sample = training.neutral_sample;
    part_.weights = training.weights;
    const std::size_t rows = training.view().sample_count();
    for (const std::uint16_t output : config.outputs)
      part_.signals.push_back(training.signals[output]);
    for (std::size_t row = 0; row < rows; ++row)
      for (const std::uint16_t output : config.outputs)
        part_.targets.push_back(training.targets[row * training.signals.size() + output]);
    for (std::size_t o = 0; o < config.outputs.size(); ++o)
      config_.outputs[o] = static_cast<std::uint16_t>(o);
    // Its targets are not in this part; what is ignored hardly changes which smoothing is best.
    config_.ignores.clear();
    part_.regions = {config_};
    errors_.resize(part_.targets.size());
  }

  // Rms leave-one-out error; infinite for what cannot be solved.
  float Error(const RegionConfig& settings) {
    RegionConfig& region = part_.regions[0];
    region.rbf = settings.rbf;
    region.nnls = settings.nnls;
    const retarget::Training view = part_.view();
    block_.resize(retarget::ExpressionMapping::RequiredBytes(view));
    workspace_.resize(retarget::ExpressionMapping::WorkspaceBytes(view));
    Arena arena(block_);
    retarget::TrainingReport report;
    if (!mapping_.Configure(view, arena, workspace_, report, errors_))
      return std::numeric_limits<float>::infinity();
    double sum = 0;
    for (const float error : errors_) sum += static_cast<double>(error) * error;
    return static_cast<float>(std::sqrt(sum / static_cast<double>(errors_.size())));
  }
  float epsilon() const { return mapping_.epsilon(0); }

  // Rms of the targets around their means.
  float Spread() const {
    const std::size_t columns = part_.signals.size();
    const std::size_t rows = part_.targets.size() / columns;
    double sum = 0;
    for (std::size_t c = 0; c < columns; ++c) {
      double mean = 0;
      for (std::size_t r = 0; r < rows; ++r) mean += part_.targets[r * columns + c];
      mean /= static_cast<double>(rows);
      for (std::size_t r = 0; r < rows; ++r)
        sum += std::pow(part_.targets[r * columns + c] - mean, 2);
    }
    return static_cast<float>(std::sqrt(sum / static_cast<double>(part_.targets.size())));
  }

 private:
  RegionConfig config_;
  app::TrainingSet part_;
  std::vector<float> errors_;
  std::vector<std::byte> block_, workspace_;
  retarget::ExpressionMapping mapping_;
};

// What a setting may be: the value that was given, or the candidates.
template <std::size_t N>
std::vector<float> Candidates(float given, const std::array<float, N>& automatic, float unit = 1) {
  if (given != kAutomatic) return {given};
  std::vector<float> out(automatic.begin(), automatic.end());
  for (float& value : out) value *= unit;
  return out;
}

Choice ChooseRidge(RegionConfig& region, Trial& trial) {
  Choice best{Choice::Reason::kLeaveOneOut, std::numeric_limits<float>::infinity(), trial.Spread()};
  RegionConfig tried = region;
  for (const float ridge : kRidges) {
    tried.nnls.ridge = ridge;
    const float error = trial.Error(tried);
    if (error >= best.error) continue;
    best.error = error;
    region.nnls = tried.nnls;
  }
  if (best.error <= kTrusted * best.spread) return best;
  best.reason = Choice::Reason::kRowsStandAlone;
  region.nnls.ridge = kRidges.front();
  return best;
}

Choice ChooseRbf(RegionConfig& region, Trial& trial) {
  const rbf::RbfConfig given = region.rbf;
  RegionConfig tried = region;
  tried.rbf.smoothing = 1;  // only to measure the mean distance: always solvable
  tried.rbf.tail_smoothing = 1;
  tried.rbf.epsilon = rbf::kMeanDistanceEpsilon;
  trial.Error(tried);
  const float mean_distance = 1 / trial.epsilon();
  const auto smoothings = Candidates(given.smoothing, kSmoothings);
  const auto tails =
      Candidates(given.tail_smoothing, kTailSmoothings, mean_distance * mean_distance);

  // Epsilon is searched when the rest is known: it matters less, and every look costs as much.
  tried.rbf.epsilon = given.epsilon == 0 ? rbf::kMeanDistanceEpsilon : given.epsilon;
  Choice best{Choice::Reason::kLeaveOneOut, std::numeric_limits<float>::infinity(), trial.Spread()};
  region.rbf = tried.rbf;
  region.rbf.smoothing = smoothings.front();
  region.rbf.tail_smoothing = tails.front();
  const rbf::RbfConfig plain = region.rbf;
  for (const float smoothing : smoothings) {
    for (const float tail : tails) {
      tried.rbf.smoothing = smoothing;
      tried.rbf.tail_smoothing = tail;
      const float error = trial.Error(tried);
      if (error >= best.error) continue;
      best.error = error;
      region.rbf = tried.rbf;
    }
  }
  if (given.epsilon == 0 && std::isfinite(best.error)) {
    tried.rbf = region.rbf;
    tried.rbf.epsilon = 0;
    best.error = std::min(best.error, trial.Error(tried));
    region.rbf.epsilon = trial.epsilon();
  }
  if (best.error <= kTrusted * best.spread) return best;
  best.reason = Choice::Reason::kRowsStandAlone;
  region.rbf = plain;
  return best;
}

std::string Number(float value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", static_cast<double>(value));
  return text.data();
}

}  // namespace

Choice ChooseSettings(app::TrainingSet& training, std::size_t index) {
  RegionConfig& region = training.regions[index];
  const bool is_rbf = region.method == Method::kRbf;
  if (is_rbf && region.rbf.tail != rbf::Tail::kLinear) region.rbf.tail_smoothing = 0;
  const bool automatic = is_rbf ? region.rbf.epsilon == 0 || region.rbf.smoothing == kAutomatic ||
                                      region.rbf.tail_smoothing == kAutomatic
                                : region.nnls.ridge == kAutomatic;
  Choice choice;
  if (automatic) {
    Trial trial(training, region);
    choice = is_rbf ? ChooseRbf(region, trial) : ChooseRidge(region, trial);
  }
  // What the method does not read is not left at a value that stands for a question.
  if (is_rbf) {
    region.nnls = {};
  } else {
    region.rbf = {};
  }
  return choice;
}

std::string Describe(const RegionConfig& region, const Choice& choice) {
  std::string text = "region " + std::string(region.name.view()) + ": " +
                     std::to_string(region.inputs()) + " inputs, ";
  if (region.axes > 0) text += std::to_string(region.axes) + " axes, ";
  text += std::to_string(region.outputs.size()) + " targets, ";
  if (region.method == Method::kNnls) {
    text += "non-negative least squares, smoothing " + Number(region.nnls.ridge);
  } else {
    text += "epsilon " + Number(region.rbf.epsilon) + " per unit, smoothing " +
            Number(region.rbf.smoothing);
    if (region.rbf.tail == rbf::Tail::kLinear)
      text += ", tail smoothing " + Number(region.rbf.tail_smoothing);
  }
  switch (choice.reason) {
    case Choice::Reason::kGiven:
      return text;
    case Choice::Reason::kLeaveOneOut:
      return text + "; chosen for the least leave-one-out error, " + Number(choice.error) +
             " where the targets vary by " + Number(choice.spread);
    case Choice::Reason::kRowsStandAlone:
      return text +
             "; chosen to meet every row, because rows that show what no other row shows say "
             "nothing about smoothing (leave-one-out error " +
             Number(choice.error) + ", the targets vary by " + Number(choice.spread) + ")";
  }
  return text;
}

}  // namespace facewire::tools
