#pragma once

#include <tiny_gltf.h>

#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace remomask::scenes {

/// Collects the arrays of a glTF file in one buffer, with an accessor and a view for each.
class GltfBuilder {
 public:
  explicit GltfBuilder(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

  /// An accessor for `elements`, every one of `N` components of type T. `bounds` states the least
  /// and greatest value, as glTF asks for of positions and times.
  template <typename T, size_t N>
  int add(const std::vector<std::array<T, N>>& elements, int type, int target = 0,
          bool bounds = false) {
    tinygltf::Accessor accessor;
    accessor.bufferView =
        add_view(elements.data(), elements.size() * sizeof(std::array<T, N>), target);
    accessor.byteOffset = 0;
    accessor.normalized = false;
    accessor.componentType = component_type(T{});
    accessor.count = elements.size();
    accessor.type = type;
    accessor.sparse.isSparse = false;
    for (size_t i = 0; bounds && i < N; ++i) {
      T least = elements[0][i], greatest = elements[0][i];
      for (const std::array<T, N>& element : elements) {
        least = std::min(least, element[i]);
        greatest = std::max(greatest, element[i]);
      }
      accessor.minValues.push_back(least);
      accessor.maxValues.push_back(greatest);
    }
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

 private:
  static int component_type(float) { return TINYGLTF_COMPONENT_TYPE_FLOAT; }
  static int component_type(uint8_t) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE; }
  static int component_type(uint16_t) { return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT; }

  int add_view(const void* bytes, size_t length, int target);

  tinygltf::Model& model_;
};

/// Any JSON as tinygltf holds `extras`.
tinygltf::Value gltf_value(const nlohmann::json& json);

/// The file's bytes. Throws Error if the library refuses the model.
std::string gltf_bytes(const tinygltf::Model& model);

}  // namespace remomask::scenes
