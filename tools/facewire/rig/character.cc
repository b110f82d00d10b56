#include "tools/facewire/rig/character.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "app/error.h"

namespace facewire::tools::rig {
namespace {

using nlohmann::json;

// Column by column, as glTF has them.
using Matrix4 = std::array<double, 16>;
constexpr Matrix4 kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix4 Product(const Matrix4& a, const Matrix4& b) {
  Matrix4 c{};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t i = 0; i < 4; ++i) c[4 * column + row] += a[4 * i + row] * b[4 * column + i];
  return c;
}

class Reader {
 public:
  Reader(const json& gltf, const std::string& source) : gltf_(gltf), source_(source) {}

  Character Read() {
    ReadNodes();
    ReadSkins();
    ReadShapes();
    const json& extensions = Member(gltf_, "extensions");
    if (const json& vrm = Member(extensions, "VRMC_vrm"); vrm.is_object()) {
      ReadVrm1(vrm);
    } else if (const json& older = Member(extensions, "VRM"); older.is_object()) {
      ReadVrm0(older);
    }
    return std::move(out_);
  }

 private:
  [[noreturn]] void Bad(const std::string& where, const std::string& what) const {
    throw app::BadInput(source_ + ": " + where + ": " + what);
  }

  static const json& Member(const json& object, const char* key) {
    static const json kNone;
    if (!object.is_object()) return kNone;
    const auto at = object.find(key);
    return at == object.end() ? kNone : *at;
  }
  static std::string TextOf(const json& value) {
    return value.is_string() ? value.get<std::string>() : std::string();
  }
  // The members of an array, none for anything else.
  static const json& ListOf(const json& value) {
    static const json kEmpty = json::array();
    return value.is_array() ? value : kEmpty;
  }
  static std::string Place(const char* list, std::size_t index) {
    return std::string(list) + "[" + std::to_string(index) + "]";
  }

  std::size_t IndexOf(const json& value, std::size_t count, const std::string& where,
                      const char* what) const {
    if (!value.is_number_integer())
      Bad(where, std::string("a number of ") + what + " belongs here");
    const auto index = value.get<std::int64_t>();
    if (index < 0 || static_cast<std::uint64_t>(index) >= count)
      Bad(where, "there is no " + std::string(what) + " " + std::to_string(index) + " of " +
                     std::to_string(count));
    return static_cast<std::size_t>(index);
  }

  template <std::size_t kCount>
  std::array<double, kCount> NumbersOf(const json& value, std::array<double, kCount> otherwise,
                                       const std::string& where) const {
    if (value.is_null()) return otherwise;
    if (!value.is_array() || value.size() != kCount)
      Bad(where, std::to_string(kCount) + " numbers belong here");
    for (std::size_t i = 0; i < kCount; ++i) {
      if (!value[i].is_number()) Bad(where, std::to_string(kCount) + " numbers belong here");
      otherwise[i] = value[i].get<double>();
    }
    return otherwise;
  }

  Matrix4 LocalOf(const json& node, const std::string& where) const {
    if (const json& matrix = Member(node, "matrix"); !matrix.is_null())
      return NumbersOf<16>(matrix, kIdentity, where + ".matrix");
    const auto t = NumbersOf<3>(Member(node, "translation"), {0, 0, 0}, where + ".translation");
    const auto q = NumbersOf<4>(Member(node, "rotation"), {0, 0, 0, 1}, where + ".rotation");
    const auto s = NumbersOf<3>(Member(node, "scale"), {1, 1, 1}, where + ".scale");
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    return {s[0] * (1 - 2 * (y * y + z * z)),
            s[0] * 2 * (x * y + z * w),
            s[0] * 2 * (x * z - y * w),
            0,
            s[1] * 2 * (x * y - z * w),
            s[1] * (1 - 2 * (x * x + z * z)),
            s[1] * 2 * (y * z + x * w),
            0,
            s[2] * 2 * (x * z + y * w),
            s[2] * 2 * (y * z - x * w),
            s[2] * (1 - 2 * (x * x + y * y)),
            0,
            t[0],
            t[1],
            t[2],
            1};
  }

  void ReadNodes() {
    const json& nodes = ListOf(Member(gltf_, "nodes"));
    out_.nodes.resize(nodes.size());
    std::vector<std::vector<std::size_t>> children(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      out_.nodes[i].name = TextOf(Member(nodes[i], "name"));
      for (const json& child : ListOf(Member(nodes[i], "children"))) {
        const std::string where = Place("nodes", i) + ".children";
        const std::size_t index = IndexOf(child, nodes.size(), where, "node");
        if (out_.nodes[index].parent >= 0 || index == i)
          Bad(where, "node " + std::to_string(index) + " hangs below two nodes");
        out_.nodes[index].parent = static_cast<int>(i);
        children[i].push_back(index);
      }
    }
    // From the roots downwards; what is never reached goes round in a circle.
    std::vector<Matrix4> places(nodes.size(), kIdentity);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (out_.nodes[i].parent < 0) order.push_back(i);
    for (std::size_t at = 0; at < order.size(); ++at) {
      const std::size_t i = order[at];
      PlaceNode(nodes[i], i, places);
      for (const std::size_t child : children[i]) order.push_back(child);
    }
    if (order.size() < nodes.size()) Bad("nodes", "some of them are their own ancestors");
  }

  void PlaceNode(const json& node, std::size_t i, std::vector<Matrix4>& places) {
    constexpr double kFarthest = 1e6;
    CharacterNode& out = out_.nodes[i];
    places[i] = LocalOf(node, Place("nodes", i));
    if (out.parent >= 0) {
      const auto parent = static_cast<std::size_t>(out.parent);
      places[i] = Product(places[parent], places[i]);
      out.depth = out_.nodes[parent].depth + 1;
    }
    for (std::size_t axis = 12; axis < 15; ++axis)
      if (!(std::abs(places[i][axis]) < kFarthest))
        Bad(Place("nodes", i), "is nowhere: its place is no number, or too far away");
    out.position = {static_cast<float>(places[i][12]), static_cast<float>(places[i][13]),
                    static_cast<float>(places[i][14])};
  }

  void ReadSkins() {
    const json& skins = ListOf(Member(gltf_, "skins"));
    for (std::size_t i = 0; i < skins.size(); ++i)
      for (const json& joint : ListOf(Member(skins[i], "joints")))
        out_.nodes[IndexOf(joint, out_.nodes.size(), Place("skins", i) + ".joints", "node")].joint =
            true;
  }

  // A morph target's positions are offsets, and their bounds are in the file: vertices need not be
  // read to know that all are nought. Without bounds it is taken to move.
  bool Moves(const json& target) const {
    const json& accessors = ListOf(Member(gltf_, "accessors"));
    const json& position = Member(target, "POSITION");
    if (position.is_null()) return false;
    const json& accessor =
        accessors[IndexOf(position, accessors.size(), "a morph target", "accessor")];
    for (const char* const bound : {"min", "max"}) {
      const json& values = Member(accessor, bound);
      if (!values.is_array()) return true;
      for (const json& value : values)
        if (!value.is_number() || value.get<double>() != 0) return true;
    }
    return false;
  }

  std::size_t ShapeNamed(const std::string& name) {
    const auto [at, fresh] = shape_of_.try_emplace(name, out_.shapes.size());
    if (fresh) out_.shapes.push_back({name, false});
    return at->second;
  }

  void ReadShapes() {
    const json& meshes = ListOf(Member(gltf_, "meshes"));
    targets_.resize(meshes.size());
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      // Names are no part of glTF itself; most exporters put them here, older VRM ones there.
      json names = ListOf(Member(Member(meshes[m], "extras"), "targetNames"));
      const std::string mesh = TextOf(Member(meshes[m], "name"));
      for (const json& primitive : ListOf(Member(meshes[m], "primitives"))) {
        if (names.empty()) names = ListOf(Member(Member(primitive, "extras"), "targetNames"));
        const json& targets = ListOf(Member(primitive, "targets"));
        for (std::size_t t = 0; t < targets.size(); ++t) {
          if (t == targets_[m].size()) {
            std::string name = t < names.size() ? TextOf(names[t]) : std::string();
            if (name.empty()) name = mesh + "_target" + std::to_string(t);
            targets_[m].push_back(ShapeNamed(name));
          }
          if (Moves(targets[t])) out_.shapes[targets_[m][t]].moves = true;
        }
      }
    }
  }

  void AddBind(CharacterExpression& expression, std::size_t mesh, const json& bind,
               double full_weight, const std::string& where) {
    const std::size_t target =
        IndexOf(Member(bind, "index"), targets_[mesh].size(), where, "morph target");
    const json& weight = Member(bind, "weight");
    const double value =
        std::clamp(weight.is_number() ? weight.get<double>() / full_weight : 1, 0.0, 1.0);
    const std::size_t shape = targets_[mesh][target];
    for (const auto& other : expression.binds)
      if (other.shape == shape) return;  // of the same name in another mesh
    if (value > 0) expression.binds.push_back({shape, value});
  }

  std::size_t NodeOf(const json& value, const std::string& where) const {
    return IndexOf(value, out_.nodes.size(), where, "node");
  }

  void ReadVrm0(const json& vrm) {
    out_.convention = Convention::kVrm0;
    out_.name = TextOf(Member(Member(vrm, "meta"), "title"));
    for (const json& bone : ListOf(Member(Member(vrm, "humanoid"), "humanBones"))) {
      const std::string name = TextOf(Member(bone, "bone"));
      if (!name.empty()) out_.humanoid[name] = NodeOf(Member(bone, "node"), "VRM.humanoid." + name);
    }
    LookBy(TextOf(Member(Member(vrm, "firstPerson"), "lookAtTypeName")));
    for (const json& group : ListOf(Member(Member(vrm, "blendShapeMaster"), "blendShapeGroups"))) {
      CharacterExpression expression;
      expression.name = TextOf(Member(group, "presetName"));
      if (expression.name.empty() || expression.name == "unknown")
        expression.name = TextOf(Member(group, "name"));
      const std::string where = "VRM.blendShapeMaster." + expression.name;
      for (const json& bind : ListOf(Member(group, "binds"))) {
        const std::size_t mesh = IndexOf(Member(bind, "mesh"), targets_.size(), where, "mesh");
        AddBind(expression, mesh, bind, 100, where);
      }
      out_.expressions.push_back(std::move(expression));
    }
  }

  void ReadVrm1(const json& vrm) {
    out_.convention = Convention::kVrm1;
    out_.name = TextOf(Member(Member(vrm, "meta"), "name"));
    const json& bones = Member(Member(vrm, "humanoid"), "humanBones");
    if (bones.is_object())
      for (const auto& bone : bones.items())
        out_.humanoid[bone.key()] =
            NodeOf(Member(bone.value(), "node"), "VRMC_vrm.humanoid." + bone.key());
    LookBy(TextOf(Member(Member(vrm, "lookAt"), "type")));
    for (const char* const kind : {"preset", "custom"}) {
      const json& expressions = Member(Member(vrm, "expressions"), kind);
      if (!expressions.is_object()) continue;
      for (const auto& entry : expressions.items()) {
        CharacterExpression expression{entry.key(), {}};
        const std::string where = "VRMC_vrm.expressions." + expression.name;
        for (const json& bind : ListOf(Member(entry.value(), "morphTargetBinds")))
          AddBind(expression, MeshOfNode(Member(bind, "node"), where), bind, 1, where);
        out_.expressions.push_back(std::move(expression));
      }
    }
  }

  std::size_t MeshOfNode(const json& node, const std::string& where) const {
    const std::size_t index = NodeOf(node, where);
    return IndexOf(Member(Member(gltf_, "nodes")[index], "mesh"), targets_.size(), where, "mesh");
  }

  void LookBy(const std::string& type) {
    out_.looks_by_bones = type == "bone" || type == "Bone";
    out_.looks_by_shapes = type == "expression" || type == "BlendShape";
  }

  const json& gltf_;
  const std::string& source_;
  Character out_;
  std::map<std::string, std::size_t> shape_of_;
  std::vector<std::vector<std::size_t>> targets_;  // shape by mesh and target
};

}  // namespace

Character ReadCharacter(const json& gltf, const std::string& source) {
  return Reader(gltf, source).Read();
}

}  // namespace facewire::tools::rig
