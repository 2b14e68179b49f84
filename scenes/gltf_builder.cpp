#include "scenes/gltf_builder.h"

#include <sstream>

#include "remomask/error.h"

namespace remomask::scenes {

int GltfBuilder::add_view(const void* bytes, size_t length, int target) {
  constexpr size_t kAlignment = 4;
  std::vector<unsigned char>& data = model_.buffers[0].data;
  data.resize((data.size() + kAlignment - 1) / kAlignment * kAlignment);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = data.size();
  view.byteLength = length;
  view.target = target;
  const auto* first = static_cast<const unsigned char*>(bytes);
  data.insert(data.end(), first, first + length);
  model_.bufferViews.push_back(view);
  return static_cast<int>(model_.bufferViews.size()) - 1;
}

tinygltf::Value gltf_value(const nlohmann::json& json) {
  if (json.is_object()) {
    tinygltf::Value::Object members;
    for (const auto& [key, value] : json.items()) members.emplace(key, gltf_value(value));
    return tinygltf::Value(std::move(members));
  }
  if (json.is_array()) {
    tinygltf::Value::Array elements;
    for (const nlohmann::json& element : json) elements.push_back(gltf_value(element));
    return tinygltf::Value(std::move(elements));
  }
  if (json.is_boolean()) return tinygltf::Value(json.get<bool>());
  if (json.is_string()) return tinygltf::Value(json.get<std::string>());
  if (json.is_number_integer()) {
    const auto number = json.get<int64_t>();
    if (number == static_cast<int>(number)) return tinygltf::Value(static_cast<int>(number));
  }
  if (json.is_number()) return tinygltf::Value(json.get<double>());
  return {};
}

std::string gltf_bytes(const tinygltf::Model& model) {
  std::ostringstream stream;
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, stream, false, true)) {
    throw Error("the glTF library refused to write the motion; please report this");
  }
  return stream.str();
}

}  // namespace remomask::scenes
