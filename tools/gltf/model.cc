#include "tools/gltf/model.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string_view>

#include "tools/gltf/face_mesh.h"

namespace facewire::tools {
namespace {

using tinygltf::Value;

void AppendMetres(Point3 cm, std::vector<float>& out) {
  for (const float v : {cm.x, cm.y, cm.z}) out.push_back(kMetresPerCm * v);
}

void AppendUnit(Point3 normal, std::vector<float>& out) {
  for (const float v : {normal.x, normal.y, normal.z}) out.push_back(v);
}

std::vector<double> Metres(Point3 cm) {
  std::vector<float> values;
  AppendMetres(cm, values);
  return {values.begin(), values.end()};
}

int AddNode(tinygltf::Model& model, std::string name, Point3 at_cm = {}) {
  tinygltf::Node node;
  node.name = std::move(name);
  if (at_cm != Point3{}) node.translation = Metres(at_cm);
  model.nodes.push_back(std::move(node));
  return static_cast<int>(model.nodes.size()) - 1;
}

int AddMaterial(tinygltf::Model& model, const char* name, const std::array<double, 3>& colour) {
  tinygltf::Material material;
  material.name = name;
  material.pbrMetallicRoughness.baseColorFactor = {colour[0], colour[1], colour[2], 1};
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 0.7;
  material.doubleSided = true;  // a mask is seen from behind, too
  model.materials.push_back(std::move(material));
  return static_cast<int>(model.materials.size()) - 1;
}

// In the order of FaceMaterial; linear colours.
struct MaterialLook {
  const char* name;
  std::array<double, 3> colour;
};
constexpr std::array<MaterialLook, kFaceMaterials> kLooks{{{"skin", {0.62, 0.55, 0.48}},
                                                           {"brow", {0.10, 0.07, 0.05}},
                                                           {"lip", {0.55, 0.22, 0.20}},
                                                           {"eye", {0.90, 0.90, 0.90}},
                                                           {"iris", {0.03, 0.16, 0.20}},
                                                           {"mouth", {0.05, 0.01, 0.02}}}};
constexpr std::array kHandleColour{0.05, 0.17, 0.46};

std::string NameOf(const Channel& channel) { return std::string(channel.name.view()); }

bool IsWeight(const Channel& parameter) { return parameter.min >= -1 && parameter.max <= 1; }

// What an importer should know of the parameters: the names of the morph targets, the agreed place
// for which is mesh.extras.targetNames, and which weights stand for another range than their own.
Value ParameterExtras(const Rig& rig, const std::vector<std::size_t>& parameters) {
  Value::Array names;
  Value::Object scaled;
  for (const std::size_t p : parameters) {
    const Channel& channel = rig.channels[p];
    names.emplace_back(NameOf(channel));
    if (IsWeight(channel)) continue;
    scaled.emplace(NameOf(channel), Value(Value::Array{Value(static_cast<double>(channel.min)),
                                                       Value(static_cast<double>(channel.max))}));
  }
  Value::Object extras{{"targetNames", Value(std::move(names))}};
  if (!scaled.empty()) extras.emplace("facewireRanges", Value(std::move(scaled)));
  return Value(std::move(extras));
}

tinygltf::Primitive FacePrimitive(const FacePart& part, const std::vector<std::string>& shapes,
                                  BufferWriter& buffer) {
  std::vector<float> positions;
  std::vector<float> normals;
  for (const FacePoint& point : part.points) {
    AppendMetres(point.rest_cm, positions);
    AppendUnit(point.normal, normals);
  }
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] =
      buffer.Add(positions, TINYGLTF_TYPE_VEC3, true, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.attributes["NORMAL"] =
      buffer.Add(normals, TINYGLTF_TYPE_VEC3, false, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.indices = buffer.Add(part.triangles);
  // Most shapes leave most parts alone: these share one array.
  std::map<std::vector<float>, int> known;
  for (const std::string& shape : shapes) {
    std::vector<float> moves;
    for (const FacePoint& point : part.points) AppendMetres(Displacement(point, shape), moves);
    const auto [at, is_new] = known.try_emplace(std::move(moves), -1);
    if (is_new) {
      at->second = buffer.Add(at->first, TINYGLTF_TYPE_VEC3, true, TINYGLTF_TARGET_ARRAY_BUFFER);
    }
    primitive.targets.push_back({{"POSITION", at->second}});
  }
  return primitive;
}

int AddFace(const Rig& rig, BufferWriter& buffer, tinygltf::Model& model) {
  const std::vector<std::size_t> parameters = ParametersOf(rig);
  if (parameters.empty()) return -1;
  tinygltf::Mesh mesh;
  mesh.name = "face";
  mesh.extras = ParameterExtras(rig, parameters);
  std::vector<std::string> shapes;
  for (const std::size_t p : parameters) {
    shapes.push_back(NameOf(rig.channels[p]));
    mesh.weights.push_back(
        static_cast<double>(MorphWeight(rig.channels[p], rig.channels[p].neutral)));
  }
  for (const FacePart& part : MakeFaceMesh()) {
    const MaterialLook& look = kLooks[static_cast<std::size_t>(part.material)];
    mesh.primitives.push_back(FacePrimitive(part, shapes, buffer));
    mesh.primitives.back().material = AddMaterial(model, look.name, look.colour);
  }
  model.meshes.push_back(std::move(mesh));
  const int node = AddNode(model, "face");
  model.nodes[static_cast<std::size_t>(node)].mesh = static_cast<int>(model.meshes.size()) - 1;
  return node;
}

// A bone that the head's own signals drive, a neck, carries out the head's motion on the character:
// below the head's node it would turn twice.
bool CarriesHead(const Rig& rig, std::size_t bone) {
  return std::ranges::any_of(rig.channels, [&](const Channel& channel) {
    return channel.bone == static_cast<std::int16_t>(bone) &&
           std::ranges::any_of(channel.drives, [](const Drive& drive) {
             return drive.signal.view().starts_with("head.");
           });
  });
}

// A bone is a small pointer out of the face, which shows where it is and how it is turned.
void AddHandles(const Rig& rig, const ModelNodes& nodes, BufferWriter& buffer,
                tinygltf::Model& model) {
  constexpr float kWide = 0.3F;
  constexpr float kLong = 1.6F;
  constexpr std::array<Point3, 6> kCorners{{{0, 0, kLong},
                                            {kWide, 0, 0},
                                            {0, kWide, 0},
                                            {-kWide, 0, 0},
                                            {0, -kWide, 0},
                                            {0, 0, -kWide}}};
  constexpr std::array<std::uint16_t, 24> kTriangles{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1,
                                                     5, 2, 1, 5, 3, 2, 5, 4, 3, 5, 1, 4};
  std::vector<float> positions, weights, inverse_binds;
  std::vector<std::uint16_t> triangles;
  std::vector<std::uint8_t> joints;
  const auto bind = [&](Point3 at_cm) {
    inverse_binds.insert(inverse_binds.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    AppendMetres(-1.0F * at_cm, inverse_binds);
    inverse_binds.push_back(1);
  };
  bind({});
  for (std::size_t bone = 0; bone < rig.bones.size(); ++bone) {
    bind(rig.bones[bone].rest_cm);
    const auto first = static_cast<std::uint16_t>(positions.size() / 3);
    for (const Point3 corner : kCorners) {
      AppendMetres(rig.bones[bone].rest_cm + corner, positions);
      joints.insert(joints.end(), {static_cast<std::uint8_t>(bone + 1), 0, 0, 0});
      weights.insert(weights.end(), {1, 0, 0, 0});
    }
    for (const std::uint16_t t : kTriangles)
      triangles.push_back(static_cast<std::uint16_t>(first + t));
  }

  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = AddMaterial(model, "bone", kHandleColour);
  primitive.attributes["POSITION"] =
      buffer.Add(positions, TINYGLTF_TYPE_VEC3, true, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.attributes["JOINTS_0"] = buffer.Add(joints);
  primitive.attributes["WEIGHTS_0"] =
      buffer.Add(weights, TINYGLTF_TYPE_VEC4, false, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.indices = buffer.Add(triangles);
  tinygltf::Mesh mesh;
  mesh.name = "bones";
  mesh.primitives.push_back(std::move(primitive));
  model.meshes.push_back(std::move(mesh));

  tinygltf::Skin skin;
  skin.name = "bones";
  skin.inverseBindMatrices = buffer.Add(inverse_binds, TINYGLTF_TYPE_MAT4);
  skin.joints.push_back(nodes.head);
  skin.joints.insert(skin.joints.end(), nodes.bones.begin(), nodes.bones.end());
  model.skins.push_back(std::move(skin));

  // A skinned mesh goes where its joints go: its own node belongs at the top.
  const int node = AddNode(model, "bones");
  model.nodes[static_cast<std::size_t>(node)].mesh = static_cast<int>(model.meshes.size()) - 1;
  model.nodes[static_cast<std::size_t>(node)].skin = 0;
  model.scenes[0].nodes.push_back(node);
}

}  // namespace

BufferWriter::BufferWriter(tinygltf::Model& model) : model_(model) { model_.buffers.resize(1); }

int BufferWriter::Append(std::span<const std::byte> bytes, std::size_t count, int type,
                         int component, int target) {
  std::vector<unsigned char>& data = model_.buffers[0].data;
  data.resize((data.size() + 3) / 4 * 4);  // an accessor starts at a multiple of its component
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();
  view.byteLength = bytes.size();
  view.target = target;
  data.resize(data.size() + bytes.size());
  std::memcpy(data.data() + view.byteOffset, bytes.data(), bytes.size());
  model_.bufferViews.push_back(std::move(view));
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = count;
  model_.accessors.push_back(std::move(accessor));
  return static_cast<int>(model_.accessors.size()) - 1;
}

int BufferWriter::Add(std::span<const float> values, int type, bool bounds, int target) {
  const auto width = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(type));
  const int index = Append(std::as_bytes(values), values.size() / width, type,
                           TINYGLTF_COMPONENT_TYPE_FLOAT, target);
  tinygltf::Accessor& accessor = model_.accessors.back();
  for (std::size_t c = 0; bounds && c < width; ++c) {
    const auto [least, greatest] = [&] {
      std::pair<float, float> range{values[c], values[c]};
      for (std::size_t i = c; i < values.size(); i += width)
        range = {std::min(range.first, values[i]), std::max(range.second, values[i])};
      return range;
    }();
    accessor.minValues.push_back(static_cast<double>(least));
    accessor.maxValues.push_back(static_cast<double>(greatest));
  }
  return index;
}

int BufferWriter::Add(std::span<const std::uint16_t> indices) {
  return Append(std::as_bytes(indices), indices.size(), TINYGLTF_TYPE_SCALAR,
                TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
}

int BufferWriter::Add(std::span<const std::uint8_t> joints) {
  return Append(std::as_bytes(joints), joints.size() / 4, TINYGLTF_TYPE_VEC4,
                TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TARGET_ARRAY_BUFFER);
}

ModelNodes AddCharacter(const Rig& rig, BufferWriter& buffer, tinygltf::Model& model) {
  model.asset.version = "2.0";
  model.asset.generator = "facewire";
  model.scenes.resize(1);
  model.defaultScene = 0;

  const int root = AddNode(model, std::string(rig.name.view()));
  model.scenes[0].nodes.push_back(root);
  ModelNodes nodes;
  nodes.head = AddNode(model, "head");
  std::vector<int> below_root{nodes.head};
  std::vector<int> below_head;
  for (std::size_t bone = 0; bone < rig.bones.size(); ++bone) {
    nodes.bones.push_back(
        AddNode(model, std::string(rig.bones[bone].name.view()), rig.bones[bone].rest_cm));
    (CarriesHead(rig, bone) ? below_root : below_head).push_back(nodes.bones.back());
  }
  if (nodes.face = AddFace(rig, buffer, model); nodes.face >= 0) below_head.push_back(nodes.face);
  model.nodes[static_cast<std::size_t>(root)].children = std::move(below_root);
  model.nodes[static_cast<std::size_t>(nodes.head)].children = std::move(below_head);
  if (!rig.bones.empty()) AddHandles(rig, nodes, buffer, model);
  return nodes;
}

std::vector<std::size_t> ParametersOf(const Rig& rig) {
  std::vector<std::size_t> parameters;
  for (std::size_t i = 0; i < rig.channels.size(); ++i)
    if (rig.channels[i].kind == ChannelKind::kParameter) parameters.push_back(i);
  return parameters;
}

float MorphWeight(const Channel& parameter, float value) {
  if (IsWeight(parameter)) return value;
  const float range = parameter.max - parameter.min;
  return range > 0 ? (value - parameter.min) / range : 0;
}

}  // namespace facewire::tools
