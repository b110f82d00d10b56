#ifndef FACEWIRE_CORE_RETARGET_TRAINING_H_
#define FACEWIRE_CORE_RETARGET_TRAINING_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/capacity.h"
#include "core/base/inline_vector.h"
#include "core/base/name.h"
#include "core/nnls/nnls.h"
#include "core/rbf/rbf.h"

namespace facewire::retarget {

// How a region's function is found. The numbers are those of profile files: append only.
enum class Method : std::uint8_t {
  kRbf = 0,   // Umenhoffer and Toth 2012; with axes also Deng 2006 and Pyun 2003
  kNnls = 1,  // Choe 2001: non-negative least squares on blend-shape positions
};
inline constexpr std::uint8_t kMethodCount = 2;

// A part of the face with a function of its own: some markers in, some signals out. Regions keep
// apart what does not belong together (a blink moves no mouth) and let what matters weigh more.
struct RegionConfig {
  struct Gap {
    std::uint16_t upper = 0, lower = 0;  // indices of markers
  };
  ShortName name;
  Method method = Method::kRbf;
  rbf::RbfConfig rbf;     // of kRbf
  nnls::NnlsConfig nnls;  // of kNnls
  // > 0: distances are taken in that many principal axes of the inputs (see rbf::PrincipalAxes).
  std::uint16_t axes = 0;
  float gap_gain = 1;  // multiplies the gaps below: how much more they count
  // Part of each output's range, from its neutral on, that fades out (SoftRange); 0..0.25.
  float dead_zone = 0;
  // Indices of markers. The inputs are the coordinates of `points` minus the mean of `origin` (when
  // there are any), then how far the upper marker of each gap is above the lower one; all in cm. A
  // gap has a sign, unlike a distance: lips that press closer than in a neutral with parted lips
  // must not read as open.
  InlineVector<std::uint16_t, kMaxMarkers> points, origin;
  InlineVector<Gap, kMaxRegionGaps> gaps;
  InlineVector<std::uint16_t, kMaxSignals> outputs;  // indices of signals
  // Indices of signals of other regions that move these markers, too, or make the tracker think so:
  // the main direction in which the inputs go where only these signals differ from the neutral
  // sample is taken out of the inputs. Needs axes.
  InlineVector<std::uint16_t, kMaxSignals> ignores;

  constexpr std::size_t inputs() const noexcept { return 3 * points.size() + gaps.size(); }
  // Inputs of the function itself.
  constexpr std::size_t dimensions() const noexcept { return axes > 0 ? axes : inputs(); }
};

// Example pairs, borrowed.
struct Training {
  std::span<const ShortName>
      markers;  // "lm0".."lm477": landmarks; any other names: a marker file's
  std::span<const ShortName> signals;
  std::span<const float> samples;         // samples x 3 markers by rows: x y z, cm, head frame
  std::span<const float> targets;         // samples x signals by rows, in the signals' own units
  std::span<const RegionConfig> regions;  // every signal is the output of exactly one
  std::size_t neutral_sample = 0;         // the row that is the face at rest
  // The samples are an average face: other performers are taken there by a geometry mapping first.
  bool average_user = false;
  // How much each sample counts, > 0; empty: all the same. The smoothing of a sample is its
  // region's divided by this, so a weight of 2 is the sample twice, and a large one holds the
  // function there. Only Method::kRbf smooths.
  std::span<const float> weights = {};

  std::size_t sample_count() const noexcept {
    return markers.empty() ? 0 : samples.size() / (3 * markers.size());
  }
};

// Which region could not be fitted, and why: the report of its method.
struct TrainingReport {
  std::size_t region = 0;
  rbf::FitReport fit;
  nnls::NnlsReport nnls;
};

}  // namespace facewire::retarget

#endif  // FACEWIRE_CORE_RETARGET_TRAINING_H_
