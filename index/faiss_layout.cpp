#include "index/faiss_layout.h"

#include "index/hnsw_layout.h"
#include "index/layout_walk.h"

namespace remomask::index {

namespace {

constexpr uint64_t kMaxLists = 1 << 20;

/// The header of every index: width, count, two unused numbers, trained or not, metric.
bool walk_header(LayoutWalk& walk, const FaissSize& expected) {
  int32_t width = 0, metric = 0;
  int64_t count = 0, unused = 0;
  uint8_t trained = 0;
  float argument = 0;
  return walk.take(width) && width == expected.width && walk.take(count) &&
         count == expected.count && walk.take(unused) && walk.take(unused) && walk.take(trained) &&
         trained <= 1 && walk.take(metric) && (metric <= 1 || walk.take(argument));
}

bool walk_flat(LayoutWalk& walk, const FaissSize& expected) {
  return walk_header(walk, expected) && walk.skip_vector(static_cast<uint64_t>(expected.count) *
                                                             static_cast<uint64_t>(expected.width),
                                                         sizeof(float));
}

bool walk_lists(LayoutWalk& walk, const FaissSize& expected, uint64_t lists) {
  std::string_view name, kind;
  uint64_t stated = 0, code_bytes = 0, sizes = 0;
  if (!walk.take_name(name) || name != "ilar" || !walk.take(stated) || stated != lists ||
      !walk.take(code_bytes) ||
      code_bytes != static_cast<uint64_t>(expected.width) * sizeof(float) ||
      !walk.take_name(kind) || !walk.take(sizes)) {
    return false;
  }
  // "full": the size of every list; "sprs": pairs of list and size.
  const bool sparse = kind == "sprs";
  if (!sparse && kind != "full") return false;
  if (sizes != lists && (!sparse || sizes % 2 != 0 || sizes / 2 > lists)) return false;
  uint64_t total = 0;
  for (uint64_t i = 0; i < sizes; ++i) {
    uint64_t value = 0;
    if (!walk.take(value)) return false;
    if (sparse && i % 2 == 0) {
      if (value >= lists) return false;
      continue;
    }
    if (value > static_cast<uint64_t>(expected.count)) return false;
    total += value;
  }
  return total == static_cast<uint64_t>(expected.count) &&
         walk.skip(total, code_bytes + sizeof(int64_t));
}

bool walk_ivf_flat(LayoutWalk& walk, const FaissSize& expected) {
  uint64_t lists = 0, probes = 0;
  std::string_view quantizer;
  if (!walk_header(walk, expected) || !walk.take(lists) || lists == 0 || lists > kMaxLists ||
      !walk.take(probes) || !walk.take_name(quantizer) || !quantizer.starts_with("IxF") ||
      !walk_flat(walk, {static_cast<int64_t>(lists), expected.width})) {
    return false;
  }
  char direct_map = 0;
  return walk.take(direct_map) && direct_map == 0 && walk.skip_vector(0, sizeof(int64_t)) &&
         walk_lists(walk, expected, lists);
}

/// With its vectors behind it, as a Flat index.
bool walk_hnsw_flat(LayoutWalk& walk, const FaissSize& expected) {
  std::string_view name;
  return walk_header(walk, expected) && walk_hnsw_graph(walk, expected.count) &&
         walk.take_name(name) && name.starts_with("IxF") && walk_flat(walk, expected);
}

}  // namespace

bool fits_layout(std::string_view bytes, const FaissSize& expected, bool with_ids) {
  if (expected.count < 0 || expected.width < 1) return false;
  LayoutWalk walk(bytes);
  std::string_view name;
  if (!walk.take_name(name)) return false;
  if (with_ids) {
    if (name != "IxM2" || !walk_header(walk, expected) || !walk.take_name(name)) return false;
  }
  if (name.starts_with("IxF")) {
    if (!walk_flat(walk, expected)) return false;
  } else if (name == "IwFl") {
    if (!walk_ivf_flat(walk, expected)) return false;
  } else if (name == "IHNf") {
    if (!walk_hnsw_flat(walk, expected)) return false;
  } else {
    return walk_header(walk, expected);
  }
  if (with_ids && !walk.skip_vector(static_cast<uint64_t>(expected.count), sizeof(int64_t))) {
    return false;
  }
  return walk.at_end();
}

}  // namespace remomask::index
