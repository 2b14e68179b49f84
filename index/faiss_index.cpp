#include "index/faiss_index.h"

#include <faiss/AutoTune.h>
#include <faiss/IndexIVF.h>
#include <faiss/impl/FaissException.h>
#include <faiss/index_factory.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "remomask/error.h"

namespace remomask::index {

namespace {

constexpr int64_t kMinCountOfLists = 500000;
constexpr int64_t kRowsPerAddition = 8192;
constexpr int kPointsPerCentroid = 64;  // more cost minutes and gain nothing measurable

std::unique_ptr<faiss::Index> make_faiss_index(int width, const std::string& factory) {
  std::unique_ptr<faiss::Index> index(
      faiss::index_factory(width, factory.c_str(), faiss::METRIC_INNER_PRODUCT));
  if (dynamic_cast<faiss::IndexIDMap*>(index.get())) {
    throw Error("the index type \"" + factory + "\" maps ids itself; remove IDMap from it");
  }
  if (auto* lists = dynamic_cast<faiss::IndexIVF*>(index.get())) {
    // FAISS prints a warning to stderr below this number, and libraries must not print.
    lists->cp.min_points_per_centroid = 1;
    lists->cp.max_points_per_centroid = kPointsPerCentroid;
  }
  return index;
}

}  // namespace

std::string resolve_factory(const std::string& requested, int64_t count) {
  if (requested != "auto") return requested;
  if (count < kMinCountOfLists) return "Flat";
  const double exponent = std::round(std::log2(2 * std::sqrt(static_cast<double>(count))));
  return fmt::format("IVF{},Flat", 1 << std::clamp(static_cast<int>(exponent), 10, 14));
}

std::unique_ptr<faiss::IndexIDMap2> build_faiss_index(const std::vector<int64_t>& ids,
                                                      const float* vectors, int width,
                                                      const IndexType& type,
                                                      const Monitor& monitor) {
  const auto count = static_cast<int64_t>(ids.size());
  try {
    auto inner = make_faiss_index(width, type.factory);
    if (!inner->is_trained) inner->train(count, vectors);
    auto index = std::make_unique<faiss::IndexIDMap2>(inner.get());
    inner.release();
    index->own_fields = true;
    for (int64_t first = 0; first < count; first += kRowsPerAddition) {
      if (monitor.stop_requested()) {
        throw Interrupted("building the index was stopped; nothing was written");
      }
      const int64_t rows = std::min(kRowsPerAddition, count - first);
      index->add_with_ids(rows, vectors + first * width, ids.data() + first);
      monitor.report({"index", static_cast<double>(first + rows), static_cast<double>(count), ""});
    }
    if (!type.search_parameters.empty()) {
      faiss::ParameterSpace().set_index_parameters(index.get(), type.search_parameters.c_str());
    }
    return index;
  } catch (const faiss::FaissException& error) {
    throw Error(fmt::format(
        "FAISS cannot build an index of type \"{}\" with parameters \"{}\" over {} vectors ({}); "
        "use another type, or Flat",
        type.factory, type.search_parameters, ids.size(), error.what()));
  }
}

}  // namespace remomask::index
