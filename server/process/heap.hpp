#pragma once

namespace oval4d::process {

/// The settings of this process's memory allocator (glibc's). Constructed once, in main, before memory is used much.
class Heap {
  public:
    Heap();
    Heap(const Heap&) = delete;
    Heap& operator=(const Heap&) = delete;

    /// Returns free memory to the operating system. Thread-safe; takes milliseconds.
    void returnFreeMemory();
};

}  // namespace oval4d::process
