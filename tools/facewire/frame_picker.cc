#include "tools/facewire/frame_picker.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/markers/head_motion.h"

namespace facewire::tools {
namespace {

constexpr std::int64_t kSpeedWindowUs = 50'000;   // to either side
constexpr std::int64_t kStillWindowUs = 100'000;  // to either side
// So many frames tell what is typical as well as all of a long recording.
constexpr std::size_t kTypicalFrames = 1500;

// The complete frames as rows of coordinates, and how far each is from blends of those picked.
class Recording {
 public:
  explicit Recording(const std::vector<SessionFrame>& frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (!IsComplete(frames[i])) continue;
      index_.push_back(i);
      t_us_.push_back(frames[i].t_us);
      for (const Point3 p : frames[i].points_cm) values_.insert(values_.end(), {p.x, p.y, p.z});
    }
    width_ = values_.size() / std::max<std::size_t>(1, index_.size());
  }

  std::size_t rows() const { return index_.size(); }
  std::size_t index(std::size_t row) const { return index_[row]; }
  double Rms(double squares) const {
    return std::sqrt(std::max(0.0, squares) / (static_cast<double>(width_) / 3));
  }
  double Distance(std::size_t a, std::size_t b) const {
    double squares = 0;
    for (std::size_t c = 0; c < width_; ++c) {
      const double difference = static_cast<double>(At(a, c) - At(b, c));
      squares += difference * difference;
    }
    return Rms(squares);
  }

  // cm per second over the frames around a row; 0 where a row stands alone in time.
  std::vector<double> Speeds() const {
    std::vector<double> speeds;
    for (std::size_t row = 0; row < rows(); ++row) {
      const auto [first, last] = Around(row, kSpeedWindowUs);
      const auto span_us = static_cast<double>(t_us_[last] - t_us_[first]);
      speeds.push_back(span_us > 0 ? Distance(first, last) * 1e6 / span_us : 0);
    }
    return speeds;
  }

  // The first and the last row within `reach_us` of a row's time.
  std::pair<std::size_t, std::size_t> Around(std::size_t row, std::int64_t reach_us) const {
    const auto from = std::ranges::lower_bound(t_us_, t_us_[row] - reach_us);
    const auto to = std::ranges::upper_bound(t_us_, t_us_[row] + reach_us);
    return {static_cast<std::size_t>(from - t_us_.begin()),
            static_cast<std::size_t>(to - t_us_.begin()) - 1};
  }

  // All motion is counted from this row on.
  void SetNeutral(std::size_t neutral) {
    for (std::size_t row = 0; row < rows(); ++row) {
      if (row == neutral) continue;
      for (std::size_t c = 0; c < width_; ++c) values_[row * width_ + c] -= At(neutral, c);
    }
    std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(neutral * width_), width_, 0.0F);
    left_.resize(rows());
    for (std::size_t row = 0; row < rows(); ++row) left_[row] = Dot(row, row);
    motion_ = std::reduce(left_.begin(), left_.end());
  }

  // Lets blends use this row's motion too.
  void Pick(std::size_t picked) {
    picked_.push_back(picked);
    const std::size_t count = picked_.size();
    std::vector<double> gram(count * count);
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b) gram[a * count + b] = Dot(picked_[a], picked_[b]);
    weights_.resize(rows());
    products_.resize(rows());
    for (std::size_t row = 0; row < rows(); ++row) {
      weights_[row].push_back(0);
      products_[row].push_back(Dot(row, picked));
      left_[row] = Blend(gram, products_[row], Dot(row, row), weights_[row]);
    }
  }

  double Left(std::size_t row) const { return Rms(left_[row]); }
  double Explained() const {
    return motion_ > 0 ? 1 - std::reduce(left_.begin(), left_.end()) / motion_ : 1;
  }

  // Markers by how much of their motion in this row is left.
  std::vector<std::size_t> Moved(std::size_t row) const {
    std::vector<double> left(width_ / 3);
    for (std::size_t c = 0; c < width_; ++c) {
      double difference = static_cast<double>(At(row, c));
      for (std::size_t p = 0; p < picked_.size(); ++p)
        difference -= weights_[row][p] * static_cast<double>(At(picked_[p], c));
      left[c / 3] += difference * difference;
    }
    std::vector<std::size_t> order(left.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return left[a] > left[b]; });
    return order;
  }

 private:
  float At(std::size_t row, std::size_t column) const { return values_[row * width_ + column]; }
  double Dot(std::size_t a, std::size_t b) const {
    double sum = 0;
    for (std::size_t c = 0; c < width_; ++c)
      sum += static_cast<double>(At(a, c)) * static_cast<double>(At(b, c));
    return sum;
  }

  // Least squares with weights of 0 to 1, by coordinate descent from the weights given; the squared
  // distance that is left.
  static double Blend(const std::vector<double>& gram, const std::vector<double>& product,
                      double own, std::vector<double>& weights) {
    constexpr int kSweeps = 200;
    constexpr double kSettled = 1e-6;
    const std::size_t count = weights.size();
    const auto pull = [&](std::size_t a) {
      double sum = 0;
      for (std::size_t b = 0; b < count; ++b) sum += gram[a * count + b] * weights[b];
      return sum;
    };
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double change = 0;
      for (std::size_t a = 0; a < count; ++a) {
        const double size = gram[a * count + a];
        if (size <= 0) continue;
        const double weight = std::clamp(weights[a] + (product[a] - pull(a)) / size, 0.0, 1.0);
        change = std::max(change, std::abs(weight - weights[a]));
        weights[a] = weight;
      }
      if (change < kSettled) break;
    }
    double left = own;
    for (std::size_t a = 0; a < count; ++a) left += weights[a] * (pull(a) - 2 * product[a]);
    return std::max(0.0, left);
  }

  std::vector<std::size_t> index_;
  std::vector<std::int64_t> t_us_;
  std::vector<float> values_;  // rows x width; after SetNeutral motion from the neutral
  std::size_t width_ = 0;
  std::vector<std::size_t> picked_;
  std::vector<std::vector<double>> weights_, products_;  // of each row with those picked
  std::vector<double> left_;                             // squared distances
  double motion_ = 0;  // sum of squared distances from the neutral
};

std::size_t FindNeutral(const Recording& recording, const std::vector<double>& speeds) {
  std::vector<double> sorted = speeds;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
  std::ranges::nth_element(sorted, middle);
  std::vector<std::size_t> still;
  for (std::size_t row = 0; row < speeds.size(); ++row)
    if (speeds[row] <= *middle) still.push_back(row);
  const std::size_t every_still = 1 + still.size() / kTypicalFrames;
  const std::size_t every = 1 + speeds.size() / kTypicalFrames;
  std::size_t best = still.front();
  double least = -1;
  for (std::size_t i = 0; i < still.size(); i += every_still) {
    double sum = 0;
    for (std::size_t row = 0; row < speeds.size(); row += every)
      sum += recording.Distance(still[i], row);
    if (least >= 0 && sum >= least) continue;
    least = sum;
    best = still[i];
  }
  return best;
}

std::vector<std::size_t> StillMoments(const Recording& recording,
                                      const std::vector<double>& speeds) {
  std::vector<std::size_t> moments;
  for (std::size_t row = 0; row < speeds.size(); ++row) {
    const auto [first, last] = recording.Around(row, kStillWindowUs);
    const auto around = speeds.begin();
    if (speeds[row] <= *std::min_element(around + static_cast<std::ptrdiff_t>(first),
                                         around + static_cast<std::ptrdiff_t>(last) + 1))
      moments.push_back(row);
  }
  return moments;
}

std::size_t Furthest(const Recording& recording, const std::vector<std::size_t>& rows) {
  return *std::ranges::max_element(rows, {}, [&](std::size_t row) { return recording.Left(row); });
}

}  // namespace

bool IsComplete(const SessionFrame& frame) {
  return !frame.points_cm.empty() && std::ranges::all_of(frame.points_cm, markers::Seen);
}

PickedFrames PickFrames(const std::vector<SessionFrame>& frames, const PickRules& rules) {
  Recording recording(frames);
  std::vector<std::size_t> all(recording.rows());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<double> speeds = recording.Speeds();
  const std::vector<std::size_t> moments = StillMoments(recording, speeds);
  const std::size_t neutral =
      rules.neutral ? *std::ranges::find(all, *rules.neutral,
                                         [&](std::size_t row) { return recording.index(row); })
                    : FindNeutral(recording, speeds);
  recording.SetNeutral(neutral);
  PickedFrames picked;
  picked.frames.push_back({recording.index(neutral), recording.Explained(), {}});
  const double enough_cm = rules.tolerance * recording.Left(Furthest(recording, moments));
  while (picked.frames.size() < rules.most) {
    const std::size_t next = Furthest(recording, moments);
    if (recording.Left(next) <= enough_cm) break;
    const std::vector<std::size_t> moved = recording.Moved(next);
    recording.Pick(next);
    picked.frames.push_back({recording.index(next), recording.Explained(), moved});
  }
  const std::size_t furthest = Furthest(recording, all);
  picked.furthest = recording.index(furthest);
  picked.furthest_cm = recording.Left(furthest);
  return picked;
}

}  // namespace facewire::tools
