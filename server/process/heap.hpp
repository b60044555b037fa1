#pragma once

namespace oval4d::process {

/// The memory that glibc's allocator has for this process. Construct one object, which configures the allocator, in
/// main(), before the program allocates much memory.
class Heap {
  public:
    Heap();
    Heap(const Heap&) = delete;
    Heap& operator=(const Heap&) = delete;

    /// Returns free memory to the operating system, which takes milliseconds. Thread-safe.
    void returnFreeMemory();
};

}  // namespace oval4d::process
