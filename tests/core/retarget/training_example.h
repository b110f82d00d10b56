#ifndef FACEWIRE_TESTS_CORE_RETARGET_TRAINING_EXAMPLE_H_
#define FACEWIRE_TESTS_CORE_RETARGET_TRAINING_EXAMPLE_H_

#include <vector>

#include "core/retarget/expression_mapping.h"

namespace facewire::retarget {

// A little face of four landmarks: upper and lower lid (386, 374), upper and lower lip (13, 14), 1
// cm and 0.2 cm apart. "blink" closes the lids; "open" drops the lower lip by 3 cm.
struct TrainingExample {
  std::vector<ShortName> markers, signals;
  std::vector<float> samples, targets;
  std::vector<RegionConfig> regions;
  bool average_user = true;
  std::size_t neutral_sample = 0;
  std::vector<float> weights;

  static ShortName Named(std::string_view name) {
    return ShortName::From(name).value_or(ShortName{});
  }

  static std::vector<Point3> Points(float blink, float open) {
    return {{3, 3.5F - blink, 4}, {3, 2.5F, 4}, {0, -3, 5}, {0, -3.2F - 3 * open, 5}};
  }

  TrainingExample() {
    for (const char* name : {"lm386", "lm374", "lm13", "lm14"}) markers.push_back(Named(name));
    for (const char* name : {"blink", "open"}) signals.push_back(Named(name));
    for (const float blink : {0.0F, 0.5F, 1.0F})
      for (const float open : {0.0F, 0.5F, 1.0F}) Add(blink, open);
    RegionConfig eye;
    eye.name = Named("eye");
    eye.rbf = {
        .tail = rbf::Tail::kLinear, .epsilon = 0.5F, .smoothing = 0.01F, .tail_smoothing = 0.01F};
    RegionConfig mouth = eye;
    mouth.name = Named("mouth");
    Fill(eye.points, {0, 1});
    Fill(eye.origin, {1});
    Fill(eye.outputs, {0});
    Fill(mouth.points, {2, 3});
    Fill(mouth.outputs, {1});
    if (!mouth.gaps.try_push({2, 3})) regions.clear();
    regions = {eye, mouth};
  }

  void Add(float blink, float open) {
    for (const Point3 p : Points(blink, open)) samples.insert(samples.end(), {p.x, p.y, p.z});
    targets.insert(targets.end(), {blink, open});
  }

  template <std::size_t N>
  static void Fill(InlineVector<std::uint16_t, N>& out, std::initializer_list<std::uint16_t> in) {
    out.clear();
    for (const std::uint16_t i : in) static_cast<void>(out.try_push(i));
  }

  Training view() const {
    return {markers, signals, samples, targets, regions, neutral_sample, average_user, weights};
  }
};

// The example's mapping with its memory.
struct ExampleMapping {
  std::vector<std::byte> block, workspace;
  ExpressionMapping mapping;
  TrainingReport report;

  Result<> Configure(const TrainingExample& example, std::span<float> leave_one_out = {}) {
    block.resize(ExpressionMapping::RequiredBytes(example.view()));
    workspace.resize(ExpressionMapping::WorkspaceBytes(example.view()));
    Arena arena(block);
    return mapping.Configure(example.view(), arena, workspace, report, leave_one_out);
  }
  std::vector<float> At(const std::vector<Point3>& points) const {
    std::vector<float> signals(mapping.signals().size());
    mapping.Evaluate(points, signals);
    return signals;
  }
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_TESTS_CORE_RETARGET_TRAINING_EXAMPLE_H_
