#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace remomask::exchange {

/// Runs work(0) .. work(count - 1) in `threads` threads and passes the results to
/// `use` in this order, in the calling thread. At most a few results per thread
/// are kept waiting. An exception of either stops everything and is rethrown.
template <typename Result>
void work_in_order(size_t count, int threads, const std::function<Result(size_t)>& work,
                   const std::function<void(size_t, Result&&)>& use) {
  struct Slot {
    Result result;
    std::exception_ptr failure;
  };
  std::mutex mutex;
  std::condition_variable changed;
  std::map<size_t, Slot> ready;
  size_t next = 0, used = 0;
  bool over = false;
  const size_t ahead = 4 * static_cast<size_t>(threads);

  const auto run = [&] {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [&] { return over || next >= count || next < used + ahead; });
      if (over || next >= count) return;
      const size_t i = next++;
      lock.unlock();
      Slot slot;
      try {
        slot.result = work(i);
      } catch (...) {
        slot.failure = std::current_exception();
      }
      lock.lock();
      ready.emplace(i, std::move(slot));
      changed.notify_all();
    }
  };

  std::vector<std::jthread> workers;
  struct Ending {
    std::mutex& mutex;
    std::condition_variable& changed;
    bool& over;
    ~Ending() {
      {
        const std::scoped_lock lock(mutex);
        over = true;
      }
      changed.notify_all();
    }
  } ending{mutex, changed, over};  // before the workers are joined
  for (int i = 0; i < threads; ++i) workers.emplace_back(run);
  while (used < count) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return ready.contains(used); });
    auto node = ready.extract(used);
    lock.unlock();
    if (node.mapped().failure) std::rethrow_exception(node.mapped().failure);
    use(used, std::move(node.mapped().result));
    lock.lock();
    ++used;
    lock.unlock();
    changed.notify_all();
  }
}

}  // namespace remomask::exchange
