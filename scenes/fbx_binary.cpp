#include "scenes/fbx_binary.h"

#include <cmath>
#include <cstdint>
#include <cstring>

#include "remomask/error.h"

namespace remomask::scenes {

namespace {

constexpr std::string_view kFbxMagic("Kaydara FBX Binary  \0\x1a\0", 23);
constexpr size_t kVersionAt = 23, kNodesAt = 27;
constexpr size_t kNodeHeader = 25;  // three 64-bit numbers and the length of the name
constexpr size_t kEmptyRecord = kNodeHeader;
constexpr int kDeepestNode = 32;
constexpr double kTicksPerSecond = 46186158000;

class FbxCompleter {
 public:
  FbxCompleter(std::string_view bytes, const FbxFacts& facts) : bytes_(bytes), facts_(facts) {}

  std::string run() {
    if (!bytes_.starts_with(kFbxMagic) || bytes_.size() < kNodesAt + kEmptyRecord ||
        number<uint32_t>(kVersionAt) < 7500) {
      throw Error("FBX cannot be written: the library gave no binary FBX 7.5");
    }
    out_ = bytes_.substr(0, kNodesAt);
    size_t at = kNodesAt;
    while (number<uint64_t>(at) != 0) at = node(at, bytes_.size(), 0);
    out_.append(kEmptyRecord, '\0');
    footer();
    return std::move(out_);
  }

 private:
  /// Readers expect these to be lists even where nothing is in them.
  static bool is_always_list(std::string_view name) {
    return name == "AnimationLayer" || name == "References";
  }

  template <typename T>
  T number(size_t at) const {
    T value{};
    if (at > bytes_.size() || bytes_.size() - at < sizeof value) damaged();
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }

  [[noreturn]] static void damaged() {
    throw Error("FBX cannot be written: the library gave a damaged file");
  }

  /// Copies the node at `at`; returns where the next one begins.
  size_t node(size_t at, size_t limit, int depth) {
    const auto end = number<uint64_t>(at), properties = number<uint64_t>(at + 16);
    const auto name = number<uint8_t>(at + 24);
    const size_t children = at + kNodeHeader + name + properties;
    if (end > limit || properties > limit || children > end || depth > kDeepestNode) damaged();
    const size_t start = out_.size();
    out_ += bytes_.substr(at, children - at);
    const std::string_view called = bytes_.substr(at + kNodeHeader, name);
    if (called == "P") correct_property(children - properties, properties);
    if (called == "KeyValueFloat") unwrap_angles(properties);
    if (called == "KeyAttrFlags") set_linear(properties);
    if (called == "AnimationStack") ++animations_;
    size_t next = children;
    while (next < end && number<uint64_t>(next) != 0) next = node(next, end, depth + 1);
    if (children < end || is_always_list(called)) {
      out_.append(kEmptyRecord, '\0');
    }
    const uint64_t new_end = out_.size();
    std::memcpy(out_.data() + start, &new_end, sizeof new_end);
    return end;
  }

  /// A property is a list of texts (name, types) and a value, which is what was copied last.
  void correct_property(size_t at, size_t size) {
    const std::string_view all = bytes_.substr(at, size);
    const auto is = [&](std::string_view name) {
      return number<uint32_t>(at + 1) == name.size() && all.substr(5).starts_with(name);
    };
    if (is("TimeMode")) {
      overwrite_end(int32_t{14}, size);  // a rate of its own
    } else if (is("CustomFrameRate")) {
      overwrite_end(facts_.fps, size);
    } else if ((is("LocalStop") || is("ReferenceStop")) && animations_ > 0 &&
               animations_ <= facts_.seconds.size()) {
      overwrite_end(static_cast<int64_t>(facts_.seconds[animations_ - 1] * kTicksPerSecond), size);
    }
  }

  template <typename T>
  void overwrite_end(T value, size_t size) {
    if (size < sizeof value + 1) damaged();
    std::memcpy(out_.data() + out_.size() - sizeof value, &value, sizeof value);
  }

  /// The elements of an array property at the end of what was copied; none if it is compressed.
  size_t plain_array(char type, size_t size) const {
    constexpr size_t kArrayHeader = 13;  // type, length, encoding, bytes
    if (size < kArrayHeader || out_[out_.size() - size] != type) return 0;
    uint32_t length = 0, encoding = 0;
    std::memcpy(&length, out_.data() + out_.size() - size + 1, sizeof length);
    std::memcpy(&encoding, out_.data() + out_.size() - size + 5, sizeof encoding);
    return encoding == 0 && size == kArrayHeader + length * 4ULL ? length : 0;
  }

  void unwrap_angles(size_t size) {
    const size_t count = plain_array('f', size);
    char* values = out_.data() + out_.size() - count * sizeof(float);
    float before = 0;
    for (size_t i = 0; i < count; ++i) {
      float value = 0;
      std::memcpy(&value, values + i * sizeof value, sizeof value);
      // Positions are metres and never move this far between two frames.
      if (i > 0) value -= 360 * std::round((value - before) / 360);
      std::memcpy(values + i * sizeof value, &value, sizeof value);
      before = value;
    }
  }

  void set_linear(size_t size) {
    constexpr int32_t kLinear = 4;
    if (plain_array('i', size) == 1) overwrite_end(kLinear, size);
  }

  /// What Autodesk's own writer puts last; the padding depends on the length.
  void footer() {
    constexpr std::string_view kId(
        "\xfa\xbc\xab\x09\xd0\xc8\xd4\x66\xb1\x76\xfb\x83\x1c\xf7\x26\x7e", 16);
    constexpr std::string_view kEnd(
        "\xf8\x5a\x8c\x6a\xde\xf5\xd9\x7e\xec\xe9\x0c\xe3\x75\x8f\x29\x0b", 16);
    constexpr size_t kZeros = 120, kAlignment = 16, kGap = 4;
    out_ += kId;
    out_.append(kGap, '\0');
    out_.append(kAlignment - out_.size() % kAlignment, '\0');
    out_ += bytes_.substr(kVersionAt, sizeof(uint32_t));
    out_.append(kZeros, '\0');
    out_ += kEnd;
  }

  std::string_view bytes_;
  const FbxFacts& facts_;
  size_t animations_ = 0;  ///< begun so far
  std::string out_;
};

}  // namespace

std::string complete_fbx(std::string_view bytes, const FbxFacts& facts) {
  return FbxCompleter(bytes, facts).run();
}

}  // namespace remomask::scenes
