#include "tools/facewire/rig/import_bones.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/rig_file.h"
#include "core/base/capacity.h"
#include "core/retarget/alignment.h"
#include "tools/facewire/rig/canonical_mesh.h"

namespace facewire::tools::rig {
namespace {

// The longest name that "NAME.pitch" leaves room for.
constexpr std::size_t kLongestBone = kMaxNameLength - 6;

struct Found {
  std::size_t node = 0;
  BoneRole role;
  std::string why;
  std::optional<std::int16_t> landmark;  // of a bone that was found by position
};

class BonePlanner {
 public:
  BonePlanner(const Character& character, ImportPlan& plan) : in_(character), plan_(plan) {}

  void Plan(RigNames& names) {
    FindByName();
    if (plan_.cm_per_unit == 0) plan_.cm_per_unit = JudgeUnit();
    plan_.turned = FacesBack();
    Align();
    if (alignment_) FindByPosition();
    for (const Found& found : found_) Add(found, names);
    for (const std::size_t node : Bones())
      if (!Has(node)) plan_.other_bones.push_back(in_.nodes[node].name);
  }

 private:
  // What may be a bone: joints of skins, or, where nothing is skinned, every node: an animatronic
  // head's parts are stiff. Parents first.
  std::vector<std::size_t> Bones() const {
    const bool skinned = std::ranges::any_of(in_.nodes, &CharacterNode::joint);
    std::vector<std::size_t> bones;
    for (std::size_t i = 0; i < in_.nodes.size(); ++i)
      if (!skinned || in_.nodes[i].joint) bones.push_back(i);
    std::ranges::stable_sort(bones, {}, [&](std::size_t i) { return in_.nodes[i].depth; });
    return bones;
  }

  bool Has(std::size_t node) const {
    return std::ranges::find(found_, node, &Found::node) != found_.end();
  }
  const Found* Find(BoneKind kind, Side side = Side::kNone) const {
    const auto at = std::ranges::find_if(
        found_, [&](const Found& f) { return f.role.kind == kind && f.role.side == side; });
    return at == found_.end() ? nullptr : &*at;
  }
  // A part is there once, and so is a landmark: two bones that follow one would contradict each
  // other.
  bool IsTaken(const BoneRole& role) const {
    return std::ranges::any_of(found_, [&](const Found& f) {
      return f.role == role || (!role.landmark.empty() && f.role.landmark == role.landmark);
    });
  }

  void FindByName() {
    for (const auto& [bone, node] : in_.humanoid)
      if (const auto role = MatchHumanoid(bone))
        found_.push_back({node, *role, "VRM's " + bone, {}});
    for (const std::size_t node : Bones()) {
      const auto role = MatchBone(in_.nodes[node].name);
      if (role && !Has(node) && !IsTaken(*role)) found_.push_back({node, *role, "by name", {}});
    }
  }

  Point3 RawPlace(std::size_t node) const { return in_.nodes[node].position; }
  Point3 Place(std::size_t node) const {
    const float scale = static_cast<float>(plan_.cm_per_unit);
    const Point3 p = scale * RawPlace(node);
    return plan_.turned ? Point3{-p.x, p.y, -p.z} : p;
  }

  // glTF's unit is the metre, but files in centimetres are about. A face between that of a mouse
  // and that of an elephant tells them apart.
  double JudgeUnit() const {
    const Found* const left = Find(BoneKind::kEye, Side::kLeft);
    const Found* const right = Find(BoneKind::kEye, Side::kRight);
    double size = 0;    // in the file's unit
    double person = 0;  // the same of a person, cm
    if (left != nullptr && right != nullptr) {
      const Point3 between = RawPlace(left->node) - RawPlace(right->node);
      size = std::sqrt(static_cast<double>(Dot(between, between)));
      person = static_cast<double>(kCanonicalLeftEye.x - kCanonicalRightEye.x);
    } else if (const auto bones = Bones(); !bones.empty()) {
      const auto [low, high] =
          std::ranges::minmax(bones, {}, [&](std::size_t i) { return RawPlace(i).y; });
      size = static_cast<double>(RawPlace(high).y - RawPlace(low).y);
      person = 60;  // between a head and a whole body
    }
    double best = 100;
    if (!(size > 0)) return best;
    for (const double unit : {1.0, 0.1})
      if (std::abs(std::log(size * unit / person)) < std::abs(std::log(size * best / person)))
        best = unit;
    return best;
  }

  // The left is where x is greater, unless the character faces -z, as VRM 0 has it.
  bool FacesBack() const {
    float sides = 0;
    for (const Found& found : found_) {
      if (found.role.side == Side::kLeft) sides += RawPlace(found.node).x;
      if (found.role.side == Side::kRight) sides -= RawPlace(found.node).x;
    }
    return sides == 0 ? in_.convention == Convention::kVrm0 : sides < 0;
  }

  // The canonical face onto this one, by what is known by name.
  void Align() {
    if (Find(BoneKind::kEye, Side::kLeft) == nullptr ||
        Find(BoneKind::kEye, Side::kRight) == nullptr)
      return;
    std::vector<Point3> canonical, here;
    std::vector<std::int16_t> landmarks;
    for (const Found& found : found_) {
      std::optional<std::int16_t> landmark;
      Point3 place{};
      if (found.role.kind == BoneKind::kEye) {
        const bool left = found.role.side == Side::kLeft;
        landmark = left ? kLeftIris : kRightIris;
        place = left ? kCanonicalLeftEye : kCanonicalRightEye;
      } else if (found.role.kind == BoneKind::kSkin) {
        landmark = app::LandmarkByName(found.role.landmark);
        if (landmark) place = kCanonicalMesh[static_cast<std::size_t>(*landmark)];
      }
      if (!landmark) continue;
      landmarks.push_back(*landmark);
      canonical.push_back(place);
      here.push_back(Place(found.node));
    }
    const auto aligned = retarget::Align(canonical, here, landmarks);
    if (aligned && aligned->scale.x > 0 && aligned->scale.y > 0 && aligned->scale.z > 0)
      alignment_ = *aligned;
  }

  Point3 OnCanonical(Point3 p) const {
    const Point3 d = p - alignment_->target_mean;
    const Point3 s = alignment_->scale;
    return alignment_->source_mean + Point3{d.x / s.x, d.y / s.y, d.z / s.z};
  }

  bool IsBelowHead(std::size_t node) const {
    const Found* const head = Find(BoneKind::kHead);
    return head == nullptr || IsBelow(node, head->node);
  }

  bool IsBelow(std::size_t node, std::size_t ancestor) const {
    for (int at = in_.nodes[node].parent; at >= 0;
         at = in_.nodes[static_cast<std::size_t>(at)].parent)
      if (static_cast<std::size_t>(at) == ancestor) return true;
    return false;
  }

  std::vector<std::int16_t> TakenLandmarks() const {
    std::vector<std::int16_t> taken;
    for (const Found& found : found_) {
      if (found.landmark) taken.push_back(*found.landmark);
      if (const auto named = app::LandmarkByName(found.role.landmark)) taken.push_back(*named);
    }
    return taken;
  }

  void FindByPosition() {
    for (const std::size_t node : Bones()) {
      if (Has(node) || !IsBelowHead(node) || IsHelper(in_.nodes[node].name)) continue;
      const auto near = NearestLandmark(OnCanonical(Place(node)), TakenLandmarks());
      if (!near) continue;
      Found found{node, {}, {}, near->index};
      found.role.landmark = near->name;
      const double mm = 10 * static_cast<double>(near->distance_cm);
      found.why = "by position: " + std::to_string(std::lround(mm)) + " mm from landmark " +
                  std::to_string(near->index) + " of a face of this size";
      found_.push_back(found);
    }
  }

  // A lid whose bone is at the eye's centre turns around it, any other slides.
  bool Turns(const Found& found) const {
    if (found.role.kind != BoneKind::kUpperLid && found.role.kind != BoneKind::kLowerLid)
      return false;
    const Found* const eye = Find(BoneKind::kEye, found.role.side);
    if (eye == nullptr) return false;
    const Point3 away = Place(found.node) - Place(eye->node);
    constexpr double kTouching = 0.6;
    return std::sqrt(static_cast<double>(Dot(away, away))) < kTouching * Scale();
  }

  // Within what ranges can be written for: a face of a centimetre, or of ten metres.
  double Scale() const {
    return alignment_ ? std::clamp(static_cast<double>(alignment_->scale.y), 0.05, 50.0) : 1;
  }

  // The parameter that moves the same part of the face; empty: none.
  std::string ShapeFor(const BoneRole& role, std::string_view place) const {
    if (role.kind == BoneKind::kHead || role.kind == BoneKind::kNeck) return {};
    if (role.kind == BoneKind::kEye && in_.looks_by_bones) return {};
    const auto at = [&](std::string_view what) {
      return place.find(what) != std::string_view::npos;
    };
    const std::string_view prefix = role.kind == BoneKind::kEye   ? "eyeLook"
                                    : role.kind == BoneKind::kJaw ? "jawOpen"
                                    : at("brow")                  ? "brow"
                                    : at("_lid")                  ? "eyeBlink"
                                    : at("cheek")                 ? "cheek"
                                    : at("nos")                   ? "nose"
                                                                  : "mouth";
    for (const PlannedParameter& parameter : plan_.parameters)
      for (const auto& [signal, gain] : parameter.drives)
        if (signal.starts_with(prefix)) return parameter.name;
    return {};
  }

  void Add(const Found& found, RigNames& names) {
    const bool both = Find(BoneKind::kHead) != nullptr && Find(BoneKind::kNeck) != nullptr;
    const double share = !both ? 1 : found.role.kind == BoneKind::kHead ? 0.6 : 0.4;
    const std::string& original = in_.nodes[found.node].name;
    std::string place = found.role.landmark;
    if (place.empty() && found.landmark) place = NearestName(OnCanonical(Place(found.node)));
    PlannedBone bone;
    const bool turns = Turns(found);
    bone.axes = AxesOf(found.role, place, Scale(), turns, share);
    if (plan_.bones.size() == kMaxBones || channels_ + bone.axes.size() > Room()) {
      plan_.notes.push_back("bone " + Shown(original) + " was left out: the rig is full");
      return;
    }
    channels_ += bone.axes.size();
    bone.name = names.Take(original, "bone", kLongestBone);
    bone.original = original;
    bone.why = found.why;
    bone.rest_cm = Place(found.node);
    bone.role = found.role;
    if (bone.role.landmark.empty() && found.landmark)
      bone.role.landmark = std::to_string(*found.landmark);
    if (turns) bone.role.landmark.clear();  // it sits at the eye, not at the lid's edge
    if (const std::string shape = ShapeFor(found.role, place); !shape.empty()) {
      bone.done_by = "the shape " + shape;
    } else if (const Found* const jaw = Find(BoneKind::kJaw);
               jaw != nullptr && IsBelow(found.node, jaw->node)) {
      bone.done_by = "the bone " + Shown(in_.nodes[jaw->node].name);
    }
    plan_.bones.push_back(std::move(bone));
  }

  std::size_t Room() const { return kMaxChannels - plan_.parameters.size(); }

  const Character& in_;
  ImportPlan& plan_;
  std::vector<Found> found_;
  std::optional<retarget::Alignment> alignment_;
  std::size_t channels_ = 0;
};

}  // namespace

void PlanBones(const Character& character, RigNames& names, ImportPlan& plan) {
  BonePlanner(character, plan).Plan(names);
}

}  // namespace facewire::tools::rig
