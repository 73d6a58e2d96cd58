#pragma once
// Objects behind handles: a handle is a number that looks like a pointer, is looked up at every call and
// never given twice, so that one that was destroyed is told and not followed.

#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace pmdsim::library {

// A number that no handle has had; never 0.
std::uintptr_t next_handle();

// Handles of the type `Handle *`, each of an `Object`. Any thread may use them.
template <class Handle, class Object>
class Handles {
public:
  Handle *add(std::shared_ptr<Object> object) {
    const std::uintptr_t number = next_handle();
    const std::scoped_lock lock(mutex_);
    objects_.emplace(number, std::move(object));
    return reinterpret_cast<Handle *>(number); // NOLINT(performance-no-int-to-ptr): it is never followed
  }
  // Null where there is none.
  std::shared_ptr<Object> get(const Handle *handle) const {
    const std::scoped_lock lock(mutex_);
    const auto found = objects_.find(reinterpret_cast<std::uintptr_t>(handle));
    return found == objects_.end() ? nullptr : found->second;
  }
  // The object, which has no handle any more.
  std::shared_ptr<Object> take(const Handle *handle) {
    const std::scoped_lock lock(mutex_);
    const auto found = objects_.find(reinterpret_cast<std::uintptr_t>(handle));
    if (found == objects_.end())
      return nullptr;
    std::shared_ptr<Object> object = std::move(found->second);
    objects_.erase(found);
    return object;
  }

private:
  mutable std::mutex mutex_;
  std::unordered_map<std::uintptr_t, std::shared_ptr<Object>> objects_;
};

} // namespace pmdsim::library
