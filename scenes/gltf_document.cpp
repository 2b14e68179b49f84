#include "scenes/gltf_document.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "base/file.h"
#include "remomask/error.h"
#include "scenes/uri.h"

namespace remomask::scenes {

namespace {

constexpr uint64_t kLargestGltf = 1ull << 30;
constexpr int kDeepestJson = 64;
constexpr size_t kMaxNumbers = 200'000'000;  // of an accessor

uint32_t little_u32(std::string_view bytes, size_t at) {
  uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Size of a component of an accessor; 0 for an unknown type.
size_t component_size(int component) {
  switch (component) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

float component_at(const char* bytes, int component, bool normalized) {
  const auto read = [&]<typename T>(T value) {
    std::memcpy(&value, bytes, sizeof value);
    return value;
  };
  switch (component) {
    case 5120: {
      const float value = read(int8_t{});
      return normalized ? std::max(value / 127, -1.F) : value;
    }
    case 5121: {
      const float value = read(uint8_t{});
      return normalized ? value / 255 : value;
    }
    case 5122: {
      const float value = read(int16_t{});
      return normalized ? std::max(value / 32767, -1.F) : value;
    }
    case 5123: {
      const float value = read(uint16_t{});
      return normalized ? value / 65535 : value;
    }
    case 5125:
      return static_cast<float>(read(uint32_t{}));
    default:
      return read(0.F);
  }
}

size_t width_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  if (type == "MAT4") return 16;
  return 0;
}

}  // namespace

GltfDocument::GltfDocument(const std::string& path) : path_(path) {
  std::error_code failed;
  const uint64_t size = std::filesystem::file_size(path, failed);
  if (!failed && size > kLargestGltf) {
    fail("is larger than 1 GiB; export the skeleton and its animation without textures");
  }
  std::string content = read_file(path);
  constexpr std::string_view kMagic = "glTF";
  is_binary_ = content.starts_with(kMagic);
  if (is_binary_) {
    load_binary(content);
  } else {
    parse(content);
  }
  load_buffers();
}

void GltfDocument::fail(const std::string& message) const { throw FileError(path_, 0, message); }

void GltfDocument::load_binary(std::string_view content) {
  constexpr size_t kHeader = 12, kChunkHeader = 8;
  constexpr uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
  if (content.size() < kHeader + kChunkHeader) fail("is cut off: a binary glTF has a header");
  const uint32_t version = little_u32(content, 4), length = little_u32(content, 8);
  if (version != 2) {
    fail(fmt::format("is glTF {}; only version 2 is read: export it as glTF 2.0", version));
  }
  if (length > content.size()) {
    fail(fmt::format("is cut off: {} of {} bytes are there", content.size(), length));
  }
  const std::string_view all = content.substr(0, length);
  std::string_view text;
  for (size_t at = kHeader; at + kChunkHeader <= all.size();) {
    const size_t size = little_u32(all, at);
    const uint32_t kind = little_u32(all, at + 4);
    at += kChunkHeader;
    if (size > all.size() - at) fail("is damaged: a chunk is longer than the file");
    if (kind == kJsonChunk && text.empty()) text = all.substr(at, size);
    if (kind == kBinaryChunk && binary_.empty()) binary_ = all.substr(at, size);
    at += size;
  }
  if (text.empty()) fail("is damaged: it has no JSON chunk");
  parse(text);
}

void GltfDocument::parse(std::string_view text) {
  try {
    // A callback bounds the depth: what is nested deeper would overflow the stack when it is
    // copied or written.
    json_ = nlohmann::json::parse(
        text, [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
          if (depth > kDeepestJson) fail("is nested deeper than any glTF file");
          return true;
        });
  } catch (const nlohmann::json::exception& error) {
    fail(std::string("is not a glTF file: ") + error.what());
  }
  if (!json_.is_object() || !json_.contains("asset") || !json_["asset"].is_object()) {
    fail("is not a glTF file: it has no member \"asset\"");
  }
  const std::string version = this->text(json_["asset"], "version");
  if (!version.starts_with("2.")) {
    fail(fmt::format("is glTF {}; only version 2 is read: export it as glTF 2.0",
                     version.empty() ? "of no version" : version));
  }
}

void GltfDocument::load_buffers() {
  const size_t count = list("buffers").size();
  size_t total = 0;
  for (size_t i = 0; i < count; ++i) {
    const nlohmann::json& buffer = element("buffers", i);
    const size_t length = size_member(buffer, "byteLength", 0);
    const std::string uri = text(buffer, "uri");
    std::string bytes = uri.empty() && i == 0 ? binary_ : buffer_from(uri, i);
    if (bytes.size() < length) {
      fail(fmt::format("buffers[{}] says {} bytes and has {}", i, length, bytes.size()));
    }
    total += bytes.size();
    if (total > kLargestGltf) fail("has buffers of more than 1 GiB");
    bytes.resize(length);
    buffers_.push_back(std::move(bytes));
  }
}

std::string GltfDocument::buffer_from(const std::string& uri, size_t number) const {
  if (uri.empty()) fail(fmt::format("buffers[{}] has neither a uri nor a binary chunk", number));
  if (uri.starts_with("data:")) {
    std::string bytes;
    if (!decode_data_uri(uri, bytes)) {
      fail(fmt::format("buffers[{}].uri is no base64 data", number));
    }
    return bytes;
  }
  const std::string file = decode_percent(uri);
  if (!is_name_inside_folder(file)) {
    fail(
        fmt::format("buffers[{}].uri \"{}\" leaves the folder of the file; only files beside it "
                    "are read",
                    number, uri));
  }
  const auto beside = std::filesystem::path(path_).parent_path() / file;
  std::error_code failed;
  // A link could lead out of the folder, and a pipe would never end.
  for (auto part = beside; part != std::filesystem::path(path_).parent_path();
       part = part.parent_path()) {
    if (std::filesystem::is_symlink(part, failed)) {
      fail(fmt::format("buffers[{}].uri \"{}\" is a link; put the file itself there", number, uri));
    }
  }
  if (!std::filesystem::is_regular_file(beside, failed)) {
    fail(fmt::format("buffers[{}].uri \"{}\": there is no such file beside it", number, uri));
  }
  if (std::filesystem::file_size(beside, failed) > kLargestGltf) {
    fail(fmt::format("buffers[{}].uri \"{}\" is larger than 1 GiB", number, uri));
  }
  return read_file(beside.string());
}

const nlohmann::json& GltfDocument::list(const char* name) const {
  static const nlohmann::json empty = nlohmann::json::array();
  const auto found = json_.find(name);
  if (found == json_.end()) return empty;
  if (!found->is_array()) fail(fmt::format("\"{}\" is not an array", name));
  return *found;
}

const nlohmann::json& GltfDocument::element(const char* list_name, size_t index) const {
  const nlohmann::json& all = list(list_name);
  if (index >= all.size() || !all[index].is_object()) {
    fail(fmt::format("{}[{}] does not exist", list_name, index));
  }
  return all[index];
}

int GltfDocument::index(const nlohmann::json& owner, const char* member,
                        const char* list_name) const {
  const auto found = owner.find(member);
  if (found == owner.end()) return -1;
  const size_t count = list(list_name).size();
  if (!found->is_number_unsigned() || found->get<uint64_t>() >= count) {
    fail(fmt::format("\"{}\": {} is not one of the {} {}", member,
                     found->is_number() ? found->dump() : "what is there", count, list_name));
  }
  return static_cast<int>(found->get<uint64_t>());
}

size_t GltfDocument::size_member(const nlohmann::json& owner, const char* member,
                                 size_t fallback) const {
  const auto found = owner.find(member);
  if (found == owner.end()) return fallback;
  if (!found->is_number_unsigned() || found->get<uint64_t>() > kLargestGltf) {
    fail(fmt::format("\"{}\" is not a size", member));
  }
  return found->get<uint64_t>();
}

std::vector<double> GltfDocument::numbers(const nlohmann::json& owner, const char* member,
                                          size_t count, std::vector<double> fallback) const {
  const auto found = owner.find(member);
  if (found == owner.end()) return fallback;
  std::vector<double> values;
  if (found->is_array() && found->size() == count) {
    for (const nlohmann::json& value : *found) {
      if (value.is_number()) values.push_back(value.get<double>());
    }
  }
  constexpr double kLargest = 1e9;
  for (const double value : values) {
    if (!(std::abs(value) < kLargest)) values.clear();
    if (values.empty()) break;
  }
  if (values.size() != count) fail(fmt::format("\"{}\" is not {} numbers", member, count));
  return values;
}

std::string GltfDocument::text(const nlohmann::json& owner, const char* member) const {
  const auto found = owner.find(member);
  if (found == owner.end()) return "";
  if (!found->is_string()) fail(fmt::format("\"{}\" is not a text", member));
  return found->get<std::string>();
}

std::string_view GltfDocument::view(int view_index, size_t& stride) const {
  const nlohmann::json& view = element("bufferViews", static_cast<size_t>(view_index));
  const int buffer = index(view, "buffer", "buffers");
  if (buffer < 0) fail(fmt::format("bufferViews[{}] names no buffer", view_index));
  const std::string& bytes = buffers_[static_cast<size_t>(buffer)];
  const size_t offset = size_member(view, "byteOffset", 0);
  const size_t length = size_member(view, "byteLength", 0);
  if (offset > bytes.size() || length > bytes.size() - offset) {
    fail(fmt::format("bufferViews[{}] reaches beyond its buffer", view_index));
  }
  stride = size_member(view, "byteStride", 0);
  return std::string_view(bytes).substr(offset, length);
}

void GltfDocument::read_elements(int view_index, size_t offset, size_t count, size_t width,
                                 int component, bool normalized, float* out) const {
  size_t stride = 0;
  const std::string_view bytes = view(view_index, stride);
  const size_t size = component_size(component), packed = size * width;
  if (stride == 0) stride = packed;
  if (stride < packed || offset > bytes.size() ||
      (count > 0 &&
       (bytes.size() - offset < packed || (bytes.size() - offset - packed) / stride < count - 1))) {
    fail(fmt::format("an accessor of {} elements reaches beyond bufferViews[{}]", count,
                     view_index));
  }
  for (size_t i = 0; i < count; ++i) {
    for (size_t k = 0; k < width; ++k) {
      const float value =
          component_at(bytes.data() + offset + i * stride + k * size, component, normalized);
      if (!std::isfinite(value)) {
        fail(fmt::format("bufferViews[{}] holds a number that is not finite", view_index));
      }
      out[i * width + k] = value;
    }
  }
}

void GltfDocument::fill_sparse(const nlohmann::json& accessor, GltfNumbers& result, int component,
                               bool normalized) const {
  const nlohmann::json& sparse = accessor["sparse"];
  const size_t count = sparse.is_object() ? size_member(sparse, "count", 0) : 0;
  if (count < 1 || count > result.count || !sparse.contains("indices") ||
      !sparse.contains("values") || !sparse["indices"].is_object() ||
      !sparse["values"].is_object()) {
    fail("a sparse accessor is damaged");
  }
  const nlohmann::json &where = sparse["indices"], &what = sparse["values"];
  const auto kind = size_member(where, "componentType", 0);
  const int where_view = index(where, "bufferView", "bufferViews");
  const int what_view = index(what, "bufferView", "bufferViews");
  if ((kind != 5121 && kind != 5123 && kind != 5125) || where_view < 0 || what_view < 0) {
    fail("a sparse accessor is damaged");
  }
  std::vector<float> places(count), values(count * result.width);
  read_elements(where_view, size_member(where, "byteOffset", 0), count, 1, static_cast<int>(kind),
                false, places.data());
  read_elements(what_view, size_member(what, "byteOffset", 0), count, result.width, component,
                normalized, values.data());
  for (size_t i = 0; i < count; ++i) {
    if (places[i] >= static_cast<float>(result.count)) fail("a sparse accessor is damaged");
    std::copy_n(values.data() + i * result.width, result.width,
                result.values.data() + static_cast<size_t>(places[i]) * result.width);
  }
}

GltfNumbers GltfDocument::accessor(int accessor_index) const {
  const nlohmann::json& accessor = element("accessors", static_cast<size_t>(accessor_index));
  const auto component = static_cast<int>(size_member(accessor, "componentType", 0));
  GltfNumbers result;
  result.count = size_member(accessor, "count", 0);
  result.width = width_of(text(accessor, "type"));
  if (result.width == 0 || component_size(component) == 0) {
    fail(fmt::format("accessors[{}] is of an unknown type", accessor_index));
  }
  // Without a view there are no bytes that bound the count, and glTF defines all zeros.
  if (result.count < 1 || result.count > kMaxNumbers / result.width) {
    fail(fmt::format("accessors[{}] has an impossible count", accessor_index));
  }
  const auto flag = accessor.find("normalized");
  const bool normalized = flag != accessor.end() && flag->is_boolean() && flag->get<bool>();
  const int from = index(accessor, "bufferView", "bufferViews");
  constexpr size_t kMaxCountWithoutView = 1'000'000;
  if (from < 0 && result.count > kMaxCountWithoutView) {
    fail(fmt::format("accessors[{}] has an impossible count", accessor_index));
  }
  if (from >= 0) {
    size_t stride = 0;
    if (view(from, stride).size() < result.count) {
      fail(fmt::format("an accessor of {} elements reaches beyond bufferViews[{}]", result.count,
                       from));
    }
  }
  result.values.assign(result.count * result.width, 0.F);
  if (from >= 0) {
    read_elements(from, size_member(accessor, "byteOffset", 0), result.count, result.width,
                  component, normalized, result.values.data());
  }
  if (accessor.contains("sparse")) fill_sparse(accessor, result, component, normalized);
  return result;
}

}  // namespace remomask::scenes
