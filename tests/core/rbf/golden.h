#ifndef FACEWIRE_TESTS_CORE_RBF_GOLDEN_H_
#define FACEWIRE_TESTS_CORE_RBF_GOLDEN_H_

#include <array>

#include "core/rbf/kernel.h"

// Written by tools/generate/rbf_golden.py (NumPy).
// clang-format off
namespace facewire::rbf::golden {

inline constexpr std::array<float, 18> kSamples = {0.02364325F, 0.9009274F, -0.7116808F, 0.8972989F, -0.3763371F, -0.1533471F, 0.6554052F, -0.1816017F, 0.09918737F, -0.9448818F, 0.5070262F, 0.07628663F, -0.3405366F, 0.5768574F, -0.3936103F, -0.09300422F, -0.7319166F, -0.193774F};
inline constexpr std::array<float, 18> kTargets = {0.9481962F, 0.02130085F, -0.09185229F, -0.6385903F, -0.8369401F, 0.0577102F, 0.7847918F, -0.1190227F, -0.7478056F, -0.09372035F, 0.9252668F, 0.03867932F, -0.05276971F, -0.196441F, -0.8013985F, 0.03660742F, -1.188059F, 0.1418264F};
inline constexpr std::array<float, 4> kAt = {0.1F, -0.2F, 1.5F, 1.0F};

struct Case {
  Kernel kernel;
  Tail tail;
  float epsilon, smoothing, tail_smoothing;
  std::array<float, 4> values;         // two outputs at each place of kAt
  std::array<float, 2> leave_one_out;  // of sample 3, by leaving it out
};
inline constexpr std::array<Case, 30> kCases = {{
    {Kernel::kMultiquadric, Tail::kNone, 0.8F, 0.0F, 0.0F,
     {-0.1585116F, -0.01733039F, 2.916002F, 0.173338F}, {-0.1188747F, -0.05601824F}},
    {Kernel::kMultiquadric, Tail::kNone, 0.8F, 0.05F, 0.0F,
     {-0.1014965F, 0.03702054F, 2.295549F, -0.1336121F}, {0.05100495F, -0.1310865F}},
    {Kernel::kMultiquadric, Tail::kConstant, 0.8F, 0.0F, 0.0F,
     {-0.1551455F, -0.01906905F, 2.773827F, 0.2467755F}, {-0.1154515F, -0.05750531F}},
    {Kernel::kMultiquadric, Tail::kConstant, 0.8F, 0.05F, 0.0F,
     {-0.09524157F, 0.02270892F, 2.231691F, 0.01249755F}, {0.05552816F, -0.1413221F}},
    {Kernel::kMultiquadric, Tail::kLinear, 0.8F, 0.0F, 0.0F,
     {-0.1761966F, -0.02099172F, 3.513669F, 0.2282072F}, {-0.1849808F, -0.06368098F}},
    {Kernel::kMultiquadric, Tail::kLinear, 0.8F, 0.05F, 0.1F,
     {-0.09820539F, 0.01859925F, 3.312922F, 0.0451707F}, {-0.08339181F, -0.1596571F}},
    {Kernel::kInverseMultiquadric, Tail::kNone, 0.8F, 0.0F, 0.0F,
     {-0.09039226F, -0.01349232F, 1.276347F, 0.07284171F}, {0.01394029F, -0.08404276F}},
    {Kernel::kInverseMultiquadric, Tail::kNone, 0.8F, 0.05F, 0.0F,
     {-0.07881859F, 0.009144072F, 1.00898F, 0.02139938F}, {0.1554763F, -0.1206314F}},
    {Kernel::kInverseMultiquadric, Tail::kConstant, 0.8F, 0.0F, 0.0F,
     {-0.09168295F, -0.01163102F, 1.310964F, 0.0229198F}, {0.01223462F, -0.08181035F}},
    {Kernel::kInverseMultiquadric, Tail::kConstant, 0.8F, 0.05F, 0.0F,
     {-0.07903225F, 0.01446542F, 1.011274F, -0.03571731F}, {0.1563388F, -0.1143539F}},
    {Kernel::kInverseMultiquadric, Tail::kLinear, 0.8F, 0.0F, 0.0F,
     {-0.1637916F, -0.01943652F, 3.256576F, -0.002593957F}, {-0.1587028F, -0.1035176F}},
    {Kernel::kInverseMultiquadric, Tail::kLinear, 0.8F, 0.05F, 0.1F,
     {-0.1073757F, 0.002130916F, 3.204464F, 0.04024097F}, {-0.09287923F, -0.1549062F}},
    {Kernel::kGaussian, Tail::kNone, 0.8F, 0.0F, 0.0F,
     {-0.07280607F, -0.02682846F, 0.9703746F, 0.1078006F}, {0.0234057F, -0.05021906F}},
    {Kernel::kGaussian, Tail::kNone, 0.8F, 0.05F, 0.0F,
     {-0.08758638F, 0.00528183F, 0.6910315F, 0.1133915F}, {0.1019783F, -0.08469312F}},
    {Kernel::kGaussian, Tail::kConstant, 0.8F, 0.0F, 0.0F,
     {-0.07767228F, -0.02331303F, 1.103672F, 0.0115045F}, {0.02014352F, -0.04792425F}},
    {Kernel::kGaussian, Tail::kConstant, 0.8F, 0.05F, 0.0F,
     {-0.08989541F, 0.01562626F, 0.7150145F, 0.005948001F}, {0.1010354F, -0.07476679F}},
    {Kernel::kGaussian, Tail::kLinear, 0.8F, 0.0F, 0.0F,
     {-0.176906F, -0.02802757F, 3.332218F, -0.1029961F}, {-0.18965F, -0.06381647F}},
    {Kernel::kGaussian, Tail::kLinear, 0.8F, 0.05F, 0.1F,
     {-0.1297162F, -0.006245879F, 3.124597F, 0.09923563F}, {-0.1178511F, -0.1118845F}},
    {Kernel::kLinear, Tail::kNone, 0.8F, 0.0F, 0.0F,
     {-0.05305587F, 0.0163541F, 1.293249F, -0.2462637F}, {0.1560027F, -0.1205012F}},
    {Kernel::kLinear, Tail::kNone, 0.8F, 0.05F, 0.0F,
     {-0.05506953F, 0.01474072F, 1.242265F, -0.2537146F}, {0.195181F, -0.1190722F}},
    {Kernel::kLinear, Tail::kConstant, 0.8F, 0.0F, 0.0F,
     {-0.05389223F, 0.0004021536F, 1.303231F, -0.05587906F}, {0.1516145F, -0.1402321F}},
    {Kernel::kLinear, Tail::kConstant, 0.8F, 0.05F, 0.0F,
     {-0.05624749F, -0.0008144269F, 1.256725F, -0.06277636F}, {0.1890794F, -0.1409571F}},
    {Kernel::kLinear, Tail::kLinear, 0.8F, 0.0F, 0.0F,
     {-0.08387525F, -0.004373797F, 3.236265F, -0.0008416139F}, {-0.09022271F, -0.1809018F}},
    {Kernel::kLinear, Tail::kLinear, 0.8F, 0.05F, 0.1F,
     {-0.0784468F, -0.003847596F, 3.049363F, -0.01512844F}, {-0.055201F, -0.1822738F}},
    {Kernel::kCubic, Tail::kNone, 0.8F, 0.0F, 0.0F,
     {-0.2546855F, 0.001526126F, 8.132432F, -0.3029079F}, {-0.4433163F, -0.07209309F}},
    {Kernel::kCubic, Tail::kNone, 0.8F, 0.05F, 0.0F,
     {-0.3508004F, 0.04091181F, 10.52544F, -0.8709983F}, {-0.5146449F, -0.08959627F}},
    {Kernel::kCubic, Tail::kConstant, 0.8F, 0.0F, 0.0F,
     {-0.1967132F, -0.01814064F, 5.663637F, 0.5346156F}, {-0.3791156F, -0.08551582F}},
    {Kernel::kCubic, Tail::kConstant, 0.8F, 0.05F, 0.0F,
     {-0.1873032F, -0.01366211F, 6.352066F, 0.5220384F}, {-0.3959001F, -0.1164384F}},
    {Kernel::kCubic, Tail::kLinear, 0.8F, 0.0F, 0.0F,
     {-0.1609204F, -0.01195727F, 3.738411F, 0.5079416F}, {-0.1747115F, -0.06351548F}},
    {Kernel::kCubic, Tail::kLinear, 0.8F, 0.05F, 0.1F,
     {-0.1366474F, 0.002437869F, 3.152779F, 0.3861452F}, {-0.1085574F, -0.08084487F}},
}};

}  // namespace facewire::rbf::golden
// clang-format on

#endif  // FACEWIRE_TESTS_CORE_RBF_GOLDEN_H_
