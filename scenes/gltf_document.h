#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace remomask::scenes {

/// The numbers of an accessor: `count` elements of `width` components.
struct GltfNumbers {
  size_t count = 0, width = 0;
  std::vector<float> values;
  const float* at(size_t element) const { return values.data() + element * width; }
};

/// The JSON and the buffers of a glTF file that nobody vouches for: every index, size and number
/// is checked where it is read. Images are never opened. Files beside it are read for `buffers`
/// alone, by a relative name inside of its folder. All errors are FileErrors that say which member
/// of the JSON is wrong.
class GltfDocument {
 public:
  /// .glb, .vrm and .vrma (binary) or .gltf (JSON), told apart by their first bytes.
  explicit GltfDocument(const std::string& path);

  const std::string& path() const { return path_; }
  nlohmann::json& json() { return json_; }
  const nlohmann::json& json() const { return json_; }
  /// The binary chunk of a .glb; empty in a .gltf.
  const std::string& binary() const { return binary_; }
  bool is_binary() const { return is_binary_; }

  /// An array at the top of the file; empty where it is absent.
  const nlohmann::json& list(const char* name) const;
  /// Element `index` of such an array, an object.
  const nlohmann::json& element(const char* list_name, size_t index) const;
  /// An index into the list `list_name`, stored as `owner`'s member; -1 where it is absent.
  int index(const nlohmann::json& owner, const char* member, const char* list_name) const;
  /// `count` finite numbers, or `fallback` where the member is absent.
  std::vector<double> numbers(const nlohmann::json& owner, const char* member, size_t count,
                              std::vector<double> fallback) const;
  std::string text(const nlohmann::json& owner, const char* member) const;

  /// The elements of an accessor, normalised integers as the numbers that they stand for, sparse
  /// ones filled in.
  GltfNumbers accessor(int accessor_index) const;

  [[noreturn]] void fail(const std::string& message) const;

 private:
  void load_binary(std::string_view content);
  void parse(std::string_view text);
  void load_buffers();
  std::string buffer_from(const std::string& uri, size_t number) const;
  size_t size_member(const nlohmann::json& owner, const char* member, size_t fallback) const;
  std::string_view view(int view_index, size_t& stride) const;
  void read_elements(int view_index, size_t offset, size_t count, size_t width, int component,
                     bool normalized, float* out) const;
  void fill_sparse(const nlohmann::json& accessor, GltfNumbers& result, int component,
                   bool normalized) const;

  std::string path_;
  nlohmann::json json_;
  std::string binary_;
  std::vector<std::string> buffers_;
  bool is_binary_ = false;
};

}  // namespace remomask::scenes
